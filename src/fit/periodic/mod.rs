//! Cubic B-spline at the least orthogonal distance, by BFGS.
//!
//! ```text
//! Source   [lumilios93 sec. 2-5, eq. 3-20]
//! Solves   min sum w_i |P(u_i) - S_i|^2 + sum alpha ((u_i - u_{i-1}) / beta)^r over the control points,
//!          u_i the foot of S_i on P
//! Takes    n >= 4 points, px, y up; shorter spans give their polygon
//! Gives    a cubic a knot interval, exactly the spline; ends exact
//! Symbols  alpha, beta, r -> alpha, beta, power; C_i -> vertices; u_i -> feet; Q_j -> ends; w_i -> weights
//! Departs  alpha counts squares of the tolerance, so that the scale does not matter, and is 1/1000: at the
//!          paper's 1 the feet around sharp corners held the curve back (measured: Africa, rms 3.8 for 0.9 px);
//!          the quintics of five pieces around are solved, not of all: a foot on the far side of a stroke is
//!          wrong even when nearer; control points are added in several places at once (step 0: in one), and
//!          where their number is given taken out of more and moved as long as that helps;
//!          a ring is settled by linear least squares before BFGS; before control points are added to a spline
//!          that nearly meets the tolerance, weights that grow with the error are tried; a spline that comes no
//!          closer with twice the pieces is begun again with pieces of one length;
//!          open spans, which the paper leaves out, pass through their ends
//! Cost     O(n + m^2) a BFGS step for n points, m control points      Fails  never; Verdict::Exhausted when
//!          m reaches n beta / 2
//! ```

mod knots;
mod objective;
mod spline;
mod start;

use super::path::{both_ways, distinct, judged, path_of, polygon};
use super::wls::solve::{Ends as Outer, Problem};
use super::{FitError, Fitter};
use crate::numeric::bspline::Basis;
use crate::numeric::cast::index;
use crate::numeric::minimise::{Limits, bfgs};
use crate::numeric::turns::{Ends, Walk};
use crate::types::{Fitted, Span, Verdict};
use knots::FAR;
use kurbo::{CubicBez, Point};
use objective::{Distances, Penalty, State};
use serde::{Deserialize, Serialize};
use spline::Spline;
use start::{end_points, even, through, weights};

/// Chords that tell curvature, in tolerances: at the paper's 1 px, a few pixels.
const REACH: f64 = 4.0;
/// BFGS steps after each addition of control points [lumilios93 sec. 6].
const STEPS_EACH: usize = 50;
/// Two steps that lower the objective by less than this part end the search while points are being added.
const ROUGH: f64 = 1e-3;
/// And at the end.
const FINE: f64 = 1e-7;
/// Rounds of least squares and new feet before BFGS starts on a ring.
const ROUNDS: usize = 4;
/// Weight of the second derivative in them: just enough where a piece has few points.
const STIFF: f64 = 1e-3;

/// Options of the optimal spline fitter.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Periodic {
    /// Number of control points. Not given: a few, then more where the error is largest until the
    /// tolerance is met.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub control: Option<usize>,
    /// BFGS steps at most once the number of control points is settled; 0 leaves the first estimate.
    pub iterations: usize,
    /// Control points added at a time, as part of those there are; 0 adds them one by one as the paper does.
    pub step: f64,
    /// Weight of the sharpest bend against the straight.
    pub weight_ratio: f64,
    /// α of the penalty on feet far apart, squares of the tolerance.
    pub alpha: f64,
    /// β of that penalty, knot intervals.
    pub beta: f64,
    /// r of that penalty; even.
    pub power: u8,
}

impl Default for Periodic {
    fn default() -> Self {
        Self {
            control: None,
            iterations: 300,
            step: 0.125,
            weight_ratio: 5.0,
            alpha: 1e-3,
            beta: 0.5,
            power: 10,
        }
    }
}

impl Fitter for Periodic {
    fn check(&self) -> Result<(), FitError> {
        if let Some(c) = self.control.filter(|c| !(3..=10_000).contains(c)) {
            return Err(wrong("control", c, "it must be 3 to 10000"));
        }
        if !(0.0..=1.0).contains(&self.step) {
            return Err(wrong("step", self.step, "it must be 0 to 1"));
        }
        if !(1.0..=1000.0).contains(&self.weight_ratio) {
            let range = "it must be 1 to 1000";
            return Err(wrong("weight_ratio", self.weight_ratio, range));
        }
        if !(self.alpha.is_finite() && self.alpha >= 0.0) {
            return Err(wrong("alpha", self.alpha, "it must be 0 or more"));
        }
        if !(self.beta.is_finite() && self.beta > 0.0) {
            return Err(wrong("beta", self.beta, "it must be above 0"));
        }
        if self.power < 2 || self.power > 40 || self.power % 2 == 1 {
            return Err(wrong("power", self.power, "it must be even, 2 to 40"));
        }
        Ok(())
    }

    fn fit(&self, span: Span<'_>, tolerance_px: f64) -> Result<Fitted, FitError> {
        self.check()?;
        both_ways(span, |span| {
            let (points, ends) = distinct(span);
            if points.len() < 4 {
                return Ok(polygon(span));
            }
            // more, and neighbouring feet lie as far apart as the penalty forbids
            let most = index(points.len() as f64 * (self.beta.min(1.0) / 2.0));
            if let Some(count) = self.control.filter(|&c| c > points.len()) {
                let value = format!("{count} for {} points", points.len());
                let range = "it must not exceed the span's points";
                return Err(wrong("control", value, range));
            }
            let task = Task::new(self, &points, ends, tolerance_px);
            let state = task.solve(most);
            Ok(state
                .and_then(|s| task.fitted(&s, span))
                .unwrap_or_else(|| polygon(span)))
        })
    }
}

fn wrong(option: &'static str, value: impl ToString, range: &'static str) -> FitError {
    FitError::option(("periodic", option), value, range)
}

impl Periodic {}

/// One span to be fitted.
struct Task<'a> {
    options: &'a Periodic,
    points: &'a [Point],
    ends: Ends,
    tolerance: f64,
    walk: Walk<'a>,
    weights: Vec<f64>,
}

impl<'a> Task<'a> {
    fn new(options: &'a Periodic, points: &'a [Point], ends: Ends, tolerance: f64) -> Self {
        let walk = Walk::new(points, ends);
        let weights = weights(&walk, REACH * tolerance, options.weight_ratio);
        Self {
            options,
            points,
            ends,
            tolerance,
            walk,
            weights,
        }
    }

    fn closed(&self) -> bool {
        self.ends == Ends::Closed
    }

    /// The spline of the number of control points given, or of the first number that meets the tolerance.
    fn solve(&self, most: usize) -> Option<State> {
        let count = self
            .options
            .control
            .map(|c| if self.closed() { c } else { c - 1 });
        let state = self.begin(count)?;
        if self.options.iterations == 0 {
            return Some(state);
        }
        let state = match count {
            Some(count) => self.exactly(state, count),
            None => self.grow(state, most),
        };
        let within = self.meets(&state);
        let (last, _) = self.descend(state.clone(), self.options.iterations, FINE);
        let spoilt = within && !self.meets(&last);
        Some(if spoilt { state } else { last })
    }

    /// So many pieces: of those by curvature, and those left of more, the ones that come closer.
    fn exactly(&self, state: State, count: usize) -> State {
        /// So many times the pieces asked for are begun with.
        const MORE: usize = 2;
        let more = self.begin(None).filter(|_| self.trials() > 0);
        let left = more
            .and_then(|s| self.reduce(self.grow(s, MORE * count), count))
            .filter(|s| s.spline.pieces() == count);
        let moved = |s: State| self.relocate(self.descend(s, STEPS_EACH, ROUGH).0);
        let by_curvature = moved(state);
        match left.map(moved) {
            Some(left) if self.squares(&left) < self.squares(&by_curvature) => left,
            _ => by_curvature,
        }
    }

    fn begin(&self, count: Option<usize>) -> Option<State> {
        let ends = end_points(&self.walk, self.ends, REACH * self.tolerance, count);
        self.begin_at(&ends)
    }

    fn begin_at(&self, ends: &[usize]) -> Option<State> {
        let state = self.start(ends)?;
        let settles = self.closed() && self.options.iterations > 0;
        Some(if settles {
            self.settle(state, self.guesses(ends))
        } else {
            state
        })
    }

    /// Control points added until the tolerance is met or there are `most` pieces. A spline that is no closer with
    /// twice the pieces lies in loops, which more of them keep: it is begun again with as many of one length.
    fn grow(&self, mut state: State, most: usize) -> State {
        let mut begun: Option<(usize, f64)> = None;
        loop {
            state = self.descend(state, STEPS_EACH, ROUGH).0;
            let (pieces, error) = (state.spline.pieces(), self.error(&state));
            let (few, far) = *begun.get_or_insert((pieces, error));
            if pieces >= 2 * few && error > far.max(FAR * self.tolerance) && pieces < most {
                let ends = even(&self.walk, self.ends, pieces);
                if let Some(again) = self.begin_at(&ends) {
                    (state, begun) = (again, None);
                    continue;
                }
            }
            if self.meets(&state) || pieces >= most {
                return state;
            }
            if let Some(pressed) = self.pressed(&state) {
                return pressed;
            }
            match self.refine(&state, most - pieces) {
                Some(finer) => state = finer,
                None => return state,
            }
        }
    }

    /// The spline through the end points, and where each point's foot is on it.
    fn start(&self, ends: &[usize]) -> Option<State> {
        let q: Vec<Point> = ends.iter().map(|&i| self.points[i]).collect();
        let spline = through(&q, self.ends)?;
        let guesses = self.guesses(ends);
        Some(self.state(spline, |i| guesses[i]))
    }

    /// A parameter for every point: the way along between the end points.
    fn guesses(&self, ends: &[usize]) -> Vec<f64> {
        let s = self.walk.lengths();
        let total = self.walk.total();
        let around = self.closed().then(|| s[ends[0]] + total);
        let mut knots: Vec<f64> = ends.iter().map(|&i| s[i]).chain(around).collect();
        knots.dedup();
        let guess = |i: usize| {
            let s = if s[i] < knots[0] { s[i] + total } else { s[i] };
            let j = knots.partition_point(|&k| k <= s).clamp(1, knots.len() - 1);
            (j - 1) as f64 + (s - knots[j - 1]) / (knots[j] - knots[j - 1])
        };
        (0..s.len()).map(guess).collect()
    }

    /// The spline of a ring drawn to the points by linear least squares before its feet may move: the one
    /// through the end points has loops whose feet are out of order, and the penalty would keep them.
    fn settle(&self, start: State, mut feet: Vec<f64>) -> State {
        let pieces = start.spline.pieces();
        let Some(basis) = Basis::uniform(4, pieces + 3) else {
            return start;
        };
        let mut state = start;
        for _ in 0..ROUNDS {
            let at: Vec<f64> = feet
                .iter()
                .map(|u| 3.0 + u.rem_euclid(pieces as f64))
                .collect();
            let problem = Problem {
                points: self.points,
                basis: &basis,
                at: &at,
                mu: (STIFF, STIFF),
                ends: Outer::Periodic(pieces),
            };
            let Some(free) = problem.vertices() else {
                return state;
            };
            let vertices = free.iter().cycle().take(pieces + 3).copied().collect();
            let spline = Spline {
                vertices,
                closed: true,
            };
            state = self.state(spline, |i| feet[i]);
            feet.clone_from(&state.feet);
        }
        state
    }

    fn state(&self, spline: Spline, guess: impl Fn(usize) -> f64) -> State {
        let feet = self.points.iter().enumerate();
        let feet = feet.map(|(i, &p)| spline.foot(p, guess(i))).collect();
        State { spline, feet }
    }

    /// The spline drawn to where it misses most, by weights that grow with the error, if it meets the
    /// tolerance so: the sum of squares is then no longer the least.
    fn pressed(&self, state: &State) -> Option<State> {
        /// A spline that misses by more, in tolerances, needs more pieces.
        const NEAR: f64 = 1.6;
        /// Rounds of weights.
        const ROUNDS: usize = 8;
        /// Least factor on a weight.
        const LEAST: f64 = 0.3;
        if self.error(state) > NEAR * self.tolerance {
            return None;
        }
        let (mut state, mut weights) = (state.clone(), self.weights.clone());
        for _ in 0..ROUNDS {
            let far: Vec<f64> = self.distances(&state).collect();
            for (w, d) in weights.iter_mut().zip(far) {
                *w *= (d / self.tolerance).max(LEAST);
            }
            let sum: f64 = weights.iter().sum();
            weights.iter_mut().for_each(|w| *w /= sum);
            state = self.descend_by(&weights, state, STEPS_EACH, ROUGH).0;
            if self.meets(&state) {
                return Some(state);
            }
        }
        None
    }

    /// At most `steps` of BFGS, and the values on the way.
    fn descend(&self, state: State, steps: usize, progress: f64) -> (State, Vec<f64>) {
        self.descend_by(&self.weights, state, steps, progress)
    }

    fn descend_by(
        &self,
        weights: &[f64],
        state: State,
        steps: usize,
        progress: f64,
    ) -> (State, Vec<f64>) {
        let penalty = Penalty {
            weight: self.options.alpha * self.tolerance * self.tolerance,
            width: self.options.beta,
            power: i32::from(self.options.power),
        };
        let mut x = Distances::variables(&state.spline);
        // the sum of squares bends by about 1 / pieces along each control point
        let width = state.spline.pieces() as f64;
        let mut f = Distances::new(self.points, weights, penalty, state);
        let limits = Limits { steps, progress };
        let values = bfgs(&mut f, &mut x, width, limits);
        (f.into_state(), values)
    }

    /// How far each point lies from its foot.
    fn distances(&self, state: &State) -> impl Iterator<Item = f64> {
        let pairs = state.feet.iter().zip(self.points);
        pairs.map(|(&u, p)| state.spline.place(u).p.distance(*p))
    }

    fn meets(&self, state: &State) -> bool {
        /// The judge looks at the curve in short chords, which lie a little beside it.
        const SURE: f64 = 0.999;
        self.error(state) <= SURE * self.tolerance
    }

    fn error(&self, state: &State) -> f64 {
        self.distances(state).fold(0.0, f64::max)
    }

    fn fitted(&self, state: &State, span: Span<'_>) -> Option<Fitted> {
        let mut cubics: Vec<CubicBez> = state.spline.cubics();
        if let (Some(&a), Some(&b), false) =
            (self.points.first(), self.points.last(), self.closed())
        {
            cubics.first_mut()?.p0 = a;
            cubics.last_mut()?.p3 = b;
        }
        let free = if self.closed() {
            cubics.len()
        } else {
            cubics.len() + 3
        };
        judged(span, path_of(&cubics, span), (self.tolerance, 2 * free))
            .filter(|f| f.path.is_finite() || f.verdict == Verdict::Degenerate)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_objective_never_rises() {
        let ring: Vec<Point> = (0..200)
            .map(|i| {
                let a = f64::from(i) * std::f64::consts::TAU / 200.0;
                let r = 40.0 + 10.0 * libm::cos(5.0 * a);
                Point::new(r * libm::cos(a), r * libm::sin(a))
            })
            .collect();
        let options = Periodic::default();
        let task = Task::new(&options, &ring, Ends::Closed, 1.0);
        let ends = end_points(&task.walk, Ends::Closed, REACH, Some(14));
        let start = task.start(&ends).unwrap();
        let before = task.error(&start);
        let (state, values) = task.descend(start, 300, FINE);
        assert!(values.windows(2).all(|w| w[1] < w[0]), "{:?}", values);
        assert!(values.len() > 10 && task.error(&state) < before);
        assert_eq!(state.spline.pieces(), 14);
    }

    #[test]
    fn a_long_noisy_ring_is_met_with_few_pieces() {
        // bends that noise makes are end points far apart beside near ones, from which the spline swings out
        let mut state = 5_u64;
        let mut roll = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1_u64 << 53) as f64
        };
        let ring: Vec<Point> = (0..20_000)
            .map(|i| {
                let a = f64::from(i) * std::f64::consts::TAU / 20_000.0;
                let noise = 0.2 * ((0..12).map(|_| roll()).sum::<f64>() - 6.0);
                let r = 50.0 * (50.0 + 9.0 * libm::cos(2.0 * a) + 4.0 * libm::sin(3.0 * a)) + noise;
                Point::new(r * libm::cos(a), r * libm::sin(a))
            })
            .collect();
        let fitted = Periodic::default().fit(Span::Ring(&ring), 1.0).unwrap();
        assert_eq!(fitted.verdict, Verdict::Met);
        assert!(fitted.parameters < 1000, "{}", fitted.parameters);
    }
}
