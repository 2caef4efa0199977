//! The papers' tables on real silhouettes: `make bench SHAPES=folder`, or a few of them:
//!
//!     cargo bench --bench papers -- FOLDER lumilios93 speed
//!
//! The folder holds dark shapes on light ground (PNG, BMP); names that a table asks for and that are
//! missing are left out of it. Everything is seeded: the same folder gives the same tables, but for times.
#![expect(
    clippy::print_stdout,
    clippy::disallowed_methods,
    reason = "a program that prints tables and times"
)]

use khatt::corner::{self, Detector, srm05::Srm05};
use khatt::fit::gc2::Gc2;
use khatt::fit::gc2::knots::{Insertion, Stop};
use khatt::fit::judge::{judge, points_to_curve};
use khatt::fit::periodic::Periodic;
use khatt::fit::wls::Wls;
use khatt::fit::{self, Fitter};
use khatt::numeric::angles;
use khatt::trace::{Boundary, Options, trace};
use khatt::types::{Contour, Gray, Span};
use kurbo::Point;
use std::path::Path;
use std::time::Instant;

/// A table by its name.
type Table = (&'static str, fn(&Path));
const TABLES: [Table; 7] = [
    ("lumilios93", optimal),
    ("rasheed05", knots),
    ("turned", rotation),
    ("corners", |_| truth()),
    ("samavati98", |_| smoothing()),
    ("speed", |_| speed()),
    ("million", |_| million()),
];

fn main() {
    let mut words = std::env::args().skip(1).filter(|a| !a.starts_with("--"));
    let folder = words.next().unwrap_or_else(|| ".".to_owned());
    let wanted: Vec<String> = words.collect();
    for (name, table) in TABLES {
        if wanted.is_empty() || wanted.iter().any(|w| w == name) {
            table(Path::new(&folder));
        }
    }
}

/// The boundary pixels' chains of a picture, the longest first.
fn chains(folder: &Path, name: &str) -> Vec<Contour> {
    boundaries(folder, name, Boundary::Chain)
}

/// The boundaries of a picture, the longest first.
fn boundaries(folder: &Path, name: &str, boundary: Boundary) -> Vec<Contour> {
    let Ok(image) = image::open(folder.join(name)) else {
        return Vec::new();
    };
    let luma = image.to_luma8();
    let (w, h) = (luma.width() as usize, luma.height() as usize);
    let raw = luma.as_raw();
    // the ground is what most of the frame's pixels are
    let frame = (0..w).flat_map(|x| [raw[x], raw[(h - 1) * w + x]]);
    let bright: i32 = frame.map(|v| if v > 127 { 1 } else { -1 }).sum();
    let pad = 2;
    let ink = |x: usize, y: usize| {
        let inside = (pad..w + pad).contains(&x) && (pad..h + pad).contains(&y);
        let value = if inside {
            raw[(y - pad) * w + x - pad]
        } else {
            return 0.0;
        };
        f32::from(u8::from((value > 127) != (bright > 0)))
    };
    let gray = Gray::from_fn(w + 2 * pad, h + 2 * pad, ink);
    let options = Options {
        boundary,
        ..Options::default()
    };
    let mut all = trace(&gray, &options);
    all.sort_by_key(|c| std::cmp::Reverse(c.points().len()));
    all
}

/// [lumilios93 tables 1, 2, 4].
fn optimal(folder: &Path) {
    println!("### lumilios93\n");
    println!("| shape | points | control points | max px | rms px |\n|---|---|---|---|---|");
    let row = |name: &str, options: &Periodic, what: &str| {
        let Some(contour) = chains(folder, name).into_iter().next() else {
            return;
        };
        let points = contour.points();
        if let Ok(f) = options.fit(Span::Ring(points), 1.0) {
            let d = points_to_curve(points, &f.path);
            let (n, m) = (points.len(), f.parameters / 2);
            println!(
                "| {name}, {what} | {n} | {m} | {:.2} | {:.2} |",
                d.max_px, d.rms_px
            );
        }
    };
    let fixed = Periodic {
        control: Some(28),
        iterations: 1000,
        ..Periodic::default()
    };
    row(
        "africa.png",
        &Periodic {
            iterations: 0,
            ..fixed.clone()
        },
        "first estimate",
    );
    let africa = [
        "africa.png",
        "africa-map.png",
        "africa-520.png",
        "africa-511.png",
        "africa-507.png",
        "africa-drawn.png",
    ];
    for name in africa {
        row(name, &fixed, "28 given");
    }
    let single = Periodic {
        step: 0.0,
        ..Periodic::default()
    };
    let keys = ["key-1.png", "key-2.png", "key-3.png"];
    for name in africa.into_iter().chain(keys) {
        row(name, &single, "until max < 1, one by one");
    }
    row(
        "africa.png",
        &Periodic::default(),
        "until max < 1, several at once",
    );
    for iterations in [0, 30, 75, 1000] {
        let leaf = Periodic {
            control: Some(40),
            iterations,
            ..Periodic::default()
        };
        row("leaf.png", &leaf, &format!("{iterations} iterations"));
    }
    println!();
}

/// Numbers of knots put into all contours of a shape cut at SRM05's corners.
fn inserted(contours: &[Contour], fitter: &dyn Fitter, epsilon: f64) -> usize {
    let mut sum = 0;
    for contour in contours {
        let corners = Srm05::default().corners(contour);
        for span in contour.cut(&corners).iter() {
            let outer = if span.is_ring() { 0 } else { 2 };
            let n = fitter.fit(span, epsilon).map_or(0, |f| f.parameters / 2);
            sum += n.saturating_sub(outer);
        }
    }
    sum
}

/// Nodes that khatt's own fitter puts into contours cut at SRM05's corners.
fn own_knots(contours: &[Contour], epsilon: f64) -> usize {
    let (detector, fitter) = (Srm05::default(), fit::Method::default());
    let inner = |span: Span<'_>| {
        let fitted = fitter.fitter().fit(span, epsilon);
        let segments = fitted.map_or(0, |f| f.path.segments().count());
        segments - usize::from(!span.is_ring()).min(segments)
    };
    let cut = |c: &Contour| c.cut(&detector.corners(c)).iter().map(inner).sum::<usize>();
    contours.iter().map(cut).sum()
}

/// All nodes of khatt's own fitter on its own contours between pixels, cut at its own corners.
fn own_nodes(contours: &[Contour], epsilon: f64) -> usize {
    let (detector, fitter) = (corner::Method::default(), fit::Method::default());
    let path = |c: &Contour| {
        let corners = detector.detector().corners(c);
        fitter.fitter().contour(&c.cut(&corners), epsilon)
    };
    let paths = contours.iter().filter_map(|c| path(c).ok());
    paths.map(|p| p.segments().count()).sum()
}

/// A picture's name, and knots by algorithm and ε.
type Printed = (&'static str, [[usize; 3]; 6]);
/// [rasheed05 tables 4.31-4.54]: the thesis's own counts.
const PRINTED: [Printed; 4] = [
    (
        "ali.png",
        [
            [652, 343, 197],
            [308, 160, 96],
            [183, 144, 98],
            [1334, 664, 422],
            [1002, 431, 260],
            [344, 173, 91],
        ],
    ),
    (
        "d.png",
        [
            [314, 155, 47],
            [137, 68, 50],
            [141, 94, 60],
            [612, 216, 125],
            [618, 324, 220],
            [160, 77, 61],
        ],
    ),
    (
        "apple.png",
        [
            [544, 219, 151],
            [271, 151, 105],
            [189, 107, 89],
            [1196, 398, 305],
            [821, 443, 268],
            [289, 159, 101],
        ],
    ),
    (
        "plane.png",
        [
            [531, 254, 174],
            [285, 150, 86],
            [190, 110, 80],
            [971, 572, 507],
            [863, 390, 395],
            [332, 142, 92],
        ],
    ),
];

/// Planes that are not the thesis's.
const OTHERS: [&str; 2] = ["plane-1.png", "plane-3.png"];

/// [rasheed05 tables 4.31-4.60]; the thesis's figures for its own pictures of the same names.
fn knots(folder: &Path) {
    println!("### rasheed05: knots inserted at ε 1, 2, 3 px (median of 9 seeds / thesis)\n");
    println!(
        "| shape, points, corners | 4.1 | 4.2 | 4.3 | 4.4 | 4.5 | 4.6 | khatt at these corners | khatt's own contour: all nodes |\n|---|---|---|---|---|---|---|---|---|"
    );
    let printed = PRINTED.map(|(name, thesis)| (name, Some(thesis)));
    let others = OTHERS.map(|name| (name, None));
    for (name, thesis) in printed.into_iter().chain(others) {
        let contours = chains(folder, name);
        if contours.is_empty() {
            continue;
        }
        let own = boundaries(folder, name, Options::default().boundary);
        let points: usize = contours.iter().map(|c| c.points().len()).sum();
        let corners: usize = contours
            .iter()
            .map(|c| Srm05::default().corners(c).len())
            .sum();
        for (e, epsilon) in [1.0, 2.0, 3.0].into_iter().enumerate() {
            let mut line = format!("| {name}, {points}, {corners}, ε {epsilon} |");
            for (i, insertion) in Insertion::ALL.into_iter().enumerate() {
                let mut counts: Vec<usize> = (1..=9)
                    .map(|seed| {
                        let stop = Stop::Chance;
                        inserted(
                            &contours,
                            &Gc2 {
                                insertion,
                                stop,
                                seed,
                                ..Gc2::default()
                            },
                            epsilon,
                        )
                    })
                    .collect();
                counts.sort_unstable();
                let printed = thesis.map_or_else(|| "–".to_owned(), |t| t[i][e].to_string());
                line += &format!(" {} / {printed} |", counts[4]);
            }
            let (knots, nodes) = (own_knots(&contours, epsilon), own_nodes(&own, epsilon));
            println!("{line} {knots} | {nodes} |");
        }
    }
    println!();
}

/// [rasheed05 fig. 2.19]: corners of the plane's chain turned by 0…90°, of every detector.
fn rotation(folder: &Path) {
    let Some(contour) = chains(folder, "plane.png").into_iter().next() else {
        return;
    };
    println!("### Corners of plane.png turned\n");
    println!(
        "| detector | 0° | 15° | 30° | 45° | 60° | 75° | 90° |\n|---|---|---|---|---|---|---|---|"
    );
    for method in corner::Method::all() {
        let count = |k: i32| {
            let map = angles::rotation(f64::from(k) * std::f64::consts::PI / 12.0);
            // back on the pixel grid, as a turned picture is
            let snapped = |p: &Point| (map * *p).round();
            let turned = Contour::new(contour.points().iter().map(snapped).collect());
            turned
                .map_or(0, |c| method.detector().corners(&c).len())
                .to_string()
        };
        let counts: Vec<String> = (0..7).map(count).collect();
        println!("| {} | {} |", method.key(), counts.join(" | "));
    }
    println!();
}

/// Six shapes and the corners that they have by construction: the ends of their pieces.
const DRAWN: [(&str, &str, &[usize]); 6] = [
    ("square", "M20 20L140 20L140 140L20 140Z", &[0, 1, 2, 3]),
    ("triangle", "M20 20L150 50L60 160Z", &[0, 1, 2]),
    (
        "L",
        "M20 20L140 20L140 50L60 50L60 170L20 170Z",
        &[0, 1, 2, 3, 4, 5],
    ),
    ("D", "M20 20L80 20C160 20 160 150 80 150L20 150Z", &[0, 3]),
    (
        "drop",
        "M90 10C110 60 150 80 150 120C150 190 30 190 30 120C30 80 70 60 90 10Z",
        &[0],
    ),
    (
        "star",
        "M90 170L71 108L7 109L59 71L38 10L90 48L142 10L121 71L173 109L109 108Z",
        &[0, 1, 2, 3, 4, 5, 6, 7, 8, 9],
    ),
];

/// [rasheed05 sec. 2.3]: corners found, missed and false on drawn shapes, straight and turned by 30°.
fn truth() {
    /// How far a corner found may lie from the true one, px.
    const NEAR: f64 = 5.0;
    println!("### Corners against the truth: found / missed / false\n");
    println!("| shape, corners | sides | angle | srm05 |\n|---|---|---|---|");
    let mut sums = [[0_usize; 3]; 3];
    for (name, svg, corners) in DRAWN {
        for turn in [0_i32, 30] {
            let map = angles::rotation_about(f64::from(turn).to_radians(), (90.0, 90.0));
            let path = map * kurbo::BezPath::from_svg(svg).expect("a path");
            let ends: Vec<Point> = path
                .segments()
                .map(|s| kurbo::ParamCurve::start(&s))
                .collect();
            let ink = |x: usize, y: usize| {
                let centre = Point::new(x as f64 - 39.5, 219.5 - y as f64);
                f32::from(u8::from(kurbo::Shape::winding(&path, centre) != 0))
            };
            let options = Options {
                boundary: Boundary::Chain,
                ..Options::default()
            };
            let traced = trace(&Gray::from_fn(260, 260, ink), &options);
            let Some(contour) = traced.first() else {
                continue;
            };
            // the picture's own origin: its bottom left corner
            let truth: Vec<Point> = corners
                .iter()
                .map(|&i| ends[i] + kurbo::Vec2::new(40.0, 40.0))
                .collect();
            let mut line = format!("| {name}, {}, {turn}° |", truth.len());
            for (m, method) in corner::Method::all().iter().enumerate() {
                let at: Vec<Point> = method
                    .detector()
                    .corners(contour)
                    .iter()
                    .map(|&i| contour.points()[i])
                    .collect();
                let hit = |p: &Point| at.iter().any(|q| q.distance(*p) <= NEAR);
                let found = truth.iter().filter(|p| hit(p)).count();
                let stray = at
                    .iter()
                    .filter(|q| truth.iter().all(|p| q.distance(*p) > NEAR))
                    .count();
                let row = [found, truth.len() - found, stray];
                (0..3).for_each(|k| sums[m][k] += row[k]);
                line += &format!(" {} / {} / {} |", row[0], row[1], row[2]);
            }
            println!("{line}");
        }
    }
    let all = sums.map(|s| format!("{} / {} / {}", s[0], s[1], s[2]));
    println!("| all | {} |\n", all.join(" | "));
}

/// A bean of `n` points, 100 px across times `size`, with noise of `sigma` px across its outline.
fn bean(n: u32, size: f64, sigma: f64) -> (Vec<Point>, Vec<Point>) {
    let mut state = 5_u64;
    let mut roll = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut noisy = Vec::new();
    let mut truth = Vec::new();
    for i in 0..n {
        let t = std::f64::consts::TAU * f64::from(i) / f64::from(n);
        let r = size * (50.0 + 9.0 * libm::cos(2.0 * t) + 4.0 * libm::sin(3.0 * t));
        // the sum of twelve uniform numbers is nearly normal, with deviation 1
        let noise: f64 = (0..12).map(|_| roll()).sum::<f64>() - 6.0;
        let at = |r: f64| Point::new(r * libm::cos(t), r * libm::sin(t));
        truth.push(at(r));
        noisy.push(at(r + sigma * noise));
    }
    (truth, noisy)
}

/// [samavati98 fig. 7]: error to the true shape by the weight.
fn smoothing() {
    println!("### samavati98: rms to the true shape, px (400 points, m = 60, m/n 0.15)\n");
    println!("| σ | μ 0 | 0.001 | 0.01 | 0.1 | 1 | 10 | 100 |\n|---|---|---|---|---|---|---|---|");
    for sigma in [0.3, 0.6, 1.0] {
        let (truth, noisy) = bean(400, 1.0, sigma);
        let error = |mu: f64| {
            let wls = Wls {
                m: Some(60),
                mu_x: mu,
                mu_y: mu,
                straight_deg: 0.0,
                ..Wls::default()
            };
            let fitted = wls.fit(Span::Ring(&noisy), 1.0);
            let d = fitted.map_or(f64::NAN, |f| points_to_curve(&truth, &f.path).rms_px);
            format!("{d:.3}")
        };
        let errors = [0.0, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0].map(error);
        println!("| {sigma} | {} |", errors.join(" | "));
    }
    println!();
}

/// Time a point of each fitter, and the exponent of the whole time's growth.
fn speed() {
    println!("### Speed: µs a point at 1 px, and growth of the whole time\n");
    println!(
        "| method | 200 points | 2,000 | 20,000 | exponent | max px |\n|---|---|---|---|---|---|"
    );
    for method in fit::Method::all() {
        let mut line = format!("| {} |", method.key());
        let mut times = Vec::new();
        let mut worst = 0.0_f64;
        for n in [200_u32, 2_000, 20_000] {
            let (_, points) = bean(n, f64::from(n) / 400.0, 0.2);
            let mut best = f64::INFINITY;
            for _ in 0..if n > 2_000 { 1 } else { 3 } {
                let start = Instant::now();
                if let Ok(f) = method.fitter().fit(Span::Ring(&points), 1.0) {
                    best = best.min(start.elapsed().as_secs_f64());
                    worst = worst.max(judge(Span::Ring(&points), &f.path).max_px());
                }
            }
            line += &format!(" {:.1} |", 1e6 * best / f64::from(n));
            times.push((f64::from(n), best));
        }
        if let (Some(a), Some(b)) = (times.first(), times.last()) {
            let exponent = libm::log(b.1 / a.1) / libm::log(b.0 / a.0);
            println!("{line} {exponent:.2} | {worst:.2} |");
        }
    }
}

/// A million points: on a line, all at one place, and around a bean.
fn million() {
    const MANY: u32 = 1_000_000;
    println!("\n### A million points at 1 px: seconds, verdict\n");
    println!("| method | on a line | at one place | a circle |\n|---|---|---|---|");
    let line: Vec<Point> = (0..MANY)
        .map(|i| Point::new(0.01 * f64::from(i), 5.0))
        .collect();
    let dot = vec![Point::new(3.0, 4.0); MANY as usize];
    let circle: Vec<Point> = (0..MANY)
        .map(|i| {
            let (y, x) = libm::sincos(std::f64::consts::TAU * f64::from(i) / f64::from(MANY));
            Point::new(500.0 * x, 500.0 * y)
        })
        .collect();
    for method in fit::Method::all() {
        let mut row = format!("| {} |", method.key());
        for span in [Span::Open(&line), Span::Open(&dot), Span::Ring(&circle)] {
            let start = Instant::now();
            let verdict = method.fitter().fit(span, 1.0).map(|f| f.verdict);
            row += &format!(" {:.1} s, {verdict:?} |", start.elapsed().as_secs_f64());
        }
        println!("{row}");
    }
}
