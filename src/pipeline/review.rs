//! A second look: corners that the picture and the fitted curves contradict, and their contours once more.

use super::picture::{Options, fit, sharp};
use crate::{
    fit::FitError,
    refine::{Cornered, Doubts, Fitted},
    types::Gray,
};
use kurbo::{BezPath, Point};

/// A corner so near to a node that is gone is gone with it, px.
const SAME_PX: f64 = 1.5;

/// The paths of contours, those with doubtful corners fit again, and all nodes settled in the picture. A corner that was
/// added stays where the picture bears it out.
pub(super) fn reviewed(
    coverage: &Gray,
    found: &[Cornered],
    paths: &[BezPath],
    options: &Options,
) -> Result<Vec<BezPath>, FitError> {
    let blur = found.first().map_or(0.0, |(c, _)| c.blur_px());
    let fitted = Fitted::new(coverage, paths, blur);
    let mut doubts = fitted.doubts(paths);
    let mut again = refit(coverage, found, (paths, &doubts), options)?;
    let corners: Vec<_> = doubts.iter().map(|d| d.sharp.clone()).collect();
    if corners.iter().any(|c| !c.is_empty()) {
        let kept = fitted.borne_out(&again, &corners);
        if kept.contains(&false) {
            let dropped = doubts.iter_mut().zip(&kept).filter(|(_, kept)| !**kept);
            dropped.for_each(|(doubts, _)| doubts.sharp.clear());
            again = refit(coverage, found, (paths, &doubts), options)?;
        }
    }
    Ok(fitted.settled(&again))
}

/// The paths, those anew whose corners are doubted.
fn refit(
    coverage: &Gray,
    found: &[Cornered],
    (paths, doubts): (&[BezPath], &[Doubts]),
    options: &Options,
) -> Result<Vec<BezPath>, FitError> {
    let wanted: Vec<Cornered> = found.iter().zip(doubts).map(corrected).collect();
    if wanted == found {
        return Ok(paths.to_vec());
    }
    let edges = sharp(coverage, &wanted, options);
    let mut paths = paths.to_vec();
    for (k, path) in paths.iter_mut().enumerate() {
        if wanted[k] != found[k] {
            *path = fit(&edges[k..=k], options)?.swap_remove(0);
        }
    }
    Ok(paths)
}

/// A contour without the corners that are drawn round, and with those that were overlooked.
fn corrected(((contour, at), doubts): (&Cornered, &Doubts)) -> Cornered {
    let points = contour.points();
    let mut at = at.clone();
    let nearest = |among: &mut dyn Iterator<Item = usize>, p: Point| {
        let off = |i: &usize| points[*i].distance_squared(p);
        among.min_by(|a, b| off(a).total_cmp(&off(b)))
    };
    let mut leave = |p: Point, within: f64| {
        let corner = nearest(&mut at.iter().copied(), p);
        let near = corner.filter(|&i| points[i].distance(p) <= within);
        at.retain(|&i| Some(i) != near);
    };
    doubts.round.iter().for_each(|p| leave(*p, f64::INFINITY));
    let replaced = doubts.sharp.iter().flat_map(|c| &c.nodes);
    replaced.for_each(|p| leave(*p, SAME_PX));
    let tips = doubts.sharp.iter().map(|c| c.tip);
    at.extend(tips.filter_map(|p| nearest(&mut (0..points.len()), p)));
    at.sort_unstable();
    at.dedup();
    (contour.clone(), at)
}
