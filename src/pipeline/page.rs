//! One table of pages → their cells.

use super::build::World;
use super::corrections::Corrections;
use super::labels::skips;
use super::printing::Printing;
use super::problem::{Place, Problem};
use super::project::{Layout, Project, SheetTable};
use super::watch::Stage;
use crate::scan::{self, Cut, Pin};
use crate::template::Gain;
use crate::types::{Cell, Label, Sheet};
use std::collections::BTreeSet;

/// A page and what it was cut into.
#[derive(Debug, Clone)]
pub struct Page {
    /// What messages call it.
    pub name: String,
    /// Its table in the project file, from 0.
    pub table: usize,
    /// Its cells in reading order, each with its label, and what is in none.
    pub cut: Cut,
    /// How its printer and scanner blur and spread black, where its margin tells.
    pub gain: Option<Gain>,
}

/// What `work` makes of each page of a table. Only one page is in memory at a time, except of a file of several.
///
/// # Errors
/// A page cannot be read or cut, names and drawings do not match, or `work` says so.
pub(super) fn each<T>(
    (number, table): (usize, &SheetTable),
    labels: &[Label],
    project: &Project,
    world: World<'_>,
    work: impl Fn(Page) -> Result<T, Vec<Problem>>,
) -> Result<Vec<T>, Vec<Problem>> {
    let corrections = Corrections::of(project)?;
    let checked = |mut page: Page, wanted: &[(usize, Label)]| {
        corrections.apply(&mut page.cut, project.font.units_per_em);
        page.cut.cells.retain(|c| !corrections.ignores(&c.label));
        let wanted = wanted.iter().filter(|w| !corrections.ignores(&w.1));
        let problems = gaps(&page, wanted);
        if problems.is_empty() {
            work(Page {
                table: number,
                ..page
            })
        } else {
            Err(problems)
        }
    };
    if table.layout == Layout::Template {
        if let Some(problem) = corrections.unfit(labels.iter()) {
            return Err(vec![problem]);
        }
        return Printing::new(project, table, labels)
            .map_err(|p| vec![p])?
            .each(world, checked);
    }
    let labels = corrections.kept(labels);
    let pins = corrections.pins(&labels);
    let page = read(table, (&labels, &pins), project.font.units_per_em, world)?;
    let wanted: Vec<(usize, Label)> = labels.into_iter().enumerate().collect();
    Ok(vec![checked(page, &wanted)?])
}

/// The cells of a table's pages, also where names have no drawing and drawings have no name.
///
/// # Errors
/// A page cannot be read or cut.
pub(super) fn cells(
    table: &SheetTable,
    labels: &[Label],
    project: &Project,
    world: World<'_>,
) -> Result<Vec<Cell>, Vec<Problem>> {
    if table.layout == Layout::Template {
        let printing = Printing::new(project, table, labels).map_err(|p| vec![p])?;
        let pages = printing.each(world, |page, _| Ok(page.cut.cells))?;
        return Ok(pages.into_iter().flatten().collect());
    }
    Ok(
        read(table, (labels, &[]), project.font.units_per_em, world)?
            .cut
            .cells,
    )
}

fn read(
    table: &SheetTable,
    (labels, pins): (&[Label], &[Pin]),
    units_per_em: u16,
    world: World<'_>,
) -> Result<Page, Vec<Problem>> {
    let wrong = |why| {
        let sheet = table.name();
        vec![Problem::Sheet { sheet, why }]
    };
    let options = table.cut_options(units_per_em).map_err(wrong)?;
    let cut = |page: scan::Page| {
        let _time = world.watch.enter(Stage::Cut);
        scan::cut_with(&page, labels, &options, pins).map_err(Problem::from)
    };
    let sheet = || load(table, world);
    let clean = |sheet: Sheet| {
        let _time = world.watch.enter(Stage::Clean);
        scan::clean(sheet).map_err(Problem::from)
    };
    let cut = sheet().and_then(clean).and_then(cut).or_else(|problem| {
        // perhaps there is a table around the page
        let page = sheet()
            .ok()
            .and_then(|s| scan::clean_paper(s).ok().flatten());
        page.and_then(|p| cut(p).ok()).ok_or(problem)
    });
    let cut = cut.map_err(|p| vec![p])?;
    Ok(Page {
        name: table.name(),
        table: 0,
        cut,
        gain: None,
    })
}

/// Names without a letter.
fn gaps<'a>(page: &Page, wanted: impl Iterator<Item = &'a (usize, Label)>) -> Vec<Problem> {
    let drawn: BTreeSet<usize> = page.cut.cells.iter().map(|c| c.index).collect();
    let named = wanted.filter(|(_, label)| !skips(label));
    let empty = named.filter(|(index, _)| !drawn.contains(index));
    let empty = empty.map(|(index, label)| {
        Problem::Empty(Place {
            sheet: page.name.clone(),
            index: *index,
            label: Some(label.0.clone()),
        })
    });
    empty.collect()
}

/// The one picture that a table names.
fn load(table: &SheetTable, world: World<'_>) -> Result<Sheet, Problem> {
    let wrong = |why: String| Problem::Sheet {
        sheet: table.name(),
        why,
    };
    let [image] = table.image.as_slice() else {
        let why = "give one image; only layout = \"template\" takes several, or none before it is scanned";
        return Err(wrong(why.to_owned()));
    };
    let _time = world.watch.enter(Stage::Load);
    let bytes = world.file(image)?;
    let name = image.display().to_string();
    let mut pages = scan::load_turned(&bytes, &name, table.polarity, table.turn)?;
    let count = pages.len();
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
