//! Where a search must look closer than elsewhere, from what earlier ones found.

use super::{BYTE, Search};
use crate::numeric::cast::index;

/// A stretch of samples: how many times the slack there, and which part of the limit.
#[derive(Debug, Clone, Copy)]
struct Stretch {
    from: f64,
    to: f64,
    slack: f64,
    limit: f64,
}

/// Stretches of a span that need more labels or less room than the rest.
#[derive(Debug, Clone, Default)]
pub(in super::super) struct Care(Vec<Stretch>);

impl Care {
    /// What a label at a sample may cost more than the cheapest beyond it, of so many bytes elsewhere.
    pub(super) fn slack(&self, at: usize, bytes: f64) -> u64 {
        index(self.wider(at) * bytes * BYTE) as u64
    }

    /// How many times the slack at a sample.
    fn wider(&self, at: usize) -> f64 {
        let at = at as f64;
        let here = self.0.iter().filter(|c| (c.from..=c.to).contains(&at));
        here.map(|c| c.slack).fold(1.0, f64::max)
    }
}

impl Search<'_> {
    /// Largest distance between two samples, units.
    pub(super) fn limit(&self, from: f64, to: f64) -> f64 {
        let here = self.care.0.iter().filter(|c| c.from < to && c.to > from);
        self.effort.limit * here.map(|c| c.limit).fold(1.0, f64::min)
    }

    /// More labels where this search came to its end.
    pub(in super::super) fn widened(&self) -> Care {
        /// Stages before the end and after it.
        const AROUND: (usize, usize) = (12, 4);
        /// Factor on the slack, each time.
        const MORE: f64 = 2.0;
        let last = self.stages.len() - 1;
        let stuck = (0..=last)
            .rev()
            .find(|&s| !self.labels.at(s).is_empty())
            .unwrap_or(0);
        let at = |s: usize| self.stages[s.min(last)].at as f64;
        let mut care = self.care.clone();
        let slack = MORE * self.care.wider(self.stages[stuck].at);
        let from = at(stuck.saturating_sub(AROUND.0));
        care.0.push(Stretch {
            from,
            to: at(stuck + AROUND.1),
            slack,
            limit: 1.0,
        });
        care
    }

    /// Less room where a path strayed: what the search measures there is only so large a part of the truth.
    pub(in super::super) fn tightened(&self, strays: &[((f64, f64), f64)]) -> Care {
        /// Part of the limit that is left at least.
        const LEAST: f64 = 0.3;
        let mut care = self.care.clone();
        care.0
            .extend(strays.iter().map(|&((from, to), part)| Stretch {
                from,
                to,
                slack: 1.0,
                limit: part.max(LEAST),
            }));
        care
    }
}
