//! The picture of one field: its light evened, its printed guides and its dust taken out.

use super::find::{Blot, labelled};
use crate::numeric::cast::index;
use crate::numeric::median::quantile;
use crate::numeric::pieces::around;
use image::{GrayImage, Luma};
use imageproc::definitions::Image;
use kurbo::{Line, Rect, Vec2};

/// Between ink and paper must lie at least this share of the contrast that the page's marks have, or the field is
/// empty: a pencil reaches it, the guides' colour does not.
const CONTRAST: f64 = 0.25;
/// A sample below this is paper or guide, above it may be ink: the guides' colour is at most 0.2 grey.
const SURELY_PAPER: f64 = 0.3;
/// How far a guide's blur reaches beyond its edge. px
const BLUR_PX: f64 = 2.5;
/// Coverage from which connected ink counts: thin strokes hold together.
const LOW: f64 = 0.33;
/// Ink smaller than a square of this many stroke widths is dust: a dot is at least a disc of one.
const DUST: f64 = 0.7;
/// How far the blurred edge of dust reaches. px
const RIM: usize = 2;

/// Samples of a field, row by row.
pub(super) struct Tile {
    pub(super) samples: Vec<f64>,
    pub(super) w: usize,
    pub(super) h: usize,
}

impl Tile {
    /// Makes paper 0 and ink 1, a slope of the light across the field taken out; false where there is no ink.
    /// `contrast` is that of the page's marks.
    pub(super) fn normalise(&mut self, contrast: f64) -> bool {
        let least = CONTRAST * contrast;
        let mut all = self.samples.clone();
        let mut at = |share: f64| quantile(&mut all, share, f64::total_cmp).unwrap_or(0.0);
        let (low, high) = (at(0.02), at(0.998));
        if high - low < least {
            return false;
        }
        let middle = (low + high) / 2.0;
        let slope = self.paper_plane(low + (middle - low) * 0.6);
        let size = Vec2::new(self.w as f64, self.h as f64);
        for (i, v) in self.samples.iter_mut().enumerate() {
            let (x, y) = ((i % self.w) as f64 / size.x, (i / self.w) as f64 / size.y);
            *v -= slope[0] + slope[1] * x + slope[2] * y;
        }
        let half = (high - low) / 2.0;
        let mut dark: Vec<f64> = self.samples.iter().copied().filter(|&v| v > half).collect();
        let ink = quantile(&mut dark, 0.6, f64::total_cmp);
        let Some(ink) = ink.filter(|ink| *ink >= least) else {
            return false;
        };
        self.samples.iter_mut().for_each(|v| *v /= ink);
        true
    }

    /// Takes out what is smaller than any dot of the drawing's pen; gives the box around the rest, px, and how
    /// many pieces it took out.
    pub(super) fn dust(&mut self) -> (Option<Rect>, usize) {
        let ink = |i: usize| self.samples[i] >= LOW;
        #[expect(
            clippy::cast_possible_truncation,
            reason = "a field is a part of a picture"
        )]
        let (w, h) = (self.w as u32, self.h as u32);
        let bits = GrayImage::from_fn(w, h, |x, y| Luma([u8::from(ink((y * w + x) as usize))]));
        let (labels, pieces) = labelled(&bits);
        let largest = (1..).zip(&pieces);
        let largest = largest.max_by(|a, b| a.1.area.total_cmp(&b.1.area));
        let stroke = largest.map_or(0.0, |(label, _)| stroke(&labels, label));
        let least = (DUST * stroke).powi(2).max(2.0);
        let (kept, dust): (Vec<Blot>, Vec<Blot>) = pieces.iter().partition(|p| p.area >= least);
        let kept_at = |x: usize, y: usize| {
            let labels = around((x, y), RIM, (self.w, self.h)).map(|i| labels.as_raw()[i] as usize);
            let mut pieces = labels.filter_map(|l| Some(&pieces[l.checked_sub(1)?]));
            pieces.any(|p| p.area >= least)
        };
        let mut cleared = Vec::new();
        for piece in &dust {
            let rim = piece.bounds.inflate(RIM as f64, RIM as f64);
            for y in index(rim.y0.max(0.0))..index(rim.y1).min(self.h) {
                for x in index(rim.x0.max(0.0))..index(rim.x1).min(self.w) {
                    cleared.extend((!kept_at(x, y)).then_some(y * self.w + x));
                }
            }
        }
        cleared.into_iter().for_each(|i| self.samples[i] = 0.0);
        let bounds = kept.iter().map(|p| p.bounds).reduce(|a, b| a.union(b));
        (bounds, dust.len())
    }

    /// Level and slopes of the paper, by least squares over the samples below `most`.
    fn paper_plane(&self, most: f64) -> [f64; 3] {
        let mut a = nalgebra::Matrix3::zeros();
        let mut b = nalgebra::Vector3::zeros();
        for (i, &v) in self.samples.iter().enumerate().filter(|(_, v)| **v < most) {
            let (x, y) = (
                (i % self.w) as f64 / self.w as f64,
                (i / self.w) as f64 / self.h as f64,
            );
            let row = nalgebra::Vector3::new(1.0, x, y);
            a += row * row.transpose();
            b += row * v;
        }
        let level = if a[(0, 0)] > 0.0 {
            b[0] / a[(0, 0)]
        } else {
            0.0
        };
        a.cholesky()
            .map_or([level, 0.0, 0.0], |c| c.solve(&b).into())
    }

    /// Takes a level guide out: on each row that it greys, what the paper there has above white is printed,
    /// and ink over it covers it.
    pub(super) fn lift(&mut self, line: Line, half_width: f64) {
        let reach = half_width + BLUR_PX;
        let (y0, y1) = (
            index((line.p0.y - reach).max(0.0)),
            index((line.p0.y + reach).max(0.0)) + 1,
        );
        let (x0, x1) = (
            index(line.p0.x.max(0.0)),
            index(line.p1.x.max(0.0)).min(self.w),
        );
        for y in y0..y1.min(self.h) {
            let Some(row) = self.samples.get_mut(y * self.w + x0..y * self.w + x1) else {
                continue;
            };
            let mut paper: Vec<f64> = row.iter().copied().filter(|&v| v < SURELY_PAPER).collect();
            if paper.len() * 8 < row.len() {
                continue;
            }
            let grey = quantile(&mut paper, 0.5, f64::total_cmp).unwrap_or(0.0);
            let grey = grey.clamp(0.0, SURELY_PAPER);
            row.iter_mut().for_each(|v| *v = (*v - grey) / (1.0 - grey));
        }
    }
}

/// Rough width of a blot's stroke, px: twice the area over the length of its edge.
fn stroke(labels: &Image<Luma<u32>>, label: u32) -> f64 {
    let paper = |x: u32, y: u32| {
        let beside = labels.get_pixel_checked(x, y);
        f64::from(u8::from(beside.is_none_or(|Luma([label])| *label == 0)))
    };
    // steps from ink to paper along rows, and along columns: two for each last pixel
    let (mut area, mut across, mut down) = (0.0, 0.0, 0.0);
    for (x, y, Luma([own])) in labels.enumerate_pixels() {
        if *own == label {
            area += 1.0;
            across += 2.0 * paper(x + 1, y);
            down += 2.0 * paper(x, y + 1);
        }
    }
    2.0 * area / (f64::max(across, down) + f64::min(across, down) / 2.0).max(1.0)
}
