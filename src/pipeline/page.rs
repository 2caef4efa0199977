//! One page → its cells.

use super::build::World;
use super::labels::skips;
use super::problem::{Place, Problem};
use super::project::SheetTable;
use super::watch::Stage;
use crate::scan::{self, Cut};
use crate::types::{Label, Sheet};
use std::collections::BTreeSet;

/// The cells of a page in reading order, each with its label.
///
/// # Errors
/// The page cannot be read or cut, or names and drawings do not match.
pub(super) fn cut(
    table: &SheetTable,
    labels: &[Label],
    units_per_em: u16,
    world: World<'_>,
) -> Result<Cut, Vec<Problem>> {
    let cut = read(table, labels, units_per_em, world)?;
    let problems = gaps(&table.name(), labels, &cut);
    if problems.is_empty() {
        Ok(cut)
    } else {
        Err(problems)
    }
}

/// The same with names that have no drawing and drawings that have no name.
///
/// # Errors
/// The page cannot be read or cut.
pub(super) fn read(
    table: &SheetTable,
    labels: &[Label],
    units_per_em: u16,
    world: World<'_>,
) -> Result<Cut, Vec<Problem>> {
    let options = table.cut_options(units_per_em).map_err(|why| {
        let sheet = table.name();
        vec![Problem::Sheet { sheet, why }]
    })?;
    let sheet = load(table, world).map_err(|p| vec![p])?;
    let page = {
        let _time = world.watch.enter(Stage::Clean);
        scan::clean(sheet).map_err(|e| vec![e.into()])?
    };
    let _time = world.watch.enter(Stage::Cut);
    scan::cut(&page, labels, &options).map_err(|e| vec![e.into()])
}

/// Names without a letter.
fn gaps(sheet: &str, labels: &[Label], cut: &Cut) -> Vec<Problem> {
    let drawn: BTreeSet<usize> = cut.cells.iter().map(|c| c.index).collect();
    let named = labels.iter().enumerate().filter(|(_, label)| !skips(label));
    let empty = named.filter(|(index, _)| !drawn.contains(index));
    let empty = empty.map(|(index, label)| {
        Problem::Empty(Place {
            sheet: sheet.to_owned(),
            index,
            label: Some(label.0.clone()),
        })
    });
    empty.collect()
}

/// The picture that a table names.
fn load(table: &SheetTable, world: World<'_>) -> Result<Sheet, Problem> {
    let _time = world.watch.enter(Stage::Load);
    let bytes = world.file(&table.image)?;
    let mut pages = scan::load(&bytes, &table.image.display().to_string(), table.polarity)?;
    let count = pages.len();
    let wrong = |why: String| Problem::Sheet {
        sheet: table.name(),
        why,
    };
    match table.page {
        None if count == 1 => Ok(pages.swap_remove(0)),
        None => Err(wrong(format!(
            "the file holds {count} pages; say which one with page = 1"
        ))),
        Some(n) if (1..=count).contains(&n) => Ok(pages.swap_remove(n - 1)),
        Some(n) => Err(wrong(format!(
            "there is no page {n}: the file holds {count}"
        ))),
    }
}
