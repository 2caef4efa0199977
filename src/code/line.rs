//! The polyline that a piece of curve is measured by.

use super::tube::Tube;
use crate::numeric::qbc::Pull;
use kurbo::Point;

/// Chords of the polyline.
pub(super) const LOOK: usize = 16;

/// Points of a piece in the order that they are looked at: the middle is the likeliest to be too far.
const ORDER: [usize; LOOK + 1] = [8, 4, 12, 2, 6, 10, 14, 1, 3, 5, 7, 9, 11, 13, 15, 0, LOOK];

/// Weights of a piece's beginning, vertex and end at the points of its polyline; of edges one end and the other.
#[derive(Debug)]
pub(super) struct Weights {
    pub(super) of: [[f64; LOOK + 1]; 3],
}

/// Points of a polyline by axis, and the vectors of its chords.
#[derive(Debug)]
pub(super) struct Line {
    x: [f64; LOOK + 1],
    y: [f64; LOOK + 1],
    dx: [f64; LOOK],
    dy: [f64; LOOK],
}

impl Weights {
    /// Of a curve; of a straight edge without one.
    pub(super) fn new(pull: Option<Pull>) -> Self {
        let at = |k: usize| {
            let u = k as f64 / LOOK as f64;
            pull.map_or([1.0 - u, 0.0, u], |pull| pull.quadratic(u))
        };
        let of = std::array::from_fn(|i| std::array::from_fn(|k| at(k)[i]));
        Self { of }
    }

    /// One point of a piece.
    pub(super) fn dot(&self, [p, q, r]: [Point; 3], k: usize) -> Point {
        let [x, y, z] = [self.of[0][k], self.of[1][k], self.of[2][k]];
        Point::new(p.x * x + q.x * y + r.x * z, p.y * x + q.y * y + r.y * z)
    }

    /// All of them.
    #[inline]
    pub(super) fn line(&self, [p, q, r]: [Point; 3]) -> Line {
        let [a, b, c] = &self.of;
        let mut line = Line {
            x: [0.0; LOOK + 1],
            y: [0.0; LOOK + 1],
            dx: [0.0; LOOK],
            dy: [0.0; LOOK],
        };
        for k in 0..=LOOK {
            line.x[k] = p.x * a[k] + q.x * b[k] + r.x * c[k];
            line.y[k] = p.y * a[k] + q.y * b[k] + r.y * c[k];
        }
        for k in 0..LOOK {
            line.dx[k] = line.x[k + 1] - line.x[k];
            line.dy[k] = line.y[k + 1] - line.y[k];
        }
        line
    }

    /// Whether a point of each piece with legs as far from these as the discs around them allow lies outside.
    pub(super) fn miss(&self, tube: &Tube, legs: [Point; 3], [first, last]: [f64; 2]) -> bool {
        let [a, _, c] = &self.of;
        ORDER
            .into_iter()
            .any(|k| tube.misses(self.dot(legs, k), a[k] * first + c[k] * last))
    }

    /// The first point of a piece that does not lie in the tube's part along the boundary from one point to another.
    pub(super) fn outside(
        &self,
        tube: &Tube,
        boundary: &[Point],
        legs: [Point; 3],
        feet: (usize, usize),
    ) -> Option<usize> {
        let holds = |k: usize| tube.holds(boundary, self.dot(legs, k), feet);
        ORDER.into_iter().find(|&k| !holds(k))
    }
}

impl Line {
    /// The first of every so many points from one to another that it does not come as near to as they ask for, each
    /// with the square of its limit.
    pub(super) fn missed(
        &self,
        (first, last, every): (usize, usize, usize),
        limit: impl Fn(usize) -> (Point, f64),
    ) -> Option<usize> {
        // the chord that the last point was close to is likely the next one's too
        let (mut i, mut chord) = (first, 0);
        while i <= last {
            let asked = limit(i);
            if !self.close(asked, chord) {
                let others = (chord + 1..LOOK).chain(0..chord);
                let Some(other) = { others }.find(|&k| self.close(asked, k)) else {
                    return Some(i);
                };
                chord = other;
            }
            i += every;
        }
        None
    }

    /// Whether a point is farther from all chords than the root of a limit.
    #[inline]
    pub(super) fn far(&self, asked: (Point, f64)) -> bool {
        let mut close = false;
        for k in 0..LOOK {
            close |= self.close(asked, k);
        }
        !close
    }

    /// Whether the square of a point's distance from a chord is within a limit; both times the chord's squared
    /// length.
    #[inline]
    fn close(&self, (p, limit): (Point, f64), k: usize) -> bool {
        let (px, py) = (p.x - self.x[k], p.y - self.y[k]);
        let (dx, dy) = (self.dx[k], self.dy[k]);
        let square = dx * dx + dy * dy + 1e-12;
        let along = px * dx + py * dy;
        let foot = along.clamp(0.0, square);
        (px * px + py * py) * square + foot * (foot - 2.0 * along) <= limit * square
    }
}
