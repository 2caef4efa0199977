//! The generic cubic spline with point and interval tension, through its points.
//!
//! ```text
//! c_{i-1} M_{i-1} + (nu_i / 2 + 2 c_{i-1} + 2 c_i) M_i + c_i M_{i+1} = 3 c_i D_i + 3 c_{i-1} D_{i-1}
//! ```
//!
//! for its tangents M, with c = ω / h and D the slopes between the points [rasheed05 eq. 3.1, 3.24];
//! eq. 3.25's second factor 2 is a misprint. Bézier, Ball and Timmer points (α = β = 3, 2, 4) are three
//! ways to write the same cubic.

use crate::numeric::banded::Tridiagonal;
use kurbo::{CubicBez, Point, Vec2};

/// The shape of a spline besides its points: a value a knot, a value an interval.
#[derive(Debug, Clone, PartialEq)]
pub struct Tension {
    /// Interval lengths h, by the parameter; positive.
    pub lengths: Vec<f64>,
    /// Point tension ν: at 0 the curve is smooth in its second derivative, large values tighten it there.
    pub point: Vec<f64>,
    /// Interval tension ω: positive; large values tighten the curve on that interval.
    pub interval: Vec<f64>,
}

/// End conditions [rasheed05 sec. 3.1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// Type 1: these derivatives by the parameter.
    Derivative(Vec2, Vec2),
    /// Type 2: no second derivative.
    Natural,
    /// Type 3: a ring, with an interval from the last point to the first.
    Periodic,
}

impl Tension {
    /// `points` knots h = 1 apart without tension; a ring has as many intervals as points.
    #[must_use]
    pub fn none(points: usize, end: End) -> Self {
        let intervals = points - usize::from(end != End::Periodic && points > 0);
        Self {
            lengths: vec![1.0; intervals],
            point: vec![0.0; points],
            interval: vec![1.0; intervals],
        }
    }

    /// c of interval `i`, cyclic.
    fn c(&self, i: usize) -> f64 {
        let i = i % self.lengths.len();
        self.interval[i] / self.lengths[i]
    }
}

/// The derivatives M by the parameter at every point; `None` when the system has no solution or the
/// lists do not fit each other.
#[must_use]
pub fn tangents(points: &[Point], tension: &Tension, end: End) -> Option<Vec<Vec2>> {
    let n = points.len();
    let ring = end == End::Periodic;
    let intervals = if ring { n } else { n.checked_sub(1)? };
    if intervals == 0
        || tension.lengths.len() != intervals
        || tension.interval.len() != intervals
        || tension.point.len() != n
    {
        return None;
    }
    let slope = |i: usize| {
        let i = i % intervals;
        (points[(i + 1) % n] - points[i]) / tension.lengths[i]
    };
    let mut matrix = Tridiagonal::default();
    let mut right = Vec::with_capacity(n);
    for i in 0..n {
        let (first, last) = (i == 0 && !ring, i + 1 == n && !ring);
        let before = if first {
            0.0
        } else {
            tension.c(i + intervals - 1)
        };
        let after = if last { 0.0 } else { tension.c(i) };
        match end {
            End::Derivative(m, _) if first => {
                matrix.push(0.0, 1.0, 0.0);
                right.push(m);
            }
            End::Derivative(_, m) if last => {
                matrix.push(0.0, 1.0, 0.0);
                right.push(m);
            }
            _ => {
                // eq. 3.1; with one side only it is eq. 3.3, and on a ring eq. 3.4
                let own = tension.point[i] / 2.0 + 2.0 * before + 2.0 * after;
                matrix.push(before, own, after);
                let a = if first {
                    Vec2::ZERO
                } else {
                    slope(i + intervals - 1) * before
                };
                let b = if last { Vec2::ZERO } else { slope(i) * after };
                right.push((a + b) * 3.0);
            }
        }
    }
    if ring {
        matrix.solve_ring(&right)
    } else {
        matrix.solve(&right)
    }
}

/// The cubics through the points with these derivatives.
#[must_use]
pub fn cubics(points: &[Point], m: &[Vec2], lengths: &[f64]) -> Vec<CubicBez> {
    let n = points.len();
    let one = |(i, h): (usize, &f64)| {
        let (p, q, third) = (points[i], points[(i + 1) % n], h / 3.0);
        CubicBez::new(p, p + m[i] * third, q - m[(i + 1) % n] * third, q)
    };
    lengths.iter().enumerate().map(one).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{ParamCurve, ParamCurveDeriv};

    fn points() -> Vec<Point> {
        [(0.0, 0.0), (4.0, 1.0), (6.0, 6.0), (1.0, 8.0), (-3.0, 4.0)]
            .map(Point::from)
            .to_vec()
    }

    #[test]
    fn the_second_derivative_jumps_by_the_tension() {
        // eq. 3.14: ω_i P'' after = ν_i P' + ω_{i-1} P'' before
        let p = points();
        for end in [
            End::Natural,
            End::Periodic,
            End::Derivative(Vec2::new(3.0, 0.0), Vec2::new(0.0, -2.0)),
        ] {
            let mut t = Tension::none(5, end);
            for (i, h) in t.lengths.iter_mut().enumerate() {
                *h = 1.0 + 0.3 * i as f64;
            }
            t.point[2] = 7.0;
            t.interval[1] = 5.0;
            let m = tangents(&p, &t, end).unwrap();
            let c = cubics(&p, &m, &t.lengths);
            for i in 1..c.len() {
                let (a, b) = (c[i - 1], c[i]);
                let (ha, hb) = (t.lengths[i - 1], t.lengths[i]);
                let before = a.deriv().deriv().eval(1.0).to_vec2() / (ha * ha);
                let after = b.deriv().deriv().eval(0.0).to_vec2() / (hb * hb);
                let jump = after * t.interval[i] - m[i] * t.point[i] - before * t.interval[i - 1];
                assert!(jump.hypot() < 1e-9, "{end:?} at {i}: {jump:?}");
            }
            if end == End::Natural {
                assert!(c[0].deriv().deriv().eval(0.0).to_vec2().hypot() < 1e-9);
            }
        }
    }

    #[test]
    fn tension_tightens() {
        let p = points();
        let length = |point: f64, interval: f64| -> f64 {
            let mut t = Tension::none(5, End::Periodic);
            t.point.fill(point);
            t.interval[1] = interval;
            let m = tangents(&p, &t, End::Periodic).unwrap();
            cubics(&p, &m, &t.lengths)
                .iter()
                .map(|c| kurbo::Shape::perimeter(c, 1e-6))
                .sum()
        };
        let polygon: f64 = (0..5).map(|i| p[i].distance(p[(i + 1) % 5])).sum();
        assert!(length(10.0, 1.0) < length(0.0, 1.0) && length(50.0, 1.0) < length(10.0, 1.0));
        assert!(
            (length(1e6, 1.0) / polygon - 1.0).abs() < 1e-3,
            "at last it is the polygon"
        );
    }
}
