//! The generic cubic spline by control points: a local support basis with the same tension.

use super::tension::Tension;
use kurbo::{CubicBez, Point, Vec2};

/// Values and slopes of the basis functions at one knot: of the function before it (λ), its own
/// (1 - λ - μ) and the one after (μ); slopes are λ̂ and μ̂ [rasheed05 eq. 3.53-3.65].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weights {
    /// λ
    pub lambda: f64,
    /// μ
    pub mu: f64,
    /// λ̂: the slope of the function before is -λ̂.
    pub lambda_slope: f64,
    /// μ̂: the slope of the function after.
    pub mu_slope: f64,
}

/// The weights at every knot of a ring of control points.
///
/// Eq. 3.60 prints a_{i+1} for a_{i-1} (the shift of 3.55), and eq. 3.62 has 2 for the 3 of 3.33.
#[must_use]
pub fn weights(tension: &Tension) -> Vec<Weights> {
    let n = tension.lengths.len();
    let h = |i: usize| tension.lengths[i % n];
    let a = |i: usize| h(i) / tension.interval[i % n];
    // eq. 3.64
    let d = |i: usize| {
        let (before, after) = (a(i + n - 1), a(i));
        after * before * tension.point[i % n] / 2.0 + after + before
    };
    // eq. 3.65; the indices count one ring more, so that nothing lies before the first
    let big = |i: usize| {
        let (a2, h2, h1) = (a(i - 2), h(i - 2), h(i - 1));
        h1 * d(i - 1) * d(i) + a(i) * (h1 + h(i)) * d(i - 1) + a2 * (h2 + h1) * d(i)
    };
    let at = |i: usize| {
        let i = i + 2 * n;
        let lambda_slope = 3.0 * a(i) * d(i - 1) / big(i);
        let mu_slope = 3.0 * a(i - 1) * d(i + 1) / big(i + 1);
        Weights {
            lambda: lambda_slope * h(i) / 3.0,
            mu: mu_slope * h(i - 1) / 3.0,
            lambda_slope,
            mu_slope,
        }
    };
    (0..n).map(at).collect()
}

/// The closed curve of a ring of control points, as cubics [rasheed05 eq. 3.80-3.84 with α = β = 3].
/// `tension` has as many intervals and knots as there are points; fewer than three points give nothing.
#[must_use]
pub fn closed_curve(control: &[Point], tension: &Tension) -> Vec<CubicBez> {
    let n = control.len();
    let sizes = [
        tension.lengths.len(),
        tension.point.len(),
        tension.interval.len(),
    ];
    if n < 3 || sizes != [n; 3] {
        return Vec::new();
    }
    let p = |i: usize| control[i % n].to_vec2();
    let knots: Vec<(Point, Vec2)> = weights(tension)
        .iter()
        .enumerate()
        .map(|(i, w)| {
            let (before, own, after) = (p(i + n - 1), p(i), p(i + 1));
            let f = before * w.lambda + own * (1.0 - w.lambda - w.mu) + after * w.mu;
            let m =
                after * w.mu_slope + own * (w.lambda_slope - w.mu_slope) - before * w.lambda_slope;
            (f.to_point(), m)
        })
        .collect();
    let piece = |i: usize| {
        let ((f, m), (g, k)) = (knots[i], knots[(i + 1) % n]);
        let third = tension.lengths[i] / 3.0;
        CubicBez::new(f, f + m * third, g - k * third, g)
    };
    (0..n).map(piece).collect()
}

#[cfg(test)]
mod tests {
    use super::super::tension::End;
    use super::*;
    use kurbo::{ParamCurve, ParamCurveDeriv};

    fn wild() -> Tension {
        Tension {
            lengths: vec![1.0, 2.0, 0.5, 1.5, 1.2, 0.8],
            point: vec![0.0, 3.0, 0.5, 10.0, 0.0, 1.0],
            interval: vec![1.0, 4.0, 1.0, 0.3, 1.0, 2.0],
        }
    }

    #[test]
    fn the_uniform_case_is_one_four_one() {
        for w in weights(&Tension::none(6, End::Periodic)) {
            assert!((w.lambda - 1.0 / 6.0).abs() < 1e-15 && (w.mu - 1.0 / 6.0).abs() < 1e-15);
            assert!((w.lambda_slope - 0.5).abs() < 1e-15 && (w.mu_slope - 0.5).abs() < 1e-15);
        }
    }

    #[test]
    fn the_functions_sum_to_one() {
        // eq. 3.77: control points that all coincide give that point; and no function is negative
        let here = Point::new(3.0, -2.0);
        for c in closed_curve(&[here; 6], &wild()) {
            assert!(
                [c.p0, c.p1, c.p2, c.p3]
                    .iter()
                    .all(|p| p.distance(here) < 1e-12)
            );
        }
        for i in 0..6 {
            let mut one = [Point::ORIGIN; 6];
            one[i].x = 1.0;
            let curve = closed_curve(&one, &wild());
            let values = curve
                .iter()
                .flat_map(|c| (0..=20).map(|t| c.eval(f64::from(t) / 20.0).x));
            assert!(
                values.into_iter().all(|v| (-1e-12..=1.0).contains(&v)),
                "function {i}"
            );
        }
    }

    #[test]
    fn the_curve_has_the_continuity_of_the_interpolant() {
        let t = wild();
        let at = |i: i32| Point::new(f64::from(i * i % 7), f64::from(i * 3 % 5));
        let control: Vec<Point> = (0..6).map(at).collect();
        let c = closed_curve(&control, &t);
        for i in 0..6 {
            let b = (i + 5) % 6;
            let (hb, ha) = (t.lengths[b], t.lengths[i]);
            let slope = c[i].deriv().eval(0.0).to_vec2() / ha;
            assert!((slope - c[b].deriv().eval(1.0).to_vec2() / hb).hypot() < 1e-10);
            let after = c[i].deriv().deriv().eval(0.0).to_vec2() / (ha * ha);
            let before = c[b].deriv().deriv().eval(1.0).to_vec2() / (hb * hb);
            let jump = after * t.interval[i] - slope * t.point[i] - before * t.interval[b];
            assert!(jump.hypot() < 1e-9, "at {i}: {jump:?}");
        }
    }
}
