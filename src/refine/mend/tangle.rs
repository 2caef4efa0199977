//! Outlines that cross each other or themselves, and did not before they were mended.
//!
//! On the way to what explains a picture best they may: what crosses there is mostly cut off, or pulled apart again,
//! and few places are mended as well without that.

use super::{MOST, Ring, Work, rings};
use crate::refine::crossings::Chords;
use kurbo::{BezPath, Rect};

/// Whether outlines may cross that did not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Crossing {
    OnTheWay,
    Never,
}

impl Work<'_> {
    /// Mends those rings once more that cross and did not in `paths`, now without crossing on the way. Noise crosses
    /// everywhere, and stays.
    pub(super) fn untangle(&mut self, paths: &[BezPath]) {
        let mut tangled = crossings(&self.rings);
        let count = tangled.len();
        if count == 0 || count > MOST {
            return;
        }
        let first = rings(paths);
        let drawn = crossings(&first);
        tangled.retain(|pair| !drawn.contains(pair));
        let again = |k: usize| tangled.iter().flatten().any(|t| *t == k);
        if tangled.is_empty() {
            return;
        }
        let before = (self.chains.clone(), self.rings.clone());
        for (k, ring) in first.into_iter().enumerate() {
            if again(k) {
                (self.chains[k], self.rings[k]) = (ring.chain(), ring);
            } else {
                // those stay
                self.chains[k] = None;
            }
        }
        self.redraw_all();
        self.vain.clear();
        self.crossing = Crossing::Never;
        self.mend();
        let (chains, rings) = before;
        if crossings(&self.rings).len() >= count {
            (self.chains, self.rings) = (chains, rings);
            return;
        }
        for (k, chain) in chains.into_iter().enumerate().filter(|(k, _)| !again(*k)) {
            self.chains[k] = chain;
        }
    }

    /// How often outlines cross there or anywhere, if that counts.
    pub(super) fn crossed(&self, bounds: Option<Rect>) -> usize {
        match self.crossing {
            Crossing::OnTheWay => 0,
            Crossing::Never => {
                let near = |r: &&Ring| bounds.is_none_or(|b| r.bounds.overlaps(b));
                let lines = self.rings.iter().filter(near).map(|r| r.chords.as_slice());
                Chords::new(lines, bounds).crossings().len()
            }
        }
    }
}

/// The crossings of rings, as pairs of their indices.
fn crossings(rings: &[Ring]) -> Vec<[usize; 2]> {
    Chords::new(rings.iter().map(|r| r.chords.as_slice()), None).crossings()
}
