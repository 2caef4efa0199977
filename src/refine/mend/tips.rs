//! Tips: acute corners, and what of them no picture can hold.
//!
//! Where two sides run on as one, or cross before they end in a corner, there is no ink (or no paper) between them: a
//! needle or a loop that no pixel speaks against. Such an end is cut off where its sides part. So are small loops at
//! other corners.

use super::side::{behind, reversed, unit};
use crate::{
    numeric::{
        cast::index,
        chain::{Chain, Join, Node},
    },
    refine::{
        crossings::cross,
        curves::{arriving, leaving, polygon_px},
    },
};
use kurbo::{CubicBez, Line, ParamCurve, ParamCurveNearest, Point, Vec2};

/// A corner is a tip if it turns by more, as the distance of its sides' unit vectors: 106°.
const ACUTE: f64 = 1.6;
/// And so far it may go on where it was cut short, px.
const ONWARD_PX: f64 = 10.0;
/// A tip whose sides differ by less, radians, is a needle, and where they are looked at, px.
const NEEDLE: f64 = 0.04;
const BEHIND_PX: f64 = 4.0;
/// Sides no further apart than this are one, px, unless pixels tell.
pub(super) const ONE_PX: f64 = 0.05;
/// And those of a needle: no pen draws one, and no lens shows it.
pub(super) const NEEDLE_PX: f64 = 0.3;
/// Ends that are no longer stay, unless their sides cross, px.
const SHORT_PX: f64 = 1.0;
/// Sides of corners that are no tips cross no further away, px: further away both are drawn.
const LOOP_PX: f64 = 6.0;
/// How far sides are followed, px, in which steps, and over how many segments.
const FAR_PX: f64 = 30.0;
const STEP_PX: f64 = 0.25;
const SEGMENTS: usize = 3;

/// Directions of the sides of a chain's node `i`, if it is an acute corner with both.
pub(super) fn tip(chain: &Chain, i: usize) -> Option<(Vec2, Vec2)> {
    let (before, after) = chain.before(i).zip(chain.after(i))?;
    let (u, v) = (
        unit(arriving(&chain.cubic(before))),
        unit(leaving(&chain.cubic(after))),
    );
    let acute = chain.nodes[i].join == Join::Corner && (u - v).hypot() > ACUTE;
    acute.then_some((u, v))
}

/// Whether an inner node is a tip.
pub(super) fn has_tip(chain: &Chain) -> bool {
    (1..chain.kinds.len()).any(|i| tip(chain, i).is_some())
}

/// Where the tips of a chain may go on.
pub(super) fn beyond(chain: &Chain) -> impl Iterator<Item = Line> {
    (0..chain.nodes.len()).filter_map(|i| {
        let (arrive, leave) = tip(chain, i)?;
        let at = chain.nodes[i].point;
        Some(Line::new(at, at + ONWARD_PX * unit(arrive - leave)))
    })
}

/// Whether the sides of corner `i` of an open chain run on as one.
pub(super) fn is_needle(chain: &Chain, i: usize) -> bool {
    let Some((before, after)) = chain.before(i).zip(chain.after(i)) else {
        return false;
    };
    let at = chain.nodes[i].point;
    let sides = [chain.cubic(before), reversed(&chain.cubic(after))];
    let back = |c: &CubicBez, px: f64| c.eval(1.0 - behind(c, px)) - at;
    // as far back on both: a needle may bend
    let px = sides.each_ref().map(|c| back(c, BEHIND_PX).hypot());
    let [u, v] = sides.each_ref().map(|c| unit(back(c, px[0].min(px[1]))));
    u.dot(v) > 0.0 && u.cross(v).abs() < NEEDLE
}

/// The ring without the end of its corner `i`, cut off where its sides are no more than `one_px` apart last or cross,
/// among their first `steps`; and the step of that place.
pub(super) fn trimmed(ring: &Chain, i: usize, one_px: f64, steps: usize) -> Option<(Chain, usize)> {
    let (last, ends) = parting(ring, i, one_px, steps)?;
    Some((cut(ring, i, ends), last))
}

/// A place on a side: segments before it, counted from the tip, and the parameter in its own, away from the tip.
#[derive(Debug, Clone, Copy)]
struct Place {
    segment: usize,
    t: f64,
    at: Point,
}

/// Where the sides of corner `i` part, if they run on as one before or cross; among their first `most` steps.
fn parting(ring: &Chain, i: usize, one_px: f64, most: usize) -> Option<(usize, (Place, Place))> {
    let acute = tip(ring, i).is_some();
    if ring.nodes[i].join != Join::Corner {
        return None;
    }
    let n = ring.kinds.len();
    let count = SEGMENTS.min(n.saturating_sub(2) / 2);
    let before = side((0..count).map(|k| reversed(&ring.cubic((i + 2 * n - 1 - k) % n))));
    let after = side((0..count).map(|k| ring.cubic((i + k) % n)));
    let steps = |px: f64| index((px / STEP_PX).ceil());
    let (shortest, longest) = (steps(SHORT_PX), steps(if acute { FAR_PX } else { LOOP_PX }));
    let touches = |k: &usize| {
        let (p, q) = (before[*k].at, before[*k + 1].at);
        // chords that begin in the corner itself meet there
        let pairs = after.iter().zip(after.iter().skip(1)).take(longest);
        let mut pairs = pairs.skip(usize::from(*k == 0));
        let one = acute && *k >= shortest;
        pairs.any(|(a, b)| {
            one && Line::new(a.at, b.at).nearest(p, 0.0).distance_sq < one_px * one_px
                || cross((p, q), (a.at, b.at))
        })
    };
    let count = before.len().saturating_sub(1).min(longest).min(most);
    let first = || (most > 0 && acute && turns(ring, i, (&before, &after))).then_some(0);
    let last = (0..count).rev().find(touches).or_else(first)?;
    let parted = before[last + 1];
    let off = |o: &&Place| o.at.distance(parted.at);
    let near = after.iter().min_by(|a, b| off(a).total_cmp(&off(b)))?;
    Some((last, (parted, *near)))
}

/// Whether the sides of corner `i` have changed places after their first step.
fn turns(ring: &Chain, i: usize, (before, after): (&[Place], &[Place])) -> bool {
    let Some(((u, v), (a, b))) = tip(ring, i).zip(before.get(1).zip(after.get(1))) else {
        return false;
    };
    let at = ring.nodes[i].point;
    (-u).cross(v) * (a.at - at).cross(b.at - at) < 0.0
}

/// Places along curves that follow each other away from a tip.
fn side(curves: impl Iterator<Item = CubicBez>) -> Vec<Place> {
    let mut out = Vec::new();
    let mut gone = 0.0;
    for (segment, c) in curves.enumerate() {
        let length = polygon_px(&c);
        let count = index((length.min(FAR_PX) / STEP_PX).ceil()).max(1);
        let last = length.min(FAR_PX) / length.max(1e-9);
        for k in 0..count {
            let t = last * k as f64 / count as f64;
            out.push(Place {
                segment,
                t,
                at: c.eval(t),
            });
        }
        gone += length;
        if gone > FAR_PX {
            break;
        }
    }
    out
}

/// The ring with a corner where the sides of tip `i` part.
fn cut(ring: &Chain, i: usize, (before, after): (Place, Place)) -> Chain {
    let n = ring.kinds.len();
    let mut out = ring.clone();
    let first = (i + n - 1 - before.segment) % n;
    out.nodes.rotate_left(first);
    out.kinds.rotate_left(first);
    let last = before.segment + 1 + after.segment;
    let a = out.cubic(0).subsegment(0.0..1.0 - before.t);
    let b = out.cubic(last).subsegment(after.t..1.0);
    let node = Node {
        point: before.at.midpoint(after.at),
        join: Join::Corner,
        arrive: unit(arriving(&a)),
        leave: unit(leaving(&b)),
        back: a.p2.distance(a.p3),
        ahead: b.p0.distance(b.p1),
    };
    out.nodes[0].ahead = a.p0.distance(a.p1);
    let end = (last + 1) % n;
    out.nodes[end].back = b.p2.distance(b.p3);
    out.nodes.splice(1..=last, [node]);
    out.kinds.drain(1..last);
    out
}
