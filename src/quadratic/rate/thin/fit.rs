//! A chain moved until its largest distance from the curve is least.

use super::super::curve::Curve;
use super::chain::Chain;
use super::{Point, Vec2};
use crate::numeric::cast::index;
use nalgebra::{DMatrix, DVector};

/// Places of a quadratic that are looked at, its start among them.
const LOOK: usize = 8;

/// A place of the chain: how far from the curve, left positive, and the direction to the left there.
#[derive(Debug, Clone, Copy)]
struct Off {
    far: f64,
    left: Vec2,
}

/// A chain beside its curve.
#[derive(Debug, Clone)]
pub(super) struct Fit<'a> {
    curve: &'a Curve,
    pub(super) chain: Chain,
    /// Feet of the places looked at, samples; none before the first look.
    feet: Vec<f64>,
}

impl<'a> Fit<'a> {
    pub(super) const fn new(curve: &'a Curve, chain: Chain) -> Self {
        Self {
            curve,
            chain,
            feet: Vec::new(),
        }
    }

    /// Moves the chain towards the least largest distance; none where that is beyond the limit, units.
    pub(super) fn freely(&mut self, limit: f64) -> Option<()> {
        /// Powers of the distance whose mean is made least, and the steps towards each.
        const POWERS: [(i32, usize); 3] = [(2, 4), (4, 4), (8, 8)];
        /// A step's mean may lie so many limits above the least one.
        const NEAR: f64 = 1.1;
        for (power, times) in POWERS {
            for k in 0..times {
                let mean = self.step(power)?;
                // No largest distance is less than the least mean of a power.
                if k + 1 == times && mean > NEAR * limit {
                    return None;
                }
            }
        }
        (self.worst() <= limit).then_some(())
    }

    /// After one of its points was rounded; none where the others no longer come near.
    pub(super) fn again(&mut self, limit: f64) -> Option<()> {
        /// What the points that are left may still make good, limits.
        const OVER: f64 = 1.2;
        (0..3).try_for_each(|_| self.step(8).map(|_| ()))?;
        (self.worst() <= OVER * limit).then_some(())
    }

    /// The largest distance at the places looked at, and of corners from where they were drawn, units.
    pub(super) fn worst(&mut self) -> f64 {
        let offs = self.look();
        self.largest(&offs)
    }

    /// Samples beside the start of a quadratic and its end.
    pub(super) fn stretch(&self, quad: usize) -> (f64, f64) {
        let around = self.feet[0] + (self.curve.last - self.curve.first) as f64;
        let to = self.feet.get((quad + 1) * LOOK).copied();
        (self.feet[quad * LOOK], to.unwrap_or(around))
    }

    /// Whether the curve lies within the limit of the lines that reach from its ends to the chain's.
    pub(super) fn keeps_lines(&self, limit: f64) -> bool {
        let (first, last) = (self.curve.first, self.curve.last);
        let end = self.feet.last().map_or(last, |&at| index(at.max(0.0)));
        let [start, stop] = self.chain.along;
        let beside = |from: usize, to: usize, u: Vec2, end: usize| {
            let away = |p: Point| u.cross(p - self.curve.dots[end].p).abs();
            let dots = self.curve.dots.iter().take(to + 1).skip(from);
            dots.map(|o| away(o.p)).fold(0.0, f64::max) <= limit
        };
        start.is_none_or(|u| beside(first, index(self.feet[0].max(0.0)), u, first))
            && stop.is_none_or(|u| beside(end, last, u, last))
    }

    /// Of each quadratic its start and seven places more; of an open chain its end.
    fn places(&self) -> Vec<(usize, f64)> {
        let many = self.chain.many();
        let all = (0..many * LOOK).map(|k| (k / LOOK, (k % LOOK) as f64 / LOOK as f64));
        let is_open = self.chain.spots.len() > many;
        all.chain(is_open.then_some((many - 1, 1.0))).collect()
    }

    fn look(&mut self) -> Vec<Off> {
        let last = self.curve.dots.len() - 1;
        let mut before: Option<(Point, f64)> = None;
        let (mut offs, mut feet) = (Vec::new(), Vec::new());
        for (k, (quad, u)) in self.places().into_iter().enumerate() {
            let q = self.chain.eval(quad, u);
            let next = |(p, at): (Point, f64)| at + p.distance(q) / self.curve.step;
            let first = || before.map_or(self.curve.first as f64, next);
            let guess = self.feet.get(k).copied().unwrap_or_else(first);
            let (at, far) = self.curve.foot(q, guess.max(0.0));
            before = Some((q, at));
            feet.push(at);
            let left = self.curve.dots[index(at + 0.5).min(last)].t.turn_90();
            offs.push(Off { far, left });
        }
        self.feet = feet;
        offs
    }

    fn largest(&self, offs: &[Off]) -> f64 {
        let spots = self.chain.spots.iter();
        let moved = spots.filter_map(|s| Some(s.at.distance(s.home?)));
        offs.iter()
            .map(|o| o.far.abs())
            .chain(moved)
            .fold(0.0, f64::max)
    }

    /// A Newton step towards the least mean of this power of the distances; answers the mean it came from, units.
    fn step(&mut self, power: i32) -> Option<f64> {
        /// Added to the diagonal, parts of its largest entry: along the curve hardly anything holds a point.
        const DAMPING: f64 = 1e-3;
        /// Weight of what lies on the curve.
        const LEAST: f64 = 1e-4;
        let offs = self.look();
        let worst = self.largest(&offs).max(1e-9);
        let n = self.chain.unknowns;
        let (mut a, mut b) = (DMatrix::<f64>::zeros(n, n), DVector::<f64>::zeros(n));
        let mut add = |row: &[(usize, f64)], far: f64, size: f64| {
            let weight = (size / worst).powi(power - 2) + LEAST;
            for &(i, g) in row {
                b[i] -= weight * g * far;
                // The factorization reads what lies below the diagonal.
                for &(j, h) in row.iter().filter(|r| r.0 <= i) {
                    a[(i, j)] += weight * g * h;
                }
            }
        };
        let spots = &self.chain.spots;
        let mut row = Vec::new();
        for ((quad, u), o) in self.places().into_iter().zip(&offs) {
            row.clear();
            for (k, w) in self.chain.weights(quad, u) {
                let ways = spots[k].ways.iter();
                row.extend(ways.map(|&(i, v)| (i, w * o.left.dot(v))));
            }
            add(&row, o.far, o.far.abs());
        }
        for (s, home) in spots.iter().filter_map(|s| Some((s, s.home?))) {
            let e = s.at - home;
            let ways = s.ways.iter();
            ways.for_each(|&(i, v)| add(&[(i, 1.0)], e.dot(v), e.hypot()));
        }
        let damping = DAMPING * a.diagonal().max().max(1e-9);
        for i in 0..n {
            a[(i, i)] += damping;
        }
        let step = a.cholesky()?.solve(&b) / f64::from(power - 1);
        for s in &mut self.chain.spots {
            s.ways.iter().for_each(|&(i, v)| s.at += v * step[i]);
        }
        let parts = offs.iter().map(|o| (o.far.abs() / worst).powi(power));
        Some(
            worst
                * libm::pow(
                    parts.sum::<f64>() / offs.len() as f64,
                    f64::from(power).recip(),
                ),
        )
    }
}
