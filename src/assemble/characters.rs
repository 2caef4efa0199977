//! The characters that a glyph's name stands for.

use glyphs_reader::glyphdata::GlyphData;
use read_fonts::ps::agl;

/// The characters of a name without suffix; `None` when no list knows it.
pub(super) fn of(base: &str) -> Option<Vec<char>> {
    let known: Vec<Vec<char>> = base
        .split('_')
        .map(|part| agl::name_to_chars(part).collect())
        .collect();
    if known.iter().all(|k| !k.is_empty()) {
        return Some(known.concat());
    }
    friendly(base)
}

/// The characters of a name as Glyphs writes it, `lam_alef-ar`.
fn friendly(base: &str) -> Option<Vec<char>> {
    let data = GlyphData::default();
    let known = data.query(base, None)?;
    if let Some(c) = known.codepoint.and_then(char::from_u32) {
        return Some(vec![c]);
    }
    let production = known.production_name?.to_string();
    let stem = production.split('.').next().unwrap_or_default();
    let parts: Vec<Vec<char>> = stem
        .split('_')
        .map(|part| agl::name_to_chars(part).collect())
        .collect();
    (parts.iter().all(|p| !p.is_empty())).then(|| parts.concat())
}
