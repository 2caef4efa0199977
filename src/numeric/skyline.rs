//! Symmetric positive definite systems whose rows begin late: envelope Cholesky.
//!
//! A closed chain of nodes gives a banded matrix with a few long last rows. Nothing outside the envelope
//! ever fills in, so the work is the sum of squared row lengths: linear in the number of nodes.

/// The lower half of a symmetric matrix; row `i` is stored from its first possible nonzero to the diagonal.
#[derive(Debug, Clone, Default)]
pub struct Skyline {
    first: Vec<usize>,
    start: Vec<usize>,
    values: Vec<f64>,
    factor: Vec<f64>,
    /// Column of each row's first number that is not zero: nor has its factor one before it.
    begins: Vec<usize>,
}

impl Skyline {
    /// Makes it a zero matrix with row `i` beginning at column `first[i]`, at most `i`. Memory is used again.
    pub fn reset(&mut self, first: &[usize]) {
        self.first.clear();
        self.start.clear();
        let mut at = 0;
        for (i, &f) in first.iter().enumerate() {
            self.first.push(f.min(i));
            self.start.push(at);
            at += i - f.min(i) + 1;
        }
        self.values.clear();
        self.values.resize(at, 0.0);
    }

    /// Number of rows.
    const fn len(&self) -> usize {
        self.first.len()
    }

    /// Adds `value` at row `i`, column `j`, and its mirror image. What lies outside the envelope is passed over.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let (i, j) = if i < j { (j, i) } else { (i, j) };
        if i < self.len() && j >= self.first[i] {
            self.values[self.start[i] + j - self.first[i]] += value;
        }
    }

    /// Adds `by` times `values`, those of the columns from `column` on, to row `i` up to its diagonal. What lies
    /// outside the envelope is passed over.
    pub fn add_row(&mut self, i: usize, (column, values): (usize, &[f64]), by: f64) {
        if i < self.len() && column <= i {
            let first = self.first[i];
            let from = first.max(column);
            let row = &mut self.values[self.start[i]..=self.start[i] + i - first];
            let pairs = row[from - first..].iter_mut();
            let pairs = pairs.zip(values.iter().skip(from - column));
            pairs.for_each(|(to, v)| *to += by * v);
        }
    }

    fn row<'a>(&self, of: &'a [f64], i: usize) -> &'a [f64] {
        &of[self.start[i]..=self.start[i] + i - self.first[i]]
    }

    /// Solves (A + λ diag A) x = `rhs` in place. `false`, and `rhs` is spoilt, where that matrix is
    /// not positive definite.
    pub fn solve_damped(&mut self, lambda: f64, rhs: &mut [f64]) -> bool {
        self.factorise(lambda) && self.substitute(rhs)
    }

    /// A + λ diag A = L Lᵀ.
    fn factorise(&mut self, lambda: f64) -> bool {
        let mut factor = std::mem::take(&mut self.factor);
        factor.clone_from(&self.values);
        self.begins.clear();
        let mut sound = true;
        for i in 0..self.len() {
            let (done, rest) = factor.split_at_mut(self.start[i]);
            let fi = self.first[i];
            let zeros = rest[..i - fi].iter().take_while(|v| **v == 0.0).count();
            self.begins.push(fi + zeros);
            for j in fi + zeros..i {
                let fj = self.first[j];
                let from = self.begins[i].max(self.begins[j]);
                let lj = &done[self.start[j]..=self.start[j] + j - fj];
                let dot = dot(&rest[from - fi..j - fi], &lj[from - fj..j - fj]);
                rest[j - fi] = (rest[j - fi] - dot) / lj[j - fj];
            }
            let diagonal = rest[i - fi] * (1.0 + lambda);
            let row = &rest[zeros..i - fi];
            let pivot = diagonal - dot(row, row);
            // A relative bound: rounding leaves about 1e-16 of the diagonal in a singular pivot.
            if pivot > 1e-13 * diagonal {
                rest[i - fi] = pivot.sqrt();
            } else {
                sound = false;
                break;
            }
        }
        self.factor = factor;
        sound
    }

    fn substitute(&self, rhs: &mut [f64]) -> bool {
        let n = self.len();
        if rhs.len() != n {
            return false;
        }
        for i in 0..n {
            let row = self.row(&self.factor, i);
            let f = self.first[i];
            rhs[i] = (rhs[i] - dot(&row[..i - f], &rhs[f..i])) / row[i - f];
        }
        for i in (0..n).rev() {
            let row = self.row(&self.factor, i);
            let f = self.first[i];
            rhs[i] /= row[i - f];
            let x = rhs[i];
            for (r, l) in rhs[f..i].iter_mut().zip(row) {
                *r -= l * x;
            }
        }
        true
    }
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bordered_band_is_solved() {
        // A cyclic second difference: tridiagonal, with a corner that makes the last row long.
        let n = 9;
        let first: Vec<usize> = (0..n)
            .map(|i: usize| if i + 1 == n { 0 } else { i.saturating_sub(1) })
            .collect();
        let mut a = Skyline::default();
        for _ in 0..2 {
            a.reset(&first);
            for i in 0..n {
                a.add(i, i, 2.5);
                a.add(i, (i + 1) % n, -1.0);
            }
            let want: Vec<f64> = (0..n).map(|i| libm::sin(i as f64)).collect();
            let damped = |i: usize| 2.5 * 1.1 * want[i] - want[(i + 1) % n] - want[(i + n - 1) % n];
            let mut x: Vec<f64> = (0..n).map(damped).collect();
            assert!(a.solve_damped(0.1, &mut x));
            for (x, w) in x.iter().zip(&want) {
                assert!((x - w).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn a_row_is_its_values_one_by_one() {
        let first = [0, 0, 1, 1];
        let values = [1.0, -2.0, 3.0, 5.0];
        let (mut rows, mut each) = (Skyline::default(), Skyline::default());
        rows.reset(&first);
        each.reset(&first);
        for i in 0..5 {
            rows.add_row(i, (0, &values), 0.5);
            (0..=i.min(3)).for_each(|j| each.add(i, j, 0.5 * values[j]));
        }
        assert_eq!(rows.values, each.values);
        for i in 0..4 {
            rows.add_row(i, (2, &values[2..]), 0.5);
            (2..=i).for_each(|j| each.add(i, j, 0.5 * values[j]));
        }
        assert_eq!(rows.values, each.values);
    }

    #[test]
    fn a_singular_matrix_is_refused() {
        let mut a = Skyline::default();
        a.reset(&[0, 0]);
        for (i, j) in [(0, 0), (0, 1), (1, 1)] {
            a.add(i, j, 1.0);
        }
        assert!(!a.solve_damped(0.0, &mut [1.0, 1.0]));
        assert!(a.solve_damped(1e-3, &mut [1.0, 1.0]));
    }
}
