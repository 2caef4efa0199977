use super::super::{Assembled, Drawn, font};
use super::{Lack, Options, summary};
use crate::assemble;
use crate::types::{Component, Font, Glyph, Info, Label, Outline};
use kurbo::{BezPath, Rect, Shape};

fn drawn(label: &str, rects: &[[f64; 4]]) -> Drawn {
    let path = |&[x0, y0, x1, y1]: &[f64; 4]| Rect::new(x0, y0, x1, y1).to_path(0.1);
    let contours: Vec<BezPath> = rects.iter().map(path).collect();
    Drawn {
        label: Label(label.to_owned()),
        outline: Outline::new(contours).unwrap(),
        plates: Vec::new(),
        advance: None,
    }
}

const DOT: &[[f64; 4]] = &[[0.0, 400.0, 80.0, 480.0]];

/// Dotless beh and hah in all forms, a dot.
fn skeletons() -> Vec<Drawn> {
    let tooth = [[0.0, 0.0, 400.0, 60.0], [200.0, 0.0, 260.0, 300.0]];
    let mut out: Vec<Drawn> = ["uni066E", "uni066E.fina", "uni066E.init", "uni066E.medi"]
        .map(|l| drawn(l, &tooth))
        .into();
    // a stroke with a bowl below that is open to the right
    let bowl = [
        [0.0, 100.0, 500.0, 160.0],
        [0.0, -300.0, 60.0, 160.0],
        [0.0, -300.0, 500.0, -240.0],
    ];
    out.push(drawn("uni062D", &bowl));
    out.push(drawn("uniFBB3", DOT));
    out
}

fn build(drawn: Vec<Drawn>, letters: &[&str]) -> Assembled {
    let letters = letters.iter().map(|l| (*l).to_owned().try_into().unwrap());
    let options = assemble::Options {
        compose: Options {
            letters: letters.collect(),
            ..Options::default()
        },
        ..assemble::Options::default()
    };
    font(drawn, Info::default(), &options).unwrap()
}

fn glyph<'a>(font: &'a Font, name: &str) -> &'a Glyph {
    font.glyph(name).unwrap_or_else(|| panic!("no {name}"))
}

/// Names of a glyph's parts.
fn parts(font: &Font, name: &str) -> Vec<String> {
    let parts = glyph(font, name).components.iter();
    parts.map(|c| c.base.to_string()).collect()
}

/// Boxes of a glyph's parts where they stand.
fn boxes(font: &Font, name: &str) -> Vec<Rect> {
    let placed = |c: &Component| {
        let base = glyph(font, c.base.as_str());
        base.outline.transformed(c.place).bounds().unwrap()
    };
    glyph(font, name).components.iter().map(placed).collect()
}

#[test]
fn dots_make_letters_in_every_form_of_the_skeleton() {
    let font = build(skeletons(), &["ب", "ث", "ج"]).font;
    for form in ["", ".fina", ".init", ".medi"] {
        let body = format!("uni066E{form}");
        assert_eq!(parts(&font, &format!("uni0628{form}")), [&body, "uniFBB3"]);
        let three = [&body, "uniFBB3", "uniFBB3", "uniFBB3"];
        assert_eq!(parts(&font, &format!("uni062B{form}")), three);
    }
    assert_eq!(glyph(&font, "uni0628").codepoints, ['ب']);
    assert!(
        font.glyph("uni062C.init").is_none(),
        "its skeleton is not drawn"
    );
    assert!(
        font.features.contains("sub uni0628 by uni0628.init;"),
        "{}",
        font.features
    );
}

#[test]
fn dots_keep_their_distance() {
    let font = build(skeletons(), &["ب", "ث", "ج"]).font;
    let below = boxes(&font, "uni0628");
    assert!((below[0].y0 - below[1].y1 - 50.0).abs() <= 1.0, "{below:?}");
    let above = boxes(&font, "uni062B");
    for dot in &above[1..] {
        // over the tooth
        assert!(dot.y0 - above[0].y1 >= 49.0, "{above:?}");
    }
    assert!(
        (above[2].x0 - above[1].x1 - 16.0).abs() <= 1.0,
        "a fifth of a dot: {above:?}"
    );
    let bowl = boxes(&font, "uni062C");
    assert!(
        bowl[1].y0 >= -190.0 && bowl[1].y1 <= 50.0,
        "in the bowl: {bowl:?}"
    );
}

#[test]
fn what_is_drawn_wins() {
    let mut all = skeletons();
    all.push(drawn("beh-ar.init", &[[0.0, 0.0, 400.0, 90.0]]));
    all.push(drawn("uniFBB6", &[[0.0, 0.0, 200.0, 180.0]]));
    let font = build(all, &["ب", "ث"]).font;
    assert!(font.glyph("uni0628.init").is_none());
    assert!(parts(&font, "beh-ar.init").is_empty());
    assert!(
        font.features.contains("sub uni0628 by beh-ar.init;"),
        "{}",
        font.features
    );
    assert_eq!(parts(&font, "uni062B"), ["uni066E", "uniFBB6"]);
}

#[test]
fn anchors_by_hand_place_dots() {
    let mut options = assemble::Options::default();
    options.compose.letters = vec!["ت".to_owned().try_into().unwrap()];
    let anchor = [("above".to_owned(), (120.0, 700.0))].into();
    options.anchors.insert("uni066E".to_owned(), anchor);
    let font = font(skeletons(), Info::default(), &options).unwrap().font;
    let all = boxes(&font, "uni062A");
    let dots = all[1].union(all[2]);
    assert!(
        (dots.center().x - 120.0).abs() <= 1.0 && (dots.y0 - 700.0).abs() <= 1.0,
        "{all:?}"
    );
}

#[test]
fn a_missing_part_is_named() {
    let built = build(skeletons(), &["ذ", "persian"]);
    let of = |name: &str| {
        let note = built.notes.iter().find(|n| n.glyph == name);
        note.map_or(String::new(), |n| n.message.clone())
    };
    assert!(
        of("uni0630").contains("its part uni062F (U+062F) is missing"),
        "{}",
        of("uni0630")
    );
    assert!(
        of("uni06AF").contains("made of no other letter"),
        "{}",
        of("uni06AF")
    );
    assert!(of("uni067E").is_empty());
}

#[test]
fn a_mark_whose_place_is_not_known_is_not_called_missing() {
    let o = drawn("o", &[[0.0, 0.0, 400.0, 500.0]]);
    let horn = drawn("uni031B", &[[0.0, 450.0, 80.0, 600.0]]);
    let notes = build(vec![o, horn], &["ơ"]).notes;
    let told = "neither drawn nor composed: no rule says where its part horncmb (U+031B) stands; draw the whole letter";
    assert_eq!(
        notes.iter().map(|n| n.message.as_str()).collect::<Vec<_>>(),
        [told]
    );
    let left = [('ơ', Some(Lack::Place('\u{31b}'))), ('ớ', None)];
    let told = summary("latin", &left).unwrap().message;
    assert!(told.contains("a place for horncmb (U+031B) in 1"), "{told}");
}

/// e, i and j with dots that are pieces, two accents, one of them a sign of its own.
fn latin() -> Vec<Drawn> {
    vec![
        drawn("a", &[[0.0, 0.0, 400.0, 500.0]]),
        drawn("A", &[[0.0, 0.0, 500.0, 700.0]]),
        drawn(
            "V",
            &[[0.0, 600.0, 500.0, 700.0], [200.0, 0.0, 300.0, 600.0]],
        ),
        drawn("i", &[[0.0, 0.0, 80.0, 500.0], [0.0, 600.0, 80.0, 680.0]]),
        drawn("uni0301", &[[0.0, 600.0, 100.0, 700.0]]),
        drawn("circumflex", &[[0.0, 550.0, 260.0, 700.0]]),
        drawn("uni0327", &[[0.0, -200.0, 100.0, -20.0]]),
        drawn("c", &[[0.0, -10.0, 400.0, 500.0]]),
        drawn("n", &[[0.0, 0.0, 80.0, 500.0], [280.0, 0.0, 360.0, 500.0]]),
        drawn("H", &[[0.0, 0.0, 90.0, 700.0], [400.0, 0.0, 490.0, 700.0]]),
    ]
}

#[test]
fn accents_follow_the_decompositions() {
    let built = build(latin(), &["latin"]);
    let [note] = built.notes.as_slice() else {
        panic!("{:?}", built.notes);
    };
    let told = note.message.as_str();
    assert_eq!(note.glyph, "latin");
    let named = told.contains(
        "letters are neither drawn nor composed for lack of O (U+004F) for 35, o (U+006F)",
    );
    assert!(named && told.ends_with(" more"), "{told}");
    for there in ["U+0061", "U+0301", "U+0302"] {
        assert!(!told.contains(there), "{told}");
    }
    let font = built.font;
    assert_eq!(parts(&font, "aacute"), ["a", "uni0301"]);
    assert_eq!(
        parts(&font, "acircumflexacute"),
        ["a", "circumflex", "uni0301"]
    );
    let stacked = boxes(&font, "acircumflexacute");
    assert!(
        stacked[0].y1 < stacked[1].y0 && stacked[1].y1 < stacked[2].y0,
        "{stacked:?}"
    );
    // ı is i without its dot
    assert_eq!(parts(&font, "iacute"), ["dotlessi", "uni0301"]);
    assert_eq!(glyph(&font, "dotlessi").outline.contours().len(), 1);
    assert!(parts(&font, "i").is_empty() && glyph(&font, "i").outline.contours().len() == 2);
    let cedilla = boxes(&font, "ccedilla");
    assert!(
        cedilla[1].y1 > cedilla[0].y0,
        "it grows from the letter: {cedilla:?}"
    );
    assert!(font.glyph("eacute").is_none(), "e is not drawn");
    // î is as wide as its accent at least
    let wide = boxes(&font, "icircumflex");
    let advance = glyph(&font, "icircumflex").advance;
    assert!(
        wide[1].x0 >= 0.0 && wide[1].x1 <= advance,
        "{wide:?} {advance}"
    );
}

#[test]
fn a_mark_above_stands_on_the_letter_where_another_one_is_below() {
    let mut drawn_ones = latin();
    drawn_ones.push(drawn("uni0323", &[[0.0, -200.0, 80.0, -120.0]]));
    let font = build(drawn_ones, &["latin"]).font;
    let both = boxes(&font, "acircumflexdotbelow");
    assert!(
        both[1].y1 < both[0].y0 && both[2].y0 > both[0].y1,
        "{both:?}"
    );
    // and the line is as tall as what was composed
    let tallest = font
        .glyphs()
        .iter()
        .flat_map(|g| boxes(&font, g.name.as_str()));
    let top = tallest.map(|b| b.y1).fold(0.0, f64::max);
    assert!(font.info.metrics.ascender >= top && top > 700.0, "{top}");
}

#[test]
fn a_hacek_beside_a_tall_letter_is_an_apostrophe_and_a_comma_stands_below() {
    let mut shapes = latin();
    shapes.extend([
        drawn(
            "d",
            &[[0.0, 0.0, 300.0, 480.0], [220.0, 480.0, 300.0, 720.0]],
        ),
        drawn("L", &[[0.0, 0.0, 400.0, 90.0], [0.0, 90.0, 90.0, 700.0]]),
        drawn(
            "t",
            &[[60.0, 0.0, 140.0, 600.0], [0.0, 420.0, 220.0, 480.0]],
        ),
        drawn("comma", &[[0.0, -120.0, 80.0, 90.0]]),
    ]);
    let font = build(shapes, &["latin"]).font;
    for (letter, stem, top) in [
        ("dcaron", 300.0, 720.0),
        ("Lcaron", 90.0, 700.0),
        ("tcaron", 140.0, 720.0),
    ] {
        let found = boxes(&font, letter);
        let (body, sign) = (found[0], found[1]);
        assert_eq!(parts(&font, letter)[1], "comma", "{letter}");
        assert!((sign.y1 - top).abs() < 1.5, "{letter}: {sign:?}");
        assert!(
            (sign.x0 - body.x0 - stem - 50.0).abs() < 1.5,
            "{letter}: {sign:?}"
        );
        assert!(
            sign.x1 <= glyph(&font, letter).advance,
            "{letter}: inside its advance"
        );
    }
    let found = font
        .glyphs()
        .iter()
        .find(|g| g.codepoints == ['ņ'])
        .unwrap();
    let ink = boxes(&font, found.name.as_str());
    assert!(ink[1].y1 < ink[0].y0, "clear below: {ink:?}");
    assert!(
        font.glyphs().iter().all(|g| g.codepoints != ['ģ']),
        "no turned comma is drawn"
    );
}

#[test]
fn accents_make_no_ligatures_of_latin_letters() {
    let mut drawn_ones = latin();
    drawn_ones.push(drawn("f_i", &[[0.0, 0.0, 400.0, 700.0]]));
    let font = build(drawn_ones, &["latin"]).font;
    let made = font.glyphs().iter().map(|g| g.name.to_string());
    let with_f: Vec<String> = made.filter(|n| n.starts_with("uni0066")).collect();
    assert!(with_f.is_empty(), "{with_f:?}");
}

#[test]
fn composed_letters_are_kerned_as_their_bodies() {
    let font = build(latin(), &["latin"]).font;
    let group = &font.kerning.second["a"];
    assert!(group.iter().any(|n| n.as_str() == "aacute"), "{group:?}");
    assert!(
        font.kerning
            .pairs
            .contains_key(&("@V".to_owned(), "@a".to_owned())),
        "{:?}",
        font.kerning.pairs
    );
}

#[test]
fn nothing_is_composed_unasked() {
    let font = build(latin(), &[]).font;
    assert!(font.glyphs().iter().all(|g| g.components.is_empty()));
    assert!(font.glyph("dotlessi").is_none());
}
