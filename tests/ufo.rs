//! UFOs that were written, changed by hands and read again.

use crate::common::desk::Desk;
use crate::convert::{converted, files, font, same};
use khatt::read::{self, ReadError, Reading};
use khatt::types::Metrics;

/// A folder with the small font as a UFO.
fn saved() -> Desk {
    let desk = Desk::new();
    for (name, content) in &files(&font(), "ufo").0 {
        desk.write(&format!("small.ufo/{name}"), content);
    }
    desk
}

#[test]
fn a_damaged_ufo_is_told_by_its_file_and_why() {
    let cases: [(&str, Option<&[u8]>, &str); 8] = [
        (
            "glyphs/O_.glif",
            Some(b"<glyph name='O' format='2'><outline>"),
            "unexpected EOF",
        ),
        ("glyphs/O_.glif", None, "there is no such file"),
        (
            "glyphs/contents.plist",
            Some(b"<plist><dict><key>O"),
            "offset",
        ),
        ("glyphs/contents.plist", None, "cannot find"),
        (
            "fontinfo.plist",
            Some(b"<plist><dict><key>unitsPerEm</key><true/></dict></plist>"),
            "expected",
        ),
        ("lib.plist", Some(b"<plist><array/></plist>"), "dictionary"),
        ("kerning.plist", Some(b"nothing\n"), "expected"),
        ("features.fea", Some(b"# \xff"), "utf-8"),
    ];
    for (name, content, why) in cases {
        let (desk, path) = (saved(), format!("small.ufo/{name}"));
        match content {
            Some(content) => desk.write(&path, content),
            None => desk.remove(&path),
        }
        let said = read::ufo(&desk.path("small.ufo"))
            .expect_err(name)
            .to_string();
        let file = format!("{name} in the UFO cannot be read: ");
        assert!(said.starts_with(&file) && said.contains(why), "{said}");
        assert!(said.contains("; mend it there"), "{said}");
    }
}

/// The small font as a UFO, changed by a hand, and read.
pub(crate) fn by_hand(change: impl FnOnce(&mut norad::Font)) -> Result<Reading, ReadError> {
    let desk = saved();
    let path = desk.path("small.ufo");
    let mut ufo = norad::Font::load(&path).expect("a UFO");
    change(&mut ufo);
    ufo.save(&path).expect("a UFO");
    read::ufo(&path)
}

fn word(text: &str) -> norad::Name {
    norad::Name::new(text).expect("a name")
}

fn kern(ufo: &mut norad::Font, first: &str, second: &str, value: f64) {
    let seconds = ufo.kerning.entry(word(first)).or_default();
    seconds.insert(word(second), value);
}

#[test]
fn a_ufo_comes_back_whole() {
    let reading = by_hand(|_| ()).expect("a UFO");
    same(&reading, 0.6);
    assert_eq!(reading.font.info, font().info);
    assert_eq!(reading.lost, Vec::<String>::new());
    let [after, before] = [&reading.font, &font()].map(|font| files(font, "ufo"));
    assert_eq!(after, before, "contours begin where they began");
}

#[test]
fn kerning_of_what_is_not_there_is_left_out_and_named() {
    let reading = by_hand(|ufo| {
        for (first, second) in [
            ("O", "beh-ar"),
            ("O", "gone"),
            ("public.kern1.none", "O"),
            ("public.kern1.hollow", "O"),
            ("public.kern1.round", "public.kern2.stems"),
        ] {
            kern(ufo, first, second, -40.0);
        }
        for (group, members) in [
            ("public.kern1.round", vec!["O", "Q"]),
            ("public.kern1.hollow", vec!["Q2"]),
            ("public.kern2.stems", vec!["beh-ar"]),
            ("of my own", vec!["O"]),
        ] {
            let members = members.into_iter().map(word).collect();
            ufo.groups.insert(word(group), members);
        }
    })
    .expect("a UFO");
    let kerning = &reading.font.kerning;
    let pairs: Vec<_> = kerning
        .pairs
        .keys()
        .map(|(a, b)| format!("{a} {b}"))
        .collect();
    assert_eq!(pairs, ["@round @stems", "O beh-ar"]);
    let groups: Vec<_> = kerning.first.keys().chain(kerning.second.keys()).collect();
    assert_eq!(groups, ["round", "stems"]);
    converted(&reading.font, "ttf");
    assert_eq!(
        reading.lost,
        [
            "1 groups beside those of kerning: of my own",
            "2 members of kerning groups that are no glyphs: Q2 in public.kern1.hollow, Q in public.kern1.round",
            "3 kerning pairs of glyphs or groups that are not there: O gone, public.kern1.hollow O, \
             public.kern1.none O",
        ]
    );
}

#[test]
fn kerning_groups_get_names_that_features_can_have() {
    let reading = by_hand(|ufo| {
        for (group, member) in [("@A left", "O"), ("_A_left", "beh-ar"), ("ا", "l.alt")] {
            let name = format!("public.kern1.{group}");
            ufo.groups.insert(word(&name), vec![word(member)]);
            kern(ufo, &name, "O", -40.0);
        }
    })
    .expect("a UFO");
    let kerning = &reading.font.kerning;
    let groups: Vec<_> = kerning
        .first
        .iter()
        .map(|(g, m)| format!("{g}: {}", m[0]))
        .collect();
    assert_eq!(groups, ["_: l.alt", "_A_left: beh-ar", "_A_left.1: O"]);
    assert_eq!(kerning.pairs.len(), 3);
    converted(&reading.font, "ttf");
    assert_eq!(reading.lost, Vec::<String>::new());
}

#[test]
fn kerning_and_components_follow_a_glyph_that_is_renamed() {
    let reading = by_hand(|ufo| {
        let mut glyph = norad::Glyph::new("O ring");
        glyph.components.push(norad::Component::new(
            word("O"),
            norad::AffineTransform::default(),
            None,
        ));
        ufo.default_layer_mut().insert_glyph(glyph);
        let mut glyph = norad::Glyph::new("double");
        for base in ["O ring", "gone"] {
            let part = norad::Component::new(word(base), norad::AffineTransform::default(), None);
            glyph.components.push(part);
        }
        ufo.default_layer_mut().insert_glyph(glyph);
        ufo.groups
            .insert(word("public.kern1.g"), vec![word("O ring")]);
        kern(ufo, "public.kern1.g", "O ring", -40.0);
    })
    .expect("a UFO");
    let font = &reading.font;
    assert_eq!(font.kerning.first["g"][0].as_str(), "glyph00004");
    let pair = ("@g".to_owned(), "glyph00004".to_owned());
    assert!(font.kerning.pairs.contains_key(&pair), "{:?}", font.kerning);
    let bases: Vec<_> = font
        .glyph("double")
        .expect("double")
        .components
        .iter()
        .map(|c| c.base.as_str())
        .collect();
    assert_eq!(bases, ["glyph00004"]);
    converted(font, "ttf");
    let said = [
        "a component of double: there is no gone",
        "1 glyph names that are illegal or not unique: O ring",
    ];
    assert_eq!(reading.lost, said);
}

#[test]
fn places_beyond_a_font_are_named() {
    for value in [-40_000.0, 1e10, f64::NAN] {
        let error = by_hand(|ufo| kern(ufo, "O", "beh-ar", value)).expect_err("too far");
        assert!(
            error.to_string().contains("kerning of O and beh-ar"),
            "{error}"
        );
    }
    let error = by_hand(|ufo| {
        let glyph = ufo.default_layer_mut().get_glyph_mut("O").expect("O");
        let top = norad::Anchor::new(320.0, 40_000.0, Some(word("top")), None, None);
        glyph.anchors.push(top);
    })
    .expect_err("too far");
    assert!(error.to_string().contains("anchor top of O"), "{error}");
}

#[test]
fn what_a_ufo_says_for_opentype_counts_and_the_rest_is_named() {
    let reading = by_hand(|ufo| {
        let info = &mut ufo.font_info;
        info.ascender = Some(700.0);
        info.open_type_hhea_ascender = Some(950);
        info.open_type_os2_typo_ascender = Some(950);
        info.open_type_hhea_descender = None;
        info.open_type_os2_typo_descender = Some(-350);
        info.open_type_hhea_line_gap = None;
        info.open_type_os2_typo_line_gap = Some(90);
        info.open_type_os2_vendor_id = Some("ABC".to_owned());
        info.open_type_head_created = Some("2000/02/29 00:00:01".to_owned());
        info.postscript_font_name = Some("Foo-Bar".to_owned());
        info.open_type_os2_type = Some(vec![3]);
        info.trademark = Some("TM".to_owned());
    })
    .expect("a UFO");
    let info = &reading.font.info;
    let wanted = Metrics {
        ascender: 950.0,
        descender: -350.0,
        line_gap: 90.0,
        ..font().info.metrics
    };
    assert_eq!(info.metrics, wanted);
    assert_eq!((info.vendor_id, info.created), (*b"ABC ", 951_782_401));
    assert_eq!(
        reading.lost,
        ["font information (ascender, descender, openTypeOS2Type, trademark)"]
    );
}
