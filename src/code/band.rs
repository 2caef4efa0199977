//! Where vertices may lie: the admissible control point band.

use super::{Bounds, Kind, RUN};
use crate::numeric::qbc::Pull;
use kurbo::Point;
use std::collections::BTreeMap;

/// Whole points near the boundary, each with the index of its nearest boundary point.
#[derive(Debug)]
pub(super) struct Band {
    pub(super) index: BTreeMap<(i32, i32), usize>,
    /// `T_i`, px, for each boundary point.
    pub(super) admissible: Vec<f64>,
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
        let index = best.into_iter().map(|(at, (_, i))| (at, i)).collect();
        Self { index, admissible }
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
