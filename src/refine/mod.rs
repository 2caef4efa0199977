//! Contours or curves and the grey picture → those that explain the picture.
//!
//! | takes | gives |
//! |---|---|
//! | coverage ([`Gray`]), [`Contour`]s with possible corners | which of them are drawn ([`confirmed`]) |
//! | coverage, contours with their corners | the same, moved by fractions of a pixel ([`contours`]) |
//! | coverage, fitted paths | doubts about their corners, nodes settled, wrong places mended ([`Comparison`]) |
//!
//! An iso-contour is not the drawing's edge: blur pulls it inwards where the edge bends and rounds its
//! corners, thin strokes lose to both their sides, and it follows the noise of two pixels at a time.
//! Here the shape itself is drawn, blurred as the picture is and compared with it; each point then moves by
//! what the difference around it says. Nothing is approximated but the linear step, which is repeated.
//!
//! Contours and paths stand upright. Where the picture's pixels do not ([`Gray::upright`]), they are drawn on the
//! pixels as these lie: no step asks for a pixel that the scanner did not see.

mod blunt;
mod comparison;
mod corners;
mod crossings;
mod mend;
mod nodes;
mod residual;
#[cfg(test)]
mod tests;

/// What this stage asks of curves by themselves.
mod curves {
    pub(super) use crate::numeric::curves::{
        arriving, control_length as polygon_px, leaving, polygon,
    };
}

pub use blunt::Overlooked;
pub use comparison::{Comparison, Doubts, squares_left};
pub use corners::confirmed;

use crate::{
    numeric::{
        many::change,
        side::{Place, Side, scatter_px},
    },
    types::{Contour, Gray},
};
use kurbo::{Point, Vec2};
use residual::Residual;

/// A contour and the increasing indices of its corners.
pub type Cornered = (Contour, Vec<usize>);

/// Steps. Each leaves about a fifth of the error along a straight edge, more at a bend.
const ROUNDS: usize = 3;
/// No point moves further from where the contour ran, px: further away it is another edge's.
const REACH_PX: f64 = 0.75;
/// A corner comes from two sides that move; it may travel further, px.
const CORNER_REACH_PX: f64 = 2.0;

/// The contours of one picture, moved to where their blurred fill is the picture.
#[must_use]
pub fn contours(gray: &Gray, traced: &[Cornered]) -> Vec<Cornered> {
    let mut rings: Vec<Ring<'_>> = traced.iter().map(Ring::new).collect();
    let Some((first, _)) = traced.first() else {
        return Vec::new();
    };
    let mut residual = Residual::new(gray, points(&rings), first.blur_px());
    for round in 0..ROUNDS {
        if round > 0 {
            residual.update(points(&rings));
        }
        change(&mut rings, |r| r.step(&residual));
    }
    rings.into_iter().map(Ring::finish).collect()
}

fn points<'r>(rings: &'r [Ring<'_>]) -> impl Iterator<Item = &'r [Point]> {
    rings.iter().map(|r| r.points.as_slice())
}

/// A contour on its way.
struct Ring<'a> {
    from: &'a Cornered,
    points: Vec<Point>,
}

impl<'a> Ring<'a> {
    fn new(from: &'a Cornered) -> Self {
        let points = from.0.points().to_vec();
        Self { from, points }
    }

    fn step(&mut self, residual: &Residual<'_>) {
        let n = self.points.len();
        let (start, corners) = (self.from.0.points(), &self.from.1);
        let mut corner = vec![false; n];
        corners.iter().for_each(|&i| corner[i] = true);
        let told = self.told(residual.reach_px());
        let shift = |i: usize| told[i].then(|| residual.shift(self.points[i]));
        let shifts: Vec<Option<f64>> = (0..n).map(shift).collect();
        let shifts = averaged(&shifts, &corner, &residual.kernel());
        let outward = |i: usize| {
            let along = self.points[(i + 1) % n] - self.points[(i + n - 1) % n];
            Vec2::new(along.y, -along.x).normalize()
        };
        // a corner's own shift is 0, and a direction that is none leaves its point in place
        let to = |i: usize| within(start[i], self.points[i] + shifts[i] * outward(i), REACH_PX);
        let keep = |i: usize| if corner[i] { self.points[i] } else { to(i) };
        self.points = (0..n).map(keep).collect();
        for (k, &i) in corners.iter().enumerate() {
            if let Some(apex) = self.apex(k) {
                self.points[i] = within(start[i], apex, CORNER_REACH_PX);
            }
        }
    }

    /// Whether the differences around each point are its own edge's: around a corner they are those of its place,
    /// which is not known yet.
    fn told(&self, reach: f64) -> Vec<bool> {
        let p = &self.points;
        let n = p.len();
        let mut told = vec![true; n];
        for &i in &self.from.1 {
            told[i] = false;
            for step in [1, n - 1] {
                let first = p[(i + step) % n];
                let mut j = (i + step) % n;
                while p[j].distance(first) < reach && told[j] {
                    told[j] = false;
                    j = (j + step) % n;
                }
            }
        }
        told
    }

    /// Where the sides of corner number `k` meet now.
    fn apex(&self, k: usize) -> Option<Point> {
        let corners = &self.from.1;
        let n = corners.len();
        let before = self.between(corners[(k + n - 1) % n], corners[k]);
        let after = self.between(corners[k], corners[(k + 1) % n]);
        let from = &self.from.0;
        let floor = scatter_px(from.ragged_px()).hypot(from.scatter_px());
        let sides = (
            Side::beside(&before, Place::Before, floor)?,
            Side::beside(&after, Place::After, floor)?,
        );
        let meeting = sides
            .0
            .meet(&sides.1, self.points[corners[k]], CORNER_REACH_PX)?;
        Some(meeting.apex)
    }

    /// The points between two corners.
    fn between(&self, a: usize, b: usize) -> Vec<Point> {
        let n = self.points.len();
        let count = (b + n - a - 1) % n;
        (1..=count).map(|j| self.points[(a + j) % n]).collect()
    }

    /// The contour that the points make; the one it came from if they make none.
    fn finish(self) -> Cornered {
        let (from, corners) = self.from;
        match from.through(self.points) {
            Ok(c) if c.points().len() == from.points().len() => (c, corners.clone()),
            _ => self.from.clone(),
        }
    }
}

/// Values of a ring's points, each averaged with its neighbours by `kernel` (weights from the point itself
/// outwards) as far as the next corner; 0 where none has a value.
fn averaged(values: &[Option<f64>], corner: &[bool], kernel: &[f64]) -> Vec<f64> {
    let n = values.len();
    let average = |i: usize| {
        let mut sum = values[i].unwrap_or(0.0);
        let mut total = f64::from(u8::from(values[i].is_some()));
        for step in [1, n - 1] {
            let mut j = i;
            for k in kernel.iter().skip(1) {
                // no division: this is done for every point and each of its neighbours
                j += step;
                j -= if j < n { 0 } else { n };
                if corner[j] {
                    break;
                }
                if let Some(v) = values[j] {
                    sum += k * v;
                    total += k;
                }
            }
        }
        if total > 0.0 {
            sum / total
        } else {
            nearest(values, corner, i)
        }
    };
    (0..n)
        .map(|i| if corner[i] { 0.0 } else { average(i) })
        .collect()
}

/// The value nearest to point `i`, as far as the next corners; 0 where there is none.
fn nearest(values: &[Option<f64>], corner: &[bool], i: usize) -> f64 {
    let n = values.len();
    let walk = |step: usize| {
        let way = (1..n).map(move |d| (i + d * step) % n);
        way.take_while(|&j| !corner[j])
            .enumerate()
            .find_map(|(d, j)| values[j].map(|v| (d, v)))
    };
    let both = [walk(1), walk(n - 1)].into_iter().flatten();
    both.min_by_key(|(d, _)| *d).map_or(0.0, |(_, v)| v)
}

/// `to`, or where the way there leaves the circle of `reach` around `from`.
fn within(from: Point, to: Point, reach: f64) -> Point {
    let way = to - from;
    let d = way.hypot();
    if d.is_nan() {
        from
    } else if d > reach {
        from + way * (reach / d)
    } else {
        to
    }
}
