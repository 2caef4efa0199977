//! Letters of cells side by side, or one below the other, that touch: their ink is cut apart near the border of the
//! cells.
//!
//! Such ink lies in the cell of its centre; in each of the others, whose middles it reaches, there is more of it than
//! of other ink.

use super::axis::Axis;
use super::plan::Plan;
use super::shared::{Shared, share};
use crate::scan::components::Component;
use crate::scan::cut::layout::named::least;
use crate::scan::cut::layout::touching::{Along, End, Meeting, Touch};
use crate::scan::letters::Shape;
use crate::types::Label;
use glyphs_reader::glyphdata::GlyphData;
use std::ops::Range;

/// The border of two letters lies within this share of a cell from that of their cells.
const UNEQUAL: f64 = 0.3;

/// Cuts apart in `all` what is of several cells' letters, shares the ink out anew, and says which pieces were cut
/// from others. New pieces go to the end of `all` and of `letters`.
pub(super) fn part(
    all: &mut Vec<Component>,
    letters: &mut Vec<usize>,
    shared: &mut Shared,
    (labels, plan): (&[Label], &Plan<'_>),
) -> Vec<usize> {
    let mut parted = Vec::new();
    loop {
        let before = all.len();
        for touch in touching(all, shared, (labels, plan)) {
            parted.extend(touch.part(all, (plan.task.gray(), &plan.task.upright)));
        }
        letters.extend(before..all.len());
        match share(all, letters, labels, plan).filter(|_| all.len() > before) {
            Some(anew) => *shared = anew,
            None => return parted,
        }
    }
}

/// Letters of neighbouring cells that touch.
fn touching(
    all: &[Component],
    shared: &Shared,
    (labels, plan): (&[Label], &Plan<'_>),
) -> Vec<Touch> {
    let own = |cell: &Vec<usize>| cell.iter().map(|&i| all[i].area).sum::<usize>();
    let own: Vec<usize> = shared.cells.iter().map(own).collect();
    let least = least(own.iter().copied());
    let data = GlyphData::default();
    let mut named = vec![false; shared.cells.len()];
    let mut joined = vec![[false; 2]; shared.cells.len()];
    for (index, label) in labels.iter().enumerate().filter(|(_, l)| l.0 != "_") {
        let (row, column) = plan.place(index);
        let cell = row * plan.columns + column;
        named[cell] = plan.task.claims.iter().all(|(k, _)| *k != index);
        joined[cell] = Shape::of(label, &data).joined;
    }
    let claimed = |i: usize| plan.task.claims.iter().any(|(_, parts)| parts.contains(&i));
    let touch = |cell: usize, i: usize| {
        let (row, column) = (cell / plan.columns, cell % plan.columns);
        [Along::Row, Along::Column].into_iter().find_map(|along| {
            let (cells, home, reach) = match along {
                Along::Row => (&shared.x, column, (all[i].upright.x0, all[i].upright.x1)),
                Along::Column => (&shared.y, row, (all[i].upright.y0, all[i].upright.y1)),
            };
            // more of it than of what lies there alone, be it dots
            let holds = |k: usize| {
                let cell = match along {
                    Along::Row => row * plan.columns + k,
                    Along::Column => k * plan.columns + column,
                };
                let here =
                    |p: &(usize, usize)| cells.cell(along.at(*p, &plan.task.upright)) == Some(k);
                let ink = || all[i].pixels().filter(here).count();
                named[cell] && (least.max(own[cell] as f64)..).contains(&(ink() as f64))
            };
            let end = |k: usize| {
                let (border, reach) = (cells.begin(k), UNEQUAL * cells.pitch);
                let cell = row * plan.columns + k;
                let strokes = along == Along::Row && joined[cell - 1][1] && joined[cell][0];
                End {
                    stretch: border - reach..border + reach,
                    meeting: if strokes {
                        Meeting::Strokes
                    } else {
                        Meeting::Any
                    },
                }
            };
            let ends: Vec<End> = seconds(cells, home, reach, holds).map(end).collect();
            (!ends.is_empty()).then(|| Touch::at(ends, (along, vec![i]), cells.pitch))
        })
    };
    let ink = shared.cells.iter().enumerate();
    let ink = ink.flat_map(|(cell, ink)| ink.iter().map(move |&i| (cell, i)));
    ink.filter(|(_, i)| !claimed(*i))
        .filter_map(|(cell, i)| touch(cell, i))
        .collect()
}

/// Of the cells around `home` that ink from one place to another reaches the middles of, all but the first: the
/// letters may be cut apart where each of them begins.
fn seconds(
    cells: &Axis,
    home: usize,
    (from, to): (f64, f64),
    holds: impl Fn(usize) -> bool,
) -> Range<usize> {
    let middle = |k: usize| cells.begin(k) + cells.pitch / 2.0;
    let is_in = |k: &usize| (from..to).contains(&middle(*k)) && holds(*k);
    let first = (0..home).rev().take_while(is_in).last().unwrap_or(home);
    let last = (home + 1..cells.count)
        .take_while(is_in)
        .last()
        .unwrap_or(home);
    first + 1..last + 1
}
