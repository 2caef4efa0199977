//! A recognised page → its drawings, upright and without the printed guides.

use super::draw::{GUIDE_WIDTH, Joins, guides, joining};
use super::find::Found;
use super::gain::Gain;
use super::layout::{Layout, Place};
use super::tile::Tile;
use crate::numeric::cast::{index, single};
use crate::numeric::surface::Surface;
use crate::numeric::tone;
use crate::types::{Cell, Gray, Guides, Label, Sheet};
use kurbo::{Affine, Line, Point, Rect, Vec2};
use rayon::prelude::*;

/// Cut from each side of a field: half its frame's width and the frame's blur. mm
const INSET: f64 = GUIDE_WIDTH / 2.0 + 0.17;
/// Paper left around a drawing: enough to see its level. px
const MARGIN: f64 = 12.0;
/// Ink this near to a field's edge touches it. px
const TOUCH: f64 = 1.5;

/// What a field holds.
#[derive(Debug, Clone)]
pub struct Drawing {
    /// Its picture and place; without ink where nothing was drawn.
    pub cell: Cell,
    /// Whether anything was drawn.
    pub inked: bool,
    /// Whether ink reaches the field's edge on a side where the form does not join.
    pub cut_off: bool,
    /// Pieces of dust that were taken out.
    pub specks: usize,
    /// The longer side of its ink, em; 0 without ink.
    pub size_em: f64,
}

/// What was drawn on a page, each field resampled once so that it stands upright at its own scan's resolution,
/// the guides' grey and the dust taken out, its edges where `gain` says that they were before the ink spread.
#[must_use]
pub fn drawings(
    sheet: &Sheet,
    layout: &Layout,
    found: &Found,
    places: &[Place],
    gain: Option<&Gain>,
) -> Vec<Drawing> {
    let level = gain.map_or(0.5, Gain::level);
    let one = |p: &Place| drawing(sheet, layout, found, (p, level));
    places.par_iter().map(one).collect()
}

fn drawing(
    sheet: &Sheet,
    layout: &Layout,
    found: &Found,
    (place, level): (&Place, f64),
) -> Drawing {
    let field = place.field.inset(-INSET);
    let px_per_mm = found.surface.scale(field.center());
    let mut tile = resample(sheet, &found.surface, field, px_per_mm);
    let (mut ink, mut specks) = (None, 0);
    if tile.normalise(found.contrast) {
        let to_tile = Affine::scale(px_per_mm) * Affine::translate(-field.origin().to_vec2());
        for line in guides(layout, place) {
            tile.lift(
                Line::new(to_tile * line.p0, to_tile * line.p1),
                GUIDE_WIDTH * px_per_mm / 2.0,
            );
        }
        (ink, specks) = tile.dust();
    } else {
        tile.samples.fill(0.0);
    }
    let whole = Rect::new(0.0, 0.0, tile.w as f64, tile.h as f64);
    let window = ink.map_or(whole, |r| r.inflate(MARGIN, MARGIN).intersect(whole));
    let to_mm = Affine::translate(field.origin().to_vec2())
        * Affine::scale(1.0 / px_per_mm)
        * Affine::translate(window.origin().to_vec2());
    let seen = to_mm.transform_rect_bbox(ink.unwrap_or(window) - window.origin().to_vec2());
    let cell = Cell {
        label: Label(place.label.clone()),
        index: place.index,
        in_sheet: found.surface.bounds(seen),
        to_sheet: found.surface.near(field.center()) * to_mm,
        guides: Guides {
            baseline_px: (place.baseline - field.y0) * px_per_mm - window.y0,
            px_per_em: layout.em() * px_per_mm,
            row: None,
        },
        gray: crop(&tile, window, level).with_scatter(sheet.gray.scatter_px()),
        plates: Vec::new(),
    };
    let joins = joining(&place.label);
    Drawing {
        cell,
        inked: ink.is_some(),
        cut_off: ink.is_some_and(|r| touches(r, whole, &joins)),
        specks,
        size_em: ink.map_or(0.0, |r| r.width().max(r.height()) / px_per_mm / layout.em()),
    }
}

/// Whether ink reaches an edge at which nothing joins.
fn touches(ink: Rect, field: Rect, joins: &Joins) -> bool {
    let near = field.inset(-TOUCH);
    let sides = (ink.x0 < near.x0 && !joins.left) || (ink.x1 > near.x1 && !joins.right);
    sides || ink.y0 < near.y0 || ink.y1 > near.y1
}

/// A rectangle of the page at `px_per_mm`.
fn resample(sheet: &Sheet, surface: &Surface, field: Rect, px_per_mm: f64) -> Tile {
    let [w, h] = [field.width(), field.height()].map(|side| index(side * px_per_mm));
    let page = |p: Point| field.origin() + p.to_vec2() / px_per_mm;
    let mut samples = Vec::with_capacity(w * h);
    for y in 0..h {
        for x in 0..w {
            let p = page(Point::new(x as f64 + 0.5, y as f64 + 0.5));
            samples.push(cubic_sample(&sheet.gray, surface.at(p)));
        }
    }
    Tile { samples, w, h }
}

/// Whole pixels of a tile, the edges put where ink that has spread had them: coverage `level` becomes a half.
fn crop(tile: &Tile, window: Rect, level: f64) -> Gray {
    let (left, top) = (index(window.x0), index(window.y0));
    let at = |x: usize, y: usize| {
        let sample = tile.samples[(y + top) * tile.w + x + left];
        tone::at_half(single(sample), level)
    };
    Gray::from_fn(index(window.width()), index(window.height()), at)
}

/// Coverage at a point by Catmull-Rom's cubic through 4 × 4 pixels; the border's pixels go on beyond it.
fn cubic_sample(gray: &Gray, p: Point) -> f64 {
    let q = p - Vec2::new(0.5, 0.5);
    let (w, h) = (gray.width() as f64, gray.height() as f64);
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
        let row = gray.row(index((y - 1.0 + j as f64).clamp(0.0, h - 1.0)));
        for (i, a) in wx.iter().enumerate() {
            let column = index((x - 1.0 + i as f64).clamp(0.0, w - 1.0));
            sum += a * b * f64::from(row.get(column).copied().unwrap_or(0.0));
        }
    }
    sum
}
