//! `khatt features`: the corners, straight runs and directions of a picture's contours, as a plot.

use super::failure::Failure;
use super::trace::{in_range, picture};
use super::{Outcome, files};
use clap::Args;
use khatt::corner::angle::{Angle, Features as Found};
use khatt::scan::{self, InkStreaks, Tones};
use khatt::trace::{self, trace};
use khatt::types::Contour;
use kurbo::{Point, Rect};
use std::path::PathBuf;
use std::slice;

/// Side of the square that shows a contour, and height of its diagram, SVG units.
const SIDE: f64 = 240.0;
/// Width of a diagram, SVG units.
const WIDE: f64 = 760.0;
/// Free space around both, SVG units.
const EDGE: f64 = 30.0;

/// Plots the direction of a picture's contours along their way, with corners and straight runs
#[derive(Debug, Args)]
pub(crate) struct Features {
    /// Picture, or - for standard input
    #[arg(value_name = "IN")]
    picture: PathBuf,
    /// Where the diagram goes, or - for standard output
    #[arg(short, long, value_name = "OUT.svg")]
    output: PathBuf,
    /// Smallest turn that is a corner, degrees [default: 45]
    #[arg(long, value_name = "DEG", value_parser = super::trace::positive)]
    turn: Option<f64>,
    /// Largest turn within a straight run, degrees [default: 4]
    #[arg(long, value_name = "DEG", value_parser = super::trace::positive)]
    straight: Option<f64>,
}

impl Features {
    pub(crate) fn run(&self) -> Outcome {
        files::ends_in(&self.output, &["svg"])?;
        let gray = in_range(picture(&self.picture, Tones::default())?);
        let mut rule = Angle::default();
        rule.turn_deg = self.turn.unwrap_or(rule.turn_deg);
        rule.straight_deg = self.straight.unwrap_or(rule.straight_deg);
        let gray = scan::grained(&gray).map_or(gray, |(even, _)| even);
        let even = scan::legible(&gray, InkStreaks::default());
        let coverage = trace::level(even.as_ref().map_or(&gray, |even| &even.gray));
        let contours = trace(&coverage, &trace::Options::default());
        if contours.is_empty() {
            let name = files::name(&self.picture);
            return Err(Failure::new(format!("{name} has no ink to trace")));
        }
        let diagram = diagram(&contours, &rule);
        files::write(
            &self.output,
            diagram.as_bytes(),
            slice::from_ref(&self.picture),
        )
    }
}

/// A row a contour: its shape with what was found, and beside it the features diagram.
fn diagram(contours: &[Contour], rule: &Angle) -> String {
    let mut rows = String::new();
    let mut top = EDGE;
    for contour in contours {
        let found = rule.features(contour);
        shape(&mut rows, contour, &found, Point::new(EDGE, top));
        plot(&mut rows, &found, Point::new(2.0 * EDGE + SIDE, top));
        top += SIDE + EDGE;
    }
    let wide = 3.0 * EDGE + SIDE + WIDE;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{wide}\" height=\"{top}\" viewBox=\"0 0 {wide} {top}\" \
         font-family=\"sans-serif\" font-size=\"11\" fill=\"none\" stroke-width=\"1\">\n\
         <style>.line{{stroke:#2a7f3f;stroke-width:4;opacity:.5}} .sc{{fill:#c0392b}} .ln{{stroke:#1f5fbf;stroke-width:2}} \
         text{{fill:#333}} .axis{{stroke:#bbb}}</style>\n{rows}</svg>\n"
    )
}

/// The contour in a square: straight runs wide and green, SC red dots, LN blue rings.
fn shape(out: &mut String, contour: &Contour, found: &Found, at: Point) {
    let points = contour.points();
    let Rect { x0, y0, x1, y1 } = contour.bounds();
    let scale = SIDE / (x1 - x0).max(y1 - y0).max(1e-9);
    let place = |i: usize| {
        let p = points[i % points.len()];
        Point::new(at.x + (p.x - x0) * scale, at.y + (y1 - p.y) * scale)
    };
    line(out, "stroke=\"#333\"", (0..=points.len()).map(place));
    for run in &found.lines {
        line(out, "class=\"line\"", (run.start..=run.end).map(place));
    }
    marks(out, found, place);
}

/// Direction over way; a corner is a leap, a straight run lies level.
fn plot(out: &mut String, found: &Found, at: Point) {
    /// The directions that get a line, degrees.
    const STEP: f64 = 90.0;
    let n = found.along_px.len();
    let total = found.along_px.last().copied().unwrap_or(1.0).max(1e-9);
    let (low, high) = found
        .direction_deg
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), &d| {
            (a.min(d), b.max(d))
        });
    let (low, high) = ((low / STEP).floor() * STEP, (high / STEP).ceil() * STEP);
    let y = |deg: f64| at.y + SIDE * (high - deg) / (high - low).max(STEP);
    let place = |i: usize| {
        Point::new(
            at.x + WIDE * found.along_px[i % n] / total,
            y(found.direction_deg[i % n]),
        )
    };
    let mut level = low;
    while level <= high {
        let ends = [at.x, at.x + WIDE].map(|x| Point::new(x, y(level)));
        line(out, "class=\"axis\"", ends.into_iter());
        text(
            out,
            Point::new(at.x + WIDE + 3.0, y(level) + 4.0),
            &format!("{level}°"),
        );
        level += STEP;
    }
    line(out, "stroke=\"#333\"", (0..n).map(place));
    for run in &found.lines {
        // A run across the first point is drawn in its two parts.
        line(
            out,
            "class=\"line\"",
            (run.start..=run.end.min(n - 1)).map(place),
        );
        line(out, "class=\"line\"", (n..=run.end).map(place));
    }
    marks(out, found, place);
    let (sc, ln, lines) = (found.corners.len(), found.joints.len(), found.lines.len());
    let words = format!(
        "{total:.0} px: {sc} corners (SC), {lines} straight runs, {ln} ends without a corner (LN)"
    );
    text(out, Point::new(at.x, at.y + SIDE + 14.0), &words);
}

fn marks(out: &mut String, found: &Found, place: impl Fn(usize) -> Point) {
    for (class, radius, points) in [("sc", 3.5, &found.corners), ("ln", 4.5, &found.joints)] {
        for &i in points {
            let Point { x, y } = place(i);
            *out += &format!(
                "<circle class=\"{class}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\"/>\n"
            );
        }
    }
}

fn line(out: &mut String, style: &str, points: impl Iterator<Item = Point>) {
    let all: Vec<String> = points.map(|p| format!("{:.1},{:.1}", p.x, p.y)).collect();
    if !all.is_empty() {
        *out += &format!("<polyline {style} points=\"{}\"/>\n", all.join(" "));
    }
}

fn text(out: &mut String, at: Point, words: &str) {
    *out += &format!("<text x=\"{:.1}\" y=\"{:.1}\">{words}</text>\n", at.x, at.y);
}
