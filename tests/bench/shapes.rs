//! Shape coding of silhouettes under one vertex code, and the shape descriptor [sohel sec. IV]:
//! `cargo bench --bench shapes -- [--svg OUT.svg] SHAPE.bmp…` (a shape is black or white on the other).
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench times and reports"
)]

use image::Luma;
use imageproc::contours::find_contours;
use khatt::code::{Bounds, Kind, distortion, encode};
use khatt::numeric::qbc::Pull;
use kurbo::Point;
use std::fmt::Write;
use std::{env, fs, time::Instant};

const KINDS: [(&str, Kind); 4] = [
    ("polygon", Kind::Polygon),
    ("B-spline", Kind::Spline(Pull::Bezier)),
    ("QBC", Kind::Spline(Pull::Qbc)),
    ("QBC-n", Kind::Spline(Pull::QbcN)),
];

/// The bounds of table 4.
const BOUNDS: [(f64, f64); 5] = [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (3.0, 1.0), (3.0, 2.0)];

/// The longest border in a picture, px: of the shape that is not the picture's corner colour.
fn boundary(path: &str) -> Vec<Point> {
    let gray = image::open(path).expect("a picture").to_luma8();
    let paper = gray.get_pixel(0, 0).0[0] > 127;
    let mut framed = image::GrayImage::new(gray.width() + 2, gray.height() + 2);
    for (x, y, p) in gray.enumerate_pixels() {
        let ink = (p.0[0] > 127) != paper;
        framed.put_pixel(x + 1, y + 1, Luma([if ink { 255 } else { 0 }]));
    }
    let borders = find_contours::<i32>(&framed);
    let longest = borders.into_iter().max_by_key(|c| c.points.len());
    let points = longest.expect("a border").points;
    points
        .iter()
        .map(|p| Point::new(f64::from(p.x), f64::from(p.y)))
        .collect()
}

fn main() {
    let mut args: Vec<String> = env::args().skip(1).filter(|a| a != "--bench").collect();
    let svg = args.iter().position(|a| a == "--svg").map(|i| {
        let path = args.remove(i + 1);
        args.remove(i);
        path
    });
    let mut sums = [[0_u64; 4]; 5];
    let mut curves = vec![Vec::new(); 4];
    for path in &args {
        let shape = boundary(path);
        println!("{path}: {} boundary points", shape.len());
        descriptor(&shape);
        for (row, (t_max, t_min)) in BOUNDS.into_iter().enumerate() {
            print!("  bits at {t_max}/{t_min}");
            for (column, (name, kind)) in KINDS.into_iter().enumerate() {
                let clock = Instant::now();
                match encode(&shape, kind, Bounds { t_max, t_min }) {
                    Ok(coded) => {
                        print!(
                            "  {name} {} (D_max {:.2}, {:.1} s)",
                            coded.bits,
                            coded.d_max,
                            clock.elapsed().as_secs_f64()
                        );
                        sums[row][column] += coded.bits;
                        curves[column].push((coded.bits, coded.d_ms));
                    }
                    Err(e) => print!("  {name}: {e}"),
                }
            }
            println!();
        }
    }
    for ((t_max, t_min), sum) in BOUNDS.into_iter().zip(sums) {
        let saving = 100.0 * (1.0 - number(sum[3]) / number(sum[1]).max(1.0));
        println!("all at {t_max}/{t_min}: {sum:?}; QBC-n saves {saving:.1} % of the B-spline's");
    }
    if let Some(path) = svg {
        fs::write(path, plot(&curves)).expect("written");
    }
}

/// Largest and mean square distance of the cubic curves of as many segments, control points on the shape [sohel sec. IV.B].
fn descriptor(shape: &[Point]) {
    for segments in 5..=10 {
        print!("  {segments} segments");
        for (name, kind) in KINDS.into_iter().skip(1) {
            let Kind::Spline(pull) = kind else { continue };
            let at = |k: usize| shape[k * shape.len() / (3 * segments) % shape.len()];
            let dots = (0..segments).flat_map(|s| {
                let controls = [at(3 * s), at(3 * s + 1), at(3 * s + 2), at(3 * s + 3)];
                (0..200).map(move |k| pull.eval(&controls, f64::from(k) / 200.0).0)
            });
            let (d_max, d_ms) = distortion(shape, &dots.collect::<Vec<_>>());
            let name = if name == "B-spline" { "Bezier" } else { name };
            print!("  {name} {d_max:.2} {d_ms:.2}");
        }
        println!();
    }
}

/// Bits against mean square distortion, a colour a kind.
fn plot(curves: &[Vec<(u64, f64)>]) -> String {
    let all = || curves.iter().flatten();
    let bits = all().map(|c| number(c.0)).fold(1.0, f64::max);
    let most = all().map(|c| c.1).fold(1e-9, f64::max);
    let mut out = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-40 -10 460 340\" font-size=\"10\">\n\
        <path d=\"M0 0V300H400\" fill=\"none\" stroke=\"#000\"/><text x=\"360\" y=\"318\">bits</text><text x=\"-34\" y=\"4\">D_ms</text>\n"
        .to_owned();
    let colours = ["#888", "#05a", "#090", "#c00"];
    for (i, (points, colour)) in curves.iter().zip(colours).enumerate() {
        let name = KINDS[i].0;
        let y = 20 + 14 * i;
        let _ = writeln!(
            out,
            "<text x=\"320\" y=\"{y}\" fill=\"{colour}\">{name}</text>"
        );
        for (b, d) in points {
            let (x, y) = (400.0 * number(*b) / bits, 300.0 - 300.0 * d / most);
            let _ = writeln!(
                out,
                "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"3\" fill=\"{colour}\"/>"
            );
        }
    }
    out + "</svg>\n"
}

fn number(v: u64) -> f64 {
    f64::from(u32::try_from(v).unwrap_or(u32::MAX))
}
