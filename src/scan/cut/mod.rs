//! A clean page → its [`Cell`]s: ink is joined to letters, letters to cells, cells get their guides.
//!
//! Nothing is lost: every piece of ink above the speckle limit is in a cell or in [`Cut::rejected`]. The way of the
//! ink:
//!
//! | room | what happens there |
//! |---|---|
//! | `level` | the coverage from which ink is connected, one at which printed lines hold together |
//! | `sieve` | pieces of ink that may be letters are told from dust, borders and other inks |
//! | `pins` | what a user says of single letters takes its ink first, and stands over all that is found |
//! | `layout` | pieces become letters in reading order: cells of a grid, printed boxes, rows of a bare page |
//! | `marks` | dots in another letter's cell, or smaller than dust may be, come back; dust as large as dots goes |
//! | `guides` | baselines of the rows, and the size of the em |
//! | `stance`, `remarks` | whether letters stand as their names say, and what a user should look at |
//! | `window` | each letter's own picture, upright; holes in its ink that are no counters are filled (`holes`) |

mod askew;
mod guides;
mod holes;
mod layout;
mod level;
mod marks;
mod pins;
mod remarks;
mod sieve;
mod stance;
mod window;

pub use pins::{Pin, Region};
pub(crate) use remarks::{SMALL_LETTER, SMALL_SHARE, is_full};

use super::bent;
use super::clean::Page;
use super::components::{Component, gap};
use super::deskew::{self, Edges};
use super::error::{Fault, ScanError};
use super::letters::Shape;
use super::options::Options;
use super::perspective::{Rows, Scene, Told};
use super::separation::{Colour, Separation};
use crate::numeric::view::View;
use crate::types::{Cell, Label};
use kurbo::{Affine, Point, Rect};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sieve::{Sieved, sort, speck_limit, stroke_width, telling};
use stance::Stance;
use std::fmt;

/// Ink beside a letter of one piece that is smaller than a square of this many stroke widths is dust.
const DUST: f64 = 0.85;
/// Skews below this, degrees, are left alone: over a page they move a letter by a hair.
const LEAST_SKEW_DEG: f64 = 0.01;
/// Times that a page is cut again whose rows tell anew how it lies.
const TURNS: usize = 2;

/// What a page was cut into.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Cut {
    /// The letters in reading order; a named cell without ink is left out and warned of.
    #[serde(skip)]
    pub cells: Vec<Cell>,
    /// Ink that is in no cell.
    pub rejected: Vec<Rejected>,
    /// What a user should look at.
    pub warnings: Vec<Warning>,
    /// Degrees by which the page lay turned clockwise.
    pub skew_deg: f64,
    /// From px of the sheet's picture to px of the upright page; at the picture's middle, where it was seen in
    /// perspective or bent.
    pub upright: Affine,
    /// Pieces of ink below the speckle limit, which are in no list.
    pub specks: usize,
    /// The inks of the layers, the lowest first; none where letters have no layers.
    pub colours: Vec<Colour>,
    /// How badly the letters stand for what their names say, 0 to 1; above a third the page may lie on its side or
    /// head. `None` where the names say too little, or have said it.
    #[serde(skip)]
    pub misfit: Option<f64>,
}

/// A piece of ink that is in no cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
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
    /// The edge of the scan: it touches the picture's border and is far larger than a letter, or thinner than a stroke.
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
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
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

impl Rejected {
    fn of(c: &Component, reason: Reason) -> Self {
        Self {
            in_sheet: c.bounds,
            area_px: c.area,
            reason,
        }
    }
}

impl Warning {
    /// About a page as a whole.
    #[must_use]
    pub fn of_page(message: impl Into<String>) -> Self {
        Self {
            index: None,
            label: None,
            message: message.into(),
        }
    }

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
    /// What its label tells of its letter.
    shape: Shape,
    /// Position in reading order.
    index: usize,
    /// Row of letters that share a baseline.
    row: usize,
    /// A height from which the baseline is equally far in all cells of a row, upright px, where rows are ruled or
    /// even.
    level: f64,
    /// Indices of its pieces of ink.
    parts: Vec<usize>,
}

/// What the heights of slots are worth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Levels {
    /// They are those of printed lines or boxes.
    Printed,
    /// Rows are even, since printed lines guided the hand, up to a drift along the page.
    Even,
    /// No line guided the hand.
    Loose,
}

/// What a layout found: slots in reading order, how many rows, and the rest.
struct Layer {
    slots: Vec<Slot>,
    rows: usize,
    levels: Levels,
    /// Pieces of ink in no slot.
    rejected: Vec<(usize, Reason)>,
    /// Pieces of ink that were cut off letters beside them.
    parted: Vec<usize>,
    /// Positions in reading order of letters that may be others.
    doubtful: Vec<usize>,
}

/// Cuts a clean page into cells: `labels` in reading order, `_` for a cell to be skipped; a user says the places of
/// the cells that have `pins`.
///
/// # Errors
/// The layout does not hold the labels, ink has no label, or the em cannot be measured.
pub fn cut(
    page: &Page,
    labels: &[Label],
    options: &Options,
    pins: &[Pin],
) -> Result<Cut, ScanError> {
    let cut = |told| cut_page(page, labels, options, pins, told);
    let (mut best, mut told) =
        cut(None).map_err(|fault| fault.of(&page.sheet.source, page.sheet.guessed))?;
    for _ in 0..TURNS {
        let Some(Ok(next)) = told.map(|t| cut(Some(t))) else {
            break;
        };
        (best, told) = next;
    }
    Ok(best)
}

/// Cuts a page that lies as its ink tells, or as was told; with what its rows tell anew.
fn cut_page(
    page: &Page,
    labels: &[Label],
    options: &Options,
    pins: &[Pin],
    told: Option<Told>,
) -> Result<(Cut, Option<Told>), Fault> {
    let gray = &page.sheet.gray;
    let (low, ink) = level::pieces(gray, page.noise);
    let Sieved {
        letters: mut all,
        rejected: beside,
        mut small,
        specks,
    } = sort(ink, page, options)?;
    let separation = Separation::measure(&page.sheet, &all, &options.ink, speck_limit(&all))?;
    let telling = telling(&all, page);
    let middle = Point::new(gray.width() as f64 / 2.0, gray.height() as f64 / 2.0);
    let (skew_deg, flat) = seen(page, &telling, middle, options, told);
    let upright = bent::upright(page, flat);
    let claims = pins::claim(&mut all, pins);
    all.par_iter_mut().for_each(|c| c.stand(&upright));
    pins::stand(&mut all, &claims, pins, &upright);

    let whole = all.len();
    let task = layout::Task {
        page,
        low,
        upright: &upright,
        options,
        claims: &claims,
        separation: separation.as_ref(),
    };
    let mut layer = layout::place(&mut all, labels, &task)?;
    pins::settle(&mut layer, &claims);
    let stroke = stroke_width(&all);
    marks::reclaim(&mut layer, &all);
    marks::restore(&mut layer, &all, &claims);
    let freed = whole..all.len();
    small.iter_mut().for_each(|c| c.stand(&upright));
    let specks = specks - marks::give(&mut layer, &mut all, small, sieve::dot_limit(stroke));
    let is_drawn = |c: &Component| task.is_hued(c);
    marks::dust(&mut layer, &all, &claims, (DUST * stroke).powi(2), is_drawn);
    let view = |slot: &Slot| pins::stance(slot.index, pins, &upright).0;
    let guides = guides::measure(&mut layer, &all, page, options, view)?;
    let stance = Stance::of(&layer, &all, &guides.drop);
    let mut warnings = guides.warnings;
    warnings.extend(remarks::of_picture(page, options));
    warnings.extend(stance.shifted(labels));
    warnings.extend(remarks::warnings(&layer, &all, gray, freed, &guides.drop));
    let shutter = window::Shutter {
        page,
        low,
        stroke,
        separation: separation.as_ref(),
    };
    let inked = layer.slots.par_iter().filter(|s| !s.parts.is_empty());
    let cells = inked.map(|slot| {
        let parts: Vec<&Component> = slot.parts.iter().map(|&i| &all[i]).collect();
        shutter.cell(
            slot,
            &parts,
            (slot.level + guides.drop[slot.row], guides.px_per_em),
            pins::stance(slot.index, pins, &upright),
        )
    });
    let cells: Vec<Cell> = cells.collect();
    let rest = (layer.rejected.iter()).map(|&(i, reason)| Rejected::of(&all[i], reason));
    let rejected = rest.chain(beside).collect();
    warnings.sort_by_key(|w| w.index);
    let cut = Cut {
        cells,
        rejected,
        warnings,
        skew_deg,
        upright: upright.affine().unwrap_or_else(|| upright.near(middle)),
        specks,
        colours: separation.map_or_else(Vec::new, |s| s.colours()),
        misfit: stance.misfit(),
    };
    let rows = guides.apart.as_deref();
    let told = rows.and_then(|rows| Told::by(rows, &flat, middle));
    Ok((cut, told))
}

/// Degrees by which a page lies turned clockwise, by ink that tells or as was told, and how it was seen.
fn seen(
    page: &Page,
    telling: &[&Component],
    middle: Point,
    options: &Options,
    told: Option<Told>,
) -> (f64, View) {
    let edges = Edges::new(telling, page.sheet.gray.height());
    let turn_deg = told.map_or_else(|| deskew::skew_deg(&edges), |t| t.skew_deg);
    let worth_it = turn_deg.abs() >= LEAST_SKEW_DEG;
    let scene = Scene {
        ink: telling,
        edges: &edges,
        middle,
        skew_deg: if worth_it { turn_deg } else { 0.0 },
        rows: told.map_or(Rows::Together, |t| t.rows),
        layout: options.layout,
        paper: page.paper.as_ref(),
    };
    (scene.skew_deg, scene.view())
}

/// The largest of some pieces of ink.
fn largest(all: &[Component], parts: &[usize]) -> Option<usize> {
    parts.iter().copied().max_by_key(|&i| all[i].area)
}

/// The box around some pieces of ink, upright px.
fn bounds(all: &[Component], parts: &[usize]) -> Option<Rect> {
    let boxes = parts.iter().map(|&i| all[i].upright);
    boxes.reduce(|a, b| a.union(b))
}

#[cfg(test)]
mod tests;
