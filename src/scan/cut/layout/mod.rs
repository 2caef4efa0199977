//! Pieces of ink → letters in reading order, as the layout says: cells of a grid, printed boxes, or rows of a bare
//! page.

mod boxes;
mod frames;
mod free;
mod grid;
mod listed;
mod named;
mod rows;
mod ruling;
mod touching;

use super::Layer;
use crate::numeric::surface::Surface;
use crate::scan::clean::Page;
use crate::scan::components::Component;
use crate::scan::error::Fault;
use crate::scan::options::{Layout, Options};
use crate::scan::separation::Separation;
use crate::types::{Gray, Label};

/// A page to be laid out, and how.
pub(super) struct Task<'a> {
    pub(super) page: &'a Page,
    /// Coverage from which pixels are ink.
    pub(super) low: f32,
    pub(super) upright: &'a Surface,
    pub(super) options: &'a Options,
    /// The letters whose places a user says, and their ink.
    pub(super) claims: &'a [(usize, Vec<usize>)],
    /// What tells the inks apart that become layers.
    pub(super) separation: Option<&'a Separation<'a>>,
}

impl<'a> Task<'a> {
    const fn gray(&self) -> &'a Gray {
        &self.page.sheet.gray
    }

    /// Whether a piece is of an ink with a hue that becomes a layer: none is dust, nor print.
    pub(super) fn is_hued(&self, piece: &Component) -> bool {
        self.separation.is_some_and(|s| s.is_hued(piece))
    }
}

/// Where the layout puts the pieces of a page.
pub(super) fn place(
    all: &mut Vec<Component>,
    labels: &[Label],
    task: &Task<'_>,
) -> Result<Layer, Fault> {
    if !labels.is_empty() && labels.iter().all(|l| l.0 == "_") {
        return Err(Fault::NoNames);
    }
    match task.options.layout {
        Layout::Grid(rows, columns) => {
            grid::place(all, labels, &grid::Plan::new(task, rows, columns)?)
        }
        Layout::Free => free::place(all, labels, task),
        Layout::Boxes => boxes::place(all, labels, task),
    }
}
