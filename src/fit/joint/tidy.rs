//! Last touches to welded spans: joins that turned out smooth, and curves that end where they are level.

use super::cost::inner_extrema;
use super::found::Found;
use crate::numeric::chain::{Chain, Join, Kind};
use kurbo::{ParamCurve, Vec2};

/// A corner that turns less after the fit is a smooth join that the blur hid, radians: below, designers mean one.
const SOFT: f64 = 0.44;
/// Directions so near to an axis are on it, radians.
const LEVEL: f64 = 0.02;
/// No corner is smoothed that this moves a point further off than it was, px.
const GIVE_PX: f64 = 0.25;
/// A curve that turns back so near to its corner is meant to end where it is level: chords, and px.
const BESIDE: (f64, f64) = (0.25, 6.0);
/// By how much it turns back at most, px.
const DEPTH_PX: f64 = 0.3;

/// Makes corners smooth that hardly turn, where the points allow it.
pub(super) fn smooth(found: &mut Found) {
    let soft: Vec<usize> = (0..found.chain.nodes.len())
        .filter(|&i| is_soft(&found.chain, i))
        .collect();
    if soft.is_empty() {
        return;
    }
    if !smoothed(found, &soft) && soft.len() > 1 {
        for i in soft {
            smoothed(found, &[i]);
        }
    }
}

/// Makes the joins of some nodes smooth; leaves all as it was, and says so, where a span's points do not allow it.
fn smoothed(found: &mut Found, soft: &[usize]) -> bool {
    let (chain, feet, worst) = (found.chain.clone(), found.feet.clone(), found.worst());
    for &i in soft {
        let node = &mut found.chain.nodes[i];
        let along = node.arrive + node.leave;
        let along = along / along.hypot();
        node.join = if along.y.abs() < LEVEL {
            Join::Horizontal
        } else if along.x.abs() < LEVEL {
            Join::Vertical
        } else {
            Join::Smooth
        };
        (node.arrive, node.leave) = (along, along);
    }
    found.settle(20, 1e-3);
    let better = found.chain.to_path().is_finite()
        && found
            .worst()
            .iter()
            .zip(worst)
            .all(|(now, was)| *now <= was + GIVE_PX);
    if !better {
        (found.chain, found.feet) = (chain, feet);
    }
    better
}

/// Whether a corner of which one side at least is curved turns too little to be one.
fn is_soft(chain: &Chain, i: usize) -> bool {
    let curved = |s| chain.kind(s) == Some(Kind::Cubic);
    let direction = |s: Option<usize>, own: Vec2| match s {
        Some(s) if chain.kinds[s] == Kind::Line => chain.direction(s),
        _ => own,
    };
    let (before, after) = (chain.before(i), chain.after(i));
    let node = &chain.nodes[i];
    let (u, v) = (direction(before, node.arrive), direction(after, node.leave));
    node.join == Join::Corner
        && (curved(before) || curved(after))
        && u.cross(v).atan2(u.dot(v)).abs() < SOFT
}

/// Turns curves that pass an extremum just before a corner so that they end in it: nothing was measured there.
pub(super) fn level_ends(chain: &mut Chain) {
    for i in 0..chain.kinds.len() {
        if chain.kinds[i] == Kind::Cubic {
            level_end(chain, i);
        }
    }
}

fn level_end(chain: &mut Chain, i: usize) {
    let c = chain.cubic(i);
    let (a, b) = chain.ends(i);
    for (t, join) in inner_extrema(&c) {
        let at = c.eval(t);
        let (node, end) = if t > 0.5 { (b, c.p3) } else { (a, c.p0) };
        let off = end - at;
        let (depth, along) = match join {
            Join::Horizontal => (off.y.abs(), Vec2::new(1.0, 0.0)),
            _ => (off.x.abs(), Vec2::new(0.0, 1.0)),
        };
        let near = (BESIDE.0 * c.p0.distance(c.p3)).min(BESIDE.1);
        let node = &mut chain.nodes[node];
        if node.join != Join::Corner || depth > DEPTH_PX || off.hypot() > near {
            continue;
        }
        if t > 0.5 {
            node.arrive = along * 1f64.copysign(node.arrive.dot(along));
        } else {
            node.leave = along * 1f64.copysign(node.leave.dot(along));
        }
    }
}
