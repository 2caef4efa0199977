//! Letters whose dots are fewer or more than their names have, and Arabic ones without their hamza or madda: these
//! may lie in another cell, or the letter be another.
//!
//! What a hand's dots are like, its own letters tell: where two or three are drawn as one dash, no dash may be
//! missing.

use crate::numeric::median::{median, middle};
use crate::scan::components::Component;
use crate::scan::cut::{Slot, Warning};
use crate::scan::letters::{Kind, Pieces, Shape};

/// So many letters of as many dots tell what a hand's dots are like, where this share of them have as many pieces
/// beside their bodies.
const TELL: usize = 3;
const ALIKE: f64 = 0.8;
/// What has less than this part of a usual sign's ink is dust, and what has more than the second is no single one.
const SIGN: (f64, f64) = (0.3, 1.6);

/// What stands over or under a letter's body.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Signs {
    Dots(usize),
    /// A hamza or a madda.
    Mark,
}

/// A letter whose name has signs.
struct Signed<'a> {
    slot: &'a Slot,
    wanted: Signs,
    /// Ink of each piece but the largest, px²: signs, and dust beside them.
    drawn: Vec<f64>,
}

impl Signs {
    /// Those of a letter; `None` where its name has none, or others.
    fn of(shape: &Shape) -> Option<Self> {
        let marked = shape.kind == Kind::Arabic && shape.pieces == Pieces::Marked;
        match shape.dots {
            0 => marked.then_some(Self::Mark),
            dots => Some(Self::Dots(dots)),
        }
    }

    const fn count(self) -> usize {
        match self {
            Self::Dots(dots) => dots,
            Self::Mark => 1,
        }
    }
}

impl<'a> Signed<'a> {
    fn new(slot: &'a Slot, all: &[Component]) -> Option<Self> {
        let wanted = Signs::of(&slot.shape)?;
        let mut drawn: Vec<f64> = slot.parts.iter().map(|&i| all[i].area as f64).collect();
        drawn.sort_by(|a, b| b.total_cmp(a));
        drawn.drain(..drawn.len().min(1));
        Some(Self {
            slot,
            wanted,
            drawn,
        })
    }

    /// What is said of it beside usual letters of its kind.
    fn odd(&self, usual: &Usual) -> Option<Warning> {
        let one = usual.ink / usual.count as f64;
        let signs = self.drawn.iter().filter(|s| **s > SIGN.0 * one);
        let (count, ink): (usize, f64) = (signs.clone().count(), signs.sum());
        let half = usual.ink / (2.0 * self.wanted.count() as f64);
        let fewer = count < usual.count && ink < usual.ink - half;
        let are_single = self.drawn.iter().all(|s| *s < SIGN.1 * one);
        let more = count > usual.count && ink > usual.ink + half && are_single;
        let kind = match self.wanted {
            Signs::Mark => "a hamza or madda".to_owned(),
            Signs::Dots(1) => "one dot".to_owned(),
            Signs::Dots(n) => format!("{n} dots"),
        };
        let signs = |n: usize| match n {
            0 => "no sign".to_owned(),
            1 => "one sign".to_owned(),
            n => format!("{n} signs"),
        };
        let (has, have) = (signs(count), signs(usual.count));
        let message = format!(
            "it has {has} beside its body where this page's letters with {kind} have {have}: does one lie in another cell, or is it \
             another letter?"
        );
        let is_odd = fewer || more && self.wanted != Signs::Mark;
        is_odd.then(|| Warning::of(self.slot, message))
    }
}

/// What letters of one kind have beside their bodies on a page.
struct Usual {
    /// Pieces; at least one.
    count: usize,
    /// Ink of all, px².
    ink: f64,
}

impl Usual {
    /// Of letters that want the same signs; `None` where they differ.
    fn of(letters: &[Signed<'_>]) -> Option<Self> {
        let counts = letters.iter().map(|l| l.drawn.len());
        let count = middle(counts, usize::cmp).filter(|n| *n > 0)?;
        let alike = letters.iter().filter(|l| l.drawn.len() == count);
        let inks: Vec<f64> = alike.map(|l| l.drawn.iter().sum()).collect();
        let tell = inks.len() >= TELL && inks.len() as f64 >= ALIKE * letters.len() as f64;
        let ink = median(inks).filter(|_| tell)?;
        Some(Self { count, ink })
    }
}

/// Warns of letters with fewer or more signs than most letters whose names have as many.
pub(super) fn warnings(slots: &[&Slot], all: &[Component]) -> Vec<Warning> {
    let letters = slots.iter().filter_map(|s| Signed::new(s, all));
    let mut letters: Vec<Signed<'_>> = letters.collect();
    letters.sort_by_key(|l| l.wanted);
    let alike = letters.chunk_by(|a, b| a.wanted == b.wanted);
    let told = alike.filter_map(|letters| Some((letters, Usual::of(letters)?)));
    let odd = told.flat_map(|(letters, usual)| {
        let odd = letters.iter().map(|l| l.odd(&usual));
        odd.collect::<Vec<_>>()
    });
    odd.flatten().collect()
}
