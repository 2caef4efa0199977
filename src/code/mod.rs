//! Boundary → vertices: operational rate-distortion coding of a shape.
//! Source   [sohel sec. II.B, alg. 1; sec. III.C, eq. 10-15]
//! Solves   min bits(vertices), each piece of curve within `T_i` of the boundary points it passes
//! Takes    the closed boundary of a silhouette, whole px; the distortion bounds `t_max` and `t_min`, px
//! Gives    vertices, their bits, and the curve's `D_max` and `D_ms`
//! Symbols  B -> `boundary`, C -> `Band`, `T_i` -> `admissible`, `MinRate` -> label cost, `W_j - T_j` -> `beyond`
//! Departs  the paper prints no rate: see [`Steps`]. The band holds every whole point within T or W of the boundary
//!          ([`Width`]), each with its nearest boundary point; T falls from `t_max` to `t_min` as the local turn
//!          grows. Distances are taken both ways, the boundary's from the curve and the curve's from it. The paper's
//!          curves have a corner on the first boundary point; [`Closing::Ring`] has none
//! Cost     O(|C| r^2 w) for runs of r boundary points and a band w wide, two or three times for rings. Exact under
//!          this code, the band and 16 chords a piece: edges, and groups of pairs for an edge or a group of edges,
//!          are put aside only where each of their curves leaves the bounds. Of rings the cheapest through an edge
//!          of one that was found before, until that is no cheaper
//! Fails    too short or too large a boundary; bounds out of order

mod band;
mod encode;
mod fan;
mod line;
mod moat;
mod piece;
mod places;
mod ring;
mod search;
mod tube;
mod vertex;

use crate::numeric::qbc::Pull;
use kurbo::Point;
use thiserror::Error;

pub use encode::encode;
pub use vertex::Steps;

/// Why a boundary is not coded.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum CodeError {
    /// Too few points.
    #[error("{0} boundary points; 8 are needed at least")]
    Short(usize),
    /// Too large, or not finite.
    #[error("the boundary spans {0} x {1} px; scale it to at most 1024 a side")]
    Large(f64, f64),
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

/// How far from the boundary vertices may lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// `T_i`, no farther than the curve.
    Tolerance,
    /// `W_i` of eq. 13 to 15, as far as those of any curve within the bounds need to.
    Bound,
}

/// Where the curve begins and ends. The first vertex is known to the reader and not counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Closing {
    /// On the first boundary point, where every curve has a corner, as Algorithm 1's.
    Corner,
    /// On a vertex like all others, around which the curve goes on.
    Ring,
}

/// What vertices there are and what they cost, the same for all kinds of curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Code {
    /// How far from the boundary they may lie.
    pub width: Width,
    /// How far apart, and the bits of that.
    pub steps: Steps,
    /// Where they begin.
    pub closing: Closing,
}

/// A coded boundary.
#[derive(Debug, Clone, PartialEq)]
pub struct Coded {
    /// Vertices, the first again at the end.
    pub vertices: Vec<Point>,
    /// Their bits under [`Steps`].
    pub bits: u64,
    /// Dense points of the curve.
    pub curve: Vec<Point>,
    /// Largest distance of a boundary point from the curve, px (class one).
    pub d_max: f64,
    /// Mean square of that distance, px² (class two).
    pub d_ms: f64,
}

/// Largest and mean square distance of the boundary points from a curve given by dense points, px and px².
#[must_use]
pub fn distortion(boundary: &[Point], curve: &[Point]) -> (f64, f64) {
    let off = |p: &Point| {
        let edges = curve.windows(2).map(|w| places::to_edge(*p, w));
        edges.fold(f64::INFINITY, f64::min)
    };
    let all: Vec<f64> = boundary.iter().map(off).collect();
    let worst = all.iter().copied().fold(0.0, f64::max).sqrt();
    let n = all.iter().fold(0.0, |n, _| n + 1.0);
    (worst, all.iter().sum::<f64>() / f64::max(n, 1.0))
}

#[cfg(test)]
mod tests;
