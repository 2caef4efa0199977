//! The free numbers of a few nodes.

use crate::numeric::chain::{Chain, Join, Kind};
use kurbo::Vec2;

/// No node moves further in a step, px, no direction turns more, radians, and no handle changes by a larger part.
const STRIDE_PX: f64 = 1.0;
const SWING: f64 = 0.4;
const STRETCH: f64 = 0.5;
/// The shortest handle, px.
const SHORTEST_PX: f64 = 0.02;

/// A number of a node.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Number {
    X,
    Y,
    /// direction of both sides
    Turn,
    Arrive,
    Leave,
    Back,
    Ahead,
}

/// The free numbers of an open chain.
pub(super) fn numbers(chain: &Chain) -> Vec<(usize, Number)> {
    let mut out = Vec::new();
    for (i, node) in chain.nodes.iter().enumerate() {
        let cubic = |s| chain.kind(s) == Some(Kind::Cubic);
        let (before, after) = (cubic(chain.before(i)), cubic(chain.after(i)));
        if !node.join.is_fixed() {
            out.extend([(i, Number::X), (i, Number::Y)]);
        }
        match node.join {
            Join::Smooth if chain.line_beside(i).is_none() => out.push((i, Number::Turn)),
            Join::Corner | Join::End | Join::Loose => {
                out.extend(before.then_some((i, Number::Arrive)));
                out.extend(after.then_some((i, Number::Leave)));
            }
            _ => {}
        }
        out.extend(before.then_some((i, Number::Back)));
        out.extend(after.then_some((i, Number::Ahead)));
    }
    out
}

pub(super) fn nudge(chain: &mut Chain, (i, number): (usize, Number), by: f64) {
    let node = &mut chain.nodes[i];
    let turn = |v: &mut Vec2| {
        let (sin, cos) = libm::sincos(by);
        *v = Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y);
    };
    match number {
        Number::X => node.point.x += by,
        Number::Y => node.point.y += by,
        Number::Turn => {
            turn(&mut node.arrive);
            turn(&mut node.leave);
        }
        Number::Arrive => turn(&mut node.arrive),
        Number::Leave => turn(&mut node.leave),
        Number::Back => node.back = (node.back + by).max(SHORTEST_PX),
        Number::Ahead => node.ahead = (node.ahead + by).max(SHORTEST_PX),
    }
}

/// Shortens a step that goes too far.
pub(super) fn shorten(chain: &Chain, numbers: &[(usize, Number)], step: &mut [f64]) {
    let most = |&(i, number): &(usize, Number)| match number {
        Number::X | Number::Y => STRIDE_PX,
        Number::Turn | Number::Arrive | Number::Leave => SWING,
        Number::Back => (STRETCH * chain.nodes[i].back).max(STRIDE_PX),
        Number::Ahead => (STRETCH * chain.nodes[i].ahead).max(STRIDE_PX),
    };
    let part = numbers
        .iter()
        .zip(&*step)
        .map(|(number, by)| most(number) / by.abs().max(1e-12))
        .fold(1.0, f64::min);
    step.iter_mut().for_each(|by| *by *= part);
}
