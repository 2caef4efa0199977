//! Font files and drawings → Font: the mirror of `write`.
//!
//! | takes | gives |
//! |---|---|
//! | the bytes of a TTF, OTF or WOFF2 ([`font`]), of SVG files ([`svg()`]), a UFO folder ([`ufo()`]) | [`Reading`]: a [`Font`] and what it could not take along |
//!
//! Whatever the bytes are, the answer is a font or an error, never a panic.

mod cff;
mod collection;
mod instance;
mod names;
mod pen;
mod sfnt;
mod svg;
mod tables;
mod ufo;

pub use pen::Pen;
pub use sfnt::font;
pub use svg::svg;
pub use ufo::ufo;

use crate::types::{Font, FontError, Glyph, Name};
use skrifa::{GlyphId, Tag};
use std::collections::BTreeSet;
use thiserror::Error;

/// What to do about a damaged font file.
const MEND: &str = "fetch the font again, or mend it in a font editor and export it anew";

/// Why there is no font.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The bytes are of no kind that is read, or damaged.
    #[error("not readable as {kind}: {message}")]
    Damaged {
        /// what it was taken for
        kind: &'static str,
        /// what is wrong with it
        message: String,
    },
    /// WOFF of the first version, which is not read.
    #[error(
        "it is WOFF 1, which is not read; take the TTF, OTF or WOFF2 of the font, or unpack it, as fontTools does"
    )]
    Woff,
    /// A table of a font file that does not hold what it should.
    #[error("its table {table} is damaged: {why}; {MEND}")]
    Table {
        /// its tag
        table: String,
        /// what is wrong with it
        why: String,
    },
    /// A glyph of a font file whose outline cannot be drawn.
    #[error("the outline of {glyph} is damaged: {why}; {MEND}")]
    Outline {
        /// its name and number
        glyph: String,
        /// what is wrong with it
        why: String,
    },
    /// A file of a UFO that cannot be read.
    #[error(
        "{file} in the UFO cannot be read: {why}; mend it there, or save the UFO again in the program that made it"
    )]
    Ufo {
        /// its path within the UFO
        file: String,
        /// what is wrong with it
        why: String,
    },
    /// A place on an axis that the font does not have.
    #[error("the font has no axis “{0}”; it has: {1}")]
    Axis(String, String),
    /// A place on an axis of a font that has none.
    #[error("the font has no axes, thus no “{0}”: it is no variable font; leave --location out")]
    NoAxes(String),
    /// A place beyond the end of an axis.
    #[error("{axis}={value} lies beyond the axis, which runs from {} to {}", range[0], range[1])]
    Beyond {
        /// the axis' tag
        axis: String,
        /// the place that was asked for
        value: f64,
        /// the axis' ends
        range: [f64; 2],
    },
    /// A collection of several fonts, and none was chosen.
    #[error("there are several fonts in it; choose one by number or name, --face: {0}")]
    Faces(String),
    /// A font that is not in the file.
    #[error("there is no font “{0}” in it (--face); it has: {1}")]
    Face(String, String),
    /// A drawing of which nothing can be read.
    #[error(
        "{file} has nothing that can be read as an outline, but {what}; make paths of it in a drawing program, \
         or take the file away"
    )]
    Undrawn {
        /// the drawing
        file: String,
        /// its elements
        what: String,
    },
    /// There is nothing to draw in it.
    #[error("there are no outlines in it")]
    Empty,
    /// The glyphs make no font.
    #[error(transparent)]
    Font(#[from] FontError),
}

impl ReadError {
    fn damaged(kind: &'static str, error: impl ToString) -> Self {
        Self::Damaged {
            kind,
            message: error.to_string(),
        }
    }

    fn table(tag: Tag, why: impl ToString) -> Self {
        Self::Table {
            table: tag.to_string().trim().to_owned(),
            why: why.to_string(),
        }
    }

    fn outline((name, id): (&Name, GlyphId), why: impl ToString) -> Self {
        Self::Outline {
            glyph: format!("{name} (glyph {id})"),
            why: why.to_string(),
        }
    }
}

/// A font, and what of its source did not come along.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// The font.
    pub font: Font,
    /// What is lost, a line each, for people.
    pub lost: Vec<String>,
}

/// Legal, unique glyph names: others get one made from their number.
#[derive(Debug, Default)]
struct Names {
    taken: BTreeSet<Name>,
    changed: Vec<String>,
}

impl Names {
    /// The glyph's name, or `glyphN` where the given one is illegal, missing or taken.
    fn claim(&mut self, wanted: &str, number: usize) -> Name {
        if let Ok(name) = Name::new(wanted)
            && self.taken.insert(name.clone())
        {
            return name;
        }
        if !wanted.is_empty() {
            self.changed.push(wanted.to_owned());
        }
        let mut made = (0..).filter_map(|k| {
            let tail = if k == 0 {
                String::new()
            } else {
                format!(".{k}")
            };
            Name::new(format!("glyph{number:05}{tail}")).ok()
        });
        let name = made
            .find(|n| !self.taken.contains(n))
            .unwrap_or_else(Name::notdef);
        self.taken.insert(name.clone());
        name
    }

    fn lost(&self) -> Option<String> {
        listed("glyph names that are illegal or not unique", &self.changed)
    }
}

/// A line for people: how many there are, of what, and the first of them.
fn listed(what: &str, all: &[String]) -> Option<String> {
    /// As many as a line has room for.
    const SHOWN: usize = 5;
    let more = if all.len() > SHOWN { ", …" } else { "" };
    let some = all[..all.len().min(SHOWN)].join(", ");
    (!all.is_empty()).then(|| format!("{} {what}: {some}{more}", all.len()))
}

/// Puts `.notdef` first: the one that is there, or an empty one.
fn begin_with_notdef(glyphs: &mut Vec<Glyph>) {
    match glyphs.iter().position(|g| g.name == Name::notdef()) {
        Some(i) => glyphs[..=i].rotate_right(1),
        None => glyphs.insert(0, Glyph::new(Name::notdef(), Vec::new(), 500.0)),
    }
}

/// A whole number of 16 bits.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 16 bits before"
)]
fn whole(v: f64) -> u16 {
    v.round().clamp(0.0, 65535.0) as u16
}
