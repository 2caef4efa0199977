//! Room between letters: where each outline stands in its advance.
//!
//! Sides that join end where the stroke was cut. Where a drawing comes with its advance, it counts.
//! Else the room beside a glyph follows from areas, as in the letter-spacing methods of Fry and of
//! Sousa: the white that a letter has on a side already, between its extreme and its ink, is taken from
//! the room that its font wants. How much that is follows from the white inside letters, between the
//! stems of n and u, and from how heavy the stems are:
//!
//! ```text
//! room = a·counter + b·x-height + c·stem − d·white(0.3 x) + e·white(0.5 x) − f·least
//! ```
//!
//! where white(D) is the mean distance from the side's extreme to the ink over the scan lines from the
//! baseline to the x-height (cap height for capitals, figures and signs), no deeper than D, and least
//! the smallest such distance. The weights were found by least absolute deviations over the
//! sidebearings of 32 upright text fonts of 11 families, each family weighing as the root of its
//! number; with a family held out, the median error of its advances is 17 thousandths of the em.
//! Leaning fonts are set upright before they are measured.
//!
//! Letters of a joining script have the same room on every side that does not join, a part of alef's height, but for
//! their tails and tops.

use super::features::is_arabic;
use super::profile::{Profile, white};
use super::tails::{self, Ends};
use super::words::{self, Gap};
use super::{Draft, Note, Options};
use crate::numeric::median::median;
use crate::types::Info;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How digits are set.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Figures {
    /// Each with the room that suits it.
    #[default]
    Proportional,
    /// All as wide as the widest, centred.
    Tabular,
}

/// How much room letters get. Lengths are parts of the em.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Room {
    /// The same room on every side that joins nothing, instead of the optical rule.
    #[serde(deserialize_with = "super::ranges::optional_room")]
    pub sidebearing: Option<f64>,
    /// Added on every side that joins nothing.
    #[serde(deserialize_with = "super::ranges::room")]
    pub tracking: f64,
    /// How digits are set.
    pub figures: Figures,
}

/// Weights of counter and x-height for small letters, capitals, figures and signs.
const KINDS: [(f64, f64); 4] = [
    (0.302, -0.019),
    (0.264, 0.016),
    (0.269, 0.025),
    (0.231, 0.078),
];
/// Weights of stem, shallow and deep white, and least distance.
const WEIGHTS: [f64; 4] = [0.17, -1.023, 0.361, -0.296];
/// How deep the two whites look, parts of the x-height.
const DEPTHS: (f64, f64) = (0.3, 0.5);
/// Room beside letters of a joining script that do not join, part of alef's height: by least absolute deviations over
/// 13 fonts of six families, each family weighing the same. A bold font has no more room than its regular one, so
/// strokes tell less: with a family held out a side is off by 14 thousandths of the em in the mean of medians, 18 by
/// the joining stroke's thickness and 20 by the em. Neither teeth, counters nor white areas added to it tell more.
const OF_ALEF: f64 = 0.082;
/// The same of the joining stroke's thickness, where there is no alef.
const OF_STROKE: f64 = 0.51;
/// Room where neither counters, alef nor joining strokes tell, em.
const UNKNOWN: f64 = 0.05;

/// What a font's letters say about the room they want, font units.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rhythm {
    counter: f64,
    stem: f64,
    x_height: f64,
    cap_height: f64,
    slant: f64,
}

impl Rhythm {
    /// From n and u, or from whatever small letter or capital has two stems; none in a font without.
    pub(super) fn of(drafts: &[Draft], info: &Info) -> Option<Self> {
        let em = f64::from(info.units_per_em);
        let x = info.metrics.x_height;
        let cap = info.metrics.cap_height;
        let x_height = if x > 0.0 { x } else { 0.7 * cap };
        let cap_height = if cap > 0.0 { cap } else { x_height / 0.7 };
        let slant = libm::tan((-info.italic_angle).to_radians());
        let counters = |letters: &str, zone: (f64, f64)| -> Vec<(f64, f64)> {
            let of = |d: &Draft| {
                let wanted = d.codepoints.first().is_some_and(|c| letters.contains(*c));
                let profile = wanted
                    .then(|| Profile::of(&d.outline, em, slant, 0.5 * x_height))
                    .flatten()?;
                profile.counter((zone.0 * x_height, zone.1 * x_height))
            };
            drafts.iter().filter_map(of).collect()
        };
        let mut found = [counters("n", (0.2, 0.6)), counters("u", (0.4, 0.8))].concat();
        if found.is_empty() {
            found = counters("hmodbqpUHON", (0.3, 0.7));
        }
        let mean = found.iter().map(|f| f.0).sum::<f64>() / found.len() as f64;
        let stem = median(found.iter().map(|f| f.1))?;
        Some(Self {
            counter: mean,
            stem,
            x_height,
            cap_height,
            slant,
        })
    }

    /// The white between the stems of n.
    pub(super) const fn counter(&self) -> f64 {
        self.counter
    }

    /// The heights between which a character's sides are looked at.
    pub(super) fn zone(&self, c: char) -> (f64, f64) {
        let small = c.is_lowercase();
        (
            0.0,
            if small {
                self.x_height
            } else {
                self.cap_height
            },
        )
    }

    /// Left and right end of the advance by the optical rule, in the outline's own x.
    fn ends(&self, draft: &Draft, c: char, em: f64) -> Option<(f64, f64)> {
        let profile = self.profile(draft, em)?;
        let kind = match c {
            c if c.is_lowercase() => 0,
            c if c.is_uppercase() => 1,
            c if c.is_numeric() => 2,
            _ => 3,
        };
        let (of_counter, of_height) = KINDS.get(kind).copied()?;
        let [stem, shallow, deep, least] = WEIGHTS;
        let base = of_counter * self.counter + of_height * self.x_height + stem * self.stem;
        let depths = (DEPTHS.0 * self.x_height, DEPTHS.1 * self.x_height);
        let room = |distances: Vec<Option<f64>>| {
            let w = white(&distances, depths);
            base + shallow * w.shallow + deep * w.deep + least * w.least
        };
        let zone = self.zone(c);
        let (left, right) = profile.extremes;
        Some((
            left - room(profile.left(zone)),
            right + room(profile.right(zone)),
        ))
    }

    /// A draft's upright profile.
    pub(super) fn profile(&self, draft: &Draft, em: f64) -> Option<Profile> {
        Profile::of(&draft.outline, em, self.slant, 0.5 * self.x_height)
    }
}

/// Places every draft and sets its advance. `stroke` is the thickness of the joining strokes, font units.
/// Words that were written have the last word.
pub(super) fn set(
    drafts: &mut [Draft],
    info: &Info,
    stroke: Option<f64>,
    options: &Options,
) -> (Vec<Gap>, Vec<Note>) {
    let em = f64::from(info.units_per_em);
    let rhythm = Rhythm::of(drafts, info);
    let alef = alef(drafts);
    let joining = alef.map(|height| OF_ALEF * height);
    let joining = joining.or(stroke.map(|s| OF_STROKE * s));
    let terms = Terms {
        em,
        rhythm,
        joining,
        room: &options.letters,
    };
    let tails = match (options.letters.sidebearing, joining) {
        (None, Some(side)) => tails::ends(drafts, side, alef, em),
        _ => drafts.iter().map(|_| Ends::default()).collect(),
    };
    for (draft, own) in drafts.iter_mut().zip(tails) {
        let (left, right) = terms.ends(draft, own);
        draft.shift(-left);
        draft.advance = (right - left).max(0.0).round();
    }
    let learnt = words::learn(drafts, &options.words, terms.side(), em);
    if options.letters.figures == Figures::Tabular {
        tabular(drafts);
    }
    learnt
}

/// Height of alef.
fn alef(drafts: &[Draft]) -> Option<f64> {
    let of = |d: &Draft| d.outline.bounds().filter(|_| d.id.chars == ['ا']);
    let heights = drafts.iter().filter_map(of).map(|ink| ink.y1);
    heights.reduce(f64::max).filter(|&h| h > 0.0)
}

struct Terms<'a> {
    em: f64,
    rhythm: Option<Rhythm>,
    /// Room beside letters of a joining script.
    joining: Option<f64>,
    room: &'a Room,
}

impl Terms<'_> {
    /// Left and right end of the advance in the outline's own x.
    fn ends(&self, draft: &Draft, own: Ends) -> (f64, f64) {
        let free = || {
            let (left, right) = self.free(draft);
            let add = self.room.tracking * self.em;
            (
                own.left.map_or(left, |l| l - add),
                own.right.map_or(right, |r| r + add),
            )
        };
        let (left, right) = draft.given.unwrap_or_else(free);
        (
            draft.joint.0.unwrap_or(left),
            draft.joint.1.unwrap_or(right),
        )
    }

    /// Room beside a letter for which there is no optical rule.
    fn side(&self) -> f64 {
        let given = self.room.sidebearing.map(|s| s * self.em);
        given.or(self.joining).unwrap_or(UNKNOWN * self.em)
    }

    /// The ends where neither page nor stroke says them. Marks stand above others and take no room.
    fn free(&self, draft: &Draft) -> (f64, f64) {
        let Some(ink) = draft.outline.bounds() else {
            return (0.0, 0.0);
        };
        if draft.is_mark() {
            let middle = 0.5 * (ink.x0 + ink.x1);
            return (middle, middle);
        }
        let add = self.room.tracking * self.em;
        let first = draft.id.chars.first().copied().filter(|c| !is_arabic(*c));
        let optical = match (self.room.sidebearing, first, &self.rhythm) {
            (None, Some(c), Some(rhythm)) => rhythm.ends(draft, c, self.em),
            _ => None,
        };
        let same = self.side();
        let (left, right) = optical.unwrap_or((ink.x0 - same, ink.x1 + same));
        (left - add, right + add)
    }
}

/// Whether a character is a digit of whole numbers: signs such as ½ and ² keep their room.
const fn is_digit(c: char) -> bool {
    matches!(c, '0'..='9' | '\u{660}'..='\u{669}' | '\u{6F0}'..='\u{6F9}')
}

/// Digits of one script all as wide as the widest, their ink centred as it was.
fn tabular(drafts: &mut [Draft]) {
    for script in [is_arabic as fn(char) -> bool, |c| !is_arabic(c)] {
        let is_one = |d: &Draft| {
            matches!(d.id.chars[..], [c] if is_digit(c) && script(c))
                && d.id.alternates().next().is_none()
        };
        let widest = drafts
            .iter()
            .filter(|d| is_one(d))
            .map(|d| d.advance)
            .fold(0.0, f64::max);
        for draft in drafts.iter_mut().filter(|d| is_one(d)) {
            let shift = 0.5 * (widest - draft.advance);
            draft.shift(shift);
            draft.advance = widest;
        }
    }
}
