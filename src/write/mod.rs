//! Font → Files: TTF, OTF, WOFF2, UFO, SVG, proof.
//!
//! [`FORMATS`] is the table of them. Every writer is a pure function: the same font gives the same
//! bytes, and nothing touches the disk.

pub mod centerline;
mod cff;
mod cmap;
mod colour;
pub mod designspace;
pub mod handwork;
pub mod layout;
mod names;
mod numbers;
mod os2;
mod otf;
pub mod picture;
pub mod proof;
mod sfnt;
mod svg;
mod ttf;
mod ufo;

use crate::types::{Files, Font};
use thiserror::Error;

/// Why a font cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum WriteError {
    /// TrueType has no cubics.
    #[error("glyph {0} has cubic curves; TrueType outlines are quadratic: convert them first")]
    Cubic(String),
    /// A number that the format cannot hold.
    #[error(
        "{what} is {value}, which a font file cannot hold; check the scale of the sheet (pixels_per_em)"
    )]
    Range {
        /// what the number measures
        what: String,
        /// the number
        value: String,
    },
    /// A feature file that does not compile, with the compiler's message and line.
    #[error("the OpenType features do not compile:\n{0}")]
    Features(String),
    /// A UFO that lies where one is to be written, and is none.
    #[error("the UFO there cannot be read: {0}")]
    Unread(String),
    /// A table that does not fit together.
    #[error("cannot build the {table} table: {message}")]
    Table {
        /// which
        table: String,
        /// why
        message: String,
    },
}

impl WriteError {
    fn range(what: impl Into<String>, value: impl ToString) -> Self {
        Self::Range {
            what: what.into(),
            value: value.to_string(),
        }
    }

    fn table(table: &str, error: impl ToString) -> Self {
        Self::Table {
            table: table.to_owned(),
            message: error.to_string(),
        }
    }
}

/// The curves that a format stores.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Curves {
    /// Cubic Béziers, as they come from the fit.
    Cubic,
    /// Quadratic Béziers: the font goes through [`crate::quadratic`] first.
    Quadratic,
}

/// An output format.
#[derive(Debug, Clone, Copy)]
pub struct Format {
    /// Its key in a project file.
    pub name: &'static str,
    /// The usual ending of its file, or `None` for a folder.
    pub extension: Option<&'static str>,
    /// The curves it stores.
    pub curves: Curves,
    /// The writer.
    pub write: fn(&Font) -> Result<Files, WriteError>,
}

/// Every format that a font can be written in.
pub const FORMATS: &[Format] = &[
    Format {
        name: "ttf",
        extension: Some("ttf"),
        curves: Curves::Quadratic,
        write: |font| ttf::bytes(font).map(Files::single),
    },
    Format {
        name: "otf",
        extension: Some("otf"),
        curves: Curves::Cubic,
        write: |font| otf::bytes(font).map(Files::single),
    },
    Format {
        name: "woff2",
        extension: Some("woff2"),
        curves: Curves::Quadratic,
        write: |font| woff2(&ttf::bytes(font)?).map(Files::single),
    },
    Format {
        name: "ufo",
        extension: Some("ufo"),
        curves: Curves::Cubic,
        write: ufo::files,
    },
    Format {
        name: "svg",
        extension: None,
        curves: Curves::Cubic,
        write: svg::files,
    },
];

/// The format of that name.
#[must_use]
pub fn format(name: &str) -> Option<&'static Format> {
    FORMATS.iter().find(|f| f.name == name)
}

/// An OpenType font (TrueType or CFF) compressed as WOFF2.
///
/// # Errors
/// The bytes are no font.
pub fn woff2(font: &[u8]) -> Result<Vec<u8>, WriteError> {
    ttf2woff2::encode(font, ttf2woff2::BrotliQuality::default())
        .map_err(|e| WriteError::table("WOFF2", e))
}
