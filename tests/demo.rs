//! The demo sheets: every glyph in its place, a few outlines and the fonts' tables approved, text that joins.

use crate::common::approved;
use crate::common::demo::{self, Demo, output};
use crate::common::read::{set, skrifa_outline};
use khatt::assemble::names;
use khatt::pipeline::Built;
use khatt::write;
use kurbo::{PathEl, PathSeg, Point};
use skrifa::{FontRef, GlyphId, MetadataProvider, raw::TableProvider};
use std::fmt::Write;

/// Tables with their sizes left out where they are coded, characters and advances: what a font says of itself.
fn dump(bytes: &[u8]) -> String {
    let font = FontRef::new(bytes).expect("a font");
    let mut out = String::new();
    let mut line = |text: String| writeln!(out, "{text}").expect("a String takes everything");
    let tags = font.table_directory.table_records().iter();
    line(format!(
        "tables: {}",
        tags.map(|r| r.tag().to_string())
            .collect::<Vec<_>>()
            .join(" ")
    ));
    let head = font.head().expect("head");
    line(format!("units per em: {}", head.units_per_em()));
    let os2 = font.os2().expect("OS/2");
    line(format!(
        "line: {} {} {}, weight {}",
        os2.s_typo_ascender(),
        os2.s_typo_descender(),
        os2.s_typo_line_gap(),
        os2.us_weight_class()
    ));
    let gsub = font.gsub().map(|g| g.feature_list().expect("features"));
    let features = gsub.map(|list| {
        let tags = list.feature_records().iter();
        tags.map(|r| r.feature_tag().to_string())
            .collect::<Vec<_>>()
    });
    line(format!("GSUB: {}", features.unwrap_or_default().join(" ")));
    line(format!(
        "glyphs: {}",
        font.maxp().expect("maxp").num_glyphs()
    ));
    for (c, id) in font.charmap().mappings() {
        line(format!("U+{c:04X} → {}", id.to_u32()));
    }
    out
}

/// Whether a curve is its own chord.
fn is_straight(curve: PathSeg) -> bool {
    let c = curve.to_cubic();
    let off = |p: Point| (c.p3 - c.p0).cross(p - c.p0).abs();
    !matches!(curve, PathSeg::Line(_)) && off(c.p1).max(off(c.p2)) < 1e-6
}

/// Outlines of a few glyphs, font units to two decimals, a segment a line.
fn outlines(built: &Built, names: &[&str]) -> String {
    let mut out = String::new();
    for name in names {
        let glyph = built.font.glyph(name).expect("a glyph of the sheet");
        writeln!(out, "{name}, advance {:.2}", glyph.advance).expect("a String takes everything");
        for el in glyph.outline.to_path().elements() {
            let (word, points) = match *el {
                PathEl::MoveTo(p) => ("move", vec![p]),
                PathEl::LineTo(p) => ("line", vec![p]),
                PathEl::QuadTo(a, p) => ("quad", vec![a, p]),
                PathEl::CurveTo(a, b, p) => ("curve", vec![a, b, p]),
                PathEl::ClosePath => ("close", vec![]),
            };
            let points = points.iter().map(|p| format!(" {:.2},{:.2}", p.x, p.y));
            writeln!(out, "  {word}{}", points.collect::<String>())
                .expect("a String takes everything");
        }
    }
    out
}

#[test]
fn the_latin_sheet() {
    let Demo { built, outputs, .. } = demo::built("latin");
    assert_eq!(built.letters.len(), 89);
    for c in "AZaz09.&@$_".chars() {
        let name = names::name_of(&[c]);
        let glyph = built.font.glyph(&name).expect("a glyph of the sheet");
        assert_eq!(glyph.codepoints, [c], "{name}");
        assert!(!glyph.outline.is_empty(), "{name}");
    }
    let drawn = outlines(built, &["A", "g", "i", "ampersand"]);
    approved::check("outlines", "latin", &drawn);
    let metrics = built.font.info.metrics;
    assert!((620.0..690.0).contains(&metrics.cap_height), "{metrics:?}");
    assert!((370.0..430.0).contains(&metrics.x_height), "{metrics:?}");
    for ending in ["ttf", "otf"] {
        let bytes = output(outputs, ending);
        approved::check("fonts", &format!("latin-{ending}"), &dump(bytes));
    }
    let font = FontRef::new(output(outputs, "otf")).expect("a font");
    for (c, id) in font.charmap().mappings() {
        let path = skrifa_outline(&font, id);
        let straight = path.segments().filter(|s| is_straight(*s)).count();
        assert_eq!(straight, 0, "U+{c:04X}");
    }
}

#[test]
fn the_arabic_sheets_join() {
    let Demo { built, outputs, .. } = demo::built("arabic");
    assert_eq!(built.letters.len(), 119);
    let drawn = outlines(built, &["uni0628", "uni0639.medi", "uni06440627.fina"]);
    approved::check("outlines", "arabic", &drawn);
    for ending in ["ttf", "otf"] {
        let bytes = output(outputs, ending);
        approved::check("fonts", &format!("arabic-{ending}"), &dump(bytes));
        let shaped = set(bytes, "بسم الله لا خط");
        let want = [
            "uni0637.fina",
            "uni062E.init",
            "space",
            "uni06440627",
            "space",
            "uni0647.fina",
            "uni0644.medi",
            "uni0644.init",
            "uni0627",
            "space",
            "uni0645.fina",
            "uni0633.medi",
            "uni0628.init",
        ];
        assert_eq!(shaped, want, "{ending}");
        let font = FontRef::new(bytes).expect("a font");
        assert_ne!(font.charmap().map('ب'), Some(GlyphId::NOTDEF));
    }
    assert!(write::layout::text(&built.font).contains("feature rlig"));
}
