//! Values between those of a grid, by a kernel that keeps what the grid can hold: Lanczos of three lobes.

use super::cast::{index, single};
use std::f64::consts::PI;

/// Lobes of the kernel: it looks so many px to each side.
pub const LOBES: usize = 3;
/// Positions between two pixels for which the kernel is tabled.
const PHASES: usize = 512;

/// The kernel, tabled.
#[derive(Debug)]
pub struct Lanczos {
    taps: Vec<[f32; 2 * LOBES]>,
}

impl Default for Lanczos {
    fn default() -> Self {
        let sinc = |x: f64| {
            if x.abs() < 1e-9 {
                1.0
            } else {
                libm::sin(PI * x) / (PI * x)
            }
        };
        let weight = |x: f64| {
            if x.abs() < LOBES as f64 {
                sinc(x) * sinc(x / LOBES as f64)
            } else {
                0.0
            }
        };
        let phase = |i: usize| {
            let t = i as f64 / PHASES as f64;
            let raw: [f64; 2 * LOBES] =
                std::array::from_fn(|k| weight(k as f64 + 1.0 - LOBES as f64 - t));
            let sum: f64 = raw.iter().sum();
            raw.map(|w| single(w / sum))
        };
        Self {
            taps: (0..=PHASES).map(phase).collect(),
        }
    }
}

impl Lanczos {
    /// What rows of `width` values hold at a place between them, in columns and rows from the first one's centre; the
    /// nearest before it where the kernel reaches beyond them, and 0 outside.
    #[must_use]
    pub fn sample(&self, values: &[f32], width: usize, (x, y): (f64, f64)) -> f32 {
        let height = values.len().checked_div(width).unwrap_or(0);
        let split = |v: f64| {
            let part = index((v - v.floor()) * PHASES as f64 + 0.5);
            (v.floor(), &self.taps[part])
        };
        let ((x, across), (y, down)) = (split(x), split(y));
        let first = 1.0 - LOBES as f64;
        let (left, top) = (x + first, y + first);
        let side = (2 * LOBES) as f64;
        let reached =
            left >= 0.0 && top >= 0.0 && left + side <= width as f64 && top + side <= height as f64;
        if !reached {
            let inside = x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64;
            return if inside {
                values[index(y) * width + index(x)]
            } else {
                0.0
            };
        }
        let start = index(top) * width + index(left);
        let line = |(k, w): (usize, &f32)| {
            let row = &values[start + k * width..][..2 * LOBES];
            w * row.iter().zip(across).map(|(v, w)| v * w).sum::<f32>()
        };
        down.iter().enumerate().map(line).sum()
    }
}
