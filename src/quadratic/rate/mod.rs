//! The smallest TrueType outline within a tolerance, the whole contour at once.
//! Source   [sohel sec. II.B, alg. 1, eq. 4]: vertices by shortest path, quadratics as runs of vertices
//! Solves   min glyf bytes + lambda * (sum of each quadratic's largest error), no error above the tolerance
//! Takes    an [`Outline`] of lines, quadratics and cubics, font units; a tolerance, units
//! Gives    an [`Outline`] on whole units; on-curve points half way between control points are implied
//! Symbols  c_(i,m), c_(j,n) -> `Join::c`, `Join::next`; r -> `Pen::store`; w -> cost; T -> `Effort::limit`
//! Departs  the rate is the bytes of `glyf`; an on-curve point may stand between two runs; control
//!          points come from tangents of the contour ahead instead of a band around it; states with
//!          nearly one future share a label, so the result is an upper bound of the optimum; runs between two nodes
//!          are then fitted with fewer points; a contour is searched both ways around and both answers spliced
//! Cost     O(stages * labels * reach), some ms a glyph    Fails  where whole units cannot come so close

mod assemble;
mod beside;
mod curve;
mod glyf;
mod least;
mod search;
mod solve;
mod splice;
mod thin;

pub use glyf::{glyf_bytes, glyf_points};

use super::QuadraticError;
use crate::types::Outline;
use curve::{Course, Keep};
use glyf::Stored;
use kurbo::BezPath;
use search::{Effort, Otherwise};
use serde::{Deserialize, Serialize};

/// What of the outline is kept beside its shape.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strictness {
    /// Corners, long lines and smooth joins; extrema where that costs nothing. A corner may move within
    /// the tolerance, but not away from a level or upright line that ends there.
    Corners,
    /// Extrema too: an on-curve or implied point with a level or upright tangent at the rounded extreme.
    #[default]
    Extrema,
    /// Both, and every corner stands at the unit nearest to where it was drawn.
    Places,
}

/// Options of the converter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Rate {
    /// What is kept beside the shape.
    pub keep: Strictness,
    /// Smallest turn that is a corner, degrees.
    pub corner_deg: f64,
    /// Bytes that a unit of largest error is worth, quadratic by quadratic.
    pub lambda: f64,
    /// How finely the search looks: its stages for each √(curvature/tolerance) of arc.
    pub grain: f64,
}

impl Default for Rate {
    fn default() -> Self {
        /// Below it, two rounded handles that were drawn as one look like a corner.
        const CORNER_DEG: f64 = 8.0;
        /// Breaks ties between answers of equal bytes towards the smaller error.
        const LAMBDA: f64 = 0.02;
        Self {
            keep: Strictness::default(),
            corner_deg: CORNER_DEG,
            lambda: LAMBDA,
            grain: 1.0,
        }
    }
}

impl Rate {
    /// Whether the options are in their ranges.
    pub(super) fn check(&self) -> Result<(), QuadraticError> {
        let options = [
            ("corner_deg", self.corner_deg, (0.0, 180.0)),
            ("lambda", self.lambda, (0.0, 1e6)),
            ("grain", self.grain, (0.1, 10.0)),
        ];
        for (option, value, (least, most)) in options {
            if !(least..=most).contains(&value) {
                return Err(QuadraticError::Option {
                    option,
                    value,
                    least,
                    most,
                });
            }
        }
        Ok(())
    }

    /// What stays at a tolerance, units.
    fn kept(&self, tolerance: f64) -> Keep {
        /// Shorter lines may become part of a curve, tolerances.
        const LINE: f64 = 16.0;
        /// A smaller rise makes no extremum worth keeping, tolerances.
        const RISE: f64 = 3.0;
        /// A corner may move so far, tolerances.
        const MOVE: f64 = 0.9;
        Keep {
            corner_rad: self.corner_deg.to_radians(),
            tolerance,
            line: LINE * tolerance,
            least: RISE * tolerance,
            free: match self.keep {
                Strictness::Corners | Strictness::Extrema => MOVE * tolerance,
                Strictness::Places => 0.0,
            },
        }
    }

    /// Lines and quadratics on whole units within `tolerance` (units, positive) of the outline.
    pub(super) fn convert(
        &self,
        outline: &Outline,
        tolerance: f64,
    ) -> Result<Outline, QuadraticError> {
        /// Bytes that a label may cost more than the cheapest beyond it, for outlines with their extrema: one
        /// more takes twice the time and saves 0.3 %.
        const SLACK: f64 = 2.1;
        /// Where all runs are fitted anew, another saves nothing more.
        const NARROW: f64 = 1.1;
        let keep = self.kept(tolerance);
        let effort = Effort {
            limit: tolerance,
            keep: self.keep,
            grain: self.grain,
            slack: match self.keep {
                Strictness::Corners => NARROW,
                Strictness::Extrema | Strictness::Places => SLACK,
            },
            lambda: self.lambda,
            beside: 1.0,
            otherwise: Otherwise::Nothing,
        };
        let mut contours = Vec::new();
        for (i, path) in outline.contours().iter().enumerate() {
            let places = Keep { free: 0.0, ..keep };
            let stored = contour(path, keep, effort)
                .filter(|stored| stored.len() > 1)
                // corners that may all move to one point leave nothing of a contour
                .or_else(|| contour(path, places, effort));
            contours.push(stored.ok_or(QuadraticError::Grid {
                contour: i,
                tolerance,
            })?);
        }
        contours.retain(|c| c.len() > 1);
        let points = contours.iter().map(Vec::len).sum();
        if points > usize::from(u16::MAX) {
            return Err(QuadraticError::Points(points));
        }
        Ok(Outline::new(assemble::paths(&contours))?)
    }
}

/// The points of a contour as TrueType runs it, against the outline: the fewest bytes of a search each way
/// and of what both make together, since a search finds the turns of a curve more easily one way than the
/// other. None where the grid is too coarse.
fn contour(path: &BezPath, keep: Keep, effort: Effort) -> Option<Vec<Stored>> {
    /// Factors on slack and grain after neither way was found.
    const CLOSER: (f64, f64) = (4.0, 2.0);
    let one = |path: &BezPath, effort: Effort| match Course::new(path, keep) {
        Some(course) => solve::contour(&course, effort),
        None => Some(Vec::new()),
    };
    let turned = path.reverse_subpaths();
    let back = |mut c: Vec<Stored>| {
        c.reverse();
        c
    };
    let found = match (one(&turned, effort), one(path, effort).map(back)) {
        (Some(a), Some(b)) => Some(splice::splice(a, b, effort.limit)),
        (a, b) => a.or(b),
    };
    let closer = Effort {
        slack: CLOSER.0 * effort.slack,
        grain: CLOSER.1 * effort.grain,
        otherwise: Otherwise::Pieces,
        ..effort
    };
    found.or_else(|| one(&turned, closer))
}

#[cfg(test)]
mod tests;
