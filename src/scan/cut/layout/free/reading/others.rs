//! Other readings than the best: how near the best one comes in which a piece is something else, or a name or a
//! letter is none.

use super::costs::{Step, steps};
use super::table::Table;
use super::{DOUBT, Names, Reading, Role, Seen};
use std::ops::RangeInclusive;

/// By how much each piece's role makes the reading likelier than the best one in which it is something else.
pub(super) fn margins(
    (pieces, names): (&[Seen], Names<'_>),
    table: &Table,
    rest: &[f64],
    reading: &Reading,
) -> Vec<f64> {
    let width = table.width;
    let mut margins = vec![f64::INFINITY; pieces.len()];
    for (i, margin) in margins.iter_mut().enumerate() {
        for j in 0..=names.shapes.len() {
            let others = steps(pieces, names, (i, j));
            let others =
                others.filter(|s| matches!(s.0, Step::Take(role) if role != reading.roles[i]));
            let more = others.map(|(_, to, cost)| {
                table.cost[i * width + j] + cost + rest[to.0 * width + to.1] - reading.cost
            });
            *margin = more.fold(*margin, f64::min);
        }
    }
    margins
}

/// The names without one of which pieces and names cost least, and how much less that is.
pub(super) fn without_a_name(
    (pieces, names): (&[Seen], Names<'_>),
    table: &Table,
    rest: &[f64],
    reading: &Reading,
) -> Option<(RangeInclusive<usize>, f64)> {
    let gain = |j: usize| {
        let places = (0..=pieces.len()).map(|i| i * table.width + j);
        let gains = places.map(|at| reading.cost - table.cost[at] - rest[at + 1]);
        (j, gains.fold(f64::NEG_INFINITY, f64::max))
    };
    likeliest((0..names.shapes.len()).map(gain))
}

/// The first and the last of the letters without one of which they cost least.
pub(super) fn without_a_letter(
    names: Names<'_>,
    table: &Table,
    rest: &[f64],
    reading: &Reading,
) -> Option<RangeInclusive<usize>> {
    let gain = |i: usize| {
        let places = (0..=names.shapes.len()).map(|j| i * table.width + j);
        let gains = places.map(|at| reading.cost - table.cost[at] - rest[at + table.width]);
        (i, gains.fold(f64::NEG_INFINITY, f64::max))
    };
    let is_letter = |i: &usize| !matches!(reading.roles[*i], Role::Part | Role::Dirt);
    let letters = (0..reading.roles.len()).filter(is_letter);
    likeliest(letters.map(gain)).map(|run| run.0)
}

/// The run of what gains about as much as the best, from the first one on, and that gain.
fn likeliest(gains: impl Iterator<Item = (usize, f64)>) -> Option<(RangeInclusive<usize>, f64)> {
    let gains: Vec<(usize, f64)> = gains.collect();
    let best = gains.iter().map(|g| g.1).reduce(f64::max)?;
    let is_best = |g: &&(usize, f64)| g.1 > best - DOUBT;
    let run = gains.iter().skip_while(|g| !is_best(g)).take_while(is_best);
    let (first, last) = (run.clone().next()?.0, run.last()?.0);
    Some((first..=last, best))
}
