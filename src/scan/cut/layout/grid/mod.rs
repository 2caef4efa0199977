//! Equal cells in rows and columns.

mod across;
mod axis;
mod furniture;
mod plan;
mod shared;

pub(super) use plan::Plan;

use super::named::{Place, named};
use super::ruling;
use super::{boxes, frames, listed};
use crate::scan::components::Component;
use crate::scan::cut::largest;
use crate::scan::cut::marks::{self, SMALL, groups};
use crate::scan::cut::sieve::LATTICE_COVER;
use crate::scan::cut::{Layer, Levels, Reason, gap};
use crate::scan::error::Fault;
use crate::scan::letters::{Pieces, Shape};
use crate::scan::options::Order;
use crate::types::Label;
use axis::Axis;
use kurbo::{Point, Rect};
use shared::{NEAR, Shared, neighbours, share};
use std::slice;

/// A piece longer than this many cells is no letter if it is thin or hollow.
const LINE_LENGTH: f64 = 1.4;
/// Thickness of a printed line at most, as a share of a cell.
const LINE_WIDTH: f64 = 0.06;
/// What a distance within the cell counts beside one to another cell's letter.
const HOME: f64 = 0.6;

/// Shares the ink out to the cells of a grid. Pieces that touch printed lines, or letters of other cells, are cut
/// free and appended to `all`.
pub(super) fn place(
    all: &mut Vec<Component>,
    labels: &[Label],
    plan: &Plan<'_>,
) -> Result<Layer, Fault> {
    let options = plan.task.options;
    listed::check(&options.lines, (options.order, &plan.lines()))?;
    plan.too_many(labels)?;
    // boxes with a label's place between them: what lies there is no letter's
    let boxed = options.order == Order::Rows;
    let boxes = boxed.then(|| frames::apart(all, plan.task, (plan.rows, plan.columns)));
    if let Some(frames) = boxes.flatten() {
        return boxes::share(all, &frames, labels, plan.task);
    }
    let lines = lines(all, plan);
    let is_lined = !lines.is_empty();
    let freed = lines
        .iter()
        .flat_map(|&i| ruling::freed(&all[i], plan.task.upright));
    let freed: Vec<Component> = freed.collect();
    all.extend(freed);
    let mut letters: Vec<usize> = (0..all.len()).filter(|i| !lines.contains(i)).collect();
    let mut rejected: Vec<(usize, Reason)> = lines.iter().map(|&i| (i, Reason::Line)).collect();
    let lattice: Vec<&Component> = lines.iter().map(|&i| &all[i]).collect();
    let plan = &Plan {
        printed: ruling::heights(&lattice, plan.task.upright),
        ..plan.clone()
    };
    let mut shared = share(all, &letters, labels, plan).ok_or(Fault::Blank)?;
    let label = |cell: usize| labels.get(plan.index((cell / plan.columns, cell % plan.columns)));
    let one_piece = |l: &Label| Shape::of(l).pieces == Pieces::One;
    let drawn = shared.cells.iter().enumerate();
    let drawn = drawn.filter_map(|(cell, parts)| Some((label(cell)?, parts.as_slice())));
    let asked: Vec<usize> = if marks::in_pieces(drawn, all) {
        Vec::new()
    } else {
        let cells = 0..shared.cells.len();
        cells.filter(|&c| label(c).is_some_and(one_piece)).collect()
    };
    let mut printed = furniture::find(all, &shared, &asked);
    printed.retain(|&i| !plan.task.is_hued(&all[i]));
    if !printed.is_empty() {
        letters.retain(|i| !printed.contains(i));
        shared = share(all, &letters, labels, plan).ok_or(Fault::Blank)?;
        rejected.extend(printed.into_iter().map(|i| (i, Reason::Furniture)));
    }
    let parted = across::part(all, &mut letters, &mut shared, (labels, plan));
    let Shared {
        x,
        y,
        is_printed,
        mut cells,
        outside,
    } = shared;
    rejected.extend(outside.into_iter().map(|i| (i, Reason::Outside)));
    settle_small_parts(all, &mut cells, &x, &y);
    let places = cells.into_iter().enumerate().map(|(cell, parts)| {
        let (row, column) = (cell / plan.columns, cell % plan.columns);
        Place {
            index: plan.index((row, column)),
            row,
            column,
            level: y.begin(row),
            parts,
        }
    });
    let slots = named(all, places.collect(), labels, &mut rejected)?;
    Ok(Layer {
        slots,
        rows: plan.rows,
        levels: match (is_printed, is_lined) {
            (true, _) => Levels::Printed,
            (false, true) => Levels::Even,
            (false, false) => Levels::Loose,
        },
        rejected,
        parted,
        doubtful: Vec::new(),
    })
}

/// Pieces that are printed lines: longer than a cell, and thin or hollow.
fn lines(all: &[Component], plan: &Plan<'_>) -> Vec<usize> {
    let Some(page) = all.iter().map(|c| c.upright).reduce(|a, b| a.union(b)) else {
        return Vec::new();
    };
    let (w, h) = (
        page.width() / plan.columns as f64,
        page.height() / plan.rows as f64,
    );
    let is_line = |c: &Component| {
        let b = c.upright;
        let long = b.width() > LINE_LENGTH * w || b.height() > LINE_LENGTH * h;
        let thin = b.width() < LINE_WIDTH * w || b.height() < LINE_WIDTH * h;
        long && (thin || (c.area as f64) < LATTICE_COVER * b.area())
    };
    (0..all.len()).filter(|&i| is_line(&all[i])).collect()
}

/// Dots and accents near a border of cells go to the letter that is nearer.
fn settle_small_parts(all: &[Component], cells: &mut [Vec<usize>], x: &Axis, y: &Axis) {
    let columns = x.count;
    let bodies: Vec<Option<usize>> = cells.iter().map(|c| largest(all, c)).collect();
    let mut moves = Vec::new();
    for (from, parts) in cells.iter().enumerate() {
        let others = parts.iter().copied().filter(|&p| bodies[from] != Some(p));
        let others: Vec<usize> = others.collect();
        let boxes: Vec<Rect> = others.iter().map(|&i| all[i].upright).collect();
        let groups = groups(&boxes).into_iter();
        let groups: Vec<Vec<usize>> = groups
            .map(|g| g.into_iter().map(|i| others[i]).collect())
            .collect();
        for &part in parts {
            let c = &all[part];
            let main = bodies[from].map_or(0, |b| all[b].area);
            // the only ink of its cell may be a letter that sits high or low, or a neighbour's dot
            let alone = bodies[from] == Some(part);
            if !alone && c.area as f64 > SMALL * main as f64 {
                continue;
            }
            let group = groups.iter().find(|g| g.contains(&part));
            let group = group.map_or(slice::from_ref(&part), Vec::as_slice);
            let is_near = |at: Point| y.clearance(at.y) < NEAR || x.clearance(at.x) < NEAR;
            if !group.iter().any(|&i| is_near(all[i].centre)) {
                continue;
            }
            let place = group
                .iter()
                .fold(c.upright, |r, &i| r.union(all[i].upright));
            let around = neighbours(from, columns, cells.len() / columns);
            let candidates =
                around.filter_map(|to| bodies[to].filter(|&b| b != part).map(|b| (to, b)));
            let nearest = candidates
                .filter(|&(to, b)| to == from || (c.area as f64) < SMALL * all[b].area as f64)
                .map(|(to, b)| {
                    let home = if to == from { HOME } else { 1.0 };
                    (home * gap(place, all[b].upright), to)
                })
                .min_by(|a, b| a.0.total_cmp(&b.0));
            let close = NEAR * y.pitch.min(x.pitch) / 2.0;
            let nearest = nearest.filter(|n| n.1 != from && (!alone || n.0 < close));
            moves.extend(nearest.map(|(_, to)| (part, from, to)));
        }
    }
    for (part, from, to) in moves {
        cells[from].retain(|&p| p != part);
        cells[to].push(part);
    }
}
