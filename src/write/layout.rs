//! OpenType layout: one feature text for every format, compiled in process.

use super::WriteError;
use crate::types::Font;
use fea_rs::compile::{Compilation, NopFeatureProvider, NopVariationInfo, error::CompilerError};
use fea_rs::parse::SourceLoadError;
use fea_rs::{Compiler, GlyphMap};
use std::path::Path;
use std::sync::Arc;

/// The name that messages give the feature text.
const SOURCE: &str = "features.fea";

/// The whole feature text: the font's own, then kerning and marks from its data.
#[must_use]
pub fn text(font: &Font) -> String {
    font.features.clone()
}

/// GSUB, GPOS and GDEF of the font.
pub(super) fn compile(font: &Font) -> Result<Compilation, WriteError> {
    let names = GlyphMap::new(font.glyphs().iter().map(|g| g.name.as_str()))
        .map_err(|e| WriteError::Features(e.to_string()))?;
    let text: Arc<str> = text(font).into();
    let resolver = move |path: &Path| {
        if path == Path::new(SOURCE) {
            Ok(text.clone())
        } else {
            Err(SourceLoadError::new(
                path.to_owned(),
                "include() is resolved before a font is built",
            ))
        }
    };
    Compiler::<NopFeatureProvider, NopVariationInfo>::new(SOURCE, &names)
        .with_resolver(resolver)
        .compile()
        .map_err(|e| WriteError::Features(message(&e)))
}

fn message(error: &CompilerError) -> String {
    match error {
        CompilerError::ParseFail(d)
        | CompilerError::ValidationFail(d)
        | CompilerError::CompilationFail(d) => d.display().to_string(),
        other => other.to_string(),
    }
}
