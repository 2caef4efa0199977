//! One picture → closed curves: trace, corner, cut, fit, refine.

use crate::{
    corner,
    fit::{self, FitError},
    refine, trace,
    types::{Contour, Fitted, Gray},
};
use kurbo::{Affine, BezPath, PathEl};
use serde::{Deserialize, Serialize};

/// How a picture becomes curves.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Contours.
    pub trace: trace::Options,
    /// Corners.
    pub corners: corner::Method,
    /// Curves.
    pub fit: fit::Method,
    /// Distance between contour and curve that a fitter aims at, px.
    pub tolerance_px: f64,
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

/// The closed curves around a picture's ink, px, y up, origin at the picture's bottom left; outer ones
/// counter-clockwise, holes clockwise. Nothing for a picture without ink.
///
/// # Errors
/// An option of the fitter is outside its range.
pub fn trace_picture(gray: &Gray, options: &Options) -> Result<Vec<BezPath>, FitError> {
    let edges = edges(gray, options);
    let fits = edges
        .iter()
        .map(|(contour, corners)| fit_contour(contour, corners, options));
    fits.collect()
}

/// The contours of a picture's ink with their corners sharp, and the corners' indices.
#[must_use]
pub fn edges(gray: &Gray, options: &Options) -> Vec<(Contour, Vec<usize>)> {
    let coverage = trace::level(gray);
    let contours = trace::trace(&coverage, &options.trace);
    let detector = options.corners.detector();
    if options.trace.boundary == trace::Boundary::Chain {
        // the boundary that the papers start from is taken as it is
        let found = contours.into_iter().map(|c| {
            let at = detector.corners(&c);
            (c, at)
        });
        return found.collect();
    }
    let sharp = contours
        .iter()
        .map(|c| corner::sharpen(c, &detector.corners(c)));
    let sharp: Vec<_> = sharp.collect();
    refine::contours(&coverage, &sharp)
}

/// The map from the curves' space (y up) to the picture's (y down).
#[must_use]
#[expect(
    clippy::cast_precision_loss,
    reason = "pictures have fewer rows than 2^52"
)]
pub fn to_picture(gray: &Gray) -> Affine {
    Affine::new([1.0, 0.0, 0.0, -1.0, 0.0, gray.height() as f64])
}

fn fit_contour(
    contour: &Contour,
    corners: &[usize],
    options: &Options,
) -> Result<BezPath, FitError> {
    let spans = contour.cut(corners);
    let fitter = options.fit.fitter();
    let pieces: Result<Vec<Fitted>, FitError> = spans
        .iter()
        .map(|s| fitter.fit(s, options.tolerance_px))
        .collect();
    Ok(join(&pieces?))
}

/// One closed path of the spans' paths in order; each starts where the one before ends.
fn join(pieces: &[Fitted]) -> BezPath {
    let mut path = BezPath::new();
    for (i, el) in pieces.iter().flat_map(|f| f.path.elements()).enumerate() {
        match el {
            PathEl::MoveTo(_) if i > 0 => {}
            PathEl::ClosePath => {}
            el => path.push(*el),
        }
    }
    path.close_path();
    path
}
