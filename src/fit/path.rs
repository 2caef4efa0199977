//! What several fitters do with spans and paths.

use super::judge::judge;
use super::{FitError, Fitter};
use crate::numeric::turns::Ends;
use crate::types::{Fitted, Span, Spans, Verdict};
use kurbo::{BezPath, CubicBez, PathEl, Point};

/// The span's finite points without neighbours that coincide, also around a ring, and whether they close.
pub(super) fn distinct(span: Span<'_>) -> (Vec<Point>, Ends) {
    let mut points = span.points().to_vec();
    points.retain(|p| p.is_finite());
    points.dedup();
    if !span.is_ring() {
        return (points, Ends::Open);
    }
    if points.len() > 1 && points.first() == points.last() {
        points.pop();
    }
    (points, Ends::Closed)
}

/// The span's own polygon: the answer where there is nothing to fit.
pub(super) fn polygon(span: Span<'_>) -> Fitted {
    let points = span.points();
    let moves = points.iter().enumerate().map(|(i, &p)| match i {
        0 => PathEl::MoveTo(p),
        _ => PathEl::LineTo(p),
    });
    let mut path: BezPath = moves.collect();
    if path.elements().len() == 1 && !span.is_ring() {
        path.extend(points.first().map(|&p| PathEl::LineTo(p)));
    }
    if span.is_ring() {
        path.close_path();
    }
    Fitted {
        path,
        verdict: Verdict::Degenerate,
        parameters: 2 * points.len(),
    }
}

/// One closed path of the spans' fits in order; each starts where the one before ends.
pub(super) fn joined<F: Fitter + ?Sized>(
    fitter: &F,
    spans: &Spans,
    tolerance_px: f64,
) -> Result<BezPath, FitError> {
    let mut path = BezPath::new();
    for span in spans.iter() {
        let fitted = fitter.fit(span, tolerance_px)?;
        for el in fitted.path.elements() {
            match el {
                PathEl::MoveTo(_) if !path.is_empty() => {}
                PathEl::ClosePath => {}
                el => path.push(*el),
            }
        }
    }
    path.close_path();
    Ok(path)
}

/// Joined cubics as a path from the first to the last; straight ones become lines.
pub(super) fn path_of(cubics: &[CubicBez], span: Span<'_>) -> BezPath {
    let mut path: BezPath = cubics
        .first()
        .map(|c| PathEl::MoveTo(c.p0))
        .into_iter()
        .collect();
    for c in cubics {
        if c.p1 == c.p0 && c.p2 == c.p3 {
            path.line_to(c.p3);
        } else {
            path.curve_to(c.p1, c.p2, c.p3);
        }
    }
    if span.is_ring() {
        path.close_path();
    }
    path
}

/// Between points that lie far apart a curve may swing out unseen by any residual. Farther from the span
/// than this many times what it misses of the points, it is no answer.
const SWING: f64 = 4.0;

/// The path with the verdict of the judge, both ways; `None` when it swings out between the points, or is lost.
pub(super) fn judged(
    span: Span<'_>,
    path: BezPath,
    (tolerance, parameters): (f64, usize),
) -> Option<Fitted> {
    let j = judge(span, &path);
    let near = j.points.max_px.is_finite();
    let steady = near && j.curve.max_px <= SWING * j.points.max_px.max(tolerance);
    let verdict = if j.max_px() <= tolerance {
        Verdict::Met
    } else {
        Verdict::Exhausted
    };
    steady.then_some(Fitted {
        path,
        verdict,
        parameters,
    })
}

/// A straight piece, as [`path_of`] knows it.
pub(super) fn line(a: Point, b: Point) -> CubicBez {
    CubicBez::new(a, a, b, b)
}

/// Whether the span runs its second way: so that a method which looks at one direction only gives the
/// same curve for the reversed span. The way is told by what turning and scaling leave alone: the sign of
/// the enclosed area, and for balanced spans the distances from the middle.
fn runs_backward(points: &[Point]) -> bool {
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return false;
    };
    let pairs = points.windows(2);
    let area: f64 = pairs.map(|w| (w[0] - first).cross(w[1] - first)).sum();
    let size = points
        .iter()
        .map(|p| p.distance_squared(first))
        .fold(0.0, f64::max);
    if area.abs() > 1e-9 * size {
        return area < 0.0;
    }
    let middle = first.midpoint(last);
    let n = points.len() as f64;
    let lever = |(i, p): (usize, &Point)| (2.0 * i as f64 + 1.0 - n) * p.distance(middle);
    let lever: f64 = points.iter().enumerate().map(lever).sum();
    if lever.abs() > 1e-9 * n * n * size.sqrt() {
        return lever < 0.0;
    }
    // alike both ways: only the place is left to tell them apart
    let beside = points.get(1).copied().unwrap_or(last);
    let (a, b) = if first == last {
        (beside, last)
    } else {
        (first, last)
    };
    (b.x, b.y) < (a.x, a.y)
}

/// Fits the span in the way that does not depend on how it was handed over, and turns the path back.
/// A ring keeps its first point.
pub(super) fn both_ways(
    span: Span<'_>,
    fit: impl FnOnce(Span<'_>) -> Result<Fitted, FitError>,
) -> Result<Fitted, FitError> {
    if !runs_backward(span.points()) {
        return fit(span);
    }
    let mut points = span.points().to_vec();
    points.reverse();
    let fitted = if span.is_ring() {
        points.rotate_right(1);
        fit(Span::Ring(&points))
    } else {
        fit(Span::Open(&points))
    }?;
    Ok(Fitted {
        path: fitted.path.reverse_subpaths(),
        ..fitted
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ways_meet() {
        let there: Vec<Point> = [(0.0, 0.0), (3.0, 1.0), (5.0, 0.0), (6.0, 2.0)]
            .map(Point::from)
            .into();
        let mut back = there.clone();
        back.reverse();
        let start = |points: &[Point]| {
            let mut seen = Point::ORIGIN;
            let fitted = both_ways(Span::Open(points), |s| {
                seen = s.points()[0];
                Ok(polygon(s))
            });
            (seen, fitted.unwrap().path)
        };
        let (a, b) = (start(&there), start(&back));
        assert_eq!(a.0, b.0, "the method sees one way only");
        assert_eq!(a.1.elements()[0], PathEl::MoveTo(there[0]));
        assert_eq!(
            b.1.elements()[0],
            PathEl::MoveTo(there[3]),
            "the caller gets his own"
        );
    }
}
