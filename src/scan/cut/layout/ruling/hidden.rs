//! Edges of letters that run along within a printed line.
//!
//! Where a bow's edge crosses a line at a small angle, there is ink on one side of the line alone for longer than the
//! line is thick, and what lies within it could be the letter's or the line's. The edge is seen again on both sides
//! of that stretch: the cubic through two places on either side says where it runs in between.

use crate::numeric::cast::index;
use std::iter;
use std::ops::Range;

/// How far beside a stretch its edge is looked at, as shares of the stretch: as far as it runs along the line, so
/// that a pixel makes little of a slope.
const BESIDE: [f64; 3] = [0.5, 0.25, 0.125];

/// A stretch of a line in which a letter's edge lies.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Hidden {
    along: Range<f64>,
    /// Places of the edge, along the line and across it.
    seen: [(f64, f64); 4],
    /// Its ink lies on the side where the line begins.
    before: bool,
}

impl Hidden {
    /// Whether its edge says of a place within the line that it is the letter's; none beside its stretch.
    pub(super) fn holds(&self, along: f64, across: f64) -> Option<bool> {
        let here = self.along.contains(&along);
        here.then(|| (across < self.edge(along)) == self.before)
    }

    /// The cubic through the places that are seen, as Lagrange has it.
    fn edge(&self, at: f64) -> f64 {
        let term = |&(x, y): &(f64, f64)| {
            let others = self.seen.iter().filter(|p| (p.0 - x).abs() > 0.0);
            y * others.map(|p| (at - p.0) / (x - p.0)).product::<f64>()
        };
        self.seen.iter().map(term).sum()
    }
}

/// The edges that lie within a line from one of its ends to the other; `ink` takes places along it and across.
pub(super) fn find(
    line: &Range<f64>,
    ends: &Range<f64>,
    ink: impl Fn(f64, f64) -> bool,
) -> Vec<Hidden> {
    let (before, after) = (line.start - 1.0, line.end + 1.0);
    let places = (0..index(ends.end - ends.start)).map(|i| ends.start + i as f64 + 0.5);
    let sides: Vec<(bool, bool)> = places.map(|v| (ink(v, before), ink(v, after))).collect();
    let mut at = ends.start;
    let runs: Vec<Run> = sides
        .chunk_by(|a, b| a == b)
        .map(|run| {
            let from = at;
            at += run.len() as f64;
            Run {
                along: from..at,
                ink: run[0],
            }
        })
        .collect();
    let line = Line {
        before,
        after,
        ink: &ink,
    };
    let places = 1..runs.len().saturating_sub(1);
    places
        // what is shorter is left to the ways across the line
        .filter(|&i| runs[i].length() > after - before)
        .filter_map(|i| {
            let left = line.beside(&runs[i], runs[..i].iter().rev())?;
            line.hidden(left, &runs[i], line.beside(&runs[i], runs[i + 1..].iter())?)
        })
        .collect()
}

/// A stretch of a line with the same sides.
struct Run {
    along: Range<f64>,
    /// Whether there is ink before the line and after it.
    ink: (bool, bool),
}

impl Run {
    fn length(&self) -> f64 {
        self.along.end - self.along.start
    }
}

/// A line seen from its two sides.
struct Line<'a, F> {
    before: f64,
    after: f64,
    ink: &'a F,
}

impl<F: Fn(f64, f64) -> bool> Line<'_, F> {
    /// The stretch next to one. Where a stroke thinner than the line passes from its one side to the other it has ink
    /// on neither for a while: the edge is seen again behind that.
    fn beside<'a>(&self, run: &Run, mut next: impl Iterator<Item = &'a Run>) -> Option<&'a Run> {
        let first = next.next()?;
        let is_gap = first.ink == (false, false) && first.length() < self.after - self.before;
        let passes = |behind: &&Run| is_gap && behind.ink == (run.ink.1, run.ink.0);
        Some(next.next().filter(passes).unwrap_or(first))
    }

    fn hidden(&self, left: &Run, run: &Run, right: &Run) -> Option<Hidden> {
        if run.ink.0 == run.ink.1 {
            return None;
        }
        let along = left.along.end..right.along.start;
        let seen = |beside: &Run, end: f64, way: f64| {
            let at = |share: &f64| {
                // two places in one say nothing of a slope
                let out = (share * run.length()).min(beside.length() - 1.0);
                let out = Some(out).filter(|out| *out >= 1.0)?;
                let place = self.seen(run, beside, (end, way * out))?;
                Some([(end, place.0), (end + way * out, place.1)])
            };
            BESIDE.iter().find_map(at)
        };
        let [a, b] = seen(left, along.start, -1.0)?;
        let [c, d] = seen(right, along.end, 1.0)?;
        Some(Hidden {
            along,
            seen: [b, a, c, d],
            before: run.ink.0,
        })
    }

    /// How far across the edge lies at a stretch's end, and so far beside it. Where there is ink on the other side
    /// beside the stretch it leaves the line on that one; where there is none at all, on the near one.
    fn seen(&self, run: &Run, beside: &Run, (end, out): (f64, f64)) -> Option<(f64, f64)> {
        let full = beside.ink.0 || beside.ink.1;
        let (from, step) = if run.ink.0 == full {
            (self.after, 1.0)
        } else {
            (self.before, -1.0)
        };
        // an edge that leaves the line at more than half a right angle does not run along it
        let most = index(out.abs()) + 1;
        let places = iter::successors(Some(from), |v| Some(v + step)).take(most);
        let mut beyond = places.skip_while(|v| (self.ink)(end + out, *v) == full);
        Some((from, beyond.next()? - 0.5 * step))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LINE: Range<f64> = 100.0..108.0;
    const ENDS: Range<f64> = 0.0..400.0;

    /// How far the longest edge that is found lies off the drawn one at most; `ink` counts outside the line.
    fn off(ink: impl Fn(f64, f64) -> bool, edge: impl Fn(f64) -> f64) -> f64 {
        let found = find(&LINE, &ENDS, ink).into_iter();
        let length = |h: &Hidden| h.along.end - h.along.start;
        let longest = found
            .max_by(|a, b| length(a).total_cmp(&length(b)))
            .unwrap();
        let places = (0..400).map(|i| f64::from(i) + 0.5);
        let within = places.filter(|v| longest.along.contains(v));
        within
            .map(|v| (longest.edge(v) - edge(v)).abs())
            .fold(0.0, f64::max)
    }

    #[test]
    fn a_bow_runs_on_within_the_line() {
        let bow = |depth: f64| move |x: f64| depth - (x - 200.0).powi(2) / 600.0;
        for depth in [103.0, 105.0, 107.0] {
            // from above, and as a counter's edge seen from below
            let edge = bow(depth);
            let far = off(|x, y| y < edge(x) && y > edge(x) - 40.0, edge);
            assert!(far < 1.0, "{depth}: {far}");
            let far = off(|x, y| y > edge(x) && y < edge(x) + 40.0, edge);
            assert!(far < 1.0, "{depth}: {far}");
        }
    }

    #[test]
    fn a_bow_whose_end_thins_out_within_the_line_runs_on() {
        // a bow's inner edge dips into the line, and its outer one rises through it before the inner one is out of it
        let inner = |x: f64| 103.0 - (x - 200.0).powi(2) / 900.0;
        let outer = |x: f64| 130.0 - 0.29 * (x - 180.0).max(-60.0);
        let far = off(|x, y| y > inner(x) && y < outer(x), inner);
        assert!(far < 2.0, "{far}");
    }

    #[test]
    fn an_edge_passes_through_the_line_aslant() {
        let edge = |x: f64| 104.0 + 0.15 * (x - 200.0);
        let far = off(|x, y| y > edge(x) && y < edge(x) + 60.0, edge);
        assert!(far < 1.0, "{far}");
    }

    #[test]
    fn an_edge_that_is_seen_for_one_pixel_alone_is_not_known() {
        // ink above the line, and on both its sides in one place at each end of it
        let bow = |x: f64, y: f64| {
            (150.0..250.0).contains(&x) && y < 104.0
                || [150.5, 249.5].iter().any(|end| (x - end).abs() < 0.1)
        };
        assert_eq!(find(&LINE, &ENDS, bow), []);
    }

    #[test]
    fn a_foot_that_ends_in_the_line_has_no_edge_along_it() {
        let foot = |x: f64, y: f64| (150.0..250.0).contains(&x) && y < 104.0;
        assert_eq!(find(&LINE, &ENDS, foot), []);
    }
}
