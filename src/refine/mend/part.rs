//! Parts of a ring: taken out as open chains to be fit, and put back.

use crate::numeric::{
    chain::{Chain, Join},
    joins::{aim, soften_if_soft},
};
use kurbo::{CubicBez, Rect, Shape};

/// A handle of a corner that is shorter, px, does not show how it turns.
const HIDDEN_PX: f64 = 1.0;

/// What the curves of a ring that another lacks take up, before and after, px.
pub(super) fn changed(before: &Chain, after: &Chain) -> Option<Rect> {
    let curves = |c: &Chain| (0..c.kinds.len()).map(|i| c.cubic(i)).collect::<Vec<_>>();
    let (before, after) = (curves(before), curves(after));
    let both = [lacking(&before, &after), lacking(&after, &before)];
    both.into_iter().flatten().reduce(|a, b| a.union(b))
}

/// What the curves take up that are not among others, px. After one that is, the next is looked for first where it
/// would follow: a ring of noise has too many to look through them all for each.
fn lacking(curves: &[CubicBez], others: &[CubicBez]) -> Option<Rect> {
    let mut next = 0;
    let is_new = |c: &&CubicBez| {
        let (before, after) = others.split_at(next);
        let found = after.iter().chain(before).position(|o| o == *c);
        next = found.map_or(next, |k| (next + k + 1) % others.len());
        found.is_none()
    };
    let new = curves.iter().filter(is_new);
    new.map(CubicBez::bounding_box).reduce(|a, b| a.union(b))
}

/// How far the control points of two curves are apart at most, px.
fn apart(a: &CubicBez, b: &CubicBez) -> f64 {
    let pairs = [(a.p0, b.p0), (a.p1, b.p1), (a.p2, b.p2), (a.p3, b.p3)];
    pairs
        .iter()
        .map(|(p, q)| p.distance(*q))
        .fold(0.0, f64::max)
}

/// A ring that begins with segment `start`.
pub(super) fn begun_at(chain: &Chain, start: usize) -> Chain {
    let mut ring = chain.clone();
    ring.nodes.rotate_left(start);
    ring.kinds.rotate_left(start);
    ring
}

/// The first segments of a ring as an open chain whose ends stay.
pub(super) fn open_part(chain: &Chain, count: usize) -> Chain {
    let mut part = chain.part(0..count);
    for i in [0, count] {
        let join = &mut part.nodes[i].join;
        *join = if *join == Join::Corner {
            Join::End
        } else {
            Join::Clamped
        };
    }
    part
}

/// The ring with its first `count` segments as they are in `part`, and by how much its control points stray from
/// that, px.
pub(super) fn put_back(mut chain: Chain, part: Chain, count: usize) -> Option<(Chain, f64)> {
    let n = chain.kinds.len();
    let inner = (0..part.kinds.len()).map(|i| part.cubic(i));
    let wanted: Vec<CubicBez> = inner.chain((count..n).map(|i| chain.cubic(i))).collect();
    let (mut nodes, kinds) = (part.nodes, part.kinds);
    let last = nodes.pop()?;
    let own = chain.nodes[0];
    let first = nodes.first_mut()?;
    first.join = own.join;
    let end = if count < n {
        (first.arrive, first.back) = (own.arrive, own.back);
        let node = &mut chain.nodes[count];
        (node.arrive, node.back) = (last.arrive, last.back);
        kinds.len()
    } else {
        (first.arrive, first.back) = (last.arrive, last.back);
        0
    };
    chain.nodes.splice(0..count, nodes);
    chain.kinds.splice(0..count, kinds);
    for i in [0, end] {
        if chain.nodes[i].join == Join::Corner {
            aim(&mut chain, i, HIDDEN_PX);
        }
        soften_if_soft(&mut chain, i);
    }
    chain.settle();
    // a line takes what is beside it along
    let strayed = |(i, c): (usize, &CubicBez)| apart(c, &chain.cubic(i));
    let strayed = wanted.iter().enumerate().map(strayed).fold(0.0, f64::max);
    (chain.to_path().is_finite()).then_some((chain, strayed))
}
