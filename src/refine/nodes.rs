//! All nodes and handles of fitted paths against the grey picture, before and after wrong places are mended.
//!
//! Along each path the difference between the picture and its blurred fill says how far the edge should move; nodes,
//! directions and handles follow by least squares, joins kept. This is the gradient of the squared difference itself,
//! corners included, which the contour only knows from their sides.

use super::curves::{polygon, polygon_px};
use super::residual::Residual;
use crate::numeric::{
    cast::index,
    chain::Chain,
    joins::{DEPTH_PX, divide_at_extrema, level_ends, sharpen, soften_if_soft},
    many::{change, each},
    refit::{Foot, Refit, Sample, Scale, Stop},
};
use kurbo::{BezPath, ParamCurve, ParamCurveDeriv, Point, Vec2};
use std::collections::BTreeSet;

/// Comparisons with the picture.
const ROUNDS: usize = 3;
/// Steps of the least squares after each.
const STEPS: usize = 8;
/// Directions that differ by less are one, radians.
const SMOOTH: f64 = 0.0175;
/// Way along a path for one sample, px, and samples of the shortest curve.
const STEP_PX: f64 = 1.5;
const FEWEST: usize = 4;
/// Deviation of a sample, px, and the number of neighbours that share pixels with it.
const SIGMA_PX: f64 = 0.06;
const SHARED: f64 = 5.0;
/// No edge moves further in a step, px: the picture says little of what is further off.
const MOST_PX: f64 = 1.0;
/// How far a node may go in a step where the picture leaves it open, in shorter sides.
const FREEDOM: f64 = 0.03;
/// And no node further in all, px.
const REACH_PX: f64 = 2.0;
/// Those that would are held, up to so many times in a step: without them others may go far.
const HOLDS: usize = 4;

/// Chords of a path that moves at most, since each step draws them anew: a letter of 9000 px an em has some ten
/// thousand, a ring of noise half a million.
pub(super) const RING_CHORDS: usize = 100_000;

/// What becomes of corners that turn too little to be one once nodes have moved.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Soft {
    /// They stay: mending may yet find where their sides lead.
    Stay,
    /// They become smooth, and the nodes are fit once more.
    Smooth,
}

/// Paths moved to where their blurred fill is most like the picture; each stays as it was if none of its steps makes it
/// more like, or if it is one of noise. The residual is that of the paths, and in the end of the last step.
pub(super) fn settled(residual: &mut Residual<'_>, paths: &[BezPath], soft: Soft) -> Vec<BezPath> {
    let mut now = each(paths, |path| {
        let ring = fine(path);
        let drawn = !is_noise(&ring);
        let mut chain = drawn.then(|| Chain::from_path(path, SMOOTH)).flatten();
        if let Some(chain) = &mut chain {
            divide_at_extrema(chain, DEPTH_PX);
        }
        (chain, ring)
    });
    let start: Vec<Option<Chain>> = now.iter().map(|(chain, _)| chain.clone()).collect();
    let mut best = paths.to_vec();
    if start.iter().all(Option::is_none) {
        return best;
    }
    let mut least = each(&now, |(_, ring)| residual.along(ring));
    for _ in 0..ROUNDS {
        let mut pairs: Vec<_> = now.iter_mut().zip(&start).collect();
        change(&mut pairs, |((chain, ring), start)| {
            if let (Some(chain), Some(start)) = (chain, start) {
                step(chain, start, residual, soft);
                *ring = fine(&chain.to_path());
            }
        });
        residual.update(rings(&now));
        let off = each(&now, |(_, ring)| residual.along(ring));
        for (k, chains) in now.iter().map(|(c, _)| c).zip(&start).enumerate() {
            let (Some(chain), Some(start)) = chains else {
                continue;
            };
            let path = chain.to_path();
            if off[k] < least[k] && far(chain, start).next().is_none() && path.is_finite() {
                least[k] = off[k];
                best[k] = path;
            }
        }
    }
    best
}

/// Whether a path of such chords is no drawing's.
pub(super) const fn is_noise(chords: &[Point]) -> bool {
    chords.len() > RING_CHORDS
}

fn rings(all: &[(Option<Chain>, Vec<Point>)]) -> impl Iterator<Item = &[Point]> {
    all.iter().map(|(_, ring)| ring.as_slice())
}

/// A path as chords that cut off next to nothing, for the fill of chords is what is compared.
pub(super) fn fine(path: &BezPath) -> Vec<Point> {
    polygon(path, 0.001)
}

/// Moves a chain by what the differences along it say. Nodes that would go far from where they started are held.
fn step(chain: &mut Chain, start: &Chain, residual: &Residual<'_>, soft: Soft) {
    for i in 0..chain.nodes.len() {
        soften_if_soft(chain, i);
        sharpen(chain, i);
    }
    let (mut samples, mut feet) = (Vec::new(), Vec::new());
    for segment in 0..chain.kinds.len() {
        let c = chain.cubic(segment);
        let length = polygon_px(&c);
        let count = index((length / STEP_PX).ceil()).max(FEWEST);
        for k in 0..count {
            let t = (k as f64 + 0.5) / count as f64;
            let (p, along) = (c.eval(t), c.deriv().eval(t).to_vec2());
            if along.hypot() < 1e-9 {
                continue;
            }
            // ink lies to the left
            let outward = Vec2::new(along.y, -along.x).normalize();
            let shift = residual.shift(p).clamp(-MOST_PX, MOST_PX);
            samples.push(Sample {
                at: p + shift * outward,
                weight: length / (count as f64 * SHARED),
                sigma: SIGMA_PX,
            });
            feet.push(Foot { segment, t });
        }
    }
    let scale = Scale {
        sigma: SIGMA_PX,
        robust: f64::INFINITY,
        freedom: FREEDOM,
    };
    let stop = Stop {
        rounds: STEPS,
        gain: 0.01,
        enough: f64::INFINITY,
    };
    let mut held = BTreeSet::new();
    let mut moved = chain.clone();
    for _ in 0..=HOLDS {
        moved.clone_from(chain);
        let data = (samples.as_slice(), &mut feet.clone());
        Refit::holding(&held).run(&mut moved, data, scale, stop);
        let before = held.len();
        held.extend(far(&moved, start));
        if held.len() == before {
            break;
        }
    }
    if soft == Soft::Smooth {
        let mut softened = false;
        for i in 0..moved.nodes.len() {
            softened |= soften_if_soft(&mut moved, i);
        }
        if softened {
            Refit::holding(&held).run(&mut moved, (&samples, &mut feet), scale, stop);
        }
    }
    *chain = moved;
    level_ends(chain);
}

/// Nodes that went far from where they started.
fn far(chain: &Chain, start: &Chain) -> impl Iterator<Item = usize> {
    let pairs = chain.nodes.iter().zip(&start.nodes).enumerate();
    let far = pairs.filter(|(_, (a, b))| a.point.distance(b.point) > REACH_PX);
    far.map(|(i, _)| i)
}
