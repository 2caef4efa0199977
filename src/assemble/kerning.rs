//! Kerning: pairs that stand further apart than letters do are brought together. Of letters that read from the left all
//! are looked at, of Arabic ones those that never join the next, with all that can follow them.
//!
//! How far two letters stand apart is the least horizontal distance between their sides, each side's
//! scan line against all of the other's within a window, so that a slanting gap counts by its width
//! and not by one row's. What is usual is the median over all pairs of letters. A pair beyond that by
//! more than some slack is drawn together by a share of the rest. Against the kerning of four known
//! fonts the mean error of the pairs that those kern falls from 49 to 33 thousandths of the em.
//!
//! Letters that are composed of another are kerned with it, as a group. Arabic letters with like edges form groups too, whose
//! pairs are drawn together by what suits all of their members.

use super::Draft;
use super::features::is_arabic;
use super::profile::Profile;
use super::spacing::Rhythm;
use crate::numeric::median::median;
use crate::types::{Kerning, Name};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use unicode_joining_type::{JoiningType, get_joining_type};

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
    if options.strength <= 0.0 {
        return Kerning::default();
    }
    let mut kerning = rightward(drafts, rhythm, em, options);
    let leftward = arabic(drafts, em, options);
    kerning.first.extend(leftward.first);
    kerning.second.extend(leftward.second);
    kerning.pairs.extend(leftward.pairs);
    kerning
}

/// The pairs of letters that read from the left.
fn rightward(drafts: &[Draft], rhythm: Option<Rhythm>, em: f64, options: &Options) -> Kerning {
    let mut kerning = Kerning::default();
    let Some(rhythm) = rhythm else {
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

/// Rows as far apart as this at most are one edge, em.
const LIKE: f64 = 0.01;

/// A side of an Arabic letter: distances from the end of its advance, row by row; infinite where there is no ink.
struct Edge<'a> {
    name: &'a Name,
    is_ligature: bool,
    rows: Vec<f64>,
}

impl<'d> Edge<'d> {
    fn of(draft: &'d Draft, em: f64, rows: impl Fn(&Profile) -> Vec<Option<f64>>) -> Option<Self> {
        let profile = Profile::of(&draft.outline, em, 0.0, 0.0)?;
        let rows = rows(&profile).into_iter();
        Some(Self {
            name: &draft.id.name,
            is_ligature: draft.id.chars.len() > 1,
            rows: rows.map(|r| r.unwrap_or(f64::INFINITY)).collect(),
        })
    }
}

/// The pairs of Arabic letters that do not join.
fn arabic(drafts: &[Draft], em: f64, options: &Options) -> Kerning {
    let letters = || {
        let is_one = |d: &&Draft| {
            let first = d.id.chars.first().copied().filter(|c| is_arabic(*c));
            first.is_some_and(char::is_alphabetic) && !d.is_mark()
        };
        drafts.iter().filter(is_one)
    };
    let never_joins = |d: &&Draft| {
        let last = d.id.chars.last();
        last.is_some_and(|c| get_joining_type(*c) == JoiningType::RightJoining)
    };
    let ends = letters().filter(never_joins);
    let firsts: Vec<Edge<'_>> = ends
        .filter_map(|d| Edge::of(d, em, Profile::lefts))
        .collect();
    let second = |d| {
        let mut edge = Edge::of(d, em, |p| {
            let room = d.advance - p.extremes.1;
            p.rights()
                .into_iter()
                .map(|r| r.map(|r| r + room))
                .collect()
        })?;
        edge.rows = reach(&edge.rows);
        Some(edge)
    };
    let seconds: Vec<Edge<'_>> = letters()
        .filter(|d: &&Draft| d.joint.1.is_none())
        .filter_map(second)
        .collect();
    let apart = |a: &Edge<'_>, b: &Edge<'_>| least(&a.rows, &b.rows);
    let all = firsts
        .iter()
        .flat_map(|a| seconds.iter().map(|b| apart(a, b)));
    let Some(usual) = median(all).filter(|u| u.is_finite() && *u > 0.0) else {
        return Kerning::default();
    };
    let value = |a: &Edge<'_>, b: &Edge<'_>| {
        // text programs tell by encoded letters which way a pair reads
        if a.is_ligature && b.is_ligature {
            return 0.0;
        }
        let far = apart(a, b).min(FURTHEST * usual);
        options.strength * (far - (1.0 + 2.0 * options.slack) * usual).max(0.0)
    };
    let (firsts, seconds) = (groups(&firsts, usual, em), groups(&seconds, usual, em));
    let mut out = Kerning::default();
    for a in &firsts {
        for b in &seconds {
            let values = a.iter().flat_map(|a| b.iter().map(|b| value(a, b)));
            let value = values.fold(f64::INFINITY, f64::min).round();
            if value >= options.least * em {
                let pair = (side(a, &mut out.first), side(b, &mut out.second));
                out.pairs.insert(pair, -value);
            }
        }
    }
    out
}

/// Edges that lie on each other, the first of each group leading it.
fn groups<'e, 'd>(edges: &'e [Edge<'d>], usual: f64, em: f64) -> Vec<Vec<&'e Edge<'d>>> {
    let far = FURTHEST * usual;
    let alike = |a: &Edge<'_>, b: &Edge<'_>| {
        let mut rows = a.rows.iter().zip(&b.rows);
        rows.all(|(a, b)| (a.min(far) - b.min(far)).abs() <= LIKE * em)
    };
    let mut out: Vec<Vec<&Edge<'_>>> = Vec::new();
    for edge in edges {
        let found = out
            .iter_mut()
            .find(|g| g.first().is_some_and(|first| alike(first, edge)));
        match found {
            Some(group) => group.push(edge),
            None => out.push(vec![edge]),
        }
    }
    out
}

/// What a group is called in a pair; one of several is put among the groups by its first name.
fn side(group: &[&Edge<'_>], groups: &mut BTreeMap<String, Vec<Name>>) -> String {
    let leader = group.first().map_or(String::new(), |e| e.name.to_string());
    if group.len() < 2 {
        return leader;
    }
    let members = group.iter().map(|e| e.name.clone());
    groups.insert(leader.clone(), members.collect());
    format!("@{leader}")
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
    least(&first.right, &second.left)
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
        let near = reach(&rows);
        let found: Vec<usize> = (0..30).filter(|&i| near[i] < 4.0).collect();
        assert_eq!(found, (15 - WINDOW..=15 + WINDOW).collect::<Vec<_>>());
    }
}
