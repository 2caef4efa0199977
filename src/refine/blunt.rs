//! Short runs of curves that stand for a corner, which the fit took for rounder than it is drawn.

use super::{
    corners::TELLING,
    curves::{arriving, leaving, polygon_px},
    residual::{Blot, Residual},
};
use kurbo::{CubicBez, ParamCurve, Point};
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
/// Pixels whose grain is one.
const GRAIN: f64 = 4.0;
/// The least part of a corner's ink that the picture must have.
const LIKELY: f64 = 0.2;
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
    /// Whether the picture of so much `grain` is explained as well with the corner as before.
    pub(super) fn explains(
        &self,
        (before, grain): (&Residual<'_>, f64),
        after: &Residual<'_>,
    ) -> bool {
        let reach = reach_px(before);
        let gain = before.squares(self.tip, reach) - after.squares(self.tip, reach);
        0.5 * gain + SIMPLER * GRAIN * grain >= 0.0
    }
}

/// How far around a corner the picture tells it from a curve, px.
pub(super) fn reach_px(residual: &Residual<'_>) -> f64 {
    SHORT_PX + SHORT_LENS * residual.lens_px()
}

/// Where the sides of short curves of a closed path meet, if the picture has the ink of a corner there.
pub(super) fn overlooked(residual: &Residual<'_>, path: &[CubicBez]) -> Vec<Overlooked> {
    let n = path.len();
    let at = |k: usize| &path[k % n];
    // a run may begin where the path does: it is met whole from behind the longest segment
    let length = |k: &usize| polygon_px(at(*k));
    let longest = (0..n).max_by(|a, b| length(a).total_cmp(&length(b)));
    let first = longest.map_or(0, |k| k + 1);
    let mut corners = Vec::new();
    let mut i = first;
    while i < first + n {
        let longest = (1..=SHORT_RUN.min(n.saturating_sub(2))).rev();
        let found = longest.into_iter().find_map(|count| {
            let run: Vec<CubicBez> = (i..i + count).map(|k| *at(k)).collect();
            let corner = blunt(residual, (at(i + n - 1), &run, at(i + count)))?;
            Some((corner, count))
        });
        i += found.as_ref().map_or(1, |(_, count)| *count);
        corners.extend(found.map(|(corner, _)| corner));
    }
    corners
}

/// The corner that a run of curves between two sides stands for, if it is short and the picture bears that out.
fn blunt(
    residual: &Residual<'_>,
    (before, run, after): (&CubicBez, &[CubicBez], &CubicBez),
) -> Option<Overlooked> {
    let short = reach_px(residual);
    let start = before.p3;
    let length: f64 = run.iter().map(polygon_px).sum();
    if length > NEEDLE * short {
        return None;
    }
    let (tip, turn) = meeting(before, after, NEEDLE * short)?;
    // the more acute a corner is, the further a lens is felt
    let acute = libm::sin((PI - turn.abs()) / 2.0) * SQRT_2;
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
    let lacking = residual.lacking(&Blot::between(tip, &cut, inwards.normalize()));
    // ink lies to the left: a corner that turns left holds it
    let part = turn.signum() * lacking;
    let nodes = run.iter().map(|c| c.p0).chain([after.p0]).collect();
    (part > LIKELY).then_some(Overlooked { tip, nodes })
}

/// Where the end of one segment and the start of another lead, within `reach` px of both, and the turn there,
/// radians.
fn meeting(before: &CubicBez, after: &CubicBez, reach: f64) -> Option<(Point, f64)> {
    let (u, v) = (arriving(before).normalize(), leaving(after).normalize());
    let cross = u.cross(v);
    let gap = after.p0 - before.p3;
    let (on, back) = (gap.cross(v) / cross, gap.cross(u) / cross);
    let near = |d: f64| (-1e-6..=reach).contains(&d);
    (near(on) && near(-back)).then(|| (before.p3 + on * u, libm::atan2(cross, u.dot(v))))
}
