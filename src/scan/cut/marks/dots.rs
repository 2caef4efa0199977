//! A letter's dots, of what lies on the side on which its name says that it has some.

use super::{COMPACT, ENOUGH, LARGER, NEAR, SMALL, apart, groups, is_compact, is_dot};
use crate::numeric::median::median;
use crate::scan::components::Component;
use crate::scan::cut::{Layer, gap, largest};
use crate::scan::letters::{Pieces, Shape, Side};
use kurbo::Rect;
use std::ptr;

/// Dots are all that a letter has from this share of their usual area on: some are drawn smaller, or as one stroke.
const WHOLE: f64 = 0.6;
/// What is more times as large as all dots of its letter is no dust beside them.
pub(super) const EXTRA: f64 = 2.5;

/// Pieces that lie where a letter has its dots.
pub(super) struct Dots<'a> {
    /// The box of the letter's body.
    body: Rect,
    pieces: Vec<&'a Component>,
    /// Indices of those that are most like its dots, of the page's usual area and near to the body, and their area, px²;
    /// dots that lie close together go together. None where the page does not tell the usual area.
    best: Option<(Vec<usize>, f64)>,
}

impl<'a> Dots<'a> {
    pub(super) fn of(
        shape: &Shape,
        (parts, all): (&[usize], &'a [Component]),
        usual: Option<f64>,
    ) -> Option<Self> {
        let (body, pieces) = dots(shape, parts, all).filter(|_| shape.dots > 0)?;
        let boxes: Vec<Rect> = pieces.iter().map(|c| c.upright).collect();
        let area = |g: &[usize]| g.iter().map(|&i| pieces[i].area).sum::<usize>() as f64;
        let cost = |g: &[usize], usual: f64| {
            let near = g.iter().map(|&i| gap(boxes[i], body));
            let off = near.fold(f64::INFINITY, f64::min) / body.height().max(1.0);
            libm::log(area(g) / (usual * shape.dots as f64)).abs() + off
        };
        let best = usual.and_then(|usual| {
            let groups = match shape.dots {
                1 => (0..boxes.len()).map(|i| vec![i]).collect(),
                _ => groups(&boxes),
            };
            let costs = groups.into_iter().map(|g| (cost(&g, usual), g));
            let (_, best) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
            let area = area(&best);
            Some((best, area))
        });
        Some(Self { body, pieces, best })
    }
}

/// Whether other pieces are rather the dots of its letter: nearer to as large as the page's dots are, and to the
/// body. If they are all that the letter has, what more lies on their side is dust, and so is what is as compact as a
/// dot and no larger anywhere else.
pub(super) fn surplus(c: &Component, shape: &Shape, dots: &Dots<'_>, usual: Option<f64>) -> bool {
    let Some(usual) = usual else {
        return shape.dots == 1 && dots.pieces.iter().any(|o| rather(o, c, dots.body));
    };
    let Some((best, area)) = &dots.best else {
        return false;
    };
    let whole = usual * shape.dots as f64;
    // fewer pieces than dots are all of them only where some touch
    let least = match best.len() < shape.dots {
        true => whole - (1.0 - WHOLE) * usual,
        false => WHOLE * whole,
    };
    let is_own = |o: &Component| o.bounds == c.bounds;
    let most = if dots.pieces.iter().any(|o| is_own(o)) {
        EXTRA * area
    } else {
        usual / LARGER[1].0
    };
    is_dot(c)
        && *area > least
        && !best.iter().any(|&i| is_own(dots.pieces[i]))
        && (c.area as f64) < most
}

/// Whether a piece is rather the one dot of its letter than another: larger, or about as large and nearer to the
/// body.
fn rather(one: &Component, other: &Component, body: Rect) -> bool {
    let off = |o: &Component| gap(o.upright, body);
    let times = one.area as f64 / other.area as f64;
    times >= LARGER[0].0 || (times >= LARGER[1].0 && off(one) < off(other))
}

/// Whether a small piece lies apart from its letter on the other side than its dots or its mark, or beside it.
///
/// Dots are not so far beside a letter, above or below; a mark may be, where it is the only piece.
pub(super) fn opposite(c: &Component, shape: &Shape, parts: &[usize], all: &[Component]) -> bool {
    let Some((side, (body, dots))) = shape.side.zip(dots(shape, parts, all)) else {
        return false;
    };
    let most = parts.iter().map(|&i| all[i].area).max().unwrap_or(0);
    let at = c.upright;
    let (beyond, level) = match side {
        Side::Above => (at.y0 >= body.y1, at.y0 >= body.y0),
        Side::Below => (at.y1 <= body.y0, at.y1 <= body.y1),
    };
    let off = (at.x0 - body.x1).max(body.x0 - at.x1);
    let beside = level && off > at.size().max_side();
    let has_others = dots.iter().any(|o| !ptr::eq(*o, c));
    (has_others && (beyond || beside) || beside && shape.dots > 0)
        && (c.area as f64) < SMALL * most as f64
        && apart(c, parts, all, NEAR)
}

/// The usual area of a dot, px²: the median of those letters of one dot that have one piece where it may be.
pub(super) fn usual_dot(layer: &Layer, all: &[Component]) -> Option<f64> {
    let areas = layer.slots.iter().filter_map(|slot| {
        let shape = slot.shape;
        let (_, dots) = dots(&shape, &slot.parts, all).filter(|_| shape.dots == 1)?;
        let [dot] = dots.as_slice() else {
            return None;
        };
        Some(dot.area as f64)
    });
    let areas: Vec<f64> = areas.collect();
    median(areas.iter().copied()).filter(|_| areas.len() >= ENOUGH)
}

/// The box of a letter's body, and the pieces that lie on the side on which its name says that it has dots or a mark.
pub(super) fn dots<'a>(
    shape: &Shape,
    parts: &[usize],
    all: &'a [Component],
) -> Option<(Rect, Vec<&'a Component>)> {
    let down = match shape.side? {
        Side::Above => -1.0,
        Side::Below => 1.0,
    };
    let main = largest(all, parts)?;
    let body = all[main].upright;
    let rest = parts.iter().filter(|&&i| i != main).map(|&i| &all[i]);
    // dots that touch are one long piece, and pieces of the body lie beside it
    let long = if shape.dots > 1 { 2.0 } else { 1.0 };
    let may_be = |o: &Component| shape.pieces == Pieces::Marked || is_compact(o, long * COMPACT.0);
    let is_there = |o: &&Component| may_be(o) && down * (o.centre.y - body.center().y) > 0.0;
    Some((body, rest.filter(is_there).collect()))
}
