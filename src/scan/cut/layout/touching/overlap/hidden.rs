//! Two ends of edges → how one letter's edge may go on from the first to the second beneath another one's ink.

use super::edges::End;
use crate::numeric::angles::angle;
use kurbo::{CubicBez, ParamCurve, Point, Vec2};
use std::f64::consts::FRAC_PI_2;

/// A curve costs so many times its bend.
const BEND: f64 = 0.6;
/// A corner beneath ink, the hidden end of a stroke, costs so much.
const CORNER: f64 = 0.3;
/// And a straight cut, but for the end of a stroke where one is expected.
const CUT: f64 = 0.5;
/// A side of a stroke goes along it by the cosine of their angle; such sides are so many strokes apart.
const ALONG: f64 = 0.95;
const WIDTHS: [f64; 2] = [0.4, 1.8];
/// The middle of a stroke's end is beneath ink, so much of it left out on either side: edges are no straight lines.
const RIM: f64 = 0.2;
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
    /// Of a stroke's end: how far it may lie beneath the ink.
    pub(super) stub: Option<Stub>,
    /// From end to end.
    bends: Vec<Point>,
}

/// How far a stroke that ends beneath ink may go on.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stub {
    /// Where it ends at the nearest.
    pub(super) at: Point,
    /// Which way it goes, of length 1.
    pub(super) way: Vec2,
    /// How much farther it may go, px.
    pub(super) most: f64,
}

impl Hidden {
    /// The likeliest edge between two ends of edges of strokes so wide that lies in the ink. Where a stroke may end, it
    /// goes `along` that way or back.
    pub(super) fn between(
        from: End,
        to: End,
        (stroke, along): (f64, Option<Vec2>),
        example: Option<Vec<Point>>,
        is_ink: impl Fn(Point) -> bool,
    ) -> Option<Self> {
        let chord = (to.at - from.at).hypot();
        if chord > LONGEST * stroke || chord <= 0.0 {
            return None;
        }
        let whole = |(cost, bends): (f64, Vec<Point>), is_cut: bool| Self {
            cost,
            is_cut,
            stub: None,
            bends,
        };
        let ways = [curve(from, to), corner(from, to)];
        let ways = ways.into_iter().flatten().map(|way| whole(way, false));
        let cut = whole((CUT, vec![from.at, to.at]), true);
        let stub = along.and_then(|along| stub(from, to, (stroke, along), &is_ink));
        let example = example.map(|path| whole((0.0, path), false));
        let ways = ways.chain([cut]).chain(stub).chain(example);
        let is_hidden = |path: &[Point]| {
            let far = |p: &&Point| p.distance(from.at).min(p.distance(to.at)) > BLUR;
            path.iter().filter(far).all(|&p| is_ink(p))
        };
        let priced = ways.filter_map(|mut way: Self| {
            let path = way.path(0.0);
            way.cost += LENGTH * SPACING * path.len() as f64 / stroke;
            is_hidden(&path).then_some(way)
        });
        priced.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    /// From end to end, evenly spaced; a stroke's end so many px farther on.
    pub(super) fn path(&self, farther: f64) -> Vec<Point> {
        let Some(stub) = self.stub else {
            return spaced(&self.bends);
        };
        let on = farther.clamp(0.0, stub.most) * stub.way;
        let last = self.bends.len() - 1;
        let is_end = |k: usize| k > 0 && k < last;
        let bends = self.bends.iter().enumerate();
        let bends = bends.map(|(k, &p)| if is_end(k) { p + on } else { p });
        spaced(&bends.collect::<Vec<Point>>())
    }
}

/// The end of a stroke that goes `along` or back, straight across, as near as may be.
fn stub(
    from: End,
    to: End,
    (stroke, along): (f64, Vec2),
    is_ink: impl Fn(Point) -> bool,
) -> Option<Hidden> {
    let goes = |side: Vec2| [along, -along].into_iter().find(|a| side.dot(*a) > ALONG);
    let way = goes(from.way).or_else(|| goes(-to.way))?;
    let chord = to.at - from.at;
    // the ink of a ring lies on its left
    let width = way.cross(chord) / stroke;
    if !(WIDTHS[0]..WIDTHS[1]).contains(&width) {
        return None;
    }
    let ahead = way.dot(chord);
    let a = from.at + ahead.max(0.0) * way;
    let b = to.at + (-ahead).max(0.0) * way;
    let middle = [a.lerp(b, RIM), b.lerp(a, RIM)];
    let mut most = 0.0;
    while most < LONGEST * stroke && middle.iter().all(|&p| is_ink(p + (most + 1.0) * way)) {
        most += 1.0;
    }
    Some(Hidden {
        cost: 0.0,
        is_cut: false,
        stub: Some(Stub {
            at: a.midpoint(b),
            way,
            most,
        }),
        bends: vec![from.at, a, b, to.at],
    })
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
    let handle = |turn: f64| chord.hypot() / (1.5 * (1.0 + libm::cos(turn)));
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
