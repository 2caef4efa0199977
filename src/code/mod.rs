//! Boundary → vertices: operational rate-distortion coding of a shape.
//! Source   [sohel sec. II.B, alg. 1; sec. III.C, eq. 10-15]
//! Solves   min bits(vertices), each piece of curve within `T_i` of the boundary points it passes
//! Takes    the closed boundary of a silhouette, whole px; the distortion bounds `t_max` and `t_min`, px
//! Gives    vertices, their bits, and the curve's `D_max` and `D_ms`
//! Symbols  B -> `boundary`, C -> `Band`, `T_i` -> `admissible`, `MinRate` -> label cost, `W_j` -> `width`
//! Departs  the paper prints no rate: see [`bits`]. The band holds every whole point within W of the
//!          boundary, each with its nearest boundary point; T falls from `t_max` to `t_min` as the local
//!          turn grows. Exact under this code: labels carry both vertices that the future needs
//! Cost     O(|C| r^2) checks for a longest run r    Fails  too short a boundary; bounds out of order

mod band;
mod search;

use crate::numeric::qbc::Pull;
use kurbo::Point;
use thiserror::Error;

pub use search::encode;

/// Longest run of the vertex code.
pub const RUN: i32 = 15;

/// Why a boundary is not coded.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CodeError {
    /// Too few points.
    #[error("{0} boundary points; 8 are needed at least")]
    Short(usize),
    /// Bounds out of order.
    #[error("the bounds are {0} and {1} px; 0 < t_min <= t_max is needed")]
    Bounds(f64, f64),
    /// No run of vertices stays within the bounds.
    #[error("no vertices on whole px within the bounds; allow a larger t_max")]
    Unreachable,
}

/// The curve between vertices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Straight edges from vertex to vertex.
    Polygon,
    /// Uniform quadratic B-spline, or what replaces it with a quasi-Bézier pull [sohel sec. III.C, eq. 10].
    Spline(Pull),
}

/// Distortion bounds, px.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Where the boundary is straight.
    pub t_max: f64,
    /// Where it turns most.
    pub t_min: f64,
}

/// A coded boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Coded {
    /// Vertices, first and last on the first boundary point.
    pub vertices: Vec<Point>,
    /// Their bits under [`bits`].
    pub bits: u64,
    /// Dense points of the curve.
    pub curve: Vec<Point>,
    /// Largest distance of a boundary point from the curve, px (class one).
    pub d_max: f64,
    /// Mean square of that distance, px² (class two).
    pub d_ms: f64,
}

/// The bits of the step from a vertex to the next one: a run of 1 to 15 px along one of 8 directions.
///
/// The direction is said by its turn against the step before: none `0`, 45° `100`/`101`, 90°
/// `1100`/`1101`, 135° `11100`/`11101`, back `1111`; the first step's by 3 bits. The run follows: its
/// bucket 1, 2-3, 4-7, 8-15 in 2 bits, its place in the bucket in 0 to 3. The first vertex is common to
/// all curves and not counted. None where the step is not of this kind.
#[must_use]
pub fn bits(before: Option<(i32, i32)>, step: (i32, i32)) -> Option<u64> {
    let (direction, run) = direction(step)?;
    let turn = match before {
        None => 3,
        Some(b) => match (direction - self::direction(b)?.0).rem_euclid(8) {
            0 => 1,
            1 | 7 => 3,
            2 | 6 => 4,
            3 | 5 => 5,
            _ => 4,
        },
    };
    Some(turn + 2 + u64::from(run.ilog2()))
}

/// Number of one of the 8 directions, counter-clockwise from east, and the run along it.
fn direction((dx, dy): (i32, i32)) -> Option<(i32, i32)> {
    let run = dx.abs().max(dy.abs());
    if !(1..=RUN).contains(&run) || (dx != 0 && dy != 0 && dx.abs() != dy.abs()) {
        return None;
    }
    let number = match (dx.signum(), dy.signum()) {
        (1, 0) => 0,
        (1, 1) => 1,
        (0, 1) => 2,
        (-1, 1) => 3,
        (-1, 0) => 4,
        (-1, -1) => 5,
        (0, -1) => 6,
        _ => 7,
    };
    Some((number, run))
}

/// Largest and mean square distance of the boundary points from a curve given by dense points, px and px².
#[must_use]
pub fn distortion(boundary: &[Point], curve: &[Point]) -> (f64, f64) {
    let off = |p: &Point| {
        curve
            .iter()
            .map(|q| q.distance_squared(*p))
            .fold(f64::INFINITY, f64::min)
    };
    let all: Vec<f64> = boundary.iter().map(off).collect();
    let worst = all.iter().copied().fold(0.0, f64::max).sqrt();
    let n = all.iter().fold(0.0, |n, _| n + 1.0);
    (worst, all.iter().sum::<f64>() / f64::max(n, 1.0))
}

#[cfg(test)]
mod tests;
