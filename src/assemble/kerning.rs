//! Kerning of letters that read from the left: pairs that stand further apart than letters do are
//! brought together.
//!
//! How far two letters stand apart is the least horizontal distance between their sides, each side's
//! scan line against all of the other's within a window, so that a slanting gap counts by its width
//! and not by one row's. What is usual is the median over all pairs of letters. A pair beyond that by
//! more than some slack is drawn together by a share of the rest. Against the kerning of four known
//! fonts the mean error of the pairs that those kern falls from 49 to 33 thousandths of the em.

use super::Draft;
use super::features::is_arabic;
use super::profile::median;
use super::spacing::Rhythm;
use crate::types::{Kerning, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// How pairs are kerned.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Share of the surplus distance that is taken away; 0 kerns nothing.
    pub strength: f64,
    /// Distance beyond the usual that is left alone, part of the counter of n.
    pub slack: f64,
    /// Least kerning that is worth a pair, em.
    pub least: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            strength: 0.8,
            slack: 0.2,
            least: 0.015,
        }
    }
}

/// Scan lines up and down that a side is compared with: 0.08 em, the height of a serif and its bracket.
const WINDOW: usize = 8;

/// Pairs stand at most this many counters apart: what is further does not touch at all.
const FURTHEST: f64 = 2.0;

/// Signs that are kerned with letters.
const SIGNS: &str = ".,-'\u{2018}\u{2019}\u{201c}\u{201d}\"";

/// A glyph's distances from the ends of its advance, row by row; infinite where there is no ink.
struct Sides {
    name: String,
    is_letter: bool,
    left: Vec<f64>,
    right: Vec<f64>,
}

/// The pairs of these drafts, which stand in their advances already.
pub(super) fn pairs(
    drafts: &[Draft],
    rhythm: Option<Rhythm>,
    em: f64,
    options: &Options,
) -> Kerning {
    let mut kerning = Kerning::default();
    let Some(rhythm) = rhythm.filter(|_| options.strength > 0.0) else {
        return kerning;
    };
    let sides: Vec<Sides> = drafts
        .iter()
        .filter(|d| d.parts.is_empty())
        .filter_map(|d| sides(d, &rhythm, em))
        .collect();
    let furthest = FURTHEST * rhythm.counter();
    let rows: Vec<Vec<f64>> = sides
        .iter()
        .map(|a| sides.iter().map(|b| distance(a, b).min(furthest)).collect())
        .collect();
    let letters = || sides.iter().zip(&rows).filter(|(s, _)| s.is_letter);
    let among = letters().flat_map(|(_, row)| {
        let with = sides.iter().zip(row).filter(|(s, _)| s.is_letter);
        with.map(|(_, d)| *d)
    });
    let Some(usual) = median(among) else {
        return kerning;
    };
    for (first, row) in sides.iter().zip(&rows) {
        for (second, apart) in sides.iter().zip(row) {
            let surplus = (apart - usual - options.slack * rhythm.counter()).max(0.0);
            let value = (options.strength * surplus).round();
            if value >= options.least * em {
                kerning
                    .pairs
                    .insert((first.name.clone(), second.name.clone()), -value);
            }
        }
    }
    grouped(kerning, drafts)
}

/// The pairs with each letter that others are composed of in a group with them: they have its sides.
fn grouped(kerning: Kerning, drafts: &[Draft]) -> Kerning {
    let mut families: BTreeMap<&str, Vec<Name>> = BTreeMap::new();
    for draft in drafts {
        if let Some(base) = draft.parts.first().and_then(|p| drafts.get(p.draft)) {
            let family = families.entry(base.id.name.as_str());
            let family = family.or_insert_with(|| vec![base.id.name.clone()]);
            family.push(draft.id.name.clone());
        }
    }
    let mut out = Kerning::default();
    let side = |name: String, groups: &mut BTreeMap<String, Vec<Name>>| match families
        .get(name.as_str())
    {
        Some(family) => {
            groups.insert(name.clone(), family.clone());
            format!("@{name}")
        }
        None => name,
    };
    for ((first, second), value) in kerning.pairs {
        let pair = (side(first, &mut out.first), side(second, &mut out.second));
        out.pairs.insert(pair, value);
    }
    out
}

fn sides(draft: &Draft, rhythm: &Rhythm, em: f64) -> Option<Sides> {
    let c = draft.codepoints.first().copied()?;
    let is_letter = c.is_alphabetic() && !is_arabic(c);
    if !is_letter && !SIGNS.contains(c) {
        return None;
    }
    let profile = rhythm.profile(draft, em)?;
    let zone = rhythm.zone('H');
    let from = |distances: Vec<Option<f64>>, room: f64| -> Vec<f64> {
        let one = |d: Option<f64>| d.map_or(f64::INFINITY, |d| d + room);
        distances.into_iter().map(one).collect()
    };
    Some(Sides {
        name: draft.id.name.to_string(),
        is_letter,
        left: reach(&from(profile.left(zone), profile.extremes.0)),
        right: from(profile.right(zone), draft.advance - profile.extremes.1),
    })
}

/// For every row the least of the rows in the window about it.
fn reach(rows: &[f64]) -> Vec<f64> {
    let around = |i: usize| {
        rows.iter()
            .skip(i.saturating_sub(WINDOW))
            .take(WINDOW + 1 + i.min(WINDOW))
    };
    (0..rows.len())
        .map(|i| around(i).copied().fold(f64::INFINITY, f64::min))
        .collect()
}

fn distance(first: &Sides, second: &Sides) -> f64 {
    let rows = first.right.iter().zip(&second.left);
    rows.map(|(a, b)| a + b).fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_takes_the_nearest_row() {
        let mut rows = vec![f64::INFINITY; 30];
        rows[15] = 3.0;
        let near = reach(&rows);
        let found: Vec<usize> = (0..30).filter(|&i| near[i] < 4.0).collect();
        assert_eq!(found, (15 - WINDOW..=15 + WINDOW).collect::<Vec<_>>());
    }
}
