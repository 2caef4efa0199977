//! B-splines of any order: basis, derivatives, and the way to Bézier curves by blossoms.

use kurbo::{CubicBez, Point};

/// The B-splines of one order over one row of knots, as in [samavati98 eq. 3-4].
#[derive(Debug, Clone, PartialEq)]
pub struct Basis {
    order: usize,
    knots: Vec<f64>,
}

/// The basis functions that are not zero at one parameter: `order` of them from index `first` on.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Index of the first.
    pub first: usize,
    /// Their values, or those of a derivative.
    pub values: Vec<f64>,
}

impl Basis {
    /// `count` functions of `order` k over knots 1 apart with both ends repeated k times, so that a curve
    /// starts and ends at its outer vertices; domain k-1 … count [samavati98 eq. 16].
    /// `None` unless 1 ≤ k ≤ count.
    #[must_use]
    pub fn clamped(order: usize, count: usize) -> Option<Self> {
        let knot = |j: usize| j.clamp(order - 1, count) as f64;
        (order >= 1 && count >= order).then(|| Self {
            order,
            knots: (0..count + order).map(knot).collect(),
        })
    }

    /// `count` functions of `order` k over the integers from 0; domain k-1 … count. A periodic curve of
    /// n vertices uses count = n + k - 1 and vertex j mod n. `None` unless 1 ≤ k ≤ count.
    #[must_use]
    pub fn uniform(order: usize, count: usize) -> Option<Self> {
        (order >= 1 && count >= order).then(|| Self {
            order,
            knots: (0..count + order).map(|j| j as f64).collect(),
        })
    }

    /// Degree + 1.
    #[must_use]
    pub const fn order(&self) -> usize {
        self.order
    }

    /// Number of functions, and of a curve's vertices.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.knots.len() - self.order
    }

    /// Where the functions sum to one.
    #[must_use]
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.order - 1], self.knots[self.count()])
    }

    /// The knot interval of `u`, from order-1 to count-1; what lies outside belongs to the outer ones.
    fn interval(&self, u: f64) -> usize {
        let after = self.knots.partition_point(|&t| t <= u);
        let s = after.clamp(self.order, self.count()) - 1;
        // the last interval with a length, where knots are repeated
        (self.order - 1..=s)
            .rev()
            .find(|&s| self.knots[s] < self.knots[s + 1])
            .unwrap_or(s)
    }

    /// Values of the functions at `u`, or of their derivative of that rank.
    #[must_use]
    pub fn row(&self, u: f64, derivative: usize) -> Row {
        let s = self.interval(u);
        let first = s + 1 - self.order;
        if derivative >= self.order {
            let values = vec![0.0; self.order];
            return Row { first, values };
        }
        let mut values = vec![1.0];
        for q in 2..=self.order {
            // order q-1 to order q; function j of order q-1 starts at s + 2 - q
            let start = s + 1 - q;
            let differ = q > self.order - derivative;
            let old = |j: usize| {
                j.checked_sub(1)
                    .and_then(|j| values.get(j))
                    .map_or(0.0, |v| *v)
            };
            let part = |i: usize, v: f64| {
                let width = self.knots[i + q - 1] - self.knots[i];
                if width > 0.0 { v / width } else { 0.0 }
            };
            let next = (0..q).map(|j| {
                let i = start + j;
                let (a, b) = (part(i, old(j)), part(i + 1, old(j + 1)));
                if differ {
                    (q - 1) as f64 * (a - b)
                } else {
                    (u - self.knots[i]) * a + (self.knots[i + q] - u) * b
                }
            });
            values = next.collect();
        }
        Row { first, values }
    }

    /// The curve's point at `u`; missing vertices are the origin.
    #[must_use]
    pub fn eval(&self, control: &[Point], u: f64) -> Point {
        self.blossom(control, self.interval(u), |_| u)
    }

    /// The polynomial of interval `s` with a parameter of its own at each of the degree's levels.
    fn blossom(&self, control: &[Point], s: usize, at: impl Fn(usize) -> f64) -> Point {
        let degree = self.order - 1;
        let vertex = |j: usize| control.get(j).copied().unwrap_or_default();
        let mut d: Vec<Point> = (s - degree..=s).map(vertex).collect();
        for r in 1..=degree {
            let t = at(r - 1);
            for j in (r..=degree).rev() {
                let i = s + j - degree;
                let (a, b) = (self.knots[i], self.knots[i + self.order - r]);
                d[j] = d[j - 1].lerp(d[j], (t - a) / (b - a));
            }
        }
        d[degree]
    }

    /// The Bézier points of every knot interval with a length, degree + 1 each.
    fn beziers(&self, control: &[Point]) -> impl Iterator<Item = Vec<Point>> {
        let long = move |s: &usize| self.knots[*s] < self.knots[s + 1];
        (self.order - 1..self.count()).filter(long).map(move |s| {
            let (a, b) = (self.knots[s], self.knots[s + 1]);
            let point = |j: usize| self.blossom(control, s, |r| if r < j { b } else { a });
            (0..self.order).map(point).collect()
        })
    }

    /// The curve as cubics: exact up to order 4; above, no further than `within` from it.
    #[must_use]
    pub fn cubics(&self, control: &[Point], within: f64) -> Vec<CubicBez> {
        let mut out = Vec::new();
        for bezier in self.beziers(control) {
            push_cubics(bezier, within, HALVINGS, &mut out);
        }
        out
    }
}

/// How often a piece of higher degree is halved at most: each halving divides the error by 16.
const HALVINGS: u32 = 12;

fn push_cubics(mut b: Vec<Point>, within: f64, halvings: u32, out: &mut Vec<CubicBez>) {
    while b.len() < 4 {
        b = elevated(&b);
    }
    let n = b.len() - 1;
    let reach = n as f64 / 3.0;
    let cubic = [
        b[0],
        b[0] + (b[1] - b[0]) * reach,
        b[n] + (b[n - 1] - b[n]) * reach,
        b[n],
    ];
    let mut raised = cubic.to_vec();
    while raised.len() < b.len() {
        raised = elevated(&raised);
    }
    // two Bézier curves lie no further apart than their points do
    let apart = raised.iter().zip(&b).map(|(p, q)| p.distance(*q));
    if halvings == 0 || apart.fold(0.0, f64::max) <= within {
        out.push(CubicBez::new(cubic[0], cubic[1], cubic[2], cubic[3]));
        return;
    }
    let (left, right) = halved(b);
    push_cubics(left, within, halvings - 1, out);
    push_cubics(right, within, halvings - 1, out);
}

/// The same curve with one Bézier point more.
fn elevated(b: &[Point]) -> Vec<Point> {
    let n = b.len() as f64;
    let inner = b
        .windows(2)
        .zip(1..)
        .map(|(w, j)| w[1].lerp(w[0], f64::from(j) / n));
    let ends = (b.first(), b.last());
    ends.0
        .copied()
        .into_iter()
        .chain(inner)
        .chain(ends.1.copied())
        .collect()
}

/// De Casteljau at the middle.
fn halved(mut b: Vec<Point>) -> (Vec<Point>, Vec<Point>) {
    let (mut left, mut right) = (Vec::new(), Vec::new());
    while let (Some(&a), Some(&z)) = (b.first(), b.last()) {
        left.push(a);
        right.push(z);
        b = b.windows(2).map(|w| w[0].midpoint(w[1])).collect();
    }
    right.reverse();
    (left, right)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{ParamCurve, ParamCurveDeriv};

    fn wild(count: usize) -> Vec<Point> {
        let at = |j: usize| Point::new(3.0 * j as f64, (j * j % 7) as f64);
        (0..count).map(at).collect()
    }

    #[test]
    fn functions_sum_to_one_and_derivatives_to_zero() {
        for order in 1..=6 {
            for basis in [Basis::clamped(order, 9), Basis::uniform(order, 9)] {
                let basis = basis.unwrap();
                let (a, b) = basis.domain();
                for i in 0..=40 {
                    let u = a + (b - a) * f64::from(i) / 40.0;
                    let sum = |d| basis.row(u, d).values.iter().sum::<f64>();
                    assert!((sum(0) - 1.0).abs() < 1e-12, "order {order} at {u}");
                    assert!(order == 1 || sum(1).abs() < 1e-12, "order {order} at {u}");
                    assert!(order <= 2 || sum(2).abs() < 1e-12, "order {order} at {u}");
                }
            }
        }
        assert!(Basis::clamped(4, 3).is_none() && Basis::clamped(0, 3).is_none());
    }

    #[test]
    fn the_uniform_cubic_is_one_four_one() {
        let row = Basis::uniform(4, 7).unwrap().row(4.0, 0);
        for (v, want) in row
            .values
            .iter()
            .zip([1.0 / 6.0, 2.0 / 3.0, 1.0 / 6.0, 0.0])
        {
            assert!((v - want).abs() < 1e-15);
        }
    }

    #[test]
    fn cubics_are_the_curve() {
        for order in 2..=7 {
            let basis = Basis::clamped(order, 10).unwrap();
            let control = wild(10);
            let cubics = basis.cubics(&control, 1e-6);
            let exact = order <= 4;
            assert!(!exact || cubics.len() == 11 - order, "a cubic an interval");
            let (a, b) = basis.domain();
            if exact {
                let step = (b - a) / cubics.len() as f64;
                for (i, c) in cubics.iter().enumerate() {
                    let u = a + (i as f64 + 0.3) * step;
                    assert!(c.eval(0.3).distance(basis.eval(&control, u)) < 1e-12);
                }
            }
            assert!(cubics[0].p0.distance(control[0]) < 1e-12);
            assert!(cubics.windows(2).all(|w| w[0].p3.distance(w[1].p0) < 1e-12));
        }
    }

    #[test]
    fn derivatives_agree_with_the_cubic() {
        let basis = Basis::clamped(4, 8).unwrap();
        let control = wild(8);
        let cubics = basis.cubics(&control, 0.0);
        let (a, _) = basis.domain();
        for (i, c) in cubics.iter().enumerate() {
            let row = basis.row(a + i as f64 + 0.25, 2);
            let sum = row.values.iter().zip(&control[row.first..]);
            let got = sum.fold(Point::ORIGIN, |s, (v, p)| s + p.to_vec2() * *v);
            assert!(got.distance(c.deriv().deriv().eval(0.25)) < 1e-11);
        }
    }
}
