//! Cells of pages as they come: corrections of single letters, other inks, what is left out and why.
#![expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who writes files"
)]

use crate::cli::{khatt, png, transcript};
use crate::common::approved;
use crate::sheets::{LETTERS, edge, page, project};
use image::imageops;
use khatt::scan::{self, Ink, Layout, Options, Polarity, Scale};
use khatt::types::{Cell, Label};
use kurbo::{Point, Rect};
use proptest::collection::vec;
use proptest::prelude::ProptestConfig;
use proptest::{prop_assert, proptest};
use std::fs;
use std::path::Path;
use std::process::Output;

/// Builds the page of nine letters with a correction.
fn corrected(picture: &[u8], correction: &str) -> (tempfile::TempDir, Output) {
    let dir = project(LETTERS, picture);
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    fs::write(&path, format!("{text}\n{correction}\n")).expect("a project");
    let out = khatt(dir.path(), &["build", "font.toml"]);
    (dir, out)
}

fn font(dir: &Path) -> Vec<u8> {
    fs::read(dir.join("out/test.ttf")).expect("the font")
}

/// A letter's box in the font, if it is there.
fn bounds(correction: &str, picture: &[u8], letter: char) -> Option<ttf_parser::Rect> {
    let (dir, out) = corrected(picture, correction);
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{correction}: {stderr}");
    let bytes = font(dir.path());
    let face = ttf_parser::Face::parse(&bytes, 0).expect("a font");
    face.glyph_bounding_box(face.glyph_index(letter)?)
}

#[test]
fn what_was_found_can_be_written_and_builds_the_same_font() {
    let dir = project(LETTERS, &page(&[]));
    let run = |args: &[&str]| {
        let out = khatt(dir.path(), args);
        assert_eq!(
            out.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&out.stderr)
        );
    };
    run(&["build", "font.toml"]);
    let before = font(dir.path());
    run(&["cut", "font.toml", "--write-overrides", "cells.toml"]);
    let cells = fs::read_to_string(dir.path().join("cells.toml")).expect("the cells");
    assert_eq!(cells.matches("box = ").count(), 9, "{cells}");
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    fs::write(&path, format!("cells_file = \"cells.toml\"\n{text}")).expect("a project");
    run(&["build", "font.toml"]);
    assert!(
        font(dir.path()) == before,
        "the cells as found make another font"
    );
}

#[test]
fn a_picture_that_says_how_it_tells_light_is_asked_where_tones_say_so() {
    let plain = page(&[]);
    // as sRGB: length, kind and intent of the chunk, and its sum
    let chunk = b"\0\0\0\x01sRGB\0\xae\xce\x1c\xe9";
    let told = [&plain[..33], chunk.as_slice(), &plain[33..]].concat();
    let run = |picture: &[u8], tones: &str, command: &[&str]| {
        let dir = project(LETTERS, picture);
        let path = dir.path().join("font.toml");
        let text = fs::read_to_string(&path).expect("the project");
        let text = text.replacen("[[sheet]]", &format!("[[sheet]]\n{tones}"), 1);
        fs::write(&path, text).expect("a project");
        let out = khatt(dir.path(), command);
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        (dir, out.status.code(), said)
    };
    let (build, cut) = (["build", "font.toml"], ["cut", "font.toml", "-o", "cells"]);
    let [asked, srgb, linear] = ["tones = \"profile\"", "tones = \"srgb\"", ""].map(|tones| {
        let (dir, code, said) = run(&told, tones, &build);
        assert_eq!(code, Some(0), "{said}");
        assert!(!said.contains("tones"), "{said}");
        font(dir.path())
    });
    assert!(
        asked == srgb && asked != linear,
        "the same light, the same font"
    );
    for (picture, tones, noted) in [
        (&told, "", true),
        (&told, "tones = \"profile\"", false),
        (&plain, "", false),
    ] {
        let (_dir, code, said) = run(picture, tones, &cut);
        assert_eq!(code, Some(0), "{said}");
        let note = "note: page.png says itself how much light its numbers stand for";
        assert_eq!(said.contains(note), noted, "{said}");
    }
    let (_dir, code, said) = run(&plain, "tones = \"profile\"", &build);
    assert_eq!(code, Some(1), "{said}");
    assert!(
        said.contains("page.png") && said.contains("tones = \"srgb\""),
        "{said}"
    );
}

#[test]
fn corrections_change_one_letter() {
    let plain = page(&[]);
    let h = bounds("", &plain, 'H').expect("a letter");
    let (wide, high) = (h.width(), h.height());
    assert!(bounds("[cells.H]\nignore = true", &plain, 'H').is_none());
    let shifted = bounds("[cells.H]\nbaseline_shift = 50", &plain, 'H').expect("a letter");
    assert!(
        (shifted.y_min - h.y_min - 50).abs() <= 1,
        "{h:?} {shifted:?}"
    );
    let turned = bounds("[cells.H]\nrotation = 90", &plain, 'H').expect("a letter");
    let near = |a: i16, b: i16| (a - b).abs() <= 8;
    assert!(
        near(turned.width(), high) && near(turned.height(), wide),
        "{h:?} {turned:?}"
    );
    let o = ["", "threshold = 0.2", "threshold = 0.8"];
    let o = o.map(|t| bounds(&format!("[cells.o]\n{t}"), &plain, 'o').expect("a letter"));
    let [usual, bold, thin] = o.map(|r| r.width());
    assert!(bold > usual && thin < usual, "{thin} {usual} {bold}");
    // the left stem alone: H stands in the first cell, its stem from 60 to 76 px
    let polygon = "[cells.H]\npolygon = [[50, 40], [80, 40], [80, 160], [50, 160]]";
    let stem = bounds(polygon, &plain, 'H').expect("a letter");
    assert!(
        near(stem.height(), high) && near(stem.width(), 133),
        "{stem:?}"
    );
    let traced = "[cells.H.trace]\ntolerance_px = 2.0";
    assert!(bounds(traced, &plain, 'H').is_some());
}

/// The points of a glyph, as drawn.
#[derive(Default)]
struct Drawn(Vec<(f32, f32)>);

impl ttf_parser::OutlineBuilder for Drawn {
    fn move_to(&mut self, x: f32, y: f32) {
        self.0.push((x, y));
    }
    fn line_to(&mut self, x: f32, y: f32) {
        self.0.push((x, y));
    }
    fn quad_to(&mut self, a: f32, b: f32, x: f32, y: f32) {
        self.0.extend([(a, b), (x, y)]);
    }
    fn curve_to(&mut self, a: f32, b: f32, c: f32, d: f32, x: f32, y: f32) {
        self.0.extend([(a, b), (c, d), (x, y)]);
    }
    fn close(&mut self) {}
}

#[test]
fn tension_is_set_for_one_letter() {
    let plain = page(&[]);
    let drawn = |tension: &str| {
        let correction = format!("[cells.o.trace.fit]\nmethod = \"gc2\"\n{tension}");
        let (dir, out) = corrected(&plain, &correction);
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(0), "{correction}: {stderr}");
        let bytes = font(dir.path());
        let face = ttf_parser::Face::parse(&bytes, 0).expect("a font");
        ['o', 'H'].map(|letter| {
            let mut drawn = Drawn::default();
            let glyph = face.glyph_index(letter).expect("a glyph");
            face.outline_glyph(glyph, &mut drawn).expect("an outline");
            drawn.0
        })
    };
    let [loose, tight] = ["point_tension = 0.0", "point_tension = 40.0"].map(drawn);
    assert_ne!(loose[0], tight[0], "o has a tension of its own");
    assert_eq!(loose[1], tight[1], "H has not");
}

#[test]
fn a_box_leaves_a_blot_out() {
    let clean = image::load_from_memory(&page(&[]))
        .expect("a picture")
        .to_luma8();
    let picture = png(600, 600, |x, y| {
        let disc = edge((f64::from(x) - 158.0).hypot(f64::from(y) - 140.0) - 9.0);
        disc.max(255 - clean.get_pixel(x, y).0[0])
    });
    let with = bounds("", &picture, 'H').expect("a letter");
    let without = bounds("[cells.H]\nbox = [55, 45, 145, 155]", &picture, 'H').expect("a letter");
    assert!(with.width() > without.width() + 100, "{with:?} {without:?}");
    assert_eq!(Some(without), bounds("", &page(&[]), 'H'));
}

#[test]
fn a_page_that_lies_on_its_side_is_turned() {
    let upright = bounds("", &page(&[]), 'H').expect("a letter");
    let clean = image::load_from_memory(&page(&[]))
        .expect("a picture")
        .to_luma8();
    for degrees in [90, 180, 270] {
        // turned back by as much as the project says it must be turned
        let picture = png(600, 600, |x, y| {
            let (u, v) = match degrees {
                90 => (599 - y, x),
                180 => (599 - x, 599 - y),
                _ => (y, 599 - x),
            };
            255 - clean.get_pixel(u, v).0[0]
        });
        let dir = project(LETTERS, &picture);
        let path = dir.path().join("font.toml");
        let text = fs::read_to_string(&path).expect("the project");
        let turned = text.replace("[[sheet]]", &format!("[[sheet]]\nturn = {degrees}"));
        fs::write(&path, turned).expect("a project");
        let out = khatt(dir.path(), &["build", "font.toml"]);
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(0), "{degrees}: {stderr}");
        let bytes = font(dir.path());
        let face = ttf_parser::Face::parse(&bytes, 0).expect("a font");
        let h = face
            .glyph_index('H')
            .and_then(|h| face.glyph_bounding_box(h));
        assert_eq!(h, Some(upright), "{degrees}");
    }
}

#[test]
fn several_drawings_of_a_glyph_are_settled() {
    let built = |repeated: &str| {
        let dir = project("H o l H e I N c L", &page(&[]));
        let path = dir.path().join("font.toml");
        let text = fs::read_to_string(&path).expect("the project");
        fs::write(&path, format!("{repeated}\n{text}")).expect("a project");
        let out = khatt(dir.path(), &["build", "font.toml"]);
        (dir, out)
    };
    let (dir, out) = built("");
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert!(
        stderr.contains("H: drawn 2 times; the drawing with the calmest edge"),
        "{stderr}"
    );
    let best = font(dir.path());
    let best = ttf_parser::Face::parse(&best, 0).expect("a font");
    let (dir, out) = built("repeated = \"alternates\"");
    assert_eq!(
        out.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&out.stderr)
    );
    let both = font(dir.path());
    let both = ttf_parser::Face::parse(&both, 0).expect("a font");
    assert_eq!(both.number_of_glyphs(), best.number_of_glyphs() + 1);
    assert!(both.glyph_index_by_name("H.ss01").is_some());
    let bytes = font(dir.path());
    assert_eq!(shaped(&bytes, "HHHoHoH"), "H H.ss01 H o H.ss01 o H");
    let (dir, out) = built("repeated = \"median\"");
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert!(
        stderr.contains("H: drawn 2 times; the one in the middle"),
        "{stderr}"
    );
    let middle = font(dir.path());
    let middle = ttf_parser::Face::parse(&middle, 0).expect("a font");
    let width = |face: &ttf_parser::Face<'_>| {
        face.glyph_index('H')
            .and_then(|h| face.glyph_bounding_box(h))
            .map(|b| b.width())
    };
    // 80 px of 150 an em; both drawings are alike
    assert!(
        width(&middle)
            .zip(width(&best))
            .is_some_and(|(a, b)| a.abs_diff(b) <= 4)
    );
    let (_dir, out) = built("repeated = \"error\"");
    assert_eq!(out.status.code(), Some(1));
    approved::check(
        "cli",
        "build-twice",
        &transcript(&["build", "font.toml"], &out),
    );
    let sets = both.tables().gsub.map(|g| {
        g.features
            .into_iter()
            .any(|f| f.tag == ttf_parser::Tag::from_bytes(b"ss01"))
    });
    assert_eq!(sets, Some(true));
}

#[test]
fn drawings_beyond_the_stylistic_sets_are_told() {
    let glyphs = ["o"; 24].join(" ");
    let dir = project(&glyphs, &png(1000, 1000, ring));
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    let text = text.replace("[3, 3]", "[5, 5]");
    fs::write(&path, format!("repeated = \"alternates\"\n{text}")).expect("a project");
    let out = khatt(dir.path(), &["build", "font.toml"]);
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{stderr}");
    let note =
        "o: drawn 24 times; there are 20 stylistic sets, and the last 3 drawings are left out";
    assert!(stderr.contains(note), "{stderr}");
}

/// Cells of 200 × 200 px with an o in each but the last.
fn ring(x: u32, y: u32) -> u8 {
    let (column, row) = (x / 200, y / 200);
    let (x, y) = (f64::from(x % 200) + 0.5, f64::from(y % 200) + 0.5);
    if (column, row) == (4, 4) {
        return 0;
    }
    edge(((x - 100.0).hypot(y - 116.0) - 26.0).abs() - 9.0)
}

/// The names of the glyphs that a text is set with.
fn shaped(bytes: &[u8], text: &str) -> String {
    let font = harfrust::FontRef::new(bytes).expect("a font");
    let data = harfrust::ShaperData::new(&font);
    let mut buffer = harfrust::UnicodeBuffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    let set = data
        .shaper(&font)
        .build()
        .shape(buffer, harfrust::ShapeOptions::default());
    let face = ttf_parser::Face::parse(bytes, 0).expect("a font");
    let name = |id: u32| {
        let id = u16::try_from(id).expect("a glyph of the font");
        face.glyph_name(ttf_parser::GlyphId(id))
            .unwrap_or_default()
            .to_owned()
    };
    let names: Vec<String> = set.glyph_infos().iter().map(|g| name(g.glyph_id)).collect();
    names.join(" ")
}

/// Letters n, i, p and l by turns in 4 × 5 cells of 150 px, as named in NIPL.
fn nipl(x: u32, y: u32) -> u8 {
    let kind = b"nipl"[((y / 150 * 5 + x / 150) % 4) as usize];
    let (x, y) = (f64::from(x % 150) + 0.5, f64::from(y % 150) + 0.5);
    let bar =
        |x0: f64, y0: f64, x1: f64, y1: f64| edge((x0 - x).max(x - x1).max((y0 - y).max(y - y1)));
    let stem = |top: f64, bottom: f64| bar(50.0, top, 60.0, bottom);
    match kind {
        b'n' => stem(60.0, 110.0)
            .max(bar(80.0, 60.0, 90.0, 110.0))
            .max(bar(55.0, 60.0, 85.0, 70.0)),
        b'i' => stem(60.0, 110.0).max(bar(49.0, 38.0, 61.0, 50.0)),
        b'p' => stem(60.0, 140.0)
            .max(bar(80.0, 60.0, 90.0, 110.0))
            .max(bar(55.0, 60.0, 85.0, 70.0))
            .max(bar(55.0, 100.0, 85.0, 110.0)),
        _ => stem(30.0, 110.0),
    }
}

#[test]
fn a_page_on_its_side_or_head_is_turned() {
    let upright = image::GrayImage::from_fn(750, 600, |x, y| image::Luma([255 - nipl(x, y)]));
    let names = ["n i p l"; 5].join(" ");
    for layout in ["{ grid = [4, 5] }", "\"free\""] {
        for turn in [0, 90, 180, 270] {
            // the picture that must be turned by so much
            let lying = match turn {
                90 => imageops::rotate270(&upright),
                180 => imageops::rotate180(&upright),
                270 => imageops::rotate90(&upright),
                _ => upright.clone(),
            };
            let mut bytes = std::io::Cursor::new(Vec::new());
            lying
                .write_to(&mut bytes, image::ImageFormat::Png)
                .expect("a PNG");
            let dir = tempfile::tempdir().expect("a folder");
            fs::write(dir.path().join("page.png"), bytes.into_inner()).expect("a picture");
            let text = format!(
                "repeated = \"best\"\n[font]\nfamily = \"T\"\n[[sheet]]\nimage = \"page.png\"\nlayout = {layout}\nglyphs = \"{names}\"\npixels_per_em = 100\n"
            );
            fs::write(dir.path().join("font.toml"), text).expect("a project");
            let out = khatt(dir.path(), &["cut", "font.toml", "-o", "cells"]);
            assert_eq!(
                out.status.code(),
                Some(0),
                "{layout}, {turn}: {}",
                String::from_utf8_lossy(&out.stderr)
            );
            let list = fs::read(dir.path().join("cells/cells.json")).expect("the list");
            let list: serde_json::Value = serde_json::from_slice(&list).expect("JSON");
            let cells = list[0]["cells"].as_array().expect("cells");
            assert_eq!(cells.len(), 20);
            for (i, cell) in cells.iter().enumerate() {
                let at = |k: usize| cell["box_px"][k].as_f64().expect("a number");
                let (x, y) = (150.0 * (i % 5) as f64, 150.0 * (i / 5) as f64);
                let fine = at(0) >= x && at(2) <= x + 150.0 && at(1) >= y && at(3) <= y + 150.0;
                assert!(fine, "{layout}, {turn}, cell {i}: {cell}");
            }
            let listed = list[0]["warnings"].to_string();
            for said in [listed, String::from_utf8_lossy(&out.stderr).into_owned()] {
                assert_eq!(
                    said.contains(&format!("turn = {turn},")),
                    turn != 0,
                    "{said}"
                );
            }
        }
    }
}

#[test]
fn one_drawing_in_two_cells_is_noticed() {
    // the page repeats its three shapes in every row
    let (_dir, out) = corrected(&page(&[]), "");
    let stderr = String::from_utf8_lossy(&out.stderr);
    let notes = stderr
        .matches("its outline is that of page.png, cell")
        .count();
    assert_eq!(notes, 6, "{stderr}");
}

#[test]
fn corrections_that_mean_nothing_are_told() {
    for (name, text) in [
        ("unknown-glyph", "[cells.Q]\nignore = true"),
        ("no-name", "[cells.qqqq]\nignore = true"),
        (
            "two-places",
            "[cells.H]\nbox = [1, 1, 2, 2]\npolygon = [[0, 0], [1, 0], [1, 1]]",
        ),
        ("turned-box", "[cells.H]\nbox = [9, 1, 2, 2]"),
        ("no-level", "[cells.H]\nthreshold = 1.5"),
        ("no-ink", "[cells.H]\nbox = [0, 0, 5, 5]"),
    ] {
        let (dir, out) = corrected(&page(&[]), text);
        assert_eq!(out.status.code(), Some(1), "{name}");
        assert!(
            !dir.path().join("out").exists(),
            "{name}: nothing may be written"
        );
        approved::check(
            "cli",
            &format!("cells-{name}"),
            &transcript(&["build", "font.toml"], &out),
        );
    }
}

/// A page drawn in rectangles of coverage and colour.
struct Drawing {
    width: u32,
    height: u32,
    /// Places and the light they swallow.
    bars: Vec<(Rect, [u8; 3])>,
}

const BLACK: [u8; 3] = [230, 228, 225];
const BLUE: [u8; 3] = [220, 190, 90];

impl Drawing {
    fn bar(&mut self, x: f64, y: f64, (w, h): (f64, f64), ink: [u8; 3]) {
        self.bars.push((Rect::new(x, y, x + w, y + h), ink));
    }

    fn png(&self) -> Vec<u8> {
        let picture = image::RgbImage::from_fn(self.width, self.height, |x, y| {
            let p = Point::new(f64::from(x) + 0.5, f64::from(y) + 0.5);
            let hit = self.bars.iter().rev().find(|(r, _)| r.contains(p));
            image::Rgb(hit.map_or([250, 250, 248], |(_, ink)| ink.map(|v| 255 - v)))
        });
        let mut bytes = std::io::Cursor::new(Vec::new());
        let written = picture.write_to(&mut bytes, image::ImageFormat::Png);
        written.expect("a picture in memory");
        bytes.into_inner()
    }

    fn cut(&self, names: &[&str], options: &Options) -> scan::Cut {
        let sheets = scan::load(&self.png(), "page", Polarity::DarkInk.into()).expect("a picture");
        let page = scan::clean(
            sheets.into_iter().next().expect("one page"),
            scan::Texture::default(),
        )
        .expect("ink");
        let labels: Vec<Label> = names.iter().map(|n| Label((*n).to_owned())).collect();
        scan::cut(&page, &labels, options, &[]).expect("cells")
    }
}

fn options(layout: Layout) -> Options {
    Options {
        layout,
        scale: Some(Scale::PixelsPerEm(100.0)),
        ..Options::default()
    }
}

/// Twelve names.
const TWELVE: [&str; 12] = ["A", "B", "C", "D", "E", "F", "G", "H", "I", "J", "K", "L"];

/// Twelve letters in three rows of blue ink, each with a black square, a corner mark and a label beside it.
fn marked() -> Drawing {
    let mut page = Drawing {
        width: 800,
        height: 600,
        bars: Vec::new(),
    };
    for i in 0..12 {
        let (x, y) = (
            60.0 + 190.0 * f64::from(i % 4),
            40.0 + 190.0 * f64::from(i / 4),
        );
        page.bar(x, y, (12.0, 60.0 + f64::from(i)), BLUE);
        page.bar(x, y, (40.0, 12.0), BLUE);
        page.bar(x - 40.0, y + 90.0, (30.0, 30.0), BLACK);
        page.bar(x + 20.0, y + 100.0, (24.0, 24.0), BLACK);
        page.bar(x + 90.0, y + 100.0, (40.0, 14.0), BLACK);
        page.bar(x + 90.0, y + 100.0, (14.0, 40.0), BLACK);
    }
    page
}

#[test]
fn marks_in_another_ink_are_no_letters() {
    let page = marked();
    for layout in [Layout::Grid(3, 4), Layout::Free] {
        let options = Options {
            ink: Ink::try_from("blue".to_owned()).expect("an ink").into(),
            ..options(layout)
        };
        let cut = page.cut(&TWELVE, &options);
        assert_eq!(cut.cells.len(), 12, "{layout:?}");
        for (i, cell) in cut.cells.iter().enumerate() {
            let size = (cell.in_sheet.width(), cell.in_sheet.height());
            assert_eq!(
                (cell.label.0.as_str(), size),
                (TWELVE[i], (40.0, 60.0 + i as f64))
            );
        }
        let other = cut
            .rejected
            .iter()
            .filter(|r| r.reason == scan::Reason::OtherInk);
        assert_eq!(other.count(), 36, "three marks a letter");
    }
}

#[test]
fn a_page_of_one_colour_is_told_from_one_of_many() {
    let dir = project(LETTERS, &page(&[]));
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    let text = text.replace("layout =", "ink = \"red\"\nlayout =");
    fs::write(&path, text).expect("a project");
    let said = |status| {
        let out = khatt(dir.path(), &["build", "font.toml", "--no-cache"]);
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(status), "{said}");
        said
    };
    let grey = said(0);
    assert!(
        grey.contains("the picture has no colours, so `ink` tells nothing apart"),
        "{grey}"
    );
    fs::remove_dir_all(dir.path().join("out")).expect("outputs");
    // the same page as a colour scanner gives it: all ink is black
    let picture = image::load_from_memory(&page(&[]))
        .expect("a picture")
        .to_rgb8();
    picture
        .save(dir.path().join("page.png"))
        .expect("a picture");
    let black = said(1);
    assert!(
        black.contains("none of the colour that `ink` asks for (#"),
        "{black}"
    );
    assert!(!dir.path().join("out").exists(), "nothing is written");
}

#[test]
fn labels_and_guides_of_a_thin_pen_are_no_letters() {
    let mut page = Drawing {
        width: 900,
        height: 700,
        bars: Vec::new(),
    };
    for row in 0..3 {
        let y = 60.0 + 210.0 * f64::from(row);
        page.bar(20.0, y - 20.0, (860.0, 4.0), BLACK);
        for column in 0..4 {
            let x = 60.0 + 210.0 * f64::from(column);
            page.bar(x, y + 30.0, (90.0, 26.0), BLACK);
            page.bar(x + 60.0, y + 30.0, (26.0, 90.0), BLACK);
            page.bar(x + 20.0, y + 90.0, (26.0, 26.0), BLACK); // its dot
            page.bar(x + 110.0, y, (70.0, 8.0), BLACK);
            page.bar(x + 110.0, y + 22.0, (8.0, 60.0), BLACK);
            page.bar(x + 146.0, y + 22.0, (8.0, 64.0), BLACK);
        }
    }
    let cut = page.cut(&TWELVE, &options(Layout::Free));
    assert_eq!(cut.cells.len(), 12);
    for cell in &cut.cells {
        assert_eq!(
            cell.in_sheet.size(),
            (90.0, 90.0).into(),
            "{}",
            cell.label.0
        );
    }
    let reasons = |reason| cut.rejected.iter().filter(|r| r.reason == reason).count();
    assert_eq!(
        (reasons(scan::Reason::Thin), reasons(scan::Reason::Line)),
        (36, 3)
    );
}

/// Ink of a cell's picture at a place of the sheet's.
fn covers(cell: &Cell, p: Point) -> bool {
    let q = cell.to_sheet.inverse() * p;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a saturating cast of a place in a small picture"
    )]
    let at = cell
        .gray
        .at(q.x.floor().max(0.0) as usize, q.y.floor().max(0.0) as usize);
    q.x >= 0.0 && q.y >= 0.0 && at > 0.5
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 12,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    /// Every piece of ink (none of them is as small as a speck) is in one cell, or in the list of what was left out.
    #[test]
    fn no_ink_is_lost(
        blots in vec((0.0..740.0f64, 0.0..540.0f64, 26.0..40.0f64, 26.0..40.0f64), 0..14),
        layout in 0..3usize,
    ) {
        let mut page = marked();
        page.bars.iter_mut().for_each(|b| b.1 = BLACK);
        for &(x, y, w, h) in &blots {
            page.bar(x.floor(), y.floor(), (w.floor(), h.floor()), BLACK);
        }
        let layout = [Layout::Grid(3, 4), Layout::Grid(1, 1), Layout::Boxes][layout];
        let names: Vec<&str> = match layout {
            Layout::Grid(1, 1) => vec!["A"],
            Layout::Boxes => vec![],
            _ => TWELVE.to_vec(),
        };
        let cut = page.cut(&names, &options(layout));
        for (bar, _) in &page.bars {
            let p = bar.center();
            let cells = cut.cells.iter().filter(|c| covers(c, p)).count();
            let listed = cut.rejected.iter().any(|r| r.in_sheet.inflate(1.0, 1.0).contains(p));
            prop_assert!(cells <= 1, "{p:?} is in {cells} cells");
            prop_assert!(cells == 1 || listed, "{p:?} is lost: {layout:?} {:?}", cut.rejected);
        }
    }
}

#[test]
fn the_cell_of_a_space_is_empty() {
    let names = LETTERS.replace(" c L", " space uni00A0");
    let built = |empty: &[usize]| {
        let dir = project(&names, &page(empty));
        let out = khatt(dir.path(), &["build", "font.toml"]);
        let said = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(0), "{said}");
        assert!(said.contains("7 glyphs"), "{said}");
        assert!(!said.contains("the cell is empty"), "{said}");
        let warned = said.matches("a space has no ink").count();
        (font(dir.path()), warned)
    };
    let (empty, warned) = built(&[7, 8]);
    assert_eq!(warned, 0);
    let (drawn, warned) = built(&[8]);
    assert_eq!(warned, 1);
    assert_eq!(built(&[]).1, 2);
    for bytes in [empty, drawn] {
        let face = ttf_parser::Face::parse(&bytes, 0).expect("a font");
        for c in [' ', '\u{a0}'] {
            let space = face.glyph_index(c).expect("a space");
            assert!(face.glyph_bounding_box(space).is_none());
            assert!(face.glyph_hor_advance(space) > Some(0));
        }
    }
}
