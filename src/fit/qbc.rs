//! Cubic quasi-Bézier pieces, least squares along tangents.
//!
//! ```text
//! Source   [sohel sec. III.A, eq. 6-9]
//! Solves   min sum |Q(u_i) - p_i|^2 over the two handles' lengths, Q a QBC or QBC-n of degree 3
//! Takes    points of a span, px, y up; a tolerance, px
//! Gives    cubics within a twentieth of the tolerance of the pieces; ends exact, joins smooth
//! Symbols  p_0..p_3 -> `controls`, u -> `u`
//! Departs  the paper gives no fit: ends and tangents come from the points, a piece that misses the
//!          tolerance is cut where it misses most
//! Cost     O(n log n)    Fails  never; Verdict::Exhausted where the cubics swing out
//! ```

use super::path::{both_ways, distinct, judged, line, path_of, polygon};
use super::{FitError, Fitter};
use crate::numeric::{qbc::Pull, turns::Ends};
use crate::types::{Fitted, Span};
use kurbo::{CubicBez, Point, Vec2};
use serde::{Deserialize, Serialize};

/// Options of the QBC fitter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Qbc {
    /// Points on each side that a tangent is taken from.
    pub reach: usize,
}

/// Options of the QBC-n fitter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct QbcN {
    /// Points on each side that a tangent is taken from.
    pub reach: usize,
}

/// Wide enough to average a pixel's steps, narrow enough for small bends.
const REACH: usize = 5;

impl Default for Qbc {
    fn default() -> Self {
        Self { reach: REACH }
    }
}

impl Default for QbcN {
    fn default() -> Self {
        Self { reach: REACH }
    }
}

impl Fitter for Qbc {
    fn check(&self) -> Result<(), FitError> {
        check("qbc", self.reach)
    }

    fn fit(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        self.check()?;
        Task {
            pull: Pull::Qbc,
            reach: self.reach,
            tolerance: tolerance_px,
        }
        .fit(span)
    }
}

impl Fitter for QbcN {
    fn check(&self) -> Result<(), FitError> {
        check("qbc-n", self.reach)
    }

    fn fit(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        self.check()?;
        Task {
            pull: Pull::QbcN,
            reach: self.reach,
            tolerance: tolerance_px,
        }
        .fit(span)
    }
}

fn check(method: &'static str, reach: usize) -> Result<(), FitError> {
    if !(1..=1000).contains(&reach) {
        let range = "it must be 1 to 1000";
        return Err(FitError::option((method, "reach"), reach, range));
    }
    Ok(())
}

/// A fit in progress.
struct Task {
    pull: Pull,
    reach: usize,
    tolerance: f64,
}

impl Task {
    fn fit(&self, span: Span<'_>) -> Result<Fitted, FitError> {
        both_ways(span, |span| {
            Ok(self.curves(span).unwrap_or_else(|| polygon(span)))
        })
    }

    fn curves(&self, span: Span<'_>) -> Option<Fitted> {
        let (mut points, ends) = distinct(span);
        if ends == Ends::Closed {
            points.extend(points.first().copied());
        }
        if points.len() < 4 || span.points().iter().any(|p| !p.is_finite()) {
            return None;
        }
        let last = points.len() - 1;
        let seam = span.is_ring().then(|| {
            tangent(
                &points[1..=self.reach.min(last)],
                &points[last.saturating_sub(self.reach)..last],
            )
        });
        let mut out = Vec::new();
        let mut pieces = vec![(0, last)];
        let mut parameters = 0;
        while let Some((a, b)) = pieces.pop() {
            let ends = [
                self.direction(&points, a, seam),
                self.direction(&points, b, seam),
            ];
            match self.piece(&points[a..=b], ends) {
                Ok(cubics) => {
                    out.extend(cubics);
                    // Two lengths, and a point and a direction for the next piece to begin with.
                    parameters += 5;
                }
                Err(worst) => pieces.extend([(a + worst, b), (a, a + worst)]),
            }
        }
        judged(span, path_of(&out, span), (self.tolerance, parameters))
    }

    /// Unit direction of the points at `i`; `seam` is a ring's at its first point.
    fn direction(&self, points: &[Point], i: usize, seam: Option<Vec2>) -> Vec2 {
        let last = points.len() - 1;
        match seam {
            Some(seam) if i == 0 || i == last => seam,
            _ => {
                let k = self.reach.min(if i == 0 || i == last {
                    last
                } else {
                    i.min(last - i)
                });
                tangent(
                    &points[i..=(i + k).min(last)],
                    &points[i.saturating_sub(k)..=i],
                )
            }
        }
    }

    /// One quasi-Bézier curve as cubics, or where it has to be cut.
    fn piece(&self, points: &[Point], [t0, t1]: [Vec2; 2]) -> Result<Vec<CubicBez>, usize> {
        /// Rounds of parameters moved to the feet of their points.
        const ROUNDS: usize = 4;
        /// Part of the tolerance that the cubics may leave the piece by.
        const APART: f64 = 0.05;
        /// Part of the largest error that counts as much as it.
        const NEARLY: f64 = 0.8;
        let (p, q) = (points[0], points[points.len() - 1]);
        if points.len() < 3 {
            return Ok(vec![line(p, q)]);
        }
        let mut u = chords(points);
        let mut controls = [p, p, q, q];
        for _ in 0..ROUNDS {
            let [a, b] = self.handles(points, &u, [t0, t1]);
            controls = [p, p + t0 * a, q - t1 * b, q];
            for (u, at) in u.iter_mut().zip(points) {
                let (c, slope) = self.pull.eval(&controls, *u);
                let move_by = (*at - c).dot(slope) / slope.hypot2().max(1e-12);
                *u = (*u + move_by).clamp(0.0, 1.0);
            }
        }
        let off = |i: usize| {
            let at = |u: f64| self.pull.eval(&controls, u).0;
            // Between its points a sparse span binds the curve to its chords.
            let between = at(u[i - 1].midpoint(u[i])).distance(points[i - 1].midpoint(points[i]));
            at(u[i]).distance(points[i]).max(between)
        };
        let offs: Vec<f64> = (1..points.len()).map(off).collect();
        let most = offs.iter().copied().fold(0.0, f64::max);
        if most <= self.tolerance * (1.0 - APART) {
            return Ok(self.pull.cubics(&controls, APART * self.tolerance));
        }
        // Of the places nearly as bad, the one nearest the middle: turning the points changes none of it.
        let bad = (1..points.len() - 1).filter(|i| offs[i - 1] >= NEARLY * most);
        let middle = points.len() / 2;
        Err(bad.min_by_key(|i| i.abs_diff(middle)).unwrap_or(middle))
    }

    /// Lengths of the handles along both tangents, by normal equations; a third of the chord where they fail.
    fn handles(&self, points: &[Point], u: &[f64], [t0, t1]: [Vec2; 2]) -> [f64; 2] {
        let (p, q) = (points[0], points[points.len() - 1]);
        let (mut aa, mut ab, mut bb, mut ar, mut br) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for (&u, at) in u.iter().zip(points) {
            let unit = |i: usize| {
                std::array::from_fn::<Point, 4, _>(|j| {
                    Point::new(f64::from(i == j), f64::from(i + 1 == j))
                })
            };
            let (first, second) = (self.pull.eval(&unit(0), u).0, self.pull.eval(&unit(2), u).0);
            let [w0, w1, w2, w3] = [first.x, first.y, second.x, second.y];
            let rest = *at - (p.to_vec2() * (w0 + w1) + q.to_vec2() * (w2 + w3)).to_point();
            let (va, vb) = (t0 * w1, t1 * -w2);
            (aa, ab, bb) = (aa + va.hypot2(), ab + va.dot(vb), bb + vb.hypot2());
            (ar, br) = (ar + va.dot(rest), br + vb.dot(rest));
        }
        let chord = p.distance(q);
        let det = aa * bb - ab * ab;
        let both = [(ar * bb - br * ab) / det, (br * aa - ar * ab) / det];
        // Handles that point back or far away come from too few points.
        let fine = both
            .iter()
            .all(|h| h.is_finite() && *h > 1e-3 * chord && *h < 10.0 * chord.max(1.0));
        if fine { both } else { [chord / 3.0; 2] }
    }
}

/// Direction from the mean of the points before to the mean of those ahead.
fn tangent(ahead: &[Point], before: &[Point]) -> Vec2 {
    let mean = |p: &[Point]| {
        let (sum, n) = p
            .iter()
            .fold((Vec2::ZERO, 0.0), |(s, n), q| (s + q.to_vec2(), n + 1.0));
        sum / f64::max(n, 1.0)
    };
    let d = mean(ahead) - mean(before);
    if d.hypot() > 0.0 {
        d.normalize()
    } else {
        Vec2::new(1.0, 0.0)
    }
}

/// Parameters by the length of the chords, 0 to 1.
fn chords(points: &[Point]) -> Vec<f64> {
    let mut sum = 0.0;
    let mut out = vec![0.0];
    for pair in points.windows(2) {
        sum += pair[0].distance(pair[1]);
        out.push(sum);
    }
    out.iter().map(|s| s / sum.max(1e-12)).collect()
}
