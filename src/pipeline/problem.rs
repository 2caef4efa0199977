//! What went wrong where, and what to do about it.

use super::project::SheetTable;
use super::reference::ReferenceError;
use crate::{
    assemble::{AssembleError, names::LabelError},
    fit::FitError,
    quadratic::QuadraticError,
    scan::ScanError,
    template::TemplateError,
    types::{Cell, Glyph, Label, OutlineError},
    write::WriteError,
};
use std::fmt;
use thiserror::Error;

/// A cell of a page.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// The page, as messages name it.
    pub sheet: String,
    /// Position in the page's reading order, from 0.
    pub index: usize,
    /// What it is said to hold.
    pub label: Option<String>,
}

impl Place {
    /// The cell of a label.
    pub(super) fn new(sheet: &str, index: usize, label: &Label) -> Self {
        Self {
            sheet: sheet.to_owned(),
            index,
            label: Some(label.0.clone()),
        }
    }

    /// Where a cell lies.
    pub(super) fn of(sheet: &str, cell: &Cell) -> Self {
        Self::new(sheet, cell.index, &cell.label)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, cell {}", self.sheet, self.index + 1)?;
        match &self.label {
            Some(label) => write!(f, " “{label}”"),
            None => Ok(()),
        }
    }
}

/// An error and the place that it concerns.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum Problem {
    /// A file cannot be read.
    #[error("{file}: {why}")]
    File {
        /// the file, as the project names it
        file: String,
        /// what the system said
        why: String,
    },
    /// A page gives no cells.
    #[error(transparent)]
    Scan(#[from] ScanError),
    /// A page of the template is none, the wrong one or missing, or none can be printed.
    #[error(transparent)]
    Template(#[from] TemplateError),
    /// A table of the project does not fit its page.
    #[error("{sheet}: {why}")]
    Sheet {
        /// the page
        sheet: String,
        /// what is missing or too much, and what to do
        why: String,
    },
    /// A correction of a single letter means nothing.
    #[error("[cells] “{name}”: {why}")]
    Correction {
        /// the glyph
        name: String,
        /// what is wrong
        why: String,
    },
    /// The file of corrections is none.
    #[error("{file}: {why}")]
    CellsFile {
        /// the file, as the project names it
        file: String,
        /// what is wrong
        why: String,
    },
    /// Drawings of one glyph differ in size too much to have a middle.
    #[error("{second}: so much larger than {first} that no drawing lies in the middle of them")]
    Sizes {
        /// the smaller one
        first: Box<Place>,
        /// the larger one
        second: Place,
    },
    /// A cell that should hold something is empty.
    #[error("{0}: the cell is empty")]
    Empty(Place),
    /// There is no ink where a correction says that a letter's lies.
    #[error("{0}: no ink lies where its [cells] table says")]
    Misplaced(Place),
    /// A cell's label names no glyph.
    #[error("{place}: {source}")]
    Label {
        /// where
        place: Place,
        /// why
        source: Box<LabelError>,
    },
    /// Two cells have one name.
    #[error("{second}: the name stands already for {first}")]
    Twice {
        /// where it stands first
        first: Box<Place>,
        /// where it stands again
        second: Place,
    },
    /// The tracing options do not fit.
    #[error("{place}: {source}")]
    Fit {
        /// where
        place: Place,
        /// why
        source: Box<FitError>,
    },
    /// The curves are no outline.
    #[error("{place}: {source}")]
    Outline {
        /// where
        place: Place,
        /// why
        source: OutlineError,
    },
    /// Letters are to be told without letters to compare them with.
    #[error("no reference font is named")]
    NoReference,
    /// The reference is none.
    #[error("{file}: {source}")]
    Reference {
        /// the file, as the project names it
        file: String,
        /// why
        source: ReferenceError,
    },
    /// A glyph has no quadratic form.
    #[error("glyph {glyph}: {source}")]
    Quadratic {
        /// its name
        glyph: String,
        /// why
        source: QuadraticError,
    },
    /// A glyph is worse than the project allows.
    #[error("{place}: {what} is {value:.2} units, above the {limit} that [gate] allows")]
    Gate {
        /// where
        place: Place,
        /// which measure
        what: &'static str,
        /// its value, font units
        value: f64,
        /// what the project allows, font units
        limit: f64,
    },
    /// An anchor or a pair set by hand does not fit the font.
    #[error("[{table}] “{key}”: {why}")]
    ByHand {
        /// the table of the project
        table: &'static str,
        /// its key
        key: String,
        /// what is wrong
        why: String,
    },
    /// The glyphs make no font.
    #[error(transparent)]
    Assemble(#[from] AssembleError),
    /// The font cannot be written.
    #[error(transparent)]
    Write(#[from] WriteError),
}

impl From<Problem> for Vec<Problem> {
    fn from(one: Problem) -> Self {
        vec![one]
    }
}

impl Problem {
    /// What a table says does not fit its page.
    pub(super) fn sheet(table: &SheetTable, why: impl Into<String>) -> Self {
        Self::Sheet {
            sheet: table.name(),
            why: why.into(),
        }
    }

    /// Why a glyph has no quadratic form.
    pub(super) fn quadratic(glyph: &Glyph, source: QuadraticError) -> Self {
        Self::Quadratic {
            glyph: glyph.name.to_string(),
            source,
        }
    }

    /// What to do about it.
    #[must_use]
    pub fn help(&self) -> Option<&'static str> {
        Some(match self {
            Self::File { .. } => "paths start from the project file's folder",
            Self::CellsFile { .. } => {
                "its tables are [NAME], as `khatt cut PROJECT.toml --write-overrides FILE` writes them"
            }
            Self::Sizes { .. } => {
                "correct pixels_per_em, or what else says how large the letters of a page are, or take repeated = \"best\""
            }
            Self::Empty(_) => {
                "draw the letter clear of its neighbours, or leave it out: ignore = true under [cells.NAME], or _ in `glyphs`"
            }
            Self::Misplaced(_) => {
                "correct box, polygon or quad under [cells.NAME], in px of the picture, from its top left"
            }
            Self::Label { .. } => {
                "give a character, an AGL name, uniXXXX, or a name such as beh-ar.init"
            }
            Self::Twice { .. } => {
                "rename one, skip its cell with _, or take repeated = \"best\" or \"alternates\""
            }
            Self::ByHand { .. } => {
                "glyph names are those of the font; `khatt build` with report lists them"
            }
            Self::Gate { .. } => {
                "look at the glyph in `khatt proof`; scan it larger, trace with a smaller tolerance_px, or raise the gate"
            }
            Self::NoReference => {
                "name one: reference = \"FONT.ttf\" under [match], or --reference FONT.ttf"
            }
            _ => return None,
        })
    }
}

/// All values, or all problems.
pub(super) fn all<T, P: Into<Vec<Problem>>>(
    results: Vec<Result<T, P>>,
) -> Result<Vec<T>, Vec<Problem>> {
    let (mut values, mut problems) = (Vec::with_capacity(results.len()), Vec::new());
    for result in results {
        match result {
            Ok(value) => values.push(value),
            Err(more) => problems.extend(more.into()),
        }
    }
    unless(problems, values)
}

/// A value, or the problems where there are any.
pub(super) fn unless<T>(problems: Vec<Problem>, value: T) -> Result<T, Vec<Problem>> {
    if problems.is_empty() {
        Ok(value)
    } else {
        Err(problems)
    }
}
