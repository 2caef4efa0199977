//! One picture → its contours and their corners.

use super::options::Options;
use crate::numeric::many::each;
use crate::refine::{self, Cornered};
use crate::types::{Contour, Gray};
use crate::{corner, trace};

/// The contours of a picture's coverage as they were traced, with the indices of their corners.
pub(super) fn found(coverage: &Gray, contours: Vec<Contour>, options: &Options) -> Vec<Cornered> {
    let corners = each(&contours, |c| options.corners.detector().corners(c));
    let found = contours.into_iter().zip(corners).collect();
    decided(coverage, found, options)
}

/// The contours with their corners sharp, moved to where the picture has its edges.
pub(super) fn sharp(coverage: &Gray, found: &[Cornered], options: &Options) -> Vec<Cornered> {
    if options.trace.boundary == trace::Boundary::Chain {
        // the boundary that the papers start from is taken as it is
        return found.to_vec();
    }
    let sharp = each(found, |(c, at)| corner::sharpen(c, at));
    refine::contours(coverage, &sharp)
}

/// The corners that the picture bears out, where the detector leaves it to it.
fn decided(coverage: &Gray, found: Vec<Cornered>, options: &Options) -> Vec<Cornered> {
    let possible = each(&found, |(c, _)| options.corners.detector().possible(c));
    let possible: Option<Vec<Vec<usize>>> = possible.into_iter().collect();
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
