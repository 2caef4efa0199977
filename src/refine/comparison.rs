//! Fitted paths beside the grey picture: what it says against them, and where their nodes settle.

use super::{
    blunt::{self, Overlooked},
    corners, nodes,
    residual::Residual,
};
use crate::types::Gray;
use kurbo::{BezPath, CubicBez, ParamCurve, PathEl, PathSeg, Point, Vec2, flatten};

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
    /// Corners that looked round and are none the less corners.
    pub kept: Vec<Tip>,
}

/// A corner of a fitted path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tip {
    /// Where it is.
    pub at: Point,
    /// From there to where its tip is drawn.
    pub inwards: Vec2,
}

/// The grey picture beside fitted paths.
#[derive(Debug)]
pub struct Comparison {
    residual: Residual<'static>,
}

impl Comparison {
    /// The picture against the fill of `paths`, both blurred by `blur_px`.
    #[must_use]
    pub fn new(gray: &Gray, paths: &[BezPath], blur_px: f64) -> Self {
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
                kept: Vec::new(),
            }
        };
        paths.iter().map(of).collect()
    }

    /// The doubts as they stand after a look at `paths`, which were fitted to them: new corners that explain the
    /// picture no better than the curves in their place are given up, and so are all that came out longer than drawn.
    #[must_use]
    pub fn revised(&self, paths: &[BezPath], doubts: &[Doubts]) -> Vec<Doubts> {
        let before = &self.residual;
        let after = before.against(polygons(paths).iter().map(Vec::as_slice));
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
            if !doubts.sharp.iter().all(|c| c.explains(before, &after)) {
                doubts.sharp.clear();
            }
            doubts
        };
        paths.iter().zip(doubts).map(revised).collect()
    }

    /// Paths like those, with nodes and handles where their blurred fill is most like the picture.
    #[must_use]
    pub fn settled(&self, paths: &[BezPath]) -> Vec<BezPath> {
        nodes::settled(&self.residual, paths)
    }

    /// The doubts with those corners kept that explain the picture better than a curve, as they are or with their tips
    /// drawn in, once all nodes have settled. `paths` have all corners; `round` ones do not, and have settled.
    #[must_use]
    pub fn upheld(
        &self,
        doubts: &[Doubts],
        (paths, round): (&[BezPath], &[BezPath]),
    ) -> Vec<Doubts> {
        let rings = polygons(round);
        let off = |paths: &[BezPath]| {
            let rings = polygons(paths);
            self.residual.against(rings.iter().map(Vec::as_slice))
        };
        let mut tried = doubts.to_vec();
        for (path, d) in paths.iter().zip(&mut tried) {
            d.kept = d.round.iter().map(|p| self.tip(path, *p)).collect();
        }
        let plain = off(&self.settled(paths));
        let short = off(&self.settled(&drawn_in(paths, &tried)));
        let round = off(round);
        for d in &mut tried {
            let tips = std::mem::take(&mut d.kept);
            for tip in tips {
                // as far as all reach from where the corner was
                let gaps = rings.iter().flatten().map(|q| q.distance(tip.at));
                let reach = blunt::reach_px(&self.residual);
                let reach = reach + gaps.fold(f64::INFINITY, f64::min).min(reach);
                let [round, plain, short] =
                    [&round, &plain, &short].map(|r| r.squares(tip.at, reach));
                if round < plain.min(short) {
                    continue;
                }
                d.round.retain(|p| *p != tip.at);
                let inwards = if short < plain {
                    tip.inwards
                } else {
                    Vec2::ZERO
                };
                d.kept.push(Tip { inwards, ..tip });
            }
        }
        tried
    }

    /// Of both versions of each path the second, if it explains the picture along it as well as the first.
    #[must_use]
    pub fn as_well(&self, first: Vec<BezPath>, second: Vec<BezPath>) -> Vec<BezPath> {
        /// A corner more or less hardly changes the differences all along a path.
        const AS_WELL: f64 = 2.0;
        let off = |paths: &[BezPath]| {
            let rings = polygons(paths);
            let off = self.residual.against(rings.iter().map(Vec::as_slice));
            rings.iter().map(|r| off.along(r)).collect::<Vec<f64>>()
        };
        let worse = off(&first).into_iter().zip(off(&second));
        let worse: Vec<bool> = worse.map(|(a, b)| b > AS_WELL * a).collect();
        let pairs = first.into_iter().zip(second).zip(worse);
        pairs
            .map(|((a, b), worse)| if worse { a } else { b })
            .collect()
    }

    /// The corner at a point and where its tip is drawn.
    fn tip(&self, path: &BezPath, at: Point) -> Tip {
        let segments: Vec<PathSeg> = path.segments().collect();
        let before = segments
            .iter()
            .cycle()
            .skip(segments.len().saturating_sub(1));
        let mut pairs = before.zip(&segments);
        let corner = pairs.find(|(_, after)| after.start() == at);
        let inwards = corner.map(|(before, after)| corners::inwards(&self.residual, before, after));
        Tip {
            at,
            inwards: inwards.unwrap_or_default(),
        }
    }
}

/// The paths with kept corners where their tips are drawn.
#[must_use]
pub fn drawn_in(paths: &[BezPath], doubts: &[Doubts]) -> Vec<BezPath> {
    let draw = |(path, doubts): (&BezPath, &Doubts)| {
        let mut segments: Vec<PathSeg> = path.segments().collect();
        for tip in &doubts.kept {
            let off = |i: &usize| segments[*i].start().distance(tip.at);
            let nearest = (0..segments.len()).min_by(|a, b| off(a).total_cmp(&off(b)));
            let Some(i) = nearest.filter(|i| off(i) <= SAME_PX) else {
                continue;
            };
            let last = (i + segments.len() - 1) % segments.len();
            segments[last] = end_moved(segments[last], tip.inwards);
            segments[i] = end_moved(segments[i].reverse(), tip.inwards).reverse();
        }
        closed(segments)
    };
    paths.iter().zip(doubts).map(draw).collect()
}

/// The segment with its end, and the handle there, moved.
fn end_moved(segment: PathSeg, by: Vec2) -> PathSeg {
    match segment {
        PathSeg::Line(mut line) => {
            line.p1 += by;
            PathSeg::Line(line)
        }
        PathSeg::Quad(mut quad) => {
            quad.p2 += by;
            PathSeg::Quad(quad)
        }
        PathSeg::Cubic(mut cubic) => {
            cubic.p2 += by;
            cubic.p3 += by;
            PathSeg::Cubic(cubic)
        }
    }
}

fn closed(segments: Vec<PathSeg>) -> BezPath {
    let mut path = BezPath::from_path_segments(segments.into_iter());
    path.close_path();
    path
}

/// The segments of a path.
fn cubics(path: &BezPath) -> Vec<CubicBez> {
    path.segments().map(|s| s.to_cubic()).collect()
}

fn polygons(paths: &[BezPath]) -> Vec<Vec<Point>> {
    paths.iter().map(|p| polygon(p, CHORD_PX)).collect()
}

/// A closed path as chords that leave it by no more than `tolerance_px`.
pub(super) fn polygon(path: &BezPath, tolerance_px: f64) -> Vec<Point> {
    let mut out = Vec::new();
    flatten(path, tolerance_px, |el| match el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => out.push(p),
        _ => {}
    });
    out
}
