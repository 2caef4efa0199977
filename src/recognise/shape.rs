//! The shape of a letter as numbers: spots on its pruned lines, where which directions lie, holes, marks.
//!
//! Source   [guohall89 sec. 3] for the lines, [chamfer77 sec. 2] for their comparison in [`super::align`]
//! Solves   distance = aligned lines + DENSITY · directions' density + holes + marks
//! Takes    a cell's ink
//! Gives    a distance from 0, symmetric up to which of two letters is moved onto the other
//! Cost     prepared once a letter in about 0.3 ms; a rough comparison is 1024 products, a full one 25 000
//! Fails    never

use super::align::{self, Spot};
use super::ink::Ink;
use super::marks::{Marks, holes};
use super::skeleton::{Pruning, Skeleton, Stroke};
use crate::numeric::angles;
use crate::numeric::cast::{index, single};
use crate::numeric::median::middle;
use crate::types::Bitmap;
use kurbo::{Point, Rect, Vec2};
use std::f64::consts::PI;

/// Side of the density's grid, cells.
const GRID: usize = 16;
/// Directions told apart in it.
const WAYS: usize = 4;
/// Half a letter in cells of the grid: 2.5 cells of margin for the blur.
const HALF: f64 = 5.5;
/// Blur, cells.
const BLUR: f64 = 0.9;
/// Pixels each way over which a line's direction is taken.
const TANGENT: usize = 4;
/// Spots kept of a letter.
const SPOTS: usize = 56;
/// A side is not taken for shorter than this part of the other: a stem stays a stem.
const NARROWEST: f64 = 0.12;
/// Spots that stand for a dot in a letter's lines.
const DOT_SPOTS: usize = 3;

/// Weight of a squared difference of the density.
const DENSITY: f32 = 2e-4;
/// Price of a hole that the other lacks: hands leave bowls open.
const HOLE: f32 = 0.015;

/// A letter made ready for comparison.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    spots: Vec<Spot>,
    density: Vec<f32>,
    holes: usize,
    marks: Marks,
}

impl Shape {
    /// The shape of some ink.
    pub(crate) fn new(ink: &Ink) -> Self {
        let body = Skeleton::new(&ink.body, Pruning::default());
        let marks = Marks::new(&ink.marks, ink_box(&ink.body), pen(&body, &ink.body));
        let mut pixels = lines(&body, Directed::Yes);
        for mark in &ink.marks {
            pixels.extend(lines(
                &Skeleton::new(mark, Pruning::default()),
                Directed::No,
            ));
        }
        let pixels = normalise(&pixels);
        let step = (pixels.len() as f64 / SPOTS as f64).max(1.0);
        let kept = (0..SPOTS).map_while(|i| pixels.get(index(i as f64 * step)));
        Self {
            spots: kept.map(Line::spot).collect(),
            density: density(&pixels),
            holes: holes(&ink.body),
            marks,
        }
    }

    /// A comparison cheap enough for every reference.
    pub(crate) fn rough(&self, other: &Self) -> f32 {
        let pairs = self.density.iter().zip(&other.density);
        let density: f32 = pairs.map(|(a, b)| (a - b) * (a - b)).sum();
        5.0 * DENSITY * density + self.counts(other)
    }

    /// The distance proper; `rough` is [`Shape::rough`] of the same two.
    pub(crate) fn distance(&self, other: &Self, rough: f32) -> f32 {
        align::distance(&self.spots, &other.spots) + 0.2 * rough + self.counts(other)
    }

    /// What holes and marks add.
    fn counts(&self, other: &Self) -> f32 {
        let holes = self.holes.abs_diff(other.holes).min(2);
        HOLE * holes as f32 + single(self.marks.distance(&other.marks))
    }
}

/// The rectangle of the ink, px.
fn ink_box(ink: &Bitmap) -> Rect {
    let w = ink.width().max(1);
    let set = ink.bits().iter().enumerate().filter(|(_, b)| **b);
    let pixels = set.map(|(i, _)| Point::new((i % w) as f64, (i / w) as f64));
    let boxes = pixels.map(|p| Rect::from_origin_size(p, (1.0, 1.0)));
    boxes.reduce(|a, b| a.union(b)).unwrap_or_default()
}

/// Width of the pen, px: the median along the lines, or a dot's own.
fn pen(body: &Skeleton, ink: &Bitmap) -> f64 {
    let strokes = body.strokes.iter();
    let half = strokes.flat_map(|s| s.half_widths.iter().copied());
    let area = || ink.bits().iter().filter(|b| **b).count() as f64;
    middle(half, f64::total_cmp).map_or_else(|| area().sqrt(), |h| 2.0 * h + 0.5)
}

/// A pixel of a line: its direction (zero where it has none) and how long it is.
#[derive(Debug, Clone, Copy)]
struct Line {
    at: Point,
    way: Vec2,
    length: f64,
}

impl Line {
    fn spot(&self) -> Spot {
        let (w, n) = (self.way, self.way.hypot2());
        let (c, s) = if n > 0.0 {
            ((w.x * w.x - w.y * w.y) / n, 2.0 * w.x * w.y / n)
        } else {
            (0.0, 0.0)
        };
        Spot {
            x: single(self.at.x),
            y: single(self.at.y),
            c: single(c),
            s: single(s),
        }
    }
}

#[derive(Clone, Copy, PartialEq)]
enum Directed {
    Yes,
    No,
}

fn lines(skeleton: &Skeleton, directed: Directed) -> Vec<Line> {
    let along = |s: &Stroke| -> Vec<Line> {
        let way = |i| {
            if directed == Directed::Yes {
                tangent(s, i)
            } else {
                Vec2::ZERO
            }
        };
        let line = |(i, p): (usize, &Point)| Line {
            at: *p,
            way: way(i),
            length: 1.0,
        };
        s.points.iter().enumerate().map(line).collect()
    };
    let dot = |at| Line {
        at,
        way: Vec2::ZERO,
        length: 1.0,
    };
    let dots = skeleton
        .dots
        .iter()
        .flat_map(|d| [dot(d.centre); DOT_SPOTS]);
    skeleton
        .strokes
        .iter()
        .flat_map(along)
        .chain(dots)
        .collect()
}

/// Unit direction of a stroke around its point `i`; zero where it is too short to have one.
fn tangent(stroke: &Stroke, i: usize) -> Vec2 {
    let n = stroke.points.len();
    let reach = TANGENT.min(n - 1);
    let (a, b) = if stroke.closed {
        ((i + n - reach) % n, (i + reach) % n)
    } else {
        (i.saturating_sub(reach), (i + reach).min(n - 1))
    };
    let way = stroke.points[b] - stroke.points[a];
    if way.hypot() > 1.5 {
        way.normalize()
    } else {
        Vec2::ZERO
    }
}

/// Into the letter's own frame: the longer side from −1 to 1, the shorter to the root of their ratio, so that
/// widths differ but count less.
fn normalise(lines: &[Line]) -> Vec<Line> {
    let spots = lines.iter().map(|l| Rect::from_points(l.at, l.at));
    let Some(bounds) = spots.reduce(|a, b| a.union(b)) else {
        return Vec::new();
    };
    let half = (bounds.width().max(bounds.height()) / 2.0).max(0.5);
    let scale = |side: f64| 1.0 / (half * (side / 2.0 / half).max(NARROWEST).sqrt());
    let (sx, sy) = (scale(bounds.width()), scale(bounds.height()));
    let centre = bounds.center();
    let place = |l: &Line| {
        let way = Vec2::new(l.way.x * sx, l.way.y * sy);
        let length = if way == Vec2::ZERO {
            (sx * sy).sqrt()
        } else {
            way.hypot()
        };
        Line {
            at: Point::new((l.at.x - centre.x) * sx, (l.at.y - centre.y) * sy),
            way,
            length,
        }
    };
    lines.iter().map(place).collect()
}

/// Blurred length of line in each direction over the grid, its root taken: twice the ink is not twice the letter.
fn density(lines: &[Line]) -> Vec<f32> {
    let mut map = vec![0.0_f64; GRID * GRID * WAYS];
    for l in lines {
        let ways = directions(l.way);
        let length = l.length * HALF / (BLUR * BLUR);
        let (u, v) = (
            l.at.x * HALF + GRID as f64 / 2.0,
            l.at.y * HALF + GRID as f64 / 2.0,
        );
        let around = |c: f64| index(c - 3.0)..(index(c + 4.0)).min(GRID);
        for j in around(v) {
            for i in around(u) {
                let d2 = (i as f64 + 0.5 - u).powi(2) + (j as f64 + 0.5 - v).powi(2);
                let k = length * libm::exp(-d2 / (2.0 * BLUR * BLUR));
                let cell = &mut map[(j * GRID + i) * WAYS..][..WAYS];
                cell.iter_mut().zip(ways).for_each(|(m, w)| *m += k * w);
            }
        }
    }
    map.iter().map(|m| single(m.sqrt())).collect()
}

/// Shares of the two nearest of [`WAYS`] directions; of all where there is none.
fn directions(way: Vec2) -> [f64; WAYS] {
    if way == Vec2::ZERO {
        return [1.0 / WAYS as f64; WAYS];
    }
    let turn = (angles::heading(way) / PI).rem_euclid(1.0) * WAYS as f64;
    let (whole, part) = (index(turn) % WAYS, turn.fract());
    let mut out = [0.0; WAYS];
    out[whole] += 1.0 - part;
    out[(whole + 1) % WAYS] += part;
    out
}
