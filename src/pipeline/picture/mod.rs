//! One picture → closed curves: trace, corner, cut, fit, refine.

mod contours;
mod options;
mod review;

pub use options::Options;

use crate::fit::{self, FitError};
use crate::refine::Cornered;
use crate::scan;
use crate::trace::Boundary;
use crate::types::Gray;
use contours::{found, sharp};
use kurbo::BezPath;

/// The closed curves around a picture's ink, px, y up, origin at the picture's bottom left; outer ones
/// counter-clockwise, holes clockwise. Nothing for a picture without ink.
///
/// # Errors
/// An option of the fitter is outside its range.
pub fn trace_picture(gray: &Gray, options: &Options) -> Result<Vec<BezPath>, FitError> {
    let soft = softened(gray, options);
    let (coverage, found) = found(soft.as_ref().unwrap_or(gray), options);
    let paths = options.curves(&sharp(&coverage, &found, options))?;
    if matches!(options.fit, fit::Method::Joint(_)) {
        review::reviewed(&coverage, &found, &paths, options)
    } else {
        Ok(paths)
    }
}

/// The picture in grey levels, for the methods that look at them, where it has but two.
fn softened(gray: &Gray, options: &Options) -> Option<Gray> {
    let looks =
        matches!(options.fit, fit::Method::Joint(_)) && options.trace.boundary == Boundary::Iso;
    looks.then(|| scan::softened(gray)).flatten()
}

/// The contours of a picture's ink with their corners sharp, and the corners' indices.
#[must_use]
pub fn edges(gray: &Gray, options: &Options) -> Vec<Cornered> {
    let soft = softened(gray, options);
    let (coverage, found) = found(soft.as_ref().unwrap_or(gray), options);
    sharp(&coverage, &found, options)
}
