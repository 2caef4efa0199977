//! One cell → one drawn letter.

use super::picture::{self, trace_picture};
use super::problem::{Place, Problem};
use super::watch::{Stage, Watch};
use crate::assemble::{Drawn, names};
use crate::finish::place;
use crate::trace;
use crate::types::{Cell, Contour, Font, Frame, Gray};
use kurbo::BezPath;

/// What was drawn in a cell, still in the cell's px.
#[derive(Debug, Clone)]
pub struct Letter {
    /// The page, as messages name it.
    pub sheet: String,
    /// The cell: its picture in 256 levels, for people to look at, its rectangle in the page, its guides.
    pub cell: Cell,
    /// The scanned edge that outlines are measured against, px, y up, origin at the picture's bottom left.
    pub edge: Vec<Contour>,
    /// Its closed curves, px, y up, origin at the picture's bottom left.
    pub paths: Vec<BezPath>,
}

impl Letter {
    /// Traces a cell.
    ///
    /// # Errors
    /// An option is outside its range, or there is nothing in the cell.
    pub(super) fn new(
        sheet: &str,
        cell: Cell,
        options: &picture::Options,
        watch: &dyn Watch,
    ) -> Result<Self, Problem> {
        let _time = watch.enter(Stage::Trace);
        match trace_picture(&cell.gray, options) {
            Ok(paths) if paths.is_empty() => Err(Problem::Empty(Place::of(sheet, &cell))),
            Ok(paths) => Ok(Self {
                sheet: sheet.to_owned(),
                edge: trace::trace(&cell.gray, &trace::Options::default()),
                cell: coarse(cell),
                paths,
            }),
            Err(source) => Err(Problem::Fit {
                place: Place::of(sheet, &cell),
                source: Box::new(source),
            }),
        }
    }

    /// From the curves' px to font units; x is the cell's own.
    #[must_use]
    #[expect(
        clippy::cast_precision_loss,
        reason = "pictures have fewer rows than 2^52"
    )]
    pub fn frame(&self, units_per_em: u16) -> Frame {
        let guides = &self.cell.guides;
        Frame {
            units_per_px: f64::from(units_per_em) / guides.px_per_em,
            baseline_px: self.cell.gray.height() as f64 - guides.baseline_px,
            origin_px: 0.0,
        }
    }

    /// From the curves' px to the glyph as it stands in `font`, after spacing; `None` where it is not in it.
    pub(super) fn frame_in(&self, font: &Font) -> Option<Frame> {
        let identity = names::identify(&self.cell.label).ok()?;
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

    /// Puts the letter on the baseline, in font units.
    ///
    /// # Errors
    /// The curves are no outline.
    pub(super) fn place(&self, units_per_em: u16) -> Result<Drawn, Problem> {
        let frame = self.frame(units_per_em);
        let outline = place::outline(&self.paths, frame).map_err(|source| Problem::Outline {
            place: Place::of(&self.sheet, &self.cell),
            source,
        })?;
        let units = |px: f64| (px - frame.origin_px) * frame.units_per_px;
        let advance = self.cell.guides.advance_px;
        Ok(Drawn {
            label: self.cell.label.clone(),
            outline,
            advance: advance.map(|(left, right)| (units(left), units(right))),
        })
    }
}

/// The cell with a picture in 256 levels: all that is shown, and what a cache keeps.
fn coarse(cell: Cell) -> Cell {
    let (width, height) = (cell.gray.width(), cell.gray.height());
    match Gray::from_levels(width, height, &cell.gray.levels()) {
        Ok(gray) => Cell { gray, ..cell },
        Err(_) => cell,
    }
}
