//! Corners that the picture bears out: a tip that is drawn round lacks ink that its sides would enclose.
//!
//! An arc of radius r that turns by theta leaves r² (tan(theta/2) - theta/2) of ink out, and the lens spreads it: a
//! blot of known place and shape. Picture minus model is weighed by that blot, the most that can be told under grain.

use super::{
    Cornered,
    curves::{arriving, leaving},
    residual::{Blot, Residual},
};
use crate::numeric::angles::{self, angle};
use crate::types::{Contour, Gray};
use kurbo::{CubicBez, Point, Vec2};

/// Below this turn an arc of a few pixels leaves out less than the grain hides, radians.
pub(super) const TELLING: f64 = 1.4;
/// A corner may lack as much ink as an arc of this radius would, px: the error of its place.
const ROUND_PX: f64 = 1.15;
/// And of this much more for each px of the lens' deviation, which makes the place less certain.
const ROUND_LENS: f64 = 0.4;
/// And for each px of the edges' own: a side that is off by half a pixel leaves out as much.
const ROUND_SCATTER: f64 = 5.0;
/// That times this where the contour alone does not look like a corner, and where it does.
const DOUBT: [f64; 2] = [0.8, 1.3];

/// A fitted corner may reach further than its tip is drawn by this, px, and by this for each px of the lens'
/// deviation.
const LONG_PX: (f64, f64) = (1.0, 1.2);

/// Which of the corners of sharpened contours are drawn as corners. `seen` says what the contour alone tells of
/// each; where the picture tells nothing, that holds.
#[must_use]
pub fn confirmed(gray: &Gray, sharp: &[Cornered], seen: &[Vec<bool>]) -> Vec<Vec<bool>> {
    let Some((first, _)) = sharp.iter().find(|(_, at)| !at.is_empty()) else {
        return vec![Vec::new(); sharp.len()];
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

/// The corners of a closed path that are drawn round.
pub(super) fn undrawn(residual: &Residual<'_>, path: &[CubicBez]) -> Vec<Point> {
    let limit = limit(residual) * DOUBT[1];
    let before = path.iter().cycle().skip(path.len().saturating_sub(1));
    let corners = path.iter().zip(before).filter_map(|(after, before)| {
        let (u, v) = (arriving(before), leaving(after));
        let (long, more) = LONG_PX;
        let tip = 1.0 / libm::cos(angle(u, v) / 2.0) - 1.0;
        let limit = limit.min((long + more * residual.lens_px()) / tip);
        let part = round(residual, after.p0, (u, v), limit)?;
        (part > 1.0).then_some(after.p0)
    });
    corners.collect()
}

/// Largest radius, px, of an arc that is still taken for a corner.
fn limit(residual: &Residual<'_>) -> f64 {
    let scatter = residual.seen().scatter_px();
    ROUND_PX + ROUND_LENS * residual.lens_px() + ROUND_SCATTER * scatter
}

/// How much of the ink that an arc of `radius` px would leave out of a corner is lacking, as a part; negative where
/// there is too much. Nothing where the turn is too small to tell.
fn round(residual: &Residual<'_>, at: Point, (u, v): (Vec2, Vec2), radius: f64) -> Option<f64> {
    let turn = angle(u, v);
    let inwards = v.normalize() - u.normalize();
    (turn.abs() >= TELLING && inwards.hypot() > 1e-9).then(|| {
        let inwards = inwards.normalize();
        let half = turn.abs() / 2.0;
        let centre = at + inwards * (radius / libm::cos(half));
        let arc = |k: i32| {
            let turn = angles::direction(half * f64::from(k) / 8.0);
            centre - inwards.rotate_scale(turn) * radius
        };
        let arc: Vec<Point> = (-8..=8).map(arc).collect();
        // ink lies to the left: a corner that turns left holds it
        -turn.signum() * residual.lacking(&Blot::between(at, &arc, inwards))
    })
}
