//! A clean page → its [`Cell`]s: ink is joined to letters, letters to cells, cells get their guides.
//!
//! Nothing is lost: every piece of ink above the speckle limit is in a cell or in [`Cut::rejected`].

mod baselines;
mod boxes;
mod doubts;
mod ends;
mod free;
mod grid;
mod guides;
mod hanging;
mod hidden;
mod joins;
mod lines;
mod listed;
mod marks;
mod named;
mod nearest;
mod odd;
mod order;
mod pieces;
mod pins;
mod reading;
mod rows;
mod ruling;
mod seam;
mod signs;
mod small;
mod stance;
mod strays;
mod touching;
mod votes;
mod window;

use super::clean::Page;
use super::components::{Component, Run, components};
use super::deskew::{Edges, skew_deg};
use super::error::ScanError;
use super::options::{Direction, Layout, Options, Order};
use super::perspective::Scene;
use super::separation::{Colour, Separation};
use crate::numeric::view::View;
use crate::types::{Cell, Label};
use kurbo::{Affine, Point, Rect};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fmt;

use stance::Stance;

pub use odd::{SMALL, SMALL_LETTER, is_full};
pub use pins::{Pin, Region};

/// Coverage from which connected ink counts: below the half level, so that thin strokes hold together,
/// and above printed guides in a light colour.
const LOW: f32 = 0.33;
/// Coverage that a piece of ink must reach somewhere.
const SEED: f32 = 0.5;
/// Standard deviations of noise that both levels keep from the paper.
const NOISE: f32 = 6.0;
/// Ink smaller than a square of this many stroke widths is a speck: the dot of a letter is a disc of at least one
/// stroke (0.89 of its side as a square), and loses a little to the threshold.
const SPECK: f64 = 0.7;
/// The same for what lies beside a letter of one piece.
const DUST: f64 = 0.85;
/// Ink smaller than a square of this many stroke widths is no dot of any style: those of `DejaVu Sans Bold`, the smallest of
/// a hundred fonts, have 0.52.
const DOT: f64 = 0.4;
/// A printed line or lattice: its length at least and its thickness at most, as shares of the longer side of all ink, and the
/// share of its box that it covers at most.
const LINE: (f64, f64, f64) = (0.5, 0.02, 0.12);
/// Share of a piece of ink that lies on the page at least.
const ON_PAPER: f64 = 0.8;
/// Skews below this, degrees, are left alone: over a page they move a letter by a hair.
const LEAST_SKEW_DEG: f64 = 0.01;

/// What a page was cut into.
#[derive(Debug, Clone)]
pub struct Cut {
    /// The letters in reading order; a named cell without ink is left out and warned of.
    pub cells: Vec<Cell>,
    /// Ink that is in no cell.
    pub rejected: Vec<Rejected>,
    /// What a user should look at.
    pub warnings: Vec<Warning>,
    /// Degrees by which the page lay turned clockwise.
    pub skew_deg: f64,
    /// From px of the sheet's picture to px of the upright page; at the picture's middle, where it was seen in
    /// perspective.
    pub upright: Affine,
    /// Pieces of ink below the speckle limit, which are in no list.
    pub specks: usize,
    /// The inks of the layers, the lowest first; none where letters have no layers.
    pub colours: Vec<Colour>,
    /// How badly the letters stand for what their names say, 0 to 1; above a third the page may lie on its side or
    /// head. `None` where the names say too little.
    pub misfit: Option<f64>,
}

/// A piece of ink that is in no cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rejected {
    /// Its rectangle in the sheet's picture, px.
    pub in_sheet: Rect,
    /// px².
    pub area_px: usize,
    /// Why.
    pub reason: Reason,
}

/// Why ink is in no cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Reason {
    /// A printed line.
    Line,
    /// Too little ink for a letter, and no name is left for it.
    Dirt,
    /// It lies outside all cells.
    Outside,
    /// Its cell is marked to be skipped.
    Skipped,
    /// The edge of the scan: it touches the picture's border and is far larger than a letter.
    Border,
    /// It is of another colour than the letters' ink.
    OtherInk,
    /// It lies beside the paper in a picture that shows more than the page.
    OffPage,
    /// A user said that its cell's ink lies elsewhere.
    Overridden,
    /// A label or a guide: its strokes are far thinner than the letters'.
    Thin,
    /// A mark or a label: nearly every cell has one at this place.
    Furniture,
}

/// Something a user should look at.
#[derive(Debug, Clone, PartialEq)]
pub struct Warning {
    /// Position in reading order, where it is about one cell.
    pub index: Option<usize>,
    /// What the cell is said to hold.
    pub label: Option<Label>,
    /// What is odd and what to do.
    pub message: String,
}

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Line => "line",
            Self::Dirt => "dirt",
            Self::Outside => "outside",
            Self::Skipped => "skipped",
            Self::OtherInk => "other ink",
            Self::OffPage => "off the page",
            Self::Thin => "thin",
            Self::Furniture => "in every cell",
            Self::Overridden => "overridden",
            Self::Border => "border",
        })
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(index) = self.index {
            write!(f, "cell {}", index + 1)?;
            self.label
                .iter()
                .try_for_each(|l| write!(f, " “{}”", l.0))?;
            f.write_str(": ")?;
        }
        f.write_str(&self.message)
    }
}

impl Warning {
    fn of(slot: &Slot, message: impl Into<String>) -> Self {
        Self {
            index: Some(slot.index),
            label: Some(slot.label.clone()),
            message: message.into(),
        }
    }
}

/// A cell while its ink is being gathered.
#[derive(Debug, Clone)]
struct Slot {
    label: Label,
    /// Position in reading order.
    index: usize,
    /// Row of letters that share a baseline.
    row: usize,
    /// A height from which the baseline is equally far in all cells of a row, upright px, where rows are ruled or even.
    level: f64,
    /// Indices of its pieces of ink.
    parts: Vec<usize>,
}

/// What a layout found: slots in reading order, how many rows, and the rest.
struct Layer {
    slots: Vec<Slot>,
    rows: usize,
    /// Lines or boxes that are printed on the page say where its rows are.
    ruled: bool,
    /// Pieces of ink in no slot.
    rejected: Vec<(usize, Reason)>,
    /// Pieces of ink that were cut off letters beside them.
    parted: Vec<usize>,
    /// Positions in reading order of letters that may be others.
    doubtful: Vec<usize>,
}

/// Cuts a clean page into cells: `labels` in reading order, `_` for a cell to be skipped.
///
/// # Errors
/// The layout does not hold the labels, ink has no label, or the em cannot be measured.
pub fn cut(page: &Page, labels: &[Label], options: &Options) -> Result<Cut, ScanError> {
    cut_with(page, labels, options, &[])
}

/// The same where a user says the places of some cells.
///
/// # Errors
/// As of [`cut`].
pub fn cut_with(
    page: &Page,
    labels: &[Label],
    options: &Options,
    pins: &[Pin],
) -> Result<Cut, ScanError> {
    let gray = &page.sheet.gray;
    let low = LOW.max(NOISE * page.noise);
    let Inks {
        letters: mut all,
        rejected: beside,
        mut small,
        specks,
    } = sort(components(gray, low, SEED.max(low)), page, options)?;
    let separation = Separation::measure(&page.sheet, &all, &options.ink, speck_limit(&all));
    let separation = separation.map_err(|ink| other_ink(page, ink))?;
    let edges = Edges::new(&all.iter().collect::<Vec<_>>());
    let skew_deg = Some(skew_deg(&edges)).filter(|s| s.abs() >= LEAST_SKEW_DEG);
    let skew_deg = skew_deg.unwrap_or(0.0);
    let middle = Point::new(gray.width() as f64 / 2.0, gray.height() as f64 / 2.0);
    let upright = Scene {
        ink: &all,
        edges: &edges,
        middle,
        skew_deg,
        layout: options.layout,
        paper: page.paper.as_ref(),
    }
    .view();
    let claims = pins::claim(&mut all, pins);
    all.par_iter_mut().for_each(|c| c.stand(&upright));
    pins::stand(&mut all, &claims, pins, &upright);

    let whole = all.len();
    let mut layer = placed(&mut all, labels, (page, low, upright), options, &claims)?;
    pins::settle(&mut layer, &claims);
    let dot = (DUST * stroke_width(&all)).powi(2);
    marks::reclaim(&mut layer, &all);
    let freed = whole..all.len();
    small.iter_mut().for_each(|c| c.stand(&upright));
    let specks = specks - marks::give(&mut layer, &mut all, &small);
    marks::dust(&mut layer, &all, &claims, dot);
    let seen = |slot: &Slot| pins::stance(slot.index, pins, &upright).0;
    let guides = guides::measure(&layer, &all, page, options, seen)?;
    let stance = Stance::of(&layer, &all, &guides.drop);
    let mut warnings = guides.warnings;
    warnings.extend(colourless(page, options));
    warnings.extend(stance.shifted(labels));
    let inked: Vec<&Slot> = layer.slots.iter().filter(|s| !s.parts.is_empty()).collect();
    let picture = Rect::new(0.0, 0.0, gray.width() as f64, gray.height() as f64);
    let is_freed = |i: usize| freed.contains(&i) && !layer.parted.contains(&i);
    warnings.extend(odd::warnings(&inked, &all, picture, is_freed));
    warnings.extend(doubts::warnings(&inked, &layer));
    let baseline = |s: &Slot| s.level + guides.drop[s.row];
    warnings.extend(odd::across(&inked, &all, baseline));
    let empty = layer.slots.iter().filter(|s| s.parts.is_empty());
    warnings
        .extend(empty.map(|s| Warning::of(s, "the cell is empty: draw the letter or name it _")));
    let shutter = window::Shutter {
        page,
        low,
        separation: separation.as_ref(),
    };
    let cells = inked.par_iter().map(|slot| {
        let parts: Vec<&Component> = slot.parts.iter().map(|&i| &all[i]).collect();
        shutter.cell(
            slot,
            &parts,
            (baseline(slot), guides.px_per_em),
            pins::stance(slot.index, pins, &upright),
        )
    });
    let cells: Vec<Cell> = cells.collect();
    let rest = layer.rejected.iter();
    let rest = rest.map(|&(i, reason)| rejected(&all[i], reason));
    let rejected = rest.chain(beside).collect();
    warnings.sort_by_key(|w| w.index);
    Ok(Cut {
        cells,
        rejected,
        warnings,
        skew_deg,
        upright: upright.affine().unwrap_or_else(|| upright.near(middle)),
        specks,
        colours: separation.map_or_else(Vec::new, |s| s.colours()),
        misfit: stance.misfit(),
    })
}

/// Where the layout puts the pieces of a page that is seen as `upright` says.
fn placed(
    all: &mut Vec<Component>,
    labels: &[Label],
    (page, low, upright): (&Page, f32, View),
    options: &Options,
    claims: &[(usize, Vec<usize>)],
) -> Result<Layer, ScanError> {
    let source = page.sheet.source.as_str();
    if !labels.is_empty() && labels.iter().all(|l| l.0 == "_") {
        return Err(ScanError::NoNames {
            source_name: source.to_owned(),
        });
    }
    match options.layout {
        Layout::Grid(rows, columns) => {
            let plan = grid::Plan::new(page, options, (rows, columns), (upright, claims))?;
            grid::place(all, labels, &plan)
        }
        Layout::Free => {
            let plan = free::Plan {
                upright,
                claims,
                options,
                source,
            };
            free::place(all, labels, &plan)
        }
        Layout::Boxes => {
            let plan = boxes::Plan {
                gray: &page.sheet.gray,
                low,
                upright,
                options,
                source,
            };
            boxes::place(all, labels, &plan)
        }
    }
}

fn rejected(c: &Component, reason: Reason) -> Rejected {
    Rejected {
        in_sheet: c.bounds,
        area_px: c.area,
        reason,
    }
}

/// A page's ink.
struct Inks {
    /// What may be letters.
    letters: Vec<Component>,
    /// What cannot.
    rejected: Vec<Rejected>,
    /// What may be dots of heavy letters.
    small: Vec<Component>,
    /// Pieces too small to be either.
    specks: usize,
}

/// Parts the letters' ink from dust, from what lies beside the paper or runs along its edge, and from other inks.
fn sort(all: Vec<Component>, page: &Page, options: &Options) -> Result<Inks, ScanError> {
    let gray = &page.sheet.gray;
    let (found, mut beyond): (Vec<_>, Vec<_>) = all.into_iter().partition(|c| on_paper(c, page));
    let (mut letters, mut other) = options.ink.part(found, page.sheet.colours.as_ref());
    if letters.is_empty() && !other.is_empty() {
        return Err(other_ink(page, options.ink.to_string()));
    }
    let least = speck_limit(&letters);
    let mut specks = 0;
    let mut take = |pieces: &mut Vec<Component>| -> Vec<Component> {
        let (large, small) = pieces.drain(..).partition(|c| c.area as f64 >= least);
        *pieces = large;
        specks += small.len();
        small
    };
    let mut small = take(&mut letters);
    small.retain(|c| c.area as f64 >= least * (DOT / SPECK).powi(2));
    take(&mut other);
    take(&mut beyond);
    let borders = take_borders(&mut letters, gray.width(), gray.height());
    let borders = borders.iter().map(|c| rejected(c, Reason::Border));
    let other = other.iter().map(|c| rejected(c, Reason::OtherInk));
    let beyond = beyond.iter().map(|c| rejected(c, Reason::OffPage));
    Ok(Inks {
        rejected: borders.chain(other).chain(beyond).collect(),
        letters,
        small,
        specks,
    })
}

fn other_ink(page: &Page, ink: String) -> ScanError {
    ScanError::OtherInk {
        source_name: page.sheet.source.clone(),
        ink,
    }
}

/// A remark where inks are to be told apart in a picture without colours.
fn colourless(page: &Page, options: &Options) -> Option<Warning> {
    let useless = options.ink.choose() && page.sheet.colours.is_none();
    useless.then(|| Warning {
        index: None,
        label: None,
        message: "the picture has no colours, so `ink` tells nothing apart; scan it in colour, or leave `ink` out"
            .to_owned(),
    })
}

/// Whether most of a piece of ink lies on the paper.
fn on_paper(c: &Component, page: &Page) -> bool {
    let Some(paper) = &page.paper else {
        return true;
    };
    let on = |r: &Run| (r.start..r.end).filter(|&x| paper.holds(x, r.y)).count();
    let inside: usize = c.runs.iter().map(on).sum();
    inside as f64 >= ON_PAPER * c.area as f64
}

/// Area of the smallest piece of ink that may be a dot, px².
fn speck_limit(all: &[Component]) -> f64 {
    (SPECK * stroke_width(all)).powi(2).max(2.0)
}

/// The page's usual stroke width, px: the median over the ink, each piece by its area. Printed lines can have more ink than
/// all letters, so what is long for the page and hollow or thin does not count.
fn stroke_width(all: &[Component]) -> f64 {
    let page = all.iter().map(|c| c.bounds).reduce(|a, b| a.union(b));
    let side = page.map_or(0.0, |p| p.width().max(p.height()));
    let is_line = |c: &Component| {
        let (long, short) = (
            c.bounds.width().max(c.bounds.height()),
            c.bounds.width().min(c.bounds.height()),
        );
        long > LINE.0 * side && (short < LINE.1 * side || (c.area as f64) < LINE.2 * long * short)
    };
    let letters = all.iter().filter(|c| !is_line(c));
    let mut widths: Vec<(f64, usize)> = letters.map(|c| (c.stroke(), c.area)).collect();
    widths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = widths.iter().map(|w| w.1).sum::<usize>() / 2;
    let mut sum = 0;
    let middle = widths.iter().find(|w| {
        sum += w.1;
        sum > half
    });
    middle.map_or(1.0, |w| w.0)
}

/// Distance of two boxes, px.
fn gap(a: Rect, b: Rect) -> f64 {
    let dx = (a.x0 - b.x1).max(b.x0 - a.x1).max(0.0);
    let dy = (a.y0 - b.y1).max(b.y0 - a.y1).max(0.0);
    dx.hypot(dy)
}

/// Takes out ink that touches the picture's border and reaches along half of a side.
fn take_borders(all: &mut Vec<Component>, width: usize, height: usize) -> Vec<Component> {
    let (w, h) = (width as f64, height as f64);
    let at_edge = |c: &Component| {
        c.bounds.x0 <= 0.0 || c.bounds.y0 <= 0.0 || c.bounds.x1 >= w || c.bounds.y1 >= h
    };
    let long = |c: &Component| c.bounds.width() > w / 2.0 || c.bounds.height() > h / 2.0;
    let (out, kept) = std::mem::take(all)
        .into_iter()
        .partition(|c| at_edge(c) && long(c));
    *all = kept;
    out
}

/// Row and column of a cell from its position in reading order.
fn position(index: usize, (rows, columns): (usize, usize), options: &Options) -> (usize, usize) {
    let (row, column) = match options.order {
        Order::Rows => (index / columns, index % columns),
        Order::Columns => (index % rows, index / rows),
    };
    match options.direction {
        Direction::Ltr => (row, column),
        Direction::Rtl => (row, columns.saturating_sub(column + 1)),
    }
}

#[cfg(test)]
mod tests;
