//! A cell's ink made small: what every way of matching begins with.

use super::skeleton::parts;
use crate::types::{Bitmap, Gray};
use kurbo::Rect;

/// Longest side of the small picture, px: strokes of a letter are then 3 to 15 px wide.
const SIDE: usize = 64;
/// A line thinner than this in the small picture, px, is kept by a lower threshold.
const THIN: f32 = 1.5;
/// Parts no longer than this share of the largest part are marks.
const MARK_SIDE: f64 = 0.55;

/// Ink cut out and made small; px, y down.
#[derive(Debug, Clone)]
pub(crate) struct Ink {
    /// The largest part and those of its size.
    pub(crate) body: Bitmap,
    /// The small parts, each alone in the picture.
    pub(crate) marks: Vec<Bitmap>,
    /// The ink's rectangle in the cell, px, y down.
    pub(crate) bounds: Rect,
}

impl Ink {
    /// The ink of a picture; `None` where there is none.
    pub(crate) fn new(gray: &Gray) -> Option<Self> {
        let (x, y) = (span(gray, Axis::X)?, span(gray, Axis::Y)?);
        let bits = shrink(gray, x, y);
        let (label, count) = parts(&bits);
        let boxes = part_boxes(&bits, &label, count);
        let main = (0..count).max_by_key(|&p| (boxes[p].1, count - p))?;
        let side = |p: usize| boxes[p].0.size().max_side();
        let is_mark = |p: usize| p != main && side(p) < MARK_SIDE * side(main);
        let pick = |keep: &dyn Fn(usize) -> bool| {
            bits.with_bits(label.iter().map(|l| l.is_some_and(keep)))
        };
        let marks = (0..count).filter(|&p| is_mark(p));
        let [x0, x1, y0, y1] = [x.0, x.1, y.0, y.1].map(|v| v as f64);
        Some(Self {
            body: pick(&|p| !is_mark(p)),
            marks: marks.map(|m| pick(&|p| p == m)).collect(),
            bounds: Rect::new(x0, y0, x1, y1),
        })
    }

    /// Body and marks together.
    pub(crate) fn whole(&self) -> Bitmap {
        let set = |i: usize| self.marks.iter().any(|m| m.bits()[i]);
        let bits = self.body.bits().iter().enumerate();
        self.body.with_bits(bits.map(|(i, b)| *b || set(i)))
    }
}

#[derive(Clone, Copy)]
enum Axis {
    X,
    Y,
}

/// First column or row with ink, and the one after the last.
fn span(gray: &Gray, axis: Axis) -> Option<(usize, usize)> {
    let (n, m) = match axis {
        Axis::X => (gray.width(), gray.height()),
        Axis::Y => (gray.height(), gray.width()),
    };
    let inked = |i: &usize| {
        (0..m).any(|j| match axis {
            Axis::X => gray.at(*i, j) >= 0.5,
            Axis::Y => gray.at(j, *i) >= 0.5,
        })
    };
    Some(((0..n).find(inked)?, (0..n).rev().find(inked)? + 1))
}

/// Mean coverage over boxes, cut at a level that keeps thin lines whole.
fn shrink(gray: &Gray, x: (usize, usize), y: (usize, usize)) -> Bitmap {
    let (w, h) = (x.1 - x.0, y.1 - y.0);
    let longest = w.max(h);
    let fit = |n: usize| {
        if longest > SIDE {
            (n * SIDE).div_ceil(longest)
        } else {
            n
        }
    };
    let (nw, nh) = (fit(w), fit(h));
    let edges = |from: usize, n: usize, to: usize, i: usize| {
        let start = from + i * n / to;
        start..(from + (i + 1) * n / to).max(start + 1)
    };
    let small = Gray::from_fn(nw, nh, |i, j| {
        let columns = edges(x.0, w, nw, i);
        let rows = edges(y.0, h, nh, j);
        let count = columns.len() * rows.len();
        let sum: f32 = rows
            .map(|r| {
                gray.row(r)
                    .get(columns.clone())
                    .unwrap_or(&[])
                    .iter()
                    .sum::<f32>()
            })
            .sum();
        sum / count as f32
    });
    let reduction = longest as f32 / nw.max(nh) as f32;
    let pen = pen_width(gray, x, y) / reduction;
    Bitmap::threshold(&small, (0.5 * pen / THIN).clamp(0.12, 0.5))
}

/// Mean width of the lines, px: twice the ink over its border.
fn pen_width(gray: &Gray, x: (usize, usize), y: (usize, usize)) -> f32 {
    let ink = |i: usize, j: usize| gray.at(i, j) >= 0.5;
    let (mut area, mut border) = (0_usize, 0_usize);
    for j in y.0..y.1 {
        for i in (x.0..x.1).filter(|&i| ink(i, j)) {
            area += 1;
            border += usize::from(!ink(i + 1, j)) + usize::from(!ink(i, j + 1));
        }
    }
    // Two of the four sides were counted.
    area as f32 / border.max(1) as f32
}

/// The box around each part, px, and how many pixels it has.
fn part_boxes(bits: &Bitmap, label: &[Option<usize>], count: usize) -> Vec<(Rect, usize)> {
    let mut boxes = vec![(Rect::ZERO, 0); count];
    for (i, part) in label.iter().enumerate() {
        if let Some(part) = *part {
            let at = ((i % bits.width()) as f64, (i / bits.width()) as f64);
            let pixel = Rect::from_origin_size(at, (1.0, 1.0));
            let (bounds, ink) = &mut boxes[part];
            *bounds = if *ink > 0 { bounds.union(pixel) } else { pixel };
            *ink += 1;
        }
    }
    boxes
}
