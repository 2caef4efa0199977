//! A recognised page → its cells, upright and without the printed guides.

use super::draw::{GUIDE_WIDTH, guides};
use super::find::{Found, as_f64, floor};
use super::layout::{Layout, Place};
use super::view::View;
use crate::types::{Cell, Gray, Guides, Label, Sheet};
use kurbo::{Affine, Line, Point, Rect, Vec2};
use rayon::prelude::*;

/// Cut from each side of a field: half its frame's width and the frame's blur. mm
const INSET: f64 = GUIDE_WIDTH / 2.0 + 0.17;
/// Between ink and paper must lie at least this much, or the field is empty.
const CONTRAST: f64 = 0.15;
/// A sample below this is paper or guide, above it may be ink: the guides' colour is at most 0.2 grey.
const SURELY_PAPER: f64 = 0.3;
/// How far a guide's blur reaches beyond its edge. px
const BLUR_PX: f64 = 2.5;

/// The drawings of a page, each resampled once so that it stands upright at its own scan's resolution, the
/// guides' grey taken from it. A field without ink gives a cell without ink.
#[must_use]
pub fn cells(sheet: &Sheet, layout: &Layout, found: &Found, places: &[Place]) -> Vec<Cell> {
    places
        .par_iter()
        .map(|p| cell(sheet, layout, found, p))
        .collect()
}

fn cell(sheet: &Sheet, layout: &Layout, found: &Found, place: &Place) -> Cell {
    let field = place.field.inset(-INSET);
    let px_per_mm = found.view.scale(field.center());
    let (w, h) = (
        floor(field.width() * px_per_mm),
        floor(field.height() * px_per_mm),
    );
    let page = |p: Point| field.origin() + p.to_vec2() / px_per_mm;
    let mut samples = Vec::with_capacity(w * h);
    for y in 0..h {
        for x in 0..w {
            let p = page(Point::new(as_f64(x) + 0.5, as_f64(y) + 0.5));
            samples.push(cubic_sample(&sheet.gray, found.view.at(p)));
        }
    }
    let mut tile = Tile { samples, w, h };
    if tile.normalise() {
        let to_tile = Affine::scale(px_per_mm) * Affine::translate(-field.origin().to_vec2());
        for line in guides(layout, place) {
            tile.lift(
                Line::new(to_tile * line.p0, to_tile * line.p1),
                GUIDE_WIDTH * px_per_mm / 2.0,
            );
        }
    } else {
        tile.samples.fill(0.0);
    }
    #[expect(
        clippy::cast_possible_truncation,
        reason = "samples are single precision"
    )]
    let gray = Gray::from_fn(w, h, |x, y| tile.samples[y * w + x] as f32);
    let to_mm = Affine::translate(field.origin().to_vec2()) * Affine::scale(1.0 / px_per_mm);
    Cell {
        label: Label(place.label.clone()),
        index: place.index,
        in_sheet: bounds(&found.view, field),
        to_sheet: found.view.near(field.center()) * to_mm,
        guides: Guides {
            baseline_px: (place.baseline - field.y0) * px_per_mm,
            px_per_em: layout.em() * px_per_mm,
            advance_px: None,
        },
        gray,
    }
}

/// The upright rectangle around a page rectangle's picture, px.
fn bounds(view: &View, r: Rect) -> Rect {
    let corners = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)];
    let seen = corners.map(|c| view.at(c.into()));
    seen.iter()
        .fold(Rect::from_points(seen[0], seen[2]), |b, &p| b.union_pt(p))
}

struct Tile {
    samples: Vec<f64>,
    w: usize,
    h: usize,
}

impl Tile {
    /// Makes paper 0 and ink 1, a slope of the light across the field taken out; false where there is no ink.
    fn normalise(&mut self) -> bool {
        let (low, high) = (
            quantile(&self.samples, 0.02),
            quantile(&self.samples, 0.998),
        );
        if high - low < CONTRAST {
            return false;
        }
        let middle = (low + high) / 2.0;
        let slope = self.paper_plane(low + (middle - low) * 0.6);
        let size = Vec2::new(as_f64(self.w), as_f64(self.h));
        for (i, v) in self.samples.iter_mut().enumerate() {
            let (x, y) = (as_f64(i % self.w) / size.x, as_f64(i / self.w) / size.y);
            *v -= slope[0] + slope[1] * x + slope[2] * y;
        }
        let half = (high - low) / 2.0;
        let dark: Vec<f64> = self.samples.iter().copied().filter(|&v| v > half).collect();
        let ink = quantile(&dark, 0.6);
        if dark.is_empty() || ink < CONTRAST {
            return false;
        }
        self.samples.iter_mut().for_each(|v| *v /= ink);
        true
    }

    /// Level and slopes of the paper, by least squares over the samples below `most`.
    fn paper_plane(&self, most: f64) -> [f64; 3] {
        let mut a = nalgebra::Matrix3::zeros();
        let mut b = nalgebra::Vector3::zeros();
        for (i, &v) in self.samples.iter().enumerate().filter(|(_, v)| **v < most) {
            let (x, y) = (
                as_f64(i % self.w) / as_f64(self.w),
                as_f64(i / self.w) / as_f64(self.h),
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
    fn lift(&mut self, line: Line, half_width: f64) {
        let reach = half_width + BLUR_PX;
        let (y0, y1) = (
            floor((line.p0.y - reach).max(0.0)),
            floor((line.p0.y + reach).max(0.0)) + 1,
        );
        let (x0, x1) = (
            floor(line.p0.x.max(0.0)),
            floor(line.p1.x.max(0.0)).min(self.w),
        );
        for y in y0..y1.min(self.h) {
            let Some(row) = self.samples.get_mut(y * self.w + x0..y * self.w + x1) else {
                continue;
            };
            let paper: Vec<f64> = row.iter().copied().filter(|&v| v < SURELY_PAPER).collect();
            if paper.len() * 8 < row.len() {
                continue;
            }
            let grey = quantile(&paper, 0.5).clamp(0.0, SURELY_PAPER);
            row.iter_mut().for_each(|v| *v = (*v - grey) / (1.0 - grey));
        }
    }
}

/// The value below which a share of the values lies; 0 of none.
fn quantile(values: &[f64], share: f64) -> f64 {
    let mut v = values.to_vec();
    if v.is_empty() {
        return 0.0;
    }
    let k = floor(share * as_f64(v.len() - 1)).min(v.len() - 1);
    *v.select_nth_unstable_by(k, f64::total_cmp).1
}

/// Coverage at a point by Catmull-Rom's cubic through 4 × 4 pixels; the border's pixels go on beyond it.
fn cubic_sample(gray: &Gray, p: Point) -> f64 {
    let q = p - Vec2::new(0.5, 0.5);
    let (w, h) = (as_f64(gray.width()), as_f64(gray.height()));
    if !(q.x > -1.0 && q.y > -1.0 && q.x < w && q.y < h) {
        return 0.0;
    }
    let weights = |t: f64| {
        let (t2, t3) = (t * t, t * t * t);
        [
            (2.0 * t2 - t - t3) / 2.0,
            (2.0 - 5.0 * t2 + 3.0 * t3) / 2.0,
            (t + 4.0 * t2 - 3.0 * t3) / 2.0,
            (t3 - t2) / 2.0,
        ]
    };
    let (x, y) = (q.x.floor(), q.y.floor());
    let (wx, wy) = (weights(q.x - x), weights(q.y - y));
    let mut sum = 0.0;
    for (j, b) in wy.iter().enumerate() {
        let row = gray.row(floor((y - 1.0 + as_f64(j)).clamp(0.0, h - 1.0)));
        for (i, a) in wx.iter().enumerate() {
            let column = floor((x - 1.0 + as_f64(i)).clamp(0.0, w - 1.0));
            sum += a * b * f64::from(row.get(column).copied().unwrap_or(0.0));
        }
    }
    sum
}
