//! Kerning: pairs that stand further apart than letters do are brought together. Of letters that read from the left
//! all are looked at but capitals after small letters, which no word has; of Arabic ones those that never join the
//! next, with all that can follow them.
//!
//! How far two Latin letters stand apart is a mean over the scan lines on which both have ink, of the power −5 of the
//! gap: near places count for more than wide ones, yet one near place, such as a crossbar, does not hide the white
//! beside it. Each side's scan line is held against three of the other's up and down, so that a slanting gap counts
//! by its width. What is usual is the median over all pairs of letters. A pair beyond that by more than some slack is
//! drawn together by a share of the rest, but no ink nearer to other ink than half of what is usual. Beside the
//! kerning of nine fonts the mean error of the pairs that those kern falls from 44 to 24 thousandths of the em (28 by
//! the least gap alone). Of Arabic letters the least gap tells how far they stand apart.
//!
//! Letters whose kerning with each side opposite lies within 0.02 em form a group, which has the middle of it.

mod arabic;
mod groups;
mod rightward;

use super::Draft;
use super::spacing::Rhythm;
use crate::types::Kerning;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How pairs are kerned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Share of the surplus distance that is taken away; 0 kerns nothing.
    #[serde(deserialize_with = "super::ranges::share")]
    pub strength: f64,
    /// Distance beyond the usual that is left alone, part of the counter of n.
    #[serde(deserialize_with = "super::ranges::up")]
    pub slack: f64,
    /// Least kerning that is worth a pair, em.
    #[serde(deserialize_with = "super::ranges::share")]
    pub least: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            strength: 0.8,
            slack: 0.25,
            least: 0.015,
        }
    }
}

/// And for the least gap, the height of a serif and its bracket: 0.08 em.
const WINDOW: usize = 8;

/// The pairs of these drafts, which stand in their advances already.
pub(super) fn pairs(
    drafts: &[Draft],
    rhythm: Option<Rhythm>,
    em: f64,
    options: &Options,
) -> Kerning {
    let mut kerning = Kerning::default();
    if options.strength > 0.0 {
        rightward::add(drafts, rhythm, em, options, &mut kerning);
        arabic::add(drafts, em, options, &mut kerning);
    }
    kerning
}

/// For every row the least of the rows in the window about it.
fn reach(rows: &[f64], window: usize) -> Vec<f64> {
    let around = |i: usize| {
        rows.iter()
            .skip(i.saturating_sub(window))
            .take(window + 1 + i.min(window))
    };
    (0..rows.len())
        .map(|i| around(i).copied().fold(f64::INFINITY, f64::min))
        .collect()
}

/// The least sum of two sides' distances.
fn least(first: &[f64], second: &[f64]) -> f64 {
    let rows = first.iter().zip(second);
    rows.map(|(a, b)| a + b).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_takes_the_nearest_row() {
        let mut rows = vec![f64::INFINITY; 30];
        rows[15] = 3.0;
        let near = reach(&rows, WINDOW);
        let found: Vec<usize> = (0..30).filter(|&i| near[i] < 4.0).collect();
        assert_eq!(found, (15 - WINDOW..=15 + WINDOW).collect::<Vec<_>>());
    }
}
