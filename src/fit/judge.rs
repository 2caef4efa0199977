//! One measure for all methods: how far a span and its curves lie apart, both ways, px.
//!
//! Points to curve tells what the curve misses; curve to points tells where it goes astray between
//! them. A method's own residual is neither.

use crate::numeric::cast::index;
use crate::numeric::distance::Polyline;
use crate::types::Span;
use kurbo::{BezPath, ParamCurve, ParamCurveArclen, PathEl, Point, Rect};

/// The curve is measured by chords that leave it by no more than this, px: the error of every figure here.
const PRECISION_PX: f64 = 1e-3;

/// Step along the curve when it is measured against the points, px.
const STEP_PX: f64 = 0.25;

/// Distances one way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// The largest, px.
    pub max_px: f64,
    /// Root of the mean square, px.
    pub rms_px: f64,
}

/// How far a span and its curves lie apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Judgement {
    /// From the span's points to the curve; every point counts once.
    pub points: Deviation,
    /// From the curve, at equal steps along it, to the span's polyline.
    pub curve: Deviation,
}

impl Judgement {
    /// The larger maximum of both ways, px: the Hausdorff distance.
    #[must_use]
    pub const fn max_px(&self) -> f64 {
        self.points.max_px.max(self.curve.max_px)
    }
}

/// A curve farther from its points than this many times their extent, and as much again in px, is astray: measuring
/// it would take as many chords as it is large.
const FAR: f64 = 100.0;

/// Measures `path` against `span`; all infinite when the path draws nothing, is not finite or leaves its points for
/// far away.
#[must_use]
pub fn judge(span: Span<'_>, path: &BezPath) -> Judgement {
    Judgement {
        points: points_to_curve(span.points(), path),
        curve: curve_to_points(span, path),
    }
}

/// The same where no distance is above `limit_px`: nothing is measured beyond the first that is.
#[must_use]
pub fn judge_within(span: Span<'_>, path: &BezPath, limit_px: f64) -> Option<Judgement> {
    let line = curve(span.points(), path)?;
    let points = deviation_within(span.points().iter().copied(), &line, limit_px)?;
    let curve = deviation_within(steps(path), &polyline(span)?, limit_px)?;
    Some(Judgement { points, curve })
}

/// Whether both maxima of [`judge`] are at most `limit_px`: sooner told than how large they are.
#[must_use]
pub fn is_within(span: Span<'_>, path: &BezPath, limit_px: f64) -> bool {
    let lines = curve(span.points(), path).zip(polyline(span));
    lines.is_some_and(|(curve, points)| {
        path.segments().next().is_some()
            && curve.is_within(span.points().iter().copied(), limit_px)
            && points.is_within(steps(path), limit_px)
    })
}

/// The half of [`judge`] that tells what the curve misses.
#[must_use]
pub fn points_to_curve(points: &[Point], path: &BezPath) -> Deviation {
    let line = curve(points, path);
    line.map_or(ASTRAY, |line| deviation(points.iter().copied(), &line))
}

/// The path as chords, if it does not stray from these points.
fn curve(points: &[Point], path: &BezPath) -> Option<Polyline> {
    (!strays(points, path)).then(|| chords(path)).flatten()
}

/// Whether the path is not finite, or a control point lies [`FAR`] away from these points.
fn strays(points: &[Point], path: &BezPath) -> bool {
    let Some(&first) = points.first() else {
        return true;
    };
    let around = points
        .iter()
        .fold(Rect::from_points(first, first), |r, p| r.union_pt(*p));
    let far = FAR * (1.0 + around.width().max(around.height()));
    let inside = around.inflate(far, far);
    !path.is_finite()
        || path.segments().any(|s| {
            let c = s.to_cubic();
            ![c.p0, c.p1, c.p2, c.p3].iter().all(|p| inside.contains(*p))
        })
}

const ASTRAY: Deviation = Deviation {
    max_px: f64::INFINITY,
    rms_px: f64::INFINITY,
};

fn curve_to_points(span: Span<'_>, path: &BezPath) -> Deviation {
    match polyline(span) {
        Some(line) if !strays(span.points(), path) => deviation(steps(path), &line),
        _ => ASTRAY,
    }
}

/// The span's points, a ring's back to the first.
fn polyline(span: Span<'_>) -> Option<Polyline> {
    let close = span.points().first().filter(|_| span.is_ring());
    Polyline::new(span.points().iter().chain(close).copied().collect())
}

/// The path as chords within [`PRECISION_PX`].
fn chords(path: &BezPath) -> Option<Polyline> {
    let start = path.elements().first().and_then(PathEl::end_point);
    let mut points: Vec<Point> = start.into_iter().collect();
    for seg in path.segments() {
        let c = seg.to_cubic();
        let bend =
            |a: Point, b: Point, c: Point| (a.to_vec2() - 2.0 * b.to_vec2() + c.to_vec2()).hypot();
        let bend = bend(c.p0, c.p1, c.p2).max(bend(c.p1, c.p2, c.p3));
        // a chord of 1/n of the parameter leaves the cubic by at most 6 bend / 8 n²
        let n = (0.75 * bend / PRECISION_PX).sqrt().ceil().max(1.0);
        points.extend((1..=index(n)).map(|i| c.eval(i as f64 / n)));
    }
    Polyline::new(points)
}

/// Points on the curve, [`STEP_PX`] apart or less.
fn steps(path: &BezPath) -> impl Iterator<Item = Point> {
    path.segments().flat_map(|seg| {
        let n = (seg.arclen(STEP_PX) / STEP_PX).ceil().max(1.0);
        (0..index(n)).map(move |i| seg.eval((i as f64 + 0.5) / n))
    })
}

fn deviation(points: impl Iterator<Item = Point>, line: &Polyline) -> Deviation {
    deviation_within(points, line, f64::INFINITY).unwrap_or(ASTRAY)
}

/// `None` where a point lies farther away than the limit, or there is none.
fn deviation_within(
    points: impl Iterator<Item = Point>,
    line: &Polyline,
    limit_px: f64,
) -> Option<Deviation> {
    let (mut max, mut sum, mut n, mut at) = (0.0_f64, 0.0, 0.0, 0);
    for p in points {
        // neighbours lie beside neighbours
        let nearest = line.nearest_from(at, p);
        at = nearest.segment;
        let d = nearest.distance;
        if d > limit_px {
            return None;
        }
        max = max.max(d);
        sum += d * d;
        n += 1.0;
    }
    (n > 0.0).then(|| Deviation {
        max_px: max,
        rms_px: (sum / n).sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{Circle, Shape};

    fn ring(radius: f64, n: u32) -> Vec<Point> {
        let at = |i: u32| f64::from(i) / f64::from(n) * std::f64::consts::TAU;
        (0..n)
            .map(|i| Point::new(radius * libm::cos(at(i)), radius * libm::sin(at(i))))
            .collect()
    }

    #[test]
    fn circles_lie_apart_by_their_radii() {
        let path = Circle::new((0.0, 0.0), 20.0).to_path(1e-6);
        let points = ring(21.0, 1000);
        let j = judge(Span::Ring(&points), &path);
        for d in [
            j.points.max_px,
            j.points.rms_px,
            j.curve.max_px,
            j.curve.rms_px,
        ] {
            assert!((d - 1.0).abs() < 2e-3, "{j:?}");
        }
        assert!(is_within(Span::Ring(&points), &path, j.max_px() + 1e-9));
        assert!(!is_within(Span::Ring(&points), &path, j.max_px() - 1e-9));
    }

    #[test]
    fn a_curve_from_here_to_the_stars_is_not_measured() {
        let points = ring(20.0, 100);
        let mut path = BezPath::from_vec(vec![PathEl::MoveTo(points[0])]);
        let far = [Point::new(1e15, 1e15), Point::new(-1e15, 1e14)];
        path.curve_to(far[0], far[1], points[0]);
        assert!(
            judge(Span::Ring(&points), &path)
                .points
                .max_px
                .is_infinite()
        );
        assert!(judge(Span::Ring(&points), &path).curve.max_px.is_infinite());
    }

    #[test]
    fn an_offshoot_is_seen_from_the_curve_alone() {
        let points: Vec<_> = (0..=10).map(|i| Point::new(f64::from(i), 0.0)).collect();
        let mut path = BezPath::from_vec(vec![PathEl::MoveTo(points[0])]);
        for p in [(5.0, 0.0), (5.0, 9.0), (5.0, 0.0), (10.0, 0.0)] {
            path.line_to(p);
        }
        let j = judge(Span::Open(&points), &path);
        assert!(
            j.points.max_px < 1e-9 && (j.max_px() - 9.0).abs() < STEP_PX,
            "{j:?}"
        );
        assert!(
            judge(Span::Open(&points), &BezPath::new())
                .max_px()
                .is_infinite(),
            "nothing drawn"
        );
    }
}
