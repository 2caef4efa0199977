//! The uniform cubic B-spline and the points of it that lie nearest to given ones.

use crate::numeric::cast::index;
use kurbo::{CubicBez, Point, Vec2};
use polycool::Quintic;

/// A uniform cubic B-spline with knots at the integers: piece i, for i ≤ u < i + 1, has the vertices
/// i … i + 3 [lumilios93 eq. 4-5].
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Spline {
    pub vertices: Vec<Point>,
    pub closed: bool,
}

/// A curve's point with its two derivatives.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place {
    pub p: Point,
    pub d: Vec2,
    pub dd: Vec2,
}

/// Newton's steps from a good guess; three are common.
const NEWTON: usize = 10;
/// Pieces to either side of the guess whose quintics are solved when Newton fails.
const AROUND: usize = 2;

/// Values, first and second derivatives of the four basis functions at t in 0…1.
pub(super) fn basis(t: f64) -> [[f64; 4]; 3] {
    let s = 1.0 - t;
    let (t2, s2) = (t * t, s * s);
    [
        [
            s * s2 / 6.0,
            (3.0 * t * t2 - 6.0 * t2 + 4.0) / 6.0,
            (3.0 * s * s2 - 6.0 * s2 + 4.0) / 6.0,
            t * t2 / 6.0,
        ],
        [-s2 / 2.0, 1.5 * t2 - 2.0 * t, 2.0 * s - 1.5 * s2, t2 / 2.0],
        [s, 3.0 * t - 2.0, 3.0 * s - 2.0, t],
    ]
}

impl Spline {
    pub(super) const fn pieces(&self) -> usize {
        self.vertices.len() - 3
    }

    /// The piece of `u` and where in it; closed splines go on around.
    pub(super) fn split(&self, u: f64) -> (usize, f64) {
        let n = self.pieces() as f64;
        let u = if self.closed {
            u.rem_euclid(n)
        } else {
            u.clamp(0.0, n)
        };
        let i = u.floor().clamp(0.0, n - 1.0);
        (index(i), u - i)
    }

    pub(super) fn place(&self, u: f64) -> Place {
        let (i, t) = self.split(u);
        let sums = basis(t).map(|b| {
            let terms = b.iter().zip(&self.vertices[i..i + 4]);
            terms.fold(Vec2::ZERO, |s, (b, v)| s + v.to_vec2() * *b)
        });
        Place {
            p: sums[0].to_point(),
            d: sums[1],
            dd: sums[2],
        }
    }

    /// The place nearest to `s`, sought from `guess` on: Newton, and where that fails or leaves the
    /// neighbourhood, all roots of the quintics of the pieces around [lumilios93 sec. 3].
    pub(super) fn foot(&self, s: Point, guess: f64) -> f64 {
        self.newton(s, guess)
            .unwrap_or_else(|| self.search(s, guess))
    }

    fn newton(&self, s: Point, guess: f64) -> Option<f64> {
        let mut u = guess;
        for _ in 0..NEWTON {
            let Place { p, d, dd } = self.place(u);
            let (slope, bend) = ((p - s).dot(d), d.hypot2() + (p - s).dot(dd));
            if bend <= 0.0 || !bend.is_finite() {
                return None;
            }
            let next = self.legal(u - slope / bend);
            if (next - guess).abs() > 1.0 {
                return None;
            }
            if (next - u).abs() < 1e-13 * (1.0 + u.abs()) {
                return Some(next);
            }
            u = next;
        }
        None
    }

    /// Open splines end.
    fn legal(&self, u: f64) -> f64 {
        if self.closed {
            u
        } else {
            u.clamp(0.0, self.pieces() as f64)
        }
    }

    fn search(&self, s: Point, guess: f64) -> f64 {
        let n = self.pieces();
        let (middle, _) = self.split(guess);
        let span = (2 * AROUND + 1).min(n);
        let first = if self.closed {
            middle + n - AROUND.min((n - 1) / 2)
        } else {
            middle.saturating_sub(AROUND).min(n - span)
        };
        let mut best = (f64::INFINITY, guess);
        for k in first..first + span {
            let i = k % n;
            let ends = [0.0, 1.0].into_iter();
            for t in self.quintic(s, i).into_iter().chain(ends) {
                let u = i as f64 + t;
                let d = self.place(u).p.distance_squared(s);
                if d < best.0 {
                    best = (d, u);
                }
            }
        }
        best.1
    }

    /// Roots of the distance's derivative on piece `i`: a quintic in t.
    fn quintic(&self, s: Point, i: usize) -> Vec<f64> {
        let c = self.powers(i);
        let mut q = [0.0; 6];
        for (axis, s) in [s.x, s.y].into_iter().enumerate() {
            let mut p = c.map(|v| if axis == 0 { v.x } else { v.y });
            p[0] -= s;
            let d = [p[1], 2.0 * p[2], 3.0 * p[3]];
            for (j, a) in p.iter().enumerate() {
                for (k, b) in d.iter().enumerate() {
                    q[j + k] += a * b;
                }
            }
        }
        Quintic::new(q)
            .roots_between(0.0, 1.0, 1e-12)
            .into_iter()
            .collect()
    }

    /// Coefficients of piece `i` by powers of t.
    fn powers(&self, i: usize) -> [Vec2; 4] {
        let v = [0, 1, 2, 3].map(|k| self.vertices[i + k].to_vec2());
        [
            (v[0] + 4.0 * v[1] + v[2]) / 6.0,
            (v[2] - v[0]) / 2.0,
            (v[0] - 2.0 * v[1] + v[2]) / 2.0,
            (v[3] - 3.0 * v[2] + 3.0 * v[1] - v[0]) / 6.0,
        ]
    }

    /// The pieces as Bézier curves, exactly.
    pub(super) fn cubics(&self) -> Vec<CubicBez> {
        let one = |w: &[Point]| {
            let (a, b) = (w[1].lerp(w[2], 1.0 / 3.0), w[1].lerp(w[2], 2.0 / 3.0));
            let start = w[0].lerp(w[1], 2.0 / 3.0).midpoint(a);
            let end = b.midpoint(w[2].lerp(w[3], 1.0 / 3.0));
            CubicBez::new(start, a, b, end)
        };
        self.vertices.windows(4).map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::ParamCurve;

    fn spline() -> Spline {
        let v = [
            (0.0, 0.0),
            (9.0, 1.0),
            (12.0, 8.0),
            (3.0, 14.0),
            (-4.0, 6.0),
            (2.0, -3.0),
        ];
        Spline {
            vertices: v.map(Point::from).to_vec(),
            closed: false,
        }
    }

    #[test]
    fn beziers_are_the_pieces() {
        let s = spline();
        for (i, c) in s.cubics().iter().enumerate() {
            for t in [0.0, 0.3, 0.99] {
                let place = s.place(i as f64 + t);
                assert!(place.p.distance(c.eval(t)) < 1e-12);
            }
        }
    }

    #[test]
    fn newton_and_the_quintics_find_the_same_foot() {
        let s = spline();
        for i in 0..60 {
            let u = f64::from(i) * 0.05;
            let Place { p, d, .. } = s.place(u);
            let beside = p + Vec2::new(-d.y, d.x) * 0.02;
            let guess = s.legal(u + 0.2);
            assert!((s.foot(beside, guess) - u).abs() < 1e-8, "at {u}");
            assert!((s.search(beside, guess) - u).abs() < 1e-6, "at {u}");
        }
    }
}
