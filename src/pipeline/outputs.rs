//! A built font → the bytes of its outputs.

use super::budget::{self, Measured};
use super::build::Built;
use super::letter::Letter;
use super::problem::Problem;
use super::project::{GateTable, Project};
use super::report::{Report, corners, mm_per_unit};
use super::watch::Stage;
use super::world::World;
use crate::assemble::names;
use crate::finish::{round, straight};
use crate::types::{Files, Font};
use crate::write::proof::{self as page, Entry, LeftOut, Proof};
use crate::write::{self, Curves, WriteError};
use std::path::PathBuf;

/// What a project asks for.
#[derive(Debug, Clone)]
pub struct Outputs {
    /// Where each output goes, relative to the project file, and what it is. The report is not among them:
    /// the caller may want to add to it.
    pub files: Vec<(PathBuf, Files)>,
    /// What was done and how well, where the project asks for it, for a proof or has a gate.
    pub report: Option<Report>,
}

/// Everything that the project's `[output]` names. `last` is the proof of the build before, where there was one: the
/// new one shows what has changed.
///
/// # Errors
/// A format cannot hold the font, or a gate does not let it through.
pub fn outputs(
    project: &Project,
    built: &Built,
    last: Option<&str>,
    world: World<'_>,
) -> Result<Outputs, Vec<Problem>> {
    let drawn = straight::font(&built.font);
    let quadratic = quadratic(project, &drawn, world)?;
    let asked = project.output.report.is_some() || project.output.proof.is_some();
    let measured = (asked || project.gate != GateTable::default()).then(|| {
        let _time = world.watch.enter(Stage::Measure);
        budget::measured(built, &drawn, &quadratic)
    });
    let report = measured.as_ref().map(|m| Report::new(built, m));
    let problems = report.as_ref().map(|r| r.gated(&project.gate));
    if let Some(problems) = problems.filter(|p| !p.is_empty()) {
        return Err(problems);
    }
    let _time = world.watch.enter(Stage::Write);
    // quadratics are fitted to what was drawn and rounded when written
    let rounded = round::font(&drawn);
    let mut files = Vec::new();
    let mut woff2 = None;
    for (format, path) in project.output.fonts() {
        let font = match format.curves {
            Curves::Quadratic => &quadratic,
            Curves::Cubic => &rounded,
        };
        let made = (format.write)(font).map_err(|e| vec![e.into()])?;
        if format.name == WEB {
            woff2 = Some(made.clone());
        }
        files.push((path.clone(), made));
    }
    if let Some((path, measured)) = project.output.proof.as_ref().zip(measured) {
        let woff2 = woff2.map_or_else(|| web_font(&quadratic), Ok);
        let woff2 = woff2.map_err(|e| vec![e.into()])?;
        let page = proof_page(built, measured, &woff2, last);
        files.push((path.clone(), Files::single(page.into_bytes())));
    }
    Ok(Outputs { files, report })
}

/// The format that web pages embed.
const WEB: &str = "woff2";

fn web_font(font: &Font) -> Result<Files, WriteError> {
    write::format(WEB).map_or_else(|| Ok(Files::default()), |f| (f.write)(font))
}

/// The font with TrueType's curves.
fn quadratic(project: &Project, font: &Font, world: World<'_>) -> Result<Font, Vec<Problem>> {
    let _time = world.watch.enter(Stage::Quadratic);
    let table = &project.quadratic;
    let units = table.tolerance_em * f64::from(font.info.units_per_em);
    font.try_map_outlines(|glyph| {
        let quadratic = table.convert.convert(&glyph.outline, units);
        quadratic.map_err(|why| Problem::quadratic(glyph, why))
    })
}

/// The proof of a built font, whether or not the project names one; `last` as in [`outputs`].
///
/// # Errors
/// The font cannot be written.
pub fn proof(
    project: &Project,
    built: &Built,
    last: Option<&str>,
    world: World<'_>,
) -> Result<String, Vec<Problem>> {
    let drawn = straight::font(&built.font);
    let font = quadratic(project, &drawn, world)?;
    let measured = {
        let _time = world.watch.enter(Stage::Measure);
        budget::measured(built, &drawn, &font)
    };
    let _time = world.watch.enter(Stage::Write);
    let woff2 = web_font(&font).map_err(|e| vec![e.into()])?;
    Ok(proof_page(built, measured, &woff2, last))
}

/// The proof of a font whose text is set in `woff2`.
fn proof_page(
    built: &Built,
    measured: Vec<Option<Measured>>,
    woff2: &Files,
    last: Option<&str>,
) -> String {
    let pairs = built.letters.iter().zip(measured);
    let entries = pairs.filter_map(|(letter, measured)| entry(built, letter, measured?));
    let entries: Vec<Entry> = entries.collect();
    let pieces = built.pages.iter().flat_map(|page| {
        page.cut.rejected.iter().map(|r| LeftOut {
            sheet: page.name.clone(),
            box_px: corners(r.in_sheet),
            area_px: r.area_px,
            reason: r.reason.to_string(),
        })
    });
    let left_out: Vec<LeftOut> = pieces.collect();
    let characters = built.font.glyphs().iter();
    let characters = characters.flat_map(|g| g.codepoints.iter().copied());
    page::page(&Proof {
        info: &built.font.info,
        entries: &entries,
        characters: &characters.collect(),
        left_out: &left_out,
        woff2: woff2.0.values().next().map_or(&[][..], Vec::as_slice),
        last,
    })
}

/// A letter beside the glyph that became of it.
fn entry(built: &Built, letter: &Letter, measured: Measured) -> Option<Entry> {
    let font = &built.font;
    let identity = names::identify(&letter.label).ok()?;
    let glyph = font.glyph(identity.name.as_str())?;
    let Measured { edge, budget } = measured;
    Some(Entry {
        sheet: letter.sheet.clone(),
        index: letter.index,
        picture: letter.picture.clone(),
        frame: letter.frame_in(font)?,
        edge,
        steps: [
            ("trace and fit", budget.fit),
            ("joining", budget.joining),
            ("quadratics", budget.quadratic),
            ("whole units", budget.rounding),
        ],
        mm_per_unit: mm_per_unit(built, letter),
        glyph: glyph.clone(),
        text: identity.chars.iter().collect(),
        remarks: remarks(built, letter, identity.name.as_str()),
    })
}

/// What was said of a letter's cell and of its glyph.
fn remarks(built: &Built, letter: &Letter, name: &str) -> Vec<String> {
    let warnings = built.page_of(letter).into_iter();
    let warnings = warnings.flat_map(|p| &p.cut.warnings);
    let own = warnings.filter(|w| w.index == Some(letter.index));
    let label = letter.label.0.as_str();
    let notes = built
        .notes
        .iter()
        .filter(|n| n.glyph == name || n.glyph == label);
    own.map(|w| w.message.clone())
        .chain(notes.map(|n| n.message.clone()))
        .collect()
}
