//! Cubic spline with point and interval tension through knots that are inserted by chance.
//!
//! ```text
//! Source   [rasheed05 sec. 3.1, eq. 3.1-3.25; sec. 4.2-4.3, alg. 4.1-4.6]
//! Solves   c_{i-1} M_{i-1} + (nu_i / 2 + 2 c_{i-1} + 2 c_i) M_i + c_i M_{i+1} = 3 c_i D_i + 3 c_{i-1} D_{i-1}
//! Takes    n >= 3 points, px, y up; shorter spans give their polygon
//! Gives    a cubic between two knots, exactly the spline; ends exact; every knot is a point of the span
//! Symbols  nu -> point_tension, omega -> interval_tension, epsilon -> tolerance_px, h -> lengths, D -> slopes
//! Departs  eq. 3.25's factor 2 (see `tension`); h is the way along the contour in mean pieces; nu counts
//!          (1/h before + 1/h after) / 2, its unit at equal knots; the weights of eq. 4.21 are exponents, since
//!          as factors they cancel; insertion ends when the tolerance is met (`stop = "chance"`: as printed)
//! Cost     O(k) a round for k knots, about log k rounds      Fails  FitError::Option for nu <= -4 omega
//! ```

pub mod knots;
pub mod tension;

use super::path::{both_ways, distinct, judged, path_of, polygon};
use super::{FitError, Fitter};
use crate::numeric::turns::{Ends, Walk};
use crate::types::{Fitted, Span};
use knots::{Insertion, Rule, Stop, insert};
use kurbo::{CubicBez, Point, Vec2};
use serde::{Deserialize, Serialize};
use tension::{End, Tension, cubics, tangents};

/// Options of the tension spline fitter. α and β are none of them: in the interpolant form they move the
/// control points and not the curve.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Gc2 {
    /// How knots are chosen.
    pub insertion: Insertion,
    /// When insertion ends.
    pub stop: Stop,
    /// Seed of the chance: the same seed gives the same curve.
    pub seed: u64,
    /// ν at every knot: above 0 the curve tightens there, down to -4 ω it loosens.
    pub point_tension: f64,
    /// ω of every interval, against the point tension.
    pub interval_tension: f64,
    /// End conditions of open spans; rings are periodic.
    pub end: EndRule,
}

/// End conditions of an open span.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum EndRule {
    /// The contour's own direction at its ends (type 1).
    Derivative,
    /// No bend at the ends (type 2).
    Natural,
}

impl Default for Gc2 {
    fn default() -> Self {
        Self {
            insertion: Insertion::Fuzzy,
            stop: Stop::Tolerance,
            seed: 1,
            point_tension: 0.0,
            interval_tension: 1.0,
            end: EndRule::Derivative,
        }
    }
}

impl Fitter for Gc2 {
    fn check(&self) -> Result<(), FitError> {
        let wrong = |option, value: f64, range| FitError::option(("gc2", option), value, range);
        let omega = self.interval_tension;
        if !(omega.is_finite() && omega > 0.0) {
            return Err(wrong("interval_tension", omega, "it must be above 0"));
        }
        let nu = self.point_tension;
        if !(nu.is_finite() && nu > -4.0 * omega) {
            let range = "it must be above -4 times the interval tension, or the curve bulges";
            return Err(wrong("point_tension", nu, range));
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

impl Gc2 {
    fn curve(&self, task: &Task<'_>, knots: &[usize]) -> Option<Vec<CubicBez>> {
        let points = task.at(knots);
        let lengths = task.lengths(knots);
        let m = lengths.len();
        let unit = |i: usize| {
            let inverse =
                |j: Option<usize>| j.and_then(|j| lengths.get(j)).map_or(0.0, |h| 1.0 / h);
            let before = if task.ends == Ends::Closed {
                Some((i + m - 1) % m)
            } else {
                i.checked_sub(1)
            };
            f64::midpoint(inverse(before), inverse(Some(i)))
        };
        let tension = Tension {
            point: (0..points.len())
                .map(|i| self.point_tension * unit(i))
                .collect(),
            interval: vec![self.interval_tension; m],
            lengths,
        };
        let end = match (task.ends, self.end) {
            (Ends::Closed, _) => End::Periodic,
            (_, EndRule::Natural) => End::Natural,
            (_, EndRule::Derivative) => {
                let (a, b) = task.directions();
                let mean = task.walk.total() / m as f64;
                End::Derivative(a * mean, b * mean)
            }
        };
        let tangents = tangents(&points, &tension, end)?;
        Some(cubics(&points, &tangents, &tension.lengths))
    }
}

/// A span to put knots into.
pub(in crate::fit) struct Task<'a> {
    pub points: &'a [Point],
    pub ends: Ends,
    pub walk: Walk<'a>,
    /// How far from an end its direction is taken, px.
    reach: f64,
}

/// Where the direction at an end is taken, in tolerances: two steps of five.
const REACH: f64 = 5.0;

impl Task<'_> {
    pub(in crate::fit) fn at(&self, knots: &[usize]) -> Vec<Point> {
        knots.iter().map(|&k| self.points[k]).collect()
    }

    /// The way from knot to knot, in mean pieces.
    pub(in crate::fit) fn lengths(&self, knots: &[usize]) -> Vec<f64> {
        let s = self.walk.lengths();
        let total = self.walk.total();
        let around = (self.ends == Ends::Closed)
            .then(|| knots.first().map(|&k| s[k] + total))
            .flatten();
        let places: Vec<f64> = knots.iter().map(|&k| s[k]).chain(around).collect();
        let pieces = places.len().saturating_sub(1);
        let mean = total / pieces.max(1) as f64;
        places.windows(2).map(|w| (w[1] - w[0]) / mean).collect()
    }

    /// Directions at both ends, a pixel's way long, by eq. 3.106-3.107 on the contour.
    pub(in crate::fit) fn directions(&self) -> (Vec2, Vec2) {
        let total = self.walk.total();
        let r = self.reach.min(total / 2.0);
        let one = |s: f64, r: f64| {
            let p = self.walk.at(s);
            let (near, far) = (self.walk.at(s + r) - p, self.walk.at(s + 2.0 * r) - p);
            (near * 2.0 - far / 2.0) / r
        };
        (one(0.0, r), one(total, -r))
    }
}

/// Inserts knots into a span and judges the curve; what cannot be drawn gives its polygon.
pub(in crate::fit) fn through_knots(
    span: Span<'_>,
    rule: Rule,
    curve: impl Fn(&Task<'_>, &[usize]) -> Option<Vec<CubicBez>>,
) -> Result<Fitted, FitError> {
    both_ways(span, |span| {
        let (points, ends) = distinct(span);
        if points.len() < if span.is_ring() { 5 } else { 3 } {
            return Ok(polygon(span));
        }
        let task = Task {
            points: &points,
            ends,
            walk: Walk::new(&points, ends),
            reach: REACH * rule.epsilon,
        };
        let inserted = insert(&task, rule, |knots| curve(&task, knots));
        let fitted = inserted.and_then(|i| {
            let parameters = 2 * i.knots.len();
            judged(span, path_of(&i.cubics, span), (rule.epsilon, parameters))
        });
        Ok(fitted.unwrap_or_else(|| polygon(span)))
    })
}
