//! Pictures of two levels, whose edges run in steps of whole pixels: told, and brought to grey.

use crate::numeric::{cast::index, coverage, median::range};
use crate::types::Gray;
use rayon::prelude::*;
use std::mem;

/// A sample is of neither level where it lies this far from both, parts of the way between them.
const BETWEEN: f32 = 0.1;
/// The least part of the steps that no sample between the levels smooths.
const BARE: f64 = 0.9;
/// The softening, a Gaussian's standard deviation, px, and its part of a stroke. Half a pixel leaves the steps as
/// they are, and what is wide beside a stroke runs its two sides together; beyond the longest, ends are lost and no
/// step is hidden any better.
const SOFT_PX: (f64, f64) = (0.7, 1.5);
const OF_STROKE: f64 = 1.0 / 15.0;
/// Runs of ink that are shorter are grain, and longer ones no stroke, px.
const RUN_PX: (usize, usize) = (2, 512);
/// Standard deviation of the softened edges' places, px. Half a pixel either way makes 0.29; the points of a step are
/// off together, so that they tell less than as many others.
const SCATTER_PX: f64 = 0.35;

/// The picture softened, where it has two levels and edges that run in steps; they then have a slope along which they
/// can be followed, and lie where those of a grey picture do, on average. `None` for any other picture.
#[must_use]
pub fn softened(gray: &Gray) -> Option<Gray> {
    let levels = Levels::of(gray);
    if !levels.run_in_steps(gray) {
        return None;
    }
    let soft = OF_STROKE * levels.stroke_px(gray)?;
    let samples = blurred(gray, soft.clamp(SOFT_PX.0, SOFT_PX.1));
    Some(gray.with_samples(samples).with_scatter(SCATTER_PX))
}

/// The least and the greatest sample.
pub(super) struct Levels {
    pub(super) least: f32,
    pub(super) most: f32,
}

impl Levels {
    fn of(gray: &Gray) -> Self {
        let (least, most) = range(gray.samples());
        Self { least, most }
    }

    fn is_ink(&self, v: f32) -> bool {
        2.0 * v > self.least + self.most
    }

    fn is_between(&self, v: f32) -> bool {
        let margin = BETWEEN * (self.most - self.least);
        v > self.least + margin && v < self.most - margin
    }

    /// Whether nearly all places where an edge comes from one row or column to the next are bare of samples between
    /// the levels: in a grey picture it comes there by way of such. Corners are no such places.
    fn run_in_steps(&self, gray: &Gray) -> bool {
        let rows = (0..gray.height()).into_par_iter();
        let of_row = rows.map(|y| self.steps(gray, y));
        let (steps, bare) = of_row.reduce(|| (0, 0), |a, b| (a.0 + b.0, a.1 + b.1));
        steps > 0 && bare as f64 >= BARE * steps as f64
    }

    /// Steps of edges along a row, and of those along columns between it and the next; and how many of them are bare.
    fn steps(&self, gray: &Gray, y: usize) -> (usize, usize) {
        let (mut steps, mut bare) = (0, 0);
        let mut look = |before: [f32; 2], here: [f32; 2], after: [f32; 2]| {
            let ink = |two: [f32; 2]| two.map(|v| self.is_ink(v));
            let ([a, b], [c, d]) = (ink(before), ink(after));
            if a == b && c == d && a != c {
                let six = [before, here, after];
                steps += 1;
                bare += usize::from(!six.iter().flatten().any(|&v| self.is_between(v)));
            }
        };
        let (row, below) = (gray.row(y), gray.row(y + 1));
        let above = y.checked_sub(1).map_or(&[][..], |y| gray.row(y));
        let first = row.get(1..).unwrap_or_default();
        let inner = first
            .len()
            .saturating_sub(1)
            .min(below.len().saturating_sub(2));
        if !above.is_empty() && !below.is_empty() {
            self.changes(row, first, |x| {
                let two = |row: &[f32]| [row[x], row[x + 1]];
                look(two(above), two(row), two(below));
            });
        }
        if inner > 0 {
            self.changes(&first[..inner], &below[1..], |x| {
                let two = |x: usize| [row[x], below[x]];
                look(two(x), two(x + 1), two(x + 2));
            });
        }
        (steps, bare)
    }

    /// Calls `at` with the indices at which one of two rows is ink and the other paper, which are few.
    fn changes(&self, a: &[f32], b: &[f32], mut at: impl FnMut(usize)) {
        /// Pixels that are looked at together.
        const TOGETHER: usize = 16;
        let differ = |(a, b): (&f32, &f32)| self.is_ink(*a) != self.is_ink(*b);
        let blocks = a.chunks(TOGETHER).zip(b.chunks(TOGETHER)).enumerate();
        for (k, (a, b)) in blocks {
            if a.iter().zip(b).fold(false, |any, pair| any | differ(pair)) {
                let here = a
                    .iter()
                    .zip(b)
                    .enumerate()
                    .filter(|(_, pair)| differ(*pair));
                here.for_each(|(i, _)| at(k * TOGETHER + i));
            }
        }
    }

    /// The usual length of ink along rows and columns, px.
    pub(super) fn stroke_px(&self, gray: &Gray) -> Option<f64> {
        let mut counts = vec![0_usize; RUN_PX.1 + 1];
        let mut upright = vec![0_usize; gray.width()];
        let mut end = |run: &mut usize| {
            let length = mem::take(run);
            if (RUN_PX.0..=RUN_PX.1).contains(&length) {
                counts[length] += 1;
            }
        };
        for row in gray.samples().chunks_exact(gray.width().max(1)) {
            let mut level = 0;
            for (v, upright) in row.iter().zip(&mut upright) {
                for run in [&mut level, upright] {
                    if self.is_ink(*v) {
                        *run += 1;
                    } else {
                        end(run);
                    }
                }
            }
            end(&mut level);
        }
        upright.iter_mut().for_each(end);
        let half = counts.iter().sum::<usize>().div_ceil(2).max(1);
        let mut seen = 0;
        let usual = counts.iter().position(|count| {
            seen += count;
            seen >= half
        });
        usual.map(|length| length as f64)
    }
}

/// The samples under a Gaussian; beyond the picture its outermost ones go on.
pub(super) fn blurred(gray: &Gray, sigma_px: f64) -> Vec<f32> {
    let margin = index((4.0 * sigma_px).ceil());
    let (width, height) = (gray.width(), gray.height());
    let wide = width + 2 * margin;
    let inside = |at: usize, size: usize| at.saturating_sub(margin).min(size - 1);
    let mut samples = Vec::with_capacity(wide * (height + 2 * margin));
    for y in 0..height + 2 * margin {
        let row = gray.row(inside(y, height));
        samples.extend((0..wide).map(|x| row[inside(x, width)]));
    }
    coverage::blur(&mut samples, wide, sigma_px, margin);
    samples
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::cast::single;

    /// A disk of a radius in px, of `soft` px of grey along its edge, between two levels.
    fn disk(radius: f64, soft: f64, levels: (f32, f32)) -> Gray {
        Gray::from_fn(100, 100, |x, y| {
            let off = (x as f64 - 49.3).hypot(y as f64 - 50.1) - radius;
            let ink = single((0.5 - off / soft.max(1e-9)).clamp(0.0, 1.0));
            levels.0 + ink * (levels.1 - levels.0)
        })
    }

    fn sum(gray: &Gray) -> f64 {
        gray.samples().iter().map(|v| f64::from(*v)).sum()
    }

    #[test]
    fn two_levels_are_told_whatever_they_are() {
        for levels in [(0.0, 1.0), (0.1, 0.7)] {
            let steps = disk(30.0, 0.0, levels);
            let soft = softened(&steps).expect("an edge in steps");
            assert!(
                (sum(&soft) / sum(&steps) - 1.0).abs() < 1e-5,
                "no ink is lost"
            );
            assert!(soft.scatter_px() > 0.28, "{}", soft.scatter_px());
            assert!(softened(&soft).is_none(), "once is enough");
        }
    }

    #[test]
    fn grey_pictures_stay() {
        for soft in [1.0, 1.5, 3.0] {
            assert!(softened(&disk(30.0, soft, (0.0, 1.0))).is_none(), "{soft}");
        }
        let plain = Gray::from_fn(9, 7, |_, _| 0.3);
        assert!(softened(&plain).is_none());
        // edges on the pixels' own
        let within = |v: usize| (3..13).contains(&v);
        let square = Gray::from_fn(20, 20, |x, y| f32::from(u8::from(within(x) && within(y))));
        assert!(softened(&square).is_none());
        // slopes of 45 degrees, whose pixels are covered alike all along
        for by in [0.0, 0.25, 0.5, 0.75] {
            let slope = Gray::from_fn(30, 30, |x, y| {
                let off = x as f64 - y as f64 - by;
                let corner = (1.0 - off.abs()).max(0.0).powi(2) / 2.0;
                single(if off < 0.0 { corner } else { 1.0 - corner })
            });
            assert!(softened(&slope).is_none(), "{by}");
        }
        assert!(softened(&Gray::from_fn(0, 0, |_, _| 0.0)).is_none());
    }

    #[test]
    fn thin_strokes_are_softened_less_and_ink_goes_on_beyond_the_picture() {
        let reach = |radius: f64| {
            let steps = disk(radius, 0.0, (0.0, 1.0));
            let soft = softened(&steps).expect("an edge in steps");
            let grey = soft.samples().iter().filter(|v| (0.02..0.98).contains(*v));
            grey.count() as f64 / radius
        };
        assert!(
            reach(40.0) > 1.6 * reach(5.0),
            "{} {}",
            reach(40.0),
            reach(5.0)
        );
        let cut = Gray::from_fn(60, 60, |x, y| f32::from(u8::from(x > 30 + y / 9)));
        let soft = softened(&cut).expect("an edge in steps");
        assert!(soft.at(59, 59) > 0.999 && soft.at(59, 0) > 0.999);
    }
}
