//! Two ends of edges → how one letter's edge may go on from the first to the second beneath another one's ink.

use super::edges::{End, angle};
use kurbo::{CubicBez, ParamCurve, Point};
use std::f64::consts::FRAC_PI_2;

/// A curve costs so many times its bend.
const BEND: f64 = 0.6;
/// A corner beneath ink, the hidden end of a stroke, costs so much.
const CORNER: f64 = 0.3;
/// And a straight cut.
const CUT: f64 = 0.5;
/// What each stroke's width of hidden edge adds.
const LENGTH: f64 = 0.05;
/// Longer ones than so many strokes are not believed.
const LONGEST: f64 = 8.0;
/// Sides that turn by less meet nowhere, and those that turn by more make a splinter: sine and cosine.
const FLAT: f64 = 0.2;
const ACUTE: f64 = -0.5;
/// px between the points of a path.
const SPACING: f64 = 0.25;
/// Points of a curve.
const POINTS: usize = 32;
/// How near to its ends a path may leave the ink, px: corners are blurred.
const BLUR: f64 = 2.5;

/// An edge beneath ink.
#[derive(Debug, Clone)]
pub(super) struct Hidden {
    /// How unlikely it is: 0 is what continues straight on.
    pub(super) cost: f64,
    /// It does not go on as the edge came.
    pub(super) is_cut: bool,
    /// From end to end, evenly spaced.
    pub(super) path: Vec<Point>,
}

impl Hidden {
    /// The likeliest edge between two ends of edges of strokes so wide that lies in the ink.
    pub(super) fn between(
        from: End,
        to: End,
        stroke: f64,
        is_ink: impl Fn(Point) -> bool,
    ) -> Option<Self> {
        let chord = (to.at - from.at).hypot();
        if chord > LONGEST * stroke || chord <= 0.0 {
            return None;
        }
        let priced = |(cost, bends): (f64, Vec<Point>), is_cut: bool| {
            let path = spaced(&bends);
            let cost = cost + LENGTH * SPACING * path.len() as f64 / stroke;
            Self { cost, is_cut, path }
        };
        let ways = [curve(from, to), corner(from, to)];
        let ways = ways.into_iter().flatten().map(|way| priced(way, false));
        let cut = priced((CUT, vec![from.at, to.at]), true);
        let is_hidden = |h: &Self| {
            let far = |p: &&Point| p.distance(from.at).min(p.distance(to.at)) > BLUR;
            h.path.iter().filter(far).all(|&p| is_ink(p))
        };
        let ways = ways.chain([cut]).filter(is_hidden);
        ways.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }
}

/// The curve that goes on both ways, and what it costs. A thin rod's squared bend, integrated, times its length is
/// four times as much.
fn curve(from: End, to: End) -> Option<(f64, Vec<Point>)> {
    let chord = to.at - from.at;
    let (a, b) = (angle(from.way, chord), angle(chord, to.way));
    if a.abs().max(b.abs()) > FRAC_PI_2 {
        return None;
    }
    // that of a circle's arc
    let handle = |turn: f64| chord.hypot() / (1.5 * (1.0 + turn.cos()));
    let curve = CubicBez::new(
        from.at,
        from.at + handle(a) * from.way,
        to.at - handle(b) * to.way,
        to.at,
    );
    let places = (0..=POINTS).map(|i| curve.eval(i as f64 / POINTS as f64));
    Some((BEND * (a * a - a * b + b * b), places.collect()))
}

/// The corner where both edges meet straight on.
fn corner(from: End, to: End) -> Option<(f64, Vec<Point>)> {
    let cross = from.way.cross(to.way);
    let chord = to.at - from.at;
    let (a, b) = (chord.cross(to.way) / cross, from.way.cross(chord) / cross);
    let meets = cross.abs() > FLAT && from.way.dot(to.way) > ACUTE && a > 0.0 && b > 0.0;
    meets.then(|| (CORNER, vec![from.at, from.at + a * from.way, to.at]))
}

/// Points along a polyline.
fn spaced(bends: &[Point]) -> Vec<Point> {
    let mut path = Vec::new();
    for pair in bends.windows(2) {
        let steps = (pair[0].distance(pair[1]) / SPACING).ceil().max(1.0);
        let mut step = 0.0;
        while step < steps {
            path.push(pair[0].lerp(pair[1], step / steps));
            step += 1.0;
        }
    }
    path.extend(bends.last());
    path
}
