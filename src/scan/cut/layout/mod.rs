//! Pieces of ink → letters in reading order, as the layout says: cells of a grid, printed boxes, or rows of a bare
//! page.

mod boxes;
mod free;
mod grid;
mod listed;
mod named;
mod rows;
mod ruling;
mod touching;

use super::Layer;
use crate::numeric::view::View;
use crate::scan::clean::Page;
use crate::scan::components::Component;
use crate::scan::error::ScanError;
use crate::scan::options::{Direction, Layout, Options, Order};
use crate::types::Label;

/// Where the layout puts the pieces of a page that is seen as `upright` says.
pub(super) fn place(
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
                gray: &page.sheet.gray,
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
