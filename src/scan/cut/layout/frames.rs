//! Where printed boxes are.
//!
//! A box is seen by its inside: paper that ink encloses. Slanted, warped and touched boxes enclose their paper all the
//! same; gaps in a line close at the reduced size at which they are looked for. Of boxes that stand in rows and
//! columns, those that are not seen lie where the others say.

use super::Task;
use super::rows::rows;
use crate::numeric::median::median;
use crate::scan::components::{Component, Touch, enclosed};
use kurbo::{Affine, Rect};
use rayon::prelude::*;

/// Longer side of the reduced picture in which boxes are looked for, px.
const REDUCED: usize = 1800;
/// Printed lines can be fainter than ink: parts of the least coverage of ink at which boxes are looked for in turn,
/// until there is one for each name, and standard deviations of noise that these stay from the paper.
const FAINTER: [f32; 3] = [1.0, 0.5, 0.25];
const NOISE: f32 = 6.0;
/// Side of a box at least, as a share of the picture's shorter side.
const LEAST_SIDE: f64 = 0.015;
/// Share of a box's rectangle that is paper at least.
const PAPER: f64 = 0.55;
/// How far a box's sides may differ from the usual ones, as a share.
const ALIKE: f64 = 0.25;
/// How far boxes of a column may lie beside each other, as a share of their width.
const COLUMN: f64 = 0.5;
/// A box of a table whose sides differ from the usual ones by more than this share is not seen as it is: its line has a
/// gap to a label's place beside it.
const ODD: f64 = 0.1;
/// Share of the places in rows and columns that show a box at least.
const SHOWN: f64 = 0.3;
/// Between the boxes of a table is more than a line where so large a share of their distance is none of them.
const APART: f64 = 0.1;

/// Insides of the boxes that are most alike, upright px: those of the darkest lines that make as many as there are
/// names, or the most; where these are fewer, with those of their rows and columns that are not seen, else with those
/// between others that hold ink.
pub(super) fn frames(all: &[Component], task: &Task<'_>, names: usize) -> Vec<Rect> {
    let small = Reduced::of(task);
    let mut most = Seen::default();
    for level in levels(task) {
        let seen = Seen::from(small.enclosed(task, level));
        if seen.count() > most.count() {
            most = seen;
        }
        if most.count() >= names {
            break;
        }
    }
    let Some(table) = most.table else {
        return most.frames;
    };
    let full = table.full();
    if most.frames.len() < names && full.len() >= names {
        return full;
    }
    let mut found = table.found();
    if found.len() != names {
        let is_inked = |place: &Rect| all.iter().any(|c| place.contains(c.centre));
        found.extend(table.gaps().filter(is_inked));
    }
    found
}

/// Boxes that are seen, and the table that they make.
#[derive(Default)]
struct Seen {
    frames: Vec<Rect>,
    table: Option<Table>,
}

impl Seen {
    fn from(frames: Vec<Rect>) -> Self {
        let table = Table::of(&frames);
        Self { frames, table }
    }

    /// How many are seen as they are.
    fn count(&self) -> usize {
        let odd = self.table.as_ref().map_or(0, |t| t.odd.len());
        self.frames.len() - odd
    }
}

/// The boxes of a table of so many rows and columns that hold letters and have more than a line between them, as
/// printed labels; row by row, upright px.
pub(super) fn apart(
    all: &[Component],
    task: &Task<'_>,
    (rows, columns): (usize, usize),
) -> Option<Vec<Rect>> {
    let small = Reduced::of(task);
    let tables = levels(task).into_iter();
    let mut tables = tables.filter_map(|level| Table::of(&small.enclosed(task, level)));
    let is_whole = |t: &Table| {
        (t.cells.len(), t.columns()) == (rows, columns) && t.full().len() == rows * columns
    };
    let table = tables.find(is_whole);
    Some(table.filter(|t| t.is_apart() && t.holds(all))?.full())
}

/// The coverages at which boxes are looked for.
fn levels(task: &Task<'_>) -> [f32; 3] {
    let floor = (NOISE * task.page.noise).min(task.low);
    FAINTER.map(|part| (part * task.low).max(floor))
}

/// A page's picture, reduced so that no line is lost: the darkest coverage of each block.
struct Reduced {
    /// Side of a block, px.
    step: usize,
    /// Blocks in a row.
    columns: usize,
    darkest: Vec<f32>,
}

impl Reduced {
    fn of(task: &Task<'_>) -> Self {
        let gray = task.gray();
        let (w, h) = (gray.width(), gray.height());
        let step = w.max(h).div_ceil(REDUCED).max(1);
        let columns = w / step;
        let row = |y: usize| {
            let mut darkest = vec![0.0_f32; columns];
            for row in (y * step..(y + 1) * step).map(|y| gray.row(y)) {
                let blocks = row.chunks_exact(step);
                for (most, block) in darkest.iter_mut().zip(blocks) {
                    *most = block.iter().fold(*most, |a, &v| if v > a { v } else { a });
                }
            }
            darkest
        };
        let rows: Vec<Vec<f32>> = (0..h / step).into_par_iter().map(row).collect();
        Self {
            step,
            columns,
            darkest: rows.concat(),
        }
    }

    /// Insides of the boxes that are most alike, of lines from a coverage on, upright px.
    fn enclosed(&self, task: &Task<'_>, low: f32) -> Vec<Rect> {
        let (w, h) = (task.gray().width(), task.gray().height());
        let least = LEAST_SIDE * w.min(h) as f64;
        let middle = |c: &Component| {
            let scaled = task.upright * Affine::scale(self.step as f64);
            let mut turned = c.clone();
            turned.stand(&scaled);
            turned.upright
        };
        let is_paper = |x: usize, y: usize| self.darkest[y * self.columns + x] < low;
        let size = (self.columns, h / self.step);
        let papers = enclosed(size, Touch::Sides, is_paper);
        let boxes: Vec<Rect> = papers
            .iter()
            .filter(|c| c.area as f64 > PAPER * c.bounds.area())
            .map(middle)
            .filter(|b| b.width() > least && b.height() > least)
            .collect();
        most_alike(&boxes)
    }
}

/// The boxes of one size that are many and large.
fn most_alike(boxes: &[Rect]) -> Vec<Rect> {
    let alike = |a: &Rect, b: &Rect| {
        (a.width() / b.width() - 1.0).abs() < ALIKE && (a.height() / b.height() - 1.0).abs() < ALIKE
    };
    let size = |b: &Rect| boxes.iter().filter(|o| alike(o, b)).count() as f64 * b.area().sqrt();
    let usual = boxes.iter().max_by(|a, b| size(a).total_cmp(&size(b)));
    usual.map_or_else(Vec::new, |u| {
        boxes.iter().filter(|b| alike(b, u)).copied().collect()
    })
}

/// Boxes that stand in rows and columns.
struct Table {
    /// Row by row, those that are seen as they are; as many in each.
    cells: Vec<Vec<Option<Rect>>>,
    /// Where there are others that a gap in their lines makes larger or ink smaller.
    odd: Vec<(usize, usize, Rect)>,
}

impl Table {
    /// Boxes by rows and columns, where each has a place of its own and most places have one.
    fn of(frames: &[Rect]) -> Option<Self> {
        let width = median(frames.iter().map(Rect::width))?;
        let mut middles: Vec<f64> = frames.iter().map(|f| f.center().x).collect();
        middles.sort_by(f64::total_cmp);
        let columns: Vec<f64> = middles
            .chunk_by(|a, b| b - a < COLUMN * width)
            .map(|column| column.iter().sum::<f64>() / column.len() as f64)
            .collect();
        let column = |f: &Rect| {
            let off = |c: &f64| (f.center().x - c).abs();
            let near = columns.iter().map(off).enumerate();
            let near = near.min_by(|a, b| a.1.total_cmp(&b.1))?;
            (near.1 < COLUMN * width).then_some(near.0)
        };
        let rows = rows(frames);
        let mut cells = vec![vec![None; columns.len()]; rows.len()];
        for (row, members) in cells.iter_mut().zip(rows) {
            for frame in members.into_iter().map(|i| frames[i]) {
                let place: &mut Option<Rect> = &mut row[column(&frame)?];
                if place.replace(frame).is_some() {
                    return None;
                }
            }
        }
        let places = cells.len() * columns.len();
        let table = Self {
            cells,
            odd: Vec::new(),
        };
        (frames.len() as f64 >= SHOWN * places as f64).then(|| table.without_odd())
    }

    fn without_odd(mut self) -> Self {
        let all = || self.cells.iter().flatten().flatten();
        let usual = [
            median(all().map(Rect::width)),
            median(all().map(Rect::height)),
        ];
        let [width, height] = usual.map(|side| side.unwrap_or(1.0));
        let is_odd = |f: &Rect| {
            (f.width() / width - 1.0).abs() > ODD || (f.height() / height - 1.0).abs() > ODD
        };
        for (r, row) in self.cells.iter_mut().enumerate() {
            for (c, place) in row.iter_mut().enumerate() {
                let odd = place.take_if(|f| is_odd(f));
                self.odd.extend(odd.map(|f| (r, c, f)));
            }
        }
        self
    }

    fn columns(&self) -> usize {
        self.cells.first().map_or(0, Vec::len)
    }

    /// Those that are seen, as they are or as the others say.
    fn found(&self) -> Vec<Rect> {
        let odd = self.odd.iter();
        let odd = odd.map(|&(r, c, seen)| self.place(r, c).unwrap_or(seen));
        let seen = self.cells.iter().flatten().flatten().copied();
        seen.chain(odd).collect()
    }

    /// All of its boxes, row by row.
    fn full(&self) -> Vec<Rect> {
        let places = (0..self.cells.len()).flat_map(|r| (0..self.columns()).map(move |c| (r, c)));
        places.filter_map(|(r, c)| self.place(r, c)).collect()
    }

    /// Those that are not seen between others of their row.
    fn gaps(&self) -> impl Iterator<Item = Rect> {
        let between = |row: &Vec<Option<Rect>>| {
            let first = row.iter().position(Option::is_some).unwrap_or(0);
            let last = row.iter().rposition(Option::is_some).unwrap_or(0);
            (first..last)
                .filter(|&c| row[c].is_none())
                .collect::<Vec<_>>()
        };
        let rows = self.cells.iter().map(between).enumerate();
        let places = rows.flat_map(|(r, gaps)| gaps.into_iter().map(move |c| (r, c)));
        let places = places.filter(|&(r, c)| !self.odd.iter().any(|o| (o.0, o.1) == (r, c)));
        places.filter_map(|(r, c)| self.place(r, c))
    }

    /// A box as it is seen, or as its column and its row say.
    fn place(&self, r: usize, c: usize) -> Option<Rect> {
        let column = self.cells.iter().map(|row| row[c]).enumerate();
        let column = column.filter_map(|(i, f)| Some((i, f?)));
        let row = self.cells[r].iter().copied().enumerate();
        let row = row.filter_map(|(i, f)| Some((i, f?)));
        let (column, row): (Vec<_>, Vec<_>) = (column.collect(), row.collect());
        let across = |of: fn(&Rect) -> f64| between(&column, r, of);
        let down = |of: fn(&Rect) -> f64| between(&row, c, of);
        let (x0, x1) = (across(|f| f.x0)?, across(|f| f.x1)?);
        let (y0, y1) = (down(|f| f.y0)?, down(|f| f.y1)?);
        self.cells[r][c].or(Some(Rect::new(x0, y0, x1, y1)))
    }

    /// Whether most of its boxes hold ink: the counters of letters hold none.
    fn holds(&self, all: &[Component]) -> bool {
        let seen = || self.cells.iter().flatten().flatten();
        let holds = |frame: &&Rect| all.iter().any(|c| frame.contains_rect(c.upright));
        2 * seen().filter(holds).count() > seen().count()
    }

    /// Whether its boxes have more than a line between them.
    fn is_apart(&self) -> bool {
        let all = || self.cells.iter().flatten().flatten();
        let rows = self
            .cells
            .windows(2)
            .flat_map(|two| two[0].iter().zip(&two[1]));
        let down = rows.filter_map(|(a, b)| Some(b.as_ref()?.y0 - a.as_ref()?.y0));
        let pairs = self.cells.iter().flat_map(|row| row.windows(2));
        let across = pairs.filter_map(|two| Some(two[1]?.x0 - two[0]?.x0));
        let gap = |pitch: Option<f64>, side: Option<f64>| {
            pitch
                .zip(side)
                .is_some_and(|(pitch, side)| pitch - side > APART * pitch)
        };
        gap(median(down), median(all().map(Rect::height)))
            || gap(median(across), median(all().map(Rect::width)))
    }
}

/// A value of the box at a place among the boxes of its row or column: between its next ones, or that of the next.
fn between(seen: &[(usize, Rect)], at: usize, of: fn(&Rect) -> f64) -> Option<f64> {
    let before = seen.iter().rev().find(|s| s.0 <= at);
    let after = seen.iter().find(|s| s.0 >= at);
    match (before, after) {
        (Some(a), Some(b)) if a.0 < b.0 => {
            let part = (at - a.0) as f64 / (b.0 - a.0) as f64;
            Some(of(&a.1) + part * (of(&b.1) - of(&a.1)))
        }
        (one, other) => one.or(other).map(|s| of(&s.1)),
    }
}
