//! One picture → closed curves: trace, corner, cut, fit, refine.

mod border;
mod contours;
mod options;
mod review;
#[cfg(test)]
mod tests;

pub use options::Options;

use crate::fit::{self, FitError};
use crate::scan::{self, Even, InkStreaks};
use crate::trace::{self, Boundary};
use crate::types::{Contour, Gray};
use border::Carried;
use contours::{found, sharp};
use kurbo::{Affine, BezPath};

/// The curves around a picture's ink.
#[derive(Debug, Clone)]
pub struct Curves {
    /// Closed, px, y up, origin at the picture's bottom left; outer ones counter-clockwise, holes clockwise.
    pub paths: Vec<BezPath>,
    /// Whether pale streaks in its ink were filled.
    pub filled: bool,
}

/// The closed curves around a picture's ink, none where it has no ink. Ink that the picture's edge cuts ends there,
/// straight. `streaks` says what becomes of pale ones in its ink.
///
/// A picture out of focus is traced in larger pixels ([`trace::focused`]); lengths in the options are those of its
/// own.
///
/// # Errors
/// An option of the fitter is outside its range.
pub fn trace_picture(
    gray: &Gray,
    streaks: InkStreaks,
    options: &Options,
) -> Result<Curves, FitError> {
    let even = legible(gray, streaks, options);
    let filled = even.as_ref().is_some_and(|even| even.filled);
    let gray = even.as_ref().map_or(gray, |even| &even.gray);
    let coverage = trace::level(gray);
    let contours = trace::trace(&coverage, &options.trace);
    if let Some((focused, side)) = focused(gray, &contours, options) {
        let small = trace_picture(&focused, streaks, &options.for_pixels_of(side))?;
        let paths = small.paths.into_iter();
        return Ok(Curves {
            paths: paths.map(|p| Affine::scale(side as f64) * p).collect(),
            filled: filled || small.filled,
        });
    }
    let paths = match carried(&coverage, &contours, options) {
        Some(carried) => {
            let contours = trace::trace(&carried.coverage, &options.trace);
            let paths = curves(&carried.coverage, contours, options)?;
            carried.cut(&paths, options.trace.speckle_px2)
        }
        None => curves(&coverage, contours, options)?,
    };
    Ok(Curves { paths, filled })
}

/// The coverage with the ink that the picture's edge cuts carried on, if there is such.
fn carried(coverage: &Gray, contours: &[Contour], options: &Options) -> Option<Carried> {
    // pixels' centres are followed as they lie, and end within the picture
    if options.trace.boundary == Boundary::Chain || !border::cuts(coverage) {
        return None;
    }
    border::carried(coverage, border::blur_px(coverage, contours)?)
}

/// The closed curves along the contours of a coverage.
fn curves(
    coverage: &Gray,
    contours: Vec<Contour>,
    options: &Options,
) -> Result<Vec<BezPath>, FitError> {
    let found = found(coverage, contours, options);
    let paths = options.curves(&sharp(coverage, &found, options))?;
    if matches!(options.fit, fit::Method::Joint(_)) {
        review::reviewed(coverage, &found, &paths, options)
    } else {
        Ok(paths)
    }
}

/// Whether the methods look at grey levels, and not at a boundary of pixels as it is.
fn look_at_grey(options: &Options) -> bool {
    matches!(options.fit, fit::Method::Joint(_)) && options.trace.boundary == Boundary::Iso
}

/// The picture with its ink at one level where it is pale in many places; in grey levels, for the methods that look
/// at them, where it has but two.
fn legible(gray: &Gray, streaks: InkStreaks, options: &Options) -> Option<Even> {
    if look_at_grey(options) {
        scan::legible(gray, streaks)
    } else {
        scan::shaded(gray, streaks)
    }
}

/// The picture in larger pixels, for the methods that look at grey levels, where it is out of focus; and the side of
/// one.
fn focused(gray: &Gray, contours: &[Contour], options: &Options) -> Option<(Gray, usize)> {
    let seen = contours.first().filter(|_| look_at_grey(options))?;
    trace::focused(gray, seen.blur_px())
}
