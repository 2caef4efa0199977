//! Corners by changes of slope, in three phases.
//!
//! ```text
//! Source   [rasheed05 sec. 2.1, eq. 2.1-2.5]
//! Solves   phase 1: points where the slope's sign changes; 2: one of those that lie close; 3: those whose
//!          angle with their neighbours is at most TA
//! Takes    n >= 3 points, px, y up, best a chain of pixels
//! Gives    indices of the corners
//! Symbols  ZCT -> zero_count, DT -> distance_px, TA -> angle_deg, T_i -> slope signs
//! Departs  of candidates within DT the one with the sharpest angle stays; phase 3 takes the flattest first
//!          and looks again, so that the start of the ring does not matter; a vector along an axis counts as
//!          such within 1/1000
//! Cost     O(n + k^2) for k candidates      Fails  never
//! ```
//!
//! The signs are those of the picture's axes: corners inside one quadrant of directions are not seen, round
//! shapes have corners at their extrema, and turning the picture changes what is found. The tables
//! measure how much.

use super::Detector;
use crate::numeric::angles::angle;
use crate::types::Contour;
use kurbo::{Point, Vec2};
use serde::{Deserialize, Serialize};

/// Options of the SRM05 detector; the defaults are the thesis's.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Srm05 {
    /// Points along an axis that make a line and not a jaggy, ZCT.
    pub zero_count: usize,
    /// Candidates closer than this are one, DT, px.
    pub distance_px: f64,
    /// Angle between neighbours above which a candidate is no corner, TA, degrees.
    pub angle_deg: f64,
}

impl Default for Srm05 {
    fn default() -> Self {
        Self {
            zero_count: 7,
            distance_px: 5.0,
            angle_deg: 152.0,
        }
    }
}

/// The three states of a slope.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Slope {
    Rising,
    Falling,
    Zero,
}

/// Part of a vector's length below which a coordinate counts as none.
const AXIS: f64 = 1e-3;

impl Detector for Srm05 {
    fn corners(&self, contour: &Contour) -> Vec<usize> {
        let points = contour.points();
        let candidates = self.candidates(points);
        let apart = self.refined(points, &candidates);
        self.sharp(points, apart)
    }
}

impl Srm05 {
    /// Phase 1: points that come after a change of slope. Short runs along an axis are passed over, and the
    /// slope before them is kept.
    fn candidates(&self, points: &[Point]) -> Vec<usize> {
        let n = points.len();
        let slopes: Vec<Slope> = (0..n).map(|i| slope(tangent(points, i))).collect();
        let Some(start) = (0..n).find(|&i| slopes[i] != slopes[(i + n - 1) % n]) else {
            return Vec::new();
        };
        // runs of one slope around the ring: where each begins, and its slope
        let mut runs: Vec<(usize, usize, Slope)> = Vec::new();
        for k in start..start + n {
            let s = slopes[k % n];
            match runs.last_mut() {
                Some(r) if r.2 == s => r.1 += 1,
                _ => runs.push((k % n, 1, s)),
            }
        }
        runs.retain(|r| r.2 != Slope::Zero || r.1 >= self.zero_count);
        let count = runs.len();
        let changed = |i: usize| runs[i].2 != runs[(i + count - 1) % count].2;
        (0..count)
            .filter(|&i| changed(i))
            .map(|i| runs[i].0)
            .collect()
    }

    /// Phase 2: of candidates that follow each other within DT the sharpest.
    fn refined(&self, points: &[Point], candidates: &[usize]) -> Vec<usize> {
        let mut sorted = candidates.to_vec();
        sorted.sort_unstable();
        let close = |a: usize, b: usize| points[a].distance(points[b]) <= self.distance_px;
        let mut groups: Vec<Vec<usize>> = Vec::new();
        for &c in &sorted {
            match groups.last_mut() {
                Some(g) if g.last().is_some_and(|&l| close(l, c)) => g.push(c),
                _ => groups.push(vec![c]),
            }
        }
        let around = match (groups.first(), groups.last()) {
            (Some(a), Some(z)) if groups.len() > 1 => {
                a.first().zip(z.last()).is_some_and(|(&a, &z)| close(z, a))
            }
            _ => false,
        };
        if around
            && let Some(last) = groups.pop()
            && let Some(first) = groups.first_mut()
        {
            first.extend(last);
        }
        let turn = |i: usize| opening(points, i, self.distance_px);
        let mut out: Vec<usize> = groups
            .iter()
            .filter_map(|g| {
                g.iter()
                    .copied()
                    .min_by(|&a, &b| turn(a).total_cmp(&turn(b)))
            })
            .collect();
        out.sort_unstable();
        out
    }

    /// Phase 3: leaves out candidates that lie nearly between their neighbours, the flattest first.
    fn sharp(&self, points: &[Point], mut corners: Vec<usize>) -> Vec<usize> {
        loop {
            let n = corners.len();
            if n < 3 {
                return corners;
            }
            let at = |i: usize| points[corners[i % n]];
            let angle = |i: usize| between(at(i + n - 1) - at(i), at(i + 1) - at(i)).to_degrees();
            let flattest = (0..n).max_by(|&a, &b| angle(a).total_cmp(&angle(b)));
            match flattest.filter(|&i| angle(i) > self.angle_deg) {
                Some(i) => corners.remove(i),
                None => return corners,
            };
        }
    }
}

/// Eq. 2.3-2.4, cyclic.
fn tangent(points: &[Point], i: usize) -> Vec2 {
    let n = points.len();
    let before = points[i] - points[(i + n - 1) % n];
    let after = points[(i + 1) % n] - points[i];
    let a = after.hypot() / (after.hypot() + before.hypot());
    before * a + after * (1.0 - a)
}

fn slope(t: Vec2) -> Slope {
    if t.x.abs().min(t.y.abs()) <= AXIS * t.hypot() {
        Slope::Zero
    } else if (t.x > 0.0) == (t.y > 0.0) {
        Slope::Rising
    } else {
        Slope::Falling
    }
}

/// The angle at point `i` between the contour's points `reach` before and after it, radians.
fn opening(points: &[Point], i: usize, reach: f64) -> f64 {
    let n = points.len();
    let away = |step: usize| {
        let walk = (1..n).map(|k| points[(i + k * step) % n]);
        walk.take(n / 2).find(|p| p.distance(points[i]) >= reach)
    };
    match (away(1), away(n - 1)) {
        (Some(a), Some(b)) => between(a - points[i], b - points[i]),
        _ => 0.0,
    }
}

/// Eq. 2.5: the angle between two vectors, 0…π.
fn between(a: Vec2, b: Vec2) -> f64 {
    angle(a, b).abs()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The boundary pixels of an upright rectangle.
    fn rectangle(w: i32, h: i32) -> Contour {
        let side = |n: i32, f: &dyn Fn(i32) -> (i32, i32)| -> Vec<Point> {
            (0..n)
                .map(|i| (f64::from(f(i).0), f64::from(f(i).1)).into())
                .collect()
        };
        let sides = [
            side(w, &|i| (i, 0)),
            side(h, &|i| (w, i)),
            side(w, &|i| (w - i, h)),
            side(h, &|i| (0, h - i)),
        ];
        Contour::new(sides.concat()).unwrap()
    }

    #[test]
    fn a_rectangle_has_four() {
        let c = rectangle(40, 25);
        let at: Vec<Point> = Srm05::default()
            .corners(&c)
            .iter()
            .map(|&i| c.points()[i])
            .collect();
        assert_eq!(at.len(), 4, "{at:?}");
        for (x, y) in [(0.0, 0.0), (40.0, 0.0), (40.0, 25.0), (0.0, 25.0)] {
            assert!(at.iter().any(|p| p.distance((x, y).into()) < 2.0), "{at:?}");
        }
    }

    #[test]
    fn a_jaggy_is_no_corner() {
        // a line of slope 1/4 in steps of one pixel, there, and straight back below it
        let mut p: Vec<Point> = (0..=48).map(|i| (f64::from(i), -20.0).into()).collect();
        p.extend(
            (0..=48)
                .rev()
                .map(|i| Point::new(f64::from(i), f64::from(i / 4))),
        );
        let c = Contour::new(p).unwrap();
        let found = Srm05::default().corners(&c);
        assert!(found.len() <= 4, "{found:?}");
    }
}
