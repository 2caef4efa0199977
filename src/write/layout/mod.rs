//! OpenType layout: one feature text for every format, compiled in process.
//!
//! The text is the font's own features, then what follows from its data, as UFO compilers write it:
//! kerning from its pairs, `curs`, `mark` and `mkmk` from its anchors, glyph classes from both. A feature or
//! table that the font's text has already is left to it.

mod context;
mod kern;
mod marks;
mod source;

pub(super) use context::longest;
pub(super) use marks::{Class, class};

use super::WriteError;
use super::numbers::to_i16;
use crate::types::Font;
use fea_rs::compile::{Compilation, NopFeatureProvider, NopVariationInfo, error::CompilerError};
use fea_rs::{Compiler, GlyphMap};
use marks::Marks;
use source::Source;

/// The name that messages give the feature text.
const SOURCE: &str = "features.fea";

/// The whole feature text.
#[must_use]
pub fn text(font: &Font) -> String {
    let own = names(font)
        .ok()
        .and_then(|n| Source::read(&font.features, &n));
    let own = own.unwrap_or_default();
    let mut out = font.features.clone();
    if !font.kerning.pairs.is_empty() && !own.has_feature("kern") {
        out += &kern::feature(font);
    }
    if !own.has_feature("curs") {
        out += &marks::cursive(font);
    }
    let marks = Marks::of(font);
    if marks.are_there() {
        out += &marks.classes();
        if !own.has_feature("mark") {
            out += &marks.feature("mark", &[Class::Base, Class::Ligature]);
        }
        if !own.has_feature("mkmk") {
            out += &marks.feature("mkmk", &[Class::Mark]);
        }
        if !own.defines_classes {
            out += &marks.definitions();
        }
    }
    out
}

/// The font's own features with those of a text that compiles by itself: one feature text, its language systems at
/// the head.
#[must_use]
pub fn with_features(font: &Font, text: &str) -> String {
    let read = |text: &str| {
        let names = names(font).ok()?;
        Source::read(text, &names)
    };
    match (read(&font.features), read(text)) {
        (Some(own), Some(more)) => own.joined(&more),
        _ => format!("{}\n{text}", font.features),
    }
}

/// GSUB, GPOS and GDEF of the font.
pub(super) fn compile(font: &Font) -> Result<Compilation, WriteError> {
    for ((first, second), value) in &font.kerning.pairs {
        to_i16(*value, || format!("the kerning of {first} and {second}"))?;
    }
    for glyph in font.glyphs() {
        for anchor in &glyph.anchors {
            for value in [anchor.at.x, anchor.at.y] {
                to_i16(value, || {
                    format!("anchor {} of {}", anchor.name, glyph.name)
                })?;
            }
        }
    }
    compiled(font, SOURCE, &text(font))
}

/// Whether a feature text compiles by itself for the glyphs of a font; messages call it `name`.
///
/// # Errors
/// What is wrong with it, line by line.
pub fn check(font: &Font, name: &str, text: &str) -> Result<(), WriteError> {
    compiled(font, name, text).map(drop)
}

fn compiled(font: &Font, source: &str, text: &str) -> Result<Compilation, WriteError> {
    let names = names(font)?;
    Compiler::<NopFeatureProvider, NopVariationInfo>::new(source, &names)
        .with_resolver(source::resolver(source, text))
        .compile()
        .map_err(|e| WriteError::Features(message(&e)))
}

fn names(font: &Font) -> Result<GlyphMap, WriteError> {
    GlyphMap::new(font.glyphs().iter().map(|g| g.name.as_str()))
        .map_err(|e| WriteError::Features(e.to_string()))
}

fn message(error: &CompilerError) -> String {
    match error {
        CompilerError::ParseFail(d)
        | CompilerError::ValidationFail(d)
        | CompilerError::CompilationFail(d) => d.display().to_string(),
        other => other.to_string(),
    }
}

#[cfg(test)]
mod tests;
