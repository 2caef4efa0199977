//! Pages and the cells that are cut from them.

use super::Gray;
use kurbo::{Affine, Rect};
use serde::{Deserialize, Serialize};

/// Millimetres an inch.
pub(crate) const MM_PER_INCH: f64 = 25.4;

/// A scanned page.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// Ink coverage, px, y down.
    pub gray: Gray,
    /// Which light it swallows, of a picture in colours.
    pub colours: Option<Colours>,
    /// Resolution, dots an inch, where the file says so.
    pub dpi: Option<f64>,
    /// The ink's shade in the picture, where it was guessed and the picture leaves doubt.
    pub guessed: Option<Shade>,
    /// The file it came from, as messages name it.
    pub source: String,
}

/// The side from which a row is read.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Direction {
    /// Left to right.
    #[default]
    Ltr,
    /// Right to left.
    Rtl,
}

/// Whether ink is darker or lighter than its paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shade {
    /// Darker.
    Dark,
    /// Lighter.
    Light,
}

/// Shares of red, green and blue light that the square blocks of a picture swallow, row by row, 255 for all of it.
/// A picture's colours are seldom finer than this: cameras and files reduce them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Colours {
    /// Side of a block, px.
    pub block: usize,
    /// Blocks in a row.
    pub columns: usize,
    /// A value a block.
    pub swallowed: Vec<[u8; 3]>,
}

impl Colours {
    /// The block around the pixel in column `x` of row `y`; nothing swallowed outside the picture.
    #[must_use]
    pub fn at(&self, x: usize, y: usize) -> [u8; 3] {
        let (column, row) = (x / self.block.max(1), y / self.block.max(1));
        let here = (column < self.columns).then(|| self.swallowed.get(row * self.columns + column));
        here.flatten().copied().unwrap_or_default()
    }
}

/// The glyph name or character that a cell is said to hold, as the user wrote it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Label(pub String);

/// Heights that the page, never the cell's own ink, gives a cell.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Guides {
    /// The baseline, px below the cell's top edge.
    pub baseline_px: f64,
    /// Pixels an em.
    pub px_per_em: f64,
    /// The row of cells whose letters together gave the baseline, where no print did.
    pub row: Option<usize>,
}

/// A letter's ink of one colour.
#[derive(Debug, Clone)]
pub struct Plate {
    /// The ink, as the project file names it.
    pub ink: String,
    /// Coverage by this ink in the cell; it runs on by a hair under the plates above.
    pub gray: Gray,
}

/// One letter of a page: the ink that belongs to it and nothing else.
#[derive(Debug, Clone)]
pub struct Cell {
    /// What it is said to hold.
    pub label: Label,
    /// Position in reading order, from 0.
    pub index: usize,
    /// Coverage inside the cell; other cells' ink, printed lines and dust are paper here.
    pub gray: Gray,
    /// The coverage by each ink, the lowest first, where inks are to become layers; empty elsewhere.
    pub plates: Vec<Plate>,
    /// The ink's rectangle in the sheet's picture, px, y down, inside the picture.
    pub in_sheet: Rect,
    /// From cell px (y down) to px of the sheet's picture.
    pub to_sheet: Affine,
    /// Baseline and scale.
    pub guides: Guides,
}
