//! Several drawings of one glyph.

use super::average;
use super::letter::Letter;
use super::problem::Problem;
use crate::assemble::{Note, names};
use crate::numeric::distance::{Polyline, chords};
use crate::scan;
use crate::types::{Cell, Label, Name};
use kurbo::Shape;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// What becomes of glyphs that are drawn more than once.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Repeated {
    /// Of the drawings in as many pieces as their letter has, the one whose edge strays least from its smooth outline is
    /// taken.
    #[default]
    Best,
    /// The drawing in the middle of them: laid upon each other, the edge runs where the median of them does.
    Median,
    /// The first is the glyph, the others are its alternates in the stylistic sets `ss01`, `ss02` …; where the letter
    /// repeats within three letters they follow each other (`calt`).
    Alternates,
    /// They are an error.
    Error,
}

/// Chords of outlines leave their curves by no more than this, px.
const CHORD_PX: f64 = 0.05;
/// Stylistic sets of OpenType.
const SETS: usize = 20;

/// Letters with each glyph drawn once.
pub(super) struct Settled {
    /// In the order of the first drawings.
    pub(super) letters: Vec<Letter>,
    /// What was decided.
    pub(super) notes: Vec<Note>,
    /// The feature by which alternates follow each other.
    pub(super) features: String,
}

/// Settles what is drawn more than once; `draw` traces a cell.
///
/// # Errors
/// What `draw` says, or drawings have no middle.
pub(super) fn settle(
    mut letters: Vec<Letter>,
    repeated: Repeated,
    draw: impl Fn(&Letter, Cell) -> Result<Letter, Problem>,
) -> Result<Settled, Problem> {
    let mut drawings: BTreeMap<Name, Vec<usize>> = BTreeMap::new();
    for (i, letter) in letters.iter().enumerate() {
        if let Ok(identity) = names::identify(&letter.label) {
            drawings.entry(identity.name).or_default().push(i);
        }
    }
    drawings.retain(|_, all| all.len() > 1);
    let (mut out, mut notes, mut rings) = (BTreeSet::new(), Vec::new(), Vec::new());
    for (name, all) in &drawings {
        let note = |message: String| Note {
            glyph: name.to_string(),
            message: format!("drawn {} times; {message}", all.len()),
        };
        if repeated == Repeated::Alternates {
            let mut ring = vec![name.to_string()];
            for (set, &i) in all.iter().skip(1).take(SETS).enumerate() {
                ring.push(format!("{name}.ss{:02}", set + 1));
                letters[i].label = Label(format!("{name}.ss{:02}", set + 1));
            }
            let rest = all.iter().skip(SETS + 1).copied();
            if rest.len() > 0 {
                notes.push(note(format!(
                    "there are {SETS} stylistic sets, and the last {} drawings are left out",
                    rest.len()
                )));
            }
            out.extend(rest);
            rings.push(ring);
            continue;
        }
        let plain = all.iter().all(|&i| letters[i].plates.is_empty());
        let cell = (repeated == Repeated::Median && plain)
            .then(|| average::middle(&all.iter().map(|&i| &letters[i]).collect::<Vec<_>>()))
            .transpose()?;
        if let Some(cell) = cell.flatten() {
            let first = all[0];
            letters[first] = draw(&letters[first], cell)?;
            out.extend(all.iter().skip(1).copied());
            notes.push(note("the one in the middle of them is taken".to_owned()));
            continue;
        }
        let noise = |&i: &usize| noise(&letters[i]);
        let best = whole(&letters, all)
            .into_iter()
            .min_by(|a, b| noise(a).total_cmp(&noise(b)));
        out.extend(all.iter().copied().filter(|&i| Some(i) != best));
        notes.extend(best.map(|i| {
            let place = letters[i].spot();
            note(format!(
                "the drawing with the calmest edge is taken, {place}"
            ))
        }));
    }
    let kept = letters
        .into_iter()
        .enumerate()
        .filter(|(i, _)| !out.contains(i));
    let letters: Vec<Letter> = kept.map(|(_, letter)| letter).collect();
    let features = rotation(&rings, &letters);
    Ok(Settled {
        letters,
        notes,
        features,
    })
}

/// The feature that puts the next drawing of a letter where the same one stands shortly before; empty for none.
fn rotation(rings: &[Vec<String>], letters: &[Letter]) -> String {
    if rings.is_empty() {
        return String::new();
    }
    let names = letters
        .iter()
        .filter_map(|l| names::identify(&l.label).ok());
    let names: BTreeSet<String> = names.map(|n| n.name.to_string()).collect();
    let names: Vec<String> = names.into_iter().collect();
    let mut out = format!("\n@drawn = [{}];\nfeature calt {{\n", names.join(" "));
    for ring in rings {
        let base = &ring[0];
        for between in ["", "@drawn ", "@drawn @drawn "] {
            for pair in ring.windows(2) {
                out += &format!("    sub {} {between}{base}' by {};\n", pair[0], pair[1]);
            }
            // after the last one comes the first again
            if let Some(last) = ring.last() {
                out += &format!("    ignore sub {last} {between}{base}';\n");
            }
        }
    }
    out + "} calt;\n"
}

/// Those of some drawings that are in as many pieces as their label says, or as most: a dot that a small picture does
/// not show leaves the calmest edge.
fn whole(letters: &[Letter], drawings: &[usize]) -> Vec<usize> {
    let told = drawings
        .first()
        .and_then(|&i| scan::pieces(&letters[i].label));
    let mut by_pieces: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for &i in drawings {
        by_pieces.entry(pieces(&letters[i])).or_default().push(i);
    }
    let right = told.into_iter().flat_map(|told| by_pieces.range(told));
    let right: Vec<usize> = right.flat_map(|(_, all)| all).copied().collect();
    if !right.is_empty() {
        return right;
    }
    let most = by_pieces.values().map(Vec::len).max();
    let usual = by_pieces
        .into_values()
        .filter(|all| Some(all.len()) == most);
    usual.flatten().collect()
}

/// How many pieces a drawing is in: contours that run as the largest one does.
fn pieces(letter: &Letter) -> usize {
    let areas: Vec<f64> = letter.paths.iter().map(Shape::area).collect();
    let largest = areas
        .iter()
        .copied()
        .max_by(|a, b| a.abs().total_cmp(&b.abs()));
    let alike = |area: &&f64| largest.is_some_and(|largest| **area * largest > 0.0);
    areas.iter().filter(alike).count()
}

/// Root mean square distance of the scanned edge from the outline, as a share of the em.
fn noise(letter: &Letter) -> f64 {
    let rings = letter.paths.iter().map(|p| chords(p, CHORD_PX));
    let lines: Vec<Polyline> = rings.filter_map(Polyline::new).collect();
    let distances = letter.edge.iter().flat_map(|c| c.points()).map(|&p| {
        let each = lines.iter().map(|l| l.nearest(p).distance);
        each.fold(f64::INFINITY, f64::min)
    });
    let (sum, n) = distances.fold((0.0, 0usize), |(s, n), d| (s + d * d, n + 1));
    (sum / n.max(1) as f64).sqrt() / letter.guides.px_per_em
}
