//! Where vertices may lie: the admissible control point band.

use super::places::{extent, place};
use super::tube::Tube;
use super::{Bounds, Kind, Width};
use crate::numeric::angles::angle;
use crate::numeric::{cast, qbc::Pull};
use kurbo::Point;
use std::collections::BTreeMap;

/// A vertex that the curve may have, and the boundary point nearest to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Vertex {
    pub(super) at: (i32, i32),
    pub(super) stage: usize,
}

impl Vertex {
    pub(super) fn point(self) -> Point {
        point(self.at)
    }
}

fn point((x, y): (i32, i32)) -> Point {
    Point::new(f64::from(x), f64::from(y))
}

/// Where a curve begins, and ends.
#[derive(Debug, Clone, Copy)]
pub(super) enum Begin {
    /// On the first boundary point, with a corner.
    Corner,
    /// With the edge between two places, which it ends with too.
    Edge([(i32, i32); 2]),
}

impl Begin {
    /// The boundary from the point nearest to where the curve begins, once around, and how many of its points are
    /// passed again by the curve's end.
    fn unrolled(self, boundary: &[Point]) -> (Vec<Point>, usize) {
        let Self::Edge([first, second]) = self else {
            return (boundary.to_vec(), 1);
        };
        let mut around = boundary.to_vec();
        let to = |at, around: &[Point]| {
            let square = |i: &usize| around[*i].distance_squared(point(at));
            let nearest = (0..around.len()).min_by(|i, j| square(i).total_cmp(&square(j)));
            nearest.unwrap_or(0)
        };
        let shift = to(first, &around);
        around.rotate_left(shift);
        let again = to(second, &around) + 1;
        (around, again)
    }

    /// The first vertex, on or near the first of the boundary's points.
    fn at(self, around: &[Point]) -> (i32, i32) {
        match self {
            Self::Corner => (near(around[0].x), near(around[0].y)),
            Self::Edge([first, _]) => first,
        }
    }
}

/// Whole points near the boundary, in its order.
#[derive(Debug)]
pub(super) struct Band {
    /// The boundary from where the curve begins, and those of its points again where the curve ends.
    pub(super) boundary: Vec<Point>,
    /// Its points.
    pub(super) around: usize,
    /// Square of `T_i`, px², for each of them.
    pub(super) squares: Vec<f64>,
    pub(super) tube: Tube,
    /// That which the curve begins with, all others of the band, and the first again.
    pub(super) vertices: Vec<Vertex>,
    /// Its longest step, px.
    stride: f64,
    corner: (i32, i32),
    across: usize,
    index: Vec<Option<usize>>,
}

impl Band {
    /// For edges whose components are no longer than so many px.
    pub(super) fn new(
        boundary: &[Point],
        begin: Begin,
        bounds: Bounds,
        kind: Kind,
        (width, longest): (Width, i32),
    ) -> Self {
        let (around, again) = begin.unrolled(boundary);
        let admissible = admissible(&around, bounds);
        // no shorter than the longest chord
        let chord = extent(&around).size().to_vec2().hypot();
        let edge = [chord, f64::from(longest)];
        let reach = |&t: &f64| match width {
            Width::Tolerance => t,
            Width::Bound => t + beyond(kind, edge, bounds.t_max, t),
        };
        let reach: Vec<f64> = admissible.iter().map(reach).collect();
        let vertices = vertices(&around, &reach, begin.at(&around));
        let least = |axis: fn(&Vertex) -> i32| vertices.iter().map(axis).min().unwrap_or(0);
        let corner = (least(|v| v.at.0), least(|v| v.at.1));
        let widest = vertices.iter().map(|v| v.at.0 - corner.0 + 1).max();
        let across = usize::try_from(widest.unwrap_or(1)).unwrap_or(1);
        let mut index = Vec::new();
        for (i, v) in vertices.iter().enumerate() {
            if let Some(cell) = place(corner, across, v.at) {
                index.resize(index.len().max(cell + 1), None);
                index[cell] = Some(i);
            }
        }
        let boundary: Vec<Point> = around.iter().chain(&around[..again]).copied().collect();
        let t: Vec<f64> = admissible
            .iter()
            .chain(&admissible[..again])
            .copied()
            .collect();
        let strides = boundary.windows(2).map(|w| w[0].distance(w[1]));
        let stride = strides.fold(1e-3, f64::max);
        Self {
            tube: Tube::new(&boundary, &t),
            squares: t.iter().map(|t| t * t + 1e-9).collect(),
            stride,
            boundary,
            around: around.len(),
            vertices,
            corner,
            across,
            index,
        }
    }

    /// The first of the boundary points nearest to a whole or half point, from one to another.
    pub(super) fn nearest(&self, p: Point, (first, last): (usize, usize)) -> usize {
        if let Some(all) = self.tube.nearest(p).filter(|i| (first..=last).contains(i)) {
            return all;
        }
        let (mut at, mut best) = (first, (first, f64::INFINITY));
        while at <= last {
            let square = self.boundary[at].distance_squared(p);
            if square < best.1 {
                best = (at, square);
            }
            // those passed over are farther: no step is longer than the stride
            let nearer = (square.sqrt() - best.1.sqrt()) / self.stride - 1e-6;
            at += 1 + cast::index(nearer);
        }
        best.0
    }

    /// The vertex at a place; the last one where the curve begins.
    pub(super) fn find(&self, at: (i32, i32)) -> Option<usize> {
        *self.index.get(place(self.corner, self.across, at)?)?
    }
}

/// All whole points that lie no farther from a boundary point than it reaches, each by the nearest of these; that
/// which the curve begins with first, and again at the end.
fn vertices(around: &[Point], reach: &[f64], first: (i32, i32)) -> Vec<Vertex> {
    let mut best: BTreeMap<(i32, i32), (f64, usize)> = BTreeMap::new();
    for (i, (b, w)) in around.iter().zip(reach).enumerate() {
        let cells = near(*w);
        for dy in -cells..=cells {
            for dx in -cells..=cells {
                let at = (near(b.x) + dx, near(b.y) + dy);
                let d = point(at).distance(*b);
                if d <= *w && best.get(&at).is_none_or(|old| d < old.0) {
                    best.insert(at, (d, i));
                }
            }
        }
    }
    let others = best
        .into_iter()
        .map(|(at, (_, stage))| Vertex { at, stage });
    let others = others.filter(|v| v.stage > 0 && v.at != first);
    let start = |stage: usize| Vertex { at: first, stage };
    let mut vertices: Vec<Vertex> = std::iter::once(start(0)).chain(others).collect();
    vertices.sort_by_key(|v| v.stage);
    vertices.push(start(around.len()));
    vertices
}

/// `W_j - T_j` [sohel sec. III.C, eq. 13-15]; a polygon's vertices lie within T.
fn beyond(kind: Kind, [chord, run]: [f64; 2], t_max: f64, t: f64) -> f64 {
    let rho = run * std::f64::consts::SQRT_2;
    let (bound, longest) = match kind {
        Kind::Polygon => (0.0, 0.0),
        Kind::Spline(Pull::Bezier) => ((3.0 * chord + 4.0 * t_max + 2.0 * t) / 6.0, rho / 4.0),
        Kind::Spline(Pull::Qbc) => (
            11.0 / 37.0 * (37.0 * chord + 48.0 * t_max + 26.0 * t) / 26.0,
            11.0 * rho / 48.0,
        ),
        Kind::Spline(Pull::QbcN) => ((5.0 * chord + 6.0 * t_max + 4.0 * t) / 20.0, rho / 6.0),
    };
    f64::min(bound, longest)
}

/// `T_i`: `t_max` where the boundary is straight, falling to `t_min` where it turns by 90° within a few px.
fn admissible(boundary: &[Point], bounds: Bounds) -> Vec<f64> {
    /// Points on each side that a turn is taken over.
    const REACH: usize = 5;
    let n = boundary.len();
    let turn = |i: usize| {
        let (a, b, c) = (
            boundary[(i + n - REACH % n) % n],
            boundary[i],
            boundary[(i + REACH) % n],
        );
        let (u, v) = (b - a, c - b);
        angle(u, v).abs()
    };
    let part = |i: usize| (turn(i) / std::f64::consts::FRAC_PI_2).min(1.0);
    (0..n)
        .map(|i| bounds.t_max + (bounds.t_min - bounds.t_max) * part(i))
        .collect()
}

/// The nearest whole number of px.
#[expect(
    clippy::cast_possible_truncation,
    reason = "pictures are smaller than 2^31 px; `as` saturates"
)]
pub(super) fn near(v: f64) -> i32 {
    v.round() as i32
}
