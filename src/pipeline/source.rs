//! The pictures of one table → its pages, corrected, each with all of its cells.

use super::batch::{self, Batch};
use super::corrections::Corrections;
use super::labels::is_space;
use super::page::{self, Page};
use super::picture;
use super::printing::Printing;
use super::problem::{Place, Problem, unless};
use super::project::{Cells, Layout, Project, SheetTable};
use super::world::World;
use crate::assemble::names;
use crate::scan::{Cut, Reason, Rejected, Warning};
use crate::types::{Cell, Label};
use std::collections::BTreeSet;
use std::mem;
use std::path::Path;

/// Empty cells from which on it is asked whether the grid is the page's.
const MANY: usize = 3;

/// Coverage from which a pixel counts as ink.
const INK: f32 = 0.5;

/// What is said of ink in a space's cell.
const STAINED: &str =
    "a space has no ink: what lies in its cell is left out; is this the name of another cell?";

/// The pictures of one `[[sheet]]` and the way to its pages.
pub(super) struct Source<'a> {
    /// Its place in the project file, from 0.
    pub(super) number: usize,
    pub(super) table: &'a SheetTable,
    pub(super) labels: &'a [Label],
    corrections: &'a Corrections,
    project: &'a Project,
    /// What was printed, where the pages are a template's.
    printing: Option<Printing<'a>>,
}

impl<'a> Source<'a> {
    /// # Errors
    /// What the table or the corrections say does not fit.
    pub(super) fn new(
        (project, corrections): (&'a Project, &'a Corrections),
        (number, table, labels): (usize, &'a SheetTable, &'a [Label]),
    ) -> Result<Self, Vec<Problem>> {
        let mut printing = None;
        if table.layout == Layout::Template {
            if let Some(problem) = corrections.unfit(labels.iter()) {
                return Err(problem.into());
            }
            printing = Some(Printing::new(project, table, labels)?);
        }
        Ok(Self {
            number,
            table,
            labels,
            corrections,
            project,
            printing,
        })
    }

    /// The picture files: each can be read without the others. None is given where the table does not name the one
    /// that it must.
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
        let labels = || self.corrections.kept(self.labels).into_iter().enumerate();
        self.cut(image, world).map(|number, page| {
            let printing = self.printing.as_ref();
            let wanted = printing.map_or_else(|| labels().collect(), |p| p.wanted(number));
            self.checked(page, &wanted)
        })
    }

    /// The cells of the table's pages, corrected, also where names have no drawing and drawings have no name.
    ///
    /// # Errors
    /// A page cannot be read or cut.
    pub(super) fn cells(&self, world: World<'_>) -> Result<Vec<Cell>, Vec<Problem>> {
        let pages = self.images().into_iter().map(|i| self.cut(i, world));
        let pages = self.join(pages.collect())?.into_iter();
        Ok(pages.flat_map(|page| page.cut.cells).collect())
    }

    /// The pages of a picture file as they are cut, their cells corrected.
    fn cut(&self, image: Option<&Path>, world: World<'_>) -> Batch<Page> {
        let corrections = self.corrections;
        let pages = match self.printing.as_ref().zip(image) {
            Some((printing, image)) => printing.read(image, world),
            None => {
                let labels = corrections.kept(self.labels);
                let pins = corrections.pins(&labels);
                match page::read(self.table, (&labels, &pins), self.project, world) {
                    Ok(page) => Batch {
                        seen: vec![(1, page.name.clone())],
                        made: vec![(1, page)],
                        problems: Vec::new(),
                    },
                    Err(problems) => Batch::failed(problems),
                }
            }
        };
        pages.map(|_, mut page| {
            corrections.apply(&mut page.cut, self.project.font.units_per_em);
            page.cut.cells.retain(|c| !corrections.ignores(&c.label));
            page.table = self.number;
            Ok(page)
        })
    }

    /// The page without what lies in cells of spaces, where no name is without a drawing.
    fn checked(&self, mut page: Page, wanted: &[(usize, Label)]) -> Result<Page, Vec<Problem>> {
        let corrections = self.corrections;
        clear_spaces(&mut page.cut);
        let wanted = wanted.iter().filter(|w| !corrections.ignores(&w.1));
        let mut problems = self.gaps(&page, wanted);
        if let (Layout::Grid(rows, columns), true) = (self.table.layout, problems.len() >= MANY) {
            problems.push(Problem::Sheet {
                sheet: page.name.clone(),
                why: format!(
                    "{} cells of the grid are empty: does the page have {rows} rows and {columns} columns of cells?",
                    problems.len()
                ),
            });
        }
        unless(problems, page)
    }

    /// Names without a letter.
    fn gaps<'w>(
        &self,
        page: &Page,
        wanted: impl Iterator<Item = &'w (usize, Label)>,
    ) -> Vec<Problem> {
        let wanted = wanted.map(|(index, label)| (*index, label));
        let gap = |(index, label): (usize, &Label)| {
            let place = Place::new(&page.name, index, label);
            if self.corrections.places(label) {
                Problem::Misplaced(place)
            } else {
                Problem::Empty(place)
            }
        };
        page::empty(&page.cut, wanted).map(gap).collect()
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
        unless(problems, made.into_values().collect())
    }
}

/// Takes out what lies in the cells of spaces, and warns of it; that they are empty is right.
fn clear_spaces(cut: &mut Cut) {
    let of_space = |w: &Warning| w.label.as_ref().is_some_and(is_space);
    cut.warnings.retain(|w| !of_space(w));
    let cells = mem::take(&mut cut.cells).into_iter();
    let (spaces, letters) = cells.partition(|c| is_space(&c.label));
    cut.cells = letters;
    for Cell {
        label,
        index,
        in_sheet,
        gray,
        ..
    } in spaces
    {
        let ink = gray.samples().iter().filter(|v| **v >= INK);
        cut.rejected.push(Rejected {
            in_sheet,
            area_px: ink.count(),
            reason: Reason::Skipped,
        });
        cut.warnings.push(Warning {
            index: Some(index),
            label: Some(label),
            message: STAINED.to_owned(),
        });
    }
    cut.warnings.sort_by_key(|w| w.index);
}
