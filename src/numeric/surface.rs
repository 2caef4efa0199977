//! Where every millimetre of a page lies in its picture.

use crate::numeric::cast::index;
use crate::numeric::view::{self, View};
use kurbo::{Affine, Point, Rect, Size, Vec2};
use nalgebra::{DMatrix, DVector};
use std::iter;
use std::ops::Mul;
use std::sync::Arc;

/// A page as its picture shows it, or a picture as it shows its page ([`Surface::inverse`]): in perspective, and bent
/// by paper that does not lie flat and by the lens.
#[derive(Debug, Clone, PartialEq)]
pub struct Surface {
    /// To the plane in which it is bent; the identity where nothing is.
    before: View,
    bend: Option<(Arc<Bend>, Way)>,
    after: View,
}

/// Which way a bend goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    /// From where places of a page would be if it were flat.
    There,
    Back,
}

impl Surface {
    /// Where a point goes: of the page, mm or px, to the picture, px.
    #[must_use]
    pub fn at(&self, p: Point) -> Point {
        let Some((bend, way)) = &self.bend else {
            return self.after.at(p);
        };
        let p = self.before.at(p);
        self.after.at(match way {
            Way::There => p + bend.at(p),
            Way::Back => bend.before(p),
        })
    }

    /// The affine map that it is near one point.
    #[must_use]
    pub fn near(&self, p: Point) -> Affine {
        let Some((bend, way)) = &self.bend else {
            return self.after.near(p);
        };
        let plane = self.before.at(p);
        let bent = match way {
            Way::There => bend.near(plane),
            Way::Back => bend.near(bend.before(plane)).inverse(),
        };
        self.after.near(bent * plane) * bent * self.before.near(p)
    }

    /// The map back.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let Some((bend, way)) = &self.bend else {
            return self.after.inverse().into();
        };
        let way = match way {
            Way::There => Way::Back,
            Way::Back => Way::There,
        };
        Self {
            before: self.after.inverse(),
            bend: Some((Arc::clone(bend), way)),
            after: self.before.inverse(),
        }
    }

    /// The map itself, where it is affine.
    #[must_use]
    pub fn affine(&self) -> Option<Affine> {
        let is_flat = self.bend.is_none();
        is_flat.then(|| self.after.affine())?
    }

    /// How many px a millimetre has near one point.
    #[must_use]
    pub fn scale(&self, p: Point) -> f64 {
        self.near(p).determinant().abs().sqrt()
    }

    /// The rectangle around a rectangle's image.
    #[must_use]
    pub fn bounds(&self, r: Rect) -> Rect {
        view::bounds(r, |p| self.at(p))
    }

    /// The same, bent; `self` lies flat, or bends in the same plane.
    #[must_use]
    pub fn with_bend(self, bend: Bend) -> Self {
        Self {
            bend: Some((Arc::new(bend), Way::There)),
            ..self
        }
    }

    /// How far a point of the page lies from where it would be if the page were flat, in the units of its bend.
    #[must_use]
    pub fn moved(&self, p: Point) -> Vec2 {
        let bend = self.bend.as_ref();
        bend.map_or(Vec2::ZERO, |(bend, _)| bend.at(self.before.at(p)))
    }
}

impl From<View> for Surface {
    /// A page that lies flat.
    fn from(view: View) -> Self {
        Self {
            before: Affine::IDENTITY.into(),
            bend: None,
            after: view,
        }
    }
}

impl From<Affine> for Surface {
    fn from(map: Affine) -> Self {
        View::from(map).into()
    }
}

impl Mul<Affine> for &Surface {
    type Output = Surface;

    /// First `then`, then `self`, as with [`Affine`].
    fn mul(self, then: Affine) -> Surface {
        let new = self.clone();
        if self.bend.is_none() {
            (self.after * View::from(then)).into()
        } else {
            Surface {
                before: self.before * View::from(then),
                ..new
            }
        }
    }
}

impl Mul<&Surface> for Affine {
    type Output = Surface;

    fn mul(self, then: &Surface) -> Surface {
        Surface {
            after: View::from(self) * then.after,
            ..then.clone()
        }
    }
}

/// A coordinate of a place that was seen elsewhere than where it would be on a flat page.
#[derive(Debug, Clone, Copy)]
pub struct Seen {
    /// The place on the page, mm.
    pub at: Point,
    /// Which coordinate: 0 for x, 1 for y.
    pub axis: usize,
    /// How far it has moved, mm.
    pub by: f64,
    /// What it counts.
    pub weight: f64,
}

/// Distance of the knots, mm; a sixteenth of the page's longer side where that is more.
const KNOTS_MM: f64 = 25.0;
/// What squared derivatives cost beside squared distances, for each mm²: of second rank, mm², and of third, mm⁴.
#[derive(Debug, Clone, Copy)]
pub struct Stiffness([f64; 2]);

impl Stiffness {
    /// What was not seen goes on straight.
    pub const STRAIGHT: Self = Self([6.0, 0.0]);
    /// What was not seen goes on as bent as it was, and straight from some 100 mm on. Where guides lie all over a page,
    /// waves of 60 mm keep 0.99 of their height.
    pub const CURVED: Self = Self([0.01, 100.0]);
    /// The same of what is seen along lines alone, some 25 mm apart: what one of them does by itself is no bend.
    pub const SHARED: Self = Self([0.01, 1e4]);
}

/// Rounds in which what was seen amiss loses its weight, and the distance at which half of it is lost, mm.
const ROUNDS: usize = 4;
const AMISS_MM: f64 = 0.1;
/// Most steps to where a place was, and how near they come.
const BACK: usize = 30;
const EXACT: f64 = 1e-7;
/// Places in each field of knots at which its stiffness is taken, and Gauss' weights and places for them.
const GAUSS: [(f64, f64); 3] = [
    (0.112_701_665_379_258_3, 5.0 / 18.0),
    (0.5, 8.0 / 18.0),
    (0.887_298_334_620_741_7, 5.0 / 18.0),
];

/// How a page is bent within the plane of its marks: cubic B-splines of both coordinates over a lattice of knots.
#[derive(Debug, Clone, PartialEq)]
pub struct Bend {
    /// Fields of knots from side to side and from top to foot.
    fields: [usize; 2],
    /// Their sizes, mm.
    step: Vec2,
    /// Vertices, row by row.
    vertices: Vec<Vec2>,
}

impl Bend {
    /// The smooth bend of a page that was seen so; `None` where too little was seen to say one.
    pub fn fitted(size: Size, seen: &[Seen], stiffness: Stiffness) -> Option<Self> {
        let knots = KNOTS_MM.max(size.max_side() / 16.0);
        let fields = [size.width, size.height].map(|side| index((side / knots).ceil()).max(1));
        let step = Vec2::new(
            size.width / fields[0] as f64,
            size.height / fields[1] as f64,
        );
        let count = (fields[0] + 3) * (fields[1] + 3);
        let mut bend = Self {
            fields,
            step,
            vertices: vec![Vec2::ZERO; count],
        };
        let stiff = bend.stiffness(stiffness);
        let solved = |axis: usize| {
            let own: Vec<(Vec<(usize, f64)>, Seen)> = seen
                .iter()
                .filter(|s| s.axis == axis)
                .map(|s| (bend.row(s.at, [0, 0]), *s))
                .collect();
            let mut trust = vec![1.0; own.len()];
            let mut found = DVector::zeros(count);
            for _ in 0..ROUNDS {
                let (mut a, mut b) = (stiff.clone(), DVector::zeros(count));
                for ((row, seen), trust) in own.iter().zip(&trust) {
                    add(&mut a, row, seen.weight * trust);
                    row.iter()
                        .for_each(|(i, v)| b[*i] += seen.weight * trust * v * seen.by);
                }
                found = a.cholesky()?.solve(&b);
                for ((row, seen), trust) in own.iter().zip(&mut trust) {
                    let here: f64 = row.iter().map(|(i, v)| v * found[*i]).sum();
                    *trust = 1.0 / (1.0 + ((here - seen.by) / AMISS_MM).powi(2));
                }
            }
            Some(found)
        };
        let (x, y) = rayon::join(|| solved(0), || solved(1));
        let both = x?
            .iter()
            .zip(y?.iter())
            .map(|(x, y)| Vec2::new(*x, *y))
            .collect();
        bend.vertices = both;
        let is_told = bend.vertices.iter().all(|v| v.is_finite());
        is_told.then_some(bend)
    }

    /// Normal equations of squared derivatives, and a trace of squares for what these leave open.
    fn stiffness(&self, Stiffness([second, third]): Stiffness) -> DMatrix<f64> {
        /// What squared distances that nobody has seen cost.
        const HOLD: f64 = 1e-9;
        let count = self.vertices.len();
        let mut a = DMatrix::identity(count, count) * HOLD;
        let area = self.step.x * self.step.y;
        for (i, j) in (0..self.fields[0]).flat_map(|i| (0..self.fields[1]).map(move |j| (i, j))) {
            for ((x, wx), (y, wy)) in GAUSS.iter().flat_map(|x| GAUSS.iter().map(move |y| (x, y))) {
                let p = Point::new((i as f64 + x) * self.step.x, (j as f64 + y) * self.step.y);
                for (ranks, cost) in [
                    ([2, 0], second),
                    ([1, 1], 2.0 * second),
                    ([0, 2], second),
                    ([3, 0], third),
                    ([2, 1], 3.0 * third),
                    ([1, 2], 3.0 * third),
                    ([0, 3], third),
                ] {
                    add(&mut a, &self.row(p, ranks), cost * wx * wy * area);
                }
            }
        }
        a
    }

    /// The vertices that a point's coordinates, or their derivatives of these ranks, come from, and their weights.
    fn row(&self, p: Point, ranks: [usize; 2]) -> Vec<(usize, f64)> {
        let [(i, x), (j, y)] = self.weights(p, ranks);
        let width = self.fields[0] + 3;
        let all = (0..4).flat_map(|k| (0..4).map(move |l| (k, l)));
        all.map(|(k, l)| ((j + k) * width + i + l, y[k] * x[l]))
            .collect()
    }

    /// First of the four columns and rows of vertices about a point, and the weights of each.
    fn weights(&self, p: Point, ranks: [usize; 2]) -> [(usize, [f64; 4]); 2] {
        let one = |at: f64, step: f64, fields: usize, rank: usize| {
            let u = (at / step).clamp(0.0, fields as f64);
            let first = index(u).min(fields - 1);
            (first, basis(u - first as f64, step, rank))
        };
        [
            one(p.x, self.step.x, self.fields[0], ranks[0]),
            one(p.y, self.step.y, self.fields[1], ranks[1]),
        ]
    }

    fn sum(&self, p: Point, ranks: [usize; 2]) -> Vec2 {
        let [(i, x), (j, y)] = self.weights(p, ranks);
        let width = self.fields[0] + 3;
        let mut sum = Vec2::ZERO;
        for (k, wy) in y.iter().enumerate() {
            let row = &self.vertices[(j + k) * width + i..][..4];
            let along = row.iter().zip(x);
            sum += *wy * along.fold(Vec2::ZERO, |sum, (v, wx)| sum + wx * *v);
        }
        sum
    }

    /// How far a place lies from where it would be flat.
    #[must_use]
    pub fn at(&self, p: Point) -> Vec2 {
        self.sum(p, [0, 0])
    }

    /// How fast it changes near a place at most, as a share of the way.
    #[must_use]
    pub fn slope(&self, p: Point) -> f64 {
        let [x, y] = self.slopes(p);
        x.hypot().max(y.hypot())
    }

    /// The affine map that it is near one place: from there to where that lies.
    fn near(&self, p: Point) -> Affine {
        let [x, y] = self.slopes(p);
        let turn = Affine::new([1.0 + x.x, x.y, y.x, 1.0 + y.y, 0.0, 0.0]);
        Affine::translate((p + self.at(p)).to_vec2()) * turn * Affine::translate(-p.to_vec2())
    }

    /// The place that lies at `p`.
    #[must_use]
    pub fn before(&self, p: Point) -> Point {
        // bends are slight: each step leaves a twentieth or so
        let steps = iter::successors(Some(p - self.at(p)), |q| Some(p - self.at(*q)));
        let mut steps = steps.take(BACK);
        let mut last = p;
        let near = steps.find(|q| {
            let off = q.distance(last);
            last = *q;
            off < EXACT
        });
        near.unwrap_or(last)
    }

    /// How it changes along x and along y.
    fn slopes(&self, p: Point) -> [Vec2; 2] {
        [self.sum(p, [1, 0]), self.sum(p, [0, 1])]
    }
}

/// The four cubic B-splines over knots `step` apart at a share `t` of a field, or their derivatives of that rank.
fn basis(t: f64, step: f64, rank: usize) -> [f64; 4] {
    let (s, t2) = (1.0 - t, t * t);
    match rank {
        0 => [
            s * s * s / 6.0,
            (3.0 * t2 * t - 6.0 * t2 + 4.0) / 6.0,
            (3.0 * s * s * s - 6.0 * s * s + 4.0) / 6.0,
            t2 * t / 6.0,
        ],
        1 => [-s * s, 3.0 * t2 - 4.0 * t, 4.0 * s - 3.0 * s * s, t2].map(|v| v / (2.0 * step)),
        2 => [s, 3.0 * t - 2.0, 3.0 * s - 2.0, t].map(|v| v / (step * step)),
        _ => [-1.0, 3.0, -3.0, 1.0].map(|v| v / (step * step * step)),
    }
}

/// Adds the square of a row to normal equations.
fn add(a: &mut DMatrix<f64>, row: &[(usize, f64)], weight: f64) {
    for (i, v) in row {
        for (j, w) in row {
            a[(*i, *j)] += weight * v * w;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size::new(210.0, 297.0);

    fn bent(p: Point) -> Vec2 {
        let d = p - Point::new(105.0, 148.0);
        let wave = libm::sin(d.x / 16.0);
        d * (0.01 * d.hypot2() / 33_000.0) + Vec2::new(0.1 * wave, 0.05 * wave)
    }

    fn places() -> impl Iterator<Item = Point> {
        (0..=14).flat_map(|i| {
            (0..=20).map(move |j| Point::new(15.0 * f64::from(i), 14.85 * f64::from(j)))
        })
    }

    /// Not beside an edge.
    fn inner() -> impl Iterator<Item = Point> {
        places().map(|p| p.lerp(Point::new(105.0, 148.0), 0.2))
    }

    fn seen(by: impl Fn(Point) -> Vec2) -> Vec<Seen> {
        let both = |at: Point| {
            let by = by(at);
            [(0, by.x), (1, by.y)].map(|(axis, by)| Seen {
                at,
                axis,
                by,
                weight: 1.0,
            })
        };
        places().flat_map(both).collect()
    }

    #[test]
    fn a_smooth_bend_comes_back_with_its_slopes() {
        let bend = Bend::fitted(SIZE, &seen(bent), Stiffness::CURVED).expect("a bend");
        for p in inner() {
            let off = bend.at(p) - bent(p);
            assert!(off.hypot() < 0.01, "{p:?}: {off:?}");
            let [x, _] = bend.slopes(p);
            let near = (bent(p + (0.01, 0.0)) - bent(p - (0.01, 0.0))) / 0.02;
            assert!((x - near).hypot() < 0.002, "{p:?}: {x:?} {near:?}");
        }
    }

    #[test]
    fn what_was_seen_amiss_does_not_bend_it() {
        let mut all = seen(bent);
        all.iter_mut().step_by(9).for_each(|s| s.by += 0.8);
        let bend = Bend::fitted(SIZE, &all, Stiffness::CURVED).expect("a bend");
        for p in inner() {
            let off = bend.at(p) - bent(p);
            assert!(off.hypot() < 0.04, "{p:?}: {off:?}");
        }
    }

    #[test]
    fn nothing_seen_is_flat() {
        let bend = Bend::fitted(SIZE, &[], Stiffness::STRAIGHT).expect("a bend");
        assert!(places().all(|p| bend.at(p).hypot() < 1e-12));
    }

    #[test]
    fn there_and_back_is_where_one_was() {
        let view = View::of_pencils([1.1, 0.05, -0.03, 0.97, 2e-4, -1e-4]);
        let bend = Bend::fitted(SIZE, &seen(bent), Stiffness::CURVED).expect("a bend");
        let steepest = inner().map(|p| bend.slope(p)).fold(0.0, f64::max);
        assert!((0.01..0.03).contains(&steepest), "{steepest}");
        let scaled = Affine::translate((7.0, -3.0)) * Affine::scale(0.2);
        let page = &Surface::from(view).with_bend(bend) * scaled;
        let back = page.inverse();
        let turned = Affine::scale(3.0) * &back;
        for p in places().map(|p| scaled.inverse() * p) {
            let there = page.at(p);
            assert!(back.at(there).distance(p) < 1e-5);
            assert!(back.inverse().at(p).distance(there) < 1e-9);
            assert!((back.near(there) * there).distance(p) < 1e-5);
            let both = back.near(there) * page.near(p);
            let off = both
                .as_coeffs()
                .into_iter()
                .zip(Affine::IDENTITY.as_coeffs());
            assert!(off.take(4).all(|(a, b)| (a - b).abs() < 1e-5), "{both:?}");
            assert!(turned.at(there).distance(Affine::scale(3.0) * p) < 1e-4);
        }
    }

    #[test]
    fn its_tangent_touches() {
        let view = View::of_pencils([1.1, 0.05, -0.03, 0.97, 2e-4, -1e-4]);
        let bend = Bend::fitted(SIZE, &seen(bent), Stiffness::CURVED).expect("a bend");
        let page = Surface::from(view).with_bend(bend);
        for p in places() {
            let (near, d) = (page.near(p), Vec2::new(1e-4, -2e-4));
            assert!((near * p).distance(page.at(p)) < 1e-9);
            let off = (near * (p + d)).distance(page.at(p + d));
            let is_inside = SIZE.to_rect().inset(-1.0).contains(p);
            assert!(!is_inside || off < 1e-7, "{p:?}: {off}");
        }
    }
}
