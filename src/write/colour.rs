//! Layers and palette: COLR version 0 and CPAL.

use super::WriteError;
use super::numbers::{count, ids};
use crate::types::Font;
use write_fonts::tables::colr::{BaseGlyph, Colr, Layer};
use write_fonts::tables::cpal::{ColorRecord, Cpal};
use write_fonts::types::GlyphId16;

/// The palette entry that stands for the text's colour ([OpenType,
/// COLR](https://learn.microsoft.com/typography/opentype/spec/colr)).
pub(super) const FOREGROUND: u16 = 0xFFFF;

/// Both tables, of a font with layers.
pub(super) fn tables(font: &Font) -> Result<Option<(Colr, Cpal)>, WriteError> {
    let glyphs = font.glyphs();
    let ids = ids(font);
    let (mut bases, mut layers) = (Vec::new(), Vec::new());
    for (i, glyph) in glyphs
        .iter()
        .enumerate()
        .filter(|(_, g)| !g.layers.is_empty())
    {
        let first = count(layers.len(), "the number of colour layers")?;
        for layer in &glyph.layers {
            let Some(&id) = ids.get(layer.glyph.as_str()) else {
                continue;
            };
            let colour = layer.colour.map(|c| count(c, "the number of colours"));
            let colour = colour.transpose()?.unwrap_or(FOREGROUND);
            layers.push(Layer::new(GlyphId16::new(count(id, "a glyph id")?), colour));
        }
        let own = count(layers.len(), "the number of colour layers")? - first;
        bases.push(BaseGlyph::new(
            GlyphId16::new(count(i, "a glyph id")?),
            first,
            own,
        ));
    }
    if bases.is_empty() {
        return Ok(None);
    }
    let (n, m) = (
        count(bases.len(), "the number of coloured glyphs")?,
        count(layers.len(), "the number of colour layers")?,
    );
    let colr = Colr::new(n, Some(bases), Some(layers), m);
    let colour = |&[red, green, blue]: &[u8; 3]| ColorRecord::new(blue, green, red, u8::MAX);
    let colours = count(font.palette.len(), "the number of colours")?;
    let cpal = Cpal::new(
        colours,
        1,
        colours,
        Some(font.palette.iter().map(colour).collect()),
        vec![0],
    );
    Ok(Some((colr, cpal)))
}
