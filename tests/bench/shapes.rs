//! Shape coding of silhouettes under one vertex code, and the shape descriptor [sohel sec. IV]:
//! `cargo bench --bench shapes -- [--svg OUT.svg] [--only far-W] [--bounds 2/1] SHAPE…` (a shape is black or white on
//! the other; `--only`: one code, `far-W` or `far-W-ring`, `--bounds`: one `T_max/T_min`, all of them else).
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a bench times and reports"
)]

use image::Luma;
use imageproc::contours::find_contours;
use khatt::code::{Bounds, Closing, Code, Kind, Steps, Width, distortion, encode};
use khatt::numeric::qbc::Pull;
use khatt::types::Contour;
use khatt::{corner, fit};
use kurbo::{Point, Shape as _};
use std::fmt::Write;
use std::path::Path;
use std::{env, fs, time::Instant};

const KINDS: [(&str, Kind); 4] = [
    ("polygon", Kind::Polygon),
    ("B-spline", Kind::Spline(Pull::Bezier)),
    ("QBC", Kind::Spline(Pull::Qbc)),
    ("QBC-n", Kind::Spline(Pull::QbcN)),
];

/// The bounds of table 4.
const BOUNDS: [(f64, f64); 5] = [(1.0, 1.0), (2.0, 1.0), (2.0, 2.0), (3.0, 1.0), (3.0, 2.0)];

const CODES: [(&str, Steps); 3] = [
    ("eight", Steps::Eight),
    ("any", Steps::Any),
    ("far", Steps::Far),
];

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
    let mut option = |name: &str| {
        let i = args.iter().position(|a| a == name)?;
        args.drain(i..(i + 2).min(args.len())).nth(1)
    };
    let (svg, only, bounds) = (option("--svg"), option("--only"), option("--bounds"));
    let bounds: Vec<(f64, f64)> = BOUNDS
        .into_iter()
        .filter(|(most, least)| {
            bounds
                .as_ref()
                .is_none_or(|b| *b == format!("{most}/{least}"))
        })
        .collect();
    let shapes: Vec<(&String, Vec<Point>)> = args.iter().map(|a| (a, boundary(a))).collect();
    println!(
        "D_max px and D_ms px² of cubics with control points on the shape: Bézier, QBC, QBC-n\n"
    );
    for (path, shape) in &shapes {
        descriptor(path, shape);
    }
    println!("\nThe same of cubics with control points fitted to the shape as Bézier's\n");
    for (path, shape) in &shapes {
        fitted(path, shape);
    }
    for (name, code) in codes() {
        if only.as_ref().is_some_and(|o| *o != name) {
            continue;
        }
        println!("\nbits (D_max px, s): {name}\n");
        let curves = table(&shapes, &bounds, code);
        if let Some(path) = &svg {
            let name = path.replace(".svg", &format!("-{name}.svg"));
            fs::write(name, plot(&curves)).expect("written");
        }
    }
}

/// Each code by its name: its steps, whether vertices lie within T or W of the boundary, and whether curves are rings.
fn codes() -> impl Iterator<Item = (String, Code)> {
    let widths = [("T", Width::Tolerance), ("W", Width::Bound)];
    let closings = [("", Closing::Corner), ("-ring", Closing::Ring)];
    CODES.into_iter().flat_map(move |(far, steps)| {
        widths.into_iter().flat_map(move |(band, width)| {
            closings.into_iter().map(move |(end, closing)| {
                let code = Code {
                    width,
                    steps,
                    closing,
                };
                (format!("{far}-{band}{end}"), code)
            })
        })
    })
}

/// Bits of all shapes by bounds and kind; bits and mean square distance of all of them together.
fn table(
    shapes: &[(&String, Vec<Point>)],
    bounds: &[(f64, f64)],
    code: Code,
) -> Vec<Vec<(u64, f64)>> {
    let mut curves = vec![Vec::new(); KINDS.len()];
    println!(
        "| shape, T_max / T_min | polygon | B-spline | QBC | QBC-n | QBC-n saves |\n|---|---|---|---|---|---|"
    );
    for &(t_max, t_min) in bounds {
        let mut sums = [(0_u64, 0.0); 4];
        for (path, shape) in shapes {
            let name = Path::new(path).file_stem().unwrap_or_default();
            print!("| {}, {t_max} / {t_min} |", name.display());
            let mut row = [0; 4];
            for (column, (_, kind)) in KINDS.into_iter().enumerate() {
                let clock = Instant::now();
                let coded = encode(shape, kind, Bounds { t_max, t_min }, code);
                let coded = coded.expect("vertices within the bounds");
                let (bits, d_max) = (coded.bits, coded.d_max);
                print!(
                    " {bits} ({d_max:.2}, {:.1}) |",
                    clock.elapsed().as_secs_f64()
                );
                row[column] = bits;
                sums[column].0 += bits;
                sums[column].1 += coded.d_ms / shapes.len() as f64;
            }
            println!(" {} |", saved(row));
        }
        let all = sums.map(|s| s.0.to_string());
        println!(
            "| all, {t_max} / {t_min} | {} | {} |",
            all.join(" | "),
            saved(sums.map(|s| s.0))
        );
        (0..4).for_each(|k| curves[k].push(sums[k]));
    }
    curves
}

/// What QBC-n saves of the B-spline's bits.
fn saved(bits: [u64; 4]) -> String {
    format!(
        "{:.1} %",
        100.0 * (1.0 - number(bits[3]) / number(bits[1]).max(1.0))
    )
}

/// Segments that begin at so many places along the shape, for no place is named to begin at.
const STARTS: usize = 24;

/// Largest and mean square distance of the cubic curves of as many segments, control points on the shape: the mean of
/// all starts, and of how many the order holds [sohel sec. IV.B, tables 1 and 2].
fn descriptor(path: &str, shape: &[Point]) {
    let name = Path::new(path).file_stem().unwrap_or_default();
    for segments in 5..=10 {
        let (mut sums, mut in_order) = ([(0.0, 0.0); 3], (0, 0));
        for start in 0..STARTS {
            let first = start * shape.len() / (segments * STARTS);
            let at = |k: usize| shape[(first + k * shape.len() / (3 * segments)) % shape.len()];
            let pieces: Vec<[Point; 4]> = (0..segments)
                .map(|s| [at(3 * s), at(3 * s + 1), at(3 * s + 2), at(3 * s + 3)])
                .collect();
            let off = distances(shape, &pieces);
            for (sum, (d_max, d_ms)) in sums.iter_mut().zip(off) {
                sum.0 += d_max / STARTS as f64;
                sum.1 += d_ms / STARTS as f64;
            }
            in_order.0 += usize::from(off.is_sorted_by(|a, b| a.0 >= b.0));
            in_order.1 += usize::from(off.is_sorted_by(|a, b| a.1 >= b.1));
        }
        println!(
            "| {}, {} points, {segments} segments | {} in order at {} and {} of {STARTS} starts |",
            name.display(),
            shape.len(),
            cells(sums),
            in_order.0,
            in_order.1
        );
    }
}

/// The same with control points that make the Bézier curves fit, which need not lie on the shape [sohel table 3]: those
/// of least squares, as the method that the paper takes them from, and of the default.
fn fitted(path: &str, shape: &[Point]) {
    let name = Path::new(path).file_stem().unwrap_or_default();
    let contour = Contour::new(shape.to_vec()).expect("a ring");
    let contour = if contour.area() < 0.0 {
        let back = shape.iter().rev().copied().collect();
        Contour::new(back).expect("a ring")
    } else {
        contour
    };
    let corners = corner::Method::default().detector().corners(&contour);
    let spans = contour.cut(&corners);
    for method in [
        fit::Method::Wls(fit::wls::Wls::default()),
        fit::Method::default(),
    ] {
        for tolerance in [1.0, 1.5, 2.0, 4.0] {
            let curve = method.fitter().contour(&spans, tolerance).expect("fitted");
            let pieces: Vec<[Point; 4]> = curve
                .path_segments(0.1)
                .map(|s| s.to_cubic())
                .map(|c| [c.p0, c.p1, c.p2, c.p3])
                .collect();
            println!(
                "| {}, {}, {tolerance} px, {} pieces | {}",
                name.display(),
                method.key(),
                pieces.len(),
                cells(distances(shape, &pieces))
            );
        }
    }
}

/// Largest and mean square distance of the boundary from the curves of each kind with these control points.
fn distances(shape: &[Point], pieces: &[[Point; 4]]) -> [(f64, f64); 3] {
    [Pull::Bezier, Pull::Qbc, Pull::QbcN].map(|pull| {
        let dots = pieces.iter().flat_map(|controls| {
            (0..=200).map(move |k| pull.eval(controls, f64::from(k) / 200.0).0)
        });
        distortion(shape, &dots.collect::<Vec<_>>())
    })
}

fn cells(off: [(f64, f64); 3]) -> String {
    off.map(|(d_max, d_ms)| format!("{d_max:.2}, {d_ms:.3} |"))
        .join(" ")
}

/// Bits against mean square distortion, a colour a kind.
fn plot(curves: &[Vec<(u64, f64)>]) -> String {
    let all = || curves.iter().flatten();
    let (mut least, mut most) = ((f64::MAX, f64::MAX), (0.0, 0.0));
    for &(bits, d) in all() {
        least = (f64::min(least.0, number(bits)), f64::min(least.1, d));
        most = (f64::max(most.0, number(bits)), f64::max(most.1, d));
    }
    let x = |bits: u64| 400.0 * (number(bits) - least.0) / (most.0 - least.0).max(1.0);
    let y = |d: f64| 300.0 * (most.1 - d) / (most.1 - least.1).max(1e-9);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-40 -20 480 350\" font-size=\"10\">\n\
        <path d=\"M-8 -8V308H408\" fill=\"none\" stroke=\"#000\"/>\
        <text x=\"-8\" y=\"322\">{:.0}</text><text x=\"370\" y=\"322\">{:.0} bits</text>\
        <text x=\"-36\" y=\"300\">{:.2}</text><text x=\"-36\" y=\"4\">{:.2}</text><text x=\"-36\" y=\"-10\">D_ms, px²</text>\n",
        least.0, most.0, least.1, most.1
    );
    let colours = ["#888", "#05a", "#090", "#c00"];
    for (i, (points, colour)) in curves.iter().zip(colours).enumerate() {
        let mut points = points.clone();
        points.sort_unstable_by_key(|p| p.0);
        let line: String = points
            .iter()
            .map(|p| format!("{:.1},{:.1} ", x(p.0), y(p.1)))
            .collect();
        let (name, row) = (KINDS[i].0, 10 + 14 * i);
        let _ = writeln!(
            out,
            "<polyline points=\"{line}\" fill=\"none\" stroke=\"{colour}\"/><text x=\"340\" y=\"{row}\" fill=\"{colour}\">{name}</text>"
        );
        for (bits, d) in points {
            let _ = writeln!(
                out,
                "<circle cx=\"{:.1}\" cy=\"{:.1}\" r=\"3\" fill=\"{colour}\"/>",
                x(bits),
                y(d)
            );
        }
    }
    out + "</svg>\n"
}

fn number(v: u64) -> f64 {
    f64::from(u32::try_from(v).unwrap_or(u32::MAX))
}
