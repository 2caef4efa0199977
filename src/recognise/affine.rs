//! The affine map that takes points to points, by weighted least squares.

/// x' = m0 x + m1 y + m2, y' = m3 x + m4 y + m5.
pub(crate) type Map = [f32; 6];

/// The map that leaves everything where it is.
pub(crate) const STAY: Map = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0];

/// Sums over pairs of points.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Sums {
    normal: [[f32; 3]; 3],
    right: [[f32; 3]; 2],
}

impl Sums {
    /// Counts a pair: `from` should be taken to `to`.
    pub(crate) fn add(&mut self, from: [f32; 2], to: [f32; 2], weight: f32) {
        let row = [from[0], from[1], 1.0];
        for i in 0..3 {
            for j in 0..3 {
                self.normal[i][j] += weight * row[i] * row[j];
            }
            self.right[0][i] += weight * row[i] * to[0];
            self.right[1][i] += weight * row[i] * to[1];
        }
    }

    /// The best map, drawn towards [`STAY`] by `stiff` of its matrix and of its shift; both above 0, so that
    /// the points of a straight line have one too.
    pub(crate) fn map(mut self, stiff: (f32, f32)) -> Map {
        for (i, row) in self.normal.iter_mut().enumerate() {
            row[i] += if i < 2 { stiff.0 } else { stiff.1 };
        }
        self.right[0][0] += stiff.0;
        self.right[1][1] += stiff.0;
        let [x, y] = self.right.map(|r| solve(self.normal, r));
        [x[0], x[1], x[2], y[0], y[1], y[2]]
    }
}

/// A symmetric, positive definite 3 × 3 system: elimination without pivots.
fn solve(mut m: [[f32; 3]; 3], mut r: [f32; 3]) -> [f32; 3] {
    for i in 0..3 {
        for j in i + 1..3 {
            let (f, pivot) = (m[j][i] / m[i][i], m[i]);
            m[j].iter_mut().zip(pivot).for_each(|(v, p)| *v -= f * p);
            r[j] -= f * r[i];
        }
    }
    for i in (0..3).rev() {
        for k in i + 1..3 {
            r[i] -= m[i][k] * r[k];
        }
        r[i] /= m[i][i];
    }
    r
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_map_is_found_again() {
        let truth: Map = [1.2, 0.3, -0.1, 0.1, 0.8, 0.2];
        let mut sums = Sums::default();
        for p in [[0.0, 0.0], [1.0, 0.2], [-0.3, 1.0], [0.5, -0.7_f32]] {
            let x = truth[0] * p[0] + truth[1] * p[1] + truth[2];
            sums.add(p, [x, truth[3] * p[0] + truth[4] * p[1] + truth[5]], 1.0);
        }
        for (a, b) in sums.map((1e-6, 1e-6)).iter().zip(truth) {
            assert!((a - b).abs() < 1e-3, "{a} for {b}");
        }
        let free = Sums::default().map((1.0, 1.0));
        assert!(free.iter().zip(STAY).all(|(a, b)| (a - b).abs() < 1e-6));
    }
}
