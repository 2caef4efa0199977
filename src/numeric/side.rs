//! The two sides of a corner: lines or parabolas through the points beside it, and where they meet.

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
/// A longer side is taken as long as its points scatter no more than this many times the shorter's.
const GROWTH: f64 = 1.3;
/// Points of the shortest and the longest side that is tried.
const REACH: (usize, usize) = (5, 20);

impl Side {
    /// The side through `points`, in their order along the contour; nothing from fewer than two.
    #[must_use]
    pub fn through(points: &[Point]) -> Option<Self> {
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
        let floor = |s: f64| s * s + FLOOR_PX * FLOOR_PX;
        // a parabola where it explains more than two standard deviations of chance would
        let bent = curve.filter(|c| floor(line.2) > floor(c.2) * (1.0 + 4.0 / (n - 3.0)));
        let (c, covariance, scatter) = bent.unwrap_or(line);
        Some(Self {
            origin,
            along,
            height: [c[0], c[1], c[2]],
            covariance,
            scatter,
        })
    }

    /// The side through as many of `points` as one parabola explains, the ones next to the corner last
    /// (`before` it) or first (after it).
    #[must_use]
    pub fn beside(points: &[Point], place: Place) -> Option<Self> {
        let part = |n: usize| match place {
            Place::Before => &points[points.len() - n..],
            Place::After => &points[..n],
        };
        let most = points.len().min(REACH.1);
        let mut n = most.min(REACH.0);
        let mut best = Self::through(part(n))?;
        let limit = (best.scatter * GROWTH).hypot(FLOOR_PX);
        while n < most {
            n = (n + n.div_ceil(3)).min(most);
            match Self::through(part(n)) {
                Some(s) if s.scatter <= limit => best = s,
                _ => break,
            }
        }
        Some(best)
    }

    fn point(&self, x: f64) -> Point {
        let [a, b, c] = self.height;
        let normal = Vec2::new(-self.along.y, self.along.x);
        self.origin + self.along * x + normal * (a + x * (b + x * c))
    }

    fn tangent(&self, x: f64) -> Vec2 {
        let normal = Vec2::new(-self.along.y, self.along.x);
        self.along + normal * (self.height[1] + 2.0 * self.height[2] * x)
    }

    /// Standard deviation of the height at `x`, px.
    fn noise(&self, x: f64) -> f64 {
        let v = Vector3::new(1.0, x, x * x);
        let lever = (v.transpose() * self.covariance * v)[0];
        lever.max(0.0).sqrt() * self.scatter.max(FLOOR_PX)
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
        let turn = u.cross(v).atan2(u.dot(v));
        let noise = self.noise(a).hypot(after.noise(b)) / 2.0 / (turn / 2.0).cos().max(0.1);
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
