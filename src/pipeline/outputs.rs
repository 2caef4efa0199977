//! A built font → the bytes of its outputs.

use super::build::{Built, World};
use super::letter::Letter;
use super::problem::Problem;
use super::project::Project;
use super::watch::Stage;
use crate::assemble::names;
use crate::types::{Files, Font, Frame};
use crate::write::proof::{self as page, Entry, Proof};
use crate::write::{self, Curves, WriteError};
use std::path::PathBuf;

/// Everything that the project's `[output]` names, except the report: where it goes and what it is.
///
/// # Errors
/// A format cannot hold the font.
pub fn outputs(
    project: &Project,
    built: &Built,
    world: World<'_>,
) -> Result<Vec<(PathBuf, Files)>, Vec<Problem>> {
    let wanted = project.output.fonts();
    let proof = project.output.proof.as_ref();
    let needs = |c: Curves| wanted.iter().any(|(f, _)| f.curves == c);
    let quadratic = if needs(Curves::Quadratic) || proof.is_some() {
        Some(quadratic(project, &built.font, world)?)
    } else {
        None
    };
    let _time = world.watch.enter(Stage::Write);
    let mut out = Vec::new();
    let mut woff2 = None;
    for (format, path) in wanted {
        let font = match (format.curves, &quadratic) {
            (Curves::Quadratic, Some(font)) => font,
            _ => &built.font,
        };
        let files = (format.write)(font).map_err(|e| vec![e.into()])?;
        if format.name == WEB {
            woff2 = Some(files.clone());
        }
        out.push((path.clone(), files));
    }
    if let (Some(path), Some(font)) = (proof, &quadratic) {
        let woff2 = woff2.map_or_else(|| web_font(font), Ok);
        let page = proof_page(built, &woff2.map_err(|e| vec![e.into()])?);
        out.push((path.clone(), Files::single(page.into_bytes())));
    }
    Ok(out)
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
        quadratic.map_err(|source| {
            vec![Problem::Quadratic {
                glyph: glyph.name.to_string(),
                source,
            }]
        })
    })
}

/// The proof of a built font, whether or not the project names one.
///
/// # Errors
/// The font cannot be written.
pub fn proof(project: &Project, built: &Built, world: World<'_>) -> Result<String, Vec<Problem>> {
    let font = quadratic(project, &built.font, world)?;
    let _time = world.watch.enter(Stage::Write);
    let woff2 = web_font(&font).map_err(|e| vec![e.into()])?;
    Ok(proof_page(built, &woff2))
}

/// The proof of a font whose text is set in `woff2`.
fn proof_page(built: &Built, woff2: &Files) -> String {
    let entries: Vec<Entry> = (built.letters.iter())
        .filter_map(|letter| entry(&built.font, letter))
        .collect();
    page::page(&Proof {
        info: &built.font.info,
        entries: &entries,
        woff2: woff2.0.values().next().map_or(&[][..], Vec::as_slice),
    })
}

/// A letter beside the glyph that became of it.
fn entry(font: &Font, letter: &Letter) -> Option<Entry> {
    let identity = names::identify(&letter.cell.label).ok()?;
    let glyph = font.glyph(identity.name.as_str())?;
    let units_per_em = font.info.units_per_em;
    let frame = letter.frame(units_per_em);
    let drawn = letter.place(units_per_em).ok()?;
    // spacing has moved the outline by whole units
    let moved = glyph.outline.bounds()?.x0 - drawn.outline.bounds()?.x0;
    Some(Entry {
        sheet: letter.sheet.clone(),
        index: letter.cell.index,
        gray: letter.cell.gray.clone(),
        frame: Frame {
            origin_px: frame.origin_px - moved.round() / frame.units_per_px,
            ..frame
        },
        glyph: glyph.clone(),
        text: identity.chars.iter().collect(),
    })
}
