//! Knots taken out and put in: where the spline has more of them than it needs, and where it needs more.

use super::objective::State;
use super::start::through;
use super::{FINE, ROUGH, STEPS_EACH, Task};
use crate::numeric::cast::index;

/// A new end point keeps this part of its piece free on either side.
const MARGIN: f64 = 0.25;
/// A piece that misses the tolerance by this factor is cut, however many others are.
pub(super) const FAR: f64 = 4.0;
/// Knots that are tried in vain before the search for a better place ends.
const VAIN: usize = 6;
/// Points times trials that the search may take: some seconds.
const EFFORT: usize = 60_000;
/// And trials at most.
const TRIALS: usize = 80;

impl Task<'_> {
    /// One end point more in each of the pieces with the largest errors, `room` of them at most.
    pub(super) fn refine(&self, state: &State, room: usize) -> Option<State> {
        let pieces = state.spline.pieces();
        let worst = self.worst(state);
        let mut order: Vec<usize> = (0..pieces).collect();
        order.sort_by(|&a, &b| worst[b].0.total_cmp(&worst[a].0).then(a.cmp(&b)));
        let far = worst.iter().filter(|w| w.0 > FAR * self.tolerance).count();
        let several = if self.options.step > 0.0 { far } else { 0 };
        let many = index(pieces as f64 * self.options.step).max(several);
        order.truncate(many.clamp(1, room.max(1)));
        order.retain(|&i| worst[i].0 > self.tolerance);
        if order.is_empty() {
            return None; // a spline that is not finite
        }
        let mut knots: Vec<f64> = (0..=pieces).map(|i| i as f64).collect();
        let cut = |&i: &usize| i as f64 + worst[i].1.clamp(MARGIN, 1.0 - MARGIN);
        knots.extend(order.iter().map(cut));
        self.reknot(state, knots)
    }

    /// The same number of end points, moved from where the spline bends evenly to where it misses most,
    /// as long as that lowers the sum of squares.
    pub(super) fn relocate(&self, mut state: State) -> State {
        let mut vain = 0;
        for _ in 0..self.trials() {
            let worst = self.worst(&state);
            let Some(i) = (0..worst.len()).max_by(|&a, &b| worst[a].0.total_cmp(&worst[b].0))
            else {
                break;
            };
            let cut = i as f64 + worst[i].1.clamp(MARGIN, 1.0 - MARGIN);
            let Some(&out) = self
                .evenest(&state)
                .iter()
                .filter(|&&k| k != i && k != i + 1)
                .nth(vain)
            else {
                break;
            };
            let knots = (0..=worst.len()).filter(|&k| k != out);
            let knots = knots.map(|k| k as f64).chain([cut]).collect();
            let moved = self.reknot(&state, knots).map(|s| self.settled(s));
            match moved.filter(|m| self.squares(m) < (1.0 - ROUGH) * self.squares(&state)) {
                Some(better) => (state, vain) = (better, 0),
                None => vain += 1,
            }
            if vain == VAIN {
                break;
            }
        }
        state
    }

    /// End points taken out until so many pieces are left.
    pub(super) fn reduce(&self, mut state: State, pieces: usize) -> Option<State> {
        while state.spline.pieces() > pieces {
            let out = *self.evenest(&state).first()?;
            let knots = (0..=state.spline.pieces()).filter(|&k| k != out);
            state = self.settled(self.reknot(&state, knots.map(|k| k as f64).collect())?);
        }
        Some(state)
    }

    pub(super) fn trials(&self) -> usize {
        TRIALS.min(EFFORT / self.points.len().max(1))
    }

    /// The knots inside, the one first whose removal changes the spline least: by the leap of its
    /// third derivative.
    fn evenest(&self, state: &State) -> Vec<usize> {
        let (v, pieces) = (&state.spline.vertices, state.spline.pieces());
        if pieces <= 4 {
            return Vec::new();
        }
        let third = |i: usize| (v[i + 3] - v[i]) - (v[i + 2] - v[i + 1]) * 3.0;
        let leap = |i: usize| (third(i) - third(i - 1)).hypot2();
        let most = (1..pieces).map(leap).fold(f64::MIN_POSITIVE, f64::max);
        // Equal but for the noise of arithmetic counts as equal, so that a shift changes nothing.
        let level = |i: usize| (1e6 * leap(i) / most).round();
        let mut leaps: Vec<(f64, usize)> = (1..pieces).map(|i| (level(i), i)).collect();
        leaps.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        leaps.into_iter().map(|(_, i)| i).collect()
    }

    /// The largest error of each piece, and where on it.
    fn worst(&self, state: &State) -> Vec<(f64, f64)> {
        let mut worst = vec![(0.0, 0.5); state.spline.pieces()];
        for (d, &u) in self.distances(state).zip(&state.feet) {
            let (i, t) = state.spline.split(u);
            if d > worst[i].0 {
                worst[i] = (d, t);
            }
        }
        worst
    }

    pub(super) fn squares(&self, state: &State) -> f64 {
        self.distances(state).map(|d| d * d).sum()
    }

    fn settled(&self, state: State) -> State {
        let feet = state.feet.clone();
        let state = if self.closed() {
            self.settle(state, feet)
        } else {
            state
        };
        self.descend(state, STEPS_EACH, ROUGH.max(FINE)).0
    }

    /// The spline whose pieces begin at these parameters of the old one, first and last included.
    fn reknot(&self, state: &State, mut knots: Vec<f64>) -> Option<State> {
        knots.sort_by(f64::total_cmp);
        let ends = &knots[..knots.len() - usize::from(self.closed())];
        let q: Vec<_> = ends.iter().map(|&u| state.spline.place(u).p).collect();
        let spline = through(&q, self.ends)?;
        let at = |i: usize| {
            let (piece, t) = state.spline.split(state.feet[i]);
            let u = piece as f64 + t;
            let j = knots.partition_point(|&k| k <= u).clamp(1, knots.len() - 1);
            (j - 1) as f64 + (u - knots[j - 1]) / (knots[j] - knots[j - 1])
        };
        Some(self.state(spline, at))
    }
}
