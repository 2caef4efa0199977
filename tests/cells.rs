//! Cells of pages as they come: corrections of single letters, other inks, what is left out and why.

use crate::common::desk::{BUILD, Desk};
use crate::common::pictures::{LETTERS, bar, edge, encoded, page, png, ring};
use crate::common::read::{drawn, face, set};
use image::{GrayImage, ImageFormat, imageops};
use khatt::scan::{self, Ink, Layout, Options, Polarity, Scale};
use khatt::types::{Cell, Label};
use kurbo::{Point, Rect};
use proptest::collection::vec;
use proptest::prelude::ProptestConfig;
use proptest::{prop_assert, proptest};

/// The page of nine letters with a correction.
fn corrected(picture: &[u8], correction: &str) -> Desk {
    let desk = Desk::project(LETTERS, picture);
    desk.edit(|text| format!("{text}\n{correction}\n"));
    desk
}

/// The font of a project, built.
fn font(desk: &Desk) -> Vec<u8> {
    desk.done(&BUILD);
    desk.read("out/test.ttf")
}

fn bounds_in(font: &[u8], letter: char) -> Option<ttf_parser::Rect> {
    let face = face(font);
    face.glyph_bounding_box(face.glyph_index(letter)?)
}

/// A letter's box in the font, if it is there.
fn bounds(correction: &str, picture: &[u8], letter: char) -> Option<ttf_parser::Rect> {
    bounds_in(&font(&corrected(picture, correction)), letter)
}

#[test]
fn what_was_found_can_be_written_and_builds_the_same_font() {
    let desk = Desk::letters();
    let before = font(&desk);
    desk.done(&["cut", "font.toml", "--write-overrides", "cells.toml"]);
    let cells = desk.text("cells.toml");
    assert_eq!(cells.matches("box = ").count(), 9, "{cells}");
    desk.edit(|text| format!("cells_file = \"cells.toml\"\n{text}"));
    let found = font(&desk);
    assert!(found == before, "the cells as found make another font");
}

#[test]
fn words_are_no_cells_to_correct() {
    let desk = Desk::letters();
    let words = "[[sheet]]\nimage = \"page.png\"\nlayout = { grid = [3, 3] }\ncontent = \"words\"\npixels_per_em = 100\n\
        glyphs = \"aa ab ac ba bb bc ca cb cc\"\n\n[output]";
    desk.edit(|text| text.replacen("[output]", words, 1));
    desk.done(&["cut", "font.toml", "--write-overrides", "cells.toml"]);
    let cells = desk.text("cells.toml");
    assert_eq!(cells.matches("box = ").count(), 9, "{cells}");
    desk.edit(|text| format!("cells_file = \"cells.toml\"\n{text}"));
    desk.done(&["cut", "font.toml", "-o", "cells"]);
}

#[test]
fn a_picture_that_says_how_it_tells_light_is_asked_where_tones_say_so() {
    let plain = page(&[]);
    // as sRGB: length, kind and intent of the chunk, and its sum
    let chunk = b"\0\0\0\x01sRGB\0\xae\xce\x1c\xe9";
    let told = [&plain[..33], chunk.as_slice(), &plain[33..]].concat();
    let with = |picture: &[u8], tones: &str| {
        let desk = Desk::project(LETTERS, picture);
        desk.edit(|text| text.replacen("[[sheet]]", &format!("[[sheet]]\n{tones}"), 1));
        desk
    };
    let [asked, srgb, linear] = ["tones = \"profile\"", "tones = \"srgb\"", ""].map(|tones| {
        let desk = with(&told, tones);
        let said = desk.done(&BUILD);
        assert!(!said.contains("tones"), "{said}");
        desk.read("out/test.ttf")
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
        let said = with(picture, tones).done(&["cut", "font.toml", "-o", "cells"]);
        let note = "note: page.png says itself how much light its numbers stand for";
        assert_eq!(said.contains(note), noted, "{said}");
    }
    let said = with(&plain, "tones = \"profile\"").fails(&BUILD);
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

#[test]
fn tension_is_set_for_one_letter() {
    let plain = page(&[]);
    let letters = |tension: &str| {
        let correction = format!("[cells.o.trace.fit]\nmethod = \"gc2\"\n{tension}");
        let bytes = font(&corrected(&plain, &correction));
        let face = face(&bytes);
        ['o', 'H'].map(|letter| drawn(&face, letter))
    };
    let [loose, tight] = ["point_tension = 0.0", "point_tension = 40.0"].map(letters);
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
        let desk = Desk::project(LETTERS, &picture);
        desk.edit(|text| text.replace("[[sheet]]", &format!("[[sheet]]\nturn = {degrees}")));
        assert_eq!(bounds_in(&font(&desk), 'H'), Some(upright), "{degrees}");
    }
}

#[test]
fn several_drawings_of_a_glyph_are_settled() {
    let with = |repeated: &str| {
        let desk = Desk::project("H o l H e I N c L", &page(&[]));
        desk.edit(|text| format!("{repeated}\n{text}"));
        desk
    };
    let built = |repeated: &str, note: &str| {
        let desk = with(repeated);
        let said = desk.done(&BUILD);
        assert!(said.contains(note), "{said}");
        desk.read("out/test.ttf")
    };
    let calmest = "H: drawn 2 times; the drawing with the calmest edge";
    let best = built("", calmest);
    let bytes = built("repeated = \"alternates\"", "");
    let both = face(&bytes);
    assert_eq!(both.number_of_glyphs(), face(&best).number_of_glyphs() + 1);
    assert!(both.glyph_index_by_name("H.ss01").is_some());
    let set = set(&bytes, "HHHoHoH").join(" ");
    assert_eq!(set, "H H.ss01 H o H.ss01 o H");
    let between = "H: drawn 2 times; the one in the middle";
    let middle = built("repeated = \"median\"", between);
    let width = |font: &[u8]| bounds_in(font, 'H').expect("H").width();
    // 80 px of 150 an em; both drawings are alike
    assert!(width(&middle).abs_diff(width(&best)) <= 4);
    with("repeated = \"error\"").refuses(&BUILD, "build-twice");
    let sets = both.tables().gsub.map(|g| {
        g.features
            .into_iter()
            .any(|f| f.tag == ttf_parser::Tag::from_bytes(b"ss01"))
    });
    assert_eq!(sets, Some(true));
}

#[test]
fn a_drawing_that_lost_its_dot_is_not_taken() {
    // cells of 200 × 200 px: stems without a dot, with one and with a dot and a dash below it, and six o
    let page = |drawn: [u32; 3]| {
        png(600, 600, |x, y| {
            let (dx, dy) = (x % 200, y % 200);
            let stem = (90..110).contains(&dx) && (80..150).contains(&dy);
            let dot = dx.abs_diff(100).pow(2) + dy.abs_diff(55).pow(2) < 144;
            let dash = (70..130).contains(&dx) && (170..182).contains(&dy);
            match (drawn[(x / 200) as usize], y / 200) {
                (pieces, 0) => 255 * u8::from(stem || dot && pieces > 1 || dash && pieces > 2),
                _ => rings(x, y),
            }
        })
    };
    let taken = |name: &str, drawn: [u32; 3]| {
        let names = format!("{name} {name} {name} o o o o o o");
        let desk = Desk::project(&names, &page(drawn));
        let said = desk.done(&BUILD);
        let taken = (1..=3).find(|i| said.contains(&format!("taken, page.png, cell {i} ")));
        taken.expect(&said)
    };
    // as the name says, and where it does not as most are drawn
    assert_eq!(taken("i", [1, 2, 3]), 2);
    assert_eq!(taken("i", [3, 3, 2]), 3);
    assert_eq!(taken("section", [3, 1, 3]) % 2, 1);
}

#[test]
fn drawings_beyond_the_stylistic_sets_are_told() {
    let glyphs = ["o"; 24].join(" ");
    let desk = Desk::project(&glyphs, &png(1000, 1000, rings));
    desk.edit(|text| {
        let text = text.replace("[3, 3]", "[5, 5]");
        format!("repeated = \"alternates\"\n{text}")
    });
    let stderr = desk.done(&BUILD);
    let note =
        "o: drawn 24 times; there are 20 stylistic sets, and the last 3 drawings are left out";
    assert!(stderr.contains(note), "{stderr}");
}

/// Cells of 200 × 200 px with an o in each but the last.
fn rings(x: u32, y: u32) -> u8 {
    if (x / 200, y / 200) == (4, 4) {
        return 0;
    }
    let at = (f64::from(x % 200) + 0.5, f64::from(y % 200) + 0.5);
    ring(at, (100.0, 116.0))
}

/// Letters n, i, p and l by turns in 4 × 5 cells of 150 px, as named in NIPL.
fn nipl(x: u32, y: u32) -> u8 {
    let kind = b"nipl"[((y / 150 * 5 + x / 150) % 4) as usize];
    let at = (f64::from(x % 150) + 0.5, f64::from(y % 150) + 0.5);
    let bar = |x0: f64, y0: f64, x1: f64, y1: f64| bar(at, [x0, y0, x1, y1]);
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
    let upright = GrayImage::from_fn(750, 600, |x, y| image::Luma([255 - nipl(x, y)]));
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
            let desk = Desk::new();
            desk.write("page.png", encoded(lying, ImageFormat::Png));
            let text = format!(
                "repeated = \"best\"\n[font]\nfamily = \"T\"\n[[sheet]]\nimage = \"page.png\"\nlayout = {layout}\nglyphs = \"{names}\"\npixels_per_em = 100\n"
            );
            desk.write("font.toml", text);
            let said = desk.done(&["cut", "font.toml", "-o", "cells"]);
            let list = desk.json("cells/cells.json");
            let cells = list[0]["cells"].as_array().expect("cells");
            assert_eq!(cells.len(), 20);
            for (i, cell) in cells.iter().enumerate() {
                let at = |k: usize| cell["box_px"][k].as_f64().expect("a number");
                let (x, y) = (150.0 * (i % 5) as f64, 150.0 * (i / 5) as f64);
                let fine = at(0) >= x && at(2) <= x + 150.0 && at(1) >= y && at(3) <= y + 150.0;
                assert!(fine, "{layout}, {turn}, cell {i}: {cell}");
            }
            let listed = list[0]["warnings"].to_string();
            for said in [listed, said] {
                let told = said.contains(&format!("turn = {turn},"));
                assert_eq!(told, turn != 0, "{said}");
            }
        }
    }
}

#[test]
fn one_drawing_in_two_cells_is_noticed() {
    // the page repeats its three shapes in every row
    let said = Desk::letters().done(&BUILD);
    let note = "its outline is that of page.png, cell";
    assert_eq!(said.matches(note).count(), 6, "{said}");
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
        corrected(&page(&[]), text).refuses(&BUILD, &format!("cells-{name}"));
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
        encoded(picture, ImageFormat::Png)
    }

    fn cut(&self, names: &[&str], options: &Options) -> scan::Cut {
        let sheets = scan::load(&self.png(), "page", Polarity::DarkInk.into()).expect("a picture");
        let sheet = sheets.into_iter().next().expect("one page");
        let page = scan::clean(sheet, scan::Texture::default()).expect("ink");
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
    let desk = Desk::letters();
    desk.edit(|text| text.replace("layout =", "ink = \"red\"\nlayout ="));
    let build = ["build", "font.toml", "--no-cache"];
    let grey = desk.done(&build);
    assert!(
        grey.contains("the picture has no colours, so `ink` tells nothing apart"),
        "{grey}"
    );
    desk.remove("out");
    // the same page as a colour scanner gives it: all ink is black
    let picture = image::load_from_memory(&page(&[]))
        .expect("a picture")
        .to_rgb8();
    picture.save(desk.path("page.png")).expect("a picture");
    let black = desk.fails(&build);
    assert!(
        black.contains("none of the colour that `ink` asks for (#"),
        "{black}"
    );
    assert!(!desk.has("out"), "nothing is written");
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
        let desk = Desk::project(&names, &page(empty));
        let said = desk.done(&BUILD);
        assert!(said.contains("7 glyphs"), "{said}");
        assert!(!said.contains("the cell is empty"), "{said}");
        (desk.read("out/test.ttf"), said)
    };
    let no_ink = "a space has no ink";
    let (empty, said) = built(&[7, 8]);
    assert!(!said.contains(no_ink), "{said}");
    let (drawn, said) = built(&[8]);
    assert!(
        said.contains(&format!("cell 8 “space”: {no_ink}")),
        "{said}"
    );
    let (_, said) = built(&[]);
    let both = format!("cells 8 “space”, 9 “uni00A0”: {no_ink}");
    assert!(said.contains(&both), "{said}");
    for bytes in [empty, drawn] {
        let face = face(&bytes);
        for c in [' ', '\u{a0}'] {
            let space = face.glyph_index(c).expect("a space");
            assert!(face.glyph_bounding_box(space).is_none());
            assert!(face.glyph_hor_advance(space) > Some(0));
        }
    }
}

#[test]
fn corrections_of_the_project_go_before_those_of_its_file_however_a_glyph_is_spelled() {
    let desk = Desk::project(&LETTERS.replace('e', "é"), &page(&[]));
    desk.edit(|text| format!("cells_file = \"cells.toml\"\n{text}[cells.eacute]\nrotation = 1\n"));
    desk.write("cells.toml", "[\"é\"]\nignore = true\n");
    assert!(bounds_in(&font(&desk), 'é').is_some());
    // the other way round in the alphabet
    desk.edit(|text| text.replace("[cells.eacute]", "[cells.\"é\"]"));
    desk.write("cells.toml", "[eacute]\nignore = true\n");
    assert!(bounds_in(&font(&desk), 'é').is_some());
    desk.edit(|text| format!("{text}[cells.eacute]\nignore = true\n"));
    let said = desk.fails(&BUILD);
    assert!(said.contains("two tables"), "{said}");
}

#[test]
fn what_is_no_file_of_corrections_is_told_as_that() {
    let desk = corrected(&page(&[]), "");
    desk.edit(|text| format!("cells_file = \"cells.toml\"\n{text}"));
    desk.write("cells.toml", "[o]\nbox = \"left\"\n");
    let said = desk.fails(&BUILD);
    assert!(
        said.contains("cells.toml") && said.contains("--write-overrides"),
        "{said}"
    );
    assert!(!said.contains("paths start from"), "{said}");
    desk.remove("cells.toml");
    assert!(desk.fails(&BUILD).contains("paths start from"));
}

#[test]
fn drawings_of_sizes_that_have_no_middle_are_refused() {
    let desk = Desk::letters();
    desk.write("more.png", page(&[]));
    let more = "[[sheet]]\nimage = \"more.png\"\nlayout = { grid = [3, 3] }\nglyphs = \"H p i B j C q k r\"\n\
        pixels_per_em = 15\n[output]";
    desk.edit(|text| {
        let text = text.replace("[output]", more);
        format!("repeated = \"median\"\n{text}")
    });
    let said = desk.fails(&BUILD);
    assert!(
        said.contains("page.png, cell 1 “H”") && said.contains("more.png, cell 1 “H”"),
        "{said}"
    );
}
