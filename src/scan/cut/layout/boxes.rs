//! Printed boxes, each around one letter: separate frames or the meshes of ruled lines.

use super::frames::frames;
use super::named::{Place, named};
use super::rows::rows;
use super::{Task, listed};
use crate::scan::components::Component;
use crate::scan::cut::{Layer, Levels, Reason};
use crate::scan::error::Fault;
use crate::scan::options::Order;
use crate::types::{Direction, Label};
use kurbo::Rect;
use std::mem;

/// Share of a box's side along its line in which ink that reaches the line is taken for line.
const RIM: f64 = 0.07;
/// Least ink that boxes hold, as a share of what lies outside them: more can be printed beside boxes than is written
/// in them.
const HELD: f64 = 0.25;

/// Shares the ink out to the boxes that are found.
pub(super) fn place(
    all: &mut Vec<Component>,
    labels: &[Label],
    task: &Task<'_>,
) -> Result<Layer, Fault> {
    let frames = frames(all, task, labels.len());
    share(all, &frames, labels, task)
}

/// Shares the ink out to boxes. Pieces of ink that a letter forms with its box are cut free and appended to `all`.
pub(super) fn share(
    all: &mut Vec<Component>,
    frames: &[Rect],
    labels: &[Label],
    task: &Task<'_>,
) -> Result<Layer, Fault> {
    let order = rows(frames);
    let rows: Vec<usize> = order.iter().map(Vec::len).collect();
    listed::check(&task.options.lines, (Order::Rows, &rows))?;
    let mut rejected = Vec::new();
    let mut inside: Vec<Vec<usize>> = vec![Vec::new(); frames.len()];
    let mut freed = Vec::new();
    for (i, c) in all.iter().enumerate() {
        let touched: Vec<usize> = (0..frames.len())
            .filter(|&f| reaches(c.upright, frames[f]))
            .collect();
        let home = (0..frames.len()).find(|&f| frames[f].contains(c.centre));
        match (touched.is_empty(), home) {
            (true, Some(f)) if in_rim(c.upright, frames[f]) => rejected.push((i, Reason::Line)),
            (true, Some(f)) => inside[f].push(i),
            (true, None) => rejected.push((i, Reason::Outside)),
            (false, _) => {
                rejected.push((i, Reason::Line));
                freed.extend(
                    touched
                        .into_iter()
                        .map(|f| (f, c.within(task.upright, free(frames[f])))),
                );
            }
        }
    }
    for (f, pieces) in freed {
        for piece in pieces {
            inside[f].push(all.len());
            all.push(piece);
        }
    }
    if labels.len() > frames.len() {
        let held = inside.iter().flatten().map(|&i| all[i].area).sum();
        let outside = rejected.iter().filter(|r| r.1 == Reason::Outside);
        let outside = outside.map(|r| all[r.0].area).sum();
        return Err(too_many(frames.len(), labels, (held, outside)));
    }
    let boxes = order.iter().enumerate().flat_map(|(r, row)| {
        let mut row: Vec<_> = (row.iter().enumerate()).map(|(c, &f)| (r, c, f)).collect();
        if task.options.direction == Direction::Rtl {
            row.reverse();
        }
        row
    });
    let places = boxes.enumerate().map(|(index, (row, column, f))| Place {
        index,
        row,
        column,
        level: frames[f].y1,
        parts: mem::take(&mut inside[f]),
    });
    let slots = named(all, places.collect(), labels, &mut rejected)?;
    Ok(Layer {
        slots,
        rows: order.len(),
        levels: Levels::Printed,
        rejected,
        parted: Vec::new(),
        doubtful: Vec::new(),
    })
}

/// Why there are more names than boxes: too many names, or no boxes.
fn too_many(found: usize, labels: &[Label], (held, outside): (usize, usize)) -> Fault {
    let names = labels.len();
    match labels.get(found) {
        Some(extra) if held as f64 > HELD * outside as f64 => Fault::TooManyNames {
            cells: found,
            names,
            extra: extra.0.clone(),
        },
        _ => Fault::NoBoxes { found, names },
    }
}

/// What a box holds besides its rim.
fn free(frame: Rect) -> Rect {
    frame.inset(-RIM * frame.size().min_side())
}

/// Whether a piece of ink reaches from a box's inside, or around it, to its line.
fn reaches(ink: Rect, frame: Rect) -> bool {
    let over = ink.x0 < frame.x0 || ink.y0 < frame.y0 || ink.x1 > frame.x1 || ink.y1 > frame.y1;
    over && ink.overlaps(frame)
}

/// Whether a piece of ink lies along one side of a box.
fn in_rim(ink: Rect, frame: Rect) -> bool {
    !ink.overlaps(free(frame))
}
