//! One picture → closed curves: trace, corner, cut, fit, refine.

mod contours;
mod options;
mod review;

pub use options::Options;

use crate::fit::{self, FitError};
use crate::refine::Cornered;
use crate::scan;
use crate::trace::{self, Boundary};
use crate::types::Gray;
use contours::{found, sharp};
use kurbo::{Affine, BezPath};

/// The closed curves around a picture's ink, px, y up, origin at the picture's bottom left; outer ones
/// counter-clockwise, holes clockwise. Nothing for a picture without ink.
///
/// A picture out of focus is traced in larger pixels ([`trace::focused`]); lengths in the options are those of its own.
///
/// # Errors
/// An option of the fitter is outside its range.
pub fn trace_picture(gray: &Gray, options: &Options) -> Result<Vec<BezPath>, FitError> {
    let soft = softened(gray, options);
    let gray = soft.as_ref().unwrap_or(gray);
    let (coverage, found) = found(gray, options);
    if let Some((focused, side)) = focused(gray, &found, options) {
        let paths = trace_picture(&focused, &options.for_pixels_of(side))?.into_iter();
        return Ok(paths.map(|p| Affine::scale(side as f64) * p).collect());
    }
    let paths = options.curves(&sharp(&coverage, &found, options))?;
    if matches!(options.fit, fit::Method::Joint(_)) {
        review::reviewed(&coverage, &found, &paths, options)
    } else {
        Ok(paths)
    }
}

/// Whether the methods look at grey levels, and not at a boundary of pixels as it is.
fn look_at_grey(options: &Options) -> bool {
    matches!(options.fit, fit::Method::Joint(_)) && options.trace.boundary == Boundary::Iso
}

/// The picture in grey levels, for the methods that look at them, where it has but two.
fn softened(gray: &Gray, options: &Options) -> Option<Gray> {
    let looks = look_at_grey(options);
    looks.then(|| scan::softened(gray)).flatten()
}

/// The picture in larger pixels, for the methods that look at grey levels, where it is out of focus; and the side of one.
fn focused(gray: &Gray, found: &[Cornered], options: &Options) -> Option<(Gray, usize)> {
    let (contour, _) = found.first().filter(|_| look_at_grey(options))?;
    trace::focused(gray, contour.blur_px())
}

/// The contours of a picture's ink with their corners sharp, and the corners' indices.
#[must_use]
pub fn edges(gray: &Gray, options: &Options) -> Vec<Cornered> {
    let soft = softened(gray, options);
    let (coverage, found) = found(soft.as_ref().unwrap_or(gray), options);
    sharp(&coverage, &found, options)
}
