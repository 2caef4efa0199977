//! A project → a font: the whole way.

use super::alike;
use super::batch::Batch;
use super::by_hand;
use super::cache;
use super::corrections::Corrections;
use super::doubt::Doubt;
use super::focus;
use super::labels;
use super::letter::{Letter, placed};
use super::level;
use super::matching;
use super::page::{Page, Traced};
use super::palette;
use super::problem::{Problem, all, unless};
use super::project::{Content, Project};
use super::repeats::{self, Settled};
use super::source::Source;
use super::watch::Stage;
use super::world::World;
use crate::assemble::words::Gap;
use crate::assemble::{self, Note};
use crate::scan::{InkStreaks, Warning};
use crate::types::{Cell, Font, Label};
use rayon::prelude::*;
use std::mem;
use std::path::Path;

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
    /// The gaps of written words beside those of the font.
    pub gaps: Vec<Gap>,
}

impl Built {
    /// The page that a letter was drawn on.
    pub(super) fn page_of(&self, letter: &Letter) -> Option<&Page> {
        let mut pages = self.pages.iter();
        pages.find(|p| p.table == letter.table && p.name == letter.sheet)
    }
}

/// Builds a font.
///
/// # Errors
/// Everything that is wrong with the project, its pages and their cells.
pub fn build(project: &Project, world: World<'_>) -> Result<Built, Vec<Problem>> {
    let (project, mut doubts) = matching::resolve(project, world)?;
    let project = &project;
    let corrections = Corrections::of(project)?;
    let Drawings {
        letters,
        words,
        pages,
    } = drawings(project, &corrections, world)?;
    doubts.extend(matching::doubts(project, &corrections, &letters, world)?);
    let draw = |like: &Letter, cell: Cell| {
        let page = (like.sheet.as_str(), like.table);
        let options = corrections.trace(&cell.label, &project.trace);
        // what is drawn anew has no streaks
        Letter::new(page, cell, InkStreaks::Keep, options, world.watch)
    };
    let Settled {
        mut letters,
        notes: repeats,
        features,
    } = repeats::settle(letters, project.repeated, draw)?;
    let _time = world.watch.enter(Stage::Assemble);
    let levelled = level::set(&mut letters, project, &corrections)?;
    let drawn = placed(&letters, project.font.units_per_em)?;
    let twins = alike::notes(&letters, &drawn, project.font.units_per_em);
    let words = words.par_iter();
    let words = all(words
        .map(|word| word.read(project.font.units_per_em))
        .collect())?;
    let info = project.font.info(world.created);
    let options = assemble::Options {
        compose: project.compose.clone(),
        anchors: project.anchors.clone(),
        inks: palette::of(project, &pages),
        words,
        heights: project.heights(),
        ..project.spacing.clone()
    };
    let mut assembled = assemble::font(drawn, info, &options).map_err(|e| vec![e.into()])?;
    assembled.font.features.push_str(&features);
    let font = by_hand::set(assembled.font, project, world)?;
    let by_hand = by_hand::notes(&font, project);
    Ok(Built {
        font,
        letters,
        pages,
        notes: [repeats, levelled, twins, assembled.notes, by_hand].concat(),
        doubts,
        gaps: assembled.gaps,
    })
}

/// What was drawn on all pages in reading order, and the pages without their cells.
struct Drawings {
    letters: Vec<Letter>,
    words: Vec<Letter>,
    pages: Vec<Page>,
}

/// # Errors
/// Everything that is wrong with the project, its pages and their cells.
fn drawings(
    project: &Project,
    corrections: &Corrections,
    world: World<'_>,
) -> Result<Drawings, Vec<Problem>> {
    let named = labels(project, corrections, world)?;
    let sources = sources((project, corrections), &named)?;
    let mut batches = batches(&sources, project, world).into_iter();
    let pages = sources.iter().map(|source| {
        let own = batches.by_ref().take(source.images().len());
        source.join(own.collect())
    });
    let traced: Vec<Traced> = all(pages.collect())?.into_iter().flatten().collect();
    let mut out = Drawings {
        letters: Vec::new(),
        words: Vec::new(),
        pages: Vec::new(),
    };
    for (drawn, page) in traced {
        let table = project.sheets.get(page.table);
        match table.map_or(Content::Letters, |t| t.content) {
            Content::Letters => out.letters.extend(drawn),
            Content::Words => out.words.extend(drawn),
        }
        out.pages.push(page);
    }
    Ok(out)
}

/// What became of every picture file of these tables: kept where nothing has changed.
fn batches(sources: &[Source<'_>], project: &Project, world: World<'_>) -> Vec<Batch<Traced>> {
    let images = |s: usize| sources[s].images().into_iter().map(move |image| (s, image));
    let files: Vec<(usize, Option<&Path>)> = (0..sources.len()).flat_map(images).collect();
    let kept = files.par_iter();
    let kept = kept.map(|&(s, image)| cache::recall(&sources[s], image?, project, world));
    let mut batches: Vec<Option<Batch<Traced>>> = kept.collect();
    let pairs = files.iter().zip(&batches);
    let fresh: Vec<_> = pairs
        .filter_map(|(f, kept)| kept.is_none().then_some(*f))
        .collect();
    let cut = |&(s, image): &(usize, Option<&Path>)| sources[s].read(image, world);
    let traced = |&(s, image): &(usize, Option<&Path>), cut: Batch<Page>| {
        let traced = cut.map(|_, page| trace(page, &sources[s], project, world));
        if let Some(image) = image {
            cache::keep(&traced, (&sources[s], image), project, world);
        }
        traced
    };
    let mut done = ahead(&fresh, cut, traced).into_iter();
    for batch in &mut batches {
        if batch.is_none() {
            *batch = done.next();
        }
    }
    batches.into_iter().flatten().collect()
}

/// What `second` makes of each item and of what `first` made of it. `first` is one item ahead of `second`: it keeps
/// one thread while the others share out what `second` does, and no more than two of its results exist at a time.
fn ahead<T: Sync, A: Send, B: Send>(
    items: &[T],
    first: impl Fn(&T) -> A + Sync,
    second: impl Fn(&T, A) -> B + Sync,
) -> Vec<B> {
    let mut done = Vec::with_capacity(items.len());
    let mut ready = items.first().map(&first);
    for (i, item) in items.iter().enumerate() {
        let Some(now) = ready.take() else { break };
        let next = || items.get(i + 1).map(&first);
        let (made, after) = rayon::join(|| second(item, now), next);
        done.push(made);
        ready = after;
    }
    done
}

/// The letters of a page.
fn trace(
    mut page: Page,
    source: &Source<'_>,
    project: &Project,
    world: World<'_>,
) -> Result<Traced, Vec<Problem>> {
    let cells = mem::take(&mut page.cut.cells);
    let sheet = (page.name.as_str(), page.table);
    world.watch.expect(cells.len());
    let letter = |cell: Cell| {
        let options = source.trace(&cell.label, &project.trace);
        let letter = Letter::new(sheet, cell, source.table.streaks, options, world.watch);
        world.watch.done();
        letter
    };
    let letters = all(cells.into_par_iter().map(letter).collect())?;
    let warnings = &mut page.cut.warnings;
    warnings.extend(focus::remark(&letters));
    // a letter may have streaks where its page as a whole told none
    let filled = letters.iter().any(|l| l.filled).then(Warning::of_filled);
    if filled.as_ref().is_some_and(|told| !warnings.contains(told)) {
        warnings.extend(filled);
    }
    Ok((letters, page))
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
    let (project, _) = matching::resolve(project, world)?;
    let named = labels::of(&project, world)?;
    let mut found = project.sheets.iter().zip(&named);
    let Some((table, labels)) = found.nth(number.wrapping_sub(1)) else {
        let (sheet, count) = (format!("sheet {number}"), project.sheets.len());
        let why = format!("the project has {count} sheets");
        return Err(Problem::Sheet { sheet, why }.into());
    };
    let corrections = Corrections::of(&project)?;
    let source = (number - 1, table, labels.as_slice());
    let source = [Source::new((&project, &corrections), source)?];
    let batches = batches(&source, &project, world);
    source[0].join(batches).map(drop)
}

/// The `[[sheet]]`s, from 1, whose result is not in the world's store.
///
/// # Errors
/// Something is wrong with the project.
pub fn sheets_without_result(
    project: &Project,
    world: World<'_>,
) -> Result<Vec<usize>, Vec<Problem>> {
    let (project, _) = matching::resolve(project, world)?;
    let corrections = Corrections::of(&project)?;
    let named = labels(&project, &corrections, world)?;
    let sources = sources((&project, &corrections), &named)?;
    let missing = sources.iter().filter(|source| {
        let mut images = source.images().into_iter();
        images.any(|i| {
            i.and_then(|i| cache::recall(source, i, &project, world))
                .is_none()
        })
    });
    Ok(missing.map(|source| source.number + 1).collect())
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
    let (project, _) = matching::resolve(project, world)?;
    let corrections = Corrections::of(&project)?;
    let named = labels(&project, &corrections, world)?;
    let sources = sources((&project, &corrections), &named)?.into_iter();
    let pages = sources.map(|source| {
        let images = source.images().into_iter();
        let batches = images.map(|image| source.read(image, world).map(|_, page| work(page)));
        source.join(batches.collect())
    });
    Ok(all(pages.collect())?.into_iter().flatten().collect())
}

/// The labels of every table; corrections are all of labels that there are.
fn labels(
    project: &Project,
    corrections: &Corrections,
    world: World<'_>,
) -> Result<Vec<Vec<Label>>, Vec<Problem>> {
    let named = labels::of(project, world)?;
    let unused = corrections.unused(named.iter().flatten());
    unless(unused, named)
}

/// Where the pages of each table come from.
fn sources<'a>(
    (project, corrections): (&'a Project, &'a Corrections),
    named: &'a [Vec<Label>],
) -> Result<Vec<Source<'a>>, Vec<Problem>> {
    let tables = project.sheets.iter().zip(named).enumerate();
    let sources =
        tables.map(|(n, (table, labels))| Source::new((project, corrections), (n, table, labels)));
    all(sources.collect())
}
