//! Where vertices may lie: the admissible control point band.

use super::{Bounds, Kind, RUN};
use crate::numeric::qbc::Pull;
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
        Point::new(f64::from(self.at.0), f64::from(self.at.1))
    }
}

/// Whole points near the boundary, in its order.
#[derive(Debug)]
pub(super) struct Band {
    /// The boundary, its first point again at the end.
    pub(super) boundary: Vec<Point>,
    /// Square of `T_i`, px², for each of them.
    pub(super) squares: Vec<f64>,
    /// The first boundary point, all others of the band, and the first again.
    pub(super) vertices: Vec<Vertex>,
    index: BTreeMap<(i32, i32), usize>,
}

impl Band {
    pub(super) fn new(boundary: &[Point], bounds: Bounds, kind: Kind) -> Self {
        let admissible = admissible(boundary, bounds);
        let longest = boundary
            .windows(2)
            .map(|w| w[0].distance(w[1]))
            .fold(0.0, f64::max);
        let mut best: BTreeMap<(i32, i32), (f64, usize)> = BTreeMap::new();
        for (i, &b) in boundary.iter().enumerate() {
            let w = width(kind, (longest, bounds.t_max), admissible[i]);
            let reach = near(w);
            for dy in -reach..=reach {
                for dx in -reach..=reach {
                    let at = (near(b.x) + dx, near(b.y) + dy);
                    let d = Point::new(f64::from(at.0), f64::from(at.1)).distance(b);
                    if d <= w && best.get(&at).is_none_or(|old| d < old.0) {
                        best.insert(at, (d, i));
                    }
                }
            }
        }
        let start = |stage: usize| Vertex {
            at: (near(boundary[0].x), near(boundary[0].y)),
            stage,
        };
        let others = best
            .into_iter()
            .map(|(at, (_, stage))| Vertex { at, stage });
        let others = others.filter(|v| v.stage > 0);
        let mut vertices: Vec<Vertex> = std::iter::once(start(0)).chain(others).collect();
        vertices.sort_by_key(|v| v.stage);
        vertices.push(start(boundary.len()));
        let index = vertices.iter().enumerate().map(|(i, v)| (v.at, i));
        let index = index.collect();
        Self {
            boundary: boundary.iter().chain(boundary.first()).copied().collect(),
            squares: admissible
                .iter()
                .chain(admissible.first())
                .map(|t| t * t + 1e-9)
                .collect(),
            vertices,
            index,
        }
    }

    /// The vertex at a place; the last one at the first boundary point.
    pub(super) fn find(&self, at: (i32, i32)) -> Option<usize> {
        self.index.get(&at).copied()
    }
}

/// `W_j` [sohel sec. III.C, eq. 13-15]; a polygon's vertices lie within T.
fn width(kind: Kind, (delta, t_max): (f64, f64), t: f64) -> f64 {
    let rho = f64::from(RUN) * std::f64::consts::SQRT_2;
    let beyond = match kind {
        Kind::Polygon => 0.0,
        Kind::Spline(Pull::Bezier) => {
            f64::min((3.0 * delta + 4.0 * t_max + 2.0 * t) / 6.0, rho / 4.0)
        }
        Kind::Spline(Pull::Qbc) => f64::min(
            11.0 / 37.0 * (37.0 * delta + 48.0 * t_max + 26.0 * t) / 26.0,
            11.0 * rho / 48.0,
        ),
        Kind::Spline(Pull::QbcN) => {
            f64::min((5.0 * delta + 6.0 * t_max + 4.0 * t) / 20.0, rho / 6.0)
        }
    };
    beyond + t
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
        u.cross(v).atan2(u.dot(v)).abs()
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
