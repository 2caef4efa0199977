//! Written fonts, read back by two independent readers and set by a shaper.

use crate::common::desk::Desk;
use crate::common::read::{face, placed, set, set_with, skrifa_outline, ttf_parser_outline};
use khatt::assemble::{self, Drawn};
use khatt::quadratic::Method;
use khatt::types::{Files, Font, Info, Label, Outline};
use khatt::write::{self, Curves};
use kurbo::{Circle, Ellipse, Rect, Shape};
use skrifa::raw::TableProvider;
use skrifa::{FontRef, GlyphId, MetadataProvider};

/// Letters of the test font: text, and the forms that Arabic needs.
const LABELS: &[&str] = &[
    "A",
    "o",
    "g",
    "n",
    "space",
    "é",
    "f",
    "i",
    "f_i",
    "alef-ar",
    "alef-ar.fina",
    "beh-ar",
    "beh-ar.init",
    "beh-ar.medi",
    "beh-ar.fina",
    "seen-ar",
    "seen-ar.init",
    "seen-ar.medi",
    "seen-ar.fina",
    "meem-ar",
    "meem-ar.init",
    "meem-ar.medi",
    "meem-ar.fina",
    "lam-ar",
    "lam-ar.init",
    "lam-ar.medi",
    "lam-ar.fina",
    "heh-ar",
    "heh-ar.init",
    "heh-ar.medi",
    "heh-ar.fina",
    "lam_alef-ar",
    "lam_alef-ar.fina",
    "u1F600",
];

/// A shape of lines, cubics and a hole, different for every glyph.
fn shape(seed: u32) -> Outline {
    let k = f64::from(seed);
    let mut ring = Ellipse::new((300.0, 250.0), (180.0 + 3.0 * k, 150.0 + k), 0.1 * k).to_path(0.1);
    let hole = Circle::new((300.0, 250.0), 60.0)
        .to_path(0.1)
        .reverse_subpaths();
    ring.close_path();
    let foot = Rect::new(80.0 - 5.0 * k, -40.0 - 0.1 * k, 560.0 + k, 20.5).to_path(0.1);
    Outline::new(vec![ring, hole, foot]).expect("closed contours")
}

fn font() -> Font {
    let drawn = (0..).zip(LABELS).map(|(i, label)| Drawn {
        label: Label((*label).to_owned()),
        outline: shape(i),
        plates: Vec::new(),
        advance: None,
    });
    let info = Info {
        family: "Khatt Test".to_owned(),
        ..Info::default()
    };
    let built = assemble::font(drawn.collect(), info, &assemble::Options::default());
    let built = built.expect("a font of these letters");
    assert!(built.notes.is_empty(), "{:?}", built.notes);
    built.font
}

/// The files of a format, with the curves that it asks for.
fn files(font: &Font, name: &str) -> Files {
    let format = write::format(name).expect("a known format");
    let font = match format.curves {
        Curves::Cubic => font.clone(),
        Curves::Quadratic => font
            .try_map_outlines(|g| Method::default().convert(&g.outline, 0.5))
            .expect("quadratics"),
    };
    (format.write)(&font).expect("a written font")
}

/// The one file of a format.
pub(crate) fn single(font: &Font, name: &str) -> Vec<u8> {
    files(font, name).0.remove("").expect("one file")
}

#[test]
fn both_readers_find_what_was_written() {
    let font = font();
    for format in ["ttf", "otf"] {
        let bytes = single(&font, format);
        let first = FontRef::new(&bytes).expect("skrifa reads it");
        let second = face(&bytes);
        assert_eq!(usize::from(second.number_of_glyphs()), font.glyphs().len());
        for (id, glyph) in (0_u16..).zip(font.glyphs()) {
            let wanted = font.shape(glyph).to_path();
            for read in [
                skrifa_outline(&first, GlyphId::new(u32::from(id))),
                ttf_parser_outline(&second, ttf_parser::GlyphId(id)),
            ] {
                // TrueType runs the other way round, and rounds to whole units
                let area = read.area() * if format == "ttf" { -1.0 } else { 1.0 };
                let perimeter = wanted.perimeter(0.1);
                assert!(
                    (area - wanted.area()).abs() <= perimeter,
                    "{format} {}",
                    glyph.name
                );
                let (a, b) = (read.bounding_box(), wanted.bounding_box());
                let off = (a.x0 - b.x0)
                    .abs()
                    .max((a.y1 - b.y1).abs())
                    .max((a.x1 - b.x1).abs());
                assert!(off <= 1.5, "{format} {}: {a:?} {b:?}", glyph.name);
            }
            let advance = second.glyph_hor_advance(ttf_parser::GlyphId(id));
            assert_eq!(
                advance.map(f64::from),
                Some(glyph.advance),
                "{format} {}",
                glyph.name
            );
            for &c in &glyph.codepoints {
                let (a, b) = (first.charmap().map(c), second.glyph_index(c));
                assert_eq!(
                    a,
                    Some(GlyphId::new(u32::from(id))),
                    "{format} U+{:04X}",
                    u32::from(c)
                );
                assert_eq!(
                    b,
                    Some(ttf_parser::GlyphId(id)),
                    "{format} U+{:04X}",
                    u32::from(c)
                );
            }
            assert_eq!(
                second.glyph_name(ttf_parser::GlyphId(id)),
                Some(glyph.name.as_str())
            );
        }
    }
}

#[test]
fn left_bearings_are_the_left_edges() {
    let font = font();
    for format in ["ttf", "otf"] {
        let bytes = single(&font, format);
        let face = face(&bytes);
        for id in 0..face.number_of_glyphs() {
            let bearing = face.glyph_hor_side_bearing(ttf_parser::GlyphId(id));
            let edge = match format {
                // glyf says its own edge: that of the points
                "ttf" => face
                    .glyph_bounding_box(ttf_parser::GlyphId(id))
                    .map_or(0.0, |b| f64::from(b.x_min)),
                _ => Some(ttf_parser_outline(&face, ttf_parser::GlyphId(id)))
                    .filter(|path| !path.elements().is_empty())
                    .map_or(0.0, |path| path.bounding_box().x0),
            };
            let bearing = f64::from(bearing.expect("a bearing"));
            assert!(
                (-0.02..1.02).contains(&(edge - bearing)),
                "{format} {id}: {bearing}, {edge}"
            );
        }
    }
}

#[test]
fn the_longest_context_is_told() {
    for format in ["ttf", "otf"] {
        let bytes = single(&font(), format);
        let os2 = FontRef::new(&bytes).expect("a font").os2();
        // f i and lam alef
        assert_eq!(os2.expect("OS/2").us_max_context(), Some(2), "{format}");
    }
}

#[test]
fn arabic_joins() {
    let font = font();
    for format in ["ttf", "otf"] {
        let bytes = single(&font, format);
        let names = |text| set(&bytes, text);
        assert_eq!(
            names("بسم"),
            ["meem-ar.fina", "seen-ar.medi", "beh-ar.init"],
            "{format}"
        );
        assert_eq!(names("لا"), ["lam_alef-ar"], "{format}");
        assert_eq!(names("بلا"), ["lam_alef-ar.fina", "beh-ar.init"], "{format}");
        assert_eq!(
            names("اب ب"),
            ["beh-ar", "space", "beh-ar", "alef-ar"],
            "{format}"
        );
        assert_eq!(names("fi"), ["f_i"], "{format}");
    }
}

/// Boxes with these labels as a font.
fn boxes(drawn: &[(&str, [f64; 4])]) -> Font {
    let one = |(label, [x0, y0, x1, y1]): &(&str, [f64; 4])| Drawn {
        label: Label((*label).to_owned()),
        outline: Outline::new(vec![Rect::new(*x0, *y0, *x1, *y1).to_path(0.1)]).expect("closed"),
        plates: Vec::new(),
        advance: None,
    };
    let drawn = drawn.iter().map(one).collect();
    let built = assemble::font(drawn, Info::default(), &assemble::Options::default());
    built.expect("a font of these letters").font
}

#[test]
fn ligatures_and_small_capitals_are_found_in_text() {
    let labels = LABELS.iter().copied();
    let more = ["الله", "reh-ar", "f.smcp", "i.smcp"];
    let all: Vec<_> = labels
        .chain(more)
        .map(|l| (l, [0.0, 0.0, 400.0, 60.0]))
        .collect();
    let bytes = single(&boxes(&all), "otf");
    assert_eq!(set(&bytes, "الله"), ["uni0627064406440647"]);
    assert_eq!(set(&bytes, "رالله"), ["uni0627064406440647", "reh-ar"]);
    let joined = [
        "heh-ar.fina",
        "lam-ar.medi",
        "lam-ar.init",
        "alef-ar.fina",
        "beh-ar.init",
    ];
    assert_eq!(set(&bytes, "بالله"), joined);
    assert_eq!(set(&bytes, "fi"), ["f_i"]);
    let small = set_with(&bytes, "fi", &["smcp"]);
    assert_eq!(small, ["f.smcp", "i.smcp"]);
}

#[test]
fn marks_stand_on_those_of_their_side_and_soft_dots_go() {
    let square = [0.0, 0.0, 100.0, 100.0];
    let all = [
        ("beh-ar", [0.0, 0.0, 400.0, 200.0]),
        ("shadda-ar", [0.0, 300.0, 100.0, 400.0]),
        ("kasra-ar", [0.0, -200.0, 100.0, -100.0]),
        ("uni06E2", [0.0, 300.0, 100.0, 400.0]),
        ("i", [0.0, 0.0, 100.0, 600.0]),
        ("j", [0.0, -200.0, 100.0, 600.0]),
        ("dotlessi", square),
        ("uni0237", square),
        ("uni012F", square),
        ("uni0328", [0.0, -100.0, 50.0, 0.0]),
        ("uni0323", [0.0, -200.0, 100.0, -100.0]),
        ("acutecomb", [0.0, 600.0, 100.0, 700.0]),
    ];
    let font = boxes(&all);
    for format in ["ttf", "otf"] {
        let bytes = single(&font, format);
        for (text, glyphs) in [
            ("j\u{301}", &["uni0237", "acutecomb"][..]),
            ("i\u{323}\u{301}", &["dotlessi", "uni0323", "acutecomb"]),
            ("į\u{301}", &["dotlessi", "uni0328", "acutecomb"]),
            ("ij", &["i", "j"]),
        ] {
            assert_eq!(set(&bytes, text), glyphs, "{format} {text}");
        }
        let name = |id: usize| font.glyphs()[id].name.as_str();
        let placed = placed(&bytes, "ب\u{651}\u{650}\u{6e2}");
        let height = |mark: &str| placed.iter().find(|g| name(g.0) == mark).map(|g| g.3);
        let (low, high) = (height("shadda-ar"), height("uni06E2"));
        assert_eq!(
            high.zip(low).map(|(high, low)| high - low),
            Some(140),
            "{placed:?}"
        );
    }
}

#[test]
fn the_same_font_gives_the_same_bytes() {
    for format in write::FORMATS {
        let (a, b) = (files(&font(), format.name), files(&font(), format.name));
        assert!(!a.0.is_empty() && a == b, "{}", format.name);
    }
}

#[test]
fn woff2_holds_the_same_font() {
    let font = font();
    let (ttf, woff2) = (single(&font, "ttf"), single(&font, "woff2"));
    assert!(woff2.len() < ttf.len(), "{} of {}", woff2.len(), ttf.len());
    let back = wuff::decompress_woff2(&woff2).expect("a WOFF2 file");
    let (a, b) = (
        FontRef::new(&ttf).expect("a font"),
        FontRef::new(&back).expect("a font"),
    );
    for id in 0..u32::try_from(font.glyphs().len()).expect("few glyphs") {
        let [a, b] = [&a, &b].map(|f| skrifa_outline(f, GlyphId::new(id)));
        assert_eq!(a, b, "glyph {id}");
    }
}

#[test]
fn ufo_opens_with_everything_in_it() {
    let font = font();
    let files = files(&font, "ufo");
    let desk = Desk::new();
    for (path, bytes) in &files.0 {
        desk.write(&format!("test.ufo/{path}"), bytes);
    }
    let ufo = norad::Font::load(desk.path("test.ufo")).expect("norad opens it");
    assert_eq!(ufo.glyph_count(), font.glyphs().len());
    assert_eq!(ufo.features, font.features);
    for glyph in font.glyphs() {
        let read = ufo.get_glyph(glyph.name.as_str()).expect("every glyph");
        assert!((read.width - glyph.advance).abs() < 1e-9, "{}", glyph.name);
        let area: f64 = read
            .contours
            .iter()
            .map(|c| c.to_kurbo().expect("a contour").area())
            .sum();
        assert!(
            (area - glyph.outline.to_path().area()).abs() < 1e-3,
            "{}",
            glyph.name
        );
    }
}

#[test]
fn cubics_are_refused_where_there_are_none() {
    let ttf = write::format("ttf").expect("a known format");
    let error = (ttf.write)(&font()).expect_err("cubics");
    assert!(error.to_string().contains("convert them first"), "{error}");
}

#[test]
fn a_shape_beyond_the_format_is_an_error() {
    let far = Rect::new(0.0, 0.0, 40_000.0, 10.0).to_path(0.1);
    let drawn = vec![Drawn {
        label: Label("A".to_owned()),
        outline: Outline::new(vec![far]).expect("closed"),
        plates: Vec::new(),
        advance: None,
    }];
    let font = assemble::font(drawn, Info::default(), &assemble::Options::default())
        .expect("a font")
        .font;
    for format in ["ttf", "otf"] {
        let format = write::format(format).expect("a known format");
        let error = (format.write)(&font).expect_err("too wide");
        assert!(
            error.to_string().contains("a coordinate of A is 80100"),
            "{error}"
        );
    }
}

#[test]
fn a_feature_that_does_not_compile_names_its_line() {
    let mut font = font();
    font.features =
        "languagesystem DFLT dflt;\nfeature liga {\n    sub A by nothing;\n} liga;\n".to_owned();
    let otf = write::format("otf").expect("a known format");
    let error = (otf.write)(&font).expect_err("no such glyph").to_string();
    assert!(error.contains("nothing") && error.contains("3"), "{error}");
}
