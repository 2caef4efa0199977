//! Places in a picture of ink → how far behind the border they are.

use kurbo::{Point, Vec2};

/// How far behind a border places are.
#[derive(Debug, Clone, Copy)]
pub(super) struct Across {
    /// Where the origin is, halves of the border's stretch behind its middle.
    origin: f64,
    /// By how much that grows each px to the right and up.
    grade: Vec2,
}

impl Across {
    /// `side` says it of a place.
    pub(super) fn of(side: impl Fn(Point) -> f64) -> Self {
        let origin = side(Point::ORIGIN);
        let [right, up] = [Point::new(1.0, 0.0), Point::new(0.0, 1.0)].map(|p| side(p) - origin);
        Self {
            origin,
            grade: Vec2::new(right, up),
        }
    }

    /// How far behind the border's middle a place is, halves of its stretch.
    pub(super) fn at(&self, p: Point) -> f64 {
        self.origin + self.grade.dot(p.to_vec2())
    }

    /// Which way that grows, of length 1.
    pub(super) fn along(&self) -> Vec2 {
        self.grade / self.step()
    }

    /// By how much it grows that way each px.
    pub(super) fn step(&self) -> f64 {
        self.grade.hypot()
    }
}
