//! What a user says about a page.

use super::Inks;
use crate::types::Direction;
use serde::{Deserialize, Serialize};

/// How the cells lie on the page.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Layout {
    /// Equal cells in rows and columns, with or without printed lines between them.
    Grid(usize, usize),
    /// Letters in rows on a bare page.
    #[default]
    Free,
    /// Printed boxes, each around one letter.
    Boxes,
}

/// Whether neighbours in reading order stand beside or below each other.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Order {
    /// Row after row.
    #[default]
    Rows,
    /// Column after column.
    Columns,
}

/// Where the size of an em comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Scale {
    /// Pixels an em.
    PixelsPerEm(f64),
    /// Millimetres an em on paper; the picture must say its resolution.
    EmMm(f64),
    /// The height of x, as a share of the em.
    XHeight(f64),
    /// The height of H, as a share of the em.
    CapHeight(f64),
    /// From the highest ink above its baseline to the lowest below, as a share of the em.
    AscenderToDescender(f64),
}

/// How a page is cut.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    /// How the cells lie.
    pub layout: Layout,
    /// The side from which a row is read.
    pub direction: Direction,
    /// Rows or columns first.
    pub order: Order,
    /// The inks of the letters; ink of other colours is in no cell.
    pub ink: Inks,
    /// The size of an em; measured from the letters' usual heights where it is not given.
    pub scale: Option<Scale>,
    /// How many names stand in each line of their list; nothing where they were not written in lines.
    pub lines: Vec<usize>,
}
