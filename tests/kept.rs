//! What a conversion keeps of its source, chooses from it, and names where it cannot.

use crate::common::desk::Desk;
use crate::convert::{converted, font, glyph, patched, path, table, variable, written};
use crate::ufo::by_hand;
use khatt::read::{self, ReadError, Reading};
use khatt::types::{Anchor, Font};
use khatt::write::layout;
use kurbo::{Point, Rect, Shape};
use write_fonts::read::{FontRef, TableProvider};
use write_fonts::types::Tag;

#[test]
fn fields_that_do_not_follow_from_outlines_come_through() {
    /// Version, dates and style of `head`; heights and slope of `hhea`; slope, underline and pitch of `post`.
    const FIELDS: [(&[u8; 4], usize, usize); 7] = [
        (b"head", 4, 8),
        (b"head", 20, 36),
        (b"head", 44, 50),
        (b"hhea", 4, 10),
        (b"hhea", 18, 24),
        (b"post", 4, 16),
        (b"OS/2", 4, 78),
    ];
    let ttf = written("ttf");
    let changed = [b"head", b"hhea", b"post", b"OS/2"].map(|tag| {
        let mut data = table(&ttf, tag);
        for (_, from, to) in FIELDS.iter().filter(|f| f.0 == tag) {
            data[*from..*to]
                .iter_mut()
                .zip(1..)
                .for_each(|(b, k)| *b = k);
        }
        if tag == b"head" {
            // all styles that there are
            data[44..46].copy_from_slice(&[0, 0b0111_1111]);
        }
        (tag, data)
    });
    let before = patched(&ttf, &changed);
    let mut after = before.clone();
    for format in ["otf", "ttf", "woff2", "otf"] {
        let read = read::font(&after, None, &[]).expect("a font").font;
        after = converted(&read, format);
        if format == "woff2" {
            continue;
        }
        for (tag, from, to) in FIELDS {
            let [was, is] = [&before, &after].map(|file| table(file, tag)[from..to].to_vec());
            assert_eq!(was, is, "{} {from} in {format}", Tag::new(tag));
        }
    }
}

#[test]
fn a_place_on_an_axis_has_its_weight_and_name() {
    let bytes = variable();
    for (place, class, style, bold) in [
        (400.0, 400, "Regular", false),
        // the one of its named instances
        (550.0, 550, "Small", false),
        (650.0, 650, "wght650", false),
        (700.0, 700, "Bold", true),
    ] {
        let at = [("wght".to_owned(), place)];
        let read = read::font(&bytes, None, &at).expect("a font").font;
        assert_eq!((read.info.weight, read.info.style.as_str()), (class, style));
        for to in ["ttf", "otf"] {
            let file = converted(&read, to);
            let tables = FontRef::new(&file).expect("a font");
            let (os2, head) = (tables.os2().expect("OS/2"), tables.head().expect("head"));
            assert_eq!(os2.us_weight_class(), class, "{to} {place}");
            assert_eq!(
                os2.fs_selection().bits() & 1 << 5 != 0,
                bold,
                "{to} {place}"
            );
            assert_eq!(head.mac_style().bits() & 1 != 0, bold, "{to} {place}");
            let again = read::font(&file, None, &[]).expect("a font").font;
            assert_eq!(again.info.style, style, "{to}");
            let name = tables.name().expect("names");
            let full = name
                .name_record()
                .iter()
                .find(|r| r.name_id().to_u16() == 4);
            let full = full
                .expect("a full name")
                .string(name.string_data())
                .expect("text");
            assert_eq!(full.to_string(), format!("Small {style}"), "{to}");
        }
    }
    let beyond = read::font(&bytes, None, &[("wght".to_owned(), 9000.0)]).expect_err("too far");
    assert!(beyond.to_string().contains("from 400 to 700"), "{beyond}");
    let none = read::font(&written("ttf"), None, &[("wght".to_owned(), 700.0)]);
    assert!(matches!(none, Err(ReadError::NoAxes(_))), "{none:?}");
}

/// A collection: offsets of a font's tables are the file's.
fn collection(fonts: &[Vec<u8>]) -> Vec<u8> {
    let long = |n: usize| u32::try_from(n).expect("32 bits").to_be_bytes();
    let (mut head, mut body) = (b"ttcf\0\x01\0\0".to_vec(), Vec::new());
    head.extend(long(fonts.len()));
    let start = head.len() + 4 * fonts.len();
    for font in fonts {
        let at = start + body.len();
        head.extend(long(at));
        let mut font = font.clone();
        for record in 0..usize::from(u16::from_be_bytes([font[4], font[5]])) {
            let place = 12 + 16 * record + 8;
            let old: [u8; 4] = font[place..place + 4].try_into().expect("four bytes");
            let old = usize::try_from(u32::from_be_bytes(old)).expect("a place");
            font[place..place + 4].copy_from_slice(&long(old + at));
        }
        body.extend(font);
    }
    [head, body].concat()
}

#[test]
fn one_font_of_a_collection_is_chosen() {
    let mut other = font();
    other.info.family = "Other".to_owned();
    let both = collection(&[written("ttf"), converted(&other, "otf")]);
    let family =
        |face: Option<&str>| Ok::<_, ReadError>(read::font(&both, face, &[])?.font.info.family);
    for (face, wanted) in [
        ("1", "Small"),
        ("2", "Other"),
        ("other regular", "Other"),
        ("Small-Regular", "Small"),
    ] {
        assert_eq!(family(Some(face)).expect("a font"), wanted, "{face}");
    }
    let known = "1 Small Regular, 2 Other Regular";
    for face in [None, Some("0"), Some("3"), Some("third")] {
        let error = family(face).expect_err("none is told").to_string();
        assert!(error.contains(known) && error.contains("--face"), "{error}");
        assert!(error.contains(face.unwrap_or_default()), "{error}");
    }
    let alone = read::font(&written("ttf"), Some("2"), &[]).expect_err("there is one");
    assert!(alone.to_string().contains("1 Small Regular"), "{alone}");
}

fn drawings(all: &[(&str, &str)]) -> Result<Reading, ReadError> {
    let file = |(name, inside): &(&str, &str)| {
        let head = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 1000 1000">"#;
        (
            format!("{name}.svg"),
            format!("{head}{inside}</svg>").into_bytes(),
        )
    };
    read::svg(&all.iter().map(file).collect::<Vec<_>>())
}

#[test]
fn clip_paths_cut() {
    let cases = [
        // a square, and a ring of which a quarter is left
        (
            r#"<rect width="200" height="300"/>"#,
            "",
            Rect::new(0.0, 700.0, 200.0, 1000.0),
            60_000.0,
        ),
        (
            r#"<rect width="500" height="500"/>"#,
            "",
            Rect::new(0.0, 500.0, 500.0, 1000.0),
            240_000.0,
        ),
        // as wide as the ink: a frame
        (
            r#"<rect width="1000" height="1000"/>"#,
            "",
            Rect::new(0.0, 100.0, 900.0, 1000.0),
            800_000.0,
        ),
        (
            r#"<path d="M0 0H200V200H0zM50 50H150V150H50z" clip-rule="evenodd"/>"#,
            "",
            Rect::new(0.0, 800.0, 200.0, 1000.0),
            30_000.0,
        ),
        (
            r#"<rect width="100" height="100"/>"#,
            r#"transform="translate(50 0) scale(2)""#,
            Rect::new(50.0, 800.0, 250.0, 1000.0),
            40_000.0,
        ),
    ];
    let ring = r#"<path d="M0 0H900V900H0zM400 400V500H500V400z" clip-path="url(#c)"/>"#;
    for (clip, place, bounds, area) in cases {
        let svg = format!(r#"<clipPath id="c" {place}>{clip}</clipPath>{ring}"#);
        let reading = drawings(&[("A", &svg)]).expect("a drawing");
        let outline = &reading.font.glyph("A").expect("A").outline;
        let found = outline.bounds().expect("ink");
        let off = Point::new(found.x0, found.y0).distance(Point::new(bounds.x0, bounds.y0));
        let off =
            off.max(Point::new(found.x1, found.y1).distance(Point::new(bounds.x1, bounds.y1)));
        assert!(off < 0.01, "{clip}: {found:?}");
        let filled = outline.to_path().area();
        assert!((filled - area).abs() < 1.0, "{clip}: {filled}");
        assert_eq!(reading.lost, Vec::<String>::new());
    }
}

/// A stroke on a clip path of one path and a circle of that radius.
fn stroked(ink: &str, clip: &str, radius: u16) -> Reading {
    let svg = format!(
        r#"<clipPath id="c"><path d="{clip}"/><circle cx="500" cy="500" r="{radius}"/></clipPath>
        <path d="{ink}" clip-path="url(#c)" stroke="red" stroke-width="20"/>"#
    );
    drawings(&[("A", &svg)]).expect("a drawing")
}

#[test]
fn what_cannot_be_cut_is_named_and_stays() {
    let clip = "M550 -50L1050 -200A200.0 1050.0 10 0 1 450 400zM550 700L-64.567 886.214C1150 450 250 822.695 \
        -100 750C-200 -200 250 -200 1050 1000Q800 600 -100 213.405T150 400z";
    let ink = "M50 0C750 300.138 600 -100 0 850T150 -50Q850 200 100 650A550.0 1050.0 10 0 0 400 850T1050 \
        1000zM650 -100C1100 203.716 450 1050 950 1100C250 -50 650 100 500 150H350z";
    // the library would never come to an end
    assert_eq!(stroked(ink, clip, 31).lost, ["A.svg: clip path c"]);
}

#[test]
fn strokes_of_ends_a_hair_apart_are_cut() {
    let clip = "M198 780.951L88 981zM1034 -69C75 -197 422 -91 724 -89V333.794T220 -119L652 323V739.332L480 95z";
    let ink = "M1062 538L667.036 1033zM442 232V-89A1147.0 108.252 10 1 0 912 24H78.028L771 812H736T293 \
        604.352V-107z";
    assert_eq!(stroked(ink, clip, 262).lost, Vec::<String>::new());
}

#[test]
fn what_is_not_drawn_is_named() {
    let square = r#"<rect width="100" height="100"/>"#;
    let lost = |inside: &str| {
        drawings(&[("A", &format!("{square}{inside}"))])
            .expect("a square")
            .lost
    };
    for (inside, said) in [
        ("<text>F</text>", "A.svg: text"),
        (r#"<g><image href="x.png"/></g>"#, "A.svg: image"),
        (
            r##"<use href="other.svg#r"/>"##,
            "A.svg: use of other.svg#r",
        ),
        (
            r##"<defs><text id="t">F</text></defs><use href="#t"/>"##,
            "A.svg: text",
        ),
        (r##"<g id="g"><use href="#g"/></g>"##, "A.svg: use of #g"),
        (
            r#"<path d="M garbage"/><path d="M0 0H5V5zL"/>"#,
            "A.svg: path of d=\"M garbage…\", \
             path of d=\"M0 0H5V5zL…\"",
        ),
        (
            r#"<mask id="m"><rect width="9" height="9" fill="white"/></mask><rect width="90" height="90" mask="url(#m)"/>"#,
            "A.svg: mask m",
        ),
    ] {
        assert_eq!(lost(inside), [said], "{inside}");
        let alone = drawings(&[("A", square), ("B", inside)]);
        if inside.contains("zL") || inside.contains("mask") {
            continue;
        }
        let error = alone.expect_err("nothing is drawn").to_string();
        assert!(error.contains("B.svg has nothing"), "{error}");
    }
    for silent in [
        "<defs><text>F</text></defs>",
        r#"<text display="none">F</text>"#,
        r#"<path d="M1e2 5.5.5.5a1 2 0 01 3 4L-1-2z"/><title>A</title>"#,
    ] {
        assert_eq!(lost(silent), Vec::<String>::new(), "{silent}");
    }
}

#[test]
fn what_a_ufo_has_beside_the_font_is_named() {
    let reading = by_hand(|ufo| {
        // no longer one of khatt's, whose classes follow from anchors
        ufo.lib.remove("khatt.built");
        ufo.lib.insert("com.editor.state".to_owned(), 1.into());
        ufo.lib.insert(
            "public.openTypeCategories".to_owned(),
            plist::Dictionary::new().into(),
        );
        ufo.data
            .insert("notes.txt".into(), b"hello".to_vec())
            .expect("data");
        let glyph = ufo.default_layer_mut().get_glyph_mut("O").expect("O");
        glyph.lib.insert("com.editor.mark".to_owned(), "red".into());
        glyph.note = Some("rounder".to_owned());
        let line = norad::Guideline::new(norad::Line::Horizontal(500.0), None, None, None);
        glyph.guidelines.push(line);
    })
    .expect("a UFO");
    assert_eq!(
        reading.lost,
        [
            "2 keys of the lib: com.editor.state, public.openTypeCategories",
            "1 data files: notes.txt",
            "1 glyphs with guidelines: O",
            "1 glyphs with notes: O",
            "1 glyphs with libs: O",
        ]
    );
}

#[test]
fn anchors_of_any_name_attach() {
    let mut mark = glyph(
        "acutecomb",
        &['\u{301}'],
        vec![path("M0 600L100 600L90 700Z")],
    );
    let mut base = glyph("a", &['a'], vec![path("M0 0L100 0L90 100Z")]);
    for name in ["top left", "top_left", "über", "top", ""] {
        let anchor = |prefix: &str| Anchor {
            name: format!("{prefix}{name}"),
            at: Point::new(50.0, 600.0),
        };
        mark.anchors.push(anchor("_"));
        base.anchors.push(anchor(""));
    }
    let glyphs = vec![glyph(".notdef", &[], vec![]), mark, base];
    let text = layout::text(&Font::new(font().info, glyphs.clone()).expect("a font"));
    assert!(
        text.contains("@mark.top_left.1;") && text.contains("@mark._ber;"),
        "{text}"
    );
    let file = converted(&Font::new(font().info, glyphs).expect("a font"), "ttf");
    let gpos = FontRef::new(&file).expect("a font").gpos().expect("GPOS");
    assert!(gpos.lookup_list().expect("lookups").lookup_count() >= 5);
}

#[test]
fn every_glyph_that_no_quadratic_meets_is_named_in_order() {
    let desk = Desk::with("in.otf", written("otf"));
    let args = ["convert", "in.otf", "-o", "out.ttf", "--quadratic", "rate"];
    let said = desk.fails(&[&args[..], &["--tolerance", "0.01"]].concat());
    let places = ["O", "beh-ar", "l.alt"].map(|name| said.find(&format!("glyph {name}: ")));
    assert!(places[0].is_some() && places.is_sorted(), "{said}");
    assert!(places[2].is_some(), "{said}");
}
