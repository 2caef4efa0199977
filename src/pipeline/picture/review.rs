//! A second look: corners that the picture and the fitted curves contradict, and their contours once more.

use super::contours::sharp;
use super::options::Options;
use crate::{
    fit::FitError,
    refine::{Comparison, Cornered, Doubts, squares_left},
    types::Gray,
};
use kurbo::{BezPath, Point};

/// A corner so near to a node that is gone is gone with it, px.
const SAME_PX: f64 = 1.5;
/// Corners so near to a missing part are gone with it, px.
const LOST_PX: f64 = 8.0;
/// A part that is brought back leaves so many squares less, once nodes have settled with and without it.
const LOST: f64 = 0.25;
/// Where more are missing corners are not why: hatching and noise leave them everywhere.
const MOST_LOST: usize = 8;
/// Nor where more are doubted, and more than one in so many points of the contours: noise has one in 36, those
/// contours of letters that have any one in 260.
const MOST_DOUBTS: usize = 1000;
const DOUBTS_APART: usize = 100;
/// Times that a contour which was fit again is looked at once more.
const REVISIONS: usize = 3;

/// The paths of contours, those with doubtful corners fit again as far as the picture bears it out, and all nodes
/// settled in the picture and wrong places mended.
pub(super) fn reviewed(
    coverage: &Gray,
    found: &[Cornered],
    paths: &[BezPath],
    options: &Options,
) -> Result<Vec<BezPath>, FitError> {
    let blur = found.first().map_or(0.0, |(c, _)| c.blur_px());
    let seen = Comparison::new(coverage, paths, blur);
    let mut doubts = borne_out(found, seen.doubts(paths));
    let mut wanted = corrected(found, &doubts);
    let mut again = refit(coverage, (found, paths), &wanted, options)?;
    for _ in 0..REVISIONS {
        if again == paths {
            break;
        }
        let revised = seen.revised(&again, &doubts);
        if revised == doubts {
            break;
        }
        doubts = revised;
        wanted = corrected(found, &doubts);
        again = refit(coverage, (found, paths), &wanted, options)?;
    }
    let mut drawn = seen.mended(&seen.settled(&again));
    for _ in 0..REVISIONS {
        let Some((fewer, better)) = completed(coverage, &wanted, &drawn, options)? else {
            break;
        };
        (wanted, drawn) = (fewer, better);
    }
    let (paths, _) = drawn;
    Ok(paths)
}

/// Paths, and the places where they leave out a part of the drawing.
type Drawn = (Vec<BezPath>, Vec<Point>);

/// The contours without the corners beside which parts of the drawing are lost, and their paths: sides that a corner
/// was found from can lie beyond a short serif, which it then cuts off. Nothing where they bring no part back.
fn completed(
    coverage: &Gray,
    found: &[Cornered],
    (paths, lost): &Drawn,
    options: &Options,
) -> Result<Option<(Vec<Cornered>, Drawn)>, FitError> {
    if lost.is_empty() || lost.len() > MOST_LOST {
        return Ok(None);
    }
    let without = |(contour, at): &Cornered| {
        let apart = |i: &usize| {
            let at = contour.points()[*i];
            lost.iter().all(|p| p.distance(at) > LOST_PX)
        };
        (contour.clone(), at.iter().copied().filter(apart).collect())
    };
    let wanted: Vec<Cornered> = found.iter().map(without).collect();
    if wanted == found {
        return Ok(None);
    }
    let again = refit(coverage, (found, paths), &wanted, options)?;
    let blur = found.first().map_or(0.0, |(c, _)| c.blur_px());
    let seen = Comparison::new(coverage, &again, blur);
    let (mut again, lost) = seen.mended(&seen.settled(&again));
    for (k, path) in paths.iter().enumerate() {
        if wanted[k] == found[k] {
            again[k].clone_from(path);
        }
    }
    let [before, after] = [paths, &again].map(|p| squares_left(coverage, p, blur));
    Ok((after + LOST < before).then_some((wanted, (again, lost))))
}

/// The paths, those anew whose corners are not those found.
fn refit(
    coverage: &Gray,
    (found, paths): (&[Cornered], &[BezPath]),
    wanted: &[Cornered],
    options: &Options,
) -> Result<Vec<BezPath>, FitError> {
    if wanted == found {
        return Ok(paths.to_vec());
    }
    let edges = sharp(coverage, wanted, options);
    let other = |k: &usize| wanted[*k] != found[*k];
    let others: Vec<usize> = (0..paths.len()).filter(other).collect();
    let edges: Vec<Cornered> = others.iter().map(|&k| edges[k].clone()).collect();
    let mut paths = paths.to_vec();
    for (k, path) in others.into_iter().zip(options.curves(&edges)?) {
        paths[k] = path;
    }
    Ok(paths)
}

/// The doubts about contours, or none where they are so many that the picture is one of noise.
fn borne_out(found: &[Cornered], doubts: Vec<Doubts>) -> Vec<Doubts> {
    let count: usize = doubts.iter().map(|d| d.round.len() + d.sharp.len()).sum();
    let points: usize = found.iter().map(|(c, _)| c.points().len()).sum();
    if count > MOST_DOUBTS.max(points / DOUBTS_APART) {
        vec![Doubts::default(); doubts.len()]
    } else {
        doubts
    }
}

/// The contours without the corners that are drawn round, and with those that were overlooked.
fn corrected(found: &[Cornered], doubts: &[Doubts]) -> Vec<Cornered> {
    found.iter().zip(doubts).map(told).collect()
}

fn told(((contour, at), doubts): (&Cornered, &Doubts)) -> Cornered {
    let points = contour.points();
    let off = |i: usize, p: Point| points[i].distance(p);
    let nearest = |among: &mut dyn Iterator<Item = usize>, p: Point| {
        among.min_by(|a, b| off(*a, p).total_cmp(&off(*b, p)))
    };
    let corner = |p: &Point| nearest(&mut at.iter().copied(), *p);
    let round = doubts.round.iter().filter_map(corner);
    let replaced = doubts.sharp.iter().flat_map(|c| &c.nodes);
    let replaced = replaced.filter_map(|p| corner(p).filter(|&i| off(i, *p) <= SAME_PX));
    let gone: Vec<usize> = round.chain(replaced).collect();
    let tips = doubts.sharp.iter().map(|c| c.tip);
    let new = tips.filter_map(|p| nearest(&mut (0..points.len()), p));
    let left = at.iter().copied().filter(|i| !gone.contains(i));
    let mut at: Vec<usize> = left.chain(new).collect();
    at.sort_unstable();
    at.dedup();
    (contour.clone(), at)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::Contour;

    #[test]
    fn doubts_everywhere_are_none() {
        let doubted = |count: usize| {
            let round = vec![Point::ORIGIN; count];
            let sharp = Vec::new();
            vec![Doubts { round, sharp }]
        };
        let long = 2 * DOUBTS_APART * MOST_DOUBTS;
        for (points, most) in [(3, MOST_DOUBTS), (long, 2 * MOST_DOUBTS)] {
            let ring = (0..points).map(|i| Point::new(i as f64, (i % 2) as f64));
            let found = [(Contour::new(ring.collect()).unwrap(), Vec::new())];
            assert_eq!(borne_out(&found, doubted(most)), doubted(most));
            assert_eq!(borne_out(&found, doubted(most + 1)), doubted(0));
        }
    }
}
