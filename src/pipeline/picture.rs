//! One picture → closed curves: trace, corner, cut, fit, refine.

use super::review;
use crate::{
    corner,
    fit::{self, FitError},
    refine::{self, Cornered},
    trace,
    types::Gray,
};
use kurbo::{Affine, BezPath};
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
    pub fit: fit::Method,
    /// Distance between contour and curve that a fitter aims at, px.
    #[serde(deserialize_with = "tolerance")]
    pub tolerance_px: f64,
}

/// A distance in px that a fitter can aim at.
fn tolerance<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    let px = f64::deserialize(from)?;
    if (0.001..=1000.0).contains(&px) {
        Ok(px)
    } else {
        Err(D::Error::custom("must be between 0.001 and 1000 pixels"))
    }
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
    let (coverage, found) = found(gray, options);
    let paths = fit(&sharp(&coverage, &found, options), options)?;
    if matches!(options.fit, fit::Method::Joint(_)) {
        review::reviewed(&coverage, &found, &paths, options)
    } else {
        Ok(paths)
    }
}

/// The curves of some contours.
pub(super) fn fit(edges: &[Cornered], options: &Options) -> Result<Vec<BezPath>, FitError> {
    let fitter = options.fit.fitter();
    let fit = |(c, at): &Cornered| fitter.contour(&c.cut(at), options.tolerance_px);
    edges.iter().map(fit).collect()
}

/// The contours of a picture's ink with their corners sharp, and the corners' indices.
#[must_use]
pub fn edges(gray: &Gray, options: &Options) -> Vec<Cornered> {
    let (coverage, found) = found(gray, options);
    sharp(&coverage, &found, options)
}

/// The picture's coverage, and its contours as they were traced with the indices of their corners.
fn found(gray: &Gray, options: &Options) -> (Gray, Vec<Cornered>) {
    let coverage = trace::level(gray);
    let detector = options.corners.detector();
    let contours = trace::trace(&coverage, &options.trace).into_iter();
    let found = contours.map(|c| {
        let at = detector.corners(&c);
        (c, at)
    });
    let found = found.collect();
    let found = decided(&coverage, found, options);
    (coverage, found)
}

/// The contours with their corners sharp, moved to where the picture has its edges.
pub(super) fn sharp(coverage: &Gray, found: &[Cornered], options: &Options) -> Vec<Cornered> {
    if options.trace.boundary == trace::Boundary::Chain {
        // the boundary that the papers start from is taken as it is
        return found.to_vec();
    }
    let sharp: Vec<_> = found.iter().map(|(c, at)| corner::sharpen(c, at)).collect();
    refine::contours(coverage, &sharp)
}

/// The corners that the picture bears out, where the detector leaves it to it.
fn decided(coverage: &Gray, found: Vec<Cornered>, options: &Options) -> Vec<Cornered> {
    let detector = options.corners.detector();
    let possible: Option<Vec<Vec<usize>>> =
        found.iter().map(|(c, _)| detector.possible(c)).collect();
    let Some(possible) = possible.filter(|_| options.trace.boundary == trace::Boundary::Iso) else {
        return found;
    };
    let pairs = || found.iter().zip(&possible);
    let sharp: Vec<Cornered> = pairs()
        .map(|((c, _), may)| corner::sharpen(c, may))
        .collect();
    let seen: Vec<Vec<bool>> = pairs()
        .map(|((_, at), may)| may.iter().map(|i| at.contains(i)).collect())
        .collect();
    let kept = refine::confirmed(coverage, &sharp, &seen);
    let chosen = possible.iter().zip(kept).map(|(may, kept)| {
        let both = may.iter().zip(kept);
        both.filter_map(|(i, kept)| kept.then_some(*i)).collect()
    });
    let contours = found.iter().map(|(c, _)| c.clone());
    contours.zip(chosen).collect()
}

/// The map from the curves' space (y up) to that of a picture so many px high (y down).
#[must_use]
#[expect(
    clippy::cast_precision_loss,
    reason = "pictures have fewer rows than 2^52"
)]
pub fn to_picture(height: usize) -> Affine {
    Affine::new([1.0, 0.0, 0.0, -1.0, 0.0, height as f64])
}
