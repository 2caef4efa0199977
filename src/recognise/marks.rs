//! Dots, hamzas and other small parts beside a letter's body: how many, and where.
//!
//! Pens join dots: two become a dash, three a caret. So a mark counts by its length and width in pens,
//! not by the number of parts, and the count is no whole number where the ink leaves it open.

use crate::types::Bitmap;
use kurbo::{Point, Rect};

/// Length of a mark in pens from which it begins to be two dots, and over how many more it becomes that.
const DASH: (f64, f64) = (2.2, 1.5);
/// Width of a long mark in pens from which it begins to be three dots, and over how many more.
const CARET: (f64, f64) = (1.4, 0.5);
/// Less ink than this in squared pens is dust.
const DUST: f64 = 0.4;
/// Nothing has more dots.
const MOST: f64 = 3.0;

/// The small parts of a letter together.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(crate) struct Marks {
    /// As many dots as their ink stands for, 0…3.
    pub(crate) dots: f64,
    /// Centre of their ink from the body's centre, half the body's longer side being 1; y down, −1.2…1.2.
    pub(crate) at: (f64, f64),
}

impl Marks {
    /// Weighs `marks` drawn with a pen of width `pen_px` beside a body inside `body`; px, y down.
    pub(crate) fn new(marks: &[Bitmap], body: Rect, pen_px: f64) -> Self {
        let blobs = marks.iter().filter_map(Blob::new);
        let blobs: Vec<Blob> = blobs.filter(|b| b.area >= DUST * pen_px * pen_px).collect();
        let area: f64 = blobs.iter().map(|b| b.area).sum();
        if blobs.is_empty() {
            return Self::default();
        }
        let sum =
            |f: &dyn Fn(&Blob) -> f64| blobs.iter().map(|b| b.area * f(b)).sum::<f64>() / area;
        let half = body.width().max(body.height()).max(1.0) / 2.0;
        let near = |v: f64| (v / half).clamp(-1.2, 1.2);
        let at = (
            near(sum(&|b| b.centre.x) - body.center().x),
            near(sum(&|b| b.centre.y) - body.center().y),
        );
        let dots = blobs.iter().map(|b| b.dots(pen_px)).sum::<f64>().min(MOST);
        Self { dots, at }
    }

    /// How unlike two letters' marks are.
    pub(crate) fn distance(&self, other: &Self) -> f64 {
        let count = COUNT * (self.dots - other.dots).abs().min(2.0);
        match (self.dots > 0.0, other.dots > 0.0) {
            (true, true) => {
                let (dx, dy) = (self.at.0 - other.at.0, self.at.1 - other.at.1);
                // Dots stray sideways more than up and down.
                count + PLACE * (0.3 * dx * dx + dy * dy)
            }
            (false, false) => 0.0,
            _ => count + PRESENCE,
        }
    }
}

/// Weight of a dot too many, in units of the shapes' distance; it may be a slip of the pen.
const COUNT: f64 = 0.01;
/// Weight of marks where the other has none.
const PRESENCE: f64 = 0.03;
/// Weight of marks at the other end of the body, squared half sides.
const PLACE: f64 = 0.06;

/// A part as an ellipse of the same moments.
struct Blob {
    area: f64,
    centre: Point,
    long: f64,
    wide: f64,
}

impl Blob {
    fn new(part: &Bitmap) -> Option<Self> {
        let w = part.width().max(1);
        let ink = part.bits().iter().enumerate().filter(|(_, b)| **b);
        let points = ink.map(|(i, _)| Point::new((i % w) as f64 + 0.5, (i / w) as f64 + 0.5));
        let points: Vec<Point> = points.collect();
        let area = points.len() as f64;
        if points.is_empty() {
            return None;
        }
        let mean = |f: &dyn Fn(&Point) -> f64| points.iter().map(f).sum::<f64>() / area;
        let centre = Point::new(mean(&|p| p.x), mean(&|p| p.y));
        // A pixel has a moment of its own.
        let xx = mean(&|p| (p.x - centre.x).powi(2)) + 1.0 / 12.0;
        let yy = mean(&|p| (p.y - centre.y).powi(2)) + 1.0 / 12.0;
        // Sides of the rectangle with these moments.
        let side = |moment: f64| (12.0 * moment.max(0.0)).sqrt();
        Some(Self {
            area,
            centre,
            long: side(xx),
            wide: side(yy),
        })
    }

    /// One for a spot, two for a dash, three for what is neither.
    fn dots(&self, pen: f64) -> f64 {
        let ramp = |v: f64, (from, over): (f64, f64)| ((v / pen - from) / over).clamp(0.0, 1.0);
        let long = ramp(self.long, DASH);
        1.0 + long + long * ramp(self.wide, CARET)
    }
}

/// The number of paper parts that the ink encloses.
pub(crate) fn holes(ink: &Bitmap) -> usize {
    // Euler's number of 8-connected ink from the corners of its pixels: parts − holes.
    let (mut corners, mut turns) = (0_i64, 0_i64);
    let at = |x: usize, y: usize| x > 0 && y > 0 && ink.at(x - 1, y - 1);
    for y in 0..=ink.height() {
        for x in 0..=ink.width() {
            let square = [at(x, y), at(x + 1, y), at(x, y + 1), at(x + 1, y + 1)];
            match (
                square.iter().filter(|b| **b).count(),
                square[0] == square[3],
            ) {
                (1, _) => corners += 1,
                (3, _) => corners -= 1,
                (2, true) => turns += 1,
                _ => {}
            }
        }
    }
    let euler = (corners - 2 * turns) / 4;
    let parts = i64::try_from(super::skeleton::parts(ink).1).unwrap_or(i64::MAX);
    usize::try_from(parts - euler).unwrap_or(0)
}
