//! Ink that is not evenly dark: the pools of a fountain pen, a pen that runs dry, a marker's overlaps, the streaks of
//! a ballpoint; brought to one level.
//!
//! Where ink is pale its edge lies at half of its own level, not at half of the page's. Ink shows its level where
//! it is flat, and it changes slowly along a stroke, so that pale ink is told from a printed line, the page's back
//! and dust by the way to ink that is surely ink: over them there is an edge.

use super::paper::Paper;
use super::steps::softened;
use super::streaks::{self, InkStreaks};
use crate::numeric::cast::index;
use crate::numeric::coverage::blur;
use crate::numeric::median::range;
use crate::types::Gray;
use std::{mem, ops::Range};

/// Ink is flat where the least of a pixel and its eight neighbours is this part of the greatest: what a lens blurs
/// is steeper.
const FLAT: f32 = 0.85;
/// Flat samples between these levels are pale ink, and what is darker is as dark as it should be. Of half of the
/// ink's level and less are printed lines and the page's back.
const PALE: (f32, f32) = (0.45, 0.8);
/// Part of the flat ink that is pale where pale ink is the rule: rough paper has 0.03 at most, a photo on the page 0.12,
/// a pen that shades 0.4 to 0.7. Where nearly all is pale, printed lines are all that is flat.
const UNEVEN: Range<f64> = 0.25..0.9;
/// Flat samples at least: of fewer nothing can be said, and as many are a stroke's.
const ENOUGH: usize = 100;
/// Standard deviation of what takes the grain out, px, before the levels are read.
const GRAIN_PX: f64 = 0.7;
/// A level that flat ink must reach somewhere, and one that it must nowhere fall below.
const INK: (f32, f32) = (0.35, 0.2);
/// Standard deviation of the neighbourhood that a level is the mean of, px: an edge's blur, and less than ink takes
/// to change.
const SPREAD_PX: f64 = 3.0;
/// Weight of the picture's own level against a neighbourhood of nothing but flat ink: it holds where none is near.
const OWN: f32 = 0.01;
/// The part of a drawing's inked samples that is paler than its ink's level: the blurred edges' and the pale ink's.
const BELOW: f64 = 0.8;
/// The least contrast of ink, of the range between black and white.
const LEAST: f32 = 0.1;
/// Samples beyond each end of a drawing's range.
const BEYOND: f64 = 0.001;
/// Steps in which a drawing's levels are told.
const STEPS: usize = 2048;

/// A picture with even ink.
#[derive(Debug, Clone)]
pub struct Even {
    /// The picture.
    pub gray: Gray,
    /// Whether pale streaks in its ink were filled.
    pub filled: bool,
}

/// A page of paper 0 and ink 1 whose ink is pale in many places, with its ink 1 there, too, or has streaks, with them
/// filled. `None` of a page whose ink is even; of a picture that shows more than the page its paper tells, not a
/// table's grain.
pub(super) fn page(gray: &Gray, paper: Option<&Paper>, streaks: InkStreaks) -> Option<Even> {
    let on_paper = |x, y| paper.is_none_or(|p| p.holds(x, y));
    even(gray, [0.0, 1.0], streaks, on_paper)
}

/// A drawing whose ink is pale in many places, with its ink as dark there as elsewhere, or has a pen's pale streaks,
/// with them filled; its paper and the level of its darker ink stay. `None` of a drawing whose ink is even.
#[must_use]
pub fn shaded(gray: &Gray, streaks: InkStreaks) -> Option<Even> {
    let levels = levels(gray)?;
    even(gray, levels, streaks, |_, _| true)
}

/// A drawing with what its edges are followed by: grey levels where it has but two ([`softened`]), else even ink
/// ([`shaded`]). `None` of any other.
#[must_use]
pub fn legible(gray: &Gray, streaks: InkStreaks) -> Option<Even> {
    let soft = softened(gray).map(|gray| Even {
        gray,
        filled: false,
    });
    soft.or_else(|| shaded(gray, streaks))
}

/// The picture with even ink, where that of the pixels that count is not.
fn even(
    gray: &Gray,
    levels: [f32; 2],
    streaks: InkStreaks,
    counts: impl Fn(usize, usize) -> bool,
) -> Option<Even> {
    let one = is_uneven(gray, levels, &counts).then(|| evened(gray, levels));
    let full = match streaks {
        InkStreaks::Fill => streaks::filled(one.as_ref().unwrap_or(gray), levels, counts),
        InkStreaks::Keep => None,
    };
    let filled = full.is_some();
    full.or(one).map(|gray| Even { gray, filled })
}

/// The levels of a drawing's paper and of its darker ink.
pub(super) fn levels(gray: &Gray) -> Option<[f32; 2]> {
    let (low, high) = (-Gray::OVERSHOOT, 1.0 + Gray::OVERSHOOT);
    let step = (high - low) / STEPS as f32;
    let mut counts = [0_usize; STEPS];
    for v in gray.samples() {
        let bin = index(f64::from((v - low) / step));
        counts[bin.min(STEPS - 1)] += 1;
    }
    let nth = |mut bins: Range<usize>, share: f64| {
        let last = counts[bins.clone()].iter().sum::<usize>().checked_sub(1)?;
        let mut left = index(share * last as f64);
        bins.find(|&i| {
            let is_here = counts[i] > left;
            left = left.saturating_sub(counts[i]);
            is_here
        })
    };
    let middle = (nth(0..STEPS, BEYOND)? + nth(0..STEPS, 1.0 - BEYOND)?) / 2 + 1;
    let bins = [nth(0..middle, 0.5)?, nth(middle..STEPS, BELOW)?];
    let levels = bins.map(|i| low + (i as f32 + 0.5) * step);
    (levels[1] - levels[0] >= LEAST).then_some(levels)
}

/// Whether much of the flat ink is pale, of the pixels that count.
fn is_uneven(gray: &Gray, [paper, ink]: [f32; 2], counts: impl Fn(usize, usize) -> bool) -> bool {
    let at = |level: f32| paper + level * (ink - paper);
    let (least, pale) = (at(PALE.0), at(PALE.1));
    let (mut flat, mut pales) = (0_usize, 0_usize);
    for y in 1..gray.height().saturating_sub(1) {
        let rows = [y - 1, y, y + 1].map(|y| gray.row(y));
        for x in 1..rows[1].len().saturating_sub(1) {
            let v = rows[1][x];
            if v >= least && is_flat(rows, x, paper) && counts(x, y) {
                flat += 1;
                pales += usize::from(v < pale);
            }
        }
    }
    flat >= ENOUGH && UNEVEN.contains(&(pales as f64 / flat as f64))
}

/// Whether a pixel and its neighbours are alike, as far as they are darker than the paper.
fn is_flat(rows: [&[f32]; 3], x: usize, paper: f32) -> bool {
    let (least, most) = range(rows.iter().flat_map(|row| &row[x - 1..=x + 1]));
    least - paper >= FLAT * (most - paper)
}

/// The picture with all flat ink at the ink's level, and what lies beside it in proportion.
fn evened(gray: &Gray, [paper, ink]: [f32; 2]) -> Gray {
    let width = gray.width();
    let part = |v: &f32| (v - paper) / (ink - paper);
    let mut soft: Vec<f32> = gray.samples().iter().map(part).collect();
    blur(&mut soft, width, GRAIN_PX, 0);
    let ours = flat_ink(&soft, width);
    let mut weights: Vec<f32> = ours.iter().map(|&is| f32::from(u8::from(is))).collect();
    soft.iter_mut().zip(&weights).for_each(|(v, w)| *v *= w);
    for sums in [&mut soft, &mut weights] {
        blur(sums, width, SPREAD_PX, 0);
    }
    let levels = soft.iter().zip(&weights);
    let levels = levels.map(|(sum, weight)| (sum + OWN) / (weight + OWN));
    let samples = gray.samples().iter().zip(levels);
    gray.with_samples(
        samples
            .map(|(v, level)| paper + (v - paper) / level)
            .collect(),
    )
}

/// Flat samples of ink, 1, on paper, 0: those that reach the one level and those that go on from there without
/// falling below the other.
fn flat_ink(samples: &[f32], width: usize) -> Vec<bool> {
    let rows: Vec<&[f32]> = samples.chunks_exact(width.max(1)).collect();
    let mut open = vec![false; samples.len()];
    let mut ways = Vec::new();
    for (y, three) in rows.windows(3).enumerate() {
        for x in 1..width.saturating_sub(1) {
            let (v, i) = (three[1][x], (y + 1) * width + x);
            open[i] = v >= INK.1 && is_flat([three[0], three[1], three[2]], x, 0.0);
            if open[i] && v >= INK.0 {
                ways.push(i);
            }
        }
    }
    let mut ink = vec![false; samples.len()];
    while let Some(i) = ways.pop() {
        // what is open lies within the picture's outermost pixels
        if !mem::take(&mut open[i]) {
            continue;
        }
        ink[i] = true;
        for row in [i - width, i, i + width] {
            ways.extend((row - 1..=row + 1).filter(|&n| open[n]));
        }
    }
    ink
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shaded(gray: &Gray) -> Option<Gray> {
        super::shaded(gray, InkStreaks::default()).map(|even| even.gray)
    }

    const W: usize = 120;
    const H: usize = 60;

    /// A bar of 100 × 20 px whose ink pales from left to right as said, and beside it a line of 5 px at a quarter
    /// of the ink that ends at the bar; all under a lens. Paper is `paper` and ink `ink`.
    fn bar(pale: impl Fn(usize) -> f32, [paper, ink]: [f32; 2]) -> Gray {
        let level = |x: usize, y: usize| match (x, y) {
            (10..110, 20..40) => pale(x),
            (58..63, 40..) => 0.25,
            _ => 0.0,
        };
        let mut samples: Vec<f32> = (0..W * H).map(|i| level(i % W, i / W)).collect();
        blur(&mut samples, W, 0.9, 0);
        let samples = samples.iter().map(|v| paper + v * (ink - paper));
        Gray::new(W, H, samples.collect()).unwrap()
    }

    /// Where the bar's lower edge lies in a column, px from the top: at half of the ink's level in the bar's middle.
    fn edge(gray: &Gray, x: usize, paper: f32) -> f32 {
        let half = f32::midpoint(paper, gray.at(x, 30));
        let y = (30..H - 1).find(|&y| gray.at(x, y) < half).unwrap();
        let (a, b) = (gray.at(x, y - 1), gray.at(x, y));
        (y as f32 - 0.5) + (a - half) / (a - b)
    }

    fn pales(x: usize) -> f32 {
        1.0 - 0.75 * (x as f32 - 10.0) / 100.0
    }

    #[test]
    fn pale_ink_ends_at_half_of_its_own_level() {
        for [paper, ink] in [[0.0, 1.0], [0.08, 0.84]] {
            let even = shaded(&bar(pales, [paper, ink])).expect("ink that pales");
            for x in (14..107).step_by(3).filter(|x| !(54..68).contains(x)) {
                let level = (even.at(x, 30) - paper) / (ink - paper);
                assert!((0.8..1.0).contains(&level), "column {x}: {level}");
                let edge = edge(&even, x, paper);
                assert!((edge - 40.0).abs() < 0.15, "column {x}: {edge}");
            }
        }
    }

    #[test]
    fn printed_lines_stay_pale() {
        let even = shaded(&bar(pales, [0.0, 1.0])).expect("ink that pales");
        assert!(even.at(60, 50) < 0.3, "{}", even.at(60, 50));
        assert!(even.at(5, 5).abs() < 0.01, "paper");
    }

    #[test]
    fn even_ink_stays() {
        for level in [1.0, 0.6] {
            let plain = bar(|_| level, [0.0, 1.0]);
            assert!(shaded(&plain).is_none(), "{level}");
        }
        // the grain of rough paper
        let grain = |x: usize| 0.95 + 0.12 * ((x * 7919 % 101) as f32 / 50.0 - 1.0);
        assert!(shaded(&bar(grain, [0.0, 1.0])).is_none());
        for small in [(0, 0), (1, 1), (2, 9)] {
            assert!(shaded(&Gray::from_fn(small.0, small.1, |x, _| x as f32)).is_none());
        }
    }
}
