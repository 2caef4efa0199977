//! Quadratics beside a sampled curve: feet and distances.

use super::curve::Curve;
use crate::numeric::cast::index;
use kurbo::{ParamCurve, Point, QuadBez};

/// A quadratic beside the curve: the sample where it ends, and its largest distance on the way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Followed {
    pub(super) at: f64,
    pub(super) worst: f64,
}

impl Curve {
    /// The foot of a point near sample `guess`: the sample as a fraction, and the signed distance, left positive.
    pub(super) fn foot(&self, q: Point, guess: f64) -> (f64, f64) {
        /// The curve may turn so far, radians, between the sample and the foot: its bend there is known.
        const TURN: f64 = 0.02;
        /// Samples between them at most.
        const NEAR: f64 = 8.0;
        let last = self.dots.len() - 1;
        let mut j = index(guess + 0.5).min(last);
        let per = 1.0 / self.step;
        for _ in 0..6 {
            let dot = &self.dots[j];
            let r = q - dot.p;
            let s = r.dot(dot.t);
            let along = s * per;
            let at = j as f64 + along;
            let straight = along.abs() <= NEAR && (s * dot.k).abs() <= TURN;
            if along.abs() <= 1.0 || (straight && at >= 0.0 && at <= last as f64) {
                return (at, dot.t.cross(r) - 0.5 * dot.k * s * s);
            }
            let next = if along >= 0.0 {
                (j + index(along + 0.5)).min(last)
            } else {
                j.saturating_sub(index(0.5 - along))
            };
            if next == j {
                break;
            }
            j = next;
        }
        // Beyond an end, or no foot found: the plain distance.
        let r = q - self.dots[j].p;
        let d = self.dots[j].t.cross(r);
        (j as f64, r.hypot() * if d < 0.0 { -1.0 } else { 1.0 })
    }

    /// Follows a quadratic from sample `from`; none if it strays farther than `limit` (units),
    /// turns back, or passes sample `until`.
    pub(super) fn follow(
        &self,
        quad: [Point; 3],
        from: f64,
        until: f64,
        limit: f64,
    ) -> Option<Followed> {
        let [a, c, b] = quad;
        // Between its chord and its legs, as a quadratic's arc does.
        let arc = (2.0 * a.distance(b) + c.distance(a) + b.distance(c)) / 3.0;
        let (end, d) = self.foot(b, from + arc / self.step);
        self.measure(quad, (from, (end, d)), until, limit)
    }

    /// Follows a quadratic whose end's foot is known.
    pub(super) fn measure(
        &self,
        [a, c, b]: [Point; 3],
        (from, (end, d)): (f64, (f64, f64)),
        until: f64,
        limit: f64,
    ) -> Option<Followed> {
        /// Places at which a quadratic is measured, as the weights of its legs there, in eighths, the
        /// likeliest failure first.
        const LOOK: [(usize, f64, f64); 7] = [
            (4, 0.75, 0.25),
            (2, 0.4375, 0.0625),
            (6, 0.9375, 0.5625),
            (1, 0.234_375, 0.015_625),
            (7, 0.984_375, 0.765_625),
            (3, 0.609_375, 0.140_625),
            (5, 0.859_375, 0.390_625),
        ];
        /// The curve's arc between two feet may be so many times the quadratic's mean.
        const DETOUR: f64 = 1.0;
        /// A foot may lie so many limits behind the start or beyond the end: what rounding moves it.
        const BEYOND: f64 = 0.6;
        let beyond = BEYOND * limit / self.step;
        if d.abs() > limit || end > until + beyond || end <= from {
            return None;
        }
        let (ca, bc) = (c - a, b - c);
        let legs = (ca.hypot(), bc.hypot());
        let chord = legs.0 + legs.1;
        let part = (end - from) / chord.max(1e-9);
        let (mut feet, mut off) = ([from; 9], [d; 9]);
        feet[8] = end;
        for (i, first, second) in LOOK {
            let q = a + ca * first + bc * second;
            // Arc length along a quadratic grows about as a blend of its two legs.
            let guess = from + part * (first * legs.0 + second * legs.1);
            let (at, d) = self.foot(q, guess);
            if d.abs() > limit || at < from - beyond || at > end + beyond {
                return None;
            }
            (feet[i], off[i]) = (at, d);
        }
        off[0] = self.foot(a, from).1;
        let worst = off
            .windows(3)
            .map(peak)
            .fold(off[0].abs().max(d.abs()), f64::max);
        if worst > limit {
            return None;
        }
        // A bend that the quadratic leaves out: the curve goes on much farther than the quadratic does.
        let longest = 0.25 * DETOUR * chord + 2.0 * limit;
        let skips = feet.windows(2).any(|f| (f[1] - f[0]) * self.step > longest);
        (!skips).then_some(Followed { at: end, worst })
    }

    /// The largest distance, units, either way, between a quadratic and the samples from `from` to `to`.
    pub(super) fn strays(&self, quad: QuadBez, from: f64, to: f64) -> f64 {
        /// How far the chords that stand for a quadratic may lie beside it, units.
        const SAG: f64 = 0.002;
        /// Fewest chords and most.
        const CHORDS: (f64, f64) = (16.0, 256.0);
        /// Chords that are looked at beyond the one nearest to the sample before.
        const AHEAD: usize = 12;
        let bend = ((quad.p0 - quad.p1) - (quad.p1 - quad.p2)).hypot();
        let chords = (0.25 * bend / SAG).sqrt().ceil();
        let chords = index(chords.clamp(CHORDS.0, CHORDS.1));
        let dots: Vec<Point> = (0..=chords)
            .map(|i| quad.eval(i as f64 / chords as f64))
            .collect();
        let (mut worst, mut at): (f64, f64) = (0.0, from);
        for pair in dots.windows(2) {
            at = self
                .foot(pair[1], at + pair[0].distance(pair[1]) / self.step)
                .0;
            let near = index(at).min(self.dots.len() - 1);
            let around = near.saturating_sub(2)..(near + 4).min(self.dots.len());
            let around: Vec<Point> = self.dots[around].iter().map(|o| o.p).collect();
            worst = worst.max(beside(pair[1], &around, 0, around.len()).1);
        }
        let mut k = 0;
        let last = self.dots.len() - 1;
        for o in &self.dots[index(from.ceil().max(0.0))..=index(to.max(0.0)).min(last)] {
            let (nearest, d) = beside(o.p, &dots, k, AHEAD);
            (k, worst) = (nearest, worst.max(d));
        }
        worst
    }
}

/// The largest of three even values, or of the parabola through them where that turns between them.
fn peak(v: &[f64]) -> f64 {
    let (slope, bend) = (0.5 * (v[2] - v[0]), v[2] - 2.0 * v[1] + v[0]);
    let beyond = if slope.abs() < bend.abs() {
        -0.5 * slope * slope / bend
    } else {
        0.0
    };
    v[1].abs().max((v[1] + beyond).abs())
}

/// The chord of a polygon nearest to a point, of `many` from `first` on, and its distance.
fn beside(q: Point, dots: &[Point], first: usize, many: usize) -> (usize, f64) {
    let off = |pair: &[Point]| {
        let (a, v) = (pair[0], pair[1] - pair[0]);
        let u = ((q - a).dot(v) / v.hypot2().max(1e-12)).clamp(0.0, 1.0);
        (a + v * u).distance_squared(q)
    };
    let chords = dots.windows(2).enumerate().skip(first).take(many);
    let nearest = chords
        .map(|(k, pair)| (k, off(pair)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.map_or((first, 0.0), |(k, d)| (k, d.sqrt()))
}
