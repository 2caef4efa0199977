//! Pairs of letters that read from the left, and of signs beside them.

use super::groups::group;
use super::{Options, WINDOW, least, reach};
use crate::assemble::Draft;
use crate::assemble::spacing::Rhythm;
use crate::numeric::median::median;
use crate::types::{Kerning, Name};
use std::ops::Range;

/// Scan lines up and down that a side is compared with, for the mean gap: 0.03 em.
const NEAR: usize = 3;

/// Scan lines beyond those on which both letters have ink that count too.
const BEYOND: usize = 5;

/// Gaps count at most so many counters: what is further does not touch at all.
const FURTHEST: f64 = 1.75;

/// And at least so much, em: letters that touch are one case.
const TOUCHING: f64 = 0.02;

/// Part of the usual least gap that kerning leaves.
const CLEAR: f64 = 0.5;

/// Signs that are kerned with letters.
const SIGNS: &str = ".,-'\u{2018}\u{2019}\u{201c}\u{201d}\"";

/// Adds them.
pub(super) fn add(
    drafts: &[Draft],
    rhythm: Option<Rhythm>,
    em: f64,
    options: &Options,
    out: &mut Kerning,
) {
    let Some(rhythm) = rhythm else { return };
    let sides: Vec<Sides<'_>> = drafts
        .iter()
        .filter_map(|d| Sides::of(d, &rhythm, em))
        .collect();
    let names: Vec<&Name> = sides.iter().map(|s| s.name).collect();
    // the counters of letters full of slits may be narrower than what touches
    let touching = TOUCHING * em;
    let bounds = (touching, touching.max(FURTHEST * rhythm.counter()));
    let gaps = |of: &dyn Fn(&Sides<'_>, &Sides<'_>) -> f64| -> Vec<Vec<f64>> {
        let row = |a| sides.iter().map(|b| of(a, b)).collect();
        sides.iter().map(row).collect()
    };
    let mean = gaps(&|a, b| a.apart(b, bounds));
    let nearest = gaps(&|a, b| least(&a.right, &b.within));
    let drawn: Vec<usize> = (0..sides.len())
        .filter(|&i| sides[i].case != Case::Sign && !sides[i].is_composed)
        .collect();
    let usual = |gaps: &[Vec<f64>]| {
        median(
            drawn
                .iter()
                .flat_map(|&a| drawn.iter().map(move |&b| gaps[a][b])),
        )
    };
    let (Some(wide), Some(near)) = (usual(&mean), usual(&nearest)) else {
        return;
    };
    let value = |a: usize, b: usize| {
        if (sides[a].case, sides[b].case) == (Case::Small, Case::Capital) {
            return 0.0;
        }
        let surplus = mean[a][b] - wide - options.slack * rhythm.counter();
        (options.strength * surplus).min(nearest[a][b] - CLEAR * near)
    };
    group((&names, &names), value, em, options.least * em, out);
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Case {
    Small,
    Capital,
    Sign,
}

/// A glyph's distances from the ends of its advance, row by row; infinite where there is no ink.
struct Sides<'a> {
    name: &'a Name,
    case: Case,
    is_composed: bool,
    right: Vec<f64>,
    /// The least of a few rows about each.
    left: Vec<f64>,
    /// The least of the rows in the window about each.
    within: Vec<f64>,
    /// The rows from the baseline to the height of capitals, and those of them from the lowest to the highest ink.
    zone: Range<usize>,
    ink: Range<usize>,
}

impl<'d> Sides<'d> {
    fn of(draft: &'d Draft, rhythm: &Rhythm, em: f64) -> Option<Self> {
        let c = draft.codepoints.first().copied()?;
        let case = match c {
            c if SIGNS.contains(c) => Case::Sign,
            c if c.is_lowercase() => Case::Small,
            c if c.is_uppercase() => Case::Capital,
            _ => return None,
        };
        let profile = rhythm.profile(draft, em)?;
        let room = draft.advance - profile.extremes.1;
        let whole = |d: Option<f64>| d.unwrap_or(f64::INFINITY);
        let left: Vec<f64> = profile.lefts().into_iter().map(whole).collect();
        let right = profile.rights().into_iter().map(|r| whole(r) + room);
        let zone = profile.band(rhythm.zone('H'));
        let mut inked = zone.clone().filter(|&i| left[i].is_finite());
        let ink = match (inked.next(), inked.next_back()) {
            (Some(low), high) => low..high.unwrap_or(low) + 1,
            _ => zone.clone(),
        };
        Some(Self {
            name: &draft.id.name,
            case,
            is_composed: !draft.parts.is_empty(),
            right: right.collect(),
            within: reach(&left, WINDOW),
            left: reach(&left, NEAR),
            zone,
            ink,
        })
    }

    /// The mean gap to the next letter, each counted between two bounds.
    fn apart(&self, next: &Self, (least, most): (f64, f64)) -> f64 {
        let low = self.ink.start.max(next.ink.start).saturating_sub(BEYOND);
        let high = self.ink.end.min(next.ink.end) + BEYOND;
        let both = low.max(self.zone.start)..high.min(self.zone.end);
        let rows = if both.is_empty() {
            self.zone.clone()
        } else {
            both
        };
        let count = rows.len() as f64;
        let near = |i: usize| (self.right[i] + next.left[i]).clamp(least, most).powi(-5);
        let sum: f64 = rows.map(near).sum();
        if sum > 0.0 {
            libm::pow(sum / count, -0.2)
        } else {
            most
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_near_place_does_not_hide_the_white_beside_it() {
        let name = Name::new("a").unwrap();
        let side = |rows: Vec<f64>| Sides {
            name: &name,
            case: Case::Small,
            is_composed: false,
            zone: 0..rows.len(),
            ink: 0..rows.len(),
            within: rows.clone(),
            left: rows.clone(),
            right: rows,
        };
        let bounds = (20.0, 400.0);
        let apart = |a: Vec<f64>, b: Vec<f64>| side(a).apart(&side(b), bounds);
        assert!((apart(vec![30.0; 40], vec![50.0; 40]) - 80.0).abs() < 1e-9);
        assert!((apart(vec![f64::INFINITY; 40], vec![0.0; 40]) - 400.0).abs() < 1e-9);
        let mut bar = vec![300.0; 40];
        bar[20] = 60.0;
        let (open, barred) = (
            apart(vec![300.0; 40], vec![0.0; 40]),
            apart(bar, vec![0.0; 40]),
        );
        assert!(barred > 100.0 && barred < 0.6 * open, "{barred} of {open}");
    }
}
