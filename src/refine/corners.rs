//! Corners that the picture bears out: a tip that is drawn round lacks ink that its sides would enclose.
//!
//! A lens moves ink about but keeps its amount. So the sum over the pixels around a corner of picture minus
//! model is the area between the two sides and what is drawn, whatever the blur. An arc of radius r that turns
//! by theta leaves r² (tan(theta/2) - theta/2) of it out.

use super::{Cornered, residual::Residual};
use crate::types::{Contour, Gray};
use kurbo::{BezPath, CubicBez, PathEl, Point, Vec2, flatten};
use std::f64::consts::{PI, SQRT_2};

/// Below this turn an arc of a few pixels leaves out less than the grain hides, radians.
const TELLING: f64 = 1.4;
/// A corner may lack as much ink as an arc of this radius would, px: the error of its place.
const ROUND_PX: f64 = 1.15;
/// And of this much more for each px of the lens' deviation, which makes the place less certain.
const ROUND_LENS: f64 = 0.4;
/// That times this where the contour alone looks like a corner, and where it does not.
const DOUBT: [f64; 2] = [0.8, 1.3];

/// A fitted corner may reach further than its tip is drawn by this, px, and by this for each px of the lens' deviation.
const LONG_PX: (f64, f64) = (1.0, 1.2);

/// Which of the corners of sharpened contours are drawn as corners. `seen` says what the contour alone tells of
/// each; where the picture tells nothing, that holds.
#[must_use]
pub fn confirmed(gray: &Gray, sharp: &[Cornered], seen: &[Vec<bool>]) -> Vec<Vec<bool>> {
    let Some((first, _)) = sharp.first() else {
        return Vec::new();
    };
    let blur = first.blur_px();
    let residual = Residual::new(gray, sharp.iter().map(|(c, _)| c.points()), blur);
    let limit = limit(&residual);
    let answer = |contour: &Contour, i: usize, seen: bool| {
        let p = contour.points();
        let n = p.len();
        let (before, after) = (p[i] - p[(i + n - 1) % n], p[(i + 1) % n] - p[i]);
        // the rounded points were left out, and what they stood for is blurred into their neighbours
        let reach = 0.5 * (before.hypot() + after.hypot()) + 1.5 * blur;
        match radius(&residual, (p[i], reach), (before, after)) {
            Some(r) => r < limit * DOUBT[usize::from(seen)],
            None => seen,
        }
    };
    let pairs = sharp.iter().zip(seen);
    pairs
        .map(|((c, at), seen)| {
            let both = at.iter().zip(seen);
            both.map(|(&i, &seen)| answer(c, i, seen)).collect()
        })
        .collect()
}

/// The corners of fitted paths that the picture does not bear out.
#[must_use]
pub fn undrawn(gray: &Gray, paths: &[BezPath], blur_px: f64) -> Vec<Vec<Point>> {
    let rings: Vec<Vec<Point>> = paths.iter().map(polygon).collect();
    let residual = Residual::new(gray, rings.iter().map(Vec::as_slice), blur_px);
    let limit = limit(&residual) * DOUBT[1];
    let of = |path: &BezPath| {
        let segments: Vec<CubicBez> = path.segments().map(|s| s.to_cubic()).collect();
        let before = segments
            .iter()
            .cycle()
            .skip(segments.len().saturating_sub(1));
        let corners = segments.iter().zip(before).filter_map(|(after, before)| {
            let (u, v) = (arriving(before), leaving(after));
            let radius = radius(&residual, (after.p0, reach(u, v, blur_px)), (u, v))?;
            let (long, more) = LONG_PX;
            let tip = 1.0 / (u.cross(v).atan2(u.dot(v)) / 2.0).cos() - 1.0;
            let limit = limit.min((long + more * residual.lens_px()) / tip);
            (radius > limit).then_some(after.p0)
        });
        corners.collect()
    };
    paths.iter().map(of).collect()
}

/// Direction in which a segment leaves its start, through the first control point that differs.
fn leaving(c: &CubicBez) -> Vec2 {
    let ways = [c.p1 - c.p0, c.p2 - c.p0, c.p3 - c.p0];
    ways.into_iter()
        .find(|d| d.hypot() > 1e-9)
        .unwrap_or_default()
}

/// Direction in which it arrives at its end.
fn arriving(c: &CubicBez) -> Vec2 {
    let ways = [c.p3 - c.p2, c.p3 - c.p1, c.p3 - c.p0];
    ways.into_iter()
        .find(|d| d.hypot() > 1e-9)
        .unwrap_or_default()
}

/// How far from a corner a lens is felt, px: the further, the more acute it is.
fn reach(u: Vec2, v: Vec2, blur_px: f64) -> f64 {
    let turn = u.cross(v).atan2(u.dot(v)).abs();
    let acute = ((PI - turn) / 2.0).sin() * SQRT_2;
    (1.0 + 1.5 * blur_px) * (1.0 / acute).clamp(1.0, 3.0) + 1.5 * blur_px
}

/// Largest radius, px, of an arc that is still taken for a corner.
fn limit(residual: &Residual) -> f64 {
    ROUND_PX + ROUND_LENS * residual.lens_px()
}

/// Radius of the arc that would lack the ink that a corner lacks within `reach` of it, px; negative for too much.
/// Nothing where the turn is too small to tell.
fn radius(residual: &Residual, (at, reach): (Point, f64), (u, v): (Vec2, Vec2)) -> Option<f64> {
    let turn = u.cross(v).atan2(u.dot(v));
    // ink lies to the left: a corner that turns left holds it
    let lacking = -turn.signum() * residual.sum(at, reach);
    let half = turn.abs() / 2.0;
    let part = (half.tan() - half).max(1e-3);
    (turn.abs() >= TELLING).then(|| (lacking.abs() / part).sqrt().copysign(lacking))
}

/// A closed path as chords that leave it by no more than a hundredth of a pixel.
fn polygon(path: &BezPath) -> Vec<Point> {
    let mut out = Vec::new();
    flatten(path, 0.01, |el| match el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => out.push(p),
        _ => {}
    });
    out
}
