//! The least costs of all beginnings and of all ends, and the steps between.

use super::costs::{Step, steps};
use super::{Names, Reading, Role, Seen};

/// Costs of all beginnings: of so many pieces and so many names, and the last step of each.
pub(super) struct Table {
    pub(super) width: usize,
    pub(super) cost: Vec<f64>,
    by: Vec<Step>,
}

impl Table {
    pub(super) fn new(pieces: usize, names: usize) -> Self {
        let width = names + 1;
        let size = (pieces + 1) * width;
        let mut cost = vec![f64::INFINITY; size];
        cost[0] = 0.0;
        Self {
            width,
            cost,
            by: vec![Step::Pass; size],
        }
    }

    pub(super) fn step(&mut self, (i, j): (usize, usize), step: Step, cost: f64) {
        let at = i * self.width + j;
        if cost < self.cost[at] {
            (self.cost[at], self.by[at]) = (cost, step);
        }
    }

    /// All steps to the last beginning, which is the whole.
    pub(super) fn reading(&self, pieces: usize, names: usize) -> Reading {
        let (mut i, mut j) = (pieces, names);
        let (mut roles, mut missing) = (Vec::new(), Vec::new());
        while i > 0 || j > 0 {
            match self.by[i * self.width + j] {
                Step::Pass => {
                    j -= 1;
                    missing.push((j, i));
                }
                Step::Take(role) => {
                    i -= 1;
                    if let Role::Letter(k) | Role::Touching(k, _) = role {
                        j = k;
                    }
                    roles.push(role);
                }
            }
        }
        roles.reverse();
        missing.reverse();
        Reading {
            roles,
            missing,
            cost: self.cost.last().copied().unwrap_or(0.0),
            margins: Vec::new(),
            spare: None,
            extra: None,
        }
    }
}
/// Costs of all ends, behind so many pieces and so many names.
pub(super) fn rest(pieces: &[Seen], names: Names<'_>) -> Vec<f64> {
    let width = names.shapes.len() + 1;
    let mut rest = vec![f64::INFINITY; (pieces.len() + 1) * width];
    if let Some(last) = rest.last_mut() {
        *last = 0.0;
    }
    for i in (0..=pieces.len()).rev() {
        for j in (0..=names.shapes.len()).rev() {
            let behind =
                |(_, to, cost): (Step, (usize, usize), f64)| cost + rest[to.0 * width + to.1];
            let least = steps(pieces, names, (i, j)).map(behind).reduce(f64::min);
            let at = i * width + j;
            rest[at] = least.map_or(rest[at], |least| least.min(rest[at]));
        }
    }
    rest
}
