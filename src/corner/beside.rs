//! The clear stretches of contour beside a corner, and the corner as the crossing of its two sides.

use super::calm::calm;
use crate::{
    numeric::side::{Meeting, Place, Side, scatter_px},
    types::Contour,
};
use kurbo::Point;
use std::f64::consts::SQRT_2;

/// Longest stretch that a side of smooth ink is taken from, px.
const REACH_PX: f64 = 16.0;
/// And how much longer it may be for each px along which ink is ragged.
const RAGGED: f64 = 4.0;

/// How far from a corner its rounding by the picture's blur is felt, px: the bilinear surface reaches
/// 1 px, and a Gaussian's edge is straight again to 1 % of a pixel after one and a half deviations. Ragged ink is
/// averaged by one more.
pub(super) fn clearance_px(contour: &Contour) -> f64 {
    1.05 + 1.5 * contour.blur_px().hypot(contour.ragged_px())
}

/// Clearance of a needle, in those of a right angle, at most: further out its sides are seen apart.
const NEEDLE: f64 = 3.0;

/// A meeting of sides that begin far out is believed where its deviation is below this, px.
const KNOWN_PX: f64 = 0.5;

/// A contour with some of its points said to be corners.
pub(super) struct Corners<'a> {
    points: &'a [Point],
    /// clearance of a right angle, px
    clear: f64,
    /// least scatter of a side's points, px
    floor: f64,
    /// longest stretch that a side is taken from, px
    reach: f64,
    /// strictly increasing
    at: &'a [usize],
}

/// What is known of a corner.
pub(super) struct Corner {
    /// where its sides meet
    pub(super) meeting: Meeting,
    /// how far along its sides the blur is felt, px
    pub(super) clear: f64,
}

impl<'a> Corners<'a> {
    pub(super) fn new(contour: &'a Contour, at: &'a [usize]) -> Self {
        Self {
            points: contour.points(),
            clear: clearance_px(contour),
            floor: scatter_px(contour.ragged_px()).hypot(contour.scatter_px()),
            reach: REACH_PX + RAGGED * contour.ragged_px(),
            at,
        }
    }

    /// Corner number `k`; nothing where its sides do not meet near it.
    ///
    /// Where they meet at an acute angle each side is within the other's blur for longer.
    pub(super) fn corner(&self, k: usize) -> Option<Corner> {
        let meeting = self.meeting(k, self.clear)?;
        let acute = libm::sin((std::f64::consts::PI - meeting.turn.abs()) / 2.0) * SQRT_2;
        let clear = self.clear * (1.0 / acute).clamp(1.0, NEEDLE);
        let apart = self.meeting(k, clear).filter(|m| m.noise < KNOWN_PX);
        let meeting = apart.unwrap_or(meeting);
        Some(Corner { meeting, clear })
    }

    /// The meeting of the sides of corner number `k` that begin `clear` px from it.
    fn meeting(&self, k: usize, clear: f64) -> Option<Meeting> {
        let n = self.at.len();
        let i = self.at[k];
        let mut before = self.stretch((i, clear), self.at[(k + n - 1) % n], Place::Before);
        before.reverse();
        let after = self.stretch((i, clear), self.at[(k + 1) % n], Place::After);
        let before = Side::beside(&before, Place::Before, self.floor)?;
        let after = Side::beside(&after, Place::After, self.floor)?;
        before.meet(&after, self.points[i], 3.0 * clear)
    }

    /// Points from corner `i` towards the corner `stop`, outside both their clearances, nearest first; of
    /// a stretch that has none, its middle.
    fn stretch(&self, (i, clear): (usize, f64), stop: usize, place: Place) -> Vec<Point> {
        let n = self.points.len();
        let step = if place == Place::After { 1 } else { n - 1 };
        let (mut d, mut j) = (0.0, i);
        let mut walk = Vec::new();
        while d <= self.reach + clear + self.clear && walk.len() < n {
            let next = (j + step) % n;
            d += self.points[j].distance(self.points[next]);
            walk.push((d, self.points[next]));
            j = next;
            if j == stop {
                break;
            }
        }
        let end = if j == stop { d } else { f64::INFINITY };
        let within = |from: f64, to: f64| -> Vec<Point> {
            let inside = walk.iter().filter(|(d, _)| (from..=to).contains(d));
            inside.map(|(_, p)| *p).collect()
        };
        let out = within(clear, (end - self.clear).min(clear + self.reach));
        if out.len() >= 2 || walk.is_empty() {
            return out;
        }
        let end = end.min(d);
        let out = within(0.3 * end, 0.7 * end);
        if out.len() >= 2 {
            return out;
        }
        [Some(self.points[i]), walk.last().map(|w| w.1)]
            .into_iter()
            .flatten()
            .collect()
    }
}

/// The contour with each corner moved to where its sides meet and the rounded points beside it left
/// out, and the corners' new indices.
///
/// A corner whose sides do not meet near it stays where it is.
#[must_use]
pub fn sharpen(contour: &Contour, corners: &[usize]) -> (Contour, Vec<usize>) {
    let calm = calm(contour);
    let all = Corners::new(&calm, corners);
    let traced = contour.points();
    let n = traced.len();
    let mut points = Vec::with_capacity(n);
    let mut indices = Vec::with_capacity(corners.len());
    let found: Vec<Option<Corner>> = (0..corners.len()).map(|k| all.corner(k)).collect();
    for (k, &i) in corners.iter().enumerate() {
        let next = corners[(k + 1) % corners.len()];
        let count = (next + n - i - 1) % n + 1;
        let place = |j: usize| traced[(i + j) % n];
        let lengths: Vec<f64> = (0..count)
            .scan(0.0, |d, j| {
                *d += place(j).distance(place(j + 1));
                Some(*d)
            })
            .collect();
        let length = lengths.last().copied().unwrap_or(0.0);
        let (here, there) = (&found[k], &found[(k + 1) % corners.len()]);
        let clear =
            |c: &Option<Corner>| c.as_ref().map_or(all.clear, |c| c.clear).min(0.3 * length);
        let (from, to) = (clear(here), length - clear(there));
        indices.push(points.len());
        points.push(here.as_ref().map_or(place(0), |c| c.meeting.apex));
        for (j, d) in lengths.iter().enumerate().take(count - 1) {
            if (from..=to).contains(d) {
                points.push(place(j + 1));
            }
        }
    }
    match contour.through(points) {
        Ok(c) if c.points().len() > 2 && !indices.is_empty() => (c, indices),
        _ => (contour.clone(), corners.to_vec()),
    }
}
