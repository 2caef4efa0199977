//! Weighted least squares B-spline with a penalty on the second derivative.
//!
//! ```text
//! Source   [samavati98 sec. 4-5, eq. 15-40]
//! Solves   min sum |Q(U_i) - P_i|^2 + mu_X X''(U_i)^2 + mu_Y Y''(U_i)^2 over the vertices of Q
//! Takes    n >= 4 points, px, y up; shorter spans give their polygon
//! Gives    lines for straight runs and exact cubics (orders above 4: within 1/100 of the tolerance); ends exact
//! Symbols  mu_X, mu_Y -> mu_x, mu_y; k -> order; m + 1 -> number of vertices; V_j -> vertices; U_i -> at
//! Departs  eq. 17's second division by L is left out; the outer vertices are held at the span's ends; when
//!          m is not given it grows from eq. 39 by halves until the tolerance is met; a ring without straight
//!          runs is one periodic spline; straight runs must be straight over ten tolerances, not pointwise
//! Cost     O(n log n + n k^2 + m k^2)      Fails  never; Verdict::Exhausted when m reaches its limit
//! ```
//!
//! The penalty has the unit of the parameter, whose knots lie 1 apart: for a segment of length L in M
//! intervals, Q'' by parameter is (L/M)² times Q'' by length, so doubling the vertices divides the
//! penalty of the same curve by 16. Twelve points a vertex (eq. 39) keep L/M at about 12 px.

pub(in crate::fit) mod solve;

use super::judge::points_to_curve;
use super::path::{both_ways, distinct, judged, line, path_of, polygon};
use super::{FitError, Fitter};
use crate::numeric::bspline::Basis;
use crate::numeric::turns::{self, Straight, Walk};
use crate::types::{Fitted, Span};
use kurbo::{CubicBez, Point};
use serde::{Deserialize, Serialize};
use solve::{Ends, Problem};
use std::ops::RangeInclusive;

/// Most vertices of one segment [samavati98 sec. 5.1].
const MOST: usize = 500;
/// Points a vertex of the paper's rule [samavati98 eq. 39].
const POINTS_A_VERTEX: usize = 12;
/// Chords that tell a straight run, in tolerances: noise of the tolerance's size turns them by 8° at most.
const REACH: f64 = 10.0;
/// Shortest straight run, in tolerances: below this a spline's own straight part is as good.
const RUN: f64 = 40.0;

/// Options of the weighted least squares fitter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Wls {
    /// Order of the B-splines, k in the paper: degree + 1.
    pub order: usize,
    /// Index of the last vertex, m in the paper, for every segment. Not given: eq. 39, then more until the
    /// tolerance is met.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub m: Option<usize>,
    /// Weight of x'' against the error, by the paper's parameter.
    pub mu_x: f64,
    /// Weight of y'' against the error, by the paper's parameter.
    pub mu_y: f64,
    /// Largest turn within a straight run, ε in the paper, degrees; 0 finds none.
    pub straight_deg: f64,
    /// How a straight run and a spline meet.
    pub joint: Joint,
}

/// The two cures of a joint [samavati98 sec. 3 and 5.1].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Joint {
    /// The spline takes in three points of the line, and so comes into its direction.
    Include,
    /// Line and spline end freely and meet halfway: continuous in place only.
    Average,
}

/// Points of the line that [`Joint::Include`] hands to the spline: the paper's "few".
const FEW: usize = 3;

impl Default for Wls {
    fn default() -> Self {
        Self {
            order: 4,
            m: None,
            mu_x: 1e-3,
            mu_y: 1e-3,
            straight_deg: 3.0,
            joint: Joint::Include,
        }
    }
}

/// A part of a span between two segmentation points: indices of its first and last point.
#[derive(Debug, Clone, PartialEq)]
enum Piece {
    Line(RangeInclusive<usize>),
    Spline(RangeInclusive<usize>),
}

impl Fitter for Wls {
    fn check(&self) -> Result<(), FitError> {
        if !(2..=12).contains(&self.order) {
            return Err(wrong("order", self.order, "it must be 2 to 12"));
        }
        if let Some(m) = self.m.filter(|&m| m + 1 < self.order || m > 10_000) {
            let range = "it must be at least the order less one, and at most 10000";
            return Err(wrong("m", m, range));
        }
        for (option, mu) in [("mu_x", self.mu_x), ("mu_y", self.mu_y)] {
            if !(mu.is_finite() && mu >= 0.0) {
                return Err(wrong(option, mu, "it must be 0 or more"));
            }
        }
        if !(0.0..=90.0).contains(&self.straight_deg) {
            let range = "it must be 0 to 90";
            return Err(wrong("straight_deg", self.straight_deg, range));
        }
        Ok(())
    }

    fn fit(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        self.check()?;
        both_ways(span, |span| {
            if let Some(m) = self.m.filter(|&m| m >= span.points().len().max(4)) {
                let value = format!("{m} for {} points", span.points().len());
                return Err(wrong("m", value, "it must be less than the span's points"));
            }
            let fitted = self.curves(span, tolerance_px);
            Ok(fitted.unwrap_or_else(|| polygon(span)))
        })
    }
}

fn wrong(option: &'static str, value: impl ToString, range: &'static str) -> FitError {
    FitError::option(("wls", option), value, range)
}

impl Wls {
    fn curves(&self, span: Span<'_>, tolerance: f64) -> Option<Fitted> {
        let (mut points, ends) = distinct(span);
        if points.len() < 4 || span.points().iter().any(|p| !p.is_finite()) {
            return None;
        }
        let (cubics, parameters) = if span.is_ring() {
            self.ring(&mut points, tolerance)?
        } else {
            let lines = self.lines(&points, ends, tolerance);
            self.row(&points, &pieces(&lines, points.len()), tolerance)?
        };
        judged(span, path_of(&cubics, span), (tolerance, parameters))
    }

    /// A ring: opened at its first straight run, or one periodic spline.
    fn ring(&self, points: &mut Vec<Point>, tolerance: f64) -> Option<(Vec<CubicBez>, usize)> {
        let lines = self.lines(points, turns::Ends::Closed, tolerance);
        let Some(start) = lines.first().map(|r| *r.start() % points.len()) else {
            let (vertices, basis) = self.grow(points, End::Ring, tolerance)?;
            let count = vertices.len();
            let around = around(&vertices, &basis);
            return Some((basis.cubics(&around, tolerance / 100.0), 2 * count));
        };
        let n = points.len();
        let turn = |k: usize| (k + n - start) % n;
        let lines: Vec<_> = lines
            .iter()
            .map(|r| {
                let a = turn(r.start() % n);
                a..=a + (r.end() - r.start())
            })
            .collect();
        points.rotate_left(start);
        points.extend(points.first().copied());
        let (cubics, parameters) = self.row(points, &pieces(&lines, n + 1), tolerance)?;
        Some((cubics, parameters - 2))
    }

    /// The straight runs, in order and without overlap.
    fn lines(
        &self,
        points: &[Point],
        ends: turns::Ends,
        tolerance: f64,
    ) -> Vec<RangeInclusive<usize>> {
        let rule = Straight {
            reach: REACH * tolerance,
            turn: self.straight_deg.to_radians(),
            length: RUN * tolerance,
            flat: tolerance / 2.0,
        };
        let mut out: Vec<RangeInclusive<usize>> = Vec::new();
        for run in Walk::new(points, ends).straight_runs(&rule) {
            let start = out.last().map_or(run.start, |r| run.start.max(*r.end()));
            if start + 2 * FEW < run.end {
                out.push(start..=run.end);
            }
        }
        out
    }

    /// The curves of an open row of points, piece by piece, and how many numbers they hold.
    fn row(
        &self,
        points: &[Point],
        pieces: &[Piece],
        tolerance: f64,
    ) -> Option<(Vec<CubicBez>, usize)> {
        let last = points.len() - 1;
        // what a spline takes of the lines beside it
        let few = if self.joint == Joint::Include { FEW } else { 0 };
        let mut parts: Vec<(Vec<Point>, Option<Basis>)> = Vec::new();
        for piece in pieces {
            parts.push(match piece {
                Piece::Line(r) => {
                    let a = r.start() + if *r.start() == 0 { 0 } else { few };
                    let b = r.end() - if *r.end() == last { 0 } else { few };
                    (vec![points[a], points[b]], None)
                }
                Piece::Spline(r) => {
                    let a = r.start().saturating_sub(few);
                    let b = (r.end() + few).min(last);
                    let held = |i: usize| (few > 0 || i == 0 || i == last).then(|| points[i]);
                    let end = End::Open(held(a), held(b));
                    let (vertices, basis) = self.grow(&points[a..=b], end, tolerance)?;
                    (vertices, Some(basis))
                }
            });
        }
        meet(&mut parts);
        let parameters = 2 + parts.iter().map(|(v, _)| 2 * (v.len() - 1)).sum::<usize>();
        let mut cubics = Vec::new();
        for (vertices, basis) in &parts {
            match (basis, vertices.as_slice()) {
                (Some(basis), _) => cubics.extend(basis.cubics(vertices, tolerance / 100.0)),
                (None, [a, b]) => cubics.push(line(*a, *b)),
                _ => {}
            }
        }
        exact_ends(&mut cubics, points);
        Some((cubics, parameters))
    }

    /// One nonlinear segment: with the m given, or with growing m until within the tolerance.
    fn grow(&self, points: &[Point], end: End, tolerance: f64) -> Option<(Vec<Point>, Basis)> {
        let n = points.len() - 1;
        let most = n.min(MOST);
        let mut m = self.m.unwrap_or(n / POINTS_A_VERTEX + 5).min(n);
        if self.m.is_none() {
            m = m.min(most);
        }
        loop {
            let order = self.order.min(m + 1);
            let (vertices, basis) = self.segment(points, (order, m + 1), end)?;
            if self.m.is_some() || m >= most {
                return Some((vertices, basis));
            }
            let around = around(&vertices, &basis);
            let cubics = basis.cubics(&around, tolerance / 100.0);
            let path = path_of(&cubics, Span::Open(points));
            if points_to_curve(points, &path).max_px <= tolerance {
                return Some((vertices, basis));
            }
            m = (m + m.div_ceil(2)).min(most);
        }
    }

    /// The vertices of one segment of that order and count.
    fn segment(
        &self,
        points: &[Point],
        (order, count): (usize, usize),
        end: End,
    ) -> Option<(Vec<Point>, Basis)> {
        let (basis, ends, walk_ends) = match end {
            End::Open(a, b) => (
                Basis::clamped(order, count)?,
                Ends::Held(a, b),
                turns::Ends::Open,
            ),
            End::Ring => (
                Basis::uniform(order, count + order - 1)?,
                Ends::Periodic(count),
                turns::Ends::Closed,
            ),
        };
        let walk = Walk::new(points, walk_ends);
        let (first, last) = basis.domain();
        let scale = (last - first) / walk.total();
        let at: Vec<f64> = walk.lengths().iter().map(|s| first + s * scale).collect(); // eq. 17
        let problem = Problem {
            points,
            basis: &basis,
            at: &at,
            mu: (self.mu_x, self.mu_y),
            ends,
        };
        let vertices = problem.vertices()?;
        Some((vertices, basis))
    }
}

/// The vertices of a curve over a basis: those of a ring again from the first on.
fn around(vertices: &[Point], basis: &Basis) -> Vec<Point> {
    let around = vertices.iter().cycle().take(basis.count());
    around.copied().collect()
}

/// How a segment ends: open with its outer vertices held or free, or closed.
#[derive(Debug, Clone, Copy)]
enum End {
    Open(Option<Point>, Option<Point>),
    Ring,
}

/// The straight runs and what lies between them, for a row of `n` points.
fn pieces(lines: &[RangeInclusive<usize>], n: usize) -> Vec<Piece> {
    let mut out = Vec::new();
    let mut at = 0;
    for run in lines {
        if *run.start() > at {
            out.push(Piece::Spline(at..=*run.start()));
        }
        out.push(Piece::Line(run.clone()));
        at = *run.end();
    }
    if at + 1 < n {
        out.push(Piece::Spline(at..=n - 1));
    }
    out
}

/// Neighbouring parts share the mean of their outer vertices [samavati98 sec. 5.1].
fn meet(parts: &mut [(Vec<Point>, Option<Basis>)]) {
    for i in 1..parts.len() {
        let (before, after) = parts.split_at_mut(i);
        let a = before.last_mut().and_then(|p| p.0.last_mut());
        if let (Some(a), Some(b)) = (a, after.first_mut().and_then(|p| p.0.first_mut())) {
            let mean = a.midpoint(*b);
            (*a, *b) = (mean, mean);
        }
    }
}

/// Takes the last bits of rounding out of the ends.
fn exact_ends(cubics: &mut [CubicBez], points: &[Point]) {
    if let (Some(c), Some(&p)) = (cubics.first_mut(), points.first()) {
        c.p0 = p;
    }
    if let (Some(c), Some(&p)) = (cubics.last_mut(), points.last()) {
        c.p3 = p;
    }
}
