//! Bytes, points and time of the conversions to quadratics, beside each other and the fewest points possible:
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench times and reports"
)]
//! `cargo bench --bench quadratics -- FONT.otf [all] TOLERANCE…` (font units; `all`: every glyph, else 65 Latin ones).

use khatt::quadratic::rate::{Rate, Strictness, glyf_bytes, glyf_points};
use khatt::quadratic::{Method, split::Split};
use khatt::read;
use khatt::types::{Glyph, Outline};
use std::{env, fs, time::Instant};

const LATIN: &str = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789&?!";

fn main() {
    let args: Vec<String> = env::args().skip(1).filter(|a| a != "--bench").collect();
    let Some(path) = args.first() else {
        println!("a font's path and tolerances are wanted; nothing measured");
        return;
    };
    let data = fs::read(path).expect("a readable file");
    let font = read::font(&data, &[]).expect("a font").font;
    let all = args.iter().any(|a| a == "all");
    let wanted = |g: &&Glyph| all || g.codepoints.iter().any(|&c| LATIN.contains(c));
    let drawn = font.glyphs().iter().filter(wanted).map(|g| &g.outline);
    let outlines: Vec<&Outline> = drawn.filter(|o| !o.is_empty()).collect();
    println!("{} glyphs of {path}", outlines.len());
    println!("method         tolerance    bytes  points  at least  ms a glyph  slowest ms  failed");
    let rate = |keep| Rate {
        keep,
        ..Rate::default()
    };
    let [extrema, corners] = [Strictness::Extrema, Strictness::Corners].map(rate);
    for tolerance in args.iter().filter_map(|a| a.parse().ok()) {
        let least = outlines.iter().map(|o| extrema.least_points(o, tolerance));
        let least = least.sum::<usize>().to_string();
        let split = Method::Split(Split::default());
        measure(("split", &split), tolerance, (&outlines, ""));
        let method = Method::Rate(corners.clone());
        measure(("rate, corners", &method), tolerance, (&outlines, ""));
        let method = Method::Rate(extrema.clone());
        measure(("rate, extrema", &method), tolerance, (&outlines, &least));
    }
}

fn measure(
    (name, method): (&str, &Method),
    tolerance: f64,
    (outlines, least): (&[&Outline], &str),
) {
    let (mut bytes, mut points, mut failed) = (0, 0, 0);
    let (mut total, mut slowest) = (0.0, 0.0_f64);
    for outline in outlines {
        let clock = Instant::now();
        let result = method.convert(outline, tolerance);
        let ms = clock.elapsed().as_secs_f64() * 1e3;
        (total, slowest) = (total + ms, slowest.max(ms));
        match result {
            Ok(q) => {
                bytes += glyf_bytes(&q);
                points += glyf_points(&q);
            }
            Err(_) => failed += 1,
        }
    }
    let each = total / f64::from(u32::try_from(outlines.len()).expect("few glyphs"));
    println!(
        "{name:14} {tolerance:9} {bytes:8} {points:7} {least:>9} {each:11.2} {slowest:11.1} {failed:7}"
    );
}
