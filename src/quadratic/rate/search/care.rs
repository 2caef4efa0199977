//! Where a search must look closer than elsewhere, from what earlier ones found.

use super::super::curve::{count, whole};
use super::{BYTE, Search};

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

impl Search<'_> {
    /// What a label at a stage may cost more than the cheapest beyond it.
    pub(super) fn slack(&self, stage: usize) -> u64 {
        whole(self.wider(stage) * self.effort.slack * BYTE) as u64
    }

    /// How many times the slack at a stage.
    fn wider(&self, stage: usize) -> f64 {
        let at = count(self.stages[stage].at);
        let here = self.care.0.iter().filter(|c| (c.from..=c.to).contains(&at));
        here.map(|c| c.slack).fold(1.0, f64::max)
    }

    /// Largest distance between two samples, units.
    pub(super) fn limit(&self, from: f64, to: f64) -> f64 {
        let here = self.care.0.iter().filter(|c| c.from < to && c.to > from);
        self.effort.limit * here.map(|c| c.limit).fold(1.0, f64::min)
    }

    /// More labels where this search came to its end.
    pub(in super::super) fn widened(&self) -> Care {
        /// Stages before the end and after it.
        const AROUND: (usize, usize) = (24, 8);
        /// Factor on the slack, each time.
        const MORE: f64 = 3.0;
        let last = self.stages.len() - 1;
        let stuck = (0..=last)
            .rev()
            .find(|&s| !self.labels.at(s).is_empty())
            .unwrap_or(0);
        let at = |s: usize| count(self.stages[s.min(last)].at);
        let mut care = self.care.clone();
        let slack = MORE * self.wider(stuck);
        let from = at(stuck.saturating_sub(AROUND.0));
        care.0.push(Stretch {
            from,
            to: at(stuck + AROUND.1),
            slack,
            limit: 1.0,
        });
        care
    }

    /// Less room where a path strayed.
    pub(in super::super) fn tightened(&self, strays: &[((f64, f64), f64)]) -> Care {
        /// Factors on the limit, each time.
        const LESS: (f64, f64) = (0.7, 0.97);
        let mut care = self.care.clone();
        for &((from, to), part) in strays {
            let limit = part.clamp(LESS.0, LESS.1) * self.limit(from, to) / self.effort.limit;
            care.0.push(Stretch {
                from,
                to,
                slack: 2.0,
                limit,
            });
        }
        care
    }
}
