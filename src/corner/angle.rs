//! Angle jumps and straight runs: the features of a contour.
//!
//! ```text
//! Source   [samavati98 sec. 3, eq. 7-14, fig. 4]
//! Solves   SC = {i : |angle(D+) - angle(D-)| > alpha}; LN = ends of runs where it is < epsilon
//! Takes    n >= 3 points, px, y up
//! Gives    indices of the critical corners SC; [`Angle::features`] also LN and the diagram
//! Symbols  alpha -> turn_deg, epsilon -> straight_deg, D-, D+ -> the chords of `numeric::turns`
//! Departs  angles are compared, not slopes (eq. 14 breaks at vertical tangents); the chords are reach_px
//!          long instead of one step, or a pixel's staircase would be all corners (0 gives the paper's own);
//!          of several jumps within the reach the largest counts; a straight run must lie within flat_px
//! Cost     O(n log n)      Fails  never
//! ```

use super::Detector;
use crate::numeric::angles;
use crate::numeric::turns::{Ends, Straight, Walk};
use crate::types::Contour;
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Options of the angle detector. What is not finite counts as 0.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Angle {
    /// Smallest turn that is a corner, called α in the paper, degrees.
    pub turn_deg: f64,
    /// Length of the chords whose directions are compared, px; 0 takes the neighbouring points.
    pub reach_px: f64,
    /// Largest turn within a straight run, called ε in the paper, degrees.
    pub straight_deg: f64,
    /// Shortest straight run, px.
    pub run_px: f64,
    /// Farthest that a point of a straight run may lie from the line through its ends, px.
    pub flat_px: f64,
}

impl Default for Angle {
    fn default() -> Self {
        Self {
            // half a right angle: the least that a staircase of pixels makes of a step
            turn_deg: 45.0,
            // long enough that noise of 0.3 px turns a chord by less than 5°
            reach_px: 5.0,
            straight_deg: 4.0,
            run_px: 20.0,
            flat_px: 0.5,
        }
    }
}

/// What the paper calls the features of a contour.
#[derive(Debug, Clone, PartialEq)]
pub struct Features {
    /// Way along the contour to every point, px.
    pub along_px: Vec<f64>,
    /// Direction of the chord after every point, degrees, without leaps of 360: the features diagram.
    pub direction_deg: Vec<f64>,
    /// Critical corners, SC in the paper: strictly increasing indices.
    pub corners: Vec<usize>,
    /// Where a straight run meets something else without a corner, LN in the paper: increasing indices.
    pub joints: Vec<usize>,
    /// The straight runs, both ends included; an end past the last index has gone around.
    pub lines: Vec<Range<usize>>,
}

impl Angle {
    /// Corners, straight runs and the diagram of one contour.
    #[must_use]
    pub fn features(&self, contour: &Contour) -> Features {
        let points = contour.points();
        let n = points.len();
        let walk = Walk::new(points, Ends::Closed);
        let corners = self.peaks(&walk);
        let rule = Straight {
            // longer than for corners, since noise has less to say over a longer chord
            reach: (self.run_px / 2.0).max(0.0),
            turn: self.straight_deg.to_radians(),
            length: self.run_px,
            flat: self.flat_px,
        };
        let lines = walk.straight_runs(&rule);
        let far = |i: usize| {
            corners
                .iter()
                .all(|&c| points[c].distance(points[i]) > self.reach_px)
        };
        let ends = lines.iter().flat_map(|r| [r.start % n, r.end % n]);
        let mut joints: Vec<usize> = ends.filter(|&i| far(i)).collect();
        joints.sort_unstable();
        joints.dedup();
        Features {
            along_px: walk.lengths().to_vec(),
            direction_deg: directions(&walk, n, self.reach_px.max(0.0)),
            corners,
            joints,
            lines,
        }
    }

    /// The points whose turn is a corner's and the largest within the reach.
    fn peaks(&self, walk: &Walk<'_>) -> Vec<usize> {
        let reach = self.reach_px.max(0.0);
        let turns: Vec<f64> = walk.turns(reach).iter().map(|t| t.abs()).collect();
        let (n, s, total) = (turns.len(), walk.lengths(), walk.total());
        let apart = |i: usize, j: usize| {
            let d = (s[i] - s[j]).abs();
            d.min(total - d)
        };
        let beats = |i: usize, j: usize| turns[j] < turns[i] || (turns[j] <= turns[i] && i <= j);
        let peak = |i: &usize| {
            let near = |j: &usize| apart(*i, *j) < reach;
            let ahead = (1..n).map(|k| (i + k) % n).take_while(near);
            let behind = (1..n).map(|k| (i + n - k) % n).take_while(near);
            turns[*i].to_degrees() > self.turn_deg && ahead.chain(behind).all(|j| beats(*i, j))
        };
        (0..n).filter(peak).collect()
    }
}

/// Direction of the chord after each point, degrees, unwrapped.
fn directions(walk: &Walk<'_>, n: usize, reach: f64) -> Vec<f64> {
    let mut last: Option<f64> = None;
    let unwrapped = |i: usize| {
        let here = angles::heading(walk.chords(i, reach).1).to_degrees();
        let turn = last.map_or(0.0, |l| ((here - l) / 360.0).round());
        let here = here - 360.0 * turn;
        last = Some(here);
        here
    };
    (0..n).map(unwrapped).collect()
}

impl Detector for Angle {
    fn corners(&self, contour: &Contour) -> Vec<usize> {
        self.peaks(&Walk::new(contour.points(), Ends::Closed))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Point;

    /// A D: a straight stem of 60 with two corners and half a circle.
    fn letter_d() -> Contour {
        let stem = (0..60).map(|i| Point::new(0.0, f64::from(60 - i)));
        let bow = (0..94).map(|i| {
            let a = f64::from(i) * std::f64::consts::PI / 94.0 - std::f64::consts::FRAC_PI_2;
            Point::new(30.0 * libm::cos(a), 30.0 + 30.0 * libm::sin(a))
        });
        Contour::new(stem.chain(bow).collect()).unwrap()
    }

    #[test]
    fn a_stem_is_one_line_between_two_corners() {
        let c = letter_d();
        let f = Angle::default().features(&c);
        let at: Vec<_> = f.corners.iter().map(|&i| c.points()[i]).collect();
        assert_eq!(at.len(), 2, "{at:?}");
        assert_eq!(f.lines.len(), 1, "{:?}", f.lines);
        assert!(f.joints.is_empty(), "its ends are corners: {:?}", f.joints);
        let (first, last) = (
            f.direction_deg[0],
            f.direction_deg[f.direction_deg.len() - 1],
        );
        assert!(
            (last - first - 360.0).abs() < 100.0,
            "one round to the left: {first} {last}"
        );
    }

    #[test]
    fn without_reach_it_is_the_papers_pointwise_rule() {
        let paper = Angle {
            reach_px: 0.0,
            ..Angle::default()
        };
        assert_eq!(paper.corners(&letter_d()), [0, 60]);
    }
}
