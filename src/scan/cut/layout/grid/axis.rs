//! Equal cells in rows and columns, found from the ink alone.
//!
//! Letters repeat with the cells' pitch. For each pitch that the ink's extent allows, the ink's profile is
//! compared with a wave of that length; the wave's phase says where the gaps are. Printed lines, letters
//! out of their place and empty cells do not move it.

use crate::numeric::cast::index;
use crate::numeric::median::median;
use std::f64::consts::TAU;
use std::ops::Range;

/// Samples of an axis' profile.
const SAMPLES: usize = 2048;
/// Pitches tried.
const PITCHES: usize = 400;
/// Share of the ink beyond each end that may belong to no cell.
const STRAY: f64 = 0.003;
/// How much ink outside the cells counts against a fit.
const OUTSIDE: f64 = 2.0;
/// Printed lines that are the cells' borders: so many at least, as far apart as the letters up to this share, and
/// each in its place up to this share of a cell; where some are missing the first cell begins this near to one of
/// them.
const FEWEST: usize = 3;
const UNLIKE: f64 = 0.1;
const UNEVEN: f64 = 0.03;
const DOUBT: f64 = 0.35;

/// Cells along one axis, px of the upright page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axis {
    /// Where the first cell begins.
    pub(super) start: f64,
    /// Length of a cell.
    pub(super) pitch: f64,
    /// Cells.
    pub(super) count: usize,
}

impl Axis {
    /// Fits `count` equal cells to ink that covers `spans`; only the cells in `used` are said to have any.
    pub(super) fn fit(spans: &[(f64, f64)], count: usize, used: Range<usize>) -> Option<Self> {
        let profile = Profile::new(spans)?;
        let n = used.len().max(1) as f64;
        if n < 1.5 {
            let pitch = 1.1 * profile.length().max(1.0);
            let start = profile.low - 0.05 * profile.length() - used.start as f64 * pitch;
            return Some(Self {
                start,
                pitch,
                count,
            });
        }
        let (least, most) = (profile.length() / (n + 0.1), profile.length() / (n - 0.9));
        let tries = (0..PITCHES).map(|i| least + (most - least) * i as f64 / (PITCHES - 1) as f64);
        let fits = tries.map(|pitch| profile.fit(pitch, n));
        let (_, start, pitch) = fits.max_by(|a, b| a.0.total_cmp(&b.0))?;
        Some(Self {
            start: start - used.start as f64 * pitch,
            pitch,
            count,
        })
    }

    /// The same cells between printed lines, where such lines are as far apart as they are.
    pub(super) fn between(&self, lines: &[f64]) -> Option<Self> {
        let mut lines = lines.to_vec();
        lines.sort_by(f64::total_cmp);
        let gaps = lines.windows(2).map(|pair| pair[1] - pair[0]);
        // where a line is missing the gap is twice as long
        let gap = median(gaps.filter(|gap| (gap / self.pitch - 1.0).abs() < UNLIKE))?;
        let first = *lines.first()?;
        let placed = lines.iter().map(|v| (((v - first) / gap).round(), *v));
        let placed: Vec<(f64, f64)> = placed.collect();
        let (start, pitch) = line(&placed)?;
        let is_even = |(k, v): &(f64, f64)| (start + k * pitch - v).abs() < UNEVEN * pitch;
        // a line in pieces is one
        let told = placed.chunk_by(|a, b| (a.0 - b.0).abs() < 0.5).count();
        if told < FEWEST.max(self.count / 2) || !placed.iter().all(is_even) {
            return None;
        }
        let cells = placed.last().map_or(0.0, |last| last.0);
        let are_all = (cells - self.count as f64).abs() < 0.5;
        let before = (self.start - start) / pitch;
        let first = if are_all { 0.0 } else { before.round() };
        let is_known = are_all || (before - first).abs() < DOUBT;
        is_known.then_some(Self {
            start: start + first * pitch,
            pitch,
            count: self.count,
        })
    }

    /// The cell at a place; what lies outside goes to the next one within half a pitch.
    pub(super) fn cell(&self, at: f64) -> Option<usize> {
        let place = (at - self.start) / self.pitch;
        let inside = place > -0.5 && place < self.count as f64 + 0.5;
        inside.then(|| index(place).min(self.count - 1))
    }

    /// Whether a place lies in a cell.
    pub(super) fn holds(&self, at: f64) -> bool {
        (0.0..self.count as f64).contains(&((at - self.start) / self.pitch))
    }

    /// Where cell `i` begins.
    pub(super) fn begin(&self, i: usize) -> f64 {
        self.start + i as f64 * self.pitch
    }

    /// Distance to the nearest border of two cells, as a share of the pitch.
    pub(super) fn clearance(&self, at: f64) -> f64 {
        let place = ((at - self.start) / self.pitch).rem_euclid(1.0);
        place.min(1.0 - place)
    }
}

/// Start and step of the line of least squares through values at places; `None` where all are at one.
pub(super) fn line(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (i, v) = (mean(|p| p.0), mean(|p| p.1));
    let (iv, ii) = points.iter().fold((0.0, 0.0), |(iv, ii), p| {
        (iv + (p.0 - i) * (p.1 - v), ii + (p.0 - i).powi(2))
    });
    (ii > 0.0).then(|| (v - iv / ii * i, iv / ii))
}

/// How much ink there is along an axis.
struct Profile {
    low: f64,
    high: f64,
    step: f64,
    origin: f64,
    ink: Vec<f64>,
    total: f64,
}

impl Profile {
    fn new(spans: &[(f64, f64)]) -> Option<Self> {
        let origin = spans.iter().map(|s| s.0).reduce(f64::min)?;
        let end = spans.iter().map(|s| s.1).reduce(f64::max)?;
        let step = ((end - origin) / SAMPLES as f64).max(1e-6);
        let mut ink = vec![0.0; SAMPLES + 1];
        for (a, b) in spans {
            let place = |v: f64| index((v - origin) / step).min(SAMPLES);
            ink[place(*a)..=place(*b)]
                .iter_mut()
                .for_each(|v| *v += 1.0);
        }
        let total: f64 = ink.iter().sum();
        let quantile = |share: f64| {
            let mut sum = 0.0;
            let at = ink.iter().position(|v| {
                sum += v;
                sum >= share * total
            });
            origin + at.unwrap_or(0) as f64 * step
        };
        let (low, high) = (quantile(STRAY), quantile(1.0 - STRAY) + step);
        Some(Self {
            low,
            high,
            step,
            origin,
            ink,
            total,
        })
    }

    fn length(&self) -> f64 {
        self.high - self.low
    }

    /// Score, start and pitch of the best `n` cells of a pitch.
    fn fit(&self, pitch: f64, n: f64) -> (f64, f64, f64) {
        let at = |i: usize| self.origin + (i as f64 + 0.5) * self.step;
        let inked = || self.ink.iter().enumerate().filter(|(_, v)| **v > 0.0);
        let sums = inked().fold((0.0, 0.0), |(c, s), (i, v)| {
            let (sin, cos) = libm::sincos(TAU * at(i) / pitch);
            (c + v * cos, s + v * sin)
        });
        let strength = sums.0.hypot(sums.1) / self.total;
        // the ink is densest in the middle of the cells
        let middle = libm::atan2(sums.1, sums.0) / TAU * pitch;
        let first = middle - pitch / 2.0;
        let from = ((self.low - first) / pitch).floor() - 1.0;
        let outside = |start: f64| {
            let out = inked().filter(|(i, _)| at(*i) < start || at(*i) > start + n * pitch);
            out.map(|(_, v)| v).sum::<f64>() / self.total
        };
        let starts = (0..4).map(|k| first + (from + f64::from(k)) * pitch);
        let scored = starts.map(|s| (strength - OUTSIDE * outside(s), s, pitch));
        scored
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((0.0, self.low, pitch))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_found_although_letters_differ() {
        // widths of 0.2 to 0.8 of a pitch of 100, centred, the fifth cell empty
        let widths = [50.0, 20.0, 80.0, 35.0, 0.0, 60.0, 75.0];
        let centre = |i: usize| 300.0 + 100.0 * i as f64;
        let spans: Vec<(f64, f64)> = widths
            .iter()
            .enumerate()
            .filter(|(_, w)| **w > 0.0)
            .map(|(i, w)| (centre(i) - w / 2.0, centre(i) + w / 2.0))
            .collect();
        let axis = Axis::fit(&spans, 7, 0..7).unwrap();
        assert!((axis.pitch - 100.0).abs() < 4.0, "{axis:?}");
        for i in 0..7 {
            assert_eq!(axis.cell(centre(i)), Some(i), "{axis:?}");
        }
        let shifted = Axis::fit(&spans, 9, 1..8).unwrap();
        assert_eq!(
            shifted.cell(centre(0)),
            Some(1),
            "the first row is said to be empty"
        );
        assert_eq!(shifted.cell(centre(20)), None);
    }

    #[test]
    fn printed_lines_say_where_cells_are() {
        // by their ink cells are 2 px too long and begin 17 px too far down
        let axis = Axis {
            start: 117.0,
            pitch: 102.0,
            count: 7,
        };
        let lines = |which: &[usize], pitch: f64| -> Vec<f64> {
            let ragged = [0.3, -0.2, 0.1, 0.4, -0.4, 0.2, -0.1, 0.0];
            which
                .iter()
                .map(|&k| 100.0 + pitch * k as f64 + ragged[k])
                .collect()
        };
        for which in [&[0, 1, 2, 3, 4, 5, 6, 7][..], &[1, 2, 4, 5, 7]] {
            let exact = axis.between(&lines(which, 100.0)).unwrap();
            for k in 0..=7 {
                let off = exact.begin(k) - 100.0 - 100.0 * k as f64;
                assert!(off.abs() < 0.5, "{which:?} {exact:?}");
            }
        }
        for few in [&[2, 3][..], &[2, 2, 3, 3, 3]] {
            assert_eq!(axis.between(&lines(few, 100.0)), None, "too few");
        }
        let writing = lines(&[0, 1, 2, 3, 4, 5, 6, 7], 50.0);
        assert_eq!(axis.between(&writing), None, "two lines a row");
        let mut uneven = lines(&[0, 1, 2, 3, 4, 5, 6, 7], 100.0);
        uneven[4] += 8.0;
        assert_eq!(axis.between(&uneven), None, "no grid");
    }
}
