//! How few points an outline can do with: a bound from below that no search enters.
//!
//! What [`Strictness::Extrema`](super::Strictness) keeps asks for points by itself. A corner and the end of a
//! line are on-curve points. At an extremum two quadratics join, so between two neighbouring ones, or an
//! extremum and a node, lies one control point at least. Where the tangents at two neighbouring extrema
//! cross at right angles a single quadratic between them has its control point at the crossing, and its
//! ends at whole or half units of both tangents: all of them are tried, and where each has a point farther
//! than the tolerance from the whole curve there are two control points at least. Tangents that do not
//! cross need two as well, since no parabola has them.

use super::Rate;
use super::curve::{Course, Curve, Dot, Gate, Span, count, whole};
use super::search::on_gate;
use crate::types::Outline;
use kurbo::{ParamCurve, Point, QuadBez, Rect};

impl Rate {
    /// Fewest points that any outline of lines and quadratics stores which lies within `tolerance` (units) of
    /// this one, on whole units, and has its corners, long lines and extrema.
    #[must_use]
    pub fn least_points(&self, outline: &Outline, tolerance: f64) -> usize {
        let keep = self.kept(tolerance);
        let courses = outline.contours().iter();
        let courses = courses.filter_map(|path| Course::new(path, keep));
        courses.map(|course| of_course(&course, tolerance)).sum()
    }
}

fn of_course(course: &Course, limit: f64) -> usize {
    match course {
        Course::Ring(curve, top) => {
            let mut gates = vec![*top];
            gates.extend(&curve.gates);
            gates.push(*top);
            between(curve, &gates, limit)
        }
        // A node, and for a curve one control point from each end to the first extremum and between them.
        Course::Spans(spans) => spans
            .iter()
            .map(|(_, span, _)| match span {
                Span::Line => 1,
                Span::Curve(curve) if curve.gates.is_empty() => 2,
                Span::Curve(curve) => 3 + between(curve, &curve.gates, limit),
            })
            .sum(),
    }
}

/// Control points between neighbouring extrema.
fn between(curve: &Curve, gates: &[Gate], limit: f64) -> usize {
    let pairs = gates.windows(2);
    pairs
        .map(|p| {
            if one_does(curve, p[0], p[1], limit) {
                1
            } else {
                2
            }
        })
        .sum()
}

/// Whether a single quadratic may lead from one extremum to the next.
fn one_does(curve: &Curve, a: Gate, b: Gate, limit: f64) -> bool {
    /// Where quadratics are looked at.
    const LOOK: [f64; 7] = [0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875];
    if a.horizontal == b.horizontal {
        return false;
    }
    let c = on_gate(b, on_gate(a, Point::ORIGIN));
    // Between two samples the curve lies no closer than half a step less than they do.
    let reach = limit + 0.5 * curve.step;
    let (heads, tails) = (ends(curve, a, reach), ends(curve, b, reach));
    let hull = heads
        .iter()
        .chain(&tails)
        .fold(Rect::from_points(c, c), |r, &p| r.union_pt(p));
    let hull = hull.inflate(reach, reach);
    let dots: Vec<Point> = curve
        .dots
        .iter()
        .map(|o| o.p)
        .filter(|&p| hull.contains(p))
        .collect();
    let near = |q: Point| dots.iter().any(|p| p.distance_squared(q) <= reach * reach);
    let fits = |m: Point, n: Point| {
        let quad = QuadBez::new(m, c, n);
        LOOK.iter().all(|&u| near(quad.eval(u)))
    };
    heads.iter().any(|&m| tails.iter().any(|&n| fits(m, n)))
}

/// Where quadratics may join at an extremum: whole and half units of its tangent, along which the curve stays
/// that near.
fn ends(curve: &Curve, gate: Gate, reach: f64) -> Vec<Point> {
    let along = |p: Point| if gate.horizontal { p.x } else { p.y };
    let stays = |dot: &&Dot| dot.p.distance(on_gate(gate, dot.p)) <= reach;
    let (before, after) = curve.dots.split_at(gate.at);
    let here = before
        .iter()
        .rev()
        .take_while(stays)
        .chain(after.iter().take_while(stays));
    let (low, high) = here.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), dot| {
        (
            low.min(along(dot.p) - reach),
            high.max(along(dot.p) + reach),
        )
    });
    let first = (2.0 * low).ceil();
    let many = whole((2.0 * high - first).max(0.0)) + 1;
    let places = (0..many).map(|k| 0.5 * (first + count(k)));
    places.map(|v| on_gate(gate, Point::new(v, v))).collect()
}
