//! Every cubic alone becomes a run of control points with implied on-curve points.
//!
//! The conversion is kurbo's port of cu2qu: the cubic is cut into n equal ranges of its parameter,
//! the tangents of each range give a control point, and n grows until the run lies within the
//! tolerance. A cubic that no such run meets is cut by the bound of its third derivative instead.
//! Ends and end tangents of every cubic stay, so corners and extrema do too; coordinates are not
//! rounded, and storing them on the grid adds up to 0.71 units.

use super::QuadraticError;
use crate::types::Outline;
use kurbo::{BezPath, CubicBez, PathEl, Point};
use serde::{Deserialize, Serialize};

/// It has no options: the tolerance says all.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Split {}

impl Split {
    /// Lines and quadratics within `tolerance` (font units, positive) of the outline before rounding.
    pub(super) fn convert(
        &self,
        outline: &Outline,
        tolerance: f64,
    ) -> Result<Outline, QuadraticError> {
        let Self {} = self;
        let contours = outline
            .contours()
            .iter()
            .map(|c| contour(c, tolerance))
            .collect();
        Ok(Outline::new(contours)?)
    }
}

fn contour(path: &BezPath, tolerance: f64) -> BezPath {
    let mut out = BezPath::new();
    let mut at = Point::ORIGIN;
    for el in path.elements() {
        match *el {
            PathEl::CurveTo(a, b, c) => quads(CubicBez::new(at, a, b, c), tolerance, &mut out),
            PathEl::LineTo(p) if p == at => {}
            other => out.push(other),
        }
        at = el.end_point().unwrap_or(at);
    }
    out
}

fn quads(cubic: CubicBez, tolerance: f64, out: &mut BezPath) {
    if [cubic.p1, cubic.p2, cubic.p3]
        .iter()
        .all(|&p| p == cubic.p0)
    {
        return;
    }
    match cubic.approx_spline(tolerance) {
        Some(run) => run.to_quads().for_each(|q| out.quad_to(q.p1, q.p2)),
        None => cubic
            .to_quads(tolerance)
            .for_each(|(_, _, q)| out.quad_to(q.p1, q.p2)),
    }
}
