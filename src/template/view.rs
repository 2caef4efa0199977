//! Where every millimetre of a page lies in its picture: a plane seen in perspective.

use kurbo::{Affine, Point, Vec2};
use nalgebra::{SMatrix, SVector};

/// A projective map from page mm to picture px, both y down.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// Row-major 3 × 3 without its last entry, which is 1.
    h: [f64; 8],
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
        let h: [f64; 8] = solution.into();
        h.iter().all(|v| v.is_finite()).then_some(Self { h })
    }

    /// Page mm → picture px.
    #[must_use]
    pub fn at(&self, p: Point) -> Point {
        let h = &self.h;
        let w = h[6] * p.x + h[7] * p.y + 1.0;
        let x = h[0] * p.x + h[1] * p.y + h[2];
        let y = h[3] * p.x + h[4] * p.y + h[5];
        Point::new(x / w, y / w)
    }

    /// The affine map that it is near one point of the page, mm → px.
    #[must_use]
    pub fn near(&self, p: Point) -> Affine {
        let h = &self.h;
        let w = h[6] * p.x + h[7] * p.y + 1.0;
        let q = self.at(p);
        let dx = Vec2::new(h[0] - q.x * h[6], h[3] - q.y * h[6]) / w;
        let dy = Vec2::new(h[1] - q.x * h[7], h[4] - q.y * h[7]) / w;
        let origin = q.to_vec2() - dx * p.x - dy * p.y;
        Affine::new([dx.x, dx.y, dy.x, dy.y, origin.x, origin.y])
    }

    /// Pixels a millimetre near one point of the page.
    #[must_use]
    pub fn scale(&self, p: Point) -> f64 {
        self.near(p).determinant().abs().sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
