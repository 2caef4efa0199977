//! Pairs of Arabic letters that do not join.

use super::groups::group;
use super::{Options, WINDOW, least, reach};
use crate::assemble::Draft;
use crate::assemble::profile::Profile;
use crate::numeric::median::median;
use crate::types::{Kerning, Name};

/// Arabic letters stand at most so many times the usual apart.
const FURTHEST: f64 = 2.0;

/// Slack between Arabic letters in slacks of the counter, whose part of the usual gap it is.
const SLACK: f64 = 1.6;

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

/// Adds them.
pub(super) fn add<'d>(drafts: &'d [Draft], em: f64, options: &Options, out: &mut Kerning) {
    let letters = || drafts.iter().filter(|d| d.is_arabic_letter());
    let ends = letters().filter(|d| d.never_joins());
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
        edge.rows = reach(&edge.rows, WINDOW);
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
        return;
    };
    let value = |a: usize, b: usize| {
        let (a, b) = (&firsts[a], &seconds[b]);
        // text programs tell by encoded letters which way a pair reads
        if a.is_ligature && b.is_ligature {
            return 0.0;
        }
        let far = apart(a, b).min(FURTHEST * usual);
        options.strength * (far - (1.0 + SLACK * options.slack) * usual)
    };
    let names = |edges: &[Edge<'d>]| -> Vec<&'d Name> { edges.iter().map(|e| e.name).collect() };
    let (first, second) = (names(&firsts), names(&seconds));
    group((&first, &second), value, em, options.least * em, out);
}
