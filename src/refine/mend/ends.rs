//! Corners whose ends are cut off by a short line, as some designers draw them, and those that are rounds.

use super::side::unit;
use crate::numeric::angles::angle;
use crate::{
    numeric::chain::{Chain, Join},
    refine::{
        curves::{arriving, leaving},
        residual::{Blot, Residual},
    },
};
use kurbo::Point;
use std::ops::Range;

/// What of a corner's end the pixels are asked about, px along each side.
const END_PX: f64 = 1.0;
/// The line across an end is as long, px: a shorter one mends what a corner's model is off by. Each of its corners
/// turns by more, radians.
const LINE_PX: Range<f64> = 0.75..4.0;
const TURN: f64 = 0.3;
/// A round in place of a corner leaves none so near, px.
const ROUND_PX: f64 = 4.0;

/// By how much squares would fall without the end of a chain's corner `i`; nothing where that is no corner, negative
/// where there is more of it than the chain has.
pub(super) fn hint(residual: &Residual<'_>, chain: &Chain, i: usize) -> f64 {
    let sides = chain.before(i).zip(chain.after(i));
    let sides = sides.filter(|_| chain.nodes[i].join == Join::Corner);
    sides.map_or(0.0, |(before, after)| {
        let u = unit(arriving(&chain.cubic(before)));
        let v = unit(leaving(&chain.cubic(after)));
        let tip = chain.nodes[i].point;
        let cut = [tip - END_PX * u, tip + END_PX * v];
        // ink lies to the left: a corner that turns left holds it
        -u.cross(v).signum() * residual.gain(&Blot::between(tip, &cut, unit(v - u)))
    })
}

/// Whether nodes `i` and the next are corners with a short line between them, to which both turn the same way.
pub(super) fn is_blunt(chain: &Chain, i: usize) -> bool {
    let (Some(a), Some(b)) = (chain.nodes.get(i), chain.nodes.get(i + 1)) else {
        return false;
    };
    let sides = chain.before(i).zip(chain.after(i + 1));
    let Some((before, after)) = sides.filter(|_| [a, b].iter().all(|n| n.join == Join::Corner))
    else {
        return false;
    };
    let line = b.point - a.point;
    let first = angle(arriving(&chain.cubic(before)), line);
    let last = angle(line, leaving(&chain.cubic(after)));
    LINE_PX.contains(&line.hypot()) && first * last > 0.0 && first.abs().min(last.abs()) > TURN
}

/// Moves nodes `i` and the next along their sides until the line between them is square to the way between those; nothing
/// where they are no such corners.
pub(super) fn square(chain: &mut Chain, i: usize) -> Option<()> {
    let ends = [*chain.nodes.get(i)?, *chain.nodes.get(i + 1)?];
    let (before, after) = chain.before(i).zip(chain.after(i + 1))?;
    if ends.iter().any(|n| n.join != Join::Corner) {
        return None;
    }
    let u = unit(arriving(&chain.cubic(before)));
    let v = unit(leaving(&chain.cubic(after)));
    let axis = unit(u - v);
    let [near, far] = ends.map(|n| n.point.to_vec2().dot(axis));
    for (k, along, depth) in [(i, u, near), (i + 1, v, far)] {
        let by = (0.5 * (near + far) - depth) / along.dot(axis);
        chain.nodes[k].point += by * along;
    }
    Some(())
}

/// Whether a chain has no corner near `at`.
pub(super) fn is_round(chain: &Chain, at: Point) -> bool {
    let mut corners = chain.nodes.iter().filter(|n| n.join == Join::Corner);
    corners.all(|n| n.point.distance(at) > ROUND_PX)
}
