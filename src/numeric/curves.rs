//! Curves by themselves: their chords, lengths and directions.

use kurbo::{BezPath, CubicBez, PathEl, Point, Vec2, flatten};

/// The ends of the chords of a closed path, which they leave by no more than `tolerance`; the first is not repeated.
#[must_use]
pub fn polygon(path: &BezPath, tolerance: f64) -> Vec<Point> {
    let mut out = Vec::new();
    flatten(path, tolerance, |el| match el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => out.push(p),
        _ => {}
    });
    out
}

/// Length of a curve's control polygon.
#[must_use]
pub fn control_length(c: &CubicBez) -> f64 {
    c.p0.distance(c.p1) + c.p1.distance(c.p2) + c.p2.distance(c.p3)
}

/// Direction in which a curve leaves its start, through the first control point that differs; zero of a point.
#[must_use]
pub fn leaving(c: &CubicBez) -> Vec2 {
    first([c.p1 - c.p0, c.p2 - c.p0, c.p3 - c.p0])
}

/// Direction in which it arrives at its end.
#[must_use]
pub fn arriving(c: &CubicBez) -> Vec2 {
    first([c.p3 - c.p2, c.p3 - c.p1, c.p3 - c.p0])
}

fn first(ways: [Vec2; 3]) -> Vec2 {
    let way = ways.into_iter().find(|d| d.hypot() > 1e-9);
    way.unwrap_or_default()
}
