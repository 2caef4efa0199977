//! One SVG a glyph: user space in font units, y down, the box from ascender to descender and as wide as the
//! advance; where that is 0 the box is as wide as the ink, and `data-advance` says so.

use super::WriteError;
use crate::numeric::svg::path_data;
use crate::types::{Files, Font, Glyph, Layer, Name};
use kurbo::Affine;
use std::collections::BTreeSet;

/// Numbers are cut to thousandths of a unit: below what a rasteriser can show.
const PER_UNIT: f64 = 1000.0;

/// A file for every glyph that has ink or a character; colours lie in the glyph whose layers they are.
#[expect(
    clippy::unnecessary_wraps,
    reason = "every writer in the table has one signature"
)]
pub(super) fn files(font: &Font) -> Result<Files, WriteError> {
    let mut files = Files::default();
    let mut taken = BTreeSet::new();
    let layers: BTreeSet<&Name> = font
        .glyphs()
        .iter()
        .flat_map(|g| &g.layers)
        .map(|l| &l.glyph)
        .collect();
    for glyph in font.glyphs() {
        let is_blank = font.shape(glyph).is_empty() && glyph.codepoints.is_empty();
        if is_blank || layers.contains(&glyph.name) {
            continue;
        }
        let name = file_name(glyph.name.as_str(), &mut taken);
        files.0.insert(name, document(font, glyph).into_bytes());
    }
    Ok(files)
}

/// A file name that also a file system without upper and lower case keeps apart: a `_` follows every capital.
fn file_name(glyph: &str, taken: &mut BTreeSet<String>) -> String {
    let mut stem = String::new();
    for (i, c) in glyph.chars().enumerate() {
        stem.push(if i == 0 && c == '.' { '_' } else { c });
        if c.is_ascii_uppercase() {
            stem.push('_');
        }
    }
    while !taken.insert(stem.to_ascii_lowercase()) {
        stem.push('_');
    }
    format!("{stem}.svg")
}

fn document(font: &Font, glyph: &Glyph) -> String {
    let m = font.info.metrics;
    let path = |glyph: &Glyph, fill: &str| {
        let data = path_data(&(Affine::FLIP_Y * font.shape(glyph).to_path()), number);
        format!("  <path{fill} d=\"{data}\"/>\n")
    };
    let layer = |layer: &Layer| {
        let colour = layer.colour.and_then(|c| font.palette.get(c));
        let fill = colour.map(|[r, g, b]| format!(" fill=\"#{r:02x}{g:02x}{b:02x}\""));
        Some(path(
            font.glyph(layer.glyph.as_str())?,
            &fill.unwrap_or_default(),
        ))
    };
    let paths = if glyph.layers.is_empty() {
        path(glyph, "")
    } else {
        glyph.layers.iter().filter_map(layer).collect()
    };
    let (top, height) = (number(-m.ascender), number(m.ascender - m.descender));
    let advance = number(glyph.advance);
    let (left, width, said) = if advance == "0" {
        // a box without a width shows nothing: a mark's goes around its ink
        let ink = font.shape(glyph).bounds().unwrap_or_default();
        let said = format!(" data-advance=\"{advance}\"");
        (number(ink.x0), number(ink.width().max(1.0)), said)
    } else {
        (number(0.0), advance, String::new())
    };
    let view = format!("viewBox=\"{left} {top} {width} {height}\"{said}");
    format!("<svg xmlns=\"http://www.w3.org/2000/svg\" {view}>\n{paths}</svg>\n")
}

fn number(v: f64) -> String {
    let cut = (v * PER_UNIT).round() / PER_UNIT;
    // no "-0"
    format!("{}", cut + 0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_collide_without_case() {
        let mut taken = BTreeSet::new();
        let names: Vec<_> = ["a", "A", "A_", ".notdef"]
            .iter()
            .map(|n| file_name(n, &mut taken))
            .collect();
        assert_eq!(names, ["a.svg", "A_.svg", "A__.svg", "_notdef.svg"]);
    }

    #[test]
    fn numbers_are_short_and_never_minus_zero() {
        assert_eq!(number(-0.0001), "0");
        assert_eq!(number(1.23456), "1.235");
        assert_eq!(number(12.0), "12");
    }
}
