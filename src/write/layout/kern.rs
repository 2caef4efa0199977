//! Kerning as a feature: which pairs read from the right, and in which order rules stand.

use super::{SOURCE, compiled};
use crate::types::Font;
use read_fonts::collections::IntSet;
use read_fonts::tables::gsub::Gsub;
use read_fonts::types::GlyphId;
use read_fonts::{FontData, FontRead};
use std::collections::BTreeSet;
use unicode_bidi::{BidiClass, bidi_class};
use write_fonts::dump_table;

/// Pairs of glyphs first, then a glyph and a group, a group and a glyph, and groups: the first rule that fits counts,
/// and so UFO ranks them.
pub(super) fn feature(font: &Font) -> String {
    let kerning = &font.kerning;
    let leftward = leftward(font);
    let mut out = String::from("\n");
    for (number, groups) in [(1, &kerning.first), (2, &kerning.second)] {
        for (group, members) in groups {
            let members: Vec<&str> = members.iter().map(|m| m.as_str()).collect();
            out += &format!("@kern{number}.{group} = [{}];\n", members.join(" "));
        }
    }
    let mut rules = [String::new(), String::new()];
    let side = |side: &str, number: u8| match side.strip_prefix('@') {
        Some(group) => format!("@kern{number}.{group}"),
        None => side.to_owned(),
    };
    let is_group = |side: &str| side.starts_with('@');
    let mut pairs: Vec<_> = kerning.pairs.iter().collect();
    pairs.sort_by_key(|((first, second), _)| (is_group(first), is_group(second)));
    for ((first, second), value) in pairs {
        let mixed = is_group(first) != is_group(second);
        let keyword = if mixed { "enum pos" } else { "pos" };
        let from_right = leftward.contains(first) || leftward.contains(second);
        let (first, second, value) = (side(first, 1), side(second, 2), value.round());
        if from_right {
            // the first letter stands right of the second: it moves, and what came before it follows
            rules[1] += &format!("        {keyword} {first} {second} <{value} 0 {value} 0>;\n");
        } else {
            rules[0] += &format!("        {keyword} {first} {second} {value};\n");
        }
    }
    out += "feature kern {\n";
    for (name, rules) in ["kern_rightward", "kern_leftward"].iter().zip(&rules) {
        if !rules.is_empty() {
            out += &format!(
                "    lookup {name} {{\n        lookupflag IgnoreMarks;\n{rules}    }} {name};\n"
            );
        }
    }
    out + "} kern;\n"
}

/// The sides of pairs, as these name them, whose letters read from the right.
fn leftward(font: &Font) -> BTreeSet<String> {
    let glyphs = from_right(font);
    let kerning = &font.kerning;
    let groups = kerning.first.iter().chain(&kerning.second);
    let groups = groups.filter(|(_, members)| members.iter().any(|m| glyphs.contains(m.as_str())));
    let groups = groups.map(|(name, _)| format!("@{name}"));
    let names: BTreeSet<String> = groups.collect();
    names
        .into_iter()
        .chain(glyphs.into_iter().map(str::to_owned))
        .collect()
}

/// The glyphs of characters that read from the right, and all that substitutions make of them. Digits do not: also
/// among Arabic letters they stand from left to right.
fn from_right(font: &Font) -> BTreeSet<&str> {
    let reads_so = |c: &char| matches!(bidi_class(*c), BidiClass::R | BidiClass::AL);
    let glyphs = font.glyphs();
    let encoded = (0u32..)
        .zip(glyphs)
        .filter(|(_, g)| g.codepoints.iter().any(reads_so));
    let mut reached: IntSet<GlyphId> = encoded.map(|(i, _)| GlyphId::new(i)).collect();
    if let Some(gsub) = substitutions(font) {
        let all = IntSet::all();
        let closed =
            Gsub::read(FontData::new(&gsub)).and_then(|t| t.closure_glyphs(&all, &mut reached));
        debug_assert!(closed.is_ok(), "a table that was just made can be read");
    }
    (0u32..)
        .zip(glyphs)
        .filter(|(i, _)| reached.contains(GlyphId::new(*i)))
        .map(|(_, g)| g.name.as_str())
        .collect()
}

/// GSUB of the font's own features; `None` where they have no substitution or do not compile, which the compiler of
/// all features says.
fn substitutions(font: &Font) -> Option<Vec<u8>> {
    let made = compiled(font, SOURCE, &font.features).ok()?;
    dump_table(made.gsub.as_ref()?).ok()
}
