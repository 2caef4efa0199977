//! A template: the pages that are printed for a table of the project, and their pictures once they are drawn on.

use super::batch::{self, Batch};
use super::labels::{self, skips};
use super::page::Page;
use super::problem::{Problem, unless};
use super::project::{Layout, Project, SheetTable};
use super::watch::Stage;
use super::world::World;
use crate::assemble::names;
use crate::numeric::cast::index;
use crate::numeric::median::{median, middle};
use crate::scan::{self, Cut, InkGrain, Order, Polarity, Reading, Reason, Rejected, Warning};
use crate::template::{self, Drawing, Place, TemplateError};
use crate::types::{Label, Sheet};
use kurbo::Affine;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::path::Path;

/// The pages to draw on of a project's templates; of all its glyph lists where it has no template yet.
///
/// # Errors
/// A glyph is not known, stands twice or there is none, or the layout cannot be printed.
pub fn sheets(project: &Project, world: World<'_>) -> Result<Vec<template::Page>, Vec<Problem>> {
    let named = labels::of(project, world)?;
    let tables = || project.sheets.iter().zip(&named);
    let templates = || tables().filter(|(t, _)| t.layout == Layout::Template);
    let chosen: Vec<_> = if templates().count() == 0 {
        tables().collect()
    } else {
        templates().collect()
    };
    let pages = chosen.into_iter().map(|(table, labels)| {
        let captions: Vec<(String, String)> =
            labels.iter().map(|l| (l.0.clone(), caption(l))).collect();
        let printed = template::pages(
            &project.template,
            table.direction,
            &project.font.family,
            &captions,
        );
        Ok(printed.map_err(Problem::from)?)
    });
    let pages: Result<Vec<_>, Vec<Problem>> = pages.collect();
    Ok(pages?.concat())
}

/// What is printed above a cell: letters and figures as they are, everything else by its name.
fn caption(label: &Label) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | '_' | '-');
    match names::identify(label) {
        Ok(identity) if !label.0.chars().all(plain) => identity.name.to_string(),
        _ => label.0.clone(),
    }
}

/// The pages of a table whose layout is `template`.
pub(super) struct Printing<'a> {
    table: &'a SheetTable,
    layout: &'a template::Layout,
    id: String,
    pages: Vec<Vec<Place>>,
}

impl<'a> Printing<'a> {
    /// Where everything stands.
    ///
    /// # Errors
    /// The layout cannot be printed, or the table says what a template's pages say themselves.
    pub(super) fn new(
        project: &'a Project,
        table: &'a SheetTable,
        labels: &[Label],
    ) -> Result<Self, Problem> {
        let layout = &project.template;
        layout.check()?;
        let scales = [
            table.pixels_per_em,
            table.em_mm,
            table.x_height,
            table.cap_height,
            table.ascender_to_descender,
        ];
        if scales.iter().any(Option::is_some) || table.order != Order::Rows {
            let why = "a template's pages say themselves how large letters are and in which order: take \
                       the scale and the order away";
            return Err(Problem::sheet(table, why));
        }
        if !table.ink.layers().is_empty() {
            let why = "layers of several inks are made from pages of your own (grid, free or boxes): give one ink to \
                       a template, or draw on other pages";
            return Err(Problem::sheet(table, why));
        }
        let names: Vec<String> = labels.iter().map(|l| l.0.clone()).collect();
        let pages = layout.places(&names, table.direction);
        Ok(Self {
            table,
            layout,
            id: layout.id(&project.font.family, &pages),
            pages,
        })
    }

    /// The pages that a picture file shows, each by its number.
    pub(super) fn read(&self, image: &Path, world: World<'_>) -> Batch<Page> {
        let sheets = match self.load(image, world) {
            Ok(sheets) => sheets,
            Err(problem) => return Batch::failed(vec![problem]),
        };
        let mut out = Batch::failed(Vec::new());
        for sheet in sheets {
            match self.page(&sheet, world) {
                Ok((number, page)) => {
                    out.seen.push((number, page.name.clone()));
                    out.made.push((number, page));
                }
                Err(problem) => out.problems.push(problem),
            }
        }
        out
    }

    /// The pages of all picture files in the order of their numbers, whatever the order of the files.
    ///
    /// # Errors
    /// A picture shows no page of this printing, or one that another shows too; a page is missing.
    pub(super) fn join<T>(&self, batches: Vec<Batch<T>>) -> Result<Vec<T>, Vec<Problem>> {
        let (made, seen, mut problems) = batch::join(batches);
        // a picture that was not recognised is probably the page that seems to be missing
        if seen.len() + problems.len() < self.pages.len() || problems.is_empty() {
            problems.extend(self.missing(&seen));
        }
        unless(problems, made.into_values().collect())
    }

    /// The pages of a file, or the one that the table names.
    fn load(&self, image: &Path, world: World<'_>) -> Result<Vec<Sheet>, Problem> {
        let _time = world.watch.enter(Stage::Load);
        let bytes = world.file(image)?;
        // a page on a dark table is no light ink
        let polarity = match self.table.polarity {
            Polarity::Auto => Polarity::DarkInk,
            given => given,
        };
        let reading = Reading {
            polarity,
            tones: self.table.tones,
            ..Reading::default()
        };
        let name = image.display().to_string();
        let sheets = match self.table.page {
            None => scan::load(&bytes, &name, reading)?,
            Some(n) => match scan::load_page(&bytes, &name, reading, n)? {
                (Some(sheet), _) => vec![sheet],
                (None, count) => {
                    let why = format!("there is no page {n}: the file holds {count}");
                    return Err(Problem::Sheet { sheet: name, why });
                }
            },
        };
        Ok(sheets.into_iter().map(scan::grey).collect())
    }

    /// Which page a picture shows, and its cells.
    fn page(&self, sheet: &Sheet, world: World<'_>) -> Result<(usize, Page), Problem> {
        let _time = world.watch.enter(Stage::Cut);
        let found = template::find(sheet, self.layout)?;
        let source = sheet.source.clone();
        let places = self.pages.get(found.code.page - 1);
        let Some(places) = places.filter(|_| found.code.id == self.id) else {
            return Err(Problem::from(TemplateError::OtherProject {
                source_name: source,
                found: found.code.id,
                expected: self.id.clone(),
            }));
        };
        let found = found.bent(sheet, self.layout, places);
        let gain = template::gain(sheet, self.layout, &found);
        let mut drawings = template::drawings(sheet, self.layout, &found, places, gain.as_ref());
        let grain = match self.table.grain {
            InkGrain::Soften => averaged(&mut drawings),
            InkGrain::Keep => None,
        };
        let beside = template::stray(sheet, self.layout, &found, places).into_iter();
        let rejected = beside.map(|(in_sheet, area)| Rejected {
            in_sheet,
            area_px: index(area),
            reason: Reason::Outside,
        });
        let rejected = rejected.collect();
        let down = found
            .surface
            .near(self.layout.paper_mm().to_rect().center());
        let [a, b, ..] = down.as_coeffs();
        let scale = a.hypot(b);
        let cut = Cut {
            warnings: warnings(&drawings).into_iter().chain(grain).collect(),
            specks: drawings.iter().map(|d| d.specks).sum(),
            cells: drawings
                .into_iter()
                .filter(|d| d.inked)
                .map(|d| d.cell)
                .collect(),
            rejected,
            skew_deg: libm::atan2(b, a).to_degrees(),
            upright: Affine::scale(scale) * down.inverse(),
            colours: Vec::new(),
            misfit: None,
        };
        let page = Page {
            name: source,
            table: 0,
            cut,
            gain,
            px_per_mm: Some(scale),
        };
        Ok((found.code.page, page))
    }

    /// The labels that a page should hold, with their places in the list.
    pub(super) fn wanted(&self, number: usize) -> Vec<(usize, Label)> {
        let places = self.pages.get(number - 1).map_or(&[][..], Vec::as_slice);
        let labels = places.iter().map(|p| (p.index, Label(p.label.clone())));
        labels.filter(|(_, l)| !skips(l)).collect()
    }

    /// The complaint about pages that no picture shows.
    fn missing(&self, seen: &BTreeMap<usize, String>) -> Option<Problem> {
        let missing = (1..=self.pages.len()).filter(|n| !seen.contains_key(n));
        let missing: Vec<String> = missing.map(|n| n.to_string()).collect();
        let text = match missing.as_slice() {
            [] => return None,
            [one] => format!("page {one}"),
            [most @ .., last] => format!("pages {} and {last}", most.join(", ")),
        };
        Some(Problem::from(TemplateError::Missing(text)))
    }
}

/// Averages the ink of the drawings where it is grain; what is to be said of that.
fn averaged(drawings: &mut [Drawing]) -> Option<Warning> {
    let average = |drawing: &mut Drawing| {
        let (gray, px) = scan::grained(&drawing.cell.gray)?;
        drawing.cell.gray = gray;
        Some(px)
    };
    let drawn = drawings.par_iter_mut().filter_map(average);
    median(drawn.collect::<Vec<_>>()).map(Warning::of_averaged)
}

/// Drawings that reach their field's edge, and letters far smaller than the page's others.
fn warnings(drawings: &[Drawing]) -> Vec<Warning> {
    let (mut out, mut sizes) = (Vec::new(), Vec::new());
    for drawing in drawings {
        let of = |message: String| Warning {
            index: Some(drawing.cell.index),
            label: Some(drawing.cell.label.clone()),
            message,
        };
        if drawing.cut_off {
            let message = "its ink reaches the frame of its field: what lies beyond is left out";
            out.push(of(message.to_owned()));
        }
        let letter = names::identify(&drawing.cell.label)
            .is_ok_and(|n| n.chars.iter().all(|c| scan::is_full(*c)));
        if drawing.inked && letter {
            sizes.push((drawing.size_em, of(scan::SMALL_LETTER.to_owned())));
        }
    }
    let usual = middle(sizes.iter().map(|s| s.0), f64::total_cmp).unwrap_or(0.0);
    let small = sizes
        .into_iter()
        .filter(|s| s.0 < scan::SMALL_SHARE * usual);
    out.extend(small.map(|s| s.1));
    out.sort_by_key(|w| w.index);
    out
}
