//! Corners where two fitted sides meet.

use super::Detector;
use crate::types::Contour;
use serde::{Deserialize, Serialize};

/// Options of the default detector.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Sides {
    /// Smallest turn between the sides that is a corner, degrees.
    pub turn_deg: f64,
    /// How far from the corner a side's direction is taken, px.
    pub reach_px: f64,
}

impl Default for Sides {
    fn default() -> Self {
        Self {
            turn_deg: 40.0,
            reach_px: 4.0,
        }
    }
}

impl Detector for Sides {
    fn corners(&self, contour: &Contour) -> Vec<usize> {
        let p = contour.points();
        let n = p.len();
        let reach = |i: usize, step: usize| {
            let mut j = i;
            for _ in 0..n {
                j = (j + step) % n;
                if p[i].distance(p[j]) >= self.reach_px {
                    break;
                }
            }
            p[j]
        };
        let turn: Vec<f64> = (0..n)
            .map(|i| {
                let (a, b) = (p[i] - reach(i, n - 1), reach(i, 1) - p[i]);
                a.cross(b).atan2(a.dot(b)).abs().to_degrees()
            })
            .collect();
        let peak = |i: usize| {
            let near = |j: &usize| p[*j].distance(p[i]) < self.reach_px;
            let ahead = (1..n).map(|k| (i + k) % n).take_while(near);
            let behind = (1..n).map(|k| (i + n - k) % n).take_while(near);
            ahead
                .chain(behind)
                .all(|j| turn[j] < turn[i] || (turn[j] <= turn[i] && j > i))
        };
        (0..n)
            .filter(|&i| turn[i] >= self.turn_deg && peak(i))
            .collect()
    }
}
