//! One global choice of nodes, then one refinement of all of them.
//! Solves   min ½ Σ (distance / σ)² + what the nodes and segments cost, over nodes, kinds, tangents and handles
//! Takes    a span of n >= 2 points, px, y up; a tolerance, px
//! Gives    lines and cubics, px; ends exact, smooth joins collinear, extrema upright
//! Departs  own method: candidates, dynamic programme, joint least squares
//! Cost     O(n)      Fails  never; a span shorter than a few pixels gives its own polygon

mod candidate;
mod choose;
mod contour;
mod cost;
mod found;
mod improve;
mod piece;
mod samples;
mod tidy;

use super::judge::{Judgement, is_within, judge_within, points_to_curve};
use super::path;
use super::{FitError, Fitter};
use crate::types::{Fitted, Span, Spans, Verdict};
use candidate::Candidate;
use found::{Draft, Found};
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

/// Searches with half the noise each in the spans that miss the tolerance, and without extrema at lines that lie
/// aslant.
const TIGHTER: usize = 2;
/// A contour's fit that lies so many times as far from the points as its spans' own, in the root mean square, has
/// lost its way.
const DERAILED: f64 = 1.4;
/// Of a longer span its first so many points are tried before all: where curves lose their way in a part, they do in
/// the whole, and noise is not searched again for each half, quarter and eighth.
const LONG: usize = 20_000;
/// With so few points their own polygon is better than curves that miss the tolerance.
const FEW: usize = 6;
/// And with so many halves are, which curves may meet.
const SHORT: usize = 16;
/// A curve further than this from its span, in tolerances, has lost its way.
const STRAY: f64 = 3.0;

/// Errors that are spread evenly reach so many of their standard deviations.
const EVEN: f64 = 1.732;

impl Fitter for Joint {
    fn check(&self) -> Result<(), FitError> {
        if !(0.0..=1.0).contains(&self.least_noise) {
            let range = "it must be 0 to 1";
            return Err(FitError::option(
                ("joint", "least_noise"),
                self.least_noise,
                range,
            ));
        }
        Ok(())
    }

    fn fit(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        self.check()?;
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

    fn contour(&self, spans: &Spans, tolerance_px: f64) -> Result<BezPath, FitError> {
        self.check()?;
        // points whose scatter they do not show themselves may lie as far off beside what is aimed at
        let scatter = spans.scatter_px();
        let least = self.least_noise * tolerance_px;
        let tolerance_px = tolerance_px + EVEN * scatter;
        let joint = Self {
            least_noise: least.max(scatter) / tolerance_px,
        };
        let whole = contour::welded(&joint, spans, tolerance_px);
        if let Some((path, Verdict::Met)) = whole {
            return Ok(path);
        }
        let apart = path::joined(&joint, spans, tolerance_px)?;
        let inner = |s: Span<'_>| {
            let within = s.points().iter().skip(1).rev().skip(1);
            within.copied().collect::<Vec<_>>()
        };
        let points: Vec<Point> = spans.iter().flat_map(inner).collect();
        let off = |path: &BezPath| points_to_curve(&points, path).rms_px;
        Ok(match whole {
            Some((path, _)) if off(&path) <= DERAILED * off(&apart) => path,
            _ => apart,
        })
    }
}

impl Joint {
    /// Fits a span in the order in which it stands.
    fn walk(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        let points = span.points();
        let length: f64 = points.windows(2).map(|w| w[0].distance(w[1])).sum();
        if points.len() < 3 || length <= 0.0 {
            return Ok(path::polygon(span));
        }
        let part = Span::Open(&points[..points.len().min(LONG)]);
        let lost = points.len() > LONG && self.pinned(part, tolerance_px).is_none();
        let whole = || self.pinned(span, tolerance_px);
        let pinned = if lost { None } else { whole() };
        let short = points.len() <= SHORT;
        let near = |worst: f64| worst.is_finite() && !(short && worst > tolerance_px);
        let Some((path, parameters, judged)) = pinned.filter(|p| near(p.2.points.max_px)) else {
            return if points.len() > FEW {
                self.halves(span, tolerance_px)
            } else {
                Ok(path::polygon(span))
            };
        };
        Ok(Fitted {
            path,
            verdict: if judged.max_px() <= tolerance_px {
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

    /// The path that ends where the span does, how many numbers of it were free, and how far it is off: the most
    /// refined one that keeps to the span, for a least-squares step can throw a handle far out.
    fn pinned(&self, span: Span<'_>, tolerance_px: f64) -> Option<(BezPath, usize, Judgement)> {
        let s = [Samples::new(span)];
        let mut found = self.search(&s, tolerance_px, |mut drafts| drafts.pop())?;
        let points = span.points();
        let ends = [points[0], points[points.len() - 1]];
        found::pin(&mut found.chain, ends);
        found::pin(&mut found.chosen, ends);
        let loose = found.chain.clone();
        found.settle(20, 1e-3);
        let mut stages = [found.chain, loose, found.chosen].into_iter();
        stages.find_map(|chain| {
            let path = chain.to_path();
            let judged = judge_within(span, &path, STRAY * tolerance_px)?;
            Some((path, found.refit.free(&chain), judged))
        })
    }

    /// The least structure that follows the points of some spans; `weld` makes one draft of theirs.
    fn search(
        &self,
        spans: &[Samples],
        tolerance_px: f64,
        weld: impl Fn(Vec<Draft>) -> Option<Draft>,
    ) -> Option<Found> {
        let least = self.least_noise * tolerance_px;
        let mut sigma: Vec<f64> = spans.iter().map(|s| s.sigma.max(least)).collect();
        let marks: Vec<Vec<Candidate>> = spans.iter().map(candidate::candidates).collect();
        let choose = |k: usize, sigma: f64| Draft::choose(&spans[k], &marks[k], sigma);
        let each = sigma.iter().enumerate();
        let mut drafts = each
            .map(|(k, &d)| choose(k, d))
            .collect::<Option<Vec<Draft>>>()?;
        let mut tighter = 0;
        loop {
            let mut draft = weld(drafts.clone())?;
            if tighter > 0 {
                found::turn(&mut draft.chain);
            }
            let found = draft.refine(least);
            let worst = found.worst();
            let missed = |&k: &usize| worst[k] > tolerance_px;
            let missed: Vec<usize> = (0..spans.len()).filter(missed).collect();
            if tighter == TIGHTER || missed.is_empty() {
                return Some(found);
            }
            tighter += 1;
            for k in missed {
                sigma[k] *= 0.5;
                drafts[k] = choose(k, sigma[k])?;
            }
        }
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

#[cfg(test)]
mod tests;
