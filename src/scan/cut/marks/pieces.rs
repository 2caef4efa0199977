//! Letters that are drawn in many pieces: stencils, clocks, dots.

use super::{ENOUGH, SAME, is_close};
use crate::numeric::cast::index;
use crate::numeric::median::median;
use crate::scan::components::Component;
use crate::scan::cut::largest;
use crate::scan::letters::{Pieces, Shape};
use crate::types::Label;

/// Of a letter of many dots, which a pen draws in one piece, what lies so many times as far from the next dot as is
/// usual is none: dots on a slope are 1.4 times as far apart as those along a line.
const STRAYED: f64 = 3.0;

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
