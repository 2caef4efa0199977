//! One picture → closed curves: trace, corner, cut, fit, refine.

mod border;
mod contours;
mod options;
mod review;

pub use options::Options;

use crate::fit::{self, FitError};
use crate::refine::Cornered;
use crate::scan;
use crate::trace::{self, Boundary};
use crate::types::Gray;
use border::Carried;
use contours::{found, sharp};
use kurbo::BezPath;

/// The closed curves around a picture's ink, px, y up, origin at the picture's bottom left; outer ones
/// counter-clockwise, holes clockwise. Nothing for a picture without ink. Ink that the picture's edge cuts ends
/// there, straight.
///
/// # Errors
/// An option of the fitter is outside its range.
pub fn trace_picture(gray: &Gray, options: &Options) -> Result<Vec<BezPath>, FitError> {
    let soft = softened(gray, options);
    let coverage = trace::level(soft.as_ref().unwrap_or(gray));
    match carried(&coverage, options) {
        Some(carried) => {
            let paths = curves(&carried.coverage, options)?;
            Ok(carried.cut(&paths, options.trace.speckle_px2))
        }
        None => curves(&coverage, options),
    }
}

/// The coverage with the ink that the picture's edge cuts carried on, if there is such.
fn carried(coverage: &Gray, options: &Options) -> Option<Carried> {
    // pixels' centres are followed as they lie, and end within the picture
    if options.trace.boundary == Boundary::Chain || !border::cuts(coverage) {
        return None;
    }
    let contours = trace::trace(coverage, &options.trace);
    border::carried(coverage, border::blur_px(coverage, &contours)?)
}

/// The closed curves around the ink of a coverage, wherever it ends.
fn curves(coverage: &Gray, options: &Options) -> Result<Vec<BezPath>, FitError> {
    let found = found(coverage, options);
    let paths = options.curves(&sharp(coverage, &found, options))?;
    if matches!(options.fit, fit::Method::Joint(_)) {
        review::reviewed(coverage, &found, &paths, options)
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
    let coverage = trace::level(soft.as_ref().unwrap_or(gray));
    sharp(&coverage, &found(&coverage, options), options)
}
