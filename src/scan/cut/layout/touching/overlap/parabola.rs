//! Points of an edge → the parabola on which it begins.

use kurbo::{Point, Vec2};
use nalgebra::{Matrix3, Vector3};

/// Points no farther from a parabola than so many px lie on it.
const STRAY: f64 = 0.35;
/// So many points at least tell of one.
const FEWEST: usize = 5;

/// The parabola of least squares through points one step apart.
pub(super) struct Parabola {
    /// Where it is at the first of them.
    pub(super) at: Point,
    /// Its first derivative there, px a step, and its second.
    slope: Vec2,
    bend: Vec2,
}

impl Parabola {
    /// Through as many of some points, from the first on, as lie on one; none where that is too few.
    pub(super) fn beginning(points: &[Point]) -> Option<Self> {
        let mut length = points.len();
        while length >= FEWEST {
            let seen = &points[..length];
            let fitted = Self::through(seen)?;
            let off = |(i, p): (usize, &Point)| p.distance(fitted.place(i as f64));
            if seen.iter().enumerate().map(off).all(|d| d < STRAY) {
                return Some(fitted);
            }
            length = length * 3 / 4;
        }
        None
    }

    fn through(points: &[Point]) -> Option<Self> {
        let mut normal = Matrix3::zeros();
        let mut right = [Vector3::zeros(); 2];
        for (i, p) in points.iter().enumerate() {
            let s = i as f64;
            let row = Vector3::new(1.0, s, s * s / 2.0);
            normal += row * row.transpose();
            right[0] += row * p.x;
            right[1] += row * p.y;
        }
        let inverse = normal.try_inverse()?;
        let [x, y] = right.map(|r| inverse * r);
        Some(Self {
            at: Point::new(x[0], y[0]),
            slope: Vec2::new(x[1], y[1]),
            bend: Vec2::new(x[2], y[2]),
        })
    }

    /// Which way it goes, so many steps from the first point on.
    pub(super) fn way(&self, step: f64) -> Vec2 {
        self.slope + step * self.bend
    }

    /// Where it is there.
    fn place(&self, step: f64) -> Point {
        self.at + step * self.slope + step * step / 2.0 * self.bend
    }
}
