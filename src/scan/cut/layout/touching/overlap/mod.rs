//! Ink of two letters that lie over each other → all ink of each, what they share included.
//!
//! Where the edge of one letter enters the ink of the other, the edge of both together has a corner inwards, and
//! beneath that ink each letter's edge goes on as it came. The way of the data:
//!
//! | file | what happens there |
//! |---|---|
//! | `across` | how far behind the border a place is |
//! | `edges` | the ink's rings, their corners inwards and how they come to them (`parabola`) |
//! | `example` | where an edge runs beneath ink, if a letter drawn alike lies free |
//! | `joint` | where joining strokes of both letters lie in line, without a corner |
//! | `hidden` | how an edge may go on from one corner to another beneath the ink, and how unlikely that is |
//! | `owners` | whose the stretches between the corners are: of all ways to share them out the likeliest ones |
//! | `shape` | closed outlines → the share of each pixel that lies within |

mod across;
mod edges;
mod example;
mod hidden;
mod joint;
mod owners;
mod parabola;
mod shape;
#[cfg(test)]
mod tests;

pub(in crate::scan::cut::layout) use example::{Example, Side};

use super::{Border, LEVEL, Parting};
use crate::numeric::cast::index;
use crate::numeric::iso;
use crate::numeric::pieces::around;
use crate::scan::components::Component;
use crate::types::Gray;
use edges::Edges;
use kurbo::{Point, Rect};
use owners::{Owner, Split};
use shape::Shape;

/// Paper around the ink, px: what its blurred edge reaches.
const MARGIN: usize = 2;
/// So much of the ink may belong to neither letter, in squares of a stroke's width.
const LOST: f64 = 0.2;
/// A letter has at least so much ink, in squares of a stroke's width.
const LEAST: f64 = 1.0;

/// Points of a ring are so many px apart.
const SPACING: f64 = 1.0;
/// A hole of less than a square of so many strokes is the paper's grain.
const GRAIN: f64 = 0.25;

/// The ink of the letter before a border and of the one after it; none where no way to part them is likely.
pub(super) fn part(ink: &Component, page: &Gray, border: &Border<'_>) -> Option<Parting> {
    let field = Field::new(ink, page);
    let stroke = ink.stroke().max(1.0);
    let side = |p: Point| border.side(field.in_sheet(p));
    let edges = Edges::find(&field, stroke, border, side)?;
    let splits = owners::likeliest(&edges, border.middles());
    let told = splits.iter().find_map(|split| {
        let letters = field.letters(&edges, split, stroke)?;
        Some((split.cost, letters))
    });
    let letter = |shape: Shape| ink.shared(|x, y| field.share(&shape, (x, y)));
    told.map(|(cost, letters)| Parting {
        cost,
        pieces: letters.map(letter).concat(),
    })
}

/// The picture of some ink, px from its lower left corner, y up.
struct Field {
    /// Column and row of its upper left pixel in the sheet.
    corner: (usize, usize),
    width: usize,
    height: usize,
    samples: Vec<f32>,
}

impl Field {
    /// What is darker than paper and nobody else's.
    fn new(ink: &Component, page: &Gray) -> Self {
        let Rect { x0, y0, x1, y1 } = ink.bounds;
        let [left, top] = [x0, y0].map(|v| index(v).saturating_sub(MARGIN));
        let [right, bottom] = [x1, y1].map(|v| index(v) + MARGIN);
        let (width, height) = (right - left, bottom - top);
        let mut own = vec![0.0_f32; width * height];
        for r in &ink.runs {
            let row = (r.y - top) * width;
            own[row + r.start - left..row + r.end - left].fill(1.0);
        }
        for &(x, y, share) in &ink.shares {
            own[(y - top) * width + x - left] = share;
        }
        // an edge is blurred beyond its ink
        let is_beside =
            |x: usize, y: usize| around((x, y), 1, (width, height)).any(|i| own[i] > 0.0);
        let sample = |i: usize| {
            let (x, y) = (i % width, i / width);
            let v = page.at(left + x, top + y);
            if own[i] > 0.0 {
                v * own[i]
            } else if f64::from(v) < LEVEL && is_beside(x, y) {
                v
            } else {
                0.0
            }
        };
        Self {
            corner: (left, top),
            width,
            height,
            samples: (0..width * height).map(sample).collect(),
        }
    }

    fn at(&self, x: usize, y: usize) -> f32 {
        if x < self.width && y < self.height {
            self.samples[y * self.width + x]
        } else {
            0.0
        }
    }

    /// The rings around its ink, grain left out.
    fn rings(&self, stroke: f64) -> Vec<Vec<Point>> {
        let grain = (GRAIN * stroke).powi(2);
        let rings = iso::rings((self.width, self.height), |x, y| self.at(x, y), LEVEL);
        let rings = rings.into_iter().filter(|r| area(r).abs() >= grain);
        rings.map(|r| iso::even(&r, SPACING)).collect()
    }

    /// A place of the sheet.
    fn of_sheet(&self, p: Point) -> Point {
        let (x, y) = self.corner;
        Point::new(p.x - x as f64, (y + self.height) as f64 - p.y)
    }

    /// A place in the sheet.
    fn in_sheet(&self, p: Point) -> Point {
        let (x, y) = self.corner;
        Point::new(x as f64 + p.x, (y + self.height) as f64 - p.y)
    }

    /// Both letters, if nearly all ink is one's and each has some.
    fn letters(&self, edges: &Edges, split: &Split, stroke: f64) -> Option<[Shape; 2]> {
        let shapes = [Owner::First, Owner::Second].map(|owner| {
            let outlines = split.outlines(edges, owner);
            Shape::within(&outlines, (self.width, self.height))
        });
        let square = stroke * stroke;
        let inked = |i: &usize| f64::from(self.samples[*i]) >= LEVEL;
        let all = || (0..self.samples.len()).filter(inked);
        let lost = all().filter(|&i| shapes.iter().all(|s| s.far[i])).count();
        let has = |s: &Shape| all().filter(|&i| s.shares[i] > 0.0).count() as f64;
        let told = lost as f64 <= LOST * square && shapes.iter().all(|s| has(s) >= LEAST * square);
        told.then_some(shapes)
    }

    /// The share that a letter has of a pixel of the sheet, and all of the blurred edge beside it.
    fn share(&self, shape: &Shape, (x, y): (usize, usize)) -> f32 {
        let i = (y - self.corner.1) * self.width + x - self.corner.0;
        let is_rim = f64::from(self.samples[i]) < LEVEL && !shape.far[i] && !shape.veiled[i];
        if is_rim { 1.0 } else { shape.shares[i] }
    }
}

/// The area within a ring, of a hole below 0, px².
fn area(ring: &[Point]) -> f64 {
    let next = ring.iter().cycle().skip(1);
    let cross = |(a, b): (&Point, &Point)| a.to_vec2().cross(b.to_vec2());
    ring.iter().zip(next).map(cross).sum::<f64>() / 2.0
}
