//! Where things lie: boxes, cells, distances.

use kurbo::{Point, Rect, Vec2};

/// The box around a boundary.
pub(super) fn extent(boundary: &[Point]) -> Rect {
    let first = boundary.first().copied().unwrap_or_default();
    let start = Rect::from_points(first, first);
    boundary.iter().fold(start, |r, &p| r.union_pt(p))
}

/// The place of a cell in rows of such a width from a corner on.
pub(super) fn place(corner: (i32, i32), width: usize, (x, y): (i32, i32)) -> Option<usize> {
    let x = usize::try_from(x - corner.0).ok().filter(|&x| x < width)?;
    Some(usize::try_from(y - corner.1).ok()? * width + x)
}

/// Square of the distance of a point from an edge.
pub(super) fn to_edge(p: Point, w: &[Point]) -> f64 {
    let v: Vec2 = w[1] - w[0];
    let u = ((p - w[0]).dot(v) / v.hypot2().max(1e-12)).clamp(0.0, 1.0);
    (w[0] + v * u).distance_squared(p)
}
