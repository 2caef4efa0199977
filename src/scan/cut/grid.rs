//! Equal cells in rows and columns.

use super::{Layer, Reason, Slot, furniture, gap, listed, marks, position, ruling};
use crate::numeric::view::View;
use crate::scan::clean::Page;
use crate::scan::components::Component;
use crate::scan::error::ScanError;
use crate::scan::grid::Axis;
use crate::scan::letters::{Pieces, Shape};
use crate::scan::options::{Options, Order};
use crate::types::Label;
use glyphs_reader::glyphdata::GlyphData;
use kurbo::Point;
use std::collections::BTreeSet;
use std::ops::Range;

/// A piece longer than this many cells is no letter if it is thin or hollow.
const LINE_LENGTH: f64 = 1.4;
/// Share of its box that a printed lattice covers at most.
const LINE_COVER: f64 = 0.12;
/// Thickness of a printed line at most, as a share of a cell.
const LINE_WIDTH: f64 = 0.06;
/// Small parts this near to a border of cells, as a share of the pitch, go to the nearer letter.
const NEAR: f64 = 0.2;
/// What a distance within the cell counts beside one to another cell's letter.
const HOME: f64 = 0.6;
/// A part smaller than this share of the largest part of its cell is a dot or an accent.
pub(super) const SMALL: f64 = 0.4;
/// Ink in a cell without a name, and where cells are looked for, counts from this share of a usual cell's ink.
const COUNTS: f64 = 0.1;
/// Letters without names at least that tell of a row or a column whose names are missing.
const NAMELESS: usize = 2;

/// A cell is at least this large, px.
const LEAST_CELL: usize = 4;

/// The grid that a user said.
pub(super) struct Plan<'a> {
    rows: usize,
    columns: usize,
    source: &'a str,
    options: &'a Options,
    upright: View,
}

impl<'a> Plan<'a> {
    pub(super) fn new(
        page: &'a Page,
        options: &'a Options,
        (rows, columns): (usize, usize),
        upright: View,
    ) -> Result<Self, ScanError> {
        let source = page.sheet.source.as_str();
        let gray = &page.sheet.gray;
        let fits = |n: usize, side: usize| n > 0 && n <= side / LEAST_CELL;
        let fine = fits(rows, gray.height()) && fits(columns, gray.width());
        fine.then_some(Self {
            rows,
            columns,
            source,
            options,
            upright,
        })
        .ok_or(ScanError::NoGrid { rows, columns })
    }

    fn place(&self, index: usize) -> (usize, usize) {
        position(index, (self.rows, self.columns), self.options)
    }

    fn index(&self, cell: (usize, usize)) -> Option<usize> {
        (0..self.rows * self.columns).find(|&i| self.place(i) == cell)
    }

    /// How many cells follow each other in a row, or in a column where columns come first.
    fn lines(&self) -> Vec<usize> {
        match self.options.order {
            Order::Rows => vec![self.columns; self.rows],
            Order::Columns => vec![self.rows; self.columns],
        }
    }

    fn too_many(&self, labels: &[Label]) -> Result<(), ScanError> {
        let cells = self.rows * self.columns;
        labels.get(cells).map_or(Ok(()), |extra| {
            Err(ScanError::TooManyNames {
                source_name: self.source.to_owned(),
                cells,
                names: labels.len(),
                extra: extra.0.clone(),
            })
        })
    }
}

/// Shares the ink out to the cells of a grid. Pieces that touch printed lines are cut free and appended to `all`.
pub(super) fn place(
    all: &mut Vec<Component>,
    labels: &[Label],
    plan: &Plan<'_>,
) -> Result<Layer, ScanError> {
    listed::check(&plan.options.lines, &plan.lines(), plan.source)?;
    plan.too_many(labels)?;
    let lines = lines(all, plan);
    let is_lined = !lines.is_empty();
    let freed = lines
        .iter()
        .flat_map(|&i| ruling::freed(&all[i], &plan.upright));
    let freed: Vec<Component> = freed.collect();
    all.extend(freed);
    let letters: Vec<usize> = (0..all.len()).filter(|i| !lines.contains(i)).collect();
    let mut rejected: Vec<(usize, Reason)> = lines.iter().map(|&i| (i, Reason::Line)).collect();
    let blank = || ScanError::Blank {
        source_name: plan.source.to_owned(),
    };
    let mut shared = share(all, &letters, labels, plan).ok_or_else(blank)?;
    let names = GlyphData::default();
    let label = |cell: usize| labels.get(plan.index((cell / plan.columns, cell % plan.columns))?);
    let one_piece = |l: &Label| Shape::of(l, &names).pieces == Pieces::One;
    let drawn = shared.cells.iter().enumerate();
    let drawn = drawn.filter_map(|(cell, parts)| Some((label(cell)?, parts.as_slice())));
    let asked: Vec<usize> = if marks::in_pieces(drawn, all, &names) {
        Vec::new()
    } else {
        let cells = 0..shared.cells.len();
        cells.filter(|&c| label(c).is_some_and(one_piece)).collect()
    };
    let printed = furniture::find(all, &shared, &asked);
    if !printed.is_empty() {
        let rest: Vec<usize> = letters
            .into_iter()
            .filter(|i| !printed.contains(i))
            .collect();
        shared = share(all, &rest, labels, plan).ok_or_else(blank)?;
        rejected.extend(printed.into_iter().map(|i| (i, Reason::Furniture)));
    }
    let Shared {
        x,
        y,
        mut cells,
        outside,
    } = shared;
    rejected.extend(outside.into_iter().map(|i| (i, Reason::Outside)));
    settle_small_parts(all, &mut cells, &x, &y);
    let mut slots = name(all, cells, labels, plan, &mut rejected)?;
    slots.iter_mut().for_each(|s| s.level = y.begin(s.row));
    Ok(Layer {
        slots,
        rows: plan.rows,
        ruled: is_lined,
        rejected,
        parted: Vec::new(),
        doubtful: Vec::new(),
    })
}

/// Ink shared out to equal cells.
pub(super) struct Shared {
    pub(super) x: Axis,
    pub(super) y: Axis,
    /// The pieces of each cell, row by row.
    pub(super) cells: Vec<Vec<usize>>,
    outside: Vec<usize>,
}

impl Shared {
    /// A cell and those around it.
    pub(super) fn around(&self, cell: usize) -> impl Iterator<Item = usize> {
        neighbours(cell, self.x.count, self.y.count)
    }
}

/// Each piece to the cell in which its centre lies.
fn share(
    all: &[Component],
    letters: &[usize],
    labels: &[Label],
    plan: &Plan<'_>,
) -> Option<Shared> {
    let (x, y) = axes(all, letters, labels, plan)?;
    let mut cells: Vec<Vec<usize>> = vec![Vec::new(); plan.rows * plan.columns];
    let (mut beyond, mut outside) = (Vec::new(), Vec::new());
    for &i in letters {
        let centre = all[i].centre;
        match y.cell(centre.y).zip(x.cell(centre.x)) {
            Some((r, c)) if x.holds(centre.x) && y.holds(centre.y) => {
                cells[r * plan.columns + c].push(i)
            }
            Some((r, c)) => beyond.push((i, r * plan.columns + c)),
            None => outside.push(i),
        }
    }
    // ink beside the grid belongs to the next cell if that holds nothing else or it stands close
    let empty: Vec<bool> = cells.iter().map(Vec::is_empty).collect();
    for (i, cell) in beyond {
        let near =
            |&b: &usize| gap(all[i].upright, all[b].upright) < NEAR * y.pitch.min(x.pitch) / 2.0;
        if empty[cell] || cells[cell].iter().any(near) {
            cells[cell].push(i);
        } else {
            outside.push(i);
        }
    }
    Some(Shared {
        x,
        y,
        cells,
        outside,
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
        long && (thin || (c.area as f64) < LINE_COVER * b.area())
    };
    (0..all.len()).filter(|&i| is_line(&all[i])).collect()
}

/// Columns and rows: of the cells that have names those of all ink, unless more of these cells have a letter in those of the ink that is no
/// dust; of all cells where as many have one then and about as many others do, whose names are missing.
fn axes(
    all: &[Component],
    letters: &[usize],
    labels: &[Label],
    plan: &Plan<'_>,
) -> Option<(Axis, Axis)> {
    let named = labels.iter().enumerate().filter(|(_, l)| l.0 != "_");
    let places: Vec<(usize, usize)> = named.map(|(i, _)| plan.place(i)).collect();
    let fit = |pieces: &[usize], whole: bool| {
        let boxes = || pieces.iter().map(|&i| all[i].upright);
        let across: Vec<_> = boxes().map(|b| (b.x0, b.x1)).collect();
        let down: Vec<_> = boxes().map(|b| (b.y0, b.y1)).collect();
        let range = |of: fn(&(usize, usize)) -> usize| -> Option<Range<usize>> {
            let all = || places.iter().map(of);
            Some(all().min()?..all().max()? + 1)
        };
        let (columns, rows) = if whole {
            (0..plan.columns, 0..plan.rows)
        } else {
            (range(|p| p.1)?, range(|p| p.0)?)
        };
        let x = Axis::fit(&across, plan.columns, columns)?;
        let y = Axis::fit(&down, plan.rows, rows)?;
        Some((x, y))
    };
    let ink: usize = letters.iter().map(|&i| all[i].area).sum();
    let least = COUNTS * ink as f64 / places.len().max(1) as f64;
    let large = letters.iter().copied();
    let large: Vec<usize> = large.filter(|&i| all[i].area as f64 >= least).collect();
    // cells with a letter: those that have names, and others
    let held = |(x, y): &(Axis, Axis)| {
        let cells = large.iter().map(|&i| all[i].centre);
        let cells = cells.filter_map(|p| Some((y.cell(p.y)?, x.cell(p.x)?)));
        let cells: BTreeSet<(usize, usize)> = cells.collect();
        let named = places.iter().filter(|p| cells.contains(p)).count();
        (named, cells.len() - named)
    };
    let ours = fit(letters, false)?;
    let clean = fit(&large, false).filter(|axes| held(axes).0 > held(&ours).0);
    let ours = clean.unwrap_or(ours);
    let whole = fit(letters, true).filter(|axes| {
        let (named, others) = held(axes);
        named >= held(&ours).0 && others >= NAMELESS.max(named / 2)
    });
    Some(whole.unwrap_or(ours))
}

/// Dots and accents near a border of cells go to the letter that is nearer.
fn settle_small_parts(all: &[Component], cells: &mut [Vec<usize>], x: &Axis, y: &Axis) {
    let columns = x.count;
    let body = |cell: &[usize]| cell.iter().copied().max_by_key(|&i| all[i].area);
    let bodies: Vec<Option<usize>> = cells.iter().map(|c| body(c)).collect();
    let mut moves = Vec::new();
    for (from, parts) in cells.iter().enumerate() {
        for &part in parts {
            let c = &all[part];
            let main = bodies[from].map_or(0, |b| all[b].area);
            // the only ink of its cell may be a letter that sits high or low, or a neighbour's dot
            let alone = bodies[from] == Some(part);
            if !alone && c.area as f64 > SMALL * main as f64 {
                continue;
            }
            let others = parts.iter().filter(|&&p| bodies[from] != Some(p));
            let group = if alone {
                vec![part]
            } else {
                group(all, part, others)
            };
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

/// A cell and those around it.
fn neighbours(cell: usize, columns: usize, rows: usize) -> impl Iterator<Item = usize> {
    let (r, c) = (cell / columns, cell % columns);
    let near = |i: usize, n: usize| i.saturating_sub(1)..(i + 2).min(n);
    near(r, rows).flat_map(move |r| near(c, columns).map(move |c| r * columns + c))
}

/// The small parts that belong together with one of them, as two or three dots do: each nearer to another than
/// it is large.
pub(super) fn group<'a>(
    all: &[Component],
    part: usize,
    others: impl Iterator<Item = &'a usize>,
) -> Vec<usize> {
    let size = |i: usize| all[i].upright.width().max(all[i].upright.height());
    let mut left: Vec<usize> = others.copied().filter(|&i| i != part).collect();
    let mut found = vec![part];
    let mut next = 0;
    while let Some(&i) = found.get(next) {
        let with = |j: &usize| gap(all[i].upright, all[*j].upright) < size(i).min(size(*j));
        let (near, far): (Vec<usize>, Vec<usize>) = left.into_iter().partition(with);
        found.extend(near);
        left = far;
        next += 1;
    }
    found
}

/// Gives the cells their labels.
fn name(
    all: &[Component],
    mut cells: Vec<Vec<usize>>,
    labels: &[Label],
    plan: &Plan<'_>,
    rejected: &mut Vec<(usize, Reason)>,
) -> Result<Vec<Slot>, ScanError> {
    let ink = |cell: &[usize]| cell.iter().map(|&i| all[i].area).sum::<usize>();
    let mut usual: Vec<usize> = cells.iter().map(|c| ink(c)).filter(|&a| a > 0).collect();
    usual.sort_unstable();
    let least = COUNTS * usual.get(usual.len() / 2).copied().unwrap_or(0) as f64;
    let mut slots = Vec::new();
    for row in 0..plan.rows {
        for column in 0..plan.columns {
            let parts = std::mem::take(&mut cells[row * plan.columns + column]);
            let Some(index) = plan.index((row, column)) else {
                continue;
            };
            match labels.get(index) {
                Some(label) if label.0 == "_" => {
                    rejected.extend(parts.iter().map(|&i| (i, Reason::Skipped)))
                }
                Some(label) => slots.push(Slot {
                    label: label.clone(),
                    index,
                    row,
                    level: 0.0,
                    parts,
                }),
                None if ink(&parts) as f64 > least => {
                    return Err(ScanError::TooFewNames {
                        source_name: plan.source.to_owned(),
                        row: row + 1,
                        column: column + 1,
                        names: labels.len(),
                    });
                }
                None => rejected.extend(parts.iter().map(|&i| (i, Reason::Dirt))),
            }
        }
    }
    slots.sort_by_key(|s| s.index);
    Ok(slots)
}
