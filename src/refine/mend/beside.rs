//! The outlines beside a part, and how often it crosses them or itself.

use crate::{
    numeric::chain::Chain,
    refine::{crossings::Chords, curves::polygon},
};
use kurbo::{Point, Rect};
use std::iter::once;

/// Chords leave a part by no more than this, px.
const CHORD_PX: f64 = 0.001;

/// What does not move around an open part of a path.
#[derive(Debug)]
pub(super) struct Beside {
    chords: Chords,
    bounds: Rect,
    /// how often the part as it was crosses them or itself
    most: usize,
}

impl Beside {
    /// What of `lines` lies within `bounds`, around a part as it was.
    pub(super) fn new<'r>(
        lines: impl Iterator<Item = &'r [Point]>,
        part: &Chain,
        bounds: Rect,
    ) -> Self {
        let mut beside = Self {
            chords: Chords::new(lines, Some(bounds)),
            bounds,
            most: 0,
        };
        beside.most = beside.crossed(part);
        beside
    }

    /// Whether a part in the place of the one that was there crosses no more.
    pub(super) fn is_clear(&self, part: &Chain) -> bool {
        self.crossed(part) <= self.most
    }

    fn crossed(&self, part: &Chain) -> usize {
        let part = polygon(&part.to_path(), CHORD_PX);
        let part = Chords::new(once(&*part), Some(self.bounds));
        self.chords.crossed_by(&part) + part.crossings().len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::BezPath;

    #[test]
    fn a_part_is_clear_that_crosses_no_more_than_before() {
        let chain = |text: &str| Chain::from_path(&BezPath::from_svg(text).unwrap(), 0.0175);
        let part = |text: &str| {
            let chain = chain(text).unwrap();
            let count = chain.kinds.len() - 1;
            chain.part(0..count)
        };
        let line = [Point::new(0.0, 5.0), Point::new(20.0, 5.0)];
        let bounds = Rect::new(0.0, 0.0, 20.0, 20.0);
        let below = part("M1 1L10 4L19 1L19 -1Z");
        let beside = Beside::new([line.as_slice()].into_iter(), &below, bounds);
        assert!(beside.is_clear(&below));
        assert!(!beside.is_clear(&part("M1 1L10 6L19 1L19 -1Z")));
        // itself
        assert!(!beside.is_clear(&part("M1 1L14 4L14 2L6 4L19 1L19 -1Z")));
        // what crossed already may
        let through = part("M1 1L10 6L19 1L19 -1Z");
        let beside = Beside::new([line.as_slice()].into_iter(), &through, bounds);
        assert!(beside.is_clear(&through));
    }
}
