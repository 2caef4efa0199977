//! One cell → one drawn letter.

use super::picture::{self, Curves, trace_picture};
use super::problem::{Place, Problem, all};
use super::watch::{Stage, Watch};
use crate::assemble::words::Word;
use crate::assemble::{Drawn, names};
use crate::finish::place;
use crate::scan::{self, InkStreaks};
use crate::trace;
use crate::types::{Cell, Contour, Font, Frame, Gray, Guides, Label, Outline, Plate, Png};
use kurbo::{BezPath, Rect};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What was drawn in a cell, still in the cell's px.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Letter {
    /// The page, as messages name it.
    pub sheet: String,
    /// The page's table in the project file, from 0.
    pub table: usize,
    /// What it is said to be.
    pub label: Label,
    /// Position of its cell in the page's reading order, from 0.
    pub index: usize,
    /// The cell, for people to look at.
    pub picture: Png,
    /// The ink's rectangle in the page's picture, px, y down.
    pub in_sheet: Rect,
    /// The cell's baseline and scale.
    pub guides: Guides,
    /// The scanned edge that outlines are measured against, px, y up, origin at the picture's bottom left.
    pub edge: Vec<Contour>,
    /// Its closed curves, px, y up, origin at the picture's bottom left.
    pub paths: Vec<BezPath>,
    /// The closed curves around each ink's own part, by the ink, the lowest first; empty where inks make no layers.
    pub plates: Vec<(String, Vec<BezPath>)>,
    /// Whether pale streaks in its ink were filled.
    pub filled: bool,
}

impl Letter {
    /// Traces a cell of a page and its table.
    ///
    /// # Errors
    /// An option is outside its range, or there is nothing in the cell.
    pub(super) fn new(
        (sheet, table): (&str, usize),
        cell: Cell,
        streaks: InkStreaks,
        options: &picture::Options,
        watch: &dyn Watch,
    ) -> Result<Self, Problem> {
        let _time = watch.enter(Stage::Trace);
        let trace = |gray: &Gray| trace_picture(gray, streaks, options);
        let traced = trace(&cell.gray).and_then(|Curves { paths, mut filled }| {
            let plate = |plate: &Plate| {
                let part = trace(&plate.gray)?;
                filled |= part.filled;
                Ok((plate.ink.clone(), part.paths))
            };
            let plates: Result<Vec<_>, _> = cell.plates.iter().map(plate).collect();
            Ok((paths, plates?, filled))
        });
        match traced {
            Ok((paths, ..)) if paths.is_empty() => Err(Problem::Empty(Place::of(sheet, &cell))),
            Ok((paths, plates, filled)) => Ok(Self {
                sheet: sheet.to_owned(),
                table,
                edge: trace::trace(&cell.gray, &trace::Options::default()),
                picture: Png::of(&scan::upright(&cell.gray)),
                label: cell.label,
                index: cell.index,
                in_sheet: cell.in_sheet,
                guides: cell.guides,
                paths,
                plates,
                filled,
            }),
            Err(source) => Err(Problem::Fit {
                place: Place::of(sheet, &cell),
                source: Box::new(source),
            }),
        }
    }

    /// Where it was drawn.
    pub(super) fn spot(&self) -> Place {
        Place::new(&self.sheet, self.index, &self.label)
    }

    /// From the curves' px to font units; x is the cell's own.
    #[must_use]
    pub fn frame(&self, units_per_em: u16) -> Frame {
        let guides = &self.guides;
        Frame {
            units_per_px: f64::from(units_per_em) / guides.px_per_em,
            baseline_px: self.picture.height as f64 - guides.baseline_px,
            origin_px: 0.0,
        }
    }

    /// From the curves' px to the glyph as it stands in `font`, after spacing; `None` where it is not in it.
    pub(super) fn frame_in(&self, font: &Font) -> Option<Frame> {
        let identity = names::identify(&self.label).ok()?;
        let glyph = font.glyph(identity.name.as_str())?;
        let units_per_em = font.info.units_per_em;
        let frame = self.frame(units_per_em);
        let drawn = self.place(units_per_em).ok()?;
        // spacing has moved the outline by whole units
        let moved = glyph.outline.bounds()?.x0 - drawn.outline.bounds()?.x0;
        Some(Frame {
            origin_px: frame.origin_px - moved.round() / frame.units_per_px,
            ..frame
        })
    }

    /// The word that was written, in font units.
    ///
    /// # Errors
    /// The curves are no outline.
    pub(super) fn read(&self, units_per_em: u16) -> Result<Word, Problem> {
        Ok(Word {
            text: self.label.0.clone(),
            outline: self.place(units_per_em)?.outline,
        })
    }

    /// Puts the letter on the baseline, in font units.
    ///
    /// # Errors
    /// The curves are no outline.
    pub(super) fn place(&self, units_per_em: u16) -> Result<Drawn, Problem> {
        let frame = self.frame(units_per_em);
        let outline = |paths: &[BezPath]| {
            place::outline(paths, frame).map_err(|source| Problem::Outline {
                place: self.spot(),
                source,
            })
        };
        let plates = self.plates.iter();
        let plates = plates.map(|(ink, paths)| Ok((ink.clone(), outline(paths)?)));
        let plates: Vec<(String, Outline)> = plates.collect::<Result<_, Problem>>()?;
        Ok(Drawn {
            label: self.label.clone(),
            outline: outline(&self.paths)?,
            plates: plates.into_iter().filter(|p| !p.1.is_empty()).collect(),
            advance: None,
        })
    }
}

/// The letters in font units.
pub(super) fn placed(letters: &[Letter], units_per_em: u16) -> Result<Vec<Drawn>, Vec<Problem>> {
    let letters = letters.par_iter();
    all(letters.map(|letter| letter.place(units_per_em)).collect())
}
