//! Pages to fonts: what a project makes, and what it says when pages and names do not match.

use crate::common::desk::{BUILD, Desk, said};
use crate::common::pictures::{LETTERS, edge, encoded, page, png};
use crate::common::read::{drawn, face};
use crate::template;
use image::ImageFormat;
use khatt::numeric::coverage::blur;
use khatt::scan::{Polarity, load};
use kurbo::Shape;
use skrifa::{FontRef, raw::TableProvider};
use std::fs::File;
use std::time::SystemTime;

#[test]
fn a_page_becomes_every_output_and_again_the_same_bytes() {
    let desk = Desk::letters();
    let stderr = desk.done(&["build", "font.toml", "--jobs", "1", "--no-cache"]);
    assert!(stderr.contains("trace "), "the stages are timed: {stderr}");
    let first = desk.files("out");
    let names = [
        "test.html",
        "test.otf",
        "test.ttf",
        "test.woff2",
        "test.ufo/metainfo.plist",
    ];
    for name in names {
        assert!(
            first.contains_key(name),
            "{name} is missing from {:?}",
            first.keys()
        );
    }
    assert_eq!(
        first.keys().filter(|k| k.starts_with("svg/")).count(),
        13,
        "nine letters, two spaces, .notdef, and the list of them"
    );
    let again = desk.run(&["build", "font.toml", "--jobs", "2", "--no-cache", "--quiet"]);
    assert_eq!((again.status.code(), again.stderr.len()), (Some(0), 0));
    assert!(
        desk.files("out") == first,
        "two jobs give other bytes than one"
    );
    let left = desk.files("");
    let stray: Vec<_> = left.keys().filter(|k| k.contains(".khatt-")).collect();
    assert!(stray.is_empty(), "{stray:?}");
}

/// What is said while a font is built of a page with [`LETTERS`], and how many segments its H and l have.
fn segments(page: &[u8]) -> (Vec<usize>, String) {
    let desk = Desk::project(LETTERS, page);
    let said = desk.done(&["build", "font.toml", "--no-cache"]);
    let bytes = desk.read("out/test.otf");
    let face = face(&bytes);
    let segments = |c: char| drawn(&face, c).segments().count();
    ("Hl".chars().map(segments).collect(), said)
}

#[test]
fn a_page_out_of_focus_is_told_and_keeps_its_corners() {
    let sharp = page(&[]);
    let sheets = load(&sharp, "page.png", Polarity::DarkInk.into()).expect("a picture");
    let mut samples = sheets[0].gray.samples().to_vec();
    blur(&mut samples, 600, 3.0, 0);
    let soft = sheets[0].gray.with_samples(samples).levels();
    let soft = png(600, 600, |x, y| soft[(y * 600 + x) as usize]);
    let ((wanted, quiet), (got, told)) = (segments(&sharp), segments(&soft));
    assert!(!quiet.contains("out of focus"), "{quiet}");
    let remark = "page.png, the letters are out of focus: their edges are blurred by";
    assert!(told.contains(remark), "{told}");
    assert_eq!(got, wanted, "segments of each letter");
}

/// The page with another ink where its letters are, by column and row.
fn redrawn(ink: impl Fn(f64, f64, f64) -> f64) -> Vec<u8> {
    let sheets = load(&page(&[]), "page.png", Polarity::DarkInk.into()).expect("a picture");
    png(600, 600, |x, y| {
        let drawn = f64::from(sheets[0].gray.at(x as usize, y as usize));
        edge(0.5 - ink(drawn, f64::from(x), f64::from(y)))
    })
}

#[test]
fn ink_of_a_pen_that_shades_is_as_good_as_even_ink() {
    let pools =
        redrawn(|drawn, x, y| drawn * (0.65 + 0.35 * libm::sin(x / 11.0) * libm::cos(y / 13.0)));
    let ((wanted, _), (got, told)) = (segments(&page(&[])), segments(&pools));
    assert_eq!(got, wanted, "segments of each letter: {told}");
}

/// Four rows of six cells of 150 × 150 px with H, o and l by turns, in a light between 0 and 1.
fn lit_page(light: impl Fn(f64, f64) -> f64) -> Vec<u8> {
    png(900, 600, |x, y| {
        let light = light(f64::from(x), f64::from(y));
        let cell = y / 150 * 6 + x / 150;
        let (x, y) = (f64::from(x % 150) + 0.5, f64::from(y % 150) + 0.5);
        let bar = |x0: f64, y0: f64, x1: f64, y1: f64| {
            let distance = (x0 - x).max(x - x1).max((y0 - y).max(y - y1));
            (0.5 - distance).clamp(0.0, 1.0)
        };
        let ink = match cell % 3 {
            0 => bar(45.0, 40.0, 57.0, 110.0)
                .max(bar(93.0, 40.0, 105.0, 110.0))
                .max(bar(50.0, 69.0, 100.0, 81.0)),
            1 => (6.5 - ((x - 75.0).hypot(y - 90.0) - 20.0).abs()).clamp(0.0, 1.0),
            _ => bar(69.0, 30.0, 81.0, 110.0),
        };
        edge(light * (0.9 - 0.8 * ink) - 0.5)
    })
}

#[test]
fn letters_in_a_shadow_over_half_of_the_page_are_not_off_it() {
    let shadow = |x: f64, y: f64| {
        let beyond = x + 0.4 * (y - 300.0) - 340.0;
        1.0 - 0.5 * (beyond / 30.0).clamp(0.0, 1.0)
    };
    let cut = |picture: &[u8]| {
        let desk = Desk::project(&"H o l ".repeat(8), picture);
        desk.edit(|text| text.replace("grid = [3, 3]", "grid = [4, 6]"));
        desk.done(&["build", "font.toml", "--no-cache", "--quiet"]);
        desk.done(&["cut", "font.toml", "-o", "cells", "--quiet"]);
        let page = desk.json("cells/cells.json")[0].clone();
        assert_eq!(page["removed"], serde_json::json!([]), "{page}");
        let cells = page["cells"].as_array().expect("cells").iter();
        let boxes = cells.map(|c| serde_json::from_value(c["box_px"].clone()).expect("a box"));
        boxes.collect::<Vec<[f64; 4]>>()
    };
    let [even, shaded] = [lit_page(|_, _| 1.0), lit_page(shadow)].map(|page| cut(&page));
    assert_eq!((even.len(), shaded.len()), (24, 24));
    for (even, shaded) in even.iter().flatten().zip(shaded.iter().flatten()) {
        assert!((even - shaded).abs() <= 1.0, "{even} px, {shaded} px");
    }
}

#[test]
fn the_date_is_the_one_that_reproducible_builds_ask_for() {
    let desk = Desk::letters();
    let build = |date: &str| {
        let mut command = desk.command(&["build", "font.toml", "--quiet"]);
        command.env("SOURCE_DATE_EPOCH", date);
        command.output().expect("the program runs")
    };
    let wrong = build("yesterday");
    assert_eq!(wrong.status.code(), Some(1));
    assert!(said(&wrong).contains("SOURCE_DATE_EPOCH"), "{wrong:?}");
    assert!(!desk.has("out"), "something was written");

    assert_eq!(build("1700000000").status.code(), Some(0));
    // OpenType counts from 1904, the epoch from 1970
    let wanted = 1_700_000_000 + 2_082_844_800;
    for name in ["out/test.ttf", "out/test.otf"] {
        let bytes = desk.read(name);
        let font = FontRef::new(&bytes).expect("a font");
        let head = font.head().expect("head");
        assert_eq!(head.created().as_secs(), wanted, "{name}");
        assert_eq!(head.modified().as_secs(), wanted, "{name}");
    }
}

#[test]
fn nothing_is_done_twice() {
    let desk = Desk::letters();
    let build = |more: &[&str]| desk.done(&[&BUILD, more].concat());
    let outputs = || desk.files("out");
    assert!(
        build(&[]).contains("load "),
        "the first build reads the page"
    );
    let first = outputs();

    assert!(build(&[]).contains("nothing to do"));
    assert!(build(&["--no-cache"]).contains("load "));
    assert_eq!(outputs(), first, "kept or not, the same bytes");

    // an output that is gone comes back, without the page being read
    desk.remove("out/test.otf");
    let said = build(&[]);
    assert!(!said.contains("load ") && said.contains("write "), "{said}");
    assert_eq!(outputs(), first, "from what was kept");

    // later stages alone
    let project = desk.text("font.toml");
    let wider = project.replace("[output]", "[spacing.letters]\ntracking = 0.1\n[output]");
    desk.write("font.toml", wider);
    let said = build(&[]);
    assert!(
        !said.contains("load ") && said.contains("assemble "),
        "{said}"
    );
    assert_ne!(outputs(), first, "wider letters");

    // another picture
    desk.write("font.toml", project);
    desk.write("page.png", page(&[8]));
    let said = desk.fails(&BUILD);
    assert!(said.contains("cell 9"), "a letter is missing now: {said}");
}

#[test]
fn anchors_kerning_and_features_may_be_set_by_hand() {
    let desk = Desk::letters();
    let text = desk.text("font.toml");
    let build = |font: &str, more: &str| {
        let text = text.replace("[font]", &format!("[font]\n{font}"));
        desk.write("font.toml", format!("{text}{more}"));
        desk.told(&["build", "font.toml", "--quiet"])
    };
    let features = |text: &str| desk.write("own.fea", text);
    let own = "features = \"own.fea\"";

    // as editors on Windows begin a file
    features("\u{feff}feature ss01 {\n    sub H by o;\n} ss01;\n");
    let more = "[anchors]\nH = { top = [50, 710] }\n[kerning]\n\"H o\" = -33\n";
    assert_eq!(build(own, more), (Some(0), String::new()));
    let ufo = norad::Font::load(desk.path("out/test.ufo")).expect("a UFO");
    assert!(ufo.features.contains("sub H by o"));
    let letter = ufo.get_glyph("H").expect("the letter");
    let top = letter
        .anchors
        .iter()
        .find(|a| a.name.as_deref() == Some("top"));
    assert!(
        top.is_some_and(|a| (a.x, a.y) == (50.0, 710.0)),
        "{:?}",
        letter.anchors
    );
    let kerned = ufo.kerning.get("H").and_then(|second| second.get("o"));
    assert_eq!(kerned, Some(&-33.0));

    features("feature ss01 {\n    sub H by o;\n    sub nothing by o;\n} ss01;\n");
    let cases = [
        (own, "", "own.fea"),
        ("", "[anchors]\nH = { top = [50, 71000] }\n", "lies outside"),
        ("", "[anchors]\nQ = { top = [50, 71] }\n", "no glyph “Q”"),
        ("", "[kerning]\nHo = 3\n", "two glyph names"),
        ("", "[kerning]\n\"H Q\" = 3\n", "no glyph “Q”"),
    ];
    let before = desk.files("out");
    for (font, more, says) in cases {
        let (status, said) = build(font, more);
        assert_eq!(status, Some(1), "{more}");
        assert!(said.contains(says), "{said}");
        let line = said.contains("nothing") && said.contains('3');
        assert!(font != own || line, "{said}");
    }
    assert_eq!(desk.files("out"), before, "nothing was written");
}

#[test]
fn what_the_font_says_of_itself_and_of_repeated_letters_redoes_no_page() {
    let desk = Desk::letters();
    let kept = |table: &str| {
        desk.edit(|text| text.replacen("[font]\n", &format!("[font]\n{table}"), 1));
        desk.done(&["build", "font.toml", "--quiet", "--cache-dir", "kept"]);
        desk.files("kept").len()
    };
    assert_eq!(kept(""), 2, "a page and a build");
    let version = "version = \"2.0\"\nweight = 700\n";
    assert_eq!(kept(version), 3, "a build more");
    desk.edit(|text| format!("repeated = \"alternates\"\n{text}"));
    assert_eq!(kept(""), 4, "a build more");
    assert_eq!(kept("units_per_em = 2000\n"), 6, "letters are placed anew");
}

/// The steps of its edges are no detail of its letters.
#[test]
fn a_template_page_of_two_levels_is_smooth() {
    let (layout, pages) = template::printed(template::PROJECT);
    let grey = pages
        .iter()
        .map(|p| template::drawn(&layout, p, template::FLATBED));
    let grey: Vec<Vec<u8>> = grey.collect();
    let two = |bytes: &Vec<u8>| {
        let mut picture = image::load_from_memory(bytes)
            .expect("a picture")
            .to_luma8();
        picture
            .pixels_mut()
            .for_each(|p| p.0[0] = if p.0[0] < 128 { 0 } else { 255 });
        encoded(picture, ImageFormat::Png)
    };
    let nodes = |pages: &[Vec<u8>]| {
        let desk = template::folder(&[("1.png", &pages[0]), ("2.png", &pages[1])]);
        desk.done(&["build", "font.toml", "--no-cache"]);
        let report = desk.json("out/report.json");
        let glyphs = report["glyphs"].as_array().expect("a list").iter();
        glyphs.filter_map(|g| g["nodes"].as_u64()).sum::<u64>()
    };
    let stepped = nodes(&grey.iter().map(two).collect::<Vec<_>>());
    let even = nodes(&grey);
    assert!(
        even > 100 && stepped < even + even / 4,
        "{stepped}, {even} in grey"
    );
}

#[test]
fn what_is_kept_may_be_spoilt() {
    let desk = Desk::letters();
    let args = ["build", "font.toml", "--quiet", "--cache-dir", "kept"];
    desk.done(&args);
    let first = desk.files("out");
    let kept = desk.files("kept");
    assert_eq!(kept.len(), 2, "a page and a build: {:?}", kept.keys());
    for (cut, name) in kept.keys().enumerate() {
        let name = format!("kept/{name}");
        let mut bytes = desk.read(&name);
        let middle = bytes.len() / 2;
        if cut == 0 {
            bytes.truncate(middle);
        } else {
            bytes[middle] ^= 1;
        }
        desk.write(&name, bytes);
    }
    desk.remove("out");
    desk.done(&args);
    assert_eq!(desk.files("out"), first);
}

#[test]
fn pages_done_apart_are_merged_to_the_same_bytes() {
    let desk = Desk::letters();
    desk.write("more.png", page(&[4]));
    desk.edit(|text| text.replace("[output]", &second("A p i B _ j C q k")));
    desk.done(&["build", "font.toml", "--no-cache"]);
    let whole = desk.files("out");
    desk.remove("out");

    desk.done(&["page", "font.toml", "--sheet", "2", "-o", "second"]);
    let said = desk.fails(&["merge", "font.toml", "second"]);
    assert!(
        said.contains("sheet 1") && said.contains("khatt page"),
        "{said}"
    );
    assert!(!desk.has("out"), "something was written");

    desk.done(&["page", "font.toml", "--sheet", "1", "-o", "first"]);
    desk.done(&["merge", "font.toml", "second", "first"]);
    assert_eq!(desk.files("out"), whole);

    let said = desk.fails(&["page", "font.toml", "--sheet", "3", "-o", "third"]);
    assert!(said.contains("the project has 2 sheets"), "{said}");
    let said = desk.fails(&["merge", "font.toml", "page.png"]);
    assert!(said.contains("not what khatt page writes"), "{said}");
}

/// The table of a second page of other letters, before the outputs.
fn second(glyphs: &str) -> String {
    format!(
        "[[sheet]]\nimage = \"more.png\"\nlayout = {{ grid = [3, 3] }}\nglyphs = \"{glyphs}\"\n\
         pixels_per_em = 150\n[output]"
    )
}

#[test]
fn a_letter_stands_on_the_baseline_in_units() {
    let desk = Desk::letters();
    desk.done(&BUILD);
    let bytes = desk.read("out/test.ttf");
    let h = drawn(&face(&bytes), 'H').bounding_box();
    let units = |px: f64| px * 1000.0 / 150.0;
    // two thirds of a px at either edge
    let near = |got: f64, want: f64| (got - want).abs() <= 9.0;
    assert!(near(h.y0, 0.0) && near(h.y1, units(100.0)), "{h:?}");
    assert!(near(h.width(), units(80.0)), "{h:?}");
}

#[test]
fn pages_and_names_that_do_not_match_name_the_cells_and_write_nothing() {
    let cases = [
        ("empty-cells", LETTERS, page(&[1, 3, 5])),
        ("too-few-names", "H o l E e I N", page(&[])),
        ("too-many-names", "H o l E e I N c L x y", page(&[])),
        ("line-too-short", r"H o l\nE e\nI N c", page(&[])),
        ("unknown-name", "H o l E e I N c beh-ra.init", page(&[])),
        ("blank", LETTERS, png(600, 600, |_, _| 0)),
        ("text", LETTERS, b"no picture".to_vec()),
        ("truncated", LETTERS, truncated_jpeg()),
        ("huge", LETTERS, huge_png()),
    ];
    for (name, glyphs, picture) in cases {
        let desk = Desk::project(glyphs, &picture);
        desk.refuses(&BUILD, &format!("build-{name}"));
    }
}

#[test]
fn a_file_of_names_may_begin_with_a_byte_order_mark() {
    let desk = Desk::letters();
    let names = format!("glyphs = \"{LETTERS}\"");
    let file = "glyphs = { file = \"names.txt\" }";
    desk.edit(|text| format!("\u{feff}{}", text.replace(&names, file)));
    desk.write("names.txt", format!("\u{feff}{LETTERS}\r\n"));
    desk.done(&BUILD);
}

/// The first half of a JPEG of the page.
fn truncated_jpeg() -> Vec<u8> {
    let picture = image::load_from_memory(&page(&[])).expect("a picture");
    let bytes = encoded(picture, ImageFormat::Jpeg);
    bytes[..bytes.len() / 2].to_vec()
}

/// The header of a PNG of 60,000 × 60,000 px, and nothing else.
fn huge_png() -> Vec<u8> {
    let mut chunk = b"IHDR".to_vec();
    chunk.extend(60_000_u32.to_be_bytes());
    chunk.extend(60_000_u32.to_be_bytes());
    chunk.extend([8, 0, 0, 0, 0]);
    let sum = crc32fast::hash(&chunk).to_be_bytes();
    [&b"\x89PNG\r\n\x1a\n\0\0\0\r"[..], &chunk, &sum].concat()
}

#[test]
fn a_picture_that_is_not_there_is_named() {
    let desk = Desk::letters();
    desk.remove("page.png");
    desk.refuses(&BUILD, "build-no-picture");
}

#[test]
fn what_a_killed_build_left_is_swept_away_and_what_another_one_writes_is_not() {
    let desk = Desk::letters();
    // whose process may live on another machine, or in another container
    let (old, new, mine) = (".khatt-0-x", ".khatt-0-y", ".khatt-notes");
    for name in [old, new, mine] {
        let name = format!("out/{name}");
        desk.write(&name, "");
        if !name.ends_with(new) {
            let file = File::options().append(true).open(desk.path(&name));
            let dated = file.and_then(|f| f.set_modified(SystemTime::UNIX_EPOCH));
            dated.expect("a date");
        }
    }
    desk.done(&BUILD);
    let left: Vec<String> = desk.files("out").into_keys().collect();
    let temporary: Vec<_> = left.iter().filter(|k| k.starts_with(".khatt-")).collect();
    assert_eq!(temporary, [new, mine]);
}

#[test]
fn a_wrong_project_file_is_shown_where_it_is_wrong() {
    let desk = Desk::project("H", &page(&[]));
    let text = desk.text("font.toml");
    for (name, right, wrong) in [
        ("unknown-key", "pixels_per_em", "pixel_per_em"),
        ("wrong-type", "150", "\"large\""),
        (
            "two-scales",
            "pixels_per_em",
            "x_height = 500\npixels_per_em",
        ),
        ("no-toml", "[font]", "[font"),
    ] {
        desk.write("font.toml", text.replacen(right, wrong, 1));
        desk.refuses(&BUILD, &format!("project-{name}"));
    }
}

#[test]
fn cells_are_cut_and_listed() {
    let desk = Desk::letters();
    desk.done(&["cut", "font.toml", "-o", "cells"]);
    let cells = desk.files("cells");
    assert_eq!(cells.len(), 11, "{:?}", cells.keys());
    let list = desk.json("cells/cells.json");
    let first = &list[0]["cells"][0];
    assert_eq!(
        (first["label"].as_str(), first["cell"].as_u64()),
        (Some("H"), Some(1))
    );
    assert!(cells.contains_key(first["picture"].as_str().expect("a name")));
}

#[test]
fn a_folder_with_somebodys_files_is_not_replaced() {
    let desk = Desk::letters();
    desk.write("out/svg/letter.txt", "mine");
    let said = desk.fails(&BUILD);
    let stranger = "letter.txt, which khatt did not make";
    assert!(said.contains(stranger), "{said}");
    assert_eq!(
        desk.files("out").len(),
        1,
        "nothing is written, nothing is lost"
    );
}

#[test]
fn a_changed_correction_redoes_no_other_page() {
    let desk = Desk::letters();
    desk.write("more.png", page(&[]));
    desk.edit(|text| text.replace("[output]", &second("A p i B j C q k r")));
    let build = ["build", "font.toml", "--quiet", "--cache-dir", "kept"];
    let kept = || desk.files("kept").len();
    desk.done(&build);
    assert_eq!(kept(), 3, "two pages and a build");
    desk.edit(|text| format!("{text}[cells.p]\nbaseline_shift = 9\n"));
    desk.done(&build);
    assert_eq!(kept(), 5, "one page and a build more");
}
