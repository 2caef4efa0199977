//! Contour → the smooth path through its points, which the search takes without a fit between.

use crate::numeric::turns::Ends;
use crate::types::Contour;
use kurbo::{BezPath, Point, Vec2};

/// A closed path through the points of a traced contour, smooth but at its corners (increasing indices);
/// in the contour's px. Scaled to font units it is an outline's contour: each error of the search is
/// then measured against the boundary that was traced.
#[must_use]
pub fn through(contour: &Contour, corners: &[usize]) -> BezPath {
    let spans = contour.cut(corners);
    let mut path = BezPath::new();
    for span in spans.iter() {
        let mut points = span.points().to_vec();
        let mut ends = Ends::Open;
        if span.is_ring() {
            points.extend(points.first().copied());
            ends = Ends::Closed;
        }
        let tangents = tangents(&points, ends);
        for (i, pair) in points.windows(2).enumerate() {
            let [a, b] = [pair[0], pair[1]];
            if path.elements().is_empty() {
                path.move_to(a);
            }
            let third = a.distance(b) / 3.0;
            path.curve_to(a + tangents[i] * third, b - tangents[i + 1] * third, b);
        }
    }
    path.close_path();
    path
}

/// Unit directions at the points of a span, over a few neighbours on both sides so that a contour's
/// grain does not bend them. A ring's first point is its last, too.
fn tangents(points: &[Point], ends: Ends) -> Vec<Vec2> {
    /// Neighbours on each side.
    const REACH: usize = 3;
    let is_ring = ends == Ends::Closed;
    let last = points.len().saturating_sub(1);
    let direction = |i: usize| {
        let room = if is_ring { last / 4 } else { i.min(last - i) };
        let (before, after) = match (room.min(REACH), is_ring) {
            (0, _) => (i.saturating_sub(1), (i + 1).min(last)),
            (k, true) => ((i + last - k) % last, (i + k) % last),
            (k, false) => (i - k, i + k),
        };
        let d = points[after] - points[before];
        if d.hypot() > 0.0 {
            d.normalize()
        } else {
            Vec2::new(1.0, 0.0)
        }
    };
    (0..points.len()).map(direction).collect()
}
