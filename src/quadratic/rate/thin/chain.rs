//! A run of control points that may still move, between two nodes or around a ring.

use super::super::curve::{Curve, Node};
use super::super::glyf::Stored;
use super::{Point, Vec2, is_ahead, smooth};
use crate::numeric::cast::index;

/// A point, and what may move it.
#[derive(Debug, Clone)]
pub(super) struct Spot {
    pub(super) at: Point,
    /// The unknowns that move it, and whither each does.
    pub(super) ways: Vec<(usize, Vec2)>,
    /// The drawn corner, from which it may move no farther than the curve may.
    pub(super) home: Option<Point>,
}

impl Spot {
    const fn fixed(at: Point) -> Self {
        Self {
            at,
            ways: Vec::new(),
            home: None,
        }
    }

    fn free(at: Point, unknown: usize) -> Self {
        Self {
            ways: vec![
                (unknown, Vec2::new(1.0, 0.0)),
                (unknown + 1, Vec2::new(0.0, 1.0)),
            ],
            ..Self::fixed(at)
        }
    }
}

/// Control points, every join between them implied; an open chain begins and ends with a node.
#[derive(Debug, Clone)]
pub(super) struct Chain {
    pub(super) spots: Vec<Spot>,
    pub(super) unknowns: usize,
    /// Directions in which it must begin and end.
    pub(super) along: [Option<Vec2>; 2],
    /// Directions in which the curve begins and ends.
    tangents: [Vec2; 2],
    is_ring: bool,
}

/// Points at even parts of those given, one less.
fn spread(points: &[Stored]) -> Option<Vec<Point>> {
    /// More are not fitted.
    const MOST: usize = 40;
    let many = points.len().checked_sub(1)?;
    if many == 0 || many > MOST {
        return None;
    }
    let share = (many + 1) as f64 / many as f64;
    let place = |i: usize| {
        let at = ((i as f64 + 0.5) * share - 0.5).clamp(0.0, many as f64);
        let low = index(at).min(many - 1);
        let [a, b] = [low, low + 1].map(|k| points[k].point());
        a.lerp(b, at - low as f64)
    };
    Some((0..many).map(place).collect())
}

impl Chain {
    /// Around a ring, of one point less.
    pub(super) fn ring(points: &[Stored]) -> Option<Self> {
        let controls = spread(points).filter(|c| c.len() > 2)?;
        Some(Self {
            unknowns: 2 * controls.len(),
            spots: free(controls),
            along: [None; 2],
            tangents: [Vec2::ZERO; 2],
            is_ring: true,
        })
    }

    /// Between two nodes, of one control point less.
    pub(super) fn open(curve: &Curve, nodes: [Node; 2], points: &[Stored]) -> Option<Self> {
        let [first, inner @ .., last] = points else {
            return None;
        };
        let mut controls = free(spread(inner)?);
        let mut unknowns = 2 * controls.len();
        let along = nodes.map(|n| n.along);
        let room = [curve.first, curve.dots.len() - 1 - curve.last];
        let drawn = [curve.first, curve.last].map(|i| curve.dots[i].p);
        let mut ends = [*first, *last].map(|p| Spot::fixed(p.point()));
        for (k, end) in ends.iter_mut().enumerate() {
            let axes = [Vec2::new(1.0, 0.0), Vec2::new(0.0, 1.0)];
            let free = [nodes[k].free.x, nodes[k].free.y];
            let ways = match along[k] {
                Some(u) => vec![u; usize::from(room[k] > 0)],
                None => (0..2).filter(|&i| free[i] > 0.0).map(|i| axes[i]).collect(),
            };
            end.home = (along[k].is_none() && !ways.is_empty()).then_some(drawn[k]);
            end.ways = (unknowns..).zip(ways).collect();
            unknowns += end.ways.len();
        }
        bind(&mut controls, [ends[0].at, ends[1].at], along)?;
        let [start, end] = ends;
        controls.insert(0, start);
        controls.push(end);
        Some(Self {
            spots: controls,
            unknowns,
            along,
            tangents: [curve.first, curve.last].map(|i| curve.dots[i].t),
            is_ring: false,
        })
    }

    /// How many quadratics.
    pub(super) fn many(&self) -> usize {
        self.spots.len() - if self.is_ring { 0 } else { 2 }
    }

    /// What each spot has to do with the place at `u` of a quadratic.
    pub(super) fn weights(&self, quad: usize, u: f64) -> [(usize, f64); 3] {
        let n = self.spots.len();
        let (before, own, after) = if self.is_ring {
            ((quad + n - 1) % n, quad, (quad + 1) % n)
        } else {
            (quad, quad + 1, quad + 2)
        };
        // A quadratic ends at a node, and half way to a control point.
        let share = |k: usize| {
            let is_node = !self.is_ring && (k == 0 || k == n - 1);
            if is_node { 1.0 } else { 0.5 }
        };
        let (x, y) = (share(before), share(after));
        let (a, b) = ((1.0 - u) * (1.0 - u), u * u);
        let middle = 2.0 * u * (1.0 - u) + (1.0 - x) * a + (1.0 - y) * b;
        [(before, x * a), (own, middle), (after, y * b)]
    }

    /// The place at `u` of a quadratic.
    pub(super) fn eval(&self, quad: usize, u: f64) -> Point {
        let parts = self.weights(quad, u).into_iter();
        let sum = parts.map(|(k, w)| self.spots[k].at.to_vec2() * w);
        sum.fold(Vec2::ZERO, |a, b| a + b).to_point()
    }

    /// Start, control point and end of a quadratic.
    pub(super) fn quad(&self, quad: usize) -> [Point; 3] {
        let own = self.weights(quad, 0.0)[1].0;
        [
            self.eval(quad, 0.0),
            self.spots[own].at,
            self.eval(quad, 1.0),
        ]
    }

    /// Whether it begins and ends at corners.
    pub(super) fn corners(&self) -> [bool; 2] {
        self.along.map(|u| u.is_none() && !self.is_ring)
    }

    /// Spots in the order in which they are rounded: the nodes first.
    pub(super) fn order(&self) -> Vec<usize> {
        let last = self.spots.len() - 1;
        if self.is_ring {
            (0..=last).collect()
        } else {
            [0, last].into_iter().chain(1..last).collect()
        }
    }

    /// Puts a spot on the grid, for good; whether any that is left may give way.
    pub(super) fn round(&mut self, spot: usize) -> bool {
        let moved = &mut self.spots[spot];
        let was_free = !moved.ways.is_empty();
        moved.at = Stored::on(moved.at).point();
        moved.ways.clear();
        let last = self.spots.len() - 1;
        if !self.is_ring && (spot == 0 || spot == last) && last > 2 {
            // The control point beside a node that was moved lies on its line again.
            let (beside, u) = if spot == 0 {
                (1, self.along[0])
            } else {
                (last - 1, self.along[1])
            };
            let m = self.spots[spot].at;
            if let Some(u) = u {
                let c = &mut self.spots[beside].at;
                *c = m + u * (*c - m).dot(u);
            }
        }
        was_free && self.spots.iter().any(|s| !s.ways.is_empty())
    }

    /// Whether it begins and ends along the lines given, and at corners where the curve goes.
    pub(super) fn leaves_well(&self) -> bool {
        let last = self.spots.len() - 1;
        let leg = |from: usize, to: usize| self.spots[to].at - self.spots[from].at;
        let ends = self.along.into_iter().zip(self.tangents);
        let mut ends = ends.zip([leg(0, 1), leg(last - 1, last)]);
        self.is_ring
            || ends.all(|((along, tangent), leg)| {
                along.map_or_else(|| is_ahead(tangent, leg), |u| smooth(u, leg))
            })
    }

    /// As TrueType stores it.
    pub(super) fn stored(&self) -> Vec<Stored> {
        let last = self.spots.len() - 1;
        let is_node = |k: usize| !self.is_ring && (k == 0 || k == last);
        let all = self.spots.iter().enumerate();
        all.map(|(k, s)| Stored {
            on: is_node(k),
            ..Stored::on(s.at)
        })
        .collect()
    }
}

/// Control points that may go anywhere.
fn free(controls: Vec<Point>) -> Vec<Spot> {
    let all = controls.into_iter().enumerate();
    all.map(|(i, c)| Spot::free(c, 2 * i)).collect()
}

/// Lays the first and the last control point on the lines along which the chain begins and ends. None where
/// one point would have to lie on two lines that do not cross.
fn bind(controls: &mut [Spot], ends: [Point; 2], along: [Option<Vec2>; 2]) -> Option<()> {
    /// Sine of the least angle at which lines cross.
    const CROSS: f64 = 1e-3;
    if let ([only], [Some(u), Some(v)]) = (&mut *controls, along) {
        let turn = u.cross(v);
        let c = ends[0] + u * ((ends[1] - ends[0]).cross(v) / turn);
        *only = Spot::fixed(Stored::on(c).point());
        return (turn.abs() > CROSS).then_some(());
    }
    let last = controls.len() - 1;
    for (k, m, u) in [(0, ends[0], along[0]), (last, ends[1], along[1])] {
        if let Some(u) = u {
            let c = &mut controls[k];
            c.at = m + u * (c.at - m).dot(u);
            c.ways = vec![(2 * k, u)];
        }
    }
    Some(())
}
