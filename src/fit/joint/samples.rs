//! A span at even steps: directions, bends, and how much noise there is.

use crate::numeric::{
    cast::index,
    median::{NORMAL, middle},
};
use crate::types::Span;
use kurbo::{Point, Vec2};

/// A span has at least so many steps.
const STEPS: usize = 4;
/// Samples that one may stand for in a search.
const STRIDE: usize = 4;
/// And the turn that they may make together, radians.
const TURN: f64 = 0.2;
/// Samples on each side of a local parabola, in a span without noise.
const REACH: usize = 4;
/// And at most.
const REACH_MOST: usize = 9;

/// A span at even steps of arc length, with local parabolas.
#[derive(Debug, Clone)]
pub(super) struct Samples {
    /// Points; of an open span both ends are among them, of a ring the first is not repeated.
    pub(super) at: Vec<Point>,
    /// What each tells, of a measured one's: the way from a given end to the first point beside it is a guess.
    pub(super) weight: Vec<f64>,
    /// Whether it closes.
    pub(super) ring: bool,
    /// Arc length from one to the next, px.
    pub(super) step: f64,
    /// Standard deviation of the points along their normals, px.
    pub(super) sigma: f64,
    /// Distances of its points from parabolas through their neighbours, px: what `sigma` is told by.
    off: Vec<f64>,
    /// Samples on each side of a local parabola.
    pub(super) reach: usize,
    /// Unit direction at each.
    pub(super) heading: Vec<Vec2>,
    /// Curvature at each, 1/px.
    pub(super) bend: Vec<f64>,
}

impl Samples {
    /// Resamples a span of different points.
    pub(super) fn new(span: Span<'_>) -> Self {
        let mut s = Self::resampled(span);
        s.sigma = deviation(s.off.iter().copied());
        s.lean();
        s
    }

    /// A span's samples without what its noise tells.
    fn resampled(span: Span<'_>) -> Self {
        let (at, step) = resample(span);
        let weight = weights(span, &at, step);
        let mut s = Self {
            at,
            weight,
            ring: span.is_ring(),
            step,
            sigma: 0.0,
            off: Vec::new(),
            reach: REACH,
            heading: Vec::new(),
            bend: Vec::new(),
        };
        s.off = s.scatter();
        s
    }

    /// Spans of one contour: their noise is one, for a short one tells little of its own.
    pub(super) fn together(spans: &[Span<'_>]) -> Vec<Self> {
        let mut all: Vec<Self> = spans.iter().map(|s| Self::resampled(*s)).collect();
        let sigma = deviation(all.iter().flat_map(|s| s.off.iter().copied()));
        for s in &mut all {
            s.sigma = sigma;
            s.lean();
        }
        all
    }

    /// Directions and bends by parabolas that reach as far as the noise asks.
    fn lean(&mut self) {
        let s = self;
        s.heading.clear();
        s.bend.clear();
        // The variance of a parabola's bend falls with the fifth power of its reach.
        let wider = libm::pow((s.sigma / (0.02 * s.step)).max(1.0), 0.4) * REACH as f64;
        s.reach = (REACH..=REACH_MOST)
            .find(|&r| r as f64 >= wider)
            .unwrap_or(REACH_MOST);
        for k in 0..s.at.len() {
            let [_, d, dd] = s.parabola(k, s.reach, s.reach);
            let speed = d.hypot().max(1e-12);
            s.heading.push(d / speed);
            s.bend.push(d.cross(dd) / (speed * speed * speed));
        }
    }

    /// Number of samples.
    pub(super) const fn len(&self) -> usize {
        self.at.len()
    }

    /// Sample `k`, counted around a ring.
    pub(super) fn point(&self, k: usize) -> Point {
        // most stand before a ring's end, and a division takes its time
        self.at
            .get(k)
            .copied()
            .unwrap_or_else(|| self.at[k % self.at.len()])
    }

    /// Value, first and second derivative by arc length at sample `k` of the parabola through `behind`
    /// samples before it and `ahead` after it, as far as the span goes, by least squares.
    pub(super) fn parabola(&self, k: usize, behind: usize, ahead: usize) -> [Vec2; 3] {
        let n = self.at.len();
        let (lo, hi) = if self.ring {
            let most = (n - 1) / 2;
            (behind.min(most), ahead.min(most))
        } else {
            (behind.min(k), ahead.min(n - 1 - k))
        };
        let origin = self.at[k].to_vec2();
        let mut s = [0.0; 5];
        let mut m = [Vec2::ZERO; 3];
        // a ring goes on at its start
        let first = if k < lo { k + n - lo } else { k - lo };
        let beyond = (first + lo + hi + 1).saturating_sub(n);
        let mut x = -(lo as f64);
        for part in [first..first + lo + hi + 1 - beyond, 0..beyond] {
            for (p, w) in self.at[part.clone()].iter().zip(&self.weight[part]) {
                let q = *w * (p.to_vec2() - origin);
                let (x2, qx) = (w * x * x, q * x);
                s[0] += w;
                s[1] += w * x;
                s[2] += x2;
                s[3] += x2 * x;
                s[4] += x2 * x2;
                m[0] += q;
                m[1] += qx;
                m[2] += qx * x;
                x += 1.0;
            }
        }
        let [a, b, c] = solve3(&s, m).unwrap_or_else(|| {
            let d = self.point(k + n + hi) - self.point(k + n - lo);
            [Vec2::ZERO, d / (lo + hi).max(1) as f64, Vec2::ZERO]
        });
        [origin + a, b / self.step, 2.0 * c / (self.step * self.step)]
    }

    /// Fewer samples that tell nearly as much: indices, and smoothed points with the number of samples that each
    /// stands for. Where the curve bends all are kept.
    pub(super) fn thinned(&self) -> (Vec<usize>, Vec<(Point, f64)>) {
        let n = self.at.len();
        let mut indices = Vec::with_capacity(n / 2);
        let mut points = Vec::with_capacity(n / 2);
        let mut k = 0;
        while k < n {
            let turn = self.bend[k].abs() * self.step;
            let stride = (1..STRIDE)
                .find(|&m| (m + 1) as f64 * turn > TURN)
                .unwrap_or(STRIDE)
                .min(n - k);
            let mid = k + (stride - 1) / 2;
            let reach = stride / 2;
            let at = if reach == 0 {
                self.at[mid]
            } else {
                self.parabola(mid, reach, reach)[0].to_point()
            };
            indices.push(mid);
            points.push((at, self.weight[k..k + stride].iter().sum()));
            k += stride;
        }
        (indices, points)
    }

    /// Distances of the points from parabolas through their neighbours, along the normal, px; made larger by what
    /// a parabola follows its middle point.
    fn scatter(&self) -> Vec<f64> {
        let n = self.at.len();
        let (r, inner) = if self.ring {
            // a parabola is no part of a ring that turns by more than some 60° within it
            let r = (n / 12).clamp(2, REACH + 1);
            (r, 0..n)
        } else {
            let r = REACH + 1;
            (r, r..n.saturating_sub(r))
        };
        let m = r as f64;
        let leverage = 3.0 * (3.0 * m * m + 3.0 * m - 1.0)
            / ((2.0 * m - 1.0) * (2.0 * m + 1.0) * (2.0 * m + 3.0));
        let off = |k: usize| {
            let [p, d, _] = self.parabola(k, r, r);
            let normal = d.turn_90() / d.hypot().max(1e-12);
            (p - self.at[k].to_vec2()).dot(normal).abs() / (1.0 - leverage).sqrt()
        };
        inner.map(off).collect()
    }
}

/// Robust standard deviation of points that lie `off` from parabolas through their neighbours, px.
fn deviation(off: impl Iterator<Item = f64>) -> f64 {
    NORMAL * middle(off, f64::total_cmp).unwrap_or(0.0)
}

/// A parabola's coefficients from the power sums `s` and moments `m`.
fn solve3(s: &[f64; 5], m: [Vec2; 3]) -> Option<[Vec2; 3]> {
    let (a, b, c, d, e, f) = (s[0], s[1], s[2], s[2], s[3], s[4]);
    // Cofactors of the symmetric matrix [a b c; b d e; c e f].
    let (ca, cb, cc) = (d * f - e * e, c * e - b * f, b * e - c * d);
    let (cd, ce, cf) = (a * f - c * c, b * c - a * e, a * d - b * b);
    let det = a * ca + b * cb + c * cc;
    (det.abs() > 1e-9).then(|| {
        [
            (m[0] * ca + m[1] * cb + m[2] * cc) / det,
            (m[0] * cb + m[1] * cd + m[2] * ce) / det,
            (m[0] * cc + m[1] * ce + m[2] * cf) / det,
        ]
    })
}

/// A first or last edge this many times as long as the middling one holds no measured point.
const GAP: f64 = 1.6;
/// What a sample without measurement tells.
const GUESS: f64 = 0.02;

/// What samples tell: next to nothing on the way from a given end to the first point that was measured.
fn weights(span: Span<'_>, at: &[Point], step: f64) -> Vec<f64> {
    let mut out = vec![1.0; at.len()];
    let p = span.points();
    let edges: Vec<f64> = p.windows(2).map(|w| w[0].distance(w[1])).collect();
    if span.is_ring() || edges.len() < 3 {
        return out;
    }
    let (first, last) = (edges[0], edges[edges.len() - 1]);
    let usual = middle(edges, f64::total_cmp).unwrap_or(0.0);
    let guessed = |gap: f64| {
        if gap > GAP * usual {
            index((gap / step).ceil())
        } else {
            0
        }
    };
    let guess = |w: &mut f64| *w = GUESS;
    out.iter_mut().take(guessed(first)).for_each(guess);
    out.iter_mut().rev().take(guessed(last)).for_each(guess);
    out
}

fn resample(span: Span<'_>) -> (Vec<Point>, f64) {
    let p = span.points();
    let close = if span.is_ring() { p.first() } else { None };
    let ring: Vec<Point> = p.iter().chain(close).copied().collect();
    let total: f64 = ring.windows(2).map(|w| w[0].distance(w[1])).sum();
    // As many steps as the span has: lengths are then measured in the contour's own resolution.
    let count = (ring.len() - 1).max(STEPS);
    let step = total / count as f64;
    let mut out = Vec::with_capacity(count + 1);
    let mut before = 0.0;
    for w in ring.windows(2) {
        let d = w[0].distance(w[1]);
        while out.len() < count && (out.len() as f64) * step <= before + d {
            let t = ((out.len() as f64 * step - before) / d.max(1e-12)).clamp(0.0, 1.0);
            out.push(w[0].lerp(w[1], t));
        }
        before += d;
    }
    if !span.is_ring() {
        out.extend(p.last());
    }
    (out, step)
}
