//! One picture → a page and its cells, the right way up.

use super::labels::{self, is_space, skips};
use super::letter::Letter;
use super::problem::Problem;
use super::project::{Project, SheetTable};
use super::watch::Stage;
use super::world::World;
use crate::scan::{self, ColourDetail, Cut, Options, Pin, Reading, Turn, Warning};
use crate::template::{self, Gain};
use crate::types::{Label, MM_PER_INCH, Sheet};
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
    /// Pixels a millimetre of paper, where the page or its file tells.
    pub px_per_mm: Option<f64>,
}

/// The letters of a page, and the page without its cells.
pub(super) type Traced = (Vec<Letter>, Page);

/// Letters that stand no worse than this are the right way up.
const STANDING: f64 = 0.33;
/// A page is turned if its letters then stand better than this share of how they did.
const FAR_BETTER: f64 = 0.6;

/// The page as the table says that it lies; where it does not say, the way up in which the letters stand as their
/// names say.
pub(super) fn read(
    table: &SheetTable,
    named: (&[Label], &[Pin]),
    project: &Project,
    world: World<'_>,
) -> Result<Page, Vec<Problem>> {
    let first = read_turned(
        table,
        table.turn.unwrap_or_default(),
        named,
        (project, world),
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
        return Ok(first?);
    }
    let turns = [Turn::Quarter, Turn::Half, Turn::ThreeQuarters].into_iter();
    let others = turns.filter_map(|turn| {
        let page = read_turned(table, turn, named, (project, world)).ok()?;
        Some((page.cut.misfit?, turn, page))
    });
    let best = others.min_by(|a, b| a.0.total_cmp(&b.0));
    match best.filter(|b| b.0 < limit) {
        Some((_, turn, mut page)) => {
            let degrees = u16::from(turn);
            let turned = Warning::of_page(format!(
                "the letters stand for their names once the picture is turned by {degrees}° clockwise, and \
                 so it was; write turn = {degrees}, or turn = 0 if that is wrong"
            ));
            page.cut.warnings.insert(0, turned);
            Ok(page)
        }
        None => Ok(first?),
    }
}

fn read_turned(
    table: &SheetTable,
    turn: Turn,
    (labels, pins): (&[Label], &[Pin]),
    (project, world): (&Project, World<'_>),
) -> Result<Page, Problem> {
    let options = table.cut_options(project.font.units_per_em);
    let options = Options {
        lines: labels::lines(table, world)?,
        ..options.map_err(|why| Problem::sheet(table, why))?
    };
    let cut = |page: scan::Page| {
        let _time = world.watch.enter(Stage::Cut);
        let cut = scan::cut(&page, labels, &options, pins).map_err(Problem::from)?;
        Ok((cut, page.sheet.dpi))
    };
    let sheet = || load(table, turn, (project, world));
    let clean = |sheet: Sheet| {
        let _time = world.watch.enter(Stage::Clean);
        scan::clean(sheet, table.texture()).map_err(Problem::from)
    };
    // what seems to lie beside the page may be in a shadow on it, and a table may seem to be the page
    let is_whole = |(cut, _): &(Cut, _)| empty(cut, labels.iter().enumerate()).next().is_none();
    let first = sheet().and_then(clean).and_then(cut);
    let cut = if first.as_ref().is_ok_and(is_whole) {
        first
    } else {
        let other = sheet().and_then(|s| Ok(scan::clean_otherwise(s, table.texture())?));
        let other = other.ok().flatten().and_then(|page| cut(page).ok());
        let better = |found: &_| first.is_err() || is_whole(found);
        other.filter(better).map_or(first, Ok)
    };
    let (cut, dpi) = cut?;
    Ok(Page {
        name: table.name(),
        table: 0,
        cut,
        gain: None,
        px_per_mm: dpi.map(|dpi| dpi / MM_PER_INCH),
    })
}

/// Names whose letter is in no cell, though somebody should have drawn it.
pub(super) fn empty<'a>(
    cut: &Cut,
    wanted: impl Iterator<Item = (usize, &'a Label)>,
) -> impl Iterator<Item = (usize, &'a Label)> {
    let drawn: BTreeSet<usize> = cut.cells.iter().map(|c| c.index).collect();
    let named = wanted.filter(|(_, label)| !skips(label) && !is_space(label));
    named.filter(move |(index, _)| !drawn.contains(index))
}

/// The one picture that a table names; none that khatt printed, where captions and marks would be taken for letters.
fn load(
    table: &SheetTable,
    turn: Turn,
    (project, world): (&Project, World<'_>),
) -> Result<Sheet, Problem> {
    let wrong = |why: String| Problem::sheet(table, why);
    let [image] = table.image.as_slice() else {
        let why = "give one image; only layout = \"template\" takes several, or none before it is scanned";
        return Err(wrong(why.to_owned()));
    };
    let _time = world.watch.enter(Stage::Load);
    let bytes = world.file(image)?;
    let name = image.display().to_string();
    let colours = if table.ink.layers().is_empty() {
        ColourDetail::Blocks
    } else {
        ColourDetail::Pixels
    };
    let reading = Reading {
        polarity: table.polarity,
        tones: table.tones,
        turn,
        colours,
    };
    let number = table.page.unwrap_or(1);
    let (page, count) = scan::load_page(&bytes, &name, reading, number)?;
    let page = page.filter(|_| table.page.is_some() || count == 1);
    let page = page.ok_or_else(|| {
        wrong(match table.page {
            Some(n) => format!("there is no page {n}: the file holds {count}"),
            None => format!("the file holds {count} pages; say which one with page = 1"),
        })
    })?;
    match template::find(&page, &project.template) {
        Ok(found) => Err(wrong(format!(
            "this is page {} of those that `khatt sheet` prints, and cannot be cut by another layout: write \
             layout = \"template\", and take scale and order away where they are given: the page says both itself",
            found.code.page
        ))),
        Err(_) => Ok(page),
    }
}
