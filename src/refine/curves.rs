//! Curves by themselves: their chords, lengths and directions.

use kurbo::{BezPath, CubicBez, PathEl, Point, Vec2, flatten};

/// A closed path as chords that leave it by no more than `tolerance_px`.
pub(super) fn polygon(path: &BezPath, tolerance_px: f64) -> Vec<Point> {
    let mut out = Vec::new();
    flatten(path, tolerance_px, |el| match el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => out.push(p),
        _ => {}
    });
    out
}

/// Length of a curve's control polygon, px.
pub(super) fn polygon_px(c: &CubicBez) -> f64 {
    c.p0.distance(c.p1) + c.p1.distance(c.p2) + c.p2.distance(c.p3)
}

/// Direction in which a segment leaves its start, through the first control point that differs.
pub(super) fn leaving(c: &CubicBez) -> Vec2 {
    let ways = [c.p1 - c.p0, c.p2 - c.p0, c.p3 - c.p0];
    ways.into_iter()
        .find(|d| d.hypot() > 1e-9)
        .unwrap_or_default()
}

/// Direction in which it arrives at its end.
pub(super) fn arriving(c: &CubicBez) -> Vec2 {
    let ways = [c.p3 - c.p2, c.p3 - c.p1, c.p3 - c.p0];
    ways.into_iter()
        .find(|d| d.hypot() > 1e-9)
        .unwrap_or_default()
}
