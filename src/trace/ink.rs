//! The level of ink of which no stroke is wide enough to show it.
//!
//! Under a lens of deviation σ a stroke of width w and ink of level I is seen across as
//! I / 2 (erf((x + w / 2) / √2 σ) − erf((x − w / 2) / √2 σ)), averaged over each pixel. What that holds in all, I w,
//! is measured without either; its shape tells I and σ, which the strokes of a picture share, by least squares of all
//! places where one is straight. Of a stroke much thinner than the blur next to nothing tells them apart, and there
//! ink is as black as it is expected to be.

use crate::types::Gray;
use libm::erf;
use std::f64::consts::{PI, SQRT_2};
use std::ops::Range;

/// Pixels on each side of a stroke's middle that are looked at.
const REACH: isize = 6;
const SEEN: usize = 13;
/// A stroke is so dark at least, as a part of the darkest pixel.
const DARK: f32 = 0.4;
/// On both sides it ends in paper that has no more than this part of it.
const PALE: f32 = 0.12;
/// So many pixels on along it goes on as it is: no paler than this part, and it holds no more or less than that part.
const ALONG: isize = 2;
const EVEN: f32 = 0.9;
const ALIKE: f64 = 0.15;
/// Straight by so much, px, and no further from a row or column than this slope.
const STRAIGHT_PX: f64 = 0.5;
const SLOPE: f64 = 0.8;
/// Fewer places tell nothing; and of more than these not all are looked at.
const LEAST: usize = 8;
const MOST: usize = 200;
/// Of a picture of more pixels not all rows are looked at.
const LOOKED: usize = 1 << 22;
/// Deviation of ink from black, as far as a picture does not tell.
const EXPECTED: f64 = 0.2;
/// Grain is one for so many pixels that lie beside each other.
const TOGETHER: f64 = 4.0;
/// Levels and blurs, px, that are looked for, where the search begins, and its steps.
const LEVELS: Range<f64> = 0.3..2.0;
const LENSES_PX: Range<f64> = 0.1..4.0;
const LENS_PX: f64 = 0.9;
const STEPS: usize = 30;

/// A place across a stroke.
struct Across {
    samples: [f64; SEEN],
    /// Ink in all, px, square to the stroke: level times width.
    held: f64,
    /// The stroke's middle among the samples.
    middle: f64,
    /// The cosine of the angle that the samples' line makes with square to the stroke.
    upright: f64,
}

/// The level of a picture's ink, from coverage that takes it for 1, of strokes none of which shows it; nothing where
/// too few tell.
pub(super) fn level(coverage: &Gray) -> Option<f64> {
    let places = places(coverage);
    if places.len() < LEAST {
        return None;
    }
    let every = places.len().div_ceil(MOST);
    let mut places: Vec<Across> = places.into_iter().step_by(every).collect();
    let ends: f64 = places.iter().flat_map(|a| a.ends()).sum();
    let paper = ends / (2 * places.len()) as f64;
    places.iter_mut().for_each(|a| a.stand_on(paper));
    let mut found = Fit {
        ink: 1.0,
        lens: LENS_PX,
    };
    // the grain that weighs them is what a first search leaves
    for _ in 0..2 {
        let left = found.sums(&places).squares;
        let count = (places.len() * SEEN) as f64;
        found = found.improved(&places, TOGETHER * left / count);
    }
    Some(found.ink)
}

/// The places across straight strokes, row by row.
fn places(coverage: &Gray) -> Vec<Across> {
    let (w, h) = (coverage.width(), coverage.height());
    let darkest = coverage.samples().iter().copied().fold(0.0, f32::max);
    let margin = REACH.unsigned_abs();
    let mut out = Vec::new();
    let every = (w * h).div_ceil(LOOKED).max(1);
    for y in (margin..h.saturating_sub(margin)).step_by(every) {
        for x in margin..w.saturating_sub(margin) {
            if coverage.at(x, y) < DARK * darkest {
                continue;
            }
            let ways = [(1, 0), (0, 1)];
            let both = ways.map(|way| Across::new(coverage, (x, y), way, darkest));
            let straightest = |a: &Across, b: &Across| a.upright.total_cmp(&b.upright);
            out.extend(both.into_iter().flatten().max_by(straightest));
        }
    }
    out
}

impl Across {
    /// What lies across a straight stroke in this direction, whose darkest pixel there is this one.
    fn new(
        coverage: &Gray,
        (x, y): (usize, usize),
        (dx, dy): (isize, isize),
        darkest: f32,
    ) -> Option<Self> {
        // so many pixels across and along
        let at = |n: isize, m: isize| {
            let x = x.checked_add_signed(n * dx + m * dy)?;
            let y = y.checked_add_signed(n * dy + m * dx)?;
            Some(coverage.at(x, y))
        };
        let here = at(0, 0)?;
        if here < at(1, 0)? || here <= at(-1, 0)? || at(0, 1)?.min(at(0, -1)?) < EVEN * here {
            return None;
        }
        let line = |m: isize| {
            let mut samples = [0.0; SEEN];
            for (to, n) in samples.iter_mut().zip(-REACH..) {
                *to = f64::from(at(n, m)?);
            }
            Some(samples)
        };
        let samples = line(0)?;
        let (held, middle) = moments(&samples);
        let [(back, before), (on, after)] = [moments(&line(-ALONG)?), moments(&line(ALONG)?)];
        let slope = (after - before) / (2 * ALONG) as f64;
        let straight = (before + after - 2.0 * middle).abs() < STRAIGHT_PX && slope.abs() < SLOPE;
        let alike = [back, on].iter().all(|v| (v / held - 1.0).abs() < ALIKE);
        let across = Self {
            samples,
            held,
            middle,
            upright: 1.0 / slope.hypot(1.0),
        };
        let pale = across.ends().iter().all(|v| *v < f64::from(PALE * darkest));
        (straight && alike && pale).then_some(across)
    }

    /// What lies furthest from the stroke on each side.
    fn ends(&self) -> [f64; 2] {
        [0, SEEN - 1].map(|i| self.samples[i])
    }

    /// Takes the paper's level off: pixels beside a stroke pass for paper with what the lens leaves of ink in them.
    fn stand_on(&mut self, paper: f64) {
        self.samples.iter_mut().for_each(|v| *v -= paper);
        (self.held, self.middle) = moments(&self.samples);
        self.held *= self.upright;
    }
}

/// The sum of samples across a stroke, and where its middle is.
fn moments(samples: &[f64; SEEN]) -> (f64, f64) {
    let sum: f64 = samples.iter().sum();
    let first: f64 = (0_u32..).zip(samples).map(|(i, v)| f64::from(i) * v).sum();
    (sum, first / sum)
}

/// Ink and blur that all strokes share.
#[derive(Clone, Copy)]
struct Fit {
    ink: f64,
    /// The lens' blur alone, px.
    lens: f64,
}

/// What is left of the samples, its gradient (halved) by ink and blur, and their normal equations.
#[derive(Default)]
struct Sums {
    squares: f64,
    gradient: [f64; 2],
    normal: [f64; 3],
}

impl Fit {
    fn sums(self, places: &[Across]) -> Sums {
        let mut sums = Sums::default();
        let scale = 1.0 / (SQRT_2 * self.lens);
        // the integral of the error function, and of that by its scale
        let edge = |x: f64| {
            let (z, bell) = (x * scale, libm::exp(-(x * scale).powi(2)) / PI.sqrt());
            (x * erf(z) + bell / scale, bell / scale)
        };
        for place in places {
            let half = 0.5 * place.held / self.ink;
            let pixel = 0.5 * place.upright;
            for (i, seen) in (0_u32..).zip(&place.samples) {
                let off = (f64::from(i) - place.middle) * place.upright;
                let ends = [(off + half, 1.0), (off - half, -1.0)];
                let (mut part, mut by_half, mut by_lens) = (0.0, 0.0, 0.0);
                for (x, sign) in ends {
                    for (x, sign) in [(x + pixel, sign), (x - pixel, -sign)] {
                        let (value, bell) = edge(x);
                        part += sign * value;
                        by_lens += sign * bell;
                    }
                    by_half += erf((x + pixel) * scale) - erf((x - pixel) * scale);
                }
                // a stroke of the pixel's width
                let whole = 0.25 / pixel;
                let part = whole * part;
                // it is as much narrower as its ink is darker
                let by_ink = part - whole * half * by_half;
                let by_lens = whole * self.ink * by_lens / self.lens;
                let left = seen - self.ink * part;
                sums.squares += left * left;
                sums.gradient[0] += left * by_ink;
                sums.gradient[1] += left * by_lens;
                sums.normal[0] += by_ink * by_ink;
                sums.normal[1] += by_ink * by_lens;
                sums.normal[2] += by_lens * by_lens;
            }
        }
        sums
    }

    /// What is left by the grain's measure, and by what is expected of ink.
    fn cost(self, squares: f64, grain: f64) -> f64 {
        squares / grain + ((self.ink - 1.0) / EXPECTED).powi(2)
    }

    /// The ink and blur of least cost that steps of damped least squares reach.
    fn improved(self, places: &[Across], grain: f64) -> Self {
        let grain = grain.max(f64::MIN_POSITIVE);
        let (mut now, mut sums) = (self, self.sums(places));
        let mut damping = 1e-3;
        for _ in 0..STEPS {
            let weight = grain / (EXPECTED * EXPECTED);
            let g = [
                sums.gradient[0] + weight * (1.0 - now.ink),
                sums.gradient[1],
            ];
            let [a, b, c] = sums.normal;
            let (a, c) = ((a + weight) * (1.0 + damping), c * (1.0 + damping));
            let determinant = a * c - b * b;
            let next = Self {
                ink: now.ink + (c * g[0] - b * g[1]) / determinant,
                lens: now.lens + (a * g[1] - b * g[0]) / determinant,
            };
            let sound = LEVELS.contains(&next.ink) && LENSES_PX.contains(&next.lens);
            let left = if sound { Some(next.sums(places)) } else { None };
            let cost = now.cost(sums.squares, grain);
            match left.filter(|left| next.cost(left.squares, grain) < cost) {
                Some(left) => (now, sums, damping) = (next, left, 0.3 * damping),
                None => damping *= 10.0,
            }
        }
        now
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::cast::single;

    /// Columns of light to a pixel.
    const FINE: u32 = 8;

    /// Bars of ink of a level and width, px, under a lens, with grain.
    fn bars(ink: f32, width: f64, lens: f64, grain: f32) -> Gray {
        let light = |x: f64| {
            let bar = |middle: f64| {
                let ends = [x - middle + 0.5 * width, x - middle - 0.5 * width];
                let [a, b] = ends.map(|v| erf(v / (SQRT_2 * lens)));
                0.5 * (a - b)
            };
            [8.27, 24.58, 40.93, 57.14, 71.71]
                .map(bar)
                .iter()
                .sum::<f64>()
        };
        let pixel = |x: u32| {
            let at = |i: u32| f64::from(x) + (f64::from(i) + 0.5) / f64::from(FINE);
            ink * single((0..FINE).map(|i| light(at(i))).sum::<f64>() / f64::from(FINE))
        };
        let row: Vec<f32> = (0..80).map(pixel).collect();
        let noise = |x, y| {
            let hash = u32::try_from(80 * y + x)
                .unwrap()
                .wrapping_mul(2_654_435_761);
            grain * ((hash >> 16) as f32 / 65536.0 - 0.5)
        };
        Gray::from_fn(80, 60, |x, y| row[x] + noise(x, y))
    }

    #[test]
    fn strokes_tell_the_level_of_their_ink_by_their_shape() {
        for ink in [0.7, 0.85, 1.0] {
            for (lens, width) in [(0.6, 2.2), (0.9, 3.1), (1.2, 4.2)] {
                let found = level(&bars(ink, width, lens, 0.0)).unwrap();
                let off = found - f64::from(ink);
                assert!(off.abs() < 0.02, "{ink} {lens} {width}: {found}");
                let found = level(&bars(ink, width, lens, 0.08)).unwrap();
                let off = found - f64::from(ink);
                assert!(off.abs() < 0.06, "grain, {ink} {lens} {width}: {found}");
            }
        }
    }

    #[test]
    fn lines_far_thinner_than_the_blur_tell_nothing() {
        let found = level(&bars(1.0, 0.8, 1.2, 0.05)).unwrap();
        assert!((found - 1.0).abs() < 0.1, "{found}");
        assert_eq!(level(&Gray::from_fn(40, 40, |_, _| 0.0)), None);
        assert_eq!(level(&Gray::from_fn(3, 3, |_, _| 1.0)), None);
    }
}
