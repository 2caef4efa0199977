//! Ink shared out to the equal cells of a grid.

use super::axis::Axis;
use super::plan::Plan;
use crate::numeric::pieces;
use crate::scan::components::Component;
use crate::scan::cut::gap;
use crate::scan::cut::layout::named::COUNTS;
use crate::types::Label;
use std::collections::BTreeSet;
use std::ops::Range;

/// Small parts this near to a border of cells, as a share of the pitch, go to the nearer letter.
pub(super) const NEAR: f64 = 0.2;
/// Ink from this share of a usual letter's on is not dust beside the grid, not even where letters are small and dust
/// is large.
const LARGE: f64 = 0.3;
/// A usual letter is at most so many times as large as its largest piece.
const WHOLE: f64 = 2.0;
/// Letters without names at least that tell of a row or a column whose names are missing.
const NAMELESS: usize = 2;

/// Ink shared out to equal cells.
#[derive(Clone)]
pub(super) struct Shared {
    pub(super) x: Axis,
    pub(super) y: Axis,
    /// The rows are those between printed lines.
    pub(super) is_printed: bool,
    /// The pieces of each cell, row by row.
    pub(super) cells: Vec<Vec<usize>>,
    /// Those beside all of them.
    pub(super) outside: Vec<usize>,
}

impl Shared {
    /// A cell and those around it.
    pub(super) fn around(&self, cell: usize) -> impl Iterator<Item = usize> {
        neighbours(cell, self.x.count, self.y.count)
    }
}

/// Each piece to the cell in which its centre lies.
pub(super) fn share(
    all: &[Component],
    letters: &[usize],
    labels: &[Label],
    plan: &Plan<'_>,
) -> Option<Shared> {
    let (x, y) = axes(all, letters, labels, plan)?;
    // letters may all stand to one side in their cells, but a row's line is equally far from that of its cells
    let printed = y.between(&plan.printed);
    let (is_printed, y) = (printed.is_some(), printed.unwrap_or(y));
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
        is_printed,
        cells,
        outside,
    })
}

/// Columns and rows: of the cells that have names those of all ink, unless more of these cells have a letter in those
/// of the ink that is no dust, or no small letter; of all cells where as many have one then and about as many others
/// do, whose names are missing.
fn axes(
    all: &[Component],
    letters: &[usize],
    labels: &[Label],
    plan: &Plan<'_>,
) -> Option<(Axis, Axis)> {
    let named = labels.iter().enumerate().filter(|(_, l)| l.0 != "_");
    let places: Vec<(usize, usize)> = named.map(|(i, _)| plan.place(i)).collect();
    let range = |of: fn(&(usize, usize)) -> usize| -> Option<Range<usize>> {
        let all = || places.iter().map(of);
        Some(all().min()?..all().max()? + 1)
    };
    let extent = (range(|p| p.1)?, range(|p| p.0)?);
    let fit = |pieces: &[usize], (columns, rows): (Range<usize>, Range<usize>)| {
        let boxes = || pieces.iter().map(|&i| all[i].upright);
        let across: Vec<_> = boxes().map(|b| (b.x0, b.x1)).collect();
        let down: Vec<_> = boxes().map(|b| (b.y0, b.y1)).collect();
        let x = Axis::fit(&across, plan.columns, columns)?;
        let y = Axis::fit(&down, plan.rows, rows)?;
        Some((x, y))
    };
    let usual = usual(
        letters.iter().map(|&i| all[i].area).collect(),
        places.len().max(1),
    );
    let above = |share: f64| -> Vec<usize> {
        let pieces = letters.iter().copied();
        let above = pieces.filter(|&i| all[i].area as f64 >= share * usual);
        above.collect()
    };
    let large = above(COUNTS);
    // cells with a letter: those that have names, and others
    let held = |(x, y): &(Axis, Axis)| {
        let cells = large.iter().map(|&i| all[i].centre);
        let cells = cells.filter_map(|p| Some((y.cell(p.y)?, x.cell(p.x)?)));
        let cells: BTreeSet<(usize, usize)> = cells.collect();
        let named = places.iter().filter(|p| cells.contains(p)).count();
        (named, cells.len() - named)
    };
    let mut ours = fit(letters, extent.clone())?;
    for clean in [COUNTS, LARGE].map(above) {
        let clean = fit(&clean, extent.clone()).filter(|axes| held(axes).0 > held(&ours).0);
        ours = clean.unwrap_or(ours);
    }
    let whole = fit(letters, (0..plan.columns, 0..plan.rows)).filter(|axes| {
        let (named, others) = held(axes);
        named >= held(&ours).0 && others >= NAMELESS.max(named / 2)
    });
    Some(whole.unwrap_or(ours))
}

/// The area of a usual letter among pieces of these areas: an even share of all ink, but no more than the middle one
/// of the largest pieces says, a piece a letter, since many letters may have no names.
fn usual(mut areas: Vec<usize>, letters: usize) -> f64 {
    let even = areas.iter().sum::<usize>() as f64 / letters as f64;
    areas.sort_unstable_by(|a, b| b.cmp(a));
    let middle = areas.get(letters.min(areas.len()) / 2);
    even.min(middle.map_or(0.0, |&m| WHOLE * m as f64))
}

/// A cell and those around it.
pub(super) fn neighbours(cell: usize, columns: usize, rows: usize) -> impl Iterator<Item = usize> {
    pieces::around((cell % columns, cell / columns), 1, (columns, rows))
}
