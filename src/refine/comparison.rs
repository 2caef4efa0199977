//! Fitted paths beside the grey picture: what it says against them, and where their nodes settle.

use super::{
    blunt::{self, Overlooked},
    corners,
    curves::polygon,
    mend,
    nodes::{self, Soft},
    residual::Residual,
};
use crate::{numeric::many::each, types::Gray};
use kurbo::{BezPath, CubicBez, Point};
use std::cell::LazyCell;

/// Chords leave a path that is compared with the picture by no more than this, px.
const CHORD_PX: f64 = 0.01;
/// A fitted corner so near to where a new one was expected is that one, px.
const SAME_PX: f64 = 6.0;

/// What the picture says against the corners of a fitted path.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Doubts {
    /// Corners that are drawn round.
    pub round: Vec<Point>,
    /// Where two sides would meet that a short run of curves joins, and should.
    pub sharp: Vec<Overlooked>,
}

/// The grey picture beside fitted paths.
#[derive(Debug)]
pub struct Comparison<'g> {
    residual: Residual<'g>,
}

impl<'g> Comparison<'g> {
    /// The picture against the fill of `paths`, both blurred by `blur_px`.
    #[must_use]
    pub fn new(gray: &'g Gray, paths: &[BezPath], blur_px: f64) -> Self {
        let rings = polygons(paths);
        Self {
            residual: Residual::new(gray, rings.iter().map(Vec::as_slice), blur_px),
        }
    }

    /// What it says against the corners of those paths.
    #[must_use]
    pub fn doubts(&self, paths: &[BezPath]) -> Vec<Doubts> {
        let of = |path: &BezPath| {
            let segments = cubics(path);
            Doubts {
                round: corners::undrawn(&self.residual, &segments),
                sharp: blunt::overlooked(&self.residual, &segments),
            }
        };
        each(paths, of)
    }

    /// The doubts as they stand after a look at `paths`, which were fitted to them: new corners that explain the
    /// picture no better than the curves in their place are given up, and so are all that came out longer than drawn.
    #[must_use]
    pub fn revised(&self, paths: &[BezPath], doubts: &[Doubts]) -> Vec<Doubts> {
        let before = &self.residual;
        let after = before.against(polygons(paths).iter().map(Vec::as_slice));
        let grain = LazyCell::new(|| before.grain());
        let revised = |(path, doubts): (&BezPath, &Doubts)| {
            let mut doubts = doubts.clone();
            if doubts == Doubts::default() {
                return doubts;
            }
            for p in corners::undrawn(&after, &cubics(path)) {
                let new = doubts.sharp.len();
                doubts.sharp.retain(|c| c.tip.distance(p) > SAME_PX);
                if doubts.sharp.len() == new && !doubts.round.contains(&p) {
                    doubts.round.push(p);
                }
            }
            let explains = |c: &Overlooked| c.explains((before, *grain), &after);
            if !doubts.sharp.iter().all(explains) {
                doubts.sharp.clear();
            }
            doubts
        };
        paths.iter().zip(doubts).map(revised).collect()
    }

    /// Paths like those, with nodes and handles where their blurred fill is most like the picture.
    #[must_use]
    pub fn settled(&self, paths: &[BezPath]) -> Vec<BezPath> {
        let rings = each(paths, nodes::fine);
        let mut residual = self.residual.against(rings.iter().map(Vec::as_slice));
        nodes::settled(&mut residual, paths, Soft::Stay)
    }

    /// Paths like those, with the few nodes around each place that is left unexplained fit to its pixels, in the
    /// structure that leaves least, and all nodes settled once more; and the places where a part of the drawing is
    /// missing all the same.
    #[must_use]
    pub fn mended(&self, paths: &[BezPath]) -> (Vec<BezPath>, Vec<Point>) {
        mend::mended(&self.residual, paths)
    }
}

/// Sum of the squared differences between a coverage and the fill of paths, blurred by `blur_px`.
#[must_use]
pub fn squares_left(coverage: &Gray, paths: &[BezPath], blur_px: f64) -> f64 {
    let rings = polygons(paths);
    Residual::as_seen(coverage, rings.iter().map(Vec::as_slice), blur_px).all_squares()
}

/// The segments of a path.
fn cubics(path: &BezPath) -> Vec<CubicBez> {
    path.segments().map(|s| s.to_cubic()).collect()
}

fn polygons(paths: &[BezPath]) -> Vec<Vec<Point>> {
    each(paths, |p| polygon(p, CHORD_PX))
}
