//! `CFF ` and `CFF2` charstrings → paths, fractions and all: the library's own pens round to whole units.

use super::{ReadError, pen::Pen};
use kurbo::{Affine, BezPath};
use skrifa::raw::ps::cff::{CffFontRef, Subfont};
use skrifa::raw::ps::cs::NopFilterSink;
use skrifa::raw::types::{F2Dot14, Fixed};
use skrifa::raw::{FontRef, TableProvider};
use skrifa::{GlyphId, Tag};

/// The charstrings of a font.
pub(super) struct Charstrings<'a>(CffFontRef<'a>);

impl<'a> Charstrings<'a> {
    pub(super) fn of(font: &FontRef<'a>) -> Result<Self, ReadError> {
        let head = font.head().map_err(|e| ReadError::damaged("a font", e))?;
        let upem = i32::from(head.units_per_em());
        let tables = [b"CFF2", b"CFF "].map(|tag| font.table_data(Tag::new(tag)));
        let data = tables.into_iter().flatten().next().unwrap_or_default();
        let all = CffFontRef::new(data.as_bytes(), 0, Some(upem));
        Ok(Self(
            all.map_err(|e| ReadError::table(Tag::new(b"CFF "), e))?,
        ))
    }

    /// The contours of a glyph, font units, at a place among the variations.
    ///
    /// # Errors
    /// Why it cannot be drawn.
    pub(super) fn draw(&self, id: GlyphId, at: &[F2Dot14]) -> Result<Vec<BezPath>, String> {
        let part = self.0.subfont_index(id).unwrap_or(0);
        let part = self.0.subfont(part, at).map_err(|e| e.to_string())?;
        let mut pen = Pen::default();
        let mut sink = NopFilterSink::new(&mut pen);
        let drawn = self.0.evaluate_charstring(&part, id, at, &mut sink);
        drawn.map_err(|e| e.to_string())?;
        let place = self.place(&part);
        Ok(pen.paths.into_iter().map(|p| place * p).collect())
    }

    /// Charstring units → font units, by the font's matrices.
    fn place(&self, part: &Subfont) -> Affine {
        /// The library's scale leads to sixty-fourths.
        const PARTS: f64 = 64.0;
        /// It has whole units where its numbers have 65536th parts.
        const WHOLE: f64 = 65536.0;
        let to = self.0.transform(part, None);
        let [a, b, c, d, x, y] = to.matrix.elements().map(Fixed::to_f64);
        let scale = to.scale.map_or(1.0, |s| s.to_f64() / PARTS);
        Affine::scale(scale) * Affine::new([a, b, c, d, WHOLE * x, WHOLE * y])
    }
}
