//! How much mending a picture is worth: one of noise is wrong everywhere, and each place of it has many structures to
//! try.

use crate::numeric::cast::index;
use std::cell::Cell;

/// Segments that may be fit to pixels, each time that they are, in any picture, and more for a px of its outlines.
/// Letters of 30 to 80 px an em took up to 9,800, of which a px 105; those of 120 to 400 px up to 1.6 a px, but for
/// letters hatched by hand, which want nearly all of this at 150 px; noise took 900 a px.
const MOST: f64 = 40_000.0;
const MOST_PX: f64 = 200.0;

/// The fits that were made, counted by their segments: what takes time is counted, not time, so that the same picture
/// always gives the same outlines.
#[derive(Debug)]
pub(super) struct Budget {
    spent: Cell<usize>,
    most: usize,
}

impl Budget {
    /// What outlines of such a length may take, px.
    pub(super) fn new(length: f64) -> Self {
        Self::of(index(MOST + MOST_PX * length))
    }

    /// So many segments.
    pub(super) const fn of(most: usize) -> Self {
        Self {
            spent: Cell::new(0),
            most,
        }
    }

    /// Takes a fit of so many segments.
    pub(super) fn take(&self, segments: usize) {
        self.spent.set(self.spent.get().saturating_add(segments));
    }

    /// Whether nothing is left.
    pub(super) fn is_spent(&self) -> bool {
        self.over().is_some()
    }

    /// How much more was taken than there was, once that is all.
    pub(super) fn over(&self) -> Option<usize> {
        self.spent.get().checked_sub(self.most)
    }
}
