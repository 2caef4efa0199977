//! The grid that a user said.

use crate::scan::cut::layout::Task;
use crate::scan::error::Fault;
use crate::scan::options::Order;
use crate::types::{Direction, Label};

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

    /// Row and column of a cell from its position in reading order.
    pub(super) fn place(&self, index: usize) -> (usize, usize) {
        let (row, column) = match self.task.options.order {
            Order::Rows => (index / self.columns, index % self.columns),
            Order::Columns => (index % self.rows, index / self.rows),
        };
        (row, self.across(column))
    }

    /// The position in reading order of a cell of such a row and column.
    pub(super) fn index(&self, (row, column): (usize, usize)) -> usize {
        match self.task.options.order {
            Order::Rows => row * self.columns + self.across(column),
            Order::Columns => self.across(column) * self.rows + row,
        }
    }

    /// A column counted from the side from which rows are read, of one from the left, and the other way round.
    fn across(&self, column: usize) -> usize {
        match self.task.options.direction {
            Direction::Ltr => column,
            Direction::Rtl => self.columns.saturating_sub(column + 1),
        }
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
