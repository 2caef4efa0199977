//! The characters that a glyph's name stands for.

use glyphs_reader::glyphdata::GlyphData;
use read_fonts::ps::agl;

/// The characters of a name without suffix; `None` when no list knows it.
pub(crate) fn of(base: &str) -> Option<Vec<char>> {
    listed(base).or_else(|| friendly(base))
}

/// Those of the Adobe Glyph List and of hexadecimal names, `f_i` and `uni0628`.
fn listed(base: &str) -> Option<Vec<char>> {
    let parts = base
        .split('_')
        .map(|part| agl::name_to_chars(part).collect());
    let parts: Vec<Vec<char>> = parts.collect();
    parts.iter().all(|p| !p.is_empty()).then(|| parts.concat())
}

/// The characters of a name as Glyphs writes it, `lam_alef-ar`.
fn friendly(base: &str) -> Option<Vec<char>> {
    let data = GlyphData::default();
    let known = data.query(base, None)?;
    if let Some(c) = known.codepoint.and_then(char::from_u32) {
        return Some(vec![c]);
    }
    let production = known.production_name?.to_string();
    listed(production.split('.').next().unwrap_or_default())
}
