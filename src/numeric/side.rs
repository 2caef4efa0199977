//! The two sides of a corner: lines or parabolas through the points beside it, and where they meet.

use super::angles::angle;
use kurbo::{Point, Vec2};
use nalgebra::{Matrix3, Vector3};

/// A parabola over a straight axis, or a line where the points show no more.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    origin: Point,
    /// unit vector along the points
    along: Vec2,
    /// height over the axis: c0 + c1 x + c2 x²
    height: [f64; 3],
    /// covariance of `height` for points of unit noise
    covariance: Matrix3<f64>,
    /// scatter of the points about it, px, degrees of freedom taken into account
    scatter: f64,
    /// least scatter that is believed, px
    floor: f64,
}

/// Where two sides meet.
#[derive(Debug, Clone, Copy)]
pub struct Meeting {
    /// The place.
    pub apex: Point,
    /// Turn from the first side to the second, radians, positive to the left.
    pub turn: f64,
    /// Standard deviation of the apex along the bisector, px.
    pub noise: f64,
}

/// What tracing itself scatters on a straight edge without noise, px: the bilinear surface follows the
/// pixels' steps.
const FLOOR_PX: f64 = 0.02;
/// How far ragged ink's edge strays, in the length along which it does.
const SCATTER: f64 = 0.1;
/// A longer side is taken as long as its points scatter no more than this many times the shorter's.
const GROWTH: f64 = 1.3;
/// Points of the shortest and the longest side that is tried.
const REACH: (usize, usize) = (5, 20);

/// Least scatter of a side's points, px, along ink that is ragged over `ragged_px`.
#[must_use]
pub fn scatter_px(ragged_px: f64) -> f64 {
    FLOOR_PX.hypot(SCATTER * ragged_px)
}

impl Side {
    /// The side through `points`, in their order along the contour, which scatter by `floor` px at least; nothing
    /// from fewer than two.
    #[must_use]
    pub fn through(points: &[Point], floor: f64) -> Option<Self> {
        let (first, last) = (points.first()?, points.last()?);
        let along = *last - *first;
        if along.hypot() < 1e-9 {
            return None;
        }
        let (origin, along) = (first.midpoint(*last), along.normalize());
        let local = |p: &Point| (along.dot(*p - origin), along.cross(*p - origin));
        let mut normal = Matrix3::zeros();
        let mut right = Vector3::zeros();
        let mut squares = 0.0;
        for (x, y) in points.iter().map(local) {
            let v = Vector3::new(1.0, x, x * x);
            normal += v * v.transpose();
            right += v * y;
            squares += y * y;
        }
        let n = points.len() as f64;
        let solved = |parameters: usize| {
            let mut inverse = Matrix3::zeros();
            let part = normal
                .view((0, 0), (parameters, parameters))
                .into_owned()
                .try_inverse()?;
            inverse
                .view_mut((0, 0), (parameters, parameters))
                .copy_from(&part);
            let c = inverse * right;
            let rest = (squares - c.dot(&right)).max(0.0);
            let free = n - parameters as f64;
            let scatter = if free > 0.0 {
                (rest / free).sqrt()
            } else {
                0.0
            };
            Some((c, inverse, scatter))
        };
        let line = solved(2)?;
        let curve = if points.len() > 4 { solved(3) } else { None };
        let least = |s: f64| s * s + floor * floor;
        // a parabola where it explains more than two standard deviations of chance would
        let bent = curve.filter(|c| least(line.2) > least(c.2) * (1.0 + 4.0 / (n - 3.0)));
        let (c, covariance, scatter) = bent.unwrap_or(line);
        Some(Self {
            origin,
            along,
            height: [c[0], c[1], c[2]],
            covariance,
            scatter,
            floor,
        })
    }

    /// The side through as many of `points` as one parabola explains, the ones next to the corner last
    /// (`before` it) or first (after it).
    #[must_use]
    pub fn beside(points: &[Point], place: Place, floor: f64) -> Option<Self> {
        let part = |n: usize| match place {
            Place::Before => &points[points.len() - n..],
            Place::After => &points[..n],
        };
        let most = points.len().min(REACH.1);
        let mut n = most.min(REACH.0);
        let mut best = Self::through(part(n), floor)?;
        let limit = (best.scatter * GROWTH).hypot(floor);
        while n < most {
            n = (n + n.div_ceil(3)).min(most);
            match Self::through(part(n), floor) {
                Some(s) if s.scatter <= limit => best = s,
                _ => break,
            }
        }
        Some(best)
    }

    fn point(&self, x: f64) -> Point {
        let [a, b, c] = self.height;
        let normal = self.along.turn_90();
        self.origin + self.along * x + normal * (a + x * (b + x * c))
    }

    fn tangent(&self, x: f64) -> Vec2 {
        let normal = self.along.turn_90();
        self.along + normal * (self.height[1] + 2.0 * self.height[2] * x)
    }

    /// Standard deviation of the height at `x`, px.
    fn noise(&self, x: f64) -> f64 {
        let v = Vector3::new(1.0, x, x * x);
        let lever = (v.transpose() * self.covariance * v)[0];
        lever.max(0.0).sqrt() * self.scatter.max(self.floor)
    }

    /// Where this side and the one after it meet, found from `near`; nothing if they do not within
    /// `reach` px of it.
    #[must_use]
    pub fn meet(&self, after: &Self, near: Point, reach: f64) -> Option<Meeting> {
        let mut a = self.along.dot(near - self.origin);
        let mut b = after.along.dot(near - after.origin);
        for _ in 0..12 {
            let gap = after.point(b) - self.point(a);
            let (u, v) = (self.tangent(a), after.tangent(b));
            let cross = u.cross(v);
            if cross.abs() < 1e-3 * u.hypot() * v.hypot() {
                return None;
            }
            let (da, db) = (gap.cross(v) / cross, gap.cross(u) / cross);
            a += da.clamp(-reach, reach);
            b += db.clamp(-reach, reach);
            if da.abs().max(db.abs()) < 1e-9 {
                break;
            }
        }
        let apex = self.point(a).midpoint(after.point(b));
        let (u, v) = (self.tangent(a), after.tangent(b));
        let turn = angle(u, v);
        let noise = self.noise(a).hypot(after.noise(b)) / 2.0 / libm::cos(turn / 2.0).max(0.1);
        let met = self.point(a).distance(after.point(b)) < 1e-3 && apex.distance(near) <= reach;
        met.then_some(Meeting { apex, turn, noise })
    }
}

/// On which side of a corner points lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// on the way to it
    Before,
    /// on the way from it
    After,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::{angles, cast::index};

    /// Points of a circle about `centre` between two angles, half a pixel apart.
    fn arc(centre: Point, radius: f64, from: f64, to: f64) -> Vec<Point> {
        let n = index((to - from).abs() * radius / 0.5);
        let at = |i: usize| {
            centre + radius * angles::direction(from + (to - from) * i as f64 / n as f64)
        };
        (0..=n).map(at).collect()
    }

    #[test]
    fn lines_meet_where_they_cross_and_say_which_way_they_turn() {
        let before: Vec<Point> = (0..12).map(|i| Point::new(f64::from(i), 0.0)).collect();
        for (dy, turn) in [(1.0, 45.0_f64), (-1.0, -45.0)] {
            let after: Vec<Point> = (2..14)
                .map(|i| Point::new(14.0 + f64::from(i), dy * f64::from(i)))
                .collect();
            let (a, b) = (
                Side::through(&before, FLOOR_PX).unwrap(),
                Side::through(&after, FLOOR_PX).unwrap(),
            );
            let met = a.meet(&b, Point::new(13.0, 0.5), 5.0).unwrap();
            assert!(met.apex.distance(Point::new(14.0, 0.0)) < 1e-9, "{met:?}");
            assert!((met.turn - turn.to_radians()).abs() < 1e-9, "{met:?}");
            assert!(
                a.meet(&b, Point::new(3.0, 0.0), 5.0).is_none(),
                "out of reach"
            );
            assert!(a.meet(&a, Point::new(13.0, 0.0), 5.0).is_none(), "parallel");
        }
    }

    #[test]
    fn arcs_meet_at_the_tip_of_the_lens_between_them() {
        // two circles of radius 40 whose centres are 48 apart cross 32 above the middle
        let before = arc(Point::new(-24.0, 0.0), 40.0, 0.5, 0.85);
        let after = arc(Point::new(24.0, 0.0), 40.0, 2.29, 2.64);
        let (a, b) = (
            Side::through(&before, FLOOR_PX).unwrap(),
            Side::through(&after, FLOOR_PX).unwrap(),
        );
        let met = a.meet(&b, Point::new(0.0, 31.0), 8.0).unwrap();
        assert!(met.apex.distance(Point::new(0.0, 32.0)) < 0.15, "{met:?}");
    }

    #[test]
    fn a_side_knows_how_well_it_is_known() {
        let noisy = |n: i32| -> Vec<Point> {
            (0..n)
                .map(|i| Point::new(f64::from(i), 0.1 * f64::from(i * i % 3)))
                .collect()
        };
        let up: Vec<Point> = (2..14).map(|i| Point::new(-2.0, f64::from(i))).collect();
        let up = Side::through(&up, FLOOR_PX).unwrap();
        let noise = |n: i32| {
            let side = Side::through(&noisy(n), FLOOR_PX).unwrap();
            up.meet(&side, Point::ORIGIN, 9.0).unwrap().noise
        };
        assert!(noise(20) < 0.5 * noise(6), "{} {}", noise(20), noise(6));
    }

    #[test]
    fn few_points_make_no_side_or_a_line() {
        assert!(Side::through(&[], FLOOR_PX).is_none());
        assert!(Side::through(&[Point::ORIGIN], FLOOR_PX).is_none());
        assert!(Side::through(&[Point::ORIGIN, Point::ORIGIN], FLOOR_PX).is_none());
        assert!(Side::through(&[Point::ORIGIN, Point::new(1.0, 0.0)], FLOOR_PX).is_some());
    }

    #[test]
    fn a_side_ends_where_another_curve_begins() {
        // ten points of a line, then a sharp bend away from it
        let mut points: Vec<Point> = (0..10).map(|i| Point::new(f64::from(i), 0.0)).collect();
        points.extend((1..11).map(|i| Point::new(9.0 + 0.3 * f64::from(i), f64::from(i))));
        let side = Side::beside(&points, Place::After, FLOOR_PX).unwrap();
        assert!(side.tangent(0.0).cross(Vec2::new(1.0, 0.0)).abs() < 1e-9);
    }
}
