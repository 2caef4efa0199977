//! Pieces of curve, and whether they stay within the bounds.

use super::Kind;
use super::band::Band;
use kurbo::Point;

/// Edges of the polyline that a piece is measured by.
const LOOK: usize = 16;

/// Points on each piece of the answer: dense enough that their distances are the curve's.
const DENSE: usize = 64;

#[derive(Debug)]
pub(super) struct Piece<'a> {
    pub(super) band: &'a Band,
    pub(super) kind: Kind,
}

impl Piece<'_> {
    /// The boundary point that an edge is parted at, if the edge may be one of a curve within the bounds: nearest to
    /// its middle, which splines pass through; a polygon's edge is all of its curve.
    pub(super) fn foot(&self, from: usize, to: usize) -> Option<usize> {
        let (v, w) = (self.band.vertices[from], self.band.vertices[to]);
        let (p, q) = (v.point(), w.point());
        if self.kind == Kind::Polygon {
            let within = self.within(|u| p.lerp(q, u), (v.stage, w.stage));
            return within.then_some(w.stage);
        }
        self.near(p.midpoint(q), v.stage, w.stage)
    }

    /// Whether the piece of three vertices stays within T of the boundary between its ends' feet, both ways.
    pub(super) fn fits(&self, abc: [usize; 3], feet: (usize, usize)) -> bool {
        let Kind::Spline(pull) = self.kind else {
            return true;
        };
        let [a, q, c] = abc.map(|i| self.band.vertices[i].point());
        let (p, r) = (a.midpoint(q).to_vec2(), q.midpoint(c).to_vec2());
        let dot = |u: f64| {
            let [x, y, z] = pull.quadratic(u);
            (p * x + q.to_vec2() * y + r * z).to_point()
        };
        self.within(dot, feet)
    }

    fn within(&self, dot: impl Fn(f64) -> Point, (first, last): (usize, usize)) -> bool {
        let near = |c: Point| self.near(c, first, last).is_some();
        // the middle is the likeliest to be too far
        if !near(dot(0.5)) {
            return false;
        }
        let line: [Point; LOOK + 1] = std::array::from_fn(|k| dot(k as f64 / LOOK as f64));
        let passed = |i: usize| {
            let (p, square) = (self.band.boundary[i], self.band.squares[i]);
            line.windows(2).any(|w| to_edge(p, w) <= square)
        };
        line.iter().all(|&c| near(c)) && (first..=last).all(passed)
    }

    /// The nearest of these boundary points, if the boundary is within T there.
    fn near(&self, p: Point, first: usize, last: usize) -> Option<usize> {
        let Band {
            boundary, squares, ..
        } = self.band;
        let mut best = (f64::INFINITY, first);
        for (i, b) in boundary[first..=last].iter().enumerate() {
            let d = b.distance_squared(p);
            if d < best.0 {
                best = (d, first + i);
            }
        }
        let (d, i) = best;
        // between the points the boundary is closer by up to half a step
        let sides = &boundary[i.saturating_sub(1)..(i + 2).min(boundary.len())];
        let within = |d: f64| d <= squares[i];
        let beside = || sides.windows(2).any(|w| within(to_edge(p, w)));
        (within(d) || beside()).then_some(i)
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

/// Square of the distance of a point from an edge.
pub(super) fn to_edge(p: Point, w: &[Point]) -> f64 {
    let v = w[1] - w[0];
    let u = ((p - w[0]).dot(v) / v.hypot2().max(1e-12)).clamp(0.0, 1.0);
    (w[0] + v * u).distance_squared(p)
}
