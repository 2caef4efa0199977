//! How a picture becomes curves: a method for each stage.

use crate::fit::{self, FitError};
use crate::numeric::many::each;
use crate::refine::Cornered;
use crate::{corner, trace};
use kurbo::BezPath;
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};

/// How a picture becomes curves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Contours.
    pub trace: trace::Options,
    /// Corners.
    pub corners: corner::Method,
    /// Curves.
    #[serde(deserialize_with = "fitter")]
    pub fit: fit::Method,
    /// Distance between contour and curve that a fitter aims at, px.
    #[serde(deserialize_with = "tolerance")]
    pub tolerance_px: f64,
}

fn tolerance<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    Options::tolerance(f64::deserialize(from)?).map_err(D::Error::custom)
}

fn fitter<'de, D: Deserializer<'de>>(from: D) -> Result<fit::Method, D::Error> {
    let method = fit::Method::deserialize(from)?;
    let checked = method.fitter().check();
    checked.map(|()| method).map_err(D::Error::custom)
}

impl Default for Options {
    fn default() -> Self {
        Self {
            trace: trace::Options::default(),
            corners: corner::Method::default(),
            fit: fit::Method::default(),
            tolerance_px: 0.5,
        }
    }
}

impl Options {
    /// The distance between contour and curve, px, where a fitter can aim at it.
    ///
    /// # Errors
    /// It is outside the range, which the error names.
    pub fn tolerance(px: f64) -> Result<f64, &'static str> {
        let fine = (0.001..=1000.0).contains(&px);
        fine.then_some(px)
            .ok_or("must be between 0.001 and 1000 pixels")
    }

    /// The same for a picture whose pixels are `side` of the usual ones a side.
    pub(super) fn for_pixels_of(&self, side: usize) -> Self {
        let side = side as f64;
        let mut options = self.clone();
        options.tolerance_px /= side;
        options.trace.speckle_px2 /= side * side;
        options
    }

    /// The curves of some contours.
    pub(super) fn curves(&self, edges: &[Cornered]) -> Result<Vec<BezPath>, FitError> {
        let fit = |(c, at): &Cornered| {
            let fitter = self.fit.fitter();
            fitter.contour(&c.cut(at), self.tolerance_px)
        };
        // of several errors the first contour's
        each(edges, fit).into_iter().collect()
    }
}
