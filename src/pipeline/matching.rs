//! Which letters a project's cells hold, and whether its labels say so.

use super::corrections::Corrections;
use super::doubt::Doubt;
use super::letter::Letter;
use super::problem::{Place, Problem};
use super::project::{Content, Labels, Layout, Project, SheetTable};
use super::reference::{Script, samples, spelling};
use super::source::Source;
use super::world::World;
use super::{corrections, labels};
use crate::assemble::names;
use crate::recognise::{Alphabet, Finding, Guess, Look, Reading, check, once};
use crate::scan::upright;
use crate::types::{Cell, Label};
use rayon::prelude::*;
use std::collections::BTreeSet;

/// A cell and the letters that it may hold.
#[derive(Debug, Clone)]
pub struct Matched {
    /// Where it lies and what it is said to hold.
    pub place: Place,
    /// Likeliest first.
    pub guesses: Vec<Guess>,
}

/// The letters of every page's cells, best first, and what speaks against the labels. Names without a drawing
/// and drawings without a name are no error here.
///
/// # Errors
/// Everything that is wrong with the project and its pages, or the reference.
pub fn match_letters(
    project: &Project,
    world: World<'_>,
) -> Result<(Vec<Matched>, Vec<Doubt>), Vec<Problem>> {
    let project = &corrections::gathered(project, world)?;
    let alphabet = alphabet(project, world)?;
    let (corrections, none) = (Corrections::of(project)?, Corrections::default());
    let (mut matched, mut remarks) = (Vec::new(), Vec::new());
    for (number, sheet) in of_letters(project) {
        let labels = sheet_labels(sheet, world)?;
        let auto = sheet.glyphs.is_auto();
        // whose cell is whose is not known where labels are to be found
        let corrections = if auto { &none } else { &corrections };
        let source = Source::new((project, corrections), (number, sheet, &labels))?;
        let cells = source.cells(world)?;
        let guesses = guesses(&cells, seen(project), &alphabet);
        if !auto {
            let indices = cells.iter().map(|c| c.index);
            let labels = corrections.kept(&labels);
            remarks.extend(findings(&sheet.name(), &labels, indices.zip(&guesses)));
        }
        let places = cells.iter().map(|c| Place::of(&sheet.name(), c));
        matched.extend(
            places
                .zip(guesses)
                .map(|(place, guesses)| Matched { place, guesses }),
        );
    }
    Ok((matched, remarks))
}

/// The project with `glyphs = "auto"` replaced by the letters that the cells look like, each letter once; cells
/// that are not sure are skipped, and the remarks name them.
///
/// # Errors
/// Everything that is wrong with pages whose letters are to be read, or the reference.
pub(super) fn resolve(
    project: &Project,
    world: World<'_>,
) -> Result<(Project, Vec<Doubt>), Vec<Problem>> {
    let project = corrections::gathered(project, world)?;
    let (mut project, mut remarks) = (project, Vec::new());
    if !project.sheets.iter().any(|s| s.glyphs.is_auto()) {
        return Ok((project, remarks));
    }
    let alphabet = alphabet(&project, world)?;
    for i in 0..project.sheets.len() {
        let sheet = &project.sheets[i];
        if sheet.glyphs.is_auto() {
            let labels = sheet_labels(sheet, world)?;
            let none = Corrections::default();
            let cells = Source::new((&project, &none), (i, sheet, &labels))?.cells(world)?;
            let guesses = guesses(&cells, seen(&project), &alphabet);
            let (labels, unsure) = name(labels.len(), &cells, &guesses);
            let remark = |finding| Doubt {
                sheet: sheet.name(),
                finding,
                labels: labels.clone(),
            };
            remarks.extend(unsure.into_iter().map(remark));
            project.sheets[i].glyphs = Labels::Text(labels.join(" "));
        }
    }
    Ok((project, remarks))
}

/// Cells of a page that get names at most: more would be too small for letters on the largest page, too.
const MOST_CELLS: usize = 1_000_000;

/// Confidence, among the letters left by the other cells, from which a cell is named by what it looks like.
const NAMED: f64 = 0.5;
/// And least confidence among all letters: a second drawing of a letter is no other letter.
const POSSIBLE: f64 = 0.1;

/// A name for each of `count` cells, no name twice; and the cells left out.
fn name(count: usize, cells: &[Cell], guesses: &[Vec<Guess>]) -> (Vec<String>, Vec<Finding>) {
    let mut labels = vec![labels::SKIP.to_owned(); count];
    let mut unsure = Vec::new();
    for ((cell, guesses), given) in cells.iter().zip(guesses).zip(once(guesses)) {
        let sure = given.filter(|given| {
            let own = guesses.iter().find(|g| g.label == given.label);
            given.confidence >= NAMED && own.is_some_and(|g| g.confidence >= POSSIBLE)
        });
        match (sure, labels.get_mut(cell.index), guesses.first()) {
            (Some(given), Some(label), _) => *label = given.label,
            (_, _, Some(like)) => unsure.push((
                cell.index,
                Finding::Unsure {
                    cell: cell.index,
                    like: like.label.clone(),
                    confidence: like.confidence,
                },
            )),
            _ => {}
        }
    }
    unsure.sort_by_key(|u| u.0);
    (labels, unsure.into_iter().map(|u| u.1).collect())
}

/// What speaks against the labels of letters already traced; nothing where the project names no reference.
///
/// # Errors
/// The reference cannot be read, or is none.
pub(super) fn doubts(
    project: &Project,
    corrections: &Corrections,
    letters: &[Letter],
    world: World<'_>,
) -> Result<Vec<Doubt>, Problem> {
    if project.matching.reference.is_empty() {
        return Ok(Vec::new());
    }
    let alphabet = alphabet(project, world)?;
    let mut remarks = Vec::new();
    for (table, sheet) in of_letters(project) {
        let drawn = letters.iter().filter(|l| l.table == table);
        let drawn: Vec<&Letter> = drawn.collect();
        let labels = corrections.kept(&sheet_labels(sheet, world)?);
        let method = project.matching.method;
        let look = |l: &&Letter| Look::new(&l.picture.gray(), Some(l.guides), method);
        let guesses = guesses(&drawn, look, &alphabet);
        let indices = drawn.iter().map(|l| l.index);
        remarks.extend(findings(&sheet.name(), &labels, indices.zip(&guesses)));
    }
    Ok(remarks)
}

/// The tables whose cells hold letters, each with its place in the project file, from 0.
fn of_letters(project: &Project) -> impl Iterator<Item = (usize, &SheetTable)> {
    let sheets = project.sheets.iter().enumerate();
    sheets.filter(|s| s.1.content == Content::Letters)
}

/// The labels as written; as many that say nothing as there are cells where they are to be found.
fn sheet_labels(sheet: &SheetTable, world: World<'_>) -> Result<Vec<Label>, Problem> {
    match (sheet.glyphs.is_auto(), sheet.layout) {
        (false, _) => labels::of_sheet(sheet, world),
        // bounded, since a grid for whose cells the page has no room is refused only when it is cut
        (true, Layout::Grid(rows, columns)) => Ok(vec![
            Label("?".to_owned());
            rows.saturating_mul(columns).min(MOST_CELLS)
        ]),
        (true, _) => {
            let why = "glyphs = \"auto\" needs layout = { grid = [rows, columns] }";
            Err(Problem::sheet(sheet, why))
        }
    }
}

/// What speaks against the labels of cells.
fn findings<'a>(
    sheet: &str,
    labels: &[Label],
    guesses: impl Iterator<Item = (usize, &'a Vec<Guess>)>,
) -> Vec<Doubt> {
    let named: Vec<String> = labels.iter().map(spelling).collect();
    let drawn: Vec<usize> = (0..labels.len())
        .filter(|&j| !labels::skips(&labels[j]))
        .collect();
    let wanted: Vec<String> = drawn.iter().map(|&j| named[j].clone()).collect();
    let reading = |(index, guesses): (usize, &'a Vec<Guess>)| {
        let label = drawn.iter().position(|&j| j == index)?;
        Some(Reading { label, guesses })
    };
    let readings: Vec<Reading<'_>> = guesses.filter_map(reading).collect();
    let back = |i: usize| drawn.get(i).copied().unwrap_or(i);
    let remark = |f: Finding| Doubt {
        sheet: sheet.to_owned(),
        finding: f.renumbered(back),
        labels: named.clone(),
    };
    check(&wanted, &readings).into_iter().map(remark).collect()
}

/// How a cell looks to a project's method.
fn seen(project: &Project) -> impl Fn(&Cell) -> Look + Send + Sync + use<> {
    let method = project.matching.method;
    move |cell| Look::new(&upright(&cell.gray), Some(cell.guides), method)
}

/// The letters that each cell of a page may hold.
fn guesses<T: Sync>(
    cells: &[T],
    look: impl Fn(&T) -> Look + Send + Sync,
    alphabet: &Alphabet,
) -> Vec<Vec<Guess>> {
    let mut looks: Vec<Look> = cells.par_iter().map(look).collect();
    alphabet.settle_page(&mut looks);
    looks.par_iter().map(|l| alphabet.rank(l)).collect()
}

/// The references' letters of the scripts that the labels use, and the labels themselves.
fn alphabet(project: &Project, world: World<'_>) -> Result<Alphabet, Problem> {
    let references = &project.matching.reference;
    if references.is_empty() {
        return Err(Problem::NoReference);
    }
    let mut labels: Vec<Label> = Vec::new();
    for (_, sheet) in of_letters(project).filter(|s| !s.1.glyphs.is_auto()) {
        labels.extend(labels::of_sheet(sheet, world)?);
    }
    let auto = project.sheets.iter().any(|s| s.glyphs.is_auto());
    let scripts = if auto {
        vec![Script::Latin, Script::Arabic]
    } else {
        Vec::new()
    };
    let wanted = letters(&labels, scripts);
    let mut pictures = Vec::new();
    for reference in references {
        let bytes = world.file(reference)?;
        let drawn = samples(&bytes, wanted.iter().cloned());
        pictures.extend(drawn.map_err(|source| Problem::Reference {
            file: reference.display().to_string(),
            source,
        })?);
    }
    Ok(Alphabet::new(&pictures, project.matching.method))
}

/// The labels, and all letters of their scripts and of these.
fn letters(labels: &[Label], scripts: Vec<Script>) -> Vec<String> {
    let named = labels.iter().filter(|l| !labels::skips(l));
    let known = labels.iter().filter_map(|l| names::identify(l).ok());
    let used = known.flat_map(|id| id.chars).filter_map(Script::of);
    let scripts: BTreeSet<Script> = used.chain(scripts).collect();
    named
        .map(spelling)
        .chain(scripts.into_iter().flat_map(Script::letters))
        .collect()
}
