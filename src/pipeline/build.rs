//! A project → a font: the whole way.

use super::alike;
use super::by_hand;
use super::cache::{self, Store};
use super::corrections::Corrections;
use super::doubt::Doubt;
use super::labels;
use super::letter::Letter;
use super::letters;
use super::page::{self, Page};
use super::problem::Problem;
use super::project::{Project, SheetTable};
use super::repeats;
use super::watch::{Stage, Watch};
use crate::assemble::{self, Drawn, Note};
use crate::types::{Cell, Font, Label};
use rayon::prelude::*;
use std::path::Path;
use std::{fmt, mem};

/// What a run needs of the world outside.
#[derive(Clone, Copy)]
pub struct World<'a> {
    /// Gives a file that the project names, or says why not.
    pub read: &'a (dyn Fn(&Path) -> Result<Vec<u8>, String> + Sync),
    /// Is told what is done.
    pub watch: &'a dyn Watch,
    /// Seconds since 1970 that the font gives as its date.
    pub created: i64,
    /// Where what pages became is kept between runs.
    pub store: &'a dyn Store,
}

impl World<'_> {
    /// The content of a file that the project names.
    pub(super) fn file(&self, path: &Path) -> Result<Vec<u8>, Problem> {
        (self.read)(path).map_err(|why| Problem::File {
            file: path.display().to_string(),
            why,
        })
    }
}

impl fmt::Debug for World<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World")
            .field("created", &self.created)
            .finish_non_exhaustive()
    }
}

/// A font and the letters that it was made of.
#[derive(Debug, Clone)]
pub struct Built {
    /// Cubic outlines, font units.
    pub font: Font,
    /// The cells' letters in reading order.
    pub letters: Vec<Letter>,
    /// The pages, their cells taken out: what was found beside them.
    pub pages: Vec<Page>,
    /// What could not be met.
    pub notes: Vec<Note>,
    /// Cells that look like other letters than their labels say.
    pub doubts: Vec<Doubt>,
}

/// Builds a font.
///
/// # Errors
/// Everything that is wrong with the project, its pages and their cells.
pub fn build(project: &Project, world: World<'_>) -> Result<Built, Vec<Problem>> {
    let (project, mut doubts) = letters::resolve(project, world)?;
    let project = &project;
    let (letters, pages) = letters(project, world)?;
    doubts.extend(letters::doubts(project, &letters, world).map_err(|p| vec![p])?);
    let (letters, repeats) = repeats::settle(letters, project.repeated);
    let _time = world.watch.enter(Stage::Assemble);
    let drawn: Vec<Result<Drawn, Problem>> = letters
        .iter()
        .map(|letter| letter.place(project.font.units_per_em))
        .collect();
    let drawn = all(drawn)?;
    let twins = alike::notes(&letters, &drawn, project.font.units_per_em);
    let info = project.font.info(world.created);
    let options = assemble::Options {
        compose: project.compose.clone(),
        anchors: project.anchors.clone(),
        ..project.spacing.clone()
    };
    let assembled = assemble::font(drawn, info, &options).map_err(|e| vec![e.into()])?;
    Ok(Built {
        font: by_hand::set(assembled.font, project, world)?,
        letters,
        pages,
        notes: [repeats, twins, assembled.notes].concat(),
        doubts,
    })
}

/// The letters of all pages in reading order, and the pages without their cells.
///
/// # Errors
/// Everything that is wrong with the project, its pages and their cells.
fn letters(project: &Project, world: World<'_>) -> Result<(Vec<Letter>, Vec<Page>), Vec<Problem>> {
    let pages = tables(project, world, |number, table, labels| {
        sheet(project, (number, table, labels), world)
    })?;
    let (letters, pages): (Vec<_>, Vec<_>) = pages.into_iter().unzip();
    Ok((letters.into_iter().flatten().collect(), pages))
}

/// The letters of a table's pages, kept ones where nothing has changed.
fn sheet(
    project: &Project,
    (number, table, labels): (usize, &SheetTable, &[Label]),
    world: World<'_>,
) -> Result<Vec<(Vec<Letter>, Page)>, Vec<Problem>> {
    let corrections = Corrections::of(project)?;
    let trace = |mut page: Page| {
        let cells = mem::take(&mut page.cut.cells);
        let sheet = page.name.as_str();
        world.watch.expect(cells.len());
        let letter = |cell: Cell| {
            let options = corrections.trace(&cell.label, &project.trace);
            let letter = Letter::new(sheet, cell, options, world.watch);
            world.watch.done();
            letter
        };
        // the one place where work is shared out
        let letters = all(cells.into_par_iter().map(letter).collect())?;
        Ok((letters, page))
    };
    let mut pages = cache::recalled((table, labels), project, world, || {
        page::each((number, table), labels, project, world, trace)
    })?;
    // a table that was kept may have stood in another place
    pages.iter_mut().for_each(|(_, page)| page.table = number);
    Ok(pages)
}

/// Does the work of one `[[sheet]]`, `number` from 1, and leaves the result in the world's store.
///
/// # Errors
/// There is no such sheet, or something is wrong with the project, its pages and their cells.
pub fn sheet_letters(
    project: &Project,
    number: usize,
    world: World<'_>,
) -> Result<(), Vec<Problem>> {
    let (project, _) = letters::resolve(project, world)?;
    let named = labels::of(&project, world)?;
    let found = project
        .sheets
        .iter()
        .zip(&named)
        .nth(number.wrapping_sub(1));
    let Some((table, labels)) = found else {
        return Err(vec![Problem::Sheet {
            sheet: format!("sheet {number}"),
            why: format!("the project has {} sheets", project.sheets.len()),
        }]);
    };
    sheet(&project, (number - 1, table, labels), world).map(drop)
}

/// The `[[sheet]]`s, from 1, whose result is not in the world's store.
///
/// # Errors
/// Something is wrong with the project, or a picture cannot be read.
pub fn sheets_without_result(
    project: &Project,
    world: World<'_>,
) -> Result<Vec<usize>, Vec<Problem>> {
    let (project, _) = letters::resolve(project, world)?;
    tables(&project, world, |number, table, labels| {
        let has = cache::has((table, labels), &project, world).map_err(|p| vec![p])?;
        Ok((!has).then_some(number + 1).into_iter().collect())
    })
}

/// What `work` makes of each page, one after the other.
///
/// # Errors
/// Everything that is wrong with the project, its pages and what `work` says of them.
pub fn pages<T>(
    project: &Project,
    world: World<'_>,
    work: impl Fn(Page) -> Result<T, Vec<Problem>>,
) -> Result<Vec<T>, Vec<Problem>> {
    let (project, _) = letters::resolve(project, world)?;
    tables(&project, world, |number, table, labels| {
        page::each((number, table), labels, &project, world, &work)
    })
}

/// What `work` makes of each table of pages, its number and its labels.
fn tables<T>(
    project: &Project,
    world: World<'_>,
    work: impl Fn(usize, &SheetTable, &[Label]) -> Result<Vec<T>, Vec<Problem>>,
) -> Result<Vec<T>, Vec<Problem>> {
    let named = labels::of(project, world)?;
    let unused = Corrections::of(project)?.unused(named.iter().flatten());
    if !unused.is_empty() {
        return Err(unused);
    }
    let tables = project.sheets.iter().zip(&named).enumerate();
    let done = tables.map(|(number, (table, labels))| work(number, table, labels));
    Ok(all_lists(done.collect())?.into_iter().flatten().collect())
}

/// All values, or all problems.
pub(super) fn all<T>(results: Vec<Result<T, Problem>>) -> Result<Vec<T>, Vec<Problem>> {
    all_lists(
        results
            .into_iter()
            .map(|r| r.map_err(|p| vec![p]))
            .collect(),
    )
}

/// All values, or all problems.
fn all_lists<T>(results: Vec<Result<T, Vec<Problem>>>) -> Result<Vec<T>, Vec<Problem>> {
    let (mut values, mut problems) = (Vec::with_capacity(results.len()), Vec::new());
    for result in results {
        match result {
            Ok(value) => values.push(value),
            Err(more) => problems.extend(more),
        }
    }
    if problems.is_empty() {
        Ok(values)
    } else {
        Err(problems)
    }
}
