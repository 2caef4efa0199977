//! The coverage from which ink counts, one at which printed lines hold together.
//!
//! Thin lines of a page out of focus are pale. Where they are as pale as that level they fall to pieces, and with
//! them what their lattice tells: the pieces pass for parts of the letters that they touch.

use super::sieve::{LATTICE_COVER, LINE};
use crate::scan::components::{Component, LOW, SEED, components};
use crate::types::Gray;

/// Coverage from which ink counts where printed lines are broken at [`LOW`] and whole at this.
const FAINT: f32 = 0.24;
/// Standard deviations of noise that these levels keep from the paper.
const NOISE: f32 = 6.0;
/// Length from which a thin or hollow piece may be a broken lattice's, as a share of the longer side of all ink.
const FRAGMENT: f64 = 0.1;

/// A page's pieces of ink, and the coverage from which they are connected; `noise` is the paper's.
pub(super) fn pieces(gray: &Gray, noise: f32) -> (f32, Vec<Component>) {
    let from = |level: f32| {
        let low = level.max(NOISE * noise);
        (low, components(gray, low, SEED.max(low)))
    };
    let usual = from(LOW);
    let fragments = fragments(&usual.1);
    if fragments.is_empty() {
        return usual;
    }
    let faint = from(FAINT);
    let side = side(&faint.1);
    let lattice = faint.1.iter().find(|c| is_lattice(c, side));
    let is_its = |c: &Component| {
        let first = c.pixels().next();
        first.is_some_and(|(x, y)| lattice.is_some_and(|l| l.covers(x, y)))
    };
    if fragments.into_iter().any(is_its) {
        faint
    } else {
        usual
    }
}

/// Thin or hollow pieces that may be parts of a broken lattice; none where one is whole.
fn fragments(all: &[Component]) -> Vec<&Component> {
    let side = side(all);
    if all.iter().any(|c| is_lattice(c, side)) {
        return Vec::new();
    }
    let is_part = |c: &&Component| {
        let size = c.bounds.size();
        let thin = size.min_side() < LINE.1 * side;
        size.max_side() > FRAGMENT * side && (thin || is_hollow(c))
    };
    all.iter().filter(is_part).collect()
}

fn is_lattice(c: &Component, side: f64) -> bool {
    c.bounds.size().min_side() > LINE.0 * side && is_hollow(c)
}

fn is_hollow(c: &Component) -> bool {
    (c.area as f64) < LATTICE_COVER * c.bounds.area()
}

/// The longer side of all ink, px.
fn side(all: &[Component]) -> f64 {
    let ink = all.iter().map(|c| c.bounds).reduce(|a, b| a.union(b));
    ink.map_or(0.0, |b| b.size().max_side())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bars in cells whose lines have a coverage, and another one in the middle of each cell's side.
    fn page(line: f32, middle: f32) -> Gray {
        let of = |across: usize, along: usize| match (across % 100, along % 100) {
            (0..4, 45..55) => middle,
            (0..4, _) => line,
            _ => 0.0,
        };
        Gray::from_fn(700, 500, |x, y| {
            let is_bar = (30..40).contains(&(x % 100)) && (30..80).contains(&(y % 100));
            let paper = (1.0 - of(x, y)) * (1.0 - of(y, x));
            if is_bar { 1.0 } else { 1.0 - paper }
        })
    }

    #[test]
    fn ink_counts_from_where_printed_lines_hold_together() {
        for (line, middle, wanted, lattices) in [
            (0.36, 0.30, FAINT, 1),
            // whole, too pale to be seen at all, and seen where they cross alone
            (0.36, 0.36, LOW, 1),
            (0.28, 0.28, LOW, 0),
            (0.31, 0.31, LOW, 0),
        ] {
            let (low, ink) = pieces(&page(line, middle), 0.0);
            assert!((low - wanted).abs() < 1e-6, "{line}, {middle}: {low}");
            let side = side(&ink);
            let found = ink.iter().filter(|c| is_lattice(c, side)).count();
            assert_eq!(found, lattices, "{line}, {middle}");
        }
    }
}
