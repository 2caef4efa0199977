//! Fewer control points than a search found: its run fitted anew with one less, as long as that takes fewer bytes.
//!
//! A search knows the control points that the curve's own tangents ask for. The fewest lie elsewhere: here
//! they move freely until the largest distance is least, and are then rounded one after the other while
//! those that are left give way. What comes out is measured as closely as any answer.

mod chain;
mod fit;

use super::curve::{Curve, Node};
use super::glyf::{Pen, Stored};
use super::search::{Effort, is_ahead, smooth};
use super::{Strictness, assemble};
use chain::Chain;
use fit::Fit;
use kurbo::{Point, QuadBez, Vec2};
use std::iter;

/// The points from a node to the next, both included, with as few control points between as fit.
pub(super) fn open(
    curve: &Curve,
    effort: Effort,
    ends: [Node; 2],
    points: Vec<Stored>,
) -> Vec<Stored> {
    let may_move = ends
        .iter()
        .any(|n| n.along.is_none() && n.free != Vec2::ZERO);
    let fewer = |points: &[Stored]| {
        let settled = |ends| settled(curve, effort, Chain::open(curve, ends, points)?);
        // Corners where the search has put them, then where they may move.
        let held = [
            ends[0].held(*points.first()?),
            ends[1].held(*points.last()?),
        ];
        settled(held).or_else(|| settled(ends).filter(|_| may_move))
    };
    let bytes = |points: &[Stored]| {
        let (&first, rest) = points.split_first()?;
        let mut pen = Pen::after(first);
        Some(rest.iter().map(|&p| pen.store(p)).sum())
    };
    fewest((curve, effort), points, fewer, bytes)
}

/// The points of a ring, with as few as fit.
pub(super) fn ring(curve: &Curve, effort: Effort, points: Vec<Stored>) -> Vec<Stored> {
    let fewer = |points: &[Stored]| settled(curve, effort, Chain::ring(points)?);
    let bytes = |points: &[Stored]| Some(assemble::bytes(points));
    fewest((curve, effort), points, fewer, bytes)
}

/// The cheapest of a run and of what ever fewer points make of it.
fn fewest(
    (curve, effort): (&Curve, Effort),
    points: Vec<Stored>,
    fewer: impl Fn(&[Stored]) -> Option<Vec<Stored>>,
    bytes: impl Fn(&[Stored]) -> Option<u32>,
) -> Vec<Stored> {
    let passes_extrema = effort.keep == Strictness::Corners || curve.gates.is_empty();
    if !passes_extrema {
        return points;
    }
    let all = iter::successors(Some(points), |p| fewer(p));
    all.min_by_key(|p| bytes(p)).unwrap_or_default()
}

/// The points of a chain, fitted and rounded; none where that does not come near enough.
fn settled(curve: &Curve, effort: Effort, chain: Chain) -> Option<Vec<Stored>> {
    let mut fit = Fit::new(curve, chain);
    fit.freely(effort.limit)?;
    for spot in fit.chain.order() {
        if fit.chain.round(spot) {
            fit.again(effort.limit)?;
        }
    }
    holds(&mut fit, curve, effort).then(|| fit.chain.stored())
}

/// Whether a rounded chain is smooth at its ends and nowhere beyond the limit.
fn holds(fit: &mut Fit<'_>, curve: &Curve, effort: Effort) -> bool {
    /// Part of the limit that the dense measure may use: it looks between its samples no closer.
    const SURE: f64 = 0.998;
    let limit = effort.limit;
    let near = fit.worst() <= SURE * limit && fit.keeps_lines(SURE * effort.beside * limit);
    if !(near && fit.chain.leaves_well()) {
        return false;
    }
    let last = fit.chain.many() - 1;
    (0..=last).all(|quad| {
        let [a, c, b] = fit.chain.quad(quad);
        let (mut from, mut to) = fit.stretch(quad);
        // Between corners all of the curve counts, wherever the ends' feet lie.
        let [starts, ends] = fit.chain.corners();
        if quad == 0 && starts {
            from = curve.first as f64;
        }
        if quad == last && ends {
            to = curve.last as f64;
        }
        from < to && curve.strays(QuadBez::new(a, c, b), from, to) <= SURE * limit
    })
}
