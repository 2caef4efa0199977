//! The weighted least squares problem itself: rows in, vertices out.

use crate::numeric::bspline::{Basis, Row};
use crate::numeric::skyline::Skyline;
use kurbo::Point;

/// One problem: find the vertices of a curve over `basis` for points at given parameters.
#[derive(Debug)]
pub(in crate::fit) struct Problem<'a> {
    pub points: &'a [Point],
    pub basis: &'a Basis,
    /// Parameters U of the points; they increase.
    pub at: &'a [f64],
    /// Weights of the second derivative, x and y.
    pub mu: (f64, f64),
    pub ends: Ends,
}

/// What the outer vertices do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::fit) enum Ends {
    /// They stay here where a point is given, and are free otherwise.
    Held(Option<Point>, Option<Point>),
    /// The curve closes over so many vertices.
    Periodic(usize),
}

/// Parts of the diagonal that are added one after the other until a system with too few points in a place
/// becomes solvable; the first is none.
const DAMPING: [f64; 3] = [0.0, 1e-9, 1e-5];

impl Problem<'_> {
    /// The vertices that minimise eq. 26; `None` when even the damped system has no solution.
    pub(in crate::fit) fn vertices(&self) -> Option<Vec<Point>> {
        let rows: Vec<(Row, Row)> = self
            .at
            .iter()
            .map(|&u| (self.basis.row(u, 0), self.basis.row(u, 2)))
            .collect();
        let x = self.coordinate(&rows, |p| p.x, self.mu.0)?;
        let y = self.coordinate(&rows, |p| p.y, self.mu.1)?;
        Some(x.into_iter().zip(y).map(Point::from).collect())
    }

    /// The unknown that vertex `j` is, or the place where it is held.
    fn unknown(&self, j: usize) -> Result<usize, Point> {
        match self.ends {
            Ends::Periodic(count) => Ok(j % count),
            Ends::Held(Some(p), _) if j == 0 => Err(p),
            Ends::Held(_, Some(p)) if j + 1 == self.basis.count() => Err(p),
            Ends::Held(first, _) => Ok(j - usize::from(first.is_some())),
        }
    }

    fn unknowns(&self) -> usize {
        match self.ends {
            Ends::Periodic(count) => count,
            Ends::Held(a, b) => {
                self.basis.count() - usize::from(a.is_some()) - usize::from(b.is_some())
            }
        }
    }

    /// The normal equations of eq. 38 for one coordinate, solved by Cholesky.
    fn coordinate(
        &self,
        rows: &[(Row, Row)],
        part: impl Fn(Point) -> f64,
        mu: f64,
    ) -> Option<Vec<f64>> {
        let n = self.unknowns();
        let k = self.basis.order();
        let first = |i: usize| match self.ends {
            // the last rows of a ring meet the first columns
            Ends::Periodic(_) if i + k > n => 0,
            _ => (i + 1).saturating_sub(k),
        };
        let mut matrix = Skyline::default();
        matrix.reset(&(0..n).map(first).collect::<Vec<_>>());
        let mut right = vec![0.0; n];
        for ((b, b2), &p) in rows.iter().zip(self.points) {
            let pairs: Vec<(f64, f64)> = b
                .values
                .iter()
                .copied()
                .zip(b2.values.iter().copied())
                .collect();
            for (i, &(v, v2)) in pairs.iter().enumerate() {
                let Ok(row) = self.unknown(b.first + i) else {
                    continue;
                };
                right[row] += v * part(p);
                for (j, &(w, w2)) in pairs.iter().enumerate() {
                    let entry = v * w + mu * v2 * w2;
                    match self.unknown(b.first + j) {
                        // the matrix takes both halves at once, and a ring's wrapped pair twice
                        Ok(column) if column < row || i == j => matrix.add(row, column, entry),
                        Ok(column) if column == row => matrix.add(row, column, entry),
                        Ok(_) => {}
                        Err(held) => right[row] -= entry * part(held),
                    }
                }
            }
        }
        let solved = DAMPING.iter().find_map(|&d| {
            let mut x = right.clone();
            (matrix.solve_damped(d, &mut x) && x.iter().all(|v| v.is_finite())).then_some(x)
        })?;
        let count = match self.ends {
            Ends::Periodic(count) => count,
            Ends::Held(..) => self.basis.count(),
        };
        let value = |j: usize| match self.unknown(j) {
            Ok(i) => solved[i],
            Err(held) => part(held),
        };
        Some((0..count).map(value).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    fn data() -> (Vec<Point>, Vec<f64>) {
        let at: Vec<f64> = (0..60).map(|i| 3.0 + f64::from(i) * 6.0 / 59.0).collect();
        let noise = |u: f64| 0.2 * libm::sin(37.0 * u);
        let points = at
            .iter()
            .map(|&u| Point::new(4.0 * u + noise(u), 9.0 * libm::sin(u - noise(u))));
        (points.collect(), at)
    }

    /// [samavati98 eq. 40]: the stacked matrix by orthogonal factors.
    #[test]
    fn cholesky_and_stacked_orthogonal_factors_agree() {
        let (points, at) = data();
        let basis = Basis::clamped(4, 9).unwrap();
        let mu = (0.3, 0.02);
        let problem = Problem {
            points: &points,
            basis: &basis,
            at: &at,
            mu,
            ends: Ends::Held(None, None),
        };
        let got = problem.vertices().unwrap();
        for (mu, part) in [(mu.0, 0), (mu.1, 1)] {
            let n = points.len();
            let stacked = DMatrix::from_fn(2 * n, 9, |i, j| {
                let (derivative, weight) = if i < n { (0, 1.0) } else { (2, mu.sqrt()) };
                let row = basis.row(at[i % n], derivative);
                let v = j.checked_sub(row.first).and_then(|j| row.values.get(j));
                v.map_or(0.0, |v| v * weight)
            });
            let of = |p: Point| if part == 0 { p.x } else { p.y };
            let right = DVector::from_fn(2 * n, |i, _| points.get(i).map_or(0.0, |&p| of(p)));
            let qr = stacked.qr();
            let want = qr
                .r()
                .solve_upper_triangular(&(qr.q().transpose() * right))
                .unwrap();
            for (g, w) in got.iter().zip(want.iter()) {
                assert!((of(*g) - w).abs() < 1e-9, "{g:?} {w}");
            }
        }
    }

    #[test]
    fn held_ends_stay_and_rings_close() {
        let (points, at) = data();
        let basis = Basis::clamped(4, 9).unwrap();
        let (a, b) = (Point::new(9.0, 9.0), Point::new(-1.0, 2.0));
        let mut problem = Problem {
            points: &points,
            basis: &basis,
            at: &at,
            mu: (0.1, 0.1),
            ends: Ends::Held(Some(a), Some(b)),
        };
        let v = problem.vertices().unwrap();
        assert_eq!((v[0], v[8]), (a, b));
        let ring = Basis::uniform(4, 9).unwrap();
        problem.basis = &ring;
        problem.ends = Ends::Periodic(6);
        assert_eq!(problem.vertices().unwrap().len(), 6);
    }
}
