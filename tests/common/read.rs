//! Fonts as readers and shapers see them.

use harfrust::{Feature, ShapeOptions, ShaperData, UnicodeBuffer};
use khatt::read::Pen;
use kurbo::BezPath;
use skrifa::outline::{DrawSettings, OutlinePen};
use skrifa::prelude::{LocationRef, Size};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use ttf_parser::Face;

/// A glyph's outline as skrifa reads it; of CFF numbers it keeps whole units only.
pub(crate) fn skrifa_outline(font: &FontRef<'_>, id: GlyphId) -> BezPath {
    let mut pen = Pen::default();
    if let Some(glyph) = font.outline_glyphs().get(id) {
        let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        glyph.draw(settings, &mut pen).expect("a readable outline");
    }
    pen.path()
}

/// The same pen in the hand of ttf-parser.
#[derive(Default)]
struct TtfPen(Pen);

impl ttf_parser::OutlineBuilder for TtfPen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.move_to(x, y);
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.0.line_to(x, y);
    }
    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.0.quad_to(cx, cy, x, y);
    }
    fn curve_to(&mut self, ax: f32, ay: f32, bx: f32, by: f32, x: f32, y: f32) {
        self.0.curve_to(ax, ay, bx, by, x, y);
    }
    fn close(&mut self) {
        self.0.close();
    }
}

pub(crate) fn face(bytes: &[u8]) -> Face<'_> {
    Face::parse(bytes, 0).expect("ttf-parser reads it")
}

/// A glyph's outline as ttf-parser reads it.
pub(crate) fn ttf_parser_outline(face: &Face<'_>, id: ttf_parser::GlyphId) -> BezPath {
    let mut pen = TtfPen::default();
    // an empty glyph has no box, which is no failure
    let _ = face.outline_glyph(id, &mut pen);
    pen.0.path()
}

/// The outline of a character that the font has.
pub(crate) fn drawn(face: &Face<'_>, c: char) -> BezPath {
    let id = face.glyph_index(c).expect("a character of the font");
    ttf_parser_outline(face, id)
}

/// Glyph, advance and shift of a text as a shaper sets it, in visual order.
pub(crate) fn placed(bytes: &[u8], text: &str) -> Vec<(usize, i32, i32, i32)> {
    placed_with(bytes, text, &[])
}

/// The same with these features turned on.
fn placed_with(bytes: &[u8], text: &str, features: &[&str]) -> Vec<(usize, i32, i32, i32)> {
    let font = FontRef::new(bytes).expect("a font");
    let data = ShaperData::new(&font);
    let mut buffer = UnicodeBuffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    let shaper = data.shaper(&font).build();
    let features = features.iter().map(|f| f.parse().expect("a feature"));
    let features: Vec<Feature> = features.collect();
    let options = ShapeOptions::default().features(&features);
    let shaped = shaper.shape(buffer, options);
    let glyphs = shaped.glyph_infos().iter().zip(shaped.glyph_positions());
    let one = |(i, p): (&harfrust::GlyphInfo, &harfrust::GlyphPosition)| {
        (i.glyph_id as usize, p.x_advance, p.x_offset, p.y_offset)
    };
    glyphs.map(one).collect()
}

/// The names of the glyphs that a text is set with, in visual order.
pub(crate) fn set(bytes: &[u8], text: &str) -> Vec<String> {
    set_with(bytes, text, &[])
}

/// The same with these features turned on.
pub(crate) fn set_with(bytes: &[u8], text: &str, features: &[&str]) -> Vec<String> {
    let face = face(bytes);
    let name = |id: usize| {
        let id = u16::try_from(id).expect("a glyph of the font");
        face.glyph_name(ttf_parser::GlyphId(id)).map(str::to_owned)
    };
    let glyphs = placed_with(bytes, text, features).into_iter();
    glyphs.map(|g| name(g.0).unwrap_or_default()).collect()
}
