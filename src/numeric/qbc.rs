//! Quasi-Bézier curves of any degree [sohel sec. III.A].
//!
//! A quadratic one is Q = (1 - w) S + w G: S the Bézier point, G the centroid of A, p1, B, where A
//! and B divide the legs of the control polygon as u divides 1, and w = k u (1 - u) with k = 1
//! (QBC, eq. 5) or k = 4 (QBC-n, eq. 9). It is a polynomial of degree 4, so it needs approximating
//! where a format stores only quadratics or cubics. A higher degree repeats the step on
//! neighbouring points (eq. 6 and 7).

use kurbo::{CubicBez, ParamCurve, Point, Vec2};

/// How far the points move from the Bézier curve towards the control polygon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pull {
    /// Not at all: the classical curve.
    Bezier,
    /// w = u (1 - u).
    Qbc,
    /// w = 4 u (1 - u).
    QbcN,
}

impl Pull {
    /// k in w = k u (1 - u).
    #[must_use]
    pub const fn factor(self) -> f64 {
        match self {
            Self::Bezier => 0.0,
            Self::Qbc => 1.0,
            Self::QbcN => 4.0,
        }
    }

    /// Weights of the three points of a quadratic curve at `u` [sohel sec. III.A, eq. 5 and 9]; they add to 1.
    #[must_use]
    pub fn quadratic(self, u: f64) -> [f64; 3] {
        let v = 1.0 - u;
        let w = self.factor() * u * v;
        [
            (1.0 - w) * v * v + w * v / 3.0,
            (1.0 - w) * 2.0 * u * v + w * 2.0 / 3.0,
            (1.0 - w) * u * u + w * u / 3.0,
        ]
    }

    /// Their derivatives by u.
    fn slopes(self, u: f64) -> [f64; 3] {
        let v = 1.0 - u;
        let (k, w) = (self.factor(), self.factor() * u * v);
        let dw = k * (v - u);
        [
            (1.0 - w) * -2.0 * v - dw * v * v + dw * v / 3.0 - w / 3.0,
            (1.0 - w) * 2.0 * (v - u) - dw * 2.0 * u * v + dw * 2.0 / 3.0,
            (1.0 - w) * 2.0 * u - dw * u * u + dw * u / 3.0 + w / 3.0,
        ]
    }

    /// Point and derivative by u of the curve of these control points, degree one less than their number.
    #[must_use]
    pub fn eval(self, points: &[Point], u: f64) -> (Point, Vec2) {
        let still: Vec<(Point, Vec2)> = points.iter().map(|&p| (p, Vec2::ZERO)).collect();
        if self == Self::Bezier || still.len() < 3 {
            return casteljau(still, u);
        }
        let (f, d) = (self.quadratic(u), self.slopes(u));
        let step = |three: [(Point, Vec2); 3]| {
            let (mut at, mut by) = (Vec2::ZERO, Vec2::ZERO);
            for (i, (p, v)) in three.into_iter().enumerate() {
                at += p.to_vec2() * f[i];
                by += p.to_vec2() * d[i] + v * f[i];
            }
            (at.to_point(), by)
        };
        // s of eq. 7 for this round and the next: points of the polygon, then every second round's own.
        let edges: Vec<_> = still
            .windows(2)
            .skip(1)
            .map(|e| lerp(e[0], e[1], u))
            .collect();
        let mut middles = [edges, still.iter().skip(2).copied().collect()];
        let mut round: Vec<_> = still.windows(3).map(|t| step([t[0], t[1], t[2]])).collect();
        while round.len() > 1 {
            let [now, next] = middles;
            round = round
                .windows(2)
                .zip(&now)
                .map(|(pair, &s)| step([pair[0], s, pair[1]]))
                .collect();
            let later = now.into_iter().skip(1).collect();
            middles = [next, later];
        }
        round.first().copied().unwrap_or_default()
    }

    /// Cubics within `tolerance` of the curve, ends and end tangents exact.
    #[must_use]
    pub fn cubics(self, points: &[Point], tolerance: f64) -> Vec<CubicBez> {
        /// Parts that each range of u is cut into at most: 2^10.
        const DEPTH: u32 = 10;
        let mut out = Vec::new();
        let mut pieces = vec![(0.0, 1.0, DEPTH)];
        while let Some((a, b, depth)) = pieces.pop() {
            let ((p, dp), (q, dq)) = (self.eval(points, a), self.eval(points, b));
            let third = (b - a) / 3.0;
            let cubic = CubicBez::new(p, p + dp * third, q - dq * third, q);
            let off = |t: f64| self.eval(points, a + (b - a) * t).0.distance(cubic.eval(t));
            let worst = (1..8).map(|i| off(f64::from(i) / 8.0)).fold(0.0, f64::max);
            if worst <= tolerance || depth == 0 {
                out.push(cubic);
            } else {
                let m = 0.5 * (a + b);
                pieces.extend([(m, b, depth - 1), (a, m, depth - 1)]);
            }
        }
        out
    }
}

fn lerp(a: (Point, Vec2), b: (Point, Vec2), u: f64) -> (Point, Vec2) {
    (a.0.lerp(b.0, u), (b.0 - a.0) + a.1 * (1.0 - u) + b.1 * u)
}

fn casteljau(mut points: Vec<(Point, Vec2)>, u: f64) -> (Point, Vec2) {
    while points.len() > 1 {
        points = points.windows(2).map(|e| lerp(e[0], e[1], u)).collect();
    }
    points.first().copied().unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::angles;
    use kurbo::Affine;
    use proptest::prelude::*;

    const ALL: [Pull; 3] = [Pull::Bezier, Pull::Qbc, Pull::QbcN];

    fn points() -> impl Strategy<Value = Vec<Point>> {
        prop::collection::vec(
            (-100.0..100.0f64, -100.0..100.0f64).prop_map(Point::from),
            2..8,
        )
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        // Lemmas 1 to 3 [sohel sec. III.B].
        #[test]
        fn ends_hull_and_affine_maps(p in points(), u in 0.0..1.0f64, turn in 0.0..6.0f64, shear in -2.0..2.0f64) {
            for pull in ALL {
                prop_assert!(pull.eval(&p, 0.0).0.distance(p[0]) < 1e-9);
                prop_assert!(pull.eval(&p, 1.0).0.distance(p[p.len() - 1]) < 1e-9);
                let at = pull.eval(&p, u).0;
                // Inside the hull: no direction in which the point lies beyond all control points.
                for i in 0..32 {
                    let d = angles::direction(f64::from(i) * 0.2);
                    let most = p.iter().map(|q| q.to_vec2().dot(d)).fold(f64::NEG_INFINITY, f64::max);
                    prop_assert!(at.to_vec2().dot(d) <= most + 1e-9);
                }
                let map = angles::rotation(turn) * Affine::skew(shear, 0.0) * Affine::translate((3.0, 5.0));
                let moved: Vec<Point> = p.iter().map(|&q| map * q).collect();
                prop_assert!(pull.eval(&moved, u).0.distance(map * at) < 1e-7);
            }
        }

        #[test]
        fn derivatives_and_approximations(p in points(), u in 0.01..0.99f64) {
            for pull in ALL {
                let h = 1e-6;
                let slope = (pull.eval(&p, u + h).0 - pull.eval(&p, u - h).0) / (2.0 * h);
                prop_assert!((slope - pull.eval(&p, u).1).hypot() < 1e-3 * (1.0 + slope.hypot()));
                let cubics = pull.cubics(&p, 0.05);
                prop_assert!(cubics.windows(2).all(|c| c[0].p3 == c[1].p0));
            }
        }

        // Lemma 4: conjoint curves of eq. 11 and 12 meet in position and direction.
        #[test]
        fn series_are_smooth(p in prop::collection::vec((-100.0..100.0f64, -100.0..100.0f64).prop_map(Point::from), 4)) {
            let piece = |a: Point, b: Point, c: Point| [a.midpoint(b), b, b.midpoint(c)];
            for pull in ALL {
                let (q, r) = (pull.eval(&piece(p[0], p[1], p[2]), 1.0), pull.eval(&piece(p[1], p[2], p[3]), 0.0));
                prop_assert!(q.0.distance(r.0) < 1e-9);
                prop_assert!(q.1.cross(r.1).abs() <= 1e-7 * (1.0 + q.1.hypot() * r.1.hypot()));
                prop_assert!(q.1.dot(r.1) >= 0.0);
            }
        }
    }

    #[test]
    fn the_printed_formulas() {
        // eq. 5 and 9 at u = 0.3, and the distances of lemma 5 when the ends coincide.
        let u = 0.3_f64;
        let v = 1.0 - u;
        let five = [
            v * v * (3.0 * u * u - 2.0 * u + 3.0) / 3.0,
            2.0 / 3.0 * u * v * (3.0 * u * u - 3.0 * u + 4.0),
            u * u * (3.0 * u * u - 4.0 * u + 4.0) / 3.0,
        ];
        let nine = [
            v * v * (3.0 * u * u - 2.0 * u + 0.75) / 0.75,
            2.0 / 0.75 * u * v * (3.0 * u * u - 3.0 * u + 1.75),
            u * u * (3.0 * u * u - 4.0 * u + 1.75) / 0.75,
        ];
        for (pull, want) in [(Pull::Qbc, five), (Pull::QbcN, nine)] {
            let got = pull.quadratic(u);
            assert!(
                got.iter().zip(want).all(|(a, b)| (a - b).abs() < 1e-12),
                "{got:?} {want:?}"
            );
        }
        let hair = [Point::ORIGIN, Point::new(0.0, 1.0), Point::ORIGIN];
        for (pull, gap) in [
            (Pull::Bezier, 1.0 / 2.0),
            (Pull::Qbc, 11.0 / 24.0),
            (Pull::QbcN, 1.0 / 3.0),
        ] {
            assert!(
                (1.0 - pull.eval(&hair, 0.5).0.y - gap).abs() < 1e-12,
                "{pull:?}"
            );
        }
    }
}
