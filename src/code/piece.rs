//! Pieces of curve, and whether they stay within the bounds.

use super::band::Band;
use super::line::{LOOK, Weights};
use super::{Closing, Kind};
use kurbo::Point;
use std::cell::Cell;

/// Every such boundary point is looked at before all are.
const SPARSE: usize = 4;

/// Points on each piece of the answer: dense enough that their distances are the curve's.
const DENSE: usize = 64;

/// What the pieces of a curve have in common.
#[derive(Debug)]
pub(super) struct Piece<'a> {
    pub(super) band: &'a Band,
    pub(super) kind: Kind,
    weights: Weights,
    /// Half of the longest edge, px.
    reach: f64,
    /// The point of the last piece that lay outside the tube.
    failed: Cell<usize>,
}

/// Places near each other that pieces begin or end at.
#[derive(Debug, Clone, Copy)]
pub(super) struct Disc {
    /// px.
    pub(super) middle: Point,
    /// px.
    pub(super) radius: f64,
    /// A boundary point that none of theirs lies beyond, seen from the piece.
    pub(super) foot: usize,
}

impl<'a> Piece<'a> {
    /// Of a curve whose edges' components are no longer than so many px.
    pub(super) fn new(band: &'a Band, kind: Kind, longest: i32) -> Self {
        let pull = match kind {
            Kind::Polygon => None,
            Kind::Spline(pull) => Some(pull),
        };
        Self {
            band,
            kind,
            weights: Weights::new(pull),
            reach: f64::from(longest) * std::f64::consts::FRAC_1_SQRT_2,
            failed: Cell::new(LOOK / 2),
        }
    }

    /// The boundary point that an edge is parted at, if the edge may be one of a curve within the bounds: nearest to
    /// its middle, which splines pass through; a polygon's edge is all of its curve.
    pub(super) fn foot(&self, from: usize, to: usize) -> Option<usize> {
        let (v, w) = (self.band.vertices[from], self.band.vertices[to]);
        let (p, q) = (v.point(), w.point());
        if self.kind == Kind::Polygon {
            let within = self.within([p, p, q], (v.stage, w.stage), &Cell::new(usize::MAX));
            return within.then_some(w.stage);
        }
        let middle = p.midpoint(q);
        let feet = (v.stage, w.stage);
        let held = self.band.tube.holds(&self.band.boundary, middle, feet);
        held.then(|| self.band.nearest(middle, feet))
    }

    /// Whether no curve within the bounds has an edge: a piece that it is half of leaves the tube
    /// wherever its other end lies.
    pub(super) fn leaves(&self, from: usize, to: usize) -> bool {
        /// Beyond this point of the piece its other end tells where it runs.
        const SOON: usize = 6;
        let [p, q] = [from, to].map(|i| self.band.vertices[i].point());
        let ([a, _, c], middle) = (&self.weights.of, p.midpoint(q));
        let leaves = |vertex: Point| {
            (1..=SOON).any(|k| {
                let at = vertex + (middle - vertex) * a[k];
                self.band.tube.misses(at, c[k] * self.reach)
            })
        };
        self.kind != Kind::Polygon && (leaves(p) || leaves(q))
    }

    /// Where the piece of a vertex ends, if a single one follows.
    pub(super) fn end(&self, vertex: usize, next: usize, foot: usize) -> Disc {
        let [p, q] = [vertex, next].map(|i| self.band.vertices[i].point());
        Disc {
            middle: p.midpoint(q),
            radius: 0.0,
            foot,
        }
    }

    /// Whether no piece fits that begins in a disc, ends in another and has this vertex between.
    pub(super) fn strays(&self, begin: Disc, vertex: usize, end: Disc, last: &Cell<usize>) -> bool {
        let Band {
            boundary,
            squares,
            tube,
            ..
        } = self.band;
        let legs = [begin.middle, self.band.vertices[vertex].point(), end.middle];
        // no point of a piece moves by more than its ends do
        let radius = f64::max(begin.radius, end.radius);
        let limit = |i: usize| {
            let wider = squares[i].sqrt() + radius;
            (boundary[i], wider * wider)
        };
        let far = last.get();
        let line = self.weights.line(legs);
        if (begin.foot..=end.foot).contains(&far) && line.far(limit(far)) {
            return true;
        }
        if self.weights.miss(tube, legs, [begin.radius, end.radius]) {
            return true;
        }
        let far = line.missed((begin.foot, end.foot, SPARSE), limit);
        if let Some(i) = far {
            last.set(i);
        }
        far.is_some()
    }

    /// Whether the piece of three vertices stays within T of the boundary between its ends' feet, both ways.
    pub(super) fn fits(&self, abc: [usize; 3], feet: (usize, usize), last: &Cell<usize>) -> bool {
        if self.kind == Kind::Polygon {
            return true;
        }
        let [a, q, c] = abc.map(|i| self.band.vertices[i].point());
        self.within([a.midpoint(q), q, q.midpoint(c)], feet, last)
    }

    fn within(
        &self,
        legs: [Point; 3],
        (first, last): (usize, usize),
        failed: &Cell<usize>,
    ) -> bool {
        let Band {
            boundary,
            squares,
            tube,
            ..
        } = self.band;
        // what the piece before failed at, one much like this one as a rule
        let (at, far) = (self.failed.get(), failed.get());
        if !tube.holds(boundary, self.weights.dot(legs, at), (first, last)) {
            return false;
        }
        let line = self.weights.line(legs);
        if (first..=last).contains(&far) && line.far((boundary[far], squares[far])) {
            return false;
        }
        if let Some(k) = self.weights.outside(tube, boundary, legs, (first, last)) {
            self.failed.set(k);
            return false;
        }
        let limit = |i: usize| (boundary[i], squares[i]);
        let sparse = line.missed((first, last, SPARSE), limit);
        let far = sparse.or_else(|| line.missed((first, last, 1), limit));
        if let Some(i) = far {
            failed.set(i);
        }
        far.is_none()
    }
}

/// The whole curve of vertices, the first of them again at the end.
pub(super) fn curve(kind: Kind, vertices: &[Point], closing: Closing) -> Vec<Point> {
    let along = |k: usize| k as f64 / DENSE as f64;
    let Kind::Spline(pull) = kind else {
        let edge = |w: &[Point]| {
            let dots = (0..=DENSE).map(|k| w[0].lerp(w[1], along(k)));
            dots.collect::<Vec<_>>()
        };
        return vertices.windows(2).flat_map(edge).collect();
    };
    let (before, after) = match closing {
        Closing::Corner => (vertices.first(), vertices.last()),
        Closing::Ring => (vertices.iter().rev().nth(1), None),
    };
    let all = before.into_iter().chain(vertices).chain(after);
    let all: Vec<Point> = all.copied().collect();
    let piece = |w: &[Point]| {
        let legs = [w[0].midpoint(w[1]), w[1], w[1].midpoint(w[2])];
        let dots = (0..=DENSE).map(|k| pull.eval(&legs, along(k)).0);
        dots.collect::<Vec<_>>()
    };
    all.windows(3).flat_map(piece).collect()
}
