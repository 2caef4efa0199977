//! Ink that lies outside all fields of a recognised page.

use super::find::{Blot, Found, blots};
use super::layout::{Layout, Place};
use crate::numeric::bilinear::bilinear;
use crate::numeric::cast::index;
use crate::numeric::median::quantile;
use crate::types::Sheet;
use image::{GrayImage, Luma};
use kurbo::{Point, Rect};
use rayon::prelude::*;

/// Samples a millimetre: a pen's line is two wide.
const PER_MM: f64 = 5.0;
/// Side of the blocks in which the paper's level is taken. mm
const BLOCK: f64 = 8.0;
/// Percentile of a block's samples that is paper.
const PAPER: f64 = 0.3;
/// Ink is darker than its paper by this share of the contrast that the page's marks have; captions lie in no asked
/// place, the guides' colour is lighter.
const DARK: f64 = 0.45;
/// Around a field, and above it for its caption, ink is asked for inside. mm
const RIM: f64 = 0.45;
/// Smaller pieces are dust. mm²
const DUST: f64 = 0.4;

/// Pieces of ink between and beside the fields: rectangles in the picture and areas, px and px².
#[must_use]
pub fn stray(sheet: &Sheet, layout: &Layout, found: &Found, places: &[Place]) -> Vec<(Rect, f64)> {
    let area = layout.body_mm();
    let (w, h) = (index(area.width() * PER_MM), index(area.height() * PER_MM));
    let page = |x: f64, y: f64| area.origin() + Point::new(x, y).to_vec2() / PER_MM;
    let row = |y: usize| {
        let at = |x: usize| {
            let p = page(x as f64 + 0.5, y as f64 + 0.5);
            bilinear(
                sheet.gray.samples(),
                sheet.gray.width(),
                found.surface.at(p),
            )
        };
        (0..w).map(at).collect::<Vec<f64>>()
    };
    let samples: Vec<Vec<f64>> = (0..h).into_par_iter().map(row).collect();
    let block = index(BLOCK * PER_MM);
    let paper = |bx: usize, by: usize| {
        let rows = samples.iter().skip(by * block).take(block);
        let mut all: Vec<f64> = rows
            .flat_map(|r| r.iter().skip(bx * block).take(block))
            .copied()
            .collect();
        quantile(&mut all, PAPER, f64::total_cmp).unwrap_or(0.0)
    };
    let (columns, rows) = (w.div_ceil(block), h.div_ceil(block));
    let levels: Vec<Vec<f64>> = (0..rows)
        .map(|by| (0..columns).map(|bx| paper(bx, by)).collect())
        .collect();
    let fields: Vec<Rect> = places
        .iter()
        .map(|p| Rect::new(p.field.x0, p.caption.y, p.field.x1, p.field.y1).inflate(RIM, RIM))
        .collect();
    let inked = |x: usize, y: usize| {
        let level = levels[y / block][x / block];
        let p = page(x as f64 + 0.5, y as f64 + 0.5);
        samples[y][x] > level + DARK * found.contrast && !fields.iter().any(|f| f.contains(p))
    };
    #[expect(
        clippy::cast_possible_truncation,
        reason = "paper is at most some metres wide"
    )]
    let bits = GrayImage::from_fn(w as u32, h as u32, |x, y| {
        Luma([u8::from(inked(x as usize, y as usize))])
    });
    let large = |b: &Blot| b.area / (PER_MM * PER_MM) > DUST;
    let pieces = blots(&bits).into_iter().filter(large);
    let there = pieces.map(|Blot { bounds: r, area }| {
        let there = Rect::from_points(page(r.x0, r.y0), page(r.x1, r.y1));
        let scale = found.surface.scale(there.center()) / PER_MM;
        (found.surface.bounds(there), area * scale * scale)
    });
    there.collect()
}
