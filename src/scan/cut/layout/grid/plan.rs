//! The grid that a user said.

use crate::scan::cut::layout::{Task, position};
use crate::scan::error::Fault;
use crate::scan::options::Order;
use crate::types::Label;

/// A cell is at least this large, px.
const LEAST_CELL: usize = 4;

/// The grid that a user said.
#[derive(Clone)]
pub(in crate::scan::cut::layout) struct Plan<'a> {
    pub(super) rows: usize,
    pub(super) columns: usize,
    pub(super) task: &'a Task<'a>,
    /// How far down the page printed lines lie, upright px.
    pub(super) printed: Vec<f64>,
}

impl<'a> Plan<'a> {
    pub(in crate::scan::cut::layout) fn new(
        task: &'a Task<'a>,
        rows: usize,
        columns: usize,
    ) -> Result<Self, Fault> {
        let gray = task.gray();
        let fits = |n: usize, side: usize| n > 0 && n <= side / LEAST_CELL;
        let fine = fits(rows, gray.height()) && fits(columns, gray.width());
        fine.then_some(Self {
            rows,
            columns,
            task,
            printed: Vec::new(),
        })
        .ok_or(Fault::NoGrid { rows, columns })
    }

    pub(super) fn place(&self, index: usize) -> (usize, usize) {
        position(index, (self.rows, self.columns), self.task.options)
    }

    pub(super) fn index(&self, cell: (usize, usize)) -> Option<usize> {
        (0..self.rows * self.columns).find(|&i| self.place(i) == cell)
    }

    /// How many cells follow each other in a row, or in a column where columns come first.
    pub(super) fn lines(&self) -> Vec<usize> {
        match self.task.options.order {
            Order::Rows => vec![self.columns; self.rows],
            Order::Columns => vec![self.rows; self.columns],
        }
    }

    pub(super) fn too_many(&self, labels: &[Label]) -> Result<(), Fault> {
        let cells = self.rows * self.columns;
        labels.get(cells).map_or(Ok(()), |extra| {
            Err(Fault::TooManyNames {
                cells,
                names: labels.len(),
                extra: extra.0.clone(),
            })
        })
    }
}
