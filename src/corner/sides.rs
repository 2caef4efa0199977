//! Corners where two fitted sides meet.
//!
//! Takes    a contour evenly sampled at about a pixel, and the blur of its picture
//! Solves   which is likelier between two smooth stretches: a point where they meet, or an arc
//! Gives    indices of the points nearest to the corners
//! Symbols  theta -> turn, s -> blur, c -> clearance: how far from a corner the blur is felt
//! Departs  own method
//! Cost     O(n)      Fails  never
//!
//! Each side is a line or parabola through the points that the blur does not reach; the two meet at an
//! apex and turn by theta there. If the drawing has a corner, the blur alone keeps the contour off the
//! apex, by about s·sqrt(2/pi)·tan(theta/2); if it has an arc, one that joins the sides where they were
//! taken, of radius c/tan(theta/2), keeps it off by (1/cos(theta/2) - 1) of that radius. The contour is
//! seen to be nearer to one or the other.

use super::{
    Detector,
    beside::{Corners, clearance_px},
    calm::calm,
};
use crate::numeric::angles::angle;
use crate::{numeric::side::Meeting, types::Contour};
use kurbo::{Line, ParamCurveNearest, Point};
use serde::{Deserialize, Serialize};

/// Options of the default detector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sides {
    /// Smallest turn between the sides that is a corner, degrees.
    pub turn_deg: f64,
    /// From this turn on a meeting is a corner also where noise hides whether it is round, degrees.
    pub sharp_deg: f64,
}

impl Default for Sides {
    fn default() -> Self {
        Self {
            // below, designers mean a smooth join
            turn_deg: 15.0,
            // what reads as a corner in type
            sharp_deg: 40.0,
        }
    }
}

/// A turn of the contour over its clearance at least this part of the smallest corner is looked at: the
/// blur hides some of it.
const CANDIDATE: f64 = 0.6;

/// Standard deviation of the interpolation between pixels, px: a tent of ±1 px.
const TENT_PX: f64 = 0.408;
/// A ring shorter than this many clearances has no room for sides between its corners.
const SMALL: f64 = 10.0;
/// A sharp corner may keep off this many times what blur explains: the estimate is good for 90°.
const NEEDLE: f64 = 1.2;

impl Detector for Sides {
    fn corners(&self, contour: &Contour) -> Vec<usize> {
        let contour = calm(contour);
        self.kept(&contour, |i, m| self.is_corner(&contour, i, m))
    }

    fn possible(&self, contour: &Contour) -> Option<Vec<usize>> {
        let turn = self.turn_deg.to_radians();
        Some(self.kept(&calm(contour), |_, m| m.turn.abs() >= turn))
    }
}

impl Sides {
    /// The candidates whose sides meet as `fits` asks.
    fn kept(&self, contour: &Contour, fits: impl Fn(usize, &Meeting) -> bool) -> Vec<usize> {
        let mut at = self.candidates(contour);
        // each refusal frees its neighbours' sides
        loop {
            let all = Corners::new(contour, &at);
            let kept: Vec<usize> = (0..at.len())
                .filter(|&k| all.corner(k).is_some_and(|c| fits(at[k], &c.meeting)))
                .map(|k| at[k])
                .collect();
            let done = kept.len() == at.len();
            at = kept;
            if done {
                return at;
            }
        }
    }

    /// Where the contour turns more than anywhere near.
    fn candidates(&self, contour: &Contour) -> Vec<usize> {
        let p = contour.points();
        let n = p.len();
        let length: f64 = (0..n).map(|i| p[i].distance(p[(i + 1) % n])).sum();
        let reach = clearance_px(contour) + 0.5;
        if length < SMALL * reach {
            return Vec::new();
        }
        let turn: Vec<f64> = (0..n)
            .map(|i| {
                let (a, b) = (
                    p[i] - along(p, i, n - 1, reach),
                    along(p, i, 1, reach) - p[i],
                );
                angle(a, b).abs().to_degrees()
            })
            .collect();
        let peak = |i: usize| {
            let near = |j: &usize| p[*j].distance(p[i]) < reach;
            let ahead = (1..n).map(|k| (i + k) % n).take_while(near);
            let behind = (1..n).map(|k| (i + n - k) % n).take_while(near);
            ahead
                .chain(behind)
                .all(|j| turn[j] < turn[i] || (turn[j] <= turn[i] && j > i))
        };
        let least = CANDIDATE * self.turn_deg;
        (0..n).filter(|&i| turn[i] >= least && peak(i)).collect()
    }

    /// Whether the meeting of the sides at point `i` explains the contour there better than an arc.
    fn is_corner(&self, contour: &Contour, i: usize, m: &Meeting) -> bool {
        let turn = m.turn.abs();
        if turn < self.turn_deg.to_radians() {
            return false;
        }
        let half = (turn / 2.0).min(1.5);
        let corner = contour.blur_px().hypot(TENT_PX).hypot(contour.ragged_px())
            * std::f64::consts::FRAC_2_PI.sqrt()
            * libm::tan(half);
        let radius = clearance_px(contour) / libm::tan(half);
        let arc = radius * (1.0 / libm::cos(half) - 1.0);
        let seen = gap(contour.points(), i, m.apex);
        let sharp = turn >= self.sharp_deg.to_radians();
        if sharp {
            // a needle's blur reaches beyond the clearance
            seen < (0.25 * corner + 0.75 * arc).max(NEEDLE * corner) + m.noise
        } else {
            arc - corner > 2.0 * m.noise && seen < (corner + arc) / 2.0
        }
    }
}

/// The point `distance` px along the contour from point `i`, walking by `step` indices.
fn along(p: &[Point], i: usize, step: usize, distance: f64) -> Point {
    let (mut j, mut left) = (i, distance);
    for _ in 0..p.len() {
        let next = (j + step) % p.len();
        let d = p[j].distance(p[next]);
        if d >= left {
            return p[j].lerp(p[next], left / d);
        }
        left -= d;
        j = next;
    }
    p[j]
}

/// Distance of `apex` from the contour near point `i`, px.
fn gap(p: &[Point], i: usize, apex: Point) -> f64 {
    let n = p.len();
    let near = (0..12.min(n)).map(|k| (i + n + k - 6.min(n / 2)) % n);
    let edges = near.map(|j| Line::new(p[j], p[(j + 1) % n]));
    edges
        .map(|e| e.nearest(apex, 1e-6).distance_sq)
        .fold(f64::INFINITY, f64::min)
        .sqrt()
}
