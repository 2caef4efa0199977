//! Pictures of two levels, whose edges run in steps of whole pixels: told, and brought to grey.

use crate::numeric::{cast::index, coverage};
use crate::types::Gray;
use std::mem;

/// A sample is of neither level where it lies this far from both, parts of the way between them.
const BETWEEN: f32 = 0.2;
/// The least part of the steps that no sample between the levels smooths.
const BARE: f64 = 0.9;
/// The softening, a Gaussian's standard deviation, px, and its part of a stroke. Half a pixel leaves the steps as they
/// are, and what is wide beside a stroke runs its two sides together; beyond the longest, ends are lost and no step is
/// hidden any better.
const SOFT_PX: (f64, f64) = (0.7, 1.5);
const OF_STROKE: f64 = 1.0 / 15.0;
/// Runs of ink that are shorter are grain, and longer ones no stroke, px.
const RUN_PX: (usize, usize) = (2, 512);
/// Standard deviation of the softened edges' places, px. Half a pixel either way makes 0.29; the points of a step are off
/// together, so that they tell less than as many others.
const SCATTER_PX: f64 = 0.35;

/// The picture softened, where it has two levels and edges that run in steps; they then have a slope along which they can
/// be followed, and lie where those of a grey picture do, on average. `None` for any other picture.
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
struct Levels {
    least: f32,
    most: f32,
}

impl Levels {
    fn of(gray: &Gray) -> Self {
        let ends = |(a, b): (f32, f32), v: &f32| (a.min(*v), b.max(*v));
        let (least, most) = gray.samples().iter().fold((f32::MAX, f32::MIN), ends);
        Self { least, most }
    }

    fn is_ink(&self, v: f32) -> bool {
        2.0 * v > self.least + self.most
    }

    fn is_between(&self, v: f32) -> bool {
        let margin = BETWEEN * (self.most - self.least);
        v > self.least + margin && v < self.most - margin
    }

    /// Whether nearly all places where an edge turns from along rows to along columns are bare of samples between the
    /// levels: in a grey picture an edge comes to the next row or column by way of such.
    fn run_in_steps(&self, gray: &Gray) -> bool {
        let (mut steps, mut bare) = (0_usize, 0_usize);
        let rows = gray.samples().chunks_exact(gray.width().max(1));
        for (above, below) in rows.clone().zip(rows.skip(1)) {
            for (a, b) in above.windows(2).zip(below.windows(2)) {
                let four = [a[0], a[1], b[0], b[1]];
                let ink = four.map(|v| self.is_ink(v));
                let straight = (ink[0] == ink[1] && ink[2] == ink[3])
                    || (ink[0] == ink[2] && ink[1] == ink[3]);
                if !straight {
                    steps += 1;
                    bare += usize::from(!four.iter().any(|&v| self.is_between(v)));
                }
            }
        }
        steps > 0 && bare as f64 >= BARE * steps as f64
    }

    /// The usual length of ink along rows and columns, px.
    fn stroke_px(&self, gray: &Gray) -> Option<f64> {
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
fn blurred(gray: &Gray, sigma_px: f64) -> Vec<f32> {
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
