//! Signs that lie in no letter's cell, or in another's, go to letters that have none.

use super::dots::{EXTRA, dots, usual_dot};
use super::{REACH, is_dot};
use crate::scan::components::Component;
use crate::scan::cut::{Layer, Reason, Slot, gap, largest};
use crate::scan::letters::{Pieces, Shape};
use kurbo::Rect;

/// Letters without their dots, of all that have some, from which on names may have slipped.
const MANY: f64 = 0.25;

/// Gives letters that have none of the signs which their names say what lies beside the grid, close over or under
/// them.
pub(in crate::scan::cut) fn reclaim(layer: &mut Layer, all: &[Component]) {
    for slot in &mut layer.slots {
        let pieces = slot.shape.pieces;
        let &[body] = slot.parts.as_slice() else {
            continue;
        };
        if matches!(
            pieces,
            Pieces::One | Pieces::Unknown | Pieces::Within | Pieces::Bare
        ) {
            continue;
        }
        let own = &all[body];
        let is_sign = |&(i, reason): &(usize, Reason)| {
            let sign = &all[i];
            let over = sign.upright.x0 < own.upright.x1 && sign.upright.x1 > own.upright.x0;
            let near = gap(sign.upright, own.upright) < REACH * own.upright.height();
            reason == Reason::Outside && over && near && sign.area < own.area
        };
        let signs = layer.rejected.extract_if(.., |r| is_sign(r));
        slot.parts.extend(signs.map(|s| s.0));
    }
}

/// Gives letters that have none of their dots those which lie there in another letter's cell, where that one's name
/// has none: rows may be so close that a dot is nearer to the row before.
pub(in crate::scan::cut) fn restore(
    layer: &mut Layer,
    all: &[Component],
    claims: &[(usize, Vec<usize>)],
) {
    let usual = usual_dot(layer, all).unwrap_or(f64::INFINITY);
    let claimed = |s: &Slot| claims.iter().any(|c| c.0 == s.index);
    let found = layer.slots.iter().enumerate();
    let found = found.filter_map(|(k, slot)| {
        let (body, dots) = dots(&slot.shape, &slot.parts, all).filter(|_| slot.shape.dots > 0)?;
        Some((k, body, dots.is_empty() && !claimed(slot)))
    });
    let dotted: Vec<(usize, Rect, bool)> = found.collect();
    let lacking = dotted.iter().filter(|d| d.2);
    if lacking.clone().count() as f64 > MANY * dotted.len() as f64 {
        return;
    }
    let mut moves = Vec::new();
    for &(to, body, _) in lacking {
        let lacks = &layer.slots[to].shape;
        for (from, slot) in layer.slots.iter().enumerate() {
            let main = largest(all, &slot.parts);
            let Some(main) = main.filter(|_| from != to && !claimed(slot)) else {
                continue;
            };
            let is_own = |i: &usize| {
                let (c, own) = (&all[*i], all[main].upright);
                let here = is_beyond(c, body, lacks) && (c.area as f64) < EXTRA * usual;
                *i != main && here && !wants(&slot.shape, c, own)
            };
            let given = slot.parts.iter().filter(|i| is_own(i));
            moves.extend(given.map(|&i| (gap(all[i].upright, body), i, from, to)));
        }
    }
    moves.sort_by(|a, b| a.0.total_cmp(&b.0));
    for (_, part, from, to) in moves {
        // of two letters the nearer one has it
        if let Some(k) = layer.slots[from].parts.iter().position(|&p| p == part) {
            layer.slots[from].parts.remove(k);
            layer.slots[to].parts.push(part);
        }
    }
}

/// Whether a compact piece lies over the body of a letter whose dots are there, or under it.
fn is_beyond(c: &Component, body: Rect, shape: &Shape) -> bool {
    let over = c.upright.x0 < body.x1 && c.upright.x1 > body.x0;
    let far = match shape.pieces {
        Pieces::DotAbove => body.y0 - c.upright.y1,
        Pieces::DotBelow => c.upright.y0 - body.y1,
        _ => return false,
    };
    is_dot(c) && over && (0.0..REACH * body.height()).contains(&far)
}

/// Whether a letter's name has a piece on that side of its body, or may have any.
fn wants(shape: &Shape, c: &Component, body: Rect) -> bool {
    match shape.pieces {
        Pieces::One | Pieces::Bare | Pieces::Within => body.contains(c.centre),
        Pieces::DotAbove => c.centre.y < body.y1,
        Pieces::DotBelow => c.centre.y > body.y0,
        Pieces::Marked | Pieces::Unknown => true,
    }
}
