//! One table of pages → their cells.

use super::batch::{self, Batch};
use super::build::World;
use super::corrections::Corrections;
use super::labels::{self, skips};
use super::picture;
use super::printing::Printing;
use super::problem::{Place, Problem};
use super::project::{Cells, Layout, Project, SheetTable};
use super::watch::Stage;
use crate::assemble::names;
use crate::scan::{self, Cut, Grain, Options, Pin, Turn, Warning};
use crate::template::Gain;
use crate::types::{Cell, Label, Sheet};
use std::collections::BTreeSet;
use std::mem;
use std::path::Path;

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
    /// Pixels a millimetre of paper, where the page or its file tells.
    pub px_per_mm: Option<f64>,
}

/// The pictures of one `[[sheet]]` and the way to its pages.
pub(super) struct Source<'a> {
    /// Its place in the project file, from 0.
    pub(super) number: usize,
    pub(super) table: &'a SheetTable,
    pub(super) labels: &'a [Label],
    corrections: Corrections,
    units_per_em: u16,
    /// What was printed, where the pages are a template's.
    printing: Option<Printing<'a>>,
}

impl<'a> Source<'a> {
    /// # Errors
    /// What the table or the corrections say does not fit.
    pub(super) fn new(
        project: &'a Project,
        (number, table, labels): (usize, &'a SheetTable, &'a [Label]),
    ) -> Result<Self, Vec<Problem>> {
        let corrections = Corrections::of(project)?;
        let mut printing = None;
        if table.layout == Layout::Template {
            if let Some(problem) = corrections.unfit(labels.iter()) {
                return Err(vec![problem]);
            }
            let printed = Printing::new(project, table, labels);
            printing = Some(printed.map_err(|p| vec![p])?);
        }
        Ok(Self {
            number,
            table,
            labels,
            corrections,
            units_per_em: project.font.units_per_em,
            printing,
        })
    }

    /// The picture files: each can be read without the others. None is given where the table does not name the one that it must.
    pub(super) fn images(&self) -> Vec<Option<&'a Path>> {
        let given = self.table.image.iter().map(|i| Some(i.as_path()));
        match (&self.printing, self.table.image.as_slice()) {
            (Some(_), _) => given.collect(),
            (None, [image]) => vec![Some(image)],
            (None, _) => vec![None],
        }
    }

    /// The pages of a picture file, their cells corrected, none of them without a drawing.
    pub(super) fn read(&self, image: Option<&Path>, world: World<'_>) -> Batch<Page> {
        let Some((printing, image)) = self.printing.as_ref().zip(image) else {
            let labels = self.corrections.kept(self.labels);
            let pins = self.corrections.pins(&labels);
            let page = read(self.table, (&labels, &pins), self.units_per_em, world);
            let wanted: Vec<(usize, Label)> = labels.into_iter().enumerate().collect();
            let page = page.and_then(|page| self.checked(page, &wanted));
            return match page {
                Ok(page) => Batch {
                    seen: vec![(1, page.name.clone())],
                    made: vec![(1, page)],
                    problems: Vec::new(),
                },
                Err(problems) => Batch::failed(problems),
            };
        };
        let mut batch = printing.read(image, world);
        for (number, page) in mem::take(&mut batch.made) {
            match self.checked(page, &printing.wanted(number)) {
                Ok(page) => batch.made.push((number, page)),
                Err(more) => batch.problems.extend(more),
            }
        }
        batch
    }

    /// The page corrected, where no name is without a drawing.
    fn checked(&self, mut page: Page, wanted: &[(usize, Label)]) -> Result<Page, Vec<Problem>> {
        let corrections = &self.corrections;
        corrections.apply(&mut page.cut, self.units_per_em);
        page.cut.cells.retain(|c| !corrections.ignores(&c.label));
        let wanted = wanted.iter().filter(|w| !corrections.ignores(&w.1));
        let mut problems = gaps(&page, wanted);
        if let (Layout::Grid(rows, columns), true) = (self.table.layout, problems.len() >= MANY) {
            problems.push(Problem::Sheet {
                sheet: page.name.clone(),
                why: format!(
                    "{} cells of the grid are empty: does the page have {rows} rows and {columns} columns of cells?",
                    problems.len()
                ),
            });
        }
        if problems.is_empty() {
            Ok(Page {
                table: self.number,
                ..page
            })
        } else {
            Err(problems)
        }
    }

    /// How a letter is traced.
    pub(super) fn trace(
        &'a self,
        label: &Label,
        usual: &'a picture::Options,
    ) -> &'a picture::Options {
        self.corrections.trace(label, usual)
    }

    /// The project's corrections of this table's glyphs.
    pub(super) fn corrected(&self, project: &Project) -> Cells {
        let name = |label: &Label| names::identify(label).ok().map(|id| id.name);
        let here: BTreeSet<_> = self.labels.iter().filter_map(name).collect();
        let mut cells = project.cells.clone();
        cells.retain(|key, _| name(&Label(key.clone())).is_some_and(|n| here.contains(&n)));
        cells
    }

    /// The pages of all picture files in order.
    ///
    /// # Errors
    /// All that went wrong with one of them, and pages that no picture shows.
    pub(super) fn join<T>(&self, batches: Vec<Batch<T>>) -> Result<Vec<T>, Vec<Problem>> {
        if let Some(printing) = &self.printing {
            return printing.join(batches);
        }
        let (made, _, problems) = batch::join(batches);
        if problems.is_empty() {
            Ok(made.into_values().collect())
        } else {
            Err(problems)
        }
    }
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
        let images = table.image.iter();
        let pages = printing.join(images.map(|i| printing.read(i, world)).collect())?;
        return Ok(pages.into_iter().flat_map(|p| p.cut.cells).collect());
    }
    let page = read(table, (labels, &[]), project.font.units_per_em, world)?;
    Ok(page.cut.cells)
}

/// Empty cells from which on it is asked whether the grid is the page's.
const MANY: usize = 3;

/// Millimetres an inch.
const MM_PER_INCH: f64 = 25.4;

/// Letters that stand no worse than this are the right way up.
const STANDING: f64 = 0.33;
/// A page is turned if its letters then stand better than this share of how they did.
const FAR_BETTER: f64 = 0.6;

/// The page as the table says that it lies; where it does not say, the way up in which the letters stand as their
/// names say.
fn read(
    table: &SheetTable,
    named: (&[Label], &[Pin]),
    units_per_em: u16,
    world: World<'_>,
) -> Result<Page, Vec<Problem>> {
    let first = read_turned(
        table,
        table.turn.unwrap_or_default(),
        named,
        (units_per_em, world),
    );
    let badly = |page: &Page| page.cut.misfit.unwrap_or(0.0);
    let limit = match &first {
        Ok(page) => STANDING.min(FAR_BETTER * badly(page)),
        Err(_) => STANDING,
    };
    let settled = match &first {
        Ok(page) => badly(page) <= STANDING,
        Err(problem) => !matches!(problem, Problem::Scan(_)),
    };
    if table.turn.is_some() || settled {
        return first.map_err(|p| vec![p]);
    }
    let turns = [Turn::Quarter, Turn::Half, Turn::ThreeQuarters].into_iter();
    let others = turns.filter_map(|turn| {
        let page = read_turned(table, turn, named, (units_per_em, world)).ok()?;
        Some((page.cut.misfit?, turn, page))
    });
    let best = others.min_by(|a, b| a.0.total_cmp(&b.0));
    match best.filter(|b| b.0 < limit) {
        Some((_, turn, mut page)) => {
            let degrees = u16::from(turn);
            page.cut.warnings.insert(
                0,
                Warning {
                    index: None,
                    label: None,
                    message: format!(
                        "the letters stand for their names once the picture is turned by {degrees}° clockwise, and \
                         so it was; write turn = {degrees}, or turn = 0 if that is wrong"
                    ),
                },
            );
            Ok(page)
        }
        None => first.map_err(|p| vec![p]),
    }
}

fn read_turned(
    table: &SheetTable,
    turn: Turn,
    (labels, pins): (&[Label], &[Pin]),
    (units_per_em, world): (u16, World<'_>),
) -> Result<Page, Problem> {
    let wrong = |why| {
        let sheet = table.name();
        Problem::Sheet { sheet, why }
    };
    let options = Options {
        lines: labels::lines(table, world)?,
        ..table.cut_options(units_per_em).map_err(wrong)?
    };
    let cut = |page: scan::Page| {
        let _time = world.watch.enter(Stage::Cut);
        let cut = scan::cut_with(&page, labels, &options, pins).map_err(Problem::from)?;
        Ok((cut, page.sheet.dpi))
    };
    let sheet = || load(table, turn, world);
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
    let (cut, dpi) = cut?;
    Ok(Page {
        name: table.name(),
        table: 0,
        cut,
        gain: None,
        px_per_mm: dpi.map(|dpi| dpi / MM_PER_INCH),
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
fn load(table: &SheetTable, turn: Turn, world: World<'_>) -> Result<Sheet, Problem> {
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
    let grain = if table.ink.layers().is_empty() {
        Grain::Blocks
    } else {
        Grain::Pixels
    };
    let mut pages = scan::load_turned(&bytes, &name, table.polarity, (turn, grain))?;
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
