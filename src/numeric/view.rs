//! Where every point of a plane lies in its picture: the plane seen in perspective.

use kurbo::{Affine, Point, Rect, Vec2};
use nalgebra::{SMatrix, SVector};
use std::ops::Mul;

/// A projective map of the plane: page to picture, picture to upright page. The axes of both run alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Row-major 3 × 3.
    h: [f64; 9],
}

impl View {
    /// The map that takes each point of `page` to the one of `picture`; `None` where three lie on a line.
    #[must_use]
    pub fn through(page: [Point; 4], picture: [Point; 4]) -> Option<Self> {
        let mut a = SMatrix::<f64, 8, 8>::zeros();
        let mut b = SVector::<f64, 8>::zeros();
        for (i, (p, q)) in page.iter().zip(&picture).enumerate() {
            let rows = [
                ([p.x, p.y, 1.0, 0.0, 0.0, 0.0, -p.x * q.x, -p.y * q.x], q.x),
                ([0.0, 0.0, 0.0, p.x, p.y, 1.0, -p.x * q.y, -p.y * q.y], q.y),
            ];
            for (k, (row, right)) in rows.into_iter().enumerate() {
                a.row_mut(2 * i + k).copy_from_slice(&row);
                b[2 * i + k] = right;
            }
        }
        let solution = a.full_piv_lu().solve(&b)?;
        let mut h = [1.0; 9];
        h[..8].copy_from_slice(solution.as_slice());
        h.iter().all(|v| v.is_finite()).then_some(Self { h })
    }

    /// The map (x, y) → (a x + b y, c x + d y) / (1 + e x + f y) for `[a, b, c, d, e, f]`.
    #[must_use]
    pub const fn of_pencils([a, b, c, d, e, f]: [f64; 6]) -> Self {
        Self {
            h: [a, b, 0.0, c, d, 0.0, e, f, 1.0],
        }
    }

    /// Where a point goes.
    #[must_use]
    pub fn at(&self, p: Point) -> Point {
        let h = &self.h;
        let w = h[6] * p.x + h[7] * p.y + h[8];
        let x = h[0] * p.x + h[1] * p.y + h[2];
        let y = h[3] * p.x + h[4] * p.y + h[5];
        Point::new(x / w, y / w)
    }

    /// The affine map that it is near one point.
    #[must_use]
    pub fn near(&self, p: Point) -> Affine {
        let h = &self.h;
        let w = h[6] * p.x + h[7] * p.y + h[8];
        let q = self.at(p);
        let dx = Vec2::new(h[0] - q.x * h[6], h[3] - q.y * h[6]) / w;
        let dy = Vec2::new(h[1] - q.x * h[7], h[4] - q.y * h[7]) / w;
        let origin = q.to_vec2() - dx * p.x - dy * p.y;
        Affine::new([dx.x, dx.y, dy.x, dy.y, origin.x, origin.y])
    }

    /// How much longer small distances near one point become.
    #[must_use]
    pub fn scale(&self, p: Point) -> f64 {
        self.near(p).determinant().abs().sqrt()
    }

    /// The map back.
    #[must_use]
    pub const fn inverse(&self) -> Self {
        let [a, b, c, d, e, f, g, h, i] = self.h;
        Self {
            h: [
                e * i - f * h,
                c * h - b * i,
                b * f - c * e,
                f * g - d * i,
                a * i - c * g,
                c * d - a * f,
                d * h - e * g,
                b * g - a * h,
                a * e - b * d,
            ],
        }
    }

    /// The map itself, where it is affine.
    #[must_use]
    pub fn affine(&self) -> Option<Affine> {
        let [a, b, c, d, e, f, g, h, i] = self.h;
        let flat = g.abs() + h.abs() < 1e-15 * i.abs();
        flat.then(|| Affine::new([a / i, d / i, b / i, e / i, c / i, f / i]))
    }

    /// The rectangle around a rectangle's image.
    #[must_use]
    pub fn bounds(&self, r: Rect) -> Rect {
        bounds(r, |p| self.at(p))
    }
}

/// The rectangle around where a rectangle's corners go.
pub fn bounds(r: Rect, at: impl Fn(Point) -> Point) -> Rect {
    let corners = [(r.x0, r.y0), (r.x1, r.y0), (r.x1, r.y1), (r.x0, r.y1)];
    let seen = corners.map(|c| at(c.into()));
    seen.iter()
        .fold(Rect::from_points(seen[0], seen[2]), |b, &p| b.union_pt(p))
}

impl From<Affine> for View {
    fn from(map: Affine) -> Self {
        let [a, b, c, d, e, f] = map.as_coeffs();
        Self {
            h: [a, c, e, b, d, f, 0.0, 0.0, 1.0],
        }
    }
}

impl Mul for View {
    type Output = Self;

    /// First `then`, then `self`, as with [`Affine`].
    fn mul(self, then: Self) -> Self {
        let entry = |k: usize| {
            (0..3)
                .map(|j| self.h[k / 3 * 3 + j] * then.h[3 * j + k % 3])
                .sum()
        };
        Self {
            h: std::array::from_fn(entry),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::angles;

    #[test]
    fn it_goes_through_its_points_and_its_tangent_touches() {
        let page = [(0.0, 0.0), (200.0, 0.0), (200.0, 280.0), (0.0, 280.0)].map(Point::from);
        let picture = [
            (31.0, 17.0),
            (1500.0, 90.0),
            (1430.0, 2200.0),
            (90.0, 2100.0),
        ]
        .map(Point::from);
        let view = View::through(page, picture).unwrap();
        for (p, q) in page.iter().zip(picture) {
            assert!(view.at(*p).distance(q) < 1e-8);
        }
        let (p, d) = (Point::new(120.0, 70.0), Vec2::new(1e-4, -2e-4));
        let tangent = view.near(p);
        assert!((tangent * p).distance(view.at(p)) < 1e-9);
        assert!((tangent * (p + d)).distance(view.at(p + d)) < 1e-7);
    }

    #[test]
    fn three_points_on_a_line_show_nothing() {
        let line = [(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (0.0, 1.0)].map(Point::from);
        let square = [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)].map(Point::from);
        assert_eq!(View::through(line, square), None);
    }

    #[test]
    fn there_and_back_is_where_one_was() {
        let view = View::of_pencils([1.1, 0.05, -0.03, 0.97, 2e-4, -1e-4]);
        let both = view.inverse() * view;
        let turned = view * View::from(angles::rotation(0.2));
        for (x, y) in [(0.0, 0.0), (300.0, -120.0), (-410.0, 77.0)] {
            let p = Point::new(x, y);
            assert!(view.inverse().at(view.at(p)).distance(p) < 1e-9);
            assert!(both.at(p).distance(p) < 1e-9);
            assert!(turned.at(p).distance(view.at(angles::rotation(0.2) * p)) < 1e-9);
        }
        let flat = View::from(Affine::new([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]));
        assert_eq!(
            flat.affine().map(Affine::as_coeffs),
            Some([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
        );
        assert_eq!(view.affine(), None);
    }
}
