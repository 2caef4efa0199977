//! Reading back what was written, conversions between formats, and readers under attack.

use khatt::pipeline::convert::{Options, convert};
use khatt::quadratic::{Method, merge::merge, rate::Rate, split::Split};
use khatt::read::{self, ReadError, Reading};
use khatt::types::{Files, Font, Glyph, Info, Metrics, Name, Outline};
use khatt::write::format;
use kurbo::{Affine, BezPath, Circle, ParamCurve, ParamCurveNearest, PathSeg, Rect, Shape};
use proptest::prelude::*;
use skrifa::MetadataProvider;
use write_fonts::FontBuilder;
use write_fonts::read::tables::glyf::Glyph as Stored;
use write_fonts::read::{FontRef, TableProvider};
use write_fonts::tables::fvar::{AxisInstanceArrays, Fvar, InstanceRecord, VariationAxisRecord};
use write_fonts::tables::gvar::{GlyphDelta, GlyphDeltas, GlyphVariations, Gvar};
use write_fonts::tables::variations::Tent;
use write_fonts::types::{F2Dot14, Fixed, GlyphId, NameId, Tag};

pub(crate) fn path(svg: &str) -> BezPath {
    BezPath::from_svg(svg).expect("a path")
}

pub(crate) fn glyph(name: &str, chars: &[char], contours: Vec<BezPath>) -> Glyph {
    let name = Name::new(name).expect("a name");
    let mut glyph = Glyph::new(name, chars.to_vec(), 640.0);
    glyph.outline = Outline::new(contours).expect("contours");
    glyph
}

/// A ring, a stem with a corner, an accent of a component, an alternate without a character.
pub(crate) fn font() -> Font {
    let hole = Circle::new((320.0, 300.0), 180.0)
        .to_path(1e-3)
        .reverse_subpaths();
    let ring = vec![Circle::new((320.0, 300.0), 280.0).to_path(1e-3), hole];
    let stem = path("M100 0L200 0L200 500C200 600 160 700 100 700Z");
    let info = Info {
        family: "Small".to_owned(),
        metrics: Metrics {
            ascender: 800.0,
            descender: -200.0,
            ..Metrics::default()
        },
        ..Info::default()
    };
    let glyphs = vec![
        glyph(".notdef", &[], vec![]),
        glyph("O", &['O'], ring.clone()),
        glyph("beh-ar", &['ب', 'ى'], vec![stem.clone()]),
        glyph("l.alt", &[], vec![Affine::translate((30.0, 0.0)) * stem]),
    ];
    Font::new(info, glyphs).expect("a font")
}

/// The largest distance of samples of `a` from `b`, either way.
fn apart(a: &Outline, b: &Outline) -> f64 {
    let one = |a: &Outline, b: &Outline| {
        let segs: Vec<PathSeg> = b.to_path().segments().collect();
        let dots = a
            .to_path()
            .segments()
            .flat_map(|s| (0..16).map(move |i| s.eval(f64::from(i) / 16.0)))
            .collect::<Vec<_>>();
        let near = |p| {
            segs.iter()
                .map(|s| s.nearest(p, 1e-6).distance_sq)
                .fold(f64::INFINITY, f64::min)
        };
        dots.into_iter().map(near).fold(0.0, f64::max).sqrt()
    };
    one(a, b).max(one(b, a))
}

/// What a conversion of a font writes.
pub(crate) fn files(font: &Font, name: &str) -> Files {
    let format = format(name).expect("a format");
    convert(font, format, &Options::default()).expect("files")
}

/// The file of a conversion that writes one.
pub(crate) fn converted(font: &Font, name: &str) -> Vec<u8> {
    let files = files(font, name).0;
    files.into_values().next().expect("a file")
}

/// The small font as a file.
pub(crate) fn written(name: &str) -> Vec<u8> {
    converted(&font(), name)
}

/// A font file with some tables changed.
pub(crate) fn patched(file: &[u8], tables: &[(&[u8; 4], Vec<u8>)]) -> Vec<u8> {
    let mut builder = FontBuilder::new();
    for (tag, table) in tables {
        builder.add_raw(Tag::new(tag), table.clone());
    }
    builder.copy_missing_tables(FontRef::new(file).expect("a font"));
    builder.build()
}

pub(crate) fn table(file: &[u8], tag: &[u8; 4]) -> Vec<u8> {
    let font = FontRef::new(file).expect("a font");
    let table = font.table_data(Tag::new(tag)).expect("a table");
    table.as_bytes().to_vec()
}

pub(crate) fn same(reading: &Reading, tolerance: f64) {
    let (a, b) = (font(), &reading.font);
    for g in a.glyphs().iter().filter(|g| !g.outline.is_empty()) {
        let other = b.glyph(g.name.as_str()).expect("every glyph");
        assert!((g.advance - other.advance).abs() < 1.0, "{}", g.name);
        let off = apart(&g.outline, &other.outline);
        assert!(off <= tolerance, "{}: {off} > {tolerance}", g.name);
        let area = |o: &Outline| o.to_path().area();
        assert!(
            area(&g.outline) * area(&other.outline) >= 0.0,
            "{} runs the other way",
            g.name
        );
    }
}

#[test]
fn compiled_fonts_come_back() {
    for (name, tolerance) in [("otf", 1.1), ("ttf", 1.3), ("woff2", 1.3)] {
        let reading = read::font(&written(name), None, &[]).expect(name);
        same(&reading, tolerance);
        assert_eq!(reading.font.info.family, "Small");
        let beh = reading.font.glyph("beh-ar").expect("beh");
        assert_eq!(beh.codepoints, ['ب', 'ى'], "{name}");
    }
}

#[test]
fn fractions_of_cff_come_back() {
    let mut font = font();
    let far = "M1234 777L1300 777L1300 840L1234 840Z";
    font = Font::new(font.info.clone(), {
        let mut glyphs = font.glyphs().to_vec();
        glyphs.push(glyph("far", &['q'], vec![path(far)]));
        glyphs
    })
    .expect("a font");
    let files = (format("otf").expect("otf").write)(&font).expect("files");
    let mut bytes = files.0[""].clone();
    // 1234 777 rmoveto, and as many bytes that say 1234.25 hmoveto
    let (whole, parts) = ([28, 4, 210, 249, 157, 21], [255, 4, 210, 64, 0, 22]);
    let places: Vec<usize> = (0..bytes.len() - 6)
        .filter(|&i| bytes[i..i + 6] == whole)
        .collect();
    assert_eq!(places.len(), 1, "one contour begins there");
    bytes[places[0]..places[0] + 6].copy_from_slice(&parts);
    let read = read::font(&bytes, None, &[]).expect("a font").font;
    let bounds = read.glyph("far").expect("far").outline.bounds();
    assert_eq!(bounds, Some(Rect::new(1234.25, 0.0, 1300.25, 63.0)));
}

/// The small font with an axis along which the stem moves 60 units to the right.
pub(crate) fn variable() -> Vec<u8> {
    let ttf = written("ttf");
    let source = FontRef::new(&ttf).expect("a font");
    let stem = source.charmap().map('ب').expect("beh");
    let (loca, glyf) = (
        source.loca(None).expect("loca"),
        source.glyf().expect("glyf"),
    );
    let glyph = loca.get_glyf(stem, &glyf).expect("a glyph");
    let Some(Stored::Simple(simple)) = glyph else {
        unreachable!("the stem has contours of its own");
    };
    let moved = (0..simple.num_points()).map(|_| GlyphDelta::required(60, 0));
    // four points more say where the glyph's box begins and ends
    let still = (0..4).map(|_| GlyphDelta::required(0, 0));
    let tent = Tent::new(F2Dot14::from_f32(1.0), None);
    let deltas = GlyphDeltas::new(vec![tent], moved.chain(still).collect());
    let glyphs = (0..source.maxp().expect("maxp").num_glyphs()).map(GlyphId::from);
    let variations = glyphs.map(|id| {
        let own = (id == stem).then(|| deltas.clone());
        GlyphVariations::new(id, own.into_iter().collect())
    });
    let gvar = Gvar::new(variations.collect(), 1).expect("variations");
    let [low, high] = [400, 700].map(Fixed::from_i32);
    let axis = VariationAxisRecord::new(Tag::new(b"wght"), low, low, high, 0, NameId::new(256));
    // named as the family is
    let named = InstanceRecord {
        subfamily_name_id: NameId::new(1),
        coordinates: vec![Fixed::from_i32(550)],
        ..InstanceRecord::default()
    };
    let fvar = Fvar::new(AxisInstanceArrays::new(vec![axis], vec![named]));
    let mut builder = FontBuilder::new();
    builder.add_table(&gvar).expect("gvar");
    builder.add_table(&fvar).expect("fvar");
    builder.copy_missing_tables(source);
    builder.build()
}

#[test]
fn a_variable_font_is_read_at_its_place() {
    let bytes = variable();
    let left = |place: &[(String, f64)], name: &str| {
        let reading = read::font(&bytes, None, place).expect("a font");
        let file = converted(&reading.font, name);
        let tables = FontRef::new(&file).expect("a font");
        assert!(
            tables.table_data(Tag::new(b"fvar")).is_none(),
            "it varies no more"
        );
        let after = read::font(&file, None, &[]).expect("a font").font;
        let beh = after.glyph("beh-ar").expect("beh");
        beh.outline.bounds().expect("ink").x0
    };
    for name in ["ttf", "otf"] {
        let usual = left(&[], name);
        for (place, moved) in [(400.0, 0.0), (550.0, 30.0), (700.0, 60.0)] {
            let found = left(&[("wght".to_owned(), place)], name);
            assert!(
                (found - usual - moved).abs() < 1.0,
                "{name} {place}: {found}, {usual}"
            );
        }
    }
    let wrong = read::font(&bytes, None, &[("opsz".to_owned(), 9.0)]).expect_err("no such axis");
    assert!(wrong.to_string().contains("opsz"), "{wrong}");
}

#[test]
fn a_polygon_begins_where_that_costs_least() {
    let z = path("M39 0L429 0L429 67L143 67L417 433L417 482L39 482L39 415L313 415L39 49Z");
    let glyphs = vec![glyph(".notdef", &[], vec![]), glyph("z", &['z'], vec![z])];
    let font = Font::new(font().info, glyphs).expect("a font");
    let length = |quadratic: Method| {
        let options = Options {
            quadratic,
            ..Options::default()
        };
        let files = convert(&font, format("ttf").expect("ttf"), &options).expect("files");
        let file = files.0.into_values().next().expect("a file");
        table(&file, b"glyf").len()
    };
    assert!(length(Method::Rate(Rate::default())) < length(Method::Split(Split::default())));
}

#[test]
fn every_table_but_outlines_comes_through() {
    let before = read::font(&written("otf"), None, &[]).expect("a font").font;
    let ttf = converted(&before, "ttf");
    let after = read::font(&ttf, None, &[]).expect("a font").font;
    assert!(
        before.carried.contains_key(b"cmap"),
        "{:?}",
        before.carried.keys()
    );
    // of these only what does not follow from outlines
    let in_part = |tag: &[u8; 4]| [b"head", b"hhea", b"post"].contains(&tag);
    for (tag, table) in before.carried.iter().filter(|(tag, _)| !in_part(tag)) {
        assert_eq!(after.carried.get(tag), Some(table), "{tag:?}");
    }
}

#[test]
fn vertical_metrics_go_together_and_are_named() {
    let vertical = [b"vhea", b"vmtx", b"VORG"].map(|tag| (tag, vec![0; 36]));
    let file = patched(&written("ttf"), &vertical);
    let reading = read::font(&file, None, &[]).expect("a font");
    for tag in [b"vhea", b"vmtx", b"VORG"] {
        assert!(!reading.font.carried.contains_key(tag), "{tag:?}");
    }
    let said = "vertical metrics (vhea, vmtx, VORG)".to_owned();
    assert!(reading.lost.contains(&said), "{:?}", reading.lost);
}

#[test]
fn flags_without_a_name_stay() {
    const FLAGS: std::ops::Range<usize> = 16..18;
    for (from, to) in [("ttf", "otf"), ("otf", "ttf"), ("otf", "otf")] {
        let before = written(from);
        let mut head = table(&before, b"head");
        head[FLAGS].copy_from_slice(&0b0100_1011_1110_1001u16.to_be_bytes());
        let file = patched(&before, &[(b"head", head)]);
        let reading = read::font(&file, None, &[]).expect("a font");
        let head = table(&converted(&reading.font, to), b"head");
        // outlines begin at their bearings
        let flags = 0b0100_1011_1110_1011u16.to_be_bytes();
        assert_eq!(head[FLAGS], flags, "{from} to {to}");
    }
}

#[test]
fn cff_says_of_the_underline_and_the_pitch_what_post_does() {
    let otf = written("otf");
    let top = |bytes: &[u8]| {
        let cff = table(bytes, b"CFF ");
        let cff = read_fonts::ps::cff::CffFontRef::new_cff(&cff, 0, None).expect("CFF");
        let meta = cff.metadata().expect("metadata");
        let line = (meta.underline_position(), meta.underline_thickness());
        (meta.is_fixed_pitch(), line.0.to_f64(), line.1.to_f64())
    };
    // a tenth of the em down to its top
    assert_eq!(top(&otf), (false, -125.0, 50.0));
    let mut post = table(&otf, b"post");
    post[8..16].copy_from_slice(&[0xff, 0xb5, 0, 31, 0, 0, 0, 1]);
    let file = patched(&otf, &[(b"post", post)]);
    let reading = read::font(&file, None, &[]).expect("a font");
    let again = converted(&reading.font, "otf");
    assert_eq!(top(&again), (true, -90.5, 31.0));
}

#[test]
fn drawings_come_back() {
    let mut glyphs = font().glyphs().to_vec();
    glyphs.push(glyph("space", &[' '], vec![]));
    let font = Font::new(font().info, glyphs).expect("a font");
    let drawings: Vec<_> = files(&font, "svg").0.into_iter().collect();
    let reading = read::svg(&drawings).expect("drawings");
    same(&reading, 0.05);
    let space = reading.font.glyph("space").expect("the space");
    assert_eq!((&space.codepoints[..], space.advance), (&[' '][..], 640.0));
    assert_eq!(reading.font.glyph("O").expect("O").codepoints, ['O']);
}

#[test]
fn drawings_have_the_characters_of_their_names() {
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 -9 9 10"><path d="M0 0H5V5z"/></svg>"#;
    let files = [
        "A_.svg",
        "uni0041.svg",
        "one.svg",
        "eacute.svg",
        "space.svg",
        "uni06A_9.svg",
        "u1F_600.svg",
        "beh-ar.svg",
        "beh-ar.init.svg",
        "f_i.svg",
        "lam_alef-ar.svg",
        "logo.svg",
        "ب.svg",
    ];
    let drawings = files.map(|f| (f.to_owned(), svg.into()));
    let reading = read::svg(&drawings).expect("drawings");
    let chars = |g: &Glyph| g.codepoints.iter().collect::<String>();
    let glyphs = reading.font.glyphs().iter().skip(1);
    let all: Vec<_> = glyphs.map(|g| format!("{} {}", g.name, chars(g))).collect();
    assert_eq!(
        all,
        [
            "A A",
            "uni0041 ",
            "one 1",
            "eacute é",
            "space  ",
            "uni06A9 ک",
            "u1F600 \u{1f600}",
            "beh-ar ب",
            "beh-ar.init ",
            "f_i ",
            "lam_alef-ar ",
            "logo ",
            "glyph00013 ",
        ]
    );
    assert_eq!(
        reading.lost,
        [
            "3 characters that names do not tell, or that another drawing has: uni0041, logo, ب",
            "1 glyph names that are illegal or not unique: ب",
        ]
    );
}

#[test]
fn a_mark_is_seen_and_comes_back_without_an_advance() {
    let mut mark = glyph(
        "acutecomb",
        &['\u{301}'],
        vec![path("M-200 600L-100 600L-90 700L-150 720Z")],
    );
    mark.advance = 0.0;
    let glyphs = vec![glyph(".notdef", &[], vec![]), mark];
    let font = Font::new(font().info, glyphs).expect("a font");
    let files = (format("svg").expect("svg").write)(&font).expect("files");
    let text = String::from_utf8(files.0["acutecomb.svg"].clone()).expect("text");
    assert!(text.contains(r#"viewBox="-200 -800 110 1000""#), "{text}");
    let drawings: Vec<_> = files.0.into_iter().collect();
    let read = read::svg(&drawings).expect("drawings").font;
    let mark = read.glyph("acutecomb").expect("the mark");
    assert_eq!(mark.advance.to_bits(), 0.0_f64.to_bits());
    let before = &font.glyphs()[1].outline;
    assert!(apart(before, &mark.outline) < 0.01, "{:?}", mark.outline);
    assert_eq!(
        read.info.metrics,
        Metrics {
            ascender: 800.0,
            descender: -200.0,
            ..Metrics::default()
        }
    );
}

#[test]
fn a_view_box_counts_whatever_its_aspect() {
    // a square of half the view box's height, at its top left corner: how large it is shown does not count
    for aspect in ["xMidYMid", "xMaxYMin slice", "xMinYMax", "none"] {
        let svg = format!(
            r#"<svg xmlns="http://www.w3.org/2000/svg" width="90" height="120" viewBox="0 0 200 100"
            preserveAspectRatio="{aspect}"><path d="M0 0H50V50H0z"/></svg>"#
        );
        let reading = read::svg(&[("a.svg".to_owned(), svg.into_bytes())]).expect("a drawing");
        let a = reading.font.glyph("a").expect("a");
        let bounds = a.outline.bounds().expect("ink");
        let wanted = Rect::new(0.0, 500.0, 500.0, 1000.0);
        let off = (bounds.x0 - wanted.x0).hypot(bounds.y0 - wanted.y0);
        let off = off.max((bounds.x1 - wanted.x1).hypot(bounds.y1 - wanted.y1));
        assert!(off < 0.01, "{aspect}: {bounds:?}");
        assert!((a.advance - 2000.0).abs() < 0.01, "{aspect}: {}", a.advance);
    }
}

#[test]
fn strokes_transforms_and_view_boxes_count() {
    let svg = r#"<svg xmlns="http://www.w3.org/2000/svg" width="48" height="48" viewBox="0 0 24 24">
        <g transform="translate(12 12)"><path d="M-6 0H6" stroke="black" stroke-width="4" fill="none"/></g></svg>"#;
    let reading = read::svg(&[("A_.svg".to_owned(), svg.into())]).expect("a drawing");
    let bounds = reading
        .font
        .glyph("A")
        .expect("A")
        .outline
        .bounds()
        .expect("ink");
    // 12 by 4 user units in a box of 24 that is 1000 units high
    let near = |a: f64, b: f64| (a - b).abs() < 0.01;
    assert!(
        near(bounds.width(), 500.0) && near(bounds.height(), 4000.0 / 24.0),
        "{bounds:?}"
    );
    assert!(
        near(bounds.center().x, 500.0) && near(bounds.center().y, 500.0),
        "{bounds:?}"
    );
}

#[test]
fn quadratics_merge_into_few_cubics() {
    let font = font();
    let ring = &font.glyph("O").expect("O").outline;
    let quads = Method::Split(Split::default())
        .convert(ring, 0.3)
        .expect("quadratics");
    let before = quads.to_path().segments().count();
    let merged = merge(&quads, 0.5);
    assert!(apart(&merged, &quads) < 0.55, "{}", apart(&merged, &quads));
    let pieces = merged.to_path().segments().count();
    assert!(pieces * 2 <= before, "{pieces} of {before} pieces");
    assert!(
        merged
            .to_path()
            .segments()
            .all(|s| matches!(s, PathSeg::Cubic(_)))
    );
}

#[test]
fn what_is_no_font_is_named() {
    let font = |bytes: &[u8]| read::font(bytes, None, &[]);
    let drawing = |svg: &str| read::svg(&[("x.svg".to_owned(), svg.into())]);
    let damaged = |read| matches!(read, Err(ReadError::Damaged { .. }));
    assert!(damaged(font(b"")));
    assert!(damaged(font(b"wOF2 and no more")));
    assert!(damaged(drawing("<svg")));
    let empty = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"/>"#;
    assert!(matches!(drawing(empty), Err(ReadError::Empty)));
    let far = r#"<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 9 9"><path d="M1 5Q5 9 2 7T1 599999999999z"/></svg>"#;
    assert!(damaged(drawing(far)));
    let axis = read::font(&written("ttf"), None, &[("wght".to_owned(), 700.0)]);
    assert!(matches!(axis, Err(ReadError::NoAxes(_))), "{axis:?}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn damaged_fonts_do_not_panic(which in 0..3usize, hits in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12), keep in 0.0..1.0f64) {
        let mut bytes = written(["ttf", "otf", "woff2"][which]);
        for (at, value) in hits {
            let i = at.index(bytes.len());
            bytes[i] = value;
        }
        let _ = read::font(&bytes, None, &[]);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "a part of a length")]
        bytes.truncate((keep * bytes.len() as f64) as usize);
        let _ = read::font(&bytes, None, &[]);
    }

    #[test]
    fn odd_drawings_do_not_panic(d in "[MLCQZAmlhv0-9eE., -]{0,60}", tail in "[<>/a-z \"=0-9]{0,30}", view in "[0-9. e-]{0,16}") {
        let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{view}\"><path d=\"{d}\" fill-rule=\"evenodd\" stroke=\"red\"/>{tail}</svg>");
        let _ = read::svg(&[("a.svg".to_owned(), svg.into_bytes())]);
    }

    #[test]
    fn odd_clip_paths_do_not_panic(ink in "M([LCQA ]( ?-?[0-9]{1,3}(\\.5)?){1,7}){1,5}", clip in "M[0-9]{1,2} [0-9]{1,2}([LQC]( -?[0-9]{1,2}){6}){1,4}z?", scale in -3.0..3.0f64) {
        let svg = format!("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 99 99\"><clipPath id=\"c\" transform=\"scale({scale})\"><path d=\"{clip}\"/></clipPath><path d=\"{ink}\" clip-path=\"url(#c)\" stroke=\"red\"/></svg>");
        let _ = read::svg(&[("a.svg".to_owned(), svg.into_bytes())]);
    }
}
