//! One global choice of nodes, then one refinement of all of them.

use super::{FitError, Fitter};
use crate::types::{Fitted, Span, Verdict};
use kurbo::BezPath;
use serde::{Deserialize, Serialize};

/// Options of the default fitter.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Joint {}

impl Fitter for Joint {
    fn fit(&self, span: Span<'_>, _tolerance_px: f64) -> Result<Fitted, FitError> {
        let points = span.points();
        let mut path = BezPath::new();
        for (i, &p) in points.iter().enumerate() {
            if i == 0 {
                path.move_to(p);
            } else {
                path.line_to(p);
            }
        }
        if span.is_ring() {
            path.close_path();
        }
        Ok(Fitted {
            path,
            verdict: Verdict::Met,
            parameters: 2 * points.len(),
        })
    }
}
