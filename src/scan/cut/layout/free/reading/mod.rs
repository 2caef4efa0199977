//! Pieces in reading order + names → which pieces are letters, and of which name: one choice for the whole page.
//!
//! Every piece is a letter, a part of one beside it, dirt, or a letter without a name; every name has one letter, in
//! order, or none. What a name says about its letter's size and dots makes some of these likely, and the least sum of
//! costs is taken: the shortest path through pieces and names, as sequences are aligned. A cost of 1 is strong doubt.

mod costs;
mod others;
mod table;
#[cfg(test)]
mod tests;

pub(super) use costs::unwanted;

use crate::scan::letters::Shape;
use costs::steps;
use others::{margins, without_a_letter, without_a_name};
use std::ops::RangeInclusive;
use table::{Table, rest};

/// Names are in doubt where another reading costs less than this more.
const DOUBT: f64 = 0.2;
/// A page's letters look like their names where each costs less than this in the mean: on 150 pages that are rightly
/// read at most 0.31, where each letter is drawn in a dozen pieces 1.0.
const UNLIKE: f64 = 0.6;
/// A name is in doubt, and one too many, where a page of a name fewer would be likelier by more than this: of 174
/// pages that are rightly read two are by 0.9 and 1.0, and the next one by 0.6.
const SPARE: (f64, f64) = (0.7, 1.1);

/// The names of a page's letters, in order.
#[derive(Debug, Clone, Copy)]
pub(super) struct Names<'a> {
    /// What each says of its letter, `None` where nothing at all is known of it.
    pub(super) shapes: &'a [Option<Shape>],
    /// How many stand in each line, where lines are taken for the page's rows; else nothing.
    pub(super) lines: &'a [usize],
}

impl Names<'_> {
    /// Whether a row may begin after so many names.
    fn begins(&self, names: usize) -> bool {
        let after = |sum: &mut usize, line: &usize| {
            *sum += line;
            Some(*sum)
        };
        let mut ends = self.lines.iter().scan(0, after);
        names == 0 || self.lines.is_empty() || ends.any(|end| end == names)
    }
}

/// What is seen of a piece.
#[derive(Debug, Clone, Copy)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "observations, each by itself"
)]
pub(super) struct Seen {
    /// How much of a full letter it is by its size, 0 to 1.
    pub(super) full: f64,
    /// Whether it is less than a dot, or as small as one and beside a letter.
    pub(super) slight: bool,
    /// Whether smaller pieces lie over it.
    pub(super) above: bool,
    /// Whether smaller pieces lie below it.
    pub(super) below: bool,
    /// Whether smaller pieces lie within its bounds: dots of bowls do, whose letters have them on either side.
    pub(super) inside: bool,
    /// The larger piece that it may be a part of.
    pub(super) body: Option<Body>,
    /// Whether it lies within the bounds of its body.
    pub(super) within: bool,
    /// Whether it may be dirt.
    pub(super) dirt: bool,
    /// Whether it is the first of its row.
    pub(super) first: bool,
    /// How many letters that touch each other it may be at most.
    pub(super) letters: usize,
}

/// A larger piece beside one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Body {
    /// How far it is, in usual sizes.
    pub(super) off: f64,
    /// Whether it is read before its part.
    pub(super) before: bool,
    /// Where its part lies.
    pub(super) sign: Side,
}

/// Where the middle of a sign lies, by that of its letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::scan::cut::layout) enum Side {
    Over,
    Under,
}

/// What a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// The letter of a name.
    Letter(usize),
    /// Letters that touch: the first one's name, and how many they are.
    Touching(usize, usize),
    /// A part of a letter beside it.
    Part,
    /// No ink of a letter's.
    Dirt,
    /// A letter without a name.
    Nameless,
}

/// A page as it is read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    /// What each piece is.
    pub(super) roles: Vec<Role>,
    /// Names without a letter, in order, each with the number of pieces read before it.
    pub(super) missing: Vec<(usize, usize)>,
    /// The sum of all costs.
    pub(super) cost: f64,
    /// How much likelier this reading is than the best one in which a piece is something else, of each piece.
    pub(super) margins: Vec<f64>,
    /// The names without one of which it would be likeliest, and by how much likelier.
    spare: Option<(RangeInclusive<usize>, f64)>,
    /// The letters without one of which it would be likeliest: the first and the last piece.
    extra: Option<RangeInclusive<usize>>,
}

impl Reading {
    /// Whether all letters have names and all names letters, and most look like that.
    pub(super) fn agrees(&self) -> bool {
        let nameless = self.roles.contains(&Role::Nameless);
        self.missing.is_empty() && !nameless && !self.is_unlike()
    }

    /// The pieces from one to another of which one letter has no name, where that is all that does not agree.
    pub(super) fn nameless(&self) -> Option<RangeInclusive<usize>> {
        let nameless = self.roles.iter().filter(|r| **r == Role::Nameless).count();
        let only = nameless == 1 && self.missing.is_empty();
        self.extra.clone().filter(|_| only)
    }

    /// The names from one to another of which one has no letter, where that is all that does not agree.
    pub(super) fn letterless(&self) -> Option<RangeInclusive<usize>> {
        let only = self.missing.len() == 1 && !self.roles.contains(&Role::Nameless);
        self.spare.as_ref().filter(|_| only).map(|s| s.0.clone())
    }

    /// Whether its letters hardly look like their names.
    pub(super) fn is_unlike(&self) -> bool {
        let named = |r: &&Role| matches!(r, Role::Letter(_) | Role::Touching(..));
        let letters = self.roles.iter().filter(named).count();
        self.cost > UNLIKE * letters as f64
    }

    /// Names of which one seems to be too many, though a piece was found for each.
    pub(super) fn spare(&self) -> Option<RangeInclusive<usize>> {
        let spare = self.spare.as_ref().filter(|s| s.1 > SPARE.1);
        spare.map(|s| s.0.clone())
    }

    /// The names of which it is not much likelier that each is a letter's than that this is something else, or that
    /// there is none.
    pub(super) fn doubtful(&self) -> Vec<usize> {
        let doubtful = self.roles.iter().zip(&self.margins);
        let doubtful = doubtful.filter_map(|(role, margin)| match role {
            Role::Letter(k) if *margin < DOUBT => Some(*k),
            _ => None,
        });
        let spare = self.spare.as_ref().filter(|s| s.1 > SPARE.0);
        let spare = spare.map(|s| *s.0.start());
        doubtful.chain(spare).collect()
    }
}

/// Reads pieces and names together.
pub(super) fn align(pieces: &[Seen], names: Names<'_>) -> Reading {
    let count = names.shapes.len();
    let mut table = Table::new(pieces.len(), count);
    for i in 0..=pieces.len() {
        for j in 0..=count {
            let here = table.cost[i * table.width + j];
            for (step, to, cost) in steps(pieces, names, (i, j)) {
                table.step(to, step, here + cost);
            }
        }
    }
    let mut reading = table.reading(pieces.len(), count);
    let rest = rest(pieces, names);
    reading.margins = margins((pieces, names), &table, &rest, &reading);
    reading.spare = without_a_name((pieces, names), &table, &rest, &reading);
    reading.extra = without_a_letter(names, &table, &rest, &reading);
    reading
}
