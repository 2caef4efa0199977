//! Every quadratic that could lead from one end of a stretch to the other.

use super::super::curve::{Curve, Dot, Gate, Node};
use super::super::search::on_gate;
use super::step;
use crate::numeric::cast::index;
use kurbo::{ParamCurve, Point, QuadBez, Rect, Vec2};

/// Where a quadratic is looked at, the likeliest failure first.
const LOOK: [f64; 7] = [0.5, 0.25, 0.75, 0.125, 0.375, 0.625, 0.875];

/// Where a stretch of a curve begins or ends.
#[derive(Debug, Clone, Copy)]
pub(super) enum Side {
    Node(Node),
    Gate(Gate),
}

/// Where quadratics may begin or end: points, and how far from the next of them any other lies.
struct Places {
    points: Vec<Point>,
    around: f64,
}

/// A curve's samples from left to right.
struct Tube(Vec<Point>);

impl Tube {
    /// What lies between two sides, and what stays near their lines beyond them.
    fn between(curve: &Curve, sides: [(Side, usize); 2], reach: f64) -> Self {
        let [(from, _), (_, to)] = sides.map(|(side, at)| side.beside(curve, at, reach));
        let mut dots: Vec<Point> = curve.dots[from..=to].iter().map(|o| o.p).collect();
        dots.sort_by(|p, q| p.x.total_cmp(&q.x));
        Self(dots)
    }

    /// Whether the curve comes as near to a point as `reach`.
    fn near(&self, q: Point, reach: f64) -> bool {
        let first = self.0.partition_point(|p| p.x < q.x - reach);
        let right = self.0[first..].iter().take_while(|p| p.x <= q.x + reach);
        right
            .into_iter()
            .any(|p| p.distance_squared(q) <= reach * reach)
    }
}

impl Side {
    /// The x and the y that a control point beside it must have.
    fn fixes(self) -> [Option<f64>; 2] {
        match self {
            Self::Gate(g) if g.horizontal => [None, Some(f64::from(g.level))],
            Self::Gate(g) => [Some(f64::from(g.level)), None],
            Self::Node(n) => {
                let at = n.at.point();
                let is = |flat: bool, v: f64| flat.then_some(v);
                n.along
                    .map_or([None; 2], |u| [is(u.x == 0.0, at.x), is(u.y == 0.0, at.y)])
            }
        }
    }

    /// The samples on both sides of `at` up to which the curve stays that near to its line, units.
    fn beside(self, curve: &Curve, at: usize, reach: f64) -> (usize, usize) {
        let off = |p: Point| match self {
            Self::Gate(g) => p.distance(on_gate(g, p)),
            Self::Node(n) => n
                .along
                .map_or(f64::INFINITY, |u| u.cross(p - n.at.point()).abs()),
        };
        let (before, after) = curve.dots.split_at(at);
        let back = before.iter().rev().take_while(|o| off(o.p) <= reach);
        let ahead = after.iter().skip(1).take_while(|o| off(o.p) <= reach);
        (at - back.count(), at + ahead.count())
    }

    /// Where it may lie; at the curve's sample `at`.
    fn places(self, curve: &Curve, at: usize, reach: f64) -> Places {
        /// Places along a line lie so far apart, units.
        const APART: f64 = 1.0;
        /// Half of it, and what rounding moves them aside.
        const AROUND: f64 = 1.25;
        match self {
            Self::Gate(g) => Places {
                points: ends(curve, g, reach),
                around: 0.0,
            },
            Self::Node(n) => {
                let Some(u) = n.along else {
                    let moves = if n.free == Vec2::ZERO { 0.0 } else { reach };
                    return Places {
                        points: vec![n.at.point()],
                        around: moves + n.rounded,
                    };
                };
                let node = n.at.point();
                let (from, to) = self.beside(curve, at, reach);
                let along = curve.dots[from..=to].iter().map(|o| (o.p - node).dot(u));
                let (low, high) = along.fold((0.0, 0.0), |(l, h), v: f64| (v.min(l), v.max(h)));
                let (low, high) = (low - reach, high + reach);
                let many = index((high - low) / APART) + 1;
                let points = (0..=many).map(|k| node + u * (low + APART * k as f64));
                Places {
                    points: points.collect(),
                    around: AROUND,
                }
            }
        }
    }

    /// Fewest bytes of the step between it and a control point.
    fn bytes(self, c: Point, limit: f64) -> u32 {
        match self {
            Self::Node(Node {
                along: None,
                at,
                free,
                ..
            }) => {
                let d = c - at.point();
                let slack = |free: f64| if free > 0.0 { limit + 1.0 } else { 0.0 };
                step(d.x, slack(free.x)) + step(d.y, slack(free.y))
            }
            _ => 1,
        }
    }
}

/// The control point where the tangents of two neighbouring extrema cross, and between which of their joins a
/// single quadratic with it lies near the curve.
pub(super) struct Crossing {
    pub(super) control: Point,
    /// Where a quadratic may leave the first extremum.
    pub(super) joins: Vec<Point>,
    /// Numbers of joins at the first and at the second.
    pub(super) pairs: Vec<(usize, usize)>,
}

/// None where the tangents do not cross.
pub(super) fn crossing(curve: &Curve, [a, b]: [(Side, usize); 2], limit: f64) -> Option<Crossing> {
    let (Side::Gate(g), Side::Gate(h)) = (a.0, b.0) else {
        return None;
    };
    if g.horizontal == h.horizontal {
        return None;
    }
    let control = on_gate(h, on_gate(g, Point::ORIGIN));
    let reach = limit + 0.5 * curve.step;
    let tube = Tube::between(curve, [a, b], reach);
    let [joins, tails] = [g, h].map(|g| ends(curve, g, reach));
    let fits = |&(i, j): &(usize, usize)| {
        let quad = QuadBez::new(joins[i], control, tails[j]);
        LOOK.iter().all(|&u| tube.near(quad.eval(u), reach))
    };
    let all = (0..joins.len()).flat_map(|i| (0..tails.len()).map(move |j| (i, j)));
    let pairs = all.filter(fits).collect();
    Some(Crossing {
        control,
        joins,
        pairs,
    })
}

/// For all single quadratics from one side to the other that lie near the curve, the fewest bytes of the steps to
/// the control point and from it.
pub(super) fn singles(curve: &Curve, [a, b]: [(Side, usize); 2], limit: f64) -> Vec<[u32; 2]> {
    /// More are not looked at, and any is thought possible.
    const MOST: f64 = 3e6;
    let reach = limit + 0.5 * curve.step;
    let tube = Tube::between(curve, [a, b], reach);
    let from = Rect::from_points(tube.0[0], tube.0[0]);
    let hull = tube.0.iter().fold(from, |r, &p| r.union_pt(p));
    let hull = hull.inflate(2.0 * reach, 2.0 * reach);
    let [heads, tails] = [a, b].map(|(side, at)| side.places(curve, at, reach));
    let (fixed, also) = (a.0.fixes(), b.0.fixes());
    let both = [0, 1].map(|k| [fixed[k], also[k]]);
    if both
        .iter()
        .any(|v| matches!(v, [Some(p), Some(q)] if (p - q).abs() > 0.5))
    {
        return Vec::new();
    }
    let fixed = both.map(|[p, q]| p.or(q));
    let range = |k: usize, low: f64, high: f64| match fixed[k] {
        Some(v) => (v, v),
        None => (low.floor(), high.ceil()),
    };
    let mut out: Vec<[u32; 2]> = Vec::new();
    let pairs = heads
        .points
        .iter()
        .flat_map(|&m| tails.points.iter().map(move |&n| (m, n)));
    let mut looked = 0.0;
    for (m, n) in pairs {
        let middle = m.midpoint(n);
        let (x0, x1) = range(0, 2.0 * hull.x0 - middle.x, 2.0 * hull.x1 - middle.x);
        let (y0, y1) = range(1, 2.0 * hull.y0 - middle.y, 2.0 * hull.y1 - middle.y);
        looked += (x1 - x0 + 1.0) * (y1 - y0 + 1.0);
        if looked > MOST {
            return vec![[1, 1]];
        }
        for x in 0..=index(x1 - x0) {
            for y in 0..=index(y1 - y0) {
                let c = Point::new(x0 + x as f64, y0 + y as f64);
                let quad = QuadBez::new(m, c, n);
                let fits = LOOK.iter().all(|&u| {
                    let moved = heads.around * (1.0 - u) * (1.0 - u) + tails.around * u * u;
                    tube.near(quad.eval(u), reach + moved)
                });
                let steps = [a, b].map(|(side, _)| side.bytes(c, limit));
                if fits && !out.contains(&steps) {
                    out.push(steps);
                }
            }
        }
    }
    out
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
    let many = index((2.0 * high - first).max(0.0)) + 1;
    let places = (0..many).map(|k| 0.5 * (first + k as f64));
    places.map(|v| on_gate(gate, Point::new(v, v))).collect()
}
