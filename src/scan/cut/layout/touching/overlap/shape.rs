//! Closed outlines → which pixels lie within, and which share of those along a hidden edge.

use crate::numeric::cast::{index, single};
use crate::numeric::pieces::around;
use kurbo::Point;

/// How far a hidden edge reaches, px: half a pixel is half a share.
const REACH: f64 = 0.5;
/// Pixels so many steps away are beside a shape.
const BESIDE: usize = 2;

/// A part of an outline.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Stretch {
    /// Along an edge.
    Seen(Vec<Point>),
    /// Beneath ink.
    Hidden(Vec<Point>),
}

impl Stretch {
    pub(super) fn points(&self) -> &[Point] {
        match self {
            Self::Seen(points) | Self::Hidden(points) => points,
        }
    }
}

/// The shares that one letter has of a picture's pixels.
pub(super) struct Shape {
    /// Row by row.
    pub(super) shares: Vec<f32>,
    /// Pixels whose nearest edge is a hidden one.
    pub(super) veiled: Vec<bool>,
    /// Pixels that lie farther from it than ink is blurred.
    pub(super) far: Vec<bool>,
}

impl Shape {
    pub(super) fn within(outlines: &[Vec<Stretch>], (width, height): (usize, usize)) -> Self {
        let rings = outlines.iter();
        let rings = rings.map(|o| o.iter().flat_map(|s| s.points().iter().copied()).collect());
        let rings: Vec<Vec<Point>> = rings.collect();
        let filled = filled(&rings, (width, height));
        let mut shares: Vec<f32> = filled.into_iter().map(|v| f32::from(u8::from(v))).collect();
        let mut veiled = vec![false; width * height];
        let mut nearest = vec![f64::INFINITY; width * height];
        for stretch in outlines.iter().flatten() {
            let last = stretch.points().len().saturating_sub(1);
            for (k, p) in stretch.points().iter().enumerate() {
                let within = matches!(stretch, Stretch::Hidden(_)) && k > 0 && k < last;
                for i in around(pixel(*p, height), 1, (width, height)) {
                    let (x, y) = (i % width, i / width);
                    let centre = Point::new(x as f64 + 0.5, (height - y) as f64 - 0.5);
                    let d = centre.distance(*p);
                    if d < nearest[i] {
                        (nearest[i], veiled[i]) = (d, within);
                    }
                }
            }
        }
        for i in (0..shares.len()).filter(|&i| veiled[i]) {
            let off = if shares[i] > 0.5 {
                nearest[i]
            } else {
                -nearest[i]
            };
            shares[i] = single((REACH + off).clamp(0.0, 1.0));
        }
        let far = |i: usize| {
            let mut around = around((i % width, i / width), BESIDE, (width, height));
            !around.any(|j| shares[j] > 0.0)
        };
        let far = (0..shares.len()).map(far).collect();
        Self {
            shares,
            veiled,
            far,
        }
    }
}

/// Which pixels of a picture are ink, row by row from above.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ink<'a> {
    pub(super) inside: &'a [bool],
    pub(super) size: (usize, usize),
}

impl Ink<'_> {
    /// Whether there is ink at a place or a pixel beside it.
    pub(super) fn is_near(self, p: Point) -> bool {
        let (column, row) = pixel(p, self.size.1);
        around((column, row), 1, self.size).any(|i| self.inside[i])
    }
}

/// Column and row of the pixel at a place in a picture so high.
pub(super) fn pixel(p: Point, height: usize) -> (usize, usize) {
    (index(p.x.max(0.0)), index((height as f64 - p.y).max(0.0)))
}

/// The pixels whose centres rings go around.
pub(super) fn filled(rings: &[Vec<Point>], (width, height): (usize, usize)) -> Vec<bool> {
    // where rings pass the line through a row's centres, and whether upwards
    let mut passes: Vec<Vec<(f64, i32)>> = vec![Vec::new(); height];
    let edges = rings
        .iter()
        .flat_map(|r| r.iter().zip(r.iter().cycle().skip(1)));
    for (a, b) in edges {
        let (low, high, up) = if a.y < b.y { (a, b, 1) } else { (b, a, -1) };
        let first = index((height as f64 - high.y).max(0.0));
        let rows = (first..height).map(|row| (row, (height - row) as f64 - 0.5));
        for (row, y) in rows
            .take_while(|(_, y)| *y >= low.y)
            .filter(|(_, y)| *y < high.y)
        {
            let x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
            passes[row].push((x, up));
        }
    }
    let mut inside = vec![false; width * height];
    for (row, passes) in passes.iter_mut().enumerate() {
        passes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut around = 0;
        for pair in passes.windows(2) {
            around += pair[0].1;
            if around != 0 {
                let ends = [pair[0].0, pair[1].0];
                let [from, to] = ends.map(|x| index((x + 0.5).max(0.0)).min(width));
                inside[row * width + from..row * width + to].fill(true);
            }
        }
    }
    inside
}
