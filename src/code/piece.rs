//! Pieces of curve, and whether they stay within the bounds.

use super::band::Band;
use super::{Kind, RUN};
use kurbo::Point;
use std::cell::Cell;

/// Edges of the polyline that a piece is measured by.
const LOOK: usize = 16;

/// Points of a piece in the order that they are looked at: the middle is the likeliest to be too far.
const ORDER: [usize; LOOK + 1] = [8, 4, 12, 2, 6, 10, 14, 1, 3, 5, 7, 9, 11, 13, 15, 0, LOOK];

/// Every such boundary point is looked at before all are.
const SPARSE: usize = 4;

/// Points on each piece of the answer: dense enough that their distances are the curve's.
const DENSE: usize = 64;

/// Weights of the ends and the vertex of a piece, at the points that it is measured by; of edges one end and the other.
#[derive(Debug)]
pub(super) struct Piece<'a> {
    pub(super) band: &'a Band,
    pub(super) kind: Kind,
    weights: [[f64; 3]; LOOK + 1],
    /// The point of the last piece that lay outside the tube, and the boundary point that one passed too far away.
    failed: Cell<(usize, usize)>,
}

impl<'a> Piece<'a> {
    pub(super) fn new(band: &'a Band, kind: Kind) -> Self {
        let weights = std::array::from_fn(|k| {
            let u = k as f64 / LOOK as f64;
            match kind {
                Kind::Polygon => [1.0 - u, 0.0, u],
                Kind::Spline(pull) => pull.quadratic(u),
            }
        });
        Self {
            band,
            kind,
            weights,
            failed: Cell::new((LOOK / 2, usize::MAX)),
        }
    }

    /// The boundary point that an edge is parted at, if the edge may be one of a curve within the bounds: nearest to
    /// its middle, which splines pass through; a polygon's edge is all of its curve.
    pub(super) fn foot(&self, from: usize, to: usize) -> Option<usize> {
        let (v, w) = (self.band.vertices[from], self.band.vertices[to]);
        let (p, q) = (v.point(), w.point());
        if self.kind == Kind::Polygon {
            let within = self.within([p, p, q], (v.stage, w.stage));
            return within.then_some(w.stage);
        }
        let middle = p.midpoint(q);
        let feet = (v.stage, w.stage);
        let Band { boundary, tube, .. } = self.band;
        if !tube.holds(boundary, middle, feet) {
            return None;
        }
        let squares = boundary[v.stage..=w.stage]
            .iter()
            .map(|b| b.distance_squared(middle));
        let nearest = squares.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
        nearest.map(|(i, _)| v.stage + i)
    }

    /// Whether no curve within the bounds has an edge: a piece that it is half of leaves the tube
    /// wherever its other end lies.
    pub(super) fn leaves(&self, from: usize, to: usize) -> bool {
        /// Beyond this point of the piece its other end tells where it runs.
        const SOON: usize = 6;
        /// Longest half of an edge, px.
        const REACH: f64 = RUN as f64 * std::f64::consts::FRAC_1_SQRT_2;
        let [p, q] = [from, to].map(|i| self.band.vertices[i].point());
        let leaves = |vertex: Point| {
            self.weights[..=SOON].iter().any(|[a, _, c]| {
                let at = vertex.lerp(p.midpoint(q), *a);
                self.band.tube.misses(at, c * REACH)
            })
        };
        self.kind != Kind::Polygon && (leaves(p) || leaves(q))
    }

    /// Whether no piece fits that begins in a disc (its middle and radius, px) and has these last vertices and feet.
    pub(super) fn strays(
        &self,
        (middle, radius): (Point, f64),
        [w, x]: [usize; 2],
        feet: (usize, usize),
    ) -> bool {
        let [q, x] = [w, x].map(|i| self.band.vertices[i].point());
        let legs = [middle, q, q.midpoint(x)];
        let Band {
            boundary,
            squares,
            tube,
            ..
        } = self.band;
        let mut line = [Point::ZERO; LOOK + 1];
        for k in ORDER {
            line[k] = self.dot(legs, k);
            if tube.misses(line[k], self.weights[k][0] * radius) {
                return true;
            }
        }
        // no point of a piece moves by more than its beginning does
        missed(&line, (feet.0..=feet.1).step_by(SPARSE), |i| {
            (boundary[i], (squares[i].sqrt() + radius).powi(2))
        })
        .is_some()
    }

    /// Whether the piece of three vertices stays within T of the boundary between its ends' feet, both ways.
    pub(super) fn fits(&self, abc: [usize; 3], feet: (usize, usize)) -> bool {
        if self.kind == Kind::Polygon {
            return true;
        }
        let [a, q, c] = abc.map(|i| self.band.vertices[i].point());
        self.within([a.midpoint(q), q, q.midpoint(c)], feet)
    }

    fn within(&self, legs: [Point; 3], (first, last): (usize, usize)) -> bool {
        let Band {
            boundary,
            squares,
            tube,
            ..
        } = self.band;
        let line: [Point; LOOK + 1] = std::array::from_fn(|k| self.dot(legs, k));
        let limit = |i: usize| (boundary[i], squares[i]);
        // what the piece before failed at, one much like this one as a rule
        let (at, far) = self.failed.get();
        let holds = |k: usize| tube.holds(boundary, line[k], (first, last));
        if !holds(at) {
            return false;
        }
        if (first..=last).contains(&far) && missed(&line, far..=far, limit).is_some() {
            return false;
        }
        if let Some(k) = ORDER.into_iter().find(|&k| !holds(k)) {
            self.failed.set((k, far));
            return false;
        }
        let sparse = missed(&line, (first..=last).step_by(SPARSE), limit);
        let far = sparse.or_else(|| missed(&line, first..=last, limit));
        if let Some(i) = far {
            self.failed.set((at, i));
        }
        far.is_none()
    }

    fn dot(&self, [p, q, r]: [Point; 3], k: usize) -> Point {
        let [x, y, z] = self.weights[k];
        (p.to_vec2() * x + q.to_vec2() * y + r.to_vec2() * z).to_point()
    }

    /// The whole curve, first and last vertex doubled.
    pub(super) fn curve(&self, vertices: &[Point]) -> Vec<Point> {
        let along = |k: usize| k as f64 / DENSE as f64;
        let Kind::Spline(pull) = self.kind else {
            let edge = |w: &[Point]| {
                let dots = (0..=DENSE).map(|k| w[0].lerp(w[1], along(k)));
                dots.collect::<Vec<_>>()
            };
            return vertices.windows(2).flat_map(edge).collect();
        };
        let (first, last) = (vertices.first(), vertices.last());
        let all = first.into_iter().chain(vertices).chain(last);
        let all: Vec<Point> = all.copied().collect();
        let piece = |w: &[Point]| {
            let legs = [w[0].midpoint(w[1]), w[1], w[1].midpoint(w[2])];
            let dots = (0..=DENSE).map(|k| pull.eval(&legs, along(k)).0);
            dots.collect::<Vec<_>>()
        };
        all.windows(3).flat_map(piece).collect()
    }
}

/// The first of points that a line does not come as near to as it asks for: each with the square of its limit.
fn missed(
    line: &[Point],
    mut points: impl Iterator<Item = usize>,
    limit: impl Fn(usize) -> (Point, f64),
) -> Option<usize> {
    // the chord that the last point was close to is likely the next one's too
    let (mut chord, chords) = (0, line.len() - 1);
    points.find(|&i| {
        let (p, square) = limit(i);
        let close = |k: &usize| to_edge(p, &line[*k..*k + 2]) <= square;
        let found = (chord..chords).chain(0..chord).find(close);
        chord = found.unwrap_or(0);
        found.is_none()
    })
}

/// Square of the distance of a point from an edge.
pub(super) fn to_edge(p: Point, w: &[Point]) -> f64 {
    let v = w[1] - w[0];
    let u = ((p - w[0]).dot(v) / v.hypot2().max(1e-12)).clamp(0.0, 1.0);
    (w[0] + v * u).distance_squared(p)
}
