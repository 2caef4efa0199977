//! Timmer's cubic through knots that are inserted by chance.
//!
//! ```text
//! Source   [rasheed05 sec. 3.3, eq. 3.85-3.133, alg. 3.1-3.3]
//! Solves   gc1: unit tangents by three points; gc2: w T_{i-1} + x T_i + y T_{i+1} = z (eq. 3.126-3.130);
//!          curvature: alpha_i from K_i(0) = K_{i-1}(1) (eq. 3.119-3.122)
//! Takes    n >= 3 points, px, y up; shorter spans give their polygon
//! Gives    a cubic between two knots, exactly the curve; ends exact
//! Symbols  alpha, beta -> alpha, beta; T_i -> tangents; P_{i,1}, P_{i,2} -> inner points
//! Departs  f_3 for the printed second f_4 (eq. 3.88); the sign of T_{i+1} / beta is minus (eq. 3.91); unit
//!          tangents are multiplied by the way between the knots, so that alpha = 4 means the same at any
//!          size; where algorithm 3.1 has no positive alpha, or one that would throw a loop, it takes 4 again
//! Cost     O(k) a round for k knots      Fails  never
//! ```

use super::gc2::knots::{Insertion, Rule, Stop};
use super::gc2::{Task, through_knots};
use super::{FitError, Fitter};
use crate::numeric::banded::Tridiagonal;
use crate::numeric::turns::Ends;
use crate::types::{Fitted, Span};
use kurbo::{CubicBez, Point, Vec2};
use serde::{Deserialize, Serialize};

/// Options of the Timmer fitter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Timmer {
    /// How the pieces meet.
    pub scheme: Scheme,
    /// α of every piece: larger values shorten the tangent at its start; 4 is the natural one. The
    /// curvature scheme takes it for the first piece only.
    pub alpha: f64,
    /// β of every piece, for the tangent at its end. The curvature scheme leaves it.
    pub beta: f64,
    /// How knots are chosen.
    pub insertion: Insertion,
    /// When insertion ends.
    pub stop: Stop,
    /// Seed of the chance.
    pub seed: u64,
}

/// How pieces meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Scheme {
    /// Tangents by three points (algorithm 3.2).
    Gc1,
    /// Equal second derivatives, by a tridiagonal system (algorithm 3.3).
    Gc2,
    /// Equal curvature, piece after piece (algorithm 3.1).
    Curvature,
}

impl Default for Timmer {
    fn default() -> Self {
        Self {
            scheme: Scheme::Gc1,
            alpha: NATURAL,
            beta: NATURAL,
            insertion: Insertion::Fuzzy,
            stop: Stop::Tolerance,
            seed: 1,
        }
    }
}

/// The α at which the tangent of a piece of straight line is the line.
const NATURAL: f64 = 4.0;
/// Least and largest α that algorithm 3.1 may find: a tangent three times the natural one, and a third of it.
const USABLE: (f64, f64) = (NATURAL / 3.0, NATURAL * 3.0);

impl Fitter for Timmer {
    fn check(&self) -> Result<(), FitError> {
        for (option, value) in [("alpha", self.alpha), ("beta", self.beta)] {
            if !(value.is_finite() && value > 0.0) {
                let range = "it must be above 0";
                return Err(FitError::option(("timmer", option), value, range));
            }
        }
        Ok(())
    }

    fn fit(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        self.check()?;
        let rule = Rule {
            insertion: self.insertion,
            stop: self.stop,
            seed: self.seed,
            epsilon: tolerance_px,
        };
        through_knots(span, rule, |task, knots| self.curve(task, knots))
    }
}

impl Timmer {
    fn curve(&self, task: &Task<'_>, knots: &[usize]) -> Option<Vec<CubicBez>> {
        let points = task.at(knots);
        let lengths = task.lengths(knots);
        let mean = task.walk.total() / lengths.len().max(1) as f64;
        let ways = lengths.iter().map(|h| h * mean).collect();
        let outer = (task.ends == Ends::Open).then(|| task.directions());
        let row = Row {
            points,
            ways,
            outer,
        };
        Some(match self.scheme {
            Scheme::Gc1 => row.pieces(&row.three_point(), |_| (self.alpha, self.beta)),
            Scheme::Gc2 => row.by_second_derivative(self.alpha, self.beta)?,
            Scheme::Curvature => row.by_curvature(self.alpha),
        })
    }
}

/// Knots with the way from each to the next, and the directions at the ends of an open row.
struct Row {
    points: Vec<Point>,
    ways: Vec<f64>,
    outer: Option<(Vec2, Vec2)>,
}

/// Timmer's inner points as those of Bézier: at an end the curve's slope is four times the way
/// to the one and three times that to the other.
fn bezier(p: Point, inner: (Point, Point), q: Point) -> CubicBez {
    let to = |end: Point, inner: Point| end + (inner - end) * (4.0 / 3.0);
    CubicBez::new(p, to(p, inner.0), to(q, inner.1), q)
}

impl Row {
    fn next(&self, i: usize) -> usize {
        (i + 1) % self.points.len()
    }

    /// Unit tangents by eq. 3.106-3.109; those at the ends of an open row come from the contour.
    fn three_point(&self) -> Vec<Vec2> {
        let n = self.points.len();
        let unit = |v: Vec2| {
            if v.hypot() > 0.0 {
                v.normalize()
            } else {
                Vec2::ZERO
            }
        };
        let tangent = |i: usize| match self.outer {
            Some((first, _)) if i == 0 => unit(first),
            Some((_, last)) if i + 1 == n => unit(last),
            _ => {
                let before = self.points[i] - self.points[(i + n - 1) % n];
                let after = self.points[self.next(i)] - self.points[i];
                let sum = after.hypot() + before.hypot();
                let a = if sum > 0.0 { after.hypot() / sum } else { 0.5 };
                unit(before * a + after * (1.0 - a))
            }
        };
        (0..n).map(tangent).collect()
    }

    /// Eq. 3.90-3.91 with unit tangents, of the length that `shape` tells for each piece.
    fn pieces(&self, tangents: &[Vec2], shape: impl Fn(usize) -> (f64, f64)) -> Vec<CubicBez> {
        let one = |(i, way): (usize, &f64)| {
            let (p, q) = (self.points[i], self.points[self.next(i)]);
            let (alpha, beta) = shape(i);
            let inner = (
                p + tangents[i] * (way / alpha),
                q - tangents[self.next(i)] * (way / beta),
            );
            bezier(p, inner, q)
        };
        self.ways.iter().enumerate().map(one).collect()
    }

    /// Eq. 3.126-3.130, divided by αβ. The tangents carry their lengths here.
    fn by_second_derivative(&self, alpha: f64, beta: f64) -> Option<Vec<CubicBez>> {
        let n = self.points.len();
        let mut matrix = Tridiagonal::default();
        let mut right = Vec::with_capacity(n);
        for i in 0..n {
            // eq. 3.131: the derivative at an end is 4 T / α
            match self.outer {
                Some((first, _)) if i == 0 => {
                    matrix.push(0.0, 1.0, 0.0);
                    right.push(first * (self.ways[0] * alpha / 4.0));
                }
                Some((_, last)) if i + 1 == n => {
                    matrix.push(0.0, 1.0, 0.0);
                    right.push(last * (self.ways[n - 2] * beta / 4.0));
                }
                _ => {
                    matrix.push(4.0 * beta, 8.0 * (alpha + beta), 4.0 * alpha);
                    let (before, after) = (self.points[(i + n - 1) % n], self.points[self.next(i)]);
                    right.push((after - before) * (3.0 * alpha * beta));
                }
            }
        }
        let t = if self.outer.is_none() {
            matrix.solve_ring(&right)
        } else {
            matrix.solve(&right)
        }?;
        let one = |i: usize| {
            let (p, q) = (self.points[i], self.points[self.next(i)]);
            bezier(p, (p + t[i] / alpha, q - t[self.next(i)] / beta), q)
        };
        Some((0..self.ways.len()).map(one).collect())
    }

    /// Algorithm 3.1: α of each piece so that its curvature begins where the last one ended.
    fn by_curvature(&self, first: f64) -> Vec<CubicBez> {
        let t = self.three_point();
        let mut shapes = Vec::with_capacity(self.ways.len());
        let mut bend: Option<f64> = None;
        for (i, &way) in self.ways.iter().enumerate() {
            let (a, b) = (t[i], t[self.next(i)]);
            let chord = self.points[self.next(i)] - self.points[i];
            let found = bend.and_then(|k| alpha_of(a, b, chord, k));
            let usable = found
                .map(|alpha| alpha * way)
                .filter(|s| (USABLE.0..=USABLE.1).contains(s));
            let shape = usable.unwrap_or(if i == 0 { first } else { NATURAL });
            shapes.push((shape, shape));
            // eq. 3.118
            let alpha = shape / way;
            bend = Some(alpha / 8.0 * (-4.0 * a.cross(b) + 3.0 * alpha * chord.cross(b)));
        }
        self.pieces(&t, |i| shapes[i])
    }
}

/// The positive α with K(0) = `bend` (eq. 3.120-3.121), the smaller of two.
fn alpha_of(t: Vec2, next: Vec2, chord: Vec2, bend: f64) -> Option<f64> {
    let a = 3.0 / 8.0 * t.cross(chord);
    let b = -t.cross(next) / 2.0;
    let c = -bend;
    if a == 0.0 {
        return (b != 0.0).then(|| -c / b).filter(|x| *x > 0.0);
    }
    let root = (b * b - 4.0 * a * c).sqrt();
    let both = [(-b - root) / (2.0 * a), (-b + root) / (2.0 * a)];
    both.into_iter().filter(|x| *x > 0.0).min_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{ParamCurve, ParamCurveCurvature, ParamCurveDeriv};

    fn row(ends: Ends) -> Row {
        let ring = ends == Ends::Closed;
        let at = |i: i32| {
            let a = f64::from(i) * 0.7;
            Point::new(30.0 * libm::cos(a), 22.0 * libm::sin(a))
        };
        let points: Vec<Point> = (0..9).map(at).collect();
        let n = points.len();
        let way = |i: usize| points[i].distance(points[(i + 1) % n]);
        let ways = (0..if ring { n } else { n - 1 }).map(way).collect();
        let outer = (!ring).then(|| (Vec2::new(0.0, 1.0), Vec2::new(0.9, 0.4)));
        Row {
            points,
            ways,
            outer,
        }
    }

    /// Eq. 3.85-3.89 walked directly.
    #[test]
    fn the_bezier_form_is_timmers_curve() {
        let (p, q) = (Point::new(0.0, 0.0), Point::new(8.0, 1.0));
        let inner = (Point::new(2.0, 5.0), Point::new(7.0, 4.0));
        let c = bezier(p, inner, q);
        for k in 0..=8 {
            let t = f64::from(k) / 8.0;
            let s = 1.0 - t;
            let f = [
                (1.0 - 2.0 * t) * s * s,
                4.0 * t * s * s,
                4.0 * t * t * s,
                (2.0 * t - 1.0) * t * t,
            ];
            let points = [p, inner.0, inner.1, q];
            let want = points
                .iter()
                .zip(f)
                .fold(Point::ORIGIN, |a, (p, w)| a + p.to_vec2() * w);
            assert!(c.eval(t).distance(want) < 1e-12, "at {t}");
        }
        // eq. 3.105: it passes through the middle of its inner points
        assert!(c.eval(0.5).distance(inner.0.midpoint(inner.1)) < 1e-12);
    }

    #[test]
    fn the_system_makes_second_derivatives_equal() {
        for (alpha, beta) in [(4.0, 4.0), (3.0, 5.0)] {
            for ends in [Ends::Closed, Ends::Open] {
                let c = row(ends).by_second_derivative(alpha, beta).unwrap();
                for w in c.windows(2) {
                    let a = w[0].deriv().deriv().eval(1.0);
                    let b = w[1].deriv().deriv().eval(0.0);
                    assert!(a.distance(b) < 1e-9, "{alpha} {beta} {ends:?}: {a:?} {b:?}");
                }
            }
        }
    }

    #[test]
    fn algorithm_3_1_makes_curvatures_equal() {
        let c = row(Ends::Open).by_curvature(NATURAL);
        let jump = |w: &[CubicBez]| (w[0].curvature(1.0) - w[1].curvature(0.0)).abs();
        let smooth = c.windows(2).filter(|w| jump(w) < 1e-9).count();
        assert!(smooth >= 3, "{smooth} of {} joins", c.len() - 1);
    }
}
