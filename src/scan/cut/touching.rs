//! Ink of several letters that touch → a piece of ink for each, cut where least ink joins them.
//!
//! Which of the ink there is whose nobody knows: such letters are warned of.

use super::{Component, Slot, Warning};
use crate::numeric::view::View;
use crate::scan::whole::floor;
use kurbo::{Point, Rect};
use std::ops::Range;

/// Letters that touch are so unequal at most: each ends within this share of a mean width from where equal ones would.
const UNEQUAL: f64 = 0.25;
/// Strokes whose thickness differs by so many px are as thick: a scanner's grain takes one from each side.
const GRAIN: usize = 2;

/// The direction in which letters that touch follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Axis {
    Across,
    Down,
}

/// Ink that is of several letters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Touch {
    /// Indices of its components.
    ink: Vec<usize>,
    axis: Axis,
    /// Where one letter ends and the next one begins, upright px.
    ends: Vec<Range<f64>>,
}

impl Touch {
    /// Letters of one row, so many within `bounds`.
    pub(super) fn beside(ink: Vec<usize>, bounds: Rect, letters: usize) -> Self {
        let width = bounds.width() / letters as f64;
        let end = |k: usize| {
            let middle = bounds.x0 + k as f64 * width;
            middle - UNEQUAL * width..middle + UNEQUAL * width
        };
        Self {
            ink,
            axis: Axis::Across,
            ends: (1..letters).map(end).collect(),
        }
    }

    /// A letter of one row and one of the next, whose middles are at `rows`.
    pub(super) fn below(ink: Vec<usize>, rows: Range<f64>) -> Self {
        let (pitch, middle) = (rows.end - rows.start, (rows.start + rows.end) / 2.0);
        let end = middle - UNEQUAL * pitch..middle + UNEQUAL * pitch;
        Self {
            ink,
            axis: Axis::Down,
            ends: vec![end],
        }
    }

    /// Cuts the ink in `all`, where new pieces go to the end, and says which pieces were cut from others.
    pub(super) fn part(&self, all: &mut Vec<Component>, upright: &View) -> Vec<usize> {
        let along = |x: usize, y: usize| {
            let at = upright.at(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            match self.axis {
                Axis::Across => at.x,
                Axis::Down => at.y,
            }
        };
        let pixels = || self.ink.iter().flat_map(|&i| all[i].pixels());
        let places: Vec<f64> = pixels().map(|(x, y)| along(x, y)).collect();
        let cuts: Vec<f64> = self.ends.iter().map(|end| thinnest(&places, end)).collect();
        let mut parted = Vec::new();
        for &i in &self.ink {
            let mut pieces = vec![all[i].clone()];
            for &cut in &cuts {
                let parts = pieces.iter().map(|p| p.parted(|x, y| along(x, y) < cut));
                pieces = parts.flatten().collect();
            }
            pieces.iter_mut().for_each(|p| p.stand(upright));
            let first = (pieces.len() > 1).then(|| pieces.swap_remove(0));
            if let Some(first) = first {
                all[i] = first;
                parted.push(i);
                parted.extend(all.len()..all.len() + pieces.len());
                all.append(&mut pieces);
            }
        }
        parted
    }
}

/// Where least ink lies in a stretch of `places`, px: nearest to its middle where there is as little for long.
fn thinnest(places: &[f64], stretch: &Range<f64>) -> f64 {
    let mut ink = vec![0; floor(stretch.end - stretch.start) + 1];
    for at in places.iter().filter(|p| stretch.contains(p)) {
        ink[floor(at - stretch.start)] += 1;
    }
    let least = ink.iter().min().copied().unwrap_or(0);
    let middle = ink.len() / 2;
    let thin = (0..ink.len()).filter(|&k| ink[k] <= least + GRAIN);
    let thin = thin.min_by_key(|k| k.abs_diff(middle)).unwrap_or(middle);
    stretch.start + thin as f64 + 0.5
}

/// Warns of the letters that have some of the ink that was cut.
pub(super) fn warnings(slots: &[&Slot], parted: &[usize]) -> Vec<Warning> {
    let cut = slots
        .iter()
        .filter(|s| s.parts.iter().any(|i| parted.contains(i)));
    let message = "it touches a letter beside it and was cut off where least ink joins the two: draw them clear of each other, or say \
        where it ends by `polygon` under [cells.NAME]";
    cut.map(|s| Warning::of(s, message)).collect()
}
