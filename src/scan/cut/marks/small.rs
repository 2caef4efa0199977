//! Small parts of letters: dots and accents.

use crate::scan::components::Component;
use crate::scan::cut::gap;

/// A part smaller than this share of the largest part of its cell is a dot or an accent.
pub(in crate::scan::cut) const SMALL: f64 = 0.4;

/// The small parts that belong together with one of them, as two or three dots do: each nearer to another than
/// it is large.
pub(in crate::scan::cut) fn group<'a>(
    all: &[Component],
    part: usize,
    others: impl Iterator<Item = &'a usize>,
) -> Vec<usize> {
    let size = |i: usize| all[i].upright.size().max_side();
    let mut left: Vec<usize> = others.copied().filter(|&i| i != part).collect();
    let mut found = vec![part];
    let mut next = 0;
    while let Some(&i) = found.get(next) {
        let with = |j: &usize| gap(all[i].upright, all[*j].upright) < size(i).min(size(*j));
        let (near, far): (Vec<usize>, Vec<usize>) = left.into_iter().partition(with);
        found.extend(near);
        left = far;
        next += 1;
    }
    found
}
