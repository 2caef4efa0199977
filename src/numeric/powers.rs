//! A cubic by powers of its parameter, and the feet of points on it, several side by side.

use kurbo::{CubicBez, Point, Vec2};
use std::{array::from_fn, ops::RangeInclusive};

/// Points whose feet are found side by side.
pub const LANES: usize = 4;
/// A step of a foot after which the next is next to nothing, parameter.
const NEAR: f64 = 0.01;

/// Coefficients of 1, t, t², t³.
#[derive(Debug, Clone, Copy)]
pub struct Powers([Vec2; 4]);

impl Powers {
    /// Those of a cubic.
    #[must_use]
    pub fn new(c: &CubicBez) -> Self {
        let [p0, p1, p2, p3] = [c.p0, c.p1, c.p2, c.p3].map(Point::to_vec2);
        Self([
            p0,
            3.0 * (p1 - p0),
            3.0 * (p0 - 2.0 * p1 + p2),
            p3 - p0 + 3.0 * (p1 - p2),
        ])
    }

    /// Place, first and second derivative at `t`.
    #[must_use]
    pub fn at(&self, t: f64) -> (Point, Vec2, Vec2) {
        let [a, b, c, d] = self.0;
        let p = ((d * t + c) * t + b) * t + a;
        (
            p.to_point(),
            (3.0 * t * d + 2.0 * c) * t + b,
            6.0 * t * d + 2.0 * c,
        )
    }

    /// Moves the parameters `t` towards the feet of the points `at` by at most two of Newton's steps, none longer
    /// than `stride` nor out of `range`. Feet do not depend on those beside them.
    #[must_use]
    pub fn feet<const N: usize>(
        &self,
        at: [Point; N],
        mut t: [f64; N],
        (stride, range): (f64, RangeInclusive<f64>),
    ) -> [f64; N] {
        let mut moving = [true; N];
        for _ in 0..2 {
            let steps: [f64; N] = from_fn(|k| {
                let (p, d, dd) = self.at(t[k]);
                let off = p - at[k];
                let speed = d.hypot2();
                let bend = speed + off.dot(dd);
                off.dot(d) / bend.max(0.25 * speed).max(1e-12)
            });
            for k in 0..N {
                let to = t[k] - steps[k].clamp(-stride, stride);
                let to = to.clamp(*range.start(), *range.end());
                // one that hardly moved takes no second step
                t[k] = if moving[k] { to } else { t[k] };
                moving[k] &= steps[k].abs() >= NEAR;
            }
            if !moving.contains(&true) {
                break;
            }
        }
        t
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{ParamCurve as _, ParamCurveNearest as _};

    #[test]
    fn feet_are_nearest_and_do_not_hang_on_their_neighbours() {
        let c = CubicBez::new((0.0, 0.0), (10.0, 25.0), (40.0, 30.0), (60.0, 5.0));
        let powers = Powers::new(&c);
        let free = || (1.0, 0.0..=1.0);
        let at: [Point; LANES] = from_fn(|k| {
            let p = c.eval(0.2 + 0.15 * k as f64);
            Point::new(p.x + 0.3, p.y - 0.5)
        });
        let guess: [f64; LANES] = from_fn(|k| 0.24 + 0.15 * k as f64);
        let t = powers.feet(at, guess, free());
        for k in 0..LANES {
            let near = c.nearest(at[k], 1e-9);
            assert!((t[k] - near.t).abs() < 1e-4, "{} {}", t[k], near.t);
            let alone = powers.feet([at[k]], [guess[k]], free());
            assert!((alone[0] - t[k]).abs() <= 0.0);
        }
    }
}
