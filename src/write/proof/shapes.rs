//! What shows the quality of an outline: curvature comb, extrema, corners, deviation from the scan.

use super::draw::{dot, stroke};
use crate::numeric::angles::angle;
use crate::types::{Info, Outline};
use kurbo::{CubicBez, ParamCurve, ParamCurveCurvature, ParamCurveDeriv, PathSeg, Point, Vec2};

/// Teeth of the comb a curve.
const TEETH: u32 = 12;
/// Length of a tooth: curvature times the square of the em, divided by this.
const COMB: f64 = 100.0;
/// Turns above this between two segments are corners, degrees.
const CORNER_DEG: f64 = 8.0;
/// Directions this near to level or upright are, as a share of their length.
const LEVEL: f64 = 0.02;
/// A shorter handle is none, units.
const HANDLE: f64 = 1e-6;
/// Upper ends of the classes of deviation, thousandths of the em, and what the style calls them.
const CLASSES: [(f64, &str); 4] = [
    (0.5, "fine"),
    (1.0, "fair"),
    (2.0, "poor"),
    (f64::INFINITY, "bad"),
];

/// From y up to y down.
fn down(p: Point) -> Point {
    Point::new(p.x, -p.y)
}

/// Teeth across the curves, outward where they are convex.
pub(super) fn comb(outline: &Outline, info: &Info) -> String {
    let scale = f64::from(info.units_per_em).powi(2) / COMB;
    let mut out = String::new();
    for contour in outline.contours() {
        for segment in contour.segments() {
            let PathSeg::Cubic(cubic) = segment else {
                continue;
            };
            let slope = cubic.deriv();
            for i in 0..=TEETH {
                let t = f64::from(i) / f64::from(TEETH);
                let along = slope.eval(t).to_vec2();
                let bend = cubic.curvature(t);
                if along.hypot() > 0.0 && bend.is_finite() {
                    let side = along.normalize().turn_90() * (-bend * scale);
                    let at = cubic.eval(t);
                    stroke(&mut out, down(at), down(at + side));
                }
            }
        }
    }
    out
}

/// Direction in which a segment leaves its start and reaches its end.
fn directions(segment: PathSeg) -> (Vec2, Vec2) {
    let first = |points: [Point; 4]| {
        let mut ways = points.iter().map(|p| *p - points[0]);
        ways.find(|v| v.hypot() > HANDLE).unwrap_or_default()
    };
    let CubicBez { p0, p1, p2, p3 } = segment.to_cubic();
    (first([p0, p1, p2, p3]), -first([p3, p2, p1, p0]))
}

/// Every joint of two segments with the directions in which the way comes and goes.
fn joints(outline: &Outline) -> Vec<(Point, Vec2, Vec2)> {
    let mut out = Vec::new();
    for contour in outline.contours() {
        let segments: Vec<PathSeg> = contour.segments().collect();
        for (i, segment) in segments.iter().enumerate() {
            let next = segments[(i + 1) % segments.len()];
            out.push((segment.end(), directions(*segment).1, directions(next).0));
        }
    }
    out
}

fn turn_deg(a: Vec2, b: Vec2) -> f64 {
    angle(a, b).abs().to_degrees()
}

/// A dot at each joint that is of a kind.
fn dots(outline: &Outline, is: impl Fn(Vec2, Vec2) -> bool) -> String {
    let mut out = String::new();
    let joints = joints(outline).into_iter();
    let such = joints.filter(|(_, come, go)| is(*come, *go));
    such.for_each(|(p, ..)| dot(&mut out, down(p)));
    out
}

/// Joints where the direction jumps.
pub(super) fn corners(outline: &Outline) -> String {
    dots(outline, |come, go| turn_deg(come, go) > CORNER_DEG)
}

/// Smooth joints whose tangent is level or upright.
pub(super) fn extrema(outline: &Outline) -> String {
    dots(outline, |come, go| {
        let level = go.x.abs().min(go.y.abs()) <= LEVEL * go.hypot();
        level && turn_deg(come, go) <= CORNER_DEG
    })
}

/// The scanned edge in classes of its distance to the outline: what the style calls a class, and its path.
pub(super) fn heat(edge: &[Vec<(Point, f64)>], info: &Info) -> Vec<(&'static str, String)> {
    let thousandths = 1000.0 / f64::from(info.units_per_em);
    let mut out = CLASSES.map(|(_, name)| (name, String::new()));
    for ring in edge {
        let next = ring.iter().cycle().skip(1);
        for ((a, d), (b, e)) in ring.iter().zip(next) {
            let far = d.max(*e) * thousandths;
            let class = CLASSES.iter().position(|(end, _)| far <= *end);
            if let Some((_, path)) = class.and_then(|c| out.get_mut(c)) {
                stroke(path, down(*a), down(*b));
            }
        }
    }
    out.into_iter()
        .filter(|(_, path)| !path.is_empty())
        .collect()
}
