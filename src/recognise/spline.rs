//! A stroke's B-spline: control points by least squares.
//!
//! Source   [bsplinematch sec. 3, eq. 3-1 to 3-8]; order and number of control points by [schwarz78 eq. 1]
//! Solves   `min Σ |Σ Q_i(t_j) C_i − r_j|²`; among orders and numbers, min N ln(σ² + mean square) + 2 n ln N
//! Takes    N ≥ 2 points of a stroke, px, open or closed
//! Gives    the curve; clamped at both ends when open, periodic when closed
//! Symbols  k -> `order`, n+1 -> `count`, C -> `control`, `t_j` -> `parameters`, Q -> `Basis::row`
//! Departs  the usual recursion for eq. 3-2 and 3-3; the normal equations of eq. 3-6 are solved by Cholesky and
//! not by inversion; the paper fixes k = 4 and leaves n open. Knots that are not uniform halve the sum of
//! arc length and turning evenly, where its conclusion speaks of inverse chord lengths
//! Cost     O(N k² + n k²) a curve      Fails  `None` with fewer points than control points

use crate::numeric::angles::angle;
use crate::numeric::{bspline::Basis, skyline::Skyline};
use kurbo::{CubicBez, Point, Vec2};

/// Where the knots lie.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Knots {
    /// One apart, as in the paper.
    Uniform,
    /// Denser where the stroke bends.
    Bends,
}

/// Errors below this do not call for more control points of a thinned stroke, px²: it has steps of a pixel.
pub(crate) const PIXEL_STEPS: f64 = 0.15;
/// Control points at most when letters are compared; more bends gain nothing.
pub(crate) const FEW: usize = 14;
/// How much length a turn of one radian is worth, of the whole stroke: where knots follow bends.
const TURN_LENGTH: f64 = 0.12;

/// What a curve is fitted to.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Data<'a> {
    /// In order, px; of a closed stroke the first is not repeated.
    pub(crate) points: &'a [Point],
    /// Whether the last is followed by the first.
    pub(crate) closed: bool,
    /// Where the knots shall lie.
    pub(crate) knots: Knots,
    /// Mean square error that is no shape but noise, px².
    pub(crate) noise: f64,
    /// Control points at most.
    pub(crate) most: usize,
}

/// A stroke as a curve.
#[derive(Debug, Clone)]
pub(crate) struct Spline {
    basis: Basis,
    /// Control points; of a closed curve the first `order` − 1 come again at the end.
    control: Vec<Point>,
    closed: bool,
}

impl Spline {
    /// The cubic with the number of control points, or the curve with order and number, that describe the
    /// points in the fewest bits.
    pub(crate) fn choose(data: Data<'_>) -> Option<Self> {
        let orders = match data.knots {
            Knots::Uniform => 4..=4,
            Knots::Bends => 3..=5,
        };
        let n = data.points.len() as f64;
        let tries = orders.flat_map(|order| (order..=data.most).map(move |count| (order, count)));
        let scored = tries.filter_map(|(order, count)| {
            let spline = Self::fit(data, order, count)?;
            let mean = spline.mean_square(data);
            Some((
                n * libm::log(data.noise + mean) + 2.0 * count as f64 * libm::log(n),
                spline,
            ))
        });
        scored.min_by(|a, b| a.0.total_cmp(&b.0)).map(|s| s.1)
    }

    /// The curve of that order and number of free control points nearest to the points.
    pub(crate) fn fit(data: Data<'_>, order: usize, count: usize) -> Option<Self> {
        let Data { points, closed, .. } = data;
        if points.len() < count.max(2) {
            return None;
        }
        let wrap = if closed { order - 1 } else { 0 };
        let basis = if closed {
            Basis::uniform(order, count + wrap)
        } else {
            Basis::clamped(order, count)
        }?;
        let mut matrix = Skyline::default();
        let first: Vec<usize> = (0..count)
            .map(|i| {
                if closed && i + order > count {
                    0
                } else {
                    (i + 1).saturating_sub(order)
                }
            })
            .collect();
        matrix.reset(&first);
        let mut right = [vec![0.0; count], vec![0.0; count]];
        for (p, u) in points.iter().zip(parameters(data, basis.domain())) {
            let row = basis.row(u, 0);
            for (i, a) in row.values.iter().enumerate() {
                let ci = (row.first + i) % count;
                right[0][ci] += a * p.x;
                right[1][ci] += a * p.y;
                for (j, b) in row.values.iter().enumerate().take(i + 1) {
                    let cj = (row.first + j) % count;
                    matrix.add(ci, cj, a * b);
                }
            }
        }
        // So little that it matters only where no point speaks for a control point.
        let solved = right.iter_mut().all(|r| matrix.solve_damped(1e-9, r));
        let vertex = |i: usize| Point::new(right[0][i % count], right[1][i % count]);
        let control: Vec<Point> = (0..count + wrap).map(vertex).collect();
        let sound = solved && control.iter().all(|p| p.is_finite());
        sound.then_some(Self {
            basis,
            control,
            closed,
        })
    }

    fn mean_square(&self, data: Data<'_>) -> f64 {
        let at = parameters(data, self.basis.domain());
        let off = |(p, u): (&Point, f64)| self.basis.eval(&self.control, u).distance_squared(*p);
        data.points.iter().zip(at).map(off).sum::<f64>() / data.points.len() as f64
    }

    /// The curve as cubics, an open one from `ends.0` to `ends.1` exactly; empty when its order is above 4.
    pub(crate) fn cubics(&self, ends: Option<(Point, Point)>) -> Vec<CubicBez> {
        let mut control = self.control.clone();
        if let (Some((from, to)), [first, .., last]) = (ends, control.as_mut_slice()) {
            (*first, *last) = (from, to);
        }
        self.basis.cubics(&control, 0.0)
    }

    /// `n` ≥ 2 points evenly spaced in the parameter; of a closed curve the first comes again at the end.
    pub(crate) fn points(&self, n: usize) -> Vec<Point> {
        let (from, to) = self.basis.domain();
        let at = |i: usize| from + (to - from) * i as f64 / (n - 1) as f64;
        (0..n)
            .map(|i| self.basis.eval(&self.control, at(i)))
            .collect()
    }

    /// Where each control point pulls most, as a share 0…1 of the parameter's way (Greville's abscissae).
    pub(crate) fn pulls(&self) -> Vec<f64> {
        let free = self.control.len()
            - if self.closed {
                self.basis.order() - 1
            } else {
                0
            };
        let (from, to) = self.basis.domain();
        let degree = self.basis.order() - 1;
        let share = |i: usize| {
            let knot = |j: usize| (j as f64).clamp(from, to);
            let mean = if self.closed {
                // The middle of its support, moved into the domain.
                let middle = i as f64 + self.basis.order() as f64 / 2.0;
                from + (middle - from).rem_euclid(to - from)
            } else {
                (1..=degree).map(|j| knot(i + j)).sum::<f64>() / degree.max(1) as f64
            };
            (mean - from) / (to - from)
        };
        (0..free).map(share).collect()
    }
}

/// The points' parameters over the basis' domain: by chord length [bsplinematch eq. 3-7, 3-8], or by length and
/// turning. Uniform knots over the latter are knots that follow the bends.
fn parameters(data: Data<'_>, (from, to): (f64, f64)) -> Vec<f64> {
    let Data {
        points,
        closed,
        knots,
        ..
    } = data;
    let n = points.len();
    let chord = |i: usize| points[(i + 1) % n] - points[i];
    let steps = if closed { n } else { n - 1 };
    let length: f64 = (0..steps).map(|i| chord(i).hypot()).sum();
    let mut way = vec![0.0];
    for i in 0..steps {
        let bend = match knots {
            Knots::Uniform => 0.0,
            Knots::Bends => TURN_LENGTH * length * turn(data, i),
        };
        way.push(way[i] + chord(i).hypot() + bend);
    }
    let total = way[steps].max(f64::MIN_POSITIVE);
    way.iter()
        .take(n)
        .map(|w| from + (to - from) * w / total)
        .collect()
}

/// The stroke's turn a step around step `i`, radians, over a window that the pixels' steps do not fill.
fn turn(Data { points, closed, .. }: Data<'_>, i: usize) -> f64 {
    const WINDOW: usize = 5;
    let n = points.len();
    let at = |k: isize| -> Option<Point> {
        let i = i
            .checked_add_signed(k)
            .or_else(|| closed.then(|| (i + n).saturating_add_signed(k)))?;
        if closed {
            points.get(i % n).copied()
        } else {
            points.get(i).copied()
        }
    };
    let w = WINDOW.cast_signed();
    let (Some(a), Some(b), Some(c)) = (at(-w), at(0), at(w)) else {
        return 0.0;
    };
    let (v, w): (Vec2, Vec2) = (b - a, c - b);
    angle(v, w).abs() / WINDOW as f64
}
