//! OpenType with CFF outlines: cubics as they were fitted.

use super::numbers::{around, check, to_u16};
use super::{WriteError, cff, sfnt};
use crate::types::Font;
use kurbo::{BezPath, Rect, Shape};
use write_fonts::types::{Tag, Version16Dot16};

/// An OpenType font with a `CFF ` table.
pub(super) fn bytes(font: &Font) -> Result<Vec<u8>, WriteError> {
    let mut shapes = Vec::with_capacity(font.glyphs().len());
    let mut advances = Vec::with_capacity(font.glyphs().len());
    for glyph in font.glyphs() {
        let shape = font.shape(glyph).to_path();
        check(&shape, glyph)?;
        shapes.push(shape);
        advances.push(i32::from(to_u16(glyph.advance, || {
            format!("the advance of {}", glyph.name)
        })?));
    }
    let extents: Vec<Option<Rect>> = shapes.iter().map(extent).collect();
    let mut common = sfnt::common(font, &extents)?;
    let cff = cff::table(font, &common.post, (&shapes, &advances), around(&extents))?;
    // the names stand in the CFF table
    common.post.version = Version16Dot16::VERSION_3_0;
    common.post.num_glyphs = None;
    common.post.glyph_name_index = None;
    common.post.string_data = None;
    common.build(|builder| {
        builder.add_raw(Tag::new(b"CFF "), cff);
        Ok(())
    })
}

/// Less than this beyond a whole unit is the noise of sums, not ink.
const NOISE: f64 = 1e-3;

/// The whole units around a shape.
fn extent(shape: &BezPath) -> Option<Rect> {
    let ink = shape.bounding_box().inset(-NOISE);
    (!shape.elements().is_empty()).then(|| ink.expand())
}
