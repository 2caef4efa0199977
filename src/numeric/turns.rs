//! Directions along a row of points, how they turn, and where they stay.

use super::angles::angle;
use kurbo::{Point, Vec2};
use std::ops::Range;

/// Whether a row of points closes on itself.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ends {
    /// From the first point to the last.
    Open,
    /// From the last point back to the first, which is not repeated.
    Closed,
}

/// Points with their distance along the polyline through them [samavati98 eq. 7-10].
#[derive(Debug, Clone)]
pub struct Walk<'a> {
    points: &'a [Point],
    ends: Ends,
    /// Distance from the first point to point i; one more entry when closed.
    lengths: Vec<f64>,
}

/// What counts as straight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Straight {
    /// Length of the chords whose directions are compared, in the points' unit.
    pub reach: f64,
    /// Largest turn between the two chords at a point of a straight run, radians.
    pub turn: f64,
    /// Shortest run, in the points' unit.
    pub length: f64,
    /// Farthest that a point of the run may lie from the line through its ends, in the points' unit.
    pub flat: f64,
}

/// Points of a run that are looked at when a broken line is put together: all of them would make the work
/// grow with the square of the breaks. The whole line is looked at once, at the end.
const SAMPLES: usize = 32;

impl<'a> Walk<'a> {
    /// Along `points`.
    #[must_use]
    pub fn new(points: &'a [Point], ends: Ends) -> Self {
        let back = points.first().filter(|_| ends == Ends::Closed);
        let mut sum = 0.0;
        let mut last = points.first().copied().unwrap_or_default();
        let step = |p: &Point| {
            sum += p.distance(last);
            last = *p;
            sum
        };
        let lengths = points.iter().chain(back).map(step).collect();
        Self {
            points,
            ends,
            lengths,
        }
    }

    /// Length of the whole polyline.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.lengths.last().copied().unwrap_or(0.0)
    }

    /// Distance of every point from the first.
    #[must_use]
    pub fn lengths(&self) -> &[f64] {
        &self.lengths[..self.points.len()]
    }

    /// The point `s` along; closed walks go on around, open ones stop at their ends.
    #[must_use]
    pub fn at(&self, s: f64) -> Point {
        let n = self.points.len();
        if n == 0 {
            return Point::ORIGIN;
        }
        let s = if self.ends == Ends::Closed && self.total() > 0.0 {
            s.rem_euclid(self.total())
        } else {
            s.clamp(0.0, self.total())
        };
        let i = self
            .lengths
            .partition_point(|&l| l <= s)
            .clamp(1, self.lengths.len().max(2) - 1)
            - 1;
        let (a, b) = (self.points[i], self.points[(i + 1) % n]);
        let piece = self.lengths.get(i + 1).map_or(0.0, |l| l - self.lengths[i]);
        if piece > 0.0 {
            a.lerp(b, (s - self.lengths[i]) / piece)
        } else {
            a
        }
    }

    /// The chords that come to point `i` from `reach` before it and lead to `reach` after it; with
    /// `reach` 0, from and to its neighbours [samavati98 eq. 11-12]. At an open end both are the same.
    #[must_use]
    pub fn chords(&self, i: usize, reach: f64) -> (Vec2, Vec2) {
        let n = self.points.len();
        let p = self.points[i];
        let (before, after) = if reach > 0.0 {
            let s = self.lengths[i];
            (self.at(s - reach), self.at(s + reach))
        } else if self.ends == Ends::Closed {
            (self.points[(i + n - 1) % n], self.points[(i + 1) % n])
        } else {
            (
                self.points[i.saturating_sub(1)],
                self.points[(i + 1).min(n - 1)],
            )
        };
        let (a, b) = (p - before, after - p);
        match (a.hypot2() > 0.0, b.hypot2() > 0.0) {
            (false, _) => (b, b),
            (_, false) => (a, a),
            _ => (a, b),
        }
    }

    /// The turn from the chord before to the chord after each point, radians, left positive.
    #[must_use]
    pub fn turns(&self, reach: f64) -> Vec<f64> {
        let turn = |i: usize| {
            let (a, b) = self.chords(i, reach);
            angle(a, b)
        };
        (0..self.points.len()).map(turn).collect()
    }

    /// The straight runs: ranges of indices, both ends included. In a closed walk the end may lie
    /// past the last index: take it modulo the number of points.
    #[must_use]
    pub fn straight_runs(&self, rule: &Straight) -> Vec<Range<usize>> {
        let turns = self.turns(rule.reach);
        let straight: Vec<bool> = turns.iter().map(|t| t.abs() < rule.turn).collect();
        let n = straight.len();
        let bent = straight.iter().position(|s| !s);
        let (start, count) = match (self.ends, bent) {
            // a round later, so that a run may grow back past the first point
            (Ends::Closed, Some(b)) => (b + n, n),
            (Ends::Closed, None) => return Vec::new(), // a ring without a bend is too large for the rule
            (Ends::Open, _) => (0, n),
        };
        let mut runs: Vec<Range<usize>> = Vec::new();
        let mut open: Option<usize> = None;
        for k in start..=start + count {
            let inside = k < start + count && straight[k % n];
            match (open, inside) {
                (None, true) => open = Some(k),
                (Some(a), false) => {
                    self.add(a..k - 1, rule, &mut runs);
                    open = None;
                }
                _ => {}
            }
        }
        let grown = runs.into_iter().filter_map(|r| self.line(r, rule));
        grown.collect()
    }

    /// Adds a run, or makes the last one longer where both are one line that noise has broken.
    fn add(&self, run: Range<usize>, rule: &Straight, runs: &mut Vec<Range<usize>>) {
        if let Some(last) = runs.last_mut() {
            let gap = self.along(run.start) - self.along(last.end);
            let whole = last.start..run.end;
            if gap <= rule.length && self.flat(&whole, rule.flat, whole.len() / SAMPLES + 1) {
                last.end = run.end;
                return;
            }
        }
        if self.flat(&run, rule.flat, 1) {
            runs.push(run);
        }
    }

    /// Whether every `step`th point of the run lies near the line through its ends.
    fn flat(&self, run: &Range<usize>, within: f64, step: usize) -> bool {
        let a = self.point(run.start);
        let d = (self.point(run.end) - a).normalize();
        let mut seen = (run.start..run.end).step_by(step);
        d.is_finite() && seen.all(|k| d.cross(self.point(k) - a).abs() <= within)
    }

    fn point(&self, k: usize) -> Point {
        self.points[k % self.points.len()]
    }

    /// Distance along to point `k`, which may lie in a later round.
    fn along(&self, k: usize) -> f64 {
        let n = self.points.len();
        self.lengths[k % n] + (k / n) as f64 * self.total()
    }

    /// The run with what belongs to its line at both ends, if that is long enough.
    fn line(&self, run: Range<usize>, rule: &Straight) -> Option<Range<usize>> {
        let n = self.points.len();
        let (a, b) = (self.point(run.start), self.point(run.end));
        let d = (b - a).normalize();
        if !self.flat(&run, rule.flat, 1) {
            return None;
        }
        let near = |k: usize| d.cross(self.point(k) - a).abs() <= rule.flat;
        // a point closer than the reach to the end of its line sees past it
        let last = match self.ends {
            Ends::Open => n - 1,
            Ends::Closed => run.start + n - 1,
        };
        let limit = self.along(run.end) + rule.reach;
        let grown = (run.end + 1..=last).take_while(|&k| self.along(k) <= limit && near(k));
        let end = grown.last().unwrap_or(run.end);
        let first = match self.ends {
            Ends::Open => 0,
            Ends::Closed => end.saturating_sub(n - 1),
        };
        let limit = self.along(run.start) - rule.reach;
        let grown = (first..run.start)
            .rev()
            .take_while(|&k| self.along(k) >= limit && near(k));
        let start = grown.last().unwrap_or(run.start);
        let rounds = start / n * n;
        (self.along(end) - self.along(start) >= rule.length).then_some(start - rounds..end - rounds)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::angles;

    /// A stadium: two straight sides of 40 and two half circles of radius 10, steps of about 1.
    fn stadium() -> Vec<Point> {
        let mut p: Vec<Point> = (0..40).map(|i| (f64::from(i), -10.0).into()).collect();
        let cap = |i: i32| angles::direction(f64::from(i) * std::f64::consts::PI / 31.0) * 10.0;
        let quarter = |v: Vec2| Vec2::new(v.y, -v.x);
        p.extend((0..31).map(|i| Point::new(40.0, 0.0) + quarter(cap(i))));
        p.extend((0..40).map(|i| Point::new(40.0 - f64::from(i), 10.0)));
        p.extend((0..31).map(|i| Point::ORIGIN - quarter(cap(i))));
        p
    }

    const RULE: Straight = Straight {
        reach: 4.0,
        turn: 0.03,
        length: 15.0,
        flat: 0.2,
    };

    #[test]
    fn straight_runs_are_the_sides_wherever_the_ring_starts() {
        let ring = stadium();
        for start in [0, 20, 55, 100, 141] {
            let mut points = ring.clone();
            points.rotate_left(start);
            let runs = Walk::new(&points, Ends::Closed).straight_runs(&RULE);
            assert_eq!(runs.len(), 2, "from {start}: {runs:?}");
            for r in runs {
                let (a, b) = (points[r.start % 142], points[r.end % 142]);
                assert!(
                    (a.distance(b) - 40.0).abs() < 6.0,
                    "from {start}: {a:?} {b:?}"
                );
            }
        }
    }

    #[test]
    fn turns_add_up_to_a_round() {
        let ring = stadium();
        let sum: f64 = Walk::new(&ring, Ends::Closed).turns(0.0).iter().sum();
        assert!((sum - std::f64::consts::TAU).abs() < 1e-9);
    }

    #[test]
    fn places_along() {
        let p = [Point::ORIGIN, Point::new(2.0, 0.0), Point::new(2.0, 2.0)];
        let open = Walk::new(&p, Ends::Open);
        assert_eq!(open.at(3.0), Point::new(2.0, 1.0));
        assert_eq!(open.at(9.0), p[2]);
        assert_eq!(open.at(-1.0), p[0]);
        let closed = Walk::new(&p, Ends::Closed);
        assert!((closed.total() - 4.0 - 8.0_f64.sqrt()).abs() < 1e-12);
        assert!(
            closed
                .at(closed.total() + 1.0)
                .distance(Point::new(1.0, 0.0))
                < 1e-12
        );
        assert_eq!(Walk::new(&[], Ends::Closed).at(1.0), Point::ORIGIN);
    }
}
