//! The error norm with its penalty, and their exact gradient.

use super::spline::{Place, Spline, basis};
use crate::numeric::minimise::Objective;
use kurbo::{Point, Vec2};

/// Weighted squared distances of the points to their feet, and the penalty on feet far apart.
#[derive(Debug)]
pub(super) struct Distances<'a> {
    points: &'a [Point],
    /// They sum to 1.
    weights: &'a [f64],
    penalty: Penalty,
    pieces: usize,
    closed: bool,
    current: State,
    trial: State,
}

/// A spline and the parameters of the points' feet on it.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub spline: Spline,
    pub feet: Vec<f64>,
}

/// α (du / β)^r on the feet of neighbouring points [lumilios93 eq. 12].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Penalty {
    /// α, px².
    pub weight: f64,
    /// β, knot intervals.
    pub width: f64,
    /// r, even.
    pub power: i32,
}

impl<'a> Distances<'a> {
    pub(super) fn new(
        points: &'a [Point],
        weights: &'a [f64],
        penalty: Penalty,
        start: State,
    ) -> Self {
        Self {
            points,
            weights,
            penalty,
            pieces: start.spline.pieces(),
            closed: start.spline.closed,
            trial: start.clone(),
            current: start,
        }
    }

    pub(super) fn into_state(self) -> State {
        self.current
    }

    /// The free vertices as one row of numbers: all of a ring, the inner ones of an open spline.
    pub(super) fn variables(spline: &Spline) -> Vec<f64> {
        let n = spline.pieces();
        let free = if spline.closed { 0..n } else { 1..n + 2 };
        spline.vertices[free]
            .iter()
            .flat_map(|v| [v.x, v.y])
            .collect()
    }

    /// The spline of these numbers. An open one passes through the outer points: the vertices before the
    /// first and after the last follow from that (eq. 20 solved for them).
    fn spline(&self, x: &[f64]) -> Spline {
        let free: Vec<Point> = x.chunks_exact(2).map(|c| Point::new(c[0], c[1])).collect();
        let vertices = if self.closed {
            free.iter().cycle().take(self.pieces + 3).copied().collect()
        } else {
            let (first, last) = (self.points[0], self.points[self.points.len() - 1]);
            let n = free.len();
            let outer = |q: Point, a: Point, b: Point| {
                (6.0 * q.to_vec2() - 4.0 * a.to_vec2() - b.to_vec2()).to_point()
            };
            let before = outer(first, free[0], free[1]);
            let after = outer(last, free[n - 1], free[n - 2]);
            std::iter::once(before).chain(free).chain([after]).collect()
        };
        Spline {
            vertices,
            closed: self.closed,
        }
    }

    /// Eq. 9-11: the foot moved by as much as the vertices' change tells.
    fn follow(&self, spline: &Spline, change: &Spline, i: usize) -> f64 {
        let u = self.current.feet[i];
        let Place { p, d, dd } = self.current.spline.place(u);
        let moved = change.place(u);
        let away = p - self.points[i];
        let bend = d.hypot2() + away.dot(dd);
        let du = -(moved.p.to_vec2().dot(d) + away.dot(moved.d)) / bend;
        let guess = if du.is_finite() {
            u + du.clamp(-1.0, 1.0)
        } else {
            u
        };
        spline.foot(self.points[i], guess)
    }

    /// From one foot to the next around the ring, in knot intervals.
    fn gap(&self, from: f64, to: f64) -> f64 {
        let n = self.pieces as f64;
        let d = to - from;
        if self.closed {
            d - n * (d / n).round()
        } else {
            d
        }
    }

    /// The penalty, and its derivative by every foot.
    fn penalise(&self, feet: &[f64]) -> (f64, Vec<f64>) {
        let Penalty {
            weight,
            width,
            power,
        } = self.penalty;
        let mut slopes = vec![0.0; feet.len()];
        let mut sum = 0.0;
        let m = feet.len();
        let start = usize::from(!self.closed);
        for i in start..m {
            let before = (i + m - 1) % m;
            let gap = self.gap(feet[before], feet[i]) / width;
            sum += weight * gap.powi(power);
            let slope = weight * f64::from(power) / width * gap.powi(power - 1);
            slopes[i] += slope;
            slopes[before] -= slope;
        }
        (sum, slopes)
    }

    /// Adds `slope` by vertex `j` to the gradient by the free numbers.
    fn add(&self, gradient: &mut [f64], j: usize, slope: Vec2) {
        let last = self.pieces + 2;
        let mut to = |k: usize, factor: f64| {
            gradient[2 * k] += factor * slope.x;
            gradient[2 * k + 1] += factor * slope.y;
        };
        match j {
            _ if self.closed => to(j % self.pieces, 1.0),
            0 => {
                to(0, -4.0);
                to(1, -1.0);
            }
            j if j == last => {
                to(last - 2, -4.0);
                to(last - 3, -1.0);
            }
            j => to(j - 1, 1.0),
        }
    }
}

impl Objective for Distances<'_> {
    fn value(&mut self, x: &[f64], gradient: &mut [f64]) -> f64 {
        gradient.fill(0.0);
        let spline = self.spline(x);
        let moved = spline.vertices.iter().zip(&self.current.spline.vertices);
        let change = Spline {
            vertices: moved.map(|(a, b)| (*a - *b).to_point()).collect(),
            closed: self.closed,
        };
        let feet: Vec<f64> = (0..self.points.len())
            .map(|i| self.follow(&spline, &change, i))
            .collect();
        let (mut sum, slopes) = self.penalise(&feet);
        let end = self.pieces as f64;
        for (i, &u) in feet.iter().enumerate() {
            let Place { p, d, dd } = spline.place(u);
            let away = p - self.points[i];
            let weight = self.weights[i];
            sum += weight * away.hypot2();
            let (piece, t) = spline.split(u);
            let [b, b1, _] = basis(t);
            let bend = d.hypot2() + away.dot(dd);
            let held = !self.closed && (u <= 0.0 || u >= end);
            // eq. 9: how the foot moves with a vertex, for the penalty only (eq. 17)
            let drag = if held || bend <= 0.0 {
                0.0
            } else {
                -slopes[i] / bend
            };
            for k in 0..4 {
                let slope = away * (2.0 * weight * b[k]) + (d * b[k] + away * b1[k]) * drag;
                self.add(gradient, piece + k, slope);
            }
        }
        self.trial = State { spline, feet };
        sum
    }

    fn accept(&mut self) {
        self.current.clone_from(&self.trial);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gradient_is_the_slope_of_the_value() {
        for closed in [true, false] {
            let n = 40;
            let round = if closed { n } else { n - 1 };
            let at = |i: i32| {
                let a = f64::from(i) / f64::from(round) * std::f64::consts::TAU * 0.99;
                Point::new(
                    30.0 * libm::cos(a),
                    20.0 * libm::sin(a) + 3.0 * libm::cos(3.0 * a),
                )
            };
            let points: Vec<Point> = (0..n).map(at).collect();
            let weights = vec![1.0 / 40.0; 40];
            let vertices: Vec<Point> = if closed {
                (0..11)
                    .map(|i| (at((i % 8) * 5).to_vec2() * 1.07).to_point())
                    .collect()
            } else {
                (0..11).map(|i| at(i * 5 - 5)).collect()
            };
            let spline = Spline { vertices, closed };
            let feet = (0..n)
                .map(|i| spline.foot(at(i), f64::from(i) / f64::from(n) * 8.0))
                .collect();
            let penalty = Penalty {
                weight: 1.0,
                width: 0.3,
                power: 10,
            };
            let mut x = Distances::variables(&spline);
            let mut f = Distances::new(&points, &weights, penalty, State { spline, feet });
            let mut gradient = vec![0.0; x.len()];
            f.value(&x, &mut gradient);
            f.accept();
            let mut unused = vec![0.0; x.len()];
            for j in 0..x.len() {
                let h = 1e-5;
                x[j] += h;
                let up = f.value(&x, &mut unused);
                x[j] -= 2.0 * h;
                let down = f.value(&x, &mut unused);
                x[j] += h;
                let slope = (up - down) / (2.0 * h);
                assert!(
                    (slope - gradient[j]).abs() < 1e-5 * (1.0 + slope.abs()),
                    "{closed} {j}: {slope} {}",
                    gradient[j]
                );
            }
        }
    }
}
