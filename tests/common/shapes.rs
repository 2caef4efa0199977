//! Shapes that the batteries draw for themselves: points in px, y up, about 1 px apart.

use khatt::types::Span;
use kurbo::{Point, Vec2};
use std::f64::consts::{PI, TAU};

/// A span that owns its points.
#[derive(Debug, Clone)]
pub(crate) struct Shape {
    pub name: &'static str,
    pub points: Vec<Point>,
    pub ring: bool,
}

impl Shape {
    pub(crate) fn span(&self) -> Span<'_> {
        if self.ring {
            Span::Ring(&self.points)
        } else {
            Span::Open(&self.points)
        }
    }

    pub(crate) fn map(&self, f: impl FnMut(Point) -> Point) -> Self {
        Self {
            points: self.points.iter().copied().map(f).collect(),
            ..self.clone()
        }
    }

    /// Run the other way; a ring keeps its first point.
    pub(crate) fn reversed(&self) -> Self {
        let mut points = self.points.clone();
        points.reverse();
        if self.ring {
            points.rotate_right(1);
        }
        Self {
            points,
            ..self.clone()
        }
    }
}

/// `n` points of `f` over 0…1, both ends among them.
pub(crate) fn open(name: &'static str, n: u32, f: impl Fn(f64) -> (f64, f64)) -> Shape {
    let points = (0..n)
        .map(|i| f(f64::from(i) / f64::from(n - 1)).into())
        .collect();
    Shape {
        name,
        points,
        ring: false,
    }
}

/// `n` points of `f` over 0…1, the end left out.
pub(crate) fn ring(name: &'static str, n: u32, f: impl Fn(f64) -> (f64, f64)) -> Shape {
    let points = (0..n)
        .map(|i| f(f64::from(i) / f64::from(n)).into())
        .collect();
    Shape {
        name,
        points,
        ring: true,
    }
}

/// A repeatable draw of uniform numbers in 0…1.
#[derive(Debug)]
pub(crate) struct Dice(pub u64);

impl Dice {
    pub(crate) fn roll(&mut self) -> f64 {
        // Knuth's MMIX generator; its high bits are good enough for noise
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = self.0.wrapping_add(1_442_695_040_888_963_407);
        f64::from((self.0 >> 33) as u32) / f64::from(1_u32 << 31)
    }

    /// Normal with deviation 1 (Box and Muller).
    pub(crate) fn normal(&mut self) -> f64 {
        let r = (-2.0 * libm::log(1.0 - self.roll())).sqrt();
        r * libm::cos(TAU * self.roll())
    }
}

/// Both coordinates of all points moved by noise of `sigma` px; open shapes keep their ends.
pub(crate) fn noisy(shape: &Shape, sigma: f64, seed: u64) -> Shape {
    let mut dice = Dice(seed);
    let last = shape.points.len() - 1;
    let mut i = 0;
    shape.map(|p| {
        let v = Vec2::new(dice.normal(), dice.normal()) * sigma;
        i += 1;
        if shape.ring || (i > 1 && i <= last) {
            p + v
        } else {
            p
        }
    })
}

pub(crate) fn circle() -> Shape {
    ring("circle", 314, |t| {
        (
            50.0 * libm::cos(TAU * t) + 60.0,
            50.0 * libm::sin(TAU * t) + 55.0,
        )
    })
}

/// Smooth shapes that every method must follow.
pub(crate) fn smooth() -> Vec<Shape> {
    vec![
        circle(),
        ring("ellipse", 260, |t| {
            (60.0 * libm::cos(TAU * t), 25.0 * libm::sin(TAU * t))
        }),
        ring("bean", 300, |t| {
            let r = 40.0 + 9.0 * libm::cos(2.0 * TAU * t) + 3.0 * libm::sin(TAU * t);
            (r * libm::cos(TAU * t), r * libm::sin(TAU * t))
        }),
        open("arc", 160, |t| {
            (100.0 * libm::cos(2.0 * t), 100.0 * libm::sin(2.0 * t))
        }),
        open("wave", 140, |t| {
            (120.0 * t, 15.0 * libm::sin(TAU * t) + 10.0 * t)
        }),
        open("spiral", 260, |t| {
            let (r, a) = (20.0 + 40.0 * t, 1.5 * PI * t);
            (r * libm::cos(a), r * libm::sin(a))
        }),
    ]
}

/// A straight stroke's side.
pub(crate) fn line() -> Shape {
    open("line", 80, |t| (3.0 + 70.0 * t, 1.0 + 35.0 * t))
}

/// Shapes that a smooth curve cannot follow everywhere.
pub(crate) fn hard() -> Vec<Shape> {
    let mut out = vec![
        open("corner", 101, |t| {
            if t < 0.5 {
                (100.0 * t, 0.0)
            } else {
                (50.0, 100.0 * t - 50.0)
            }
        }),
        open("near-cusp", 121, |t| {
            let u = 2.0 * t - 1.0;
            (60.0 * u * u, 40.0 * u * u * u + 0.8 * u)
        }),
        polygon(
            "square",
            &[(0.0, 0.0), (60.0, 0.0), (60.0, 60.0), (0.0, 60.0)],
        ),
        polygon(
            "sliver",
            &[(0.0, 0.0), (80.0, 0.0), (80.0, 2.0), (0.0, 2.0)],
        ),
    ];
    out.extend(smooth().iter().step_by(3).map(|s| noisy(s, 0.3, 7)));
    out
}

/// A closed polygon's sides in steps of at most 1 px, its corners among the points.
pub(crate) fn polygon(name: &'static str, corners: &[(f64, f64)]) -> Shape {
    let mut points = Vec::new();
    for (i, &a) in corners.iter().enumerate() {
        let (a, b) = (
            Point::from(a),
            Point::from(corners[(i + 1) % corners.len()]),
        );
        let n = a.distance(b).ceil();
        let steps = std::iter::successors(Some(0.0), |k| Some(k + 1.0)).take_while(|&k| k < n);
        points.extend(steps.map(|k| a.lerp(b, k / n)));
    }
    Shape {
        name,
        points,
        ring: true,
    }
}

/// Spans at the edge of what is legal and beyond: few, collinear or repeated points.
pub(crate) fn degenerate() -> Vec<Shape> {
    let path = |name, points: &[(f64, f64)]| Shape {
        name,
        points: points.iter().map(|&p| p.into()).collect(),
        ring: false,
    };
    let closed = |name, points: &[(f64, f64)]| Shape {
        ring: true,
        ..path(name, points)
    };
    vec![
        path("two points", &[(1.0, 2.0), (4.0, 6.0)]),
        path("three points", &[(0.0, 0.0), (1.0, 0.5), (2.0, 0.0)]),
        path(
            "four points",
            &[(0.0, 0.0), (1.0, 0.5), (2.0, 0.5), (3.0, 0.0)],
        ),
        path(
            "five points",
            &[(0.0, 0.0), (1.0, 0.5), (2.0, 0.7), (3.0, 0.5), (4.0, 0.0)],
        ),
        path("one point twice", &[(1.0, 1.0), (1.0, 1.0)]),
        path("one point ten times", &[(1.0, 1.0); 10]),
        path(
            "there and back",
            &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (1.0, 0.0), (0.0, 0.0)],
        ),
        path(
            "repeated points",
            &[
                (0.0, 0.0),
                (1.0, 0.0),
                (1.0, 0.0),
                (1.0, 0.0),
                (2.0, 1.0),
                (2.0, 1.0),
                (3.0, 3.0),
                (4.0, 5.0),
            ],
        ),
        path(
            "ends meet",
            &[(0.0, 0.0), (3.0, 0.0), (3.0, 3.0), (0.0, 3.0), (0.0, 0.0)],
        ),
        path(
            "leaps",
            &[
                (0.0, 0.0),
                (0.001, 0.0),
                (0.002, 0.0),
                (900.0, 3.0),
                (900.001, 3.0),
                (900.002, 3.5),
            ],
        ),
        closed("ring of three", &[(0.0, 0.0), (2.0, 0.0), (1.0, 2.0)]),
        closed(
            "ring of four",
            &[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0), (0.0, 2.0)],
        ),
        closed(
            "ring of five",
            &[(0.0, 0.0), (2.0, 0.0), (3.0, 1.0), (2.0, 2.0), (0.0, 2.0)],
        ),
        closed(
            "flat ring",
            &[
                (0.0, 0.0),
                (1.0, 0.0),
                (2.0, 0.0),
                (3.0, 0.0),
                (2.0, 0.0),
                (1.0, 0.0),
            ],
        ),
        closed("ring of one point", &[(5.0, 5.0); 6]),
    ]
}
