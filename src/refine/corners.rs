//! Corners that the picture bears out: a tip that is drawn round lacks ink that its sides would enclose.
//!
//! An arc of radius r that turns by theta leaves r² (tan(theta/2) - theta/2) of ink out, and the lens spreads it: a
//! blot of known place and shape. Picture minus model is weighed by that blot, the most that can be told under grain.

use super::{
    Cornered, nodes,
    residual::{Blot, Residual},
};
use crate::types::{Contour, Gray};
use kurbo::{BezPath, CubicBez, ParamCurve, PathEl, Point, Vec2, flatten};
use std::f64::consts::{PI, SQRT_2};

/// Below this turn an arc of a few pixels leaves out less than the grain hides, radians.
const TELLING: f64 = 1.4;
/// A corner may lack as much ink as an arc of this radius would, px: the error of its place.
const ROUND_PX: f64 = 1.15;
/// And of this much more for each px of the lens' deviation, which makes the place less certain.
const ROUND_LENS: f64 = 0.4;
/// That times this where the contour alone does not look like a corner, and where it does.
const DOUBT: [f64; 2] = [0.8, 1.3];

/// A fitted corner may reach further than its tip is drawn by this, px, and by this for each px of the lens' deviation.
const LONG_PX: (f64, f64) = (1.0, 1.2);

/// Chords leave a path that is compared with the picture by no more than this, px.
const CHORD_PX: f64 = 0.01;
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
        let limit = limit * DOUBT[usize::from(seen)];
        round(&residual, p[i], (before, after), limit).map_or(seen, |part| part < 1.0)
    };
    let pairs = sharp.iter().zip(seen);
    pairs
        .map(|((c, at), seen)| {
            let both = at.iter().zip(seen);
            both.map(|(&i, &seen)| answer(c, i, seen)).collect()
        })
        .collect()
}

/// What the picture says against the corners of a fitted path.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Doubts {
    /// Corners that are drawn round.
    pub round: Vec<Point>,
    /// Where two sides would meet that a short run of curves joins, and should.
    pub sharp: Vec<Overlooked>,
}

/// A corner that a short run of curves stands for.
#[derive(Debug, Clone, PartialEq)]
pub struct Overlooked {
    /// Where its sides meet.
    pub tip: Point,
    /// The nodes of the run, its ends among them.
    pub nodes: Vec<Point>,
}

/// What the picture says against the corners of fitted paths.
#[derive(Debug)]
pub struct Fitted {
    residual: Residual,
}

impl Fitted {
    /// The picture against the fill of `paths`, both blurred by `blur_px`.
    #[must_use]
    pub fn new(gray: &Gray, paths: &[BezPath], blur_px: f64) -> Self {
        let rings = polygons(paths);
        Self {
            residual: Residual::new(gray, rings.iter().map(Vec::as_slice), blur_px),
        }
    }

    /// What it says against the corners of those paths.
    #[must_use]
    pub fn doubts(&self, paths: &[BezPath]) -> Vec<Doubts> {
        let of = |path: &BezPath| {
            let segments: Vec<CubicBez> = path.segments().map(|s| s.to_cubic()).collect();
            Doubts {
                round: undrawn(&self.residual, &segments),
                sharp: overlooked(&self.residual, &segments),
            }
        };
        paths.iter().map(of).collect()
    }

    /// Whether it bears out each of some paths with new `corners` as well as it did the path before it.
    #[must_use]
    pub fn borne_out(&self, paths: &[BezPath], corners: &[Vec<Overlooked>]) -> Vec<bool> {
        let before = &self.residual;
        let after = before.against(polygons(paths).iter().map(Vec::as_slice));
        let grain = GRAIN * before.grain();
        let reach = SHORT_PX + SHORT_LENS * before.lens_px();
        let gain = |c: &Overlooked| before.squares(c.tip, reach) - after.squares(c.tip, reach);
        let kept = |c: &Overlooked| 0.5 * gain(c) + SIMPLER * grain >= 0.0;
        corners.iter().map(|c| c.iter().all(kept)).collect()
    }

    /// Paths like those, with nodes and handles where their blurred fill is most like the picture.
    #[must_use]
    pub fn settled(&self, paths: &[BezPath]) -> Vec<BezPath> {
        nodes::settled(&self.residual, paths)
    }
}

fn polygons(paths: &[BezPath]) -> Vec<Vec<Point>> {
    paths.iter().map(|p| polygon(p, CHORD_PX)).collect()
}

/// The corners of a closed path that are drawn round.
fn undrawn(residual: &Residual, path: &[CubicBez]) -> Vec<Point> {
    let limit = limit(residual) * DOUBT[1];
    let before = path.iter().cycle().skip(path.len().saturating_sub(1));
    let corners = path.iter().zip(before).filter_map(|(after, before)| {
        let (u, v) = (arriving(before), leaving(after));
        let (long, more) = LONG_PX;
        let tip = 1.0 / (u.cross(v).atan2(u.dot(v)) / 2.0).cos() - 1.0;
        let limit = limit.min((long + more * residual.lens_px()) / tip);
        let part = round(residual, after.p0, (u, v), limit)?;
        (part > 1.0).then_some(after.p0)
    });
    corners.collect()
}

/// Where the sides of short curves of a closed path meet, if the picture has the ink of a corner there.
fn overlooked(residual: &Residual, path: &[CubicBez]) -> Vec<Overlooked> {
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

/// Largest radius, px, of an arc that is still taken for a corner.
fn limit(residual: &Residual) -> f64 {
    ROUND_PX + ROUND_LENS * residual.lens_px()
}

/// How much of the ink that an arc of `radius` px would leave out of a corner is lacking, as a part; negative where
/// there is too much. Nothing where the turn is too small to tell.
fn round(residual: &Residual, at: Point, (u, v): (Vec2, Vec2), radius: f64) -> Option<f64> {
    let turn = u.cross(v).atan2(u.dot(v));
    let inwards = v.normalize() - u.normalize();
    (turn.abs() >= TELLING && inwards.hypot() > 1e-9).then(|| {
        let inwards = inwards.normalize();
        let half = turn.abs() / 2.0;
        let centre = at + inwards * (radius / half.cos());
        let arc = |k: i32| centre - turned(inwards, half * f64::from(k) / 8.0) * radius;
        let arc: Vec<Point> = (-8..=8).map(arc).collect();
        // ink lies to the left: a corner that turns left holds it
        -turn.signum() * residual.weigh(&Blot::between(at, &arc, inwards)).part
    })
}

fn turned(v: Vec2, by: f64) -> Vec2 {
    let (sin, cos) = by.sin_cos();
    Vec2::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y)
}

/// A closed path as chords that leave it by no more than `tolerance_px`.
pub(super) fn polygon(path: &BezPath, tolerance_px: f64) -> Vec<Point> {
    let mut out = Vec::new();
    flatten(path, tolerance_px, |el| match el {
        PathEl::MoveTo(p) | PathEl::LineTo(p) => out.push(p),
        _ => {}
    });
    out
}
