//! A chain moved until its largest distance from the curve is least.

use super::super::curve::{Curve, count, whole};
use super::chain::Chain;
use super::{Point, Vec2};
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

    /// From where the chain lies; answers the largest distance, units.
    pub(super) fn freely(&mut self) -> Option<f64> {
        /// Powers of the distance whose sum is made least, and the steps towards each.
        const POWERS: [(f64, usize); 3] = [(2.0, 4), (4.0, 4), (8.0, 8)];
        for (power, times) in POWERS {
            (0..times).try_for_each(|_| self.step(power))?;
        }
        Some(self.worst()).filter(|w| w.is_finite())
    }

    /// After one of its points was rounded.
    pub(super) fn again(&mut self) -> Option<()> {
        (0..3).try_for_each(|_| self.step(8.0))
    }

    /// The largest distance at the places looked at, and of corners from where they were drawn, units.
    pub(super) fn worst(&mut self) -> f64 {
        let offs = self.look();
        self.largest(&offs)
    }

    /// Samples beside the start of a quadratic and its end.
    pub(super) fn stretch(&self, quad: usize) -> (f64, f64) {
        let around = self.feet[0] + count(self.curve.last - self.curve.first);
        let to = self.feet.get((quad + 1) * LOOK).copied();
        (self.feet[quad * LOOK], to.unwrap_or(around))
    }

    /// Whether the curve lies within the limit of the lines that reach from its ends to the chain's.
    pub(super) fn keeps_lines(&self, limit: f64) -> bool {
        let (first, last) = (self.curve.first, self.curve.last);
        let end = self.feet.last().map_or(last, |&at| whole(at.max(0.0)));
        let [start, stop] = self.chain.along;
        let beside = |from: usize, to: usize, u: Vec2, end: usize| {
            let away = |p: Point| u.cross(p - self.curve.dots[end].p).abs();
            let dots = self.curve.dots.iter().take(to + 1).skip(from);
            dots.map(|o| away(o.p)).fold(0.0, f64::max) <= limit
        };
        start.is_none_or(|u| beside(first, whole(self.feet[0].max(0.0)), u, first))
            && stop.is_none_or(|u| beside(end, last, u, last))
    }

    /// Of each quadratic its start and seven places more; of an open chain its end.
    fn places(&self) -> Vec<(usize, f64)> {
        let many = self.chain.many();
        let all = (0..many * LOOK).map(|k| (k / LOOK, count(k % LOOK) / count(LOOK)));
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
            let first = || before.map_or(count(self.curve.first), next);
            let guess = self.feet.get(k).copied().unwrap_or_else(first);
            let (at, far) = self.curve.foot(q, guess.max(0.0));
            before = Some((q, at));
            feet.push(at);
            let t = self.curve.dots[whole(at + 0.5).min(last)].t;
            let left = Vec2::new(-t.y, t.x);
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

    /// A Newton step towards the least sum of this power of the distances.
    fn step(&mut self, power: f64) -> Option<()> {
        /// Added to the diagonal, parts of its largest entry: along the curve hardly anything holds a point.
        const DAMPING: f64 = 1e-3;
        /// Weight of what lies on the curve.
        const LEAST: f64 = 1e-4;
        let offs = self.look();
        let worst = self.largest(&offs).max(1e-9);
        let n = self.chain.unknowns;
        let (mut a, mut b) = (DMatrix::<f64>::zeros(n, n), DVector::<f64>::zeros(n));
        let mut add = |row: &[(usize, f64)], far: f64, size: f64| {
            let weight = (size / worst).powf(power - 2.0) + LEAST;
            for &(i, g) in row {
                b[i] -= weight * g * far;
                for &(j, h) in row {
                    a[(i, j)] += weight * g * h;
                }
            }
        };
        let spots = &self.chain.spots;
        for ((quad, u), o) in self.places().into_iter().zip(&offs) {
            let parts = self.chain.weights(quad, u).into_iter();
            let row = parts.flat_map(|(k, w)| {
                let ways = spots[k].ways.iter();
                ways.map(move |&(i, v)| (i, w * o.left.dot(v)))
            });
            add(&row.collect::<Vec<_>>(), o.far, o.far.abs());
        }
        for (s, home) in spots.iter().filter_map(|s| Some((s, s.home?))) {
            let e = s.at - home;
            s.ways
                .iter()
                .for_each(|&(i, v)| add(&[(i, 1.0)], e.dot(v), e.hypot()));
        }
        let damping = DAMPING * a.diagonal().max().max(1e-9);
        for i in 0..n {
            a[(i, i)] += damping;
        }
        let step = a.cholesky()?.solve(&b) / (power - 1.0);
        for s in &mut self.chain.spots {
            s.ways.iter().for_each(|&(i, v)| s.at += v * step[i]);
        }
        Some(())
    }
}
