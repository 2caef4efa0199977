//! Dots and accents that are smaller than dust may be, and dust that is as large as dots: names tell them apart.
//!
//! Heavy styles have dots half as wide as their strokes.
//! Ink below the speckle limit is too much like dust to be shared out with the letters. But a letter whose name says that
//! it has dots or an accent takes the largest such piece beside it, and those like it, unless it has larger ones already;
//! and one that is drawn in one piece has none of them, whatever lies beside it.

use super::{Layer, Reason, gap};
use crate::scan::components::Component;
use crate::scan::letters::{Pieces, Shape};
use glyphs_reader::glyphdata::GlyphData;
use kurbo::Rect;

/// Area of a dot beside that of the largest of the letter's dots at least: two of three may touch.
const ALIKE: f64 = 0.3;
/// How far a dot stands off its letter, as a share of the height of the letter's body.
const REACH: f64 = 0.75;

/// Takes ink smaller than a dot out of the letters that have none; what a user gave to a letter stays.
pub(super) fn dust(layer: &mut Layer, all: &[Component], claims: &[(usize, Vec<usize>)], dot: f64) {
    let names = GlyphData::default();
    for slot in &mut layer.slots {
        let claimed = claims.iter().any(|c| c.0 == slot.index);
        if claimed || Shape::of(&slot.label, &names).pieces != Pieces::One {
            continue;
        }
        let body = slot.parts.iter().copied().max_by_key(|&i| all[i].area);
        let large = |&i: &usize| Some(i) == body || all[i].area as f64 >= dot;
        let (kept, small): (Vec<usize>, Vec<usize>) = slot.parts.iter().partition(|i| large(i));
        slot.parts = kept;
        let small = small.into_iter().map(|i| (i, Reason::Dirt));
        layer.rejected.extend(small);
    }
}

/// Gives small pieces of ink, in no slot so far, to the letters that want them: they go to the end of `all`. Returns how many.
pub(super) fn give(layer: &mut Layer, all: &mut Vec<Component>, small: Vec<Component>) -> usize {
    let names = GlyphData::default();
    let bodies: Vec<Option<Rect>> = (layer.slots.iter())
        .map(|s| s.parts.iter().max_by_key(|&&i| all[i].area))
        .map(|body| body.map(|&i| all[i].upright))
        .collect();
    let mut wanted: Vec<Vec<Component>> = vec![Vec::new(); layer.slots.len()];
    for c in small {
        let near = (0..bodies.len()).filter_map(|s| Some((s, gap(bodies[s]?, c.upright))));
        let nearest = near.min_by(|a, b| a.1.total_cmp(&b.1));
        let close = |&(s, gap): &(usize, f64)| bodies[s].is_some_and(|b| gap < REACH * b.height());
        if let Some((s, _)) = nearest.filter(close) {
            wanted[s].push(c);
        }
    }
    let before = all.len();
    for (slot, pieces) in layer.slots.iter_mut().zip(wanted) {
        let marked = matches!(
            Shape::of(&slot.label, &names).pieces,
            Pieces::DotAbove | Pieces::DotBelow | Pieces::Marked
        );
        let mut areas: Vec<usize> = slot.parts.iter().map(|&i| all[i].area).collect();
        areas.sort_unstable();
        areas.pop();
        areas.extend(pieces.iter().map(|c| c.area));
        let dot = areas.into_iter().max().unwrap_or(0) as f64;
        for c in pieces {
            if marked && c.area as f64 > ALIKE * dot {
                slot.parts.push(all.len());
                all.push(c);
            }
        }
    }
    all.len() - before
}
