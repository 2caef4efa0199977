//! Bytes and time of the conversions to quadratics, beside each other:
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench times and reports"
)]
//! `cargo bench --bench quadratics -- FONT.otf [all] TOLERANCE…` (font units; `all`: every glyph, else 65 Latin ones).

use khatt::quadratic::{Method, rate::glyf_bytes};
use khatt::types::Outline;
use kurbo::BezPath;
use skrifa::instance::{LocationRef, Size};
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use std::{env, fs, time::Instant};

const LATIN: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789&?!";

#[derive(Default)]
struct Pen(Vec<BezPath>);

impl Pen {
    fn last(&mut self) -> &mut BezPath {
        self.0.last_mut().expect("a contour begins with a move")
    }
}

impl OutlinePen for Pen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.push(BezPath::new());
        self.last().move_to((f64::from(x), f64::from(y)));
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.last().line_to((f64::from(x), f64::from(y)));
    }
    fn quad_to(&mut self, a: f32, b: f32, x: f32, y: f32) {
        let (c, p) = ((f64::from(a), f64::from(b)), (f64::from(x), f64::from(y)));
        self.last().quad_to(c, p);
    }
    fn curve_to(&mut self, a: f32, b: f32, c: f32, d: f32, x: f32, y: f32) {
        let (p, q) = ((f64::from(a), f64::from(b)), (f64::from(c), f64::from(d)));
        self.last().curve_to(p, q, (f64::from(x), f64::from(y)));
    }
    fn close(&mut self) {
        self.last().close_path();
    }
}

fn main() {
    let args: Vec<String> = env::args().skip(1).filter(|a| a != "--bench").collect();
    let Some(path) = args.first() else {
        println!("a font's path and tolerances are wanted; nothing measured");
        return;
    };
    let data = fs::read(path).expect("a readable file");
    let font = FontRef::new(&data).expect("a font");
    let glyphs = font.outline_glyphs();
    let ids: Vec<GlyphId> = if args.iter().any(|a| a == "all") {
        glyphs.iter().map(|(id, _)| id).collect()
    } else {
        LATIN
            .chars()
            .filter_map(|c| font.charmap().map(c))
            .collect()
    };
    let drawn = ids.iter().filter_map(|&id| {
        let mut pen = Pen::default();
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        glyphs.get(id)?.draw(settings, &mut pen).ok()?;
        Outline::new(pen.0).ok()
    });
    let outlines: Vec<Outline> = drawn.collect();
    println!("{} glyphs of {path}", outlines.len());
    println!("method  tolerance    bytes  ms a glyph  slowest ms  failed");
    for tolerance in args.iter().filter_map(|a| a.parse().ok()) {
        Method::all()
            .iter()
            .for_each(|m| measure(m, tolerance, &outlines));
    }
}

fn measure(method: &Method, tolerance: f64, outlines: &[Outline]) {
    let (mut bytes, mut failed, mut total, mut slowest) = (0, 0, 0.0, 0.0_f64);
    for outline in outlines {
        let clock = Instant::now();
        let result = method.convert(outline, tolerance);
        let ms = clock.elapsed().as_secs_f64() * 1e3;
        (total, slowest) = (total + ms, slowest.max(ms));
        match result {
            Ok(q) => bytes += glyf_bytes(&q),
            Err(_) => failed += 1,
        }
    }
    let each = total / f64::from(u32::try_from(outlines.len()).expect("few glyphs"));
    println!(
        "{:6} {tolerance:10} {bytes:8} {each:11.2} {slowest:11.1} {failed:7}",
        method.key()
    );
}
