//! Letters that are drawn in many pieces: stencils, clocks, shadows, dots.

use super::{ENOUGH, REACH, SAME, is_close, is_dot};
use crate::numeric::cast::index;
use crate::numeric::median::median;
use crate::scan::components::Component;
use crate::scan::cut::{Layer, gap, largest};
use crate::scan::letters::{Pieces, Shape};
use crate::types::Label;

/// Of a letter of many dots, which a pen draws in one piece, what lies so many times as far from the next dot as is
/// usual is none: dots on a slope are 1.4 times as far apart as those along a line.
const STRAYED: f64 = 3.0;
/// Strokes that are drawn alike have sides that differ by this factor at most.
const LIKE: f64 = 1.25;

/// Whether most letters that a pen draws in one piece are drawn in several that lie close together, like a stencil's
/// or a clock's, or in many alike: then only what lies apart is dust, or is less than those.
pub(in crate::scan::cut) fn in_pieces<'a>(
    letters: impl Iterator<Item = (&'a Label, &'a [usize])>,
    all: &[Component],
) -> bool {
    let asked = letters.filter(|l| Shape::of(l.0).pieces == Pieces::One);
    let parted = asked.filter_map(|(_, parts)| {
        let body = largest(all, parts)?;
        let mut others = parts.iter().filter(|&&i| i != body);
        let close = others.any(|&i| is_close(&all[i], &all[body]));
        Some(close || is_scattered(body, parts, all))
    });
    let parted: Vec<bool> = parted.collect();
    let most = parted.iter().filter(|p| **p).count();
    parted.len() >= ENOUGH && 2 * most > parted.len()
}

/// Gives strokes too small to be told from dust by their size to the letters of many pieces by which they lie: they go
/// to the end of `all`. They are long, and others on the page are like them; dust is neither.
pub(super) fn give_strokes(layer: &mut Layer, all: &mut Vec<Component>, small: Vec<Component>) {
    let letters = layer.slots.iter().map(|s| (&s.label, s.parts.as_slice()));
    if small.is_empty() || !in_pieces(letters, all) {
        return;
    }
    let is_drawn = |c: &Component| {
        let alike = all.iter().chain(&small).filter(|o| is_like(c, o));
        // a piece is like itself, too
        !is_dot(c) && alike.take(ENOUGH + 1).count() > ENOUGH
    };
    let owner = |c| is_drawn(c).then(|| owner(layer, all, c)).flatten();
    let owners: Vec<Option<usize>> = small.iter().map(owner).collect();
    for (c, slot) in small.into_iter().zip(owners) {
        if let Some(slot) = slot {
            layer.slots[slot].parts.push(all.len());
            all.push(c);
        }
    }
}

/// Whether two pieces are as long and as wide, or one of them is the other.
fn is_like(a: &Component, b: &Component) -> bool {
    let like = |a: f64, b: f64| a.max(b) <= LIKE * a.min(b);
    like(a.upright.width(), b.upright.width()) && like(a.upright.height(), b.upright.height())
}

/// The letter by which a piece lies nearest, if it lies by one.
fn owner(layer: &Layer, all: &[Component], c: &Component) -> Option<usize> {
    let off = |parts: &[usize]| {
        let off = parts.iter().map(|&i| gap(all[i].upright, c.upright));
        off.min_by(f64::total_cmp)
    };
    let slots = layer.slots.iter().enumerate();
    let near = slots.filter_map(|(s, slot)| Some((s, off(&slot.parts)?)));
    let (s, off) = near.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let body = largest(all, &layer.slots[s].parts)?;
    (off < REACH * all[body].upright.height()).then_some(s)
}

/// Whether pieces about as large as a letter's largest one have more ink than it: it is no body, but one of many.
pub(super) fn is_scattered(body: usize, parts: &[usize], all: &[Component]) -> bool {
    let others = parts.iter().filter(|&&i| i != body).map(|&i| all[i].area);
    let alike = others.filter(|&area| area >= one_of_many(&all[body]));
    alike.sum::<usize>() > all[body].area
}

/// The area of pieces that are about as large as a letter's largest one at least, px².
pub(super) fn one_of_many(largest: &Component) -> usize {
    index(largest.area as f64 / SAME)
}

/// Of a letter of many pieces those that are far from all others.
pub(super) fn strayed(parts: &[usize], all: &[Component]) -> Vec<usize> {
    let to_next = parts.iter().filter_map(|&i| {
        let others = parts.iter().filter(|&&j| j != i);
        let off = others.map(|&j| (all[i].centre - all[j].centre).hypot());
        Some((i, off.min_by(f64::total_cmp)?))
    });
    let to_next: Vec<(usize, f64)> = to_next.collect();
    let usual = median(to_next.iter().map(|n| n.1)).unwrap_or(0.0);
    let far = to_next.into_iter().filter(|n| n.1 > STRAYED * usual);
    far.map(|n| n.0).collect()
}
