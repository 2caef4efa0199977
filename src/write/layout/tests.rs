use super::*;
use crate::types::{Anchor, Glyph, Info, Name};
use kurbo::Point;
use write_fonts::dump_table;

/// A font of these glyphs, each a name and its character where it has one, with these features.
fn font(glyphs: &[(&str, Option<char>)], features: &str) -> Font {
    let glyph = |&(name, c): &(&str, Option<char>)| {
        Glyph::new(Name::new(name).unwrap(), c.into_iter().collect(), 500.0)
    };
    let all = [(".notdef", None)];
    let glyphs = all.iter().chain(glyphs).map(glyph).collect();
    let mut font = Font::new(Info::default(), glyphs).unwrap();
    font.features = features.to_owned();
    font
}

fn kern(font: &mut Font, pairs: &[(&str, &str, f64)]) {
    let pairs = pairs
        .iter()
        .map(|(a, b, v)| (((*a).to_owned(), (*b).to_owned()), *v));
    font.kerning.pairs = pairs.collect();
}

#[test]
fn forms_read_as_the_letters_do_that_they_stand_for_whatever_their_names() {
    let glyphs = [
        ("uni0631", Some('ر')),
        ("reh-ar.fina", None),
        ("alef", Some('ا')),
        ("one", Some('١')),
        ("a", Some('a')),
    ];
    let mut font = font(
        &glyphs,
        "feature fina { sub uni0631 by reh-ar.fina; } fina;",
    );
    kern(
        &mut font,
        &[
            ("reh-ar.fina", "reh-ar.fina", -83.0),
            ("one", "one", -20.0),
            ("a", "a", -7.0),
        ],
    );
    let text = text(&font);
    assert!(
        text.contains("pos reh-ar.fina reh-ar.fina <-83 0 -83 0>;"),
        "{text}"
    );
    assert!(
        text.contains("pos one one -20;") && text.contains("pos a a -7;"),
        "{text}"
    );
    assert!(compile(&font).is_ok());
}

#[test]
fn a_comment_is_no_feature_and_a_feature_is_one_however_it_is_spaced() {
    for (own, ours) in [
        ("# our feature kern is measured", true),
        ("feature  kern { pos a a -1; } kern;", false),
    ] {
        let mut font = font(&[("a", Some('a'))], own);
        kern(&mut font, &[("a", "a", -7.0)]);
        assert_eq!(text(&font).contains("pos a a -7;"), ours, "{own}");
    }
}

#[test]
fn rules_of_pairs_stand_as_ufo_ranks_them() {
    let mut font = font(&[("a", Some('a')), ("b", Some('b'))], "");
    let members = |n: &str| vec![Name::new(n).unwrap()];
    font.kerning.first.insert("x".to_owned(), members("a"));
    font.kerning.second.insert("y".to_owned(), members("b"));
    kern(
        &mut font,
        &[
            ("@x", "@y", -4.0),
            ("@x", "b", -3.0),
            ("a", "@y", -2.0),
            ("a", "b", -1.0),
        ],
    );
    let text = text(&font);
    let at = |value: &str| text.find(value).unwrap();
    assert!(
        at(" -1;") < at(" -2;") && at(" -2;") < at(" -3;") && at(" -3;") < at(" -4;"),
        "{text}"
    );
    assert!(compile(&font).is_ok());
}

#[test]
fn a_feature_file_that_stands_alone_stands_beside_ours() {
    let font = font(
        &[("a", Some('a')), ("b", Some('b'))],
        "languagesystem DFLT dflt;\nlanguagesystem arab dflt;\n",
    );
    let more = "languagesystem DFLT dflt;\nlanguagesystem latn TRK; # ours\nfeature ss01 { sub a by b; } ss01;\n";
    check(&font, "own.fea", more).unwrap();
    let joined = with_features(&font, more);
    check(&font, "all.fea", &joined).unwrap_or_else(|e| panic!("{e}\n{joined}"));
    for system in ["DFLT dflt", "arab dflt", "latn TRK"] {
        assert_eq!(
            joined.matches(&format!("languagesystem {system};")).count(),
            1,
            "{joined}"
        );
    }
    assert!(joined.contains("feature ss01"), "{joined}");
}

/// The font with anchors on these glyphs, by glyph.
fn anchored(font: &Font, anchors: &[(&str, &str)]) -> Font {
    font.map_glyphs(|glyph| {
        let own = anchors
            .iter()
            .filter(|(name, _)| *name == glyph.name.as_str());
        let own = own.map(|(_, anchor)| Anchor {
            name: (*anchor).to_owned(),
            at: Point::ZERO,
        });
        Glyph {
            anchors: own.collect(),
            ..glyph.clone()
        }
    })
}

#[test]
fn marks_pass_over_those_of_other_anchors() {
    let marks = [
        ("beh", Some('ب')),
        ("shadda", Some('\u{651}')),
        ("kasra", Some('\u{650}')),
    ];
    let anchors = [
        ("beh", "top"),
        ("shadda", "_top"),
        ("shadda", "top"),
        ("kasra", "_bottom"),
        ("kasra", "bottom"),
    ];
    let font = anchored(&font(&marks, ""), &anchors);
    let text = text(&font);
    for (anchor, mark) in [("top", "shadda"), ("bottom", "kasra")] {
        let lookup = format!(
            "lookup mkmk_mark_{anchor} {{\n        lookupflag UseMarkFilteringSet [{mark}];\n"
        );
        assert!(text.contains(&lookup), "{text}");
    }
    assert!(
        text.contains("lookup mark_base_top {\n        pos base"),
        "{text}"
    );
    let gdef = compile(&font).unwrap().gdef.unwrap();
    assert!(gdef.mark_glyph_sets_def.is_some());
}

#[test]
fn a_combining_character_is_a_mark_without_anchors_too() {
    for (anchors, bases) in [(&[][..], ""), (&[("a", "exit")], "[a]")] {
        let font = anchored(
            &font(&[("a", Some('a')), ("uni0338", Some('\u{338}'))], ""),
            anchors,
        );
        let text = text(&font);
        assert!(
            text.contains(&format!("GlyphClassDef {bases}, , [uni0338], ;")),
            "{text}"
        );
        assert!(compile(&font).is_ok(), "{text}");
    }
}

#[test]
fn numbers_that_no_table_holds_are_errors() {
    let mut kerned = font(&[("a", Some('a'))], "");
    kern(&mut kerned, &[("a", "a", -40000.0)]);
    assert!(
        compile(&kerned)
            .map(drop)
            .unwrap_err()
            .to_string()
            .contains("kerning of a and a")
    );
    let far = font(&[("a", Some('a'))], "").map_glyphs(|g| {
        let mut g = g.clone();
        g.anchors.push(Anchor {
            name: "top".to_owned(),
            at: Point::new(f64::NAN, 1e9),
        });
        g
    });
    assert!(
        compile(&far)
            .map(drop)
            .unwrap_err()
            .to_string()
            .contains("anchor top of")
    );
}

#[test]
fn the_longest_context_is_that_of_the_tables() {
    // the numbers are those of fontTools' `maxCtxFont`
    let many = |body: &str| format!("feature test {{ {body} }} test;");
    let cases = [
        ("", 0),
        ("pos cursive a <anchor 0 0> <anchor 9 0>;", 0),
        ("sub a by b;", 1),
        ("sub a by b c;", 1),
        ("sub a from [b c];", 1),
        ("pos a 10;", 1),
        ("pos a b -10;", 2),
        ("sub a b c by d;", 3),
        ("sub a' b' by c;", 2),
        ("sub d a' b c by b;", 3),
        ("sub d d d a' by b;", 1),
        ("sub [a b] [c d]' [a b c] [a b] by d;", 3),
        ("rsub a' b c d by d;", 4),
        ("rsub a b' by d;", 1),
        ("pos d a' 10 b c d;", 4),
        (
            "lookup one { sub a by b; } one; lookup two useExtension { sub a b c d by a; } two;",
            4,
        ),
    ];
    let glyphs = [
        ("a", Some('a')),
        ("b", Some('b')),
        ("c", Some('c')),
        ("d", Some('d')),
    ];
    for (body, most) in cases {
        let features = if body.is_empty() {
            String::new()
        } else {
            many(body)
        };
        let made = compile(&font(&glyphs, &features)).unwrap();
        let gsub = made
            .gsub
            .map(|t| dump_table(&t).unwrap())
            .unwrap_or_default();
        let gpos = made
            .gpos
            .map(|t| dump_table(&t).unwrap())
            .unwrap_or_default();
        assert_eq!(longest(&gsub, &gpos), most, "{body}");
        let half = |b: &[u8]| b[..b.len() / 2].to_vec();
        assert!(
            longest(&half(&gsub), &half(&gpos)) <= most,
            "{body}, cut off"
        );
    }
}
