//! The methods' pictures, drawn from shapes of formulas: `cargo bench --bench pictures -- FOLDER`.
//!
//! `methods.svg`: every fitter and detector on one letter; `tension.svg`: point and interval tension, as
//! figures 3.4-3.46 of [rasheed05]; `smoothing.svg`: one noisy contour at growing μ, as figure 7 of
//! [samavati98]; `leaf.svg`: BFGS at work on a leaf, as the third example of [lumilios93].
#![expect(
    clippy::disallowed_methods,
    clippy::print_stdout,
    reason = "a program that writes pictures"
)]

use khatt::corner;
use khatt::fit::gc2::tension::{End, Tension, cubics, tangents};
use khatt::fit::judge::points_to_curve;
use khatt::fit::periodic::Periodic;
use khatt::fit::wls::Wls;
use khatt::fit::{self, Fitter};
use khatt::types::{Contour, Span};
use kurbo::{Affine, BezPath, ParamCurve, ParamCurveArclen, Point, Rect, Shape};
use std::f64::consts::TAU;
use std::path::Path;

/// Side of a panel, and its free edge, SVG units.
const SIDE: f64 = 180.0;
const EDGE: f64 = 16.0;

fn main() {
    let Some(folder) = std::env::args().skip(1).find(|a| !a.starts_with("--")) else {
        println!("a folder for the pictures is wanted; nothing drawn");
        return;
    };
    let folder = Path::new(&folder);
    std::fs::create_dir_all(folder).expect("a folder");
    for (name, panels, columns) in [
        ("methods.svg", methods(), 5),
        ("tension.svg", tension(), 6),
        ("smoothing.svg", smoothing(), 4),
        ("leaf.svg", leaf(), 4),
    ] {
        let svg = sheet(&panels, columns);
        println!("{name}: {} panels, {} bytes", panels.len(), svg.len());
        std::fs::write(folder.join(name), svg).expect("a file");
    }
}

/// One picture of a sheet: what is drawn, and the words below it.
struct Panel {
    words: String,
    points: Vec<Point>,
    path: BezPath,
    nodes: Vec<Point>,
}

fn sheet(panels: &[Panel], columns: usize) -> String {
    let rows = panels.len().div_ceil(columns);
    let step = (SIDE + EDGE, SIDE + 2.0 * EDGE);
    let (w, h) = (step.0 * columns as f64 + EDGE, step.1 * rows as f64 + EDGE);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" \
         font-family=\"sans-serif\" font-size=\"10\">\n<style>.p{{fill:none;stroke:#bbb;stroke-width:3}} \
         .c{{fill:none;stroke:#c0392b}} .n{{fill:#1f5fbf}}</style>\n"
    );
    for (i, panel) in panels.iter().enumerate() {
        let (x, y) = (
            EDGE + step.0 * (i % columns) as f64,
            EDGE + step.1 * (i / columns) as f64,
        );
        out += &drawn(panel, Point::new(x, y));
    }
    out + "</svg>\n"
}

fn drawn(panel: &Panel, at: Point) -> String {
    let start = panel.points.first().copied().unwrap_or_default();
    let bounds = panel
        .points
        .iter()
        .fold(Rect::from_points(start, start), |b, &p| b.union_pt(p))
        .union(panel.path.bounding_box());
    let scale = SIDE / bounds.width().max(bounds.height()).max(1e-9);
    let place = Affine::translate(at.to_vec2())
        * Affine::scale_non_uniform(scale, -scale)
        * Affine::translate((-bounds.x0, -bounds.y1));
    let short = |p: Point| format!("{:.1},{:.1}", (place * p).x, (place * p).y);
    let points: Vec<String> = panel.points.iter().map(|&p| short(p)).collect();
    let mut path = String::new();
    for el in panel.path.elements() {
        path += &match *el {
            kurbo::PathEl::MoveTo(p) => format!("M{}", short(p)),
            kurbo::PathEl::LineTo(p) => format!("L{}", short(p)),
            kurbo::PathEl::QuadTo(a, p) => format!("Q{} {}", short(a), short(p)),
            kurbo::PathEl::CurveTo(a, b, p) => format!("C{} {} {}", short(a), short(b), short(p)),
            kurbo::PathEl::ClosePath => "Z".to_owned(),
        };
    }
    let nodes: String = panel
        .nodes
        .iter()
        .map(|&p| {
            let q = place * p;
            format!(
                "<rect class=\"n\" x=\"{:.1}\" y=\"{:.1}\" width=\"4\" height=\"4\"/>",
                q.x - 2.0,
                q.y - 2.0
            )
        })
        .collect();
    format!(
        "<polygon class=\"p\" points=\"{}\"/><path class=\"c\" d=\"{path}\"/>{nodes}<text x=\"{:.1}\" y=\"{:.1}\">{}</text>\n",
        points.join(" "),
        at.x,
        at.y + SIDE + EDGE,
        panel.words
    )
}

/// A number in 0…1, the same row every time.
struct Dice(u64);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Nearly normal, deviation 1.
    fn normal(&mut self) -> f64 {
        (0..12).map(|_| self.roll()).sum::<f64>() - 6.0
    }
}

/// The bowl and stem of a p, 200 px high, in steps of a pixel with noise.
fn letter(sigma: f64) -> Vec<Point> {
    let p = "M20 0L60 0L60 70C72 62 86 58 100 58C140 58 166 88 166 130C166 172 138 202 98 202C82 202 68 196 58 186L56 198L20 198Z";
    let path = BezPath::from_svg(p).expect("a path");
    let mut dice = Dice(7);
    let mut out = Vec::new();
    for seg in path.segments() {
        let n = seg.arclen(0.1).round().max(1.0);
        let mut i = 0.0;
        while i < n {
            let q = seg.eval(i / n);
            out.push(Point::new(
                q.x + sigma * dice.normal(),
                q.y + sigma * dice.normal(),
            ));
            i += 1.0;
        }
    }
    out
}

/// Five lobes with points between, as a maple's leaf.
fn maple() -> Vec<Point> {
    (0..420)
        .map(|i| {
            let a = TAU * f64::from(i) / 420.0;
            let lobes =
                26.0 * libm::pow(libm::cos(2.5 * a).abs(), 0.7) + 9.0 * libm::cos(12.5 * a).abs();
            Point::new((55.0 + lobes) * libm::sin(a), (55.0 + lobes) * libm::cos(a))
        })
        .collect()
}

/// Where pieces meet.
fn nodes(path: &BezPath) -> Vec<Point> {
    path.segments().map(|s| s.start()).collect()
}

fn methods() -> Vec<Panel> {
    let points = letter(0.25);
    let contour = Contour::new(points.clone()).expect("a contour");
    let cut = corner::Method::default().detector().corners(&contour);
    let mut panels = Vec::new();
    for method in fit::Method::all() {
        let mut path = BezPath::new();
        for span in contour.cut(&cut).iter() {
            if let Ok(f) = method.fitter().fit(span, 1.0) {
                path.extend(f.path.elements().iter().copied());
            }
        }
        let (nodes, worst) = (nodes(&path), points_to_curve(&points, &path).max_px);
        let words = format!(
            "fit {}: {} pieces, {worst:.2} px",
            method.key(),
            nodes.len()
        );
        panels.push(Panel {
            words,
            points: points.clone(),
            path,
            nodes,
        });
    }
    for method in corner::Method::all() {
        let found = method.detector().corners(&contour);
        panels.push(Panel {
            words: format!("corners {}: {}", method.key(), found.len()),
            points: points.clone(),
            path: BezPath::new(),
            nodes: found.iter().map(|&i| contour.points()[i]).collect(),
        });
    }
    panels
}

/// A ring through eight points: tension at all points, at one, on all intervals, on one.
fn tension() -> Vec<Panel> {
    let points: Vec<Point> = [
        (10, 0),
        (60, 20),
        (100, 0),
        (90, 50),
        (120, 90),
        (60, 80),
        (0, 110),
        (20, 50),
    ]
    .map(|(x, y)| Point::new(f64::from(x), f64::from(y)))
    .to_vec();
    let mut panels = Vec::new();
    let mut panel = |words: String, change: &dyn Fn(&mut Tension)| {
        let mut t = Tension::none(points.len(), End::Periodic);
        change(&mut t);
        let Some(m) = tangents(&points, &t, End::Periodic) else {
            return;
        };
        let mut path = BezPath::new();
        path.move_to(points[0]);
        for c in cubics(&points, &m, &t.lengths) {
            path.curve_to(c.p1, c.p2, c.p3);
        }
        panels.push(Panel {
            words,
            points: points.clone(),
            path,
            nodes: points.clone(),
        });
    };
    for nu in [-3.0, 0.0, 5.0, 20.0, 100.0, 1000.0] {
        panel(format!("ν = {nu} everywhere"), &|t| t.point.fill(nu));
    }
    for nu in [-3.0, 0.0, 5.0, 20.0, 100.0, 1000.0] {
        panel(format!("ν = {nu} at one point"), &|t| t.point[4] = nu);
    }
    for omega in [0.1, 1.0, 5.0, 20.0, 100.0, 1000.0] {
        panel(format!("ω = {omega} on one interval"), &|t| {
            t.interval[3] = omega
        });
    }
    for omega in [0.1, 1.0, 5.0, 20.0, 100.0, 1000.0] {
        panel(format!("ν = 10, ω = {omega} everywhere"), &|t| {
            t.point.fill(10.0);
            t.interval.fill(omega);
        });
    }
    panels
}

fn smoothing() -> Vec<Panel> {
    let (noisy, truth) = (letter(1.2), letter(0.0));
    let weights = [0.0, 1e-3, 1e-2, 1e-1, 1.0, 10.0, 100.0, 1000.0];
    let panel = |mu: f64| {
        let wls = Wls {
            m: Some(60),
            mu_x: mu,
            mu_y: mu,
            straight_deg: 0.0,
            ..Wls::default()
        };
        let fitted = wls.fit(Span::Ring(&noisy), 1.0).ok()?;
        let off = points_to_curve(&truth, &fitted.path).rms_px;
        Some(Panel {
            words: format!("μ = {mu}: {off:.2} px from the truth"),
            points: noisy.clone(),
            path: fitted.path,
            nodes: Vec::new(),
        })
    };
    weights.into_iter().filter_map(panel).collect()
}

fn leaf() -> Vec<Panel> {
    let points = maple();
    let panel = |iterations: usize| {
        let periodic = Periodic {
            control: Some(40),
            iterations,
            ..Periodic::default()
        };
        let fitted = periodic.fit(Span::Ring(&points), 1.0).ok()?;
        let d = points_to_curve(&points, &fitted.path);
        Some(Panel {
            words: format!(
                "{iterations} steps: max {:.2}, rms {:.2} px",
                d.max_px, d.rms_px
            ),
            points: points.clone(),
            nodes: nodes(&fitted.path),
            path: fitted.path,
        })
    };
    [0, 30, 75, 1000].into_iter().filter_map(panel).collect()
}
