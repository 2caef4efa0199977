//! Short runs of curves that stand for a corner, which the fit took for rounder than it is drawn.

use super::{
    corners::TELLING,
    residual::{Blot, Residual},
};
use kurbo::{CubicBez, ParamCurve, Point, Vec2};
use std::f64::consts::{PI, SQRT_2};

/// Longest curve that may stand for a corner, px, and what each px of the lens' deviation adds.
const SHORT_PX: f64 = 4.0;
const SHORT_LENS: f64 = 3.0;
/// How much longer it may be at a needle's tip.
const NEEDLE: f64 = 3.0;
/// Segments that it has at most.
const SHORT_RUN: usize = 3;
/// Chords that stand for each.
const CHORDS: u32 = 8;
/// Mean square of the differences of a picture without grain: one level of 256.
const LEAST_GRAIN: f64 = 1.5e-5;
/// Pixels whose grain is one.
const GRAIN: f64 = 4.0;
/// The least part of a corner's ink that the picture must have.
const LIKELY: f64 = 0.4;
/// What a corner is worth in place of such a curve, nats: two nodes and handles fewer.
const SIMPLER: f64 = 12.0;

/// A corner that a short run of curves stands for.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlooked {
    /// Where its sides meet.
    pub tip: Point,
    /// The nodes of the run, its ends among them.
    pub nodes: Vec<Point>,
}

impl Overlooked {
    /// Whether the picture is explained as well with the corner as before.
    pub(super) fn explains(&self, before: &Residual, after: &Residual) -> bool {
        let reach = SHORT_PX + SHORT_LENS * before.lens_px();
        let gain = before.squares(self.tip, reach) - after.squares(self.tip, reach);
        0.5 * gain + SIMPLER * GRAIN * before.grain() >= 0.0
    }
}

/// Where the sides of short curves of a closed path meet, if the picture has the ink of a corner there.
pub(super) fn overlooked(residual: &Residual, path: &[CubicBez]) -> Vec<Overlooked> {
    let grain = GRAIN * residual.grain().max(LEAST_GRAIN);
    let n = path.len();
    let at = |k: usize| &path[k % n];
    let mut corners = Vec::new();
    let mut i = 0;
    while i < n {
        let longest = (1..=SHORT_RUN.min(n.saturating_sub(2))).rev();
        let found = longest.into_iter().find_map(|count| {
            let run: Vec<CubicBez> = (i..i + count).map(|k| *at(k)).collect();
            let corner = blunt(residual, (at(i + n - 1), &run, at(i + count)), grain)?;
            Some((corner, count))
        });
        i += found.as_ref().map_or(1, |(_, count)| *count);
        corners.extend(found.map(|(corner, _)| corner));
    }
    corners
}

/// The corner that a run of curves between two sides stands for, if it is short and the picture bears that out.
fn blunt(
    residual: &Residual,
    (before, run, after): (&CubicBez, &[CubicBez], &CubicBez),
    grain: f64,
) -> Option<Overlooked> {
    let short = SHORT_PX + SHORT_LENS * residual.lens_px();
    let start = before.p3;
    let length: f64 = run.iter().map(polygon_px).sum();
    if length > NEEDLE * short {
        return None;
    }
    let (tip, turn) = meeting(before, after, NEEDLE * short)?;
    // the more acute a corner is, the further a lens is felt
    let acute = ((PI - turn.abs()) / 2.0).sin() * SQRT_2;
    let short = short * (1.0 / acute).clamp(1.0, NEEDLE);
    let sides = [before, after].map(|c| c.p0.distance(c.p3));
    let inwards = (start - tip) + (after.p0 - tip);
    if length > short
        || sides.into_iter().any(|s| s < length)
        || turn.abs() < TELLING
        || inwards.hypot() < 1e-9
    {
        return None;
    }
    let along = |c: &CubicBez| {
        let c = *c;
        (1..=CHORDS).map(move |k| c.eval(f64::from(k) / f64::from(CHORDS)))
    };
    let cut: Vec<Point> = [start]
        .into_iter()
        .chain(run.iter().flat_map(along))
        .collect();
    let weighed = residual.weigh(&Blot::between(tip, &cut, inwards.normalize()));
    // ink lies to the left: a corner that turns left holds it
    let part = turn.signum() * weighed.part;
    let gain = 0.5 * weighed.squares * (2.0 * part - 1.0) / grain;
    let nodes = run.iter().map(|c| c.p0).chain([after.p0]).collect();
    (part > LIKELY && gain + SIMPLER > 0.0).then_some(Overlooked { tip, nodes })
}

/// Length of a curve's control polygon, px.
fn polygon_px(c: &CubicBez) -> f64 {
    c.p0.distance(c.p1) + c.p1.distance(c.p2) + c.p2.distance(c.p3)
}

/// Where the end of one segment and the start of another lead, within `reach` px of both, and the turn there,
/// radians.
fn meeting(before: &CubicBez, after: &CubicBez, reach: f64) -> Option<(Point, f64)> {
    let (u, v) = (arriving(before).normalize(), leaving(after).normalize());
    let cross = u.cross(v);
    let gap = after.p0 - before.p3;
    let (on, back) = (gap.cross(v) / cross, gap.cross(u) / cross);
    let near = |d: f64| (-1e-6..=reach).contains(&d);
    (near(on) && near(-back)).then(|| (before.p3 + on * u, cross.atan2(u.dot(v))))
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
