//! Tridiagonal systems, also with the corners of a ring.

use kurbo::Vec2;

/// Rows of three coefficients, for the unknowns before, at and after the row's own place.
/// On a ring the first row's `below` meets the last unknown and the last row's `above` the first; else
/// those two are not looked at.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tridiagonal {
    /// Coefficients of the unknown before.
    pub below: Vec<f64>,
    /// Coefficients of the row's own unknown.
    pub diagonal: Vec<f64>,
    /// Coefficients of the unknown after.
    pub above: Vec<f64>,
}

impl Tridiagonal {
    /// Adds a row.
    pub fn push(&mut self, below: f64, diagonal: f64, above: f64) {
        self.below.push(below);
        self.diagonal.push(diagonal);
        self.above.push(above);
    }

    /// The solution of an open row, in O(n), with row exchanges; `None` when there is none.
    #[must_use]
    pub fn solve(&self, right: &[Vec2]) -> Option<Vec<Vec2>> {
        let n = self.diagonal.len();
        if right.len() != n || n == 0 {
            return None;
        }
        // after exchanges a row reaches two unknowns to the right: coefficients of x_i, x_{i+1}, x_{i+2}
        let mut done: Vec<([f64; 3], Vec2)> = Vec::with_capacity(n);
        let outer = |i: usize| if i + 1 < n { self.above[i] } else { 0.0 };
        let mut row = ([self.diagonal[0], outer(0), 0.0], right[0]);
        for i in 1..n {
            let mut next = ([self.below[i], self.diagonal[i], outer(i)], right[i]);
            if next.0[0].abs() > row.0[0].abs() {
                std::mem::swap(&mut row, &mut next);
            }
            let factor = next.0[0] / row.0[0];
            if !factor.is_finite() {
                return None;
            }
            let rest = [
                next.0[1] - factor * row.0[1],
                next.0[2] - factor * row.0[2],
                0.0,
            ];
            let right = next.1 - row.1 * factor;
            done.push(row);
            row = (rest, right);
        }
        done.push(row);
        let mut x = vec![Vec2::ZERO; n + 2];
        for (i, (c, r)) in done.iter().enumerate().rev() {
            x[i] = (*r - x[i + 1] * c[1] - x[i + 2] * c[2]) / c[0];
        }
        x.truncate(n);
        x.iter().all(|v| v.is_finite()).then_some(x)
    }

    /// The solution of a ring of at least three, by a correction of rank one (Sherman and Morrison).
    #[must_use]
    pub fn solve_ring(&self, right: &[Vec2]) -> Option<Vec<Vec2>> {
        let n = self.diagonal.len();
        if n < 3 || right.len() != n {
            return None;
        }
        let (corner, opposite) = (self.above[n - 1], self.below[0]);
        let gamma = -self.diagonal[0];
        let mut open = self.clone();
        open.diagonal[0] -= gamma;
        open.diagonal[n - 1] -= corner * opposite / gamma;
        let x = open.solve(right)?;
        let mut unit = vec![Vec2::ZERO; n];
        unit[0].x = gamma;
        unit[n - 1].x = corner;
        let z = open.solve(&unit)?;
        let ratio = opposite / gamma;
        let factor = (x[0] + x[n - 1] * ratio) / (1.0 + z[0].x + z[n - 1].x * ratio);
        let out: Vec<Vec2> = x.iter().zip(&z).map(|(x, z)| *x - factor * z.x).collect();
        out.iter().all(|v| v.is_finite()).then_some(out)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn solutions_satisfy_their_rows() {
        // the second has a zero on the diagonal: rows must be exchanged
        for middle in [4.0, 0.0] {
            let mut m = Tridiagonal::default();
            let n = 8;
            for i in 0..n {
                let d = if i == 3 { middle } else { 4.0 + f64::from(i) };
                m.push(1.0 + f64::from(i) * 0.1, d, 2.0 - f64::from(i) * 0.1);
            }
            let n = 8_usize;
            let right: Vec<Vec2> = (0..n)
                .map(|i| Vec2::new(i as f64, 1.0 - i as f64))
                .collect();
            for ring in [false, true] {
                let x = if ring {
                    m.solve_ring(&right)
                } else {
                    m.solve(&right)
                };
                let x = x.unwrap();
                for i in 0..n {
                    let inner = |k: bool| if ring || k { 1.0 } else { 0.0 };
                    let before = x[(i + n - 1) % n] * (m.below[i] * inner(i > 0));
                    let after = x[(i + 1) % n] * (m.above[i] * inner(i + 1 < n));
                    let sum = before + x[i] * m.diagonal[i] + after;
                    assert!((sum - right[i]).hypot() < 1e-12, "{ring} row {i}");
                }
            }
        }
    }

    #[test]
    fn what_has_no_solution_is_refused() {
        let mut m = Tridiagonal::default();
        assert!(m.solve(&[]).is_none());
        m.push(0.0, 0.0, 0.0);
        m.push(0.0, 0.0, 0.0);
        assert!(m.solve(&[Vec2::ZERO; 2]).is_none());
    }
}
