//! One global choice of nodes, then one refinement of all of them.
//! Solves   min ½ Σ (distance / σ)² + what the nodes and segments cost, over nodes, kinds, tangents and handles
//! Takes    a span of n >= 2 points, px, y up; a tolerance, px
//! Gives    lines and cubics, px; ends exact, smooth joins collinear, extrema upright
//! Departs  own method: candidates, dynamic programme, joint least squares
//! Cost     O(n)      Fails  never; a span shorter than a few pixels gives its own polygon

mod candidate;
mod choose;
mod cost;
mod improve;
mod piece;
mod samples;

use super::judge::{judge, points_to_curve};
use super::{FitError, Fitter};
use crate::numeric::chain::{Chain, Join, Kind};
use crate::numeric::refit::{Refit, Sample, Scale};
use crate::types::{Fitted, Span, Verdict};
use kurbo::{BezPath, Point};
use samples::Samples;
use serde::{Deserialize, Serialize};

/// Options of the default fitter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Joint {
    /// Least standard deviation of the contour's points that is believed, as a part of the tolerance.
    pub least_noise: f64,
}

impl Default for Joint {
    fn default() -> Self {
        Self { least_noise: 0.12 }
    }
}

/// Searches with half the noise each, when the tolerance is missed.
const TIGHTER: usize = 2;
/// Distance, in sigmas, from which a point counts as an outlier.
const ROBUST: f64 = 4.0;
/// With so few points their own polygon is better than curves that miss the tolerance.
const FEW: usize = 16;
/// Points at each end of an open span that may be outliers: the blur of a corner.
const BLURRED: usize = 4;
/// A curve further than this from its span, in tolerances, has lost its way.
const STRAY: f64 = 8.0;
/// A line so near to an axis is meant to be parallel to it, radians.
const UPRIGHT: f64 = 0.006;

impl Fitter for Joint {
    fn fit(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        let (points, turned) = canonical(span);
        let canonical = match span {
            Span::Open(_) => Span::Open(&points),
            Span::Ring(_) => Span::Ring(&points),
        };
        let mut fitted = self.walk(canonical, tolerance_px)?;
        if turned {
            fitted.path = fitted.path.reverse_subpaths();
        }
        Ok(fitted)
    }
}

impl Joint {
    /// Fits a span in the order in which it stands.
    fn walk(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        let points = span.points();
        let length: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
        if points.len() < 3 || length <= 0.0 {
            return Ok(polygon(span));
        }
        let s = Samples::new(span);
        let blurred = if span.is_ring() { 0 } else { BLURRED };
        let inner = points.get(blurred..points.len().saturating_sub(blurred));
        let mut sigma = s.sigma.max(self.least_noise * tolerance_px);
        let keeps = |path: &BezPath| {
            let max = judge(span, path).max_px();
            path.is_finite() && max <= STRAY * tolerance_px
        };
        let mut path = Self::search(&s, sigma, keeps);
        for _ in 0..TIGHTER {
            let missed = inner.is_some_and(|p| points_to_curve(p, &path.0).max_px > tolerance_px);
            if !missed || sigma <= s.sigma {
                break;
            }
            sigma *= 0.5;
            let tighter = Self::search(&s, sigma.max(s.sigma), keeps);
            if tighter.0.elements().is_empty() {
                break;
            }
            path = tighter;
        }
        let (path, parameters) = path;
        if path.elements().is_empty() && points.len() > 2 * FEW {
            return self.halves(span, tolerance_px);
        }
        let worst = points_to_curve(points, &path).max_px;
        let hopeless = worst > tolerance_px && points.len() <= FEW;
        if !worst.is_finite() || !path.is_finite() || hopeless {
            return Ok(polygon(span));
        }
        Ok(Fitted {
            path,
            verdict: if worst <= tolerance_px {
                Verdict::Met
            } else {
                Verdict::Exhausted
            },
            parameters,
        })
    }

    /// A span that no chain keeps to, for rough paper or a brush's edge, is fit as two.
    fn halves(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        let mut points = span.points().to_vec();
        if span.is_ring() {
            points.extend(span.points().first().copied());
        }
        let (first, _) = points.split_at(points.len() / 2 + 1);
        let (_, last) = points.split_at(points.len() / 2);
        let first = self.fit(Span::Open(first), tolerance_px)?;
        let last = self.fit(Span::Open(last), tolerance_px)?;
        let mut path = first.path;
        path.extend(last.path.elements().iter().skip(1).copied());
        if span.is_ring() {
            path.close_path();
        }
        let met = first.verdict == Verdict::Met && last.verdict == Verdict::Met;
        Ok(Fitted {
            path,
            verdict: if met {
                Verdict::Met
            } else {
                Verdict::Exhausted
            },
            parameters: first.parameters + last.parameters,
        })
    }

    /// The path for points of deviation `sigma`, and how many numbers of it were free: the most refined one
    /// that `keeps` to its span, for a least-squares step can throw a handle far out.
    fn search(s: &Samples, sigma: f64, keeps: impl Fn(&BezPath) -> bool) -> (BezPath, usize) {
        let marks = candidate::candidates(s);
        let (mut chain, feet) = choose::choose(s, &marks, sigma);
        if chain.nodes.len() < 2 {
            return (BezPath::new(), 0);
        }
        upright(&mut chain);
        let weighed = |at, steps| Sample {
            at,
            weight: steps / cost::CORRELATION,
        };
        let all: Vec<Sample> = s.at.iter().map(|&at| weighed(at, 1.0)).collect();
        let (indices, points) = s.thinned();
        let few: Vec<Sample> = points
            .into_iter()
            .map(|(at, steps)| weighed(at, steps))
            .collect();
        let mut work = improve::Work {
            chain,
            feet: indices.iter().map(|&k| feet[k]).collect(),
            samples: &few,
            scale: Scale {
                sigma,
                robust: ROBUST,
            },
            refit: Refit::default(),
            stale: Vec::new(),
        };
        let chosen = work.chain.clone();
        work.loosen();
        work.settle(8, 0.1);
        work.improve();
        work.pin([s.at[0], s.at[s.len() - 1]]);
        // Each sample's foot is near that of its neighbour among the few.
        let near = |k: usize| indices.partition_point(|&i| i < k).min(indices.len() - 1);
        work.feet = (0..all.len()).map(|k| work.feet[near(k)]).collect();
        work.samples = &all;
        let improved = work.chain.clone();
        work.settle(20, 1e-3);
        let settled = work.chain.clone();
        let mut stages = [settled, improved, chosen].into_iter();
        let kept = stages.find(|chain| keeps(&chain.to_path()));
        kept.map_or_else(Default::default, |chain| {
            (chain.to_path(), work.refit.free(&chain))
        })
    }
}

/// The span's points in an order that does not depend on where and which way it was walked, and whether that
/// is the other way.
fn canonical(span: Span<'_>) -> (Vec<Point>, bool) {
    let mut p = span.points().to_vec();
    let before = |a: &Point, b: &Point| (a.x, a.y) < (b.x, b.y);
    if span.is_ring() {
        let least = (0..p.len()).reduce(|i, j| if before(&p[j], &p[i]) { j } else { i });
        p.rotate_left(least.unwrap_or(0));
        let turned = p.len() > 2 && before(&p[p.len() - 1], &p[1]);
        if turned {
            p[1..].reverse();
        }
        return (p, turned);
    }
    let unlike = p.iter().zip(p.iter().rev()).find(|(a, b)| a != b);
    let turned = unlike.is_some_and(|(a, b)| before(b, a));
    if turned {
        p.reverse();
    }
    (p, turned)
}

/// Lines that are all but upright or level become so, where their ends are free.
fn upright(chain: &mut Chain) {
    for i in 0..chain.kinds.len() {
        let (a, b) = chain.ends(i);
        let d = chain.direction(i);
        let axis = if d.y.abs() < UPRIGHT {
            Join::Horizontal
        } else {
            Join::Vertical
        };
        if chain.kinds[i] == Kind::Line && d.x.abs().min(d.y.abs()) < UPRIGHT {
            for n in [a, b] {
                if chain.nodes[n].join == Join::Smooth {
                    chain.nodes[n].join = axis;
                }
            }
        }
    }
}

/// The points themselves, joined by lines.
fn polygon(span: Span<'_>) -> Fitted {
    let mut path = BezPath::new();
    let mut last: Option<Point> = None;
    for &p in span.points() {
        match last {
            None => path.move_to(p),
            Some(_) => path.line_to(p),
        }
        last = Some(p);
    }
    if span.is_ring() {
        path.close_path();
    }
    Fitted {
        path,
        verdict: Verdict::Degenerate,
        parameters: 2 * span.points().len(),
    }
}

#[cfg(test)]
mod tests;
