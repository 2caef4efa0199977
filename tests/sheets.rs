//! Pages to fonts: what a project makes, and what it says when pages and names do not match.
#![expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who writes files"
)]

use crate::cli::{command, khatt, png, transcript};
use crate::common::approved;
use khatt::numeric::coverage::blur;
use khatt::scan::{Polarity, load};
use skrifa::{
    FontRef, MetadataProvider,
    instance::{LocationRef, Size},
    outline::{DrawSettings, OutlinePen},
    raw::TableProvider,
};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread::{sleep, spawn};
use std::time::{Duration, SystemTime};

/// Where the grey of a drawn edge begins and ends, px.
pub(crate) fn edge(distance: f64) -> u8 {
    let ink = (0.5 - distance).clamp(0.0, 1.0) * 255.0;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0…255 by the clamp"
    )]
    let level = ink.round() as u8;
    level
}

/// Nine cells of 200 × 200 px, three a row, all but those of `empty` with a letter: H, o and l by turns.
pub(crate) fn page(empty: &[usize]) -> Vec<u8> {
    png(600, 600, |x, y| {
        let cell = (y / 200 * 3 + x / 200) as usize;
        let (x, y) = (f64::from(x % 200) + 0.5, f64::from(y % 200) + 0.5);
        if empty.contains(&cell) {
            return 0;
        }
        let bar = |x0: f64, y0: f64, x1: f64, y1: f64| {
            edge((x0 - x).max(x - x1).max((y0 - y).max(y - y1)))
        };
        match cell % 3 {
            0 => bar(60.0, 50.0, 76.0, 150.0)
                .max(bar(124.0, 50.0, 140.0, 150.0))
                .max(bar(70.0, 92.0, 130.0, 108.0)),
            1 => edge(((x - 100.0).hypot(y - 116.0) - 26.0).abs() - 9.0),
            _ => bar(92.0, 40.0, 108.0, 150.0),
        }
    })
}

/// Names for them.
pub(crate) const LETTERS: &str = "H o l E e I N c L";

/// A folder with a project of these glyphs on `page.png`.
pub(crate) fn project(glyphs: &str, picture: &[u8]) -> tempfile::TempDir {
    let dir = tempfile::tempdir().expect("a folder");
    let text = format!(
        "[font]\nfamily = \"Test\"\n[[sheet]]\nimage = \"page.png\"\nlayout = {{ grid = [3, 3] }}\n\
         glyphs = \"{glyphs}\"\npixels_per_em = 150\n[output]\nttf = \"out/test.ttf\"\notf = \"out/test.otf\"\n\
         woff2 = \"out/test.woff2\"\nufo = \"out/test.ufo\"\nsvg = \"out/svg\"\nproof = \"out/test.html\"\n"
    );
    fs::write(dir.path().join("font.toml"), text).expect("a project");
    fs::write(dir.path().join("page.png"), picture).expect("a picture");
    dir
}

/// Every file below a folder, by its path.
pub(crate) fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut out = BTreeMap::new();
    let mut folders = vec![folder.to_owned()];
    while let Some(at) = folders.pop() {
        for entry in fs::read_dir(at).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() {
                folders.push(path);
            } else {
                let name = path.strip_prefix(folder).expect("below the folder");
                out.insert(name.display().to_string(), fs::read(&path).expect("a file"));
            }
        }
    }
    out
}

#[test]
fn a_page_becomes_every_output_and_again_the_same_bytes() {
    let dir = project(LETTERS, &page(&[]));
    let out = khatt(
        dir.path(),
        &["build", "font.toml", "--jobs", "1", "--no-cache"],
    );
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{stderr}");
    assert!(stderr.contains("trace "), "the stages are timed: {stderr}");
    let first = files(&dir.path().join("out"));
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
    let again = khatt(
        dir.path(),
        &["build", "font.toml", "--jobs", "2", "--no-cache", "--quiet"],
    );
    assert_eq!((again.status.code(), again.stderr.len()), (Some(0), 0));
    assert!(
        files(&dir.path().join("out")) == first,
        "two jobs give other bytes than one"
    );
    let left = files(dir.path());
    let stray: Vec<_> = left.keys().filter(|k| k.contains(".khatt-")).collect();
    assert!(stray.is_empty(), "{stray:?}");
}

/// How many lines and curves an outline has.
struct Segments(usize);

impl OutlinePen for Segments {
    fn move_to(&mut self, _: f32, _: f32) {}
    fn line_to(&mut self, _: f32, _: f32) {
        self.0 += 1;
    }
    fn quad_to(&mut self, _: f32, _: f32, _: f32, _: f32) {
        self.0 += 1;
    }
    fn curve_to(&mut self, _: f32, _: f32, _: f32, _: f32, _: f32, _: f32) {
        self.0 += 1;
    }
    fn close(&mut self) {}
}

/// What is said while a font is built of a page with [`LETTERS`], and how many segments its H and l have.
fn segments(page: &[u8]) -> (Vec<usize>, String) {
    let dir = project(LETTERS, page);
    let out = khatt(dir.path(), &["build", "font.toml", "--no-cache"]);
    let stderr = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(0), "{stderr}");
    let bytes = fs::read(dir.path().join("out/test.otf")).expect("a font");
    let font = FontRef::new(&bytes).expect("a font");
    let points = |c: char| {
        let glyph = font.charmap().map(c).expect("a letter that was named");
        let mut pen = Segments(0);
        let size = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
        let outline = font.outline_glyphs().get(glyph).expect("its outline");
        outline.draw(size, &mut pen).expect("it can be drawn");
        pen.0
    };
    ("Hl".chars().map(points).collect(), stderr)
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
    let pools = redrawn(|drawn, x, y| drawn * (0.65 + 0.35 * (x / 11.0).sin() * (y / 13.0).cos()));
    let ((wanted, _), (got, told)) = (segments(&page(&[])), segments(&pools));
    assert_eq!(got, wanted, "segments of each letter: {told}");
}

#[test]
fn letters_in_a_shadow_over_half_of_the_page_are_not_off_it() {
    let shadow = |x: f64, y: f64| {
        let beyond = x + 0.4 * (y - 300.0) - 340.0;
        1.0 - 0.5 * (beyond / 30.0).clamp(0.0, 1.0)
    };
    // four rows of six cells of 150 × 150 px with H, o and l by turns
    let picture = png(900, 600, |x, y| {
        let light = shadow(f64::from(x), f64::from(y));
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
    });
    let dir = project(&"H o l ".repeat(8), &picture);
    let text = fs::read_to_string(dir.path().join("font.toml")).expect("a project");
    let text = text.replace("grid = [3, 3]", "grid = [4, 6]");
    fs::write(dir.path().join("font.toml"), text).expect("a project");
    let out = khatt(dir.path(), &["build", "font.toml", "--no-cache", "--quiet"]);
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(0), "{stderr}");
}

#[test]
fn the_date_is_the_one_that_reproducible_builds_ask_for() {
    let dir = project(LETTERS, &page(&[]));
    let build = |date: &str| {
        let mut command = command(dir.path(), &["build", "font.toml", "--quiet"]);
        command.env("SOURCE_DATE_EPOCH", date);
        command.output().expect("the program runs")
    };
    let wrong = build("yesterday");
    assert_eq!(wrong.status.code(), Some(1));
    let stderr = String::from_utf8_lossy(&wrong.stderr);
    assert!(stderr.contains("SOURCE_DATE_EPOCH"), "{stderr}");
    assert!(!dir.path().join("out").exists(), "something was written");

    assert_eq!(build("1700000000").status.code(), Some(0));
    // OpenType counts from 1904, the epoch from 1970
    let wanted = 1_700_000_000 + 2_082_844_800;
    for name in ["out/test.ttf", "out/test.otf"] {
        let bytes = fs::read(dir.path().join(name)).expect("a font");
        let font = FontRef::new(&bytes).expect("a font");
        let head = font.head().expect("head");
        assert_eq!(head.created().as_secs(), wanted, "{name}");
        assert_eq!(head.modified().as_secs(), wanted, "{name}");
    }
}

#[test]
fn nothing_is_done_twice() {
    let dir = project(LETTERS, &page(&[]));
    let build = |more: &[&str]| {
        let out = khatt(dir.path(), &[&["build", "font.toml"], more].concat());
        let stderr = String::from_utf8_lossy(&out.stderr).into_owned();
        assert_eq!(out.status.code(), Some(0), "{stderr}");
        stderr
    };
    let outputs = || files(&dir.path().join("out"));
    assert!(
        build(&[]).contains("load "),
        "the first build reads the page"
    );
    let first = outputs();

    assert!(build(&[]).contains("nothing to do"));
    assert!(build(&["--no-cache"]).contains("load "));
    assert_eq!(outputs(), first, "kept or not, the same bytes");

    // an output that is gone comes back, without the page being read
    fs::remove_file(dir.path().join("out/test.otf")).expect("an output");
    let said = build(&[]);
    assert!(!said.contains("load ") && said.contains("write "), "{said}");
    assert_eq!(outputs(), first, "from what was kept");

    // later stages alone
    let project = fs::read_to_string(dir.path().join("font.toml")).expect("the project");
    let wider = project.replace("[output]", "[spacing.letters]\ntracking = 0.1\n[output]");
    fs::write(dir.path().join("font.toml"), wider).expect("the project");
    let said = build(&[]);
    assert!(
        !said.contains("load ") && said.contains("assemble "),
        "{said}"
    );
    assert_ne!(outputs(), first, "wider letters");

    // another picture
    fs::write(dir.path().join("font.toml"), project).expect("the project");
    fs::write(dir.path().join("page.png"), page(&[8])).expect("a picture");
    let out = khatt(dir.path(), &["build", "font.toml"]);
    assert_eq!(out.status.code(), Some(1), "a letter is missing now");
}

#[test]
fn anchors_kerning_and_features_may_be_set_by_hand() {
    let dir = project(LETTERS, &page(&[]));
    let text = fs::read_to_string(dir.path().join("font.toml")).expect("the project");
    let build = |font: &str, more: &str| {
        let text = text.replace("[font]", &format!("[font]\n{font}"));
        fs::write(dir.path().join("font.toml"), format!("{text}{more}")).expect("the project");
        khatt(dir.path(), &["build", "font.toml", "--quiet"])
    };
    let features = |text: &str| fs::write(dir.path().join("own.fea"), text).expect("features");
    let own = "features = \"own.fea\"";

    features("feature ss01 {\n    sub H by o;\n} ss01;\n");
    let out = build(
        own,
        "[anchors]\nH = { top = [50, 710] }\n[kerning]\n\"H o\" = -33\n",
    );
    assert_eq!(
        out.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&out.stderr)
    );
    let ufo = norad::Font::load(dir.path().join("out/test.ufo")).expect("a UFO");
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
    let before = files(&dir.path().join("out"));
    for (font, more, says) in cases {
        let out = build(font, more);
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(1), "{more}");
        assert!(stderr.contains(says), "{stderr}");
        if font == own {
            assert!(
                stderr.contains("nothing") && stderr.contains('3'),
                "the line: {stderr}"
            );
        }
    }
    assert_eq!(
        files(&dir.path().join("out")),
        before,
        "nothing was written"
    );
}

#[test]
fn what_is_kept_may_be_spoilt() {
    let dir = project(LETTERS, &page(&[]));
    let args = ["build", "font.toml", "--quiet", "--cache-dir", "kept"];
    assert_eq!(khatt(dir.path(), &args).status.code(), Some(0));
    let first = files(&dir.path().join("out"));
    let kept = files(&dir.path().join("kept"));
    assert_eq!(kept.len(), 2, "a page and a build: {:?}", kept.keys());
    for (cut, name) in kept.keys().enumerate() {
        let path = dir.path().join("kept").join(name);
        let mut bytes = fs::read(&path).expect("an entry");
        let middle = bytes.len() / 2;
        if cut == 0 {
            bytes.truncate(middle);
        } else {
            bytes[middle] ^= 1;
        }
        fs::write(&path, bytes).expect("an entry");
    }
    fs::remove_dir_all(dir.path().join("out")).expect("outputs");
    assert_eq!(khatt(dir.path(), &args).status.code(), Some(0));
    assert_eq!(files(&dir.path().join("out")), first);
}

#[test]
fn pages_done_apart_are_merged_to_the_same_bytes() {
    let dir = project(LETTERS, &page(&[]));
    fs::write(dir.path().join("more.png"), page(&[4])).expect("a picture");
    let text = fs::read_to_string(dir.path().join("font.toml")).expect("the project");
    let second = "[[sheet]]\nimage = \"more.png\"\nlayout = { grid = [3, 3] }\n\
                  glyphs = \"A p i B _ j C q k\"\npixels_per_em = 150\n[output]";
    fs::write(
        dir.path().join("font.toml"),
        text.replace("[output]", second),
    )
    .expect("a project");
    let run = |args: &[&str]| {
        let out = khatt(dir.path(), &[args, &["--quiet"]].concat());
        (
            out.status.code(),
            String::from_utf8_lossy(&out.stderr).into_owned(),
        )
    };
    let built = run(&["build", "font.toml", "--no-cache"]);
    assert_eq!(built.0, Some(0), "{}", built.1);
    let whole = files(&dir.path().join("out"));
    fs::remove_dir_all(dir.path().join("out")).expect("outputs");

    let page = |n: &str, to: &str| run(&["page", "font.toml", "--sheet", n, "-o", to]);
    assert_eq!(page("2", "second").0, Some(0));
    let (status, said) = run(&["merge", "font.toml", "second"]);
    assert_eq!(status, Some(1));
    assert!(
        said.contains("sheet 1") && said.contains("khatt page"),
        "{said}"
    );
    assert!(!dir.path().join("out").exists(), "something was written");

    assert_eq!(page("1", "first").0, Some(0));
    let (status, said) = run(&["merge", "font.toml", "second", "first"]);
    assert_eq!(status, Some(0), "{said}");
    assert_eq!(files(&dir.path().join("out")), whole);

    assert!(page("3", "third").1.contains("the project has 2 sheets"));
    assert!(
        run(&["merge", "font.toml", "page.png"])
            .1
            .contains("no result")
    );
}

/// What the address answers.
fn fetch(address: &str, path: &str) -> String {
    let mut stream = TcpStream::connect(address).expect("a server");
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\n\r\n").expect("a request");
    let mut answer = String::new();
    stream.read_to_string(&mut answer).expect("an answer");
    answer
}

/// `khatt watch` in a folder.
struct Watched {
    child: Child,
    address: String,
}

impl Watched {
    fn new(folder: &Path) -> Self {
        let mut command = command(folder, &["watch", "font.toml", "--port", "0"]);
        let mut child = command.stderr(Stdio::piped()).spawn().expect("khatt runs");
        let mut lines = BufReader::new(child.stderr.take().expect("its words")).lines();
        let first = lines.next().expect("a line").expect("text");
        let address = first.split('/').nth(2).expect("an address").to_owned();
        // it goes on talking
        spawn(move || lines.for_each(drop));
        Self { child, address }
    }

    /// Whether its page comes to hold that text.
    fn shows(&self, text: &str) -> bool {
        // a minute is enough on a machine that does much else
        (0..1200).any(|_| {
            sleep(Duration::from_millis(50));
            fetch(&self.address, "/").contains(text)
        })
    }
}

impl Drop for Watched {
    fn drop(&mut self) {
        self.child.kill().expect("it ends");
        self.child.wait().expect("it has ended");
    }
}

#[test]
fn a_watched_project_is_built_again_when_a_page_changes() {
    let dir = project(LETTERS, &page(&[]));
    let watched = Watched::new(dir.path());
    assert!(watched.shows("Test Regular"), "the first build");
    assert!(dir.path().join("out/test.ttf").exists());
    fs::write(dir.path().join("page.png"), page(&[8])).expect("a picture");
    assert!(watched.shows("cell 9"), "the empty cell is named");
    assert!(fetch(&watched.address, "/other").starts_with("HTTP/1.1 404"));
}

#[test]
fn a_watched_project_is_built_when_what_was_missing_comes() {
    let dir = project(LETTERS, &page(&[]));
    let (toml, png) = (dir.path().join("font.toml"), dir.path().join("page.png"));
    let text = fs::read_to_string(&toml).expect("the project");
    fs::write(&toml, text.replace("page.png", "scans/new/page.png")).expect("a project");
    let watched = Watched::new(dir.path());
    assert!(watched.shows("scans/new/page.png"), "the page is missed");
    fs::create_dir_all(dir.path().join("scans/new")).expect("a folder");
    fs::rename(png, dir.path().join("scans/new/page.png")).expect("a picture");
    assert!(watched.shows("Test Regular"), "a build of the picture");
    fs::remove_file(&toml).expect("the project");
    assert!(watched.shows("font.toml"), "the project is missed");
    fs::write(&toml, text.replace("page.png", "gone.png")).expect("a project");
    assert!(watched.shows("gone.png"), "the new project");
}

#[test]
fn a_letter_stands_on_the_baseline_in_units() {
    let dir = project(LETTERS, &page(&[]));
    khatt(dir.path(), &["build", "font.toml"]);
    let bytes = fs::read(dir.path().join("out/test.ttf")).expect("the font");
    let face = ttf_parser::Face::parse(&bytes, 0).expect("a font");
    let bounds = |c: char| {
        let id = face.glyph_index(c).expect("a character of the font");
        face.glyph_bounding_box(id).expect("a shape")
    };
    let units = |px: f64| px * 1000.0 / 150.0;
    // two thirds of a px at either edge
    let near = |got: i16, want: f64| (f64::from(got) - want).abs() <= 9.0;
    let h = bounds('H');
    assert!(near(h.y_min, 0.0) && near(h.y_max, units(100.0)), "{h:?}");
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
        let dir = project(glyphs, &picture);
        let args = ["build", "font.toml"];
        let out = khatt(dir.path(), &args);
        assert_eq!(out.status.code(), Some(1), "{name}");
        assert!(
            !dir.path().join("out").exists(),
            "{name}: nothing may be written"
        );
        approved::check("cli", &format!("build-{name}"), &transcript(&args, &out));
    }
}

#[test]
fn a_file_of_names_may_begin_with_a_byte_order_mark() {
    let dir = project(LETTERS, &page(&[]));
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    let names = format!("glyphs = \"{LETTERS}\"");
    let text = text.replace(&names, "glyphs = { file = \"names.txt\" }");
    fs::write(&path, format!("\u{feff}{text}")).expect("a project");
    fs::write(
        dir.path().join("names.txt"),
        format!("\u{feff}{LETTERS}\r\n"),
    )
    .expect("names");
    let out = khatt(dir.path(), &["build", "font.toml"]);
    assert_eq!(out.status.code(), Some(0), "{out:?}");
}

/// The first half of a JPEG of the page.
fn truncated_jpeg() -> Vec<u8> {
    let picture = image::load_from_memory(&page(&[])).expect("a picture");
    let mut bytes = std::io::Cursor::new(Vec::new());
    let written = picture.write_to(&mut bytes, image::ImageFormat::Jpeg);
    written.expect("a picture in memory");
    let bytes = bytes.into_inner();
    bytes[..bytes.len() / 2].to_vec()
}

/// The header of a PNG of 60,000 × 60,000 px, and nothing else.
fn huge_png() -> Vec<u8> {
    let mut chunk = b"IHDR".to_vec();
    chunk.extend(60_000_u32.to_be_bytes());
    chunk.extend(60_000_u32.to_be_bytes());
    chunk.extend([8, 0, 0, 0, 0]);
    let crc = chunk.iter().fold(!0_u32, |crc, &byte| {
        (0..8).fold(crc ^ u32::from(byte), |c, _| {
            (c >> 1) ^ if c & 1 == 1 { 0xEDB8_8320 } else { 0 }
        })
    });
    let header = [
        &b"\x89PNG\r\n\x1a\n\0\0\0\r"[..],
        &chunk,
        &(!crc).to_be_bytes(),
    ];
    header.concat()
}

#[test]
fn a_picture_that_is_not_there_is_named() {
    let dir = project(LETTERS, &page(&[]));
    fs::remove_file(dir.path().join("page.png")).expect("a file");
    let args = ["build", "font.toml"];
    let out = khatt(dir.path(), &args);
    assert_eq!(out.status.code(), Some(1));
    approved::check("cli", "build-no-picture", &transcript(&args, &out));
}

#[test]
fn what_a_killed_build_left_is_swept_away_and_what_another_one_writes_is_not() {
    let dir = project(LETTERS, &page(&[]));
    let out = dir.path().join("out");
    fs::create_dir_all(&out).expect("a folder");
    // whose process may live on another machine, or in another container
    let (old, new, mine) = (".khatt-0-x", ".khatt-0-y", ".khatt-notes");
    for name in [old, new, mine] {
        let file = File::create(out.join(name)).expect("a file");
        if name != new {
            let then = SystemTime::UNIX_EPOCH;
            file.set_modified(then).expect("a date");
        }
    }
    let build = khatt(dir.path(), &["build", "font.toml"]);
    assert_eq!(
        build.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&build.stderr)
    );
    let left: Vec<String> = files(&out).into_keys().collect();
    let temporary: Vec<_> = left.iter().filter(|k| k.starts_with(".khatt-")).collect();
    assert_eq!(temporary, [new, mine]);
}

#[test]
fn a_wrong_project_file_is_shown_where_it_is_wrong() {
    let dir = project("H", &page(&[]));
    let text = fs::read_to_string(dir.path().join("font.toml")).expect("the project");
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
        fs::write(dir.path().join("font.toml"), text.replacen(right, wrong, 1)).expect("a file");
        let args = ["build", "font.toml"];
        let out = khatt(dir.path(), &args);
        assert_eq!(out.status.code(), Some(1), "{name}");
        approved::check("cli", &format!("project-{name}"), &transcript(&args, &out));
    }
}

#[test]
fn cells_are_cut_and_listed() {
    let dir = project(LETTERS, &page(&[]));
    let out = khatt(dir.path(), &["cut", "font.toml", "-o", "cells"]);
    assert_eq!(
        out.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&out.stderr)
    );
    let cells = files(&dir.path().join("cells"));
    assert_eq!(cells.len(), 11, "{:?}", cells.keys());
    let list: serde_json::Value = serde_json::from_slice(&cells["cells.json"]).expect("JSON");
    let first = &list[0]["cells"][0];
    assert_eq!(
        (first["label"].as_str(), first["cell"].as_u64()),
        (Some("H"), Some(1))
    );
    assert!(cells.contains_key(first["picture"].as_str().expect("a name")));
}

#[test]
fn a_build_reports_lists_its_inputs_and_can_be_locked() {
    let dir = project(LETTERS, &page(&[]));
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    fs::write(&path, format!("{text}report = \"out/report.json\"\n")).expect("a project");
    let locked = ["build", "font.toml", "--locked"];
    assert_eq!(
        khatt(dir.path(), &locked).status.code(),
        Some(1),
        "nothing is built yet"
    );
    assert!(!dir.path().join("out").exists(), "--locked writes nothing");
    let args = [
        "build",
        "font.toml",
        "--no-cache",
        "--depfile",
        "out/font.d",
        "--keep",
        "out/keep",
    ];
    let out = khatt(dir.path(), &args);
    assert_eq!(
        out.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&out.stderr)
    );
    assert_eq!(
        khatt(dir.path(), &locked).status.code(),
        Some(0),
        "now it is"
    );
    let made = files(&dir.path().join("out"));
    let rule = String::from_utf8_lossy(&made["font.d"]);
    assert!(
        rule.contains("out/test.ttf") && rule.contains(": font.toml page.png\n"),
        "{rule}"
    );
    let kept = |stage: &str| {
        made.keys()
            .filter(|k| k.starts_with(&format!("keep/{stage}")))
            .count()
    };
    let stages = ["1-cut", "2-trace", "3-fit", "4-place", "5-assemble"];
    assert_eq!(stages.map(kept), [9, 9, 9, 12, 1]);
    let report: serde_json::Value = serde_json::from_slice(&made["report.json"]).expect("JSON");
    let rows = report["glyphs"].as_array().expect("a list");
    assert_eq!(rows.len(), 9);
    for row in rows {
        let error = row["max_error"].as_f64().expect("a number");
        assert!(error > 0.0 && error < 15.0, "{row}");
    }
    let timed = ["build", "font.toml", "--timings", "--no-cache"];
    assert_eq!(khatt(dir.path(), &timed).status.code(), Some(0));
    let report = fs::read(dir.path().join("out/report.json")).expect("the report");
    let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
    assert!(report["stage_seconds"]["cut"].is_number());
    assert!(report["pages_per_decoding"].is_number());
    let plain = || {
        let out = khatt(dir.path(), &["build", "font.toml", "--no-cache", "--quiet"]);
        assert_eq!(out.status.code(), Some(0));
        fs::read(dir.path().join("out/report.json")).expect("the report")
    };
    let first = plain();
    assert!(!String::from_utf8_lossy(&first).contains("seconds"));
    assert_eq!(first, plain(), "without times the report is the same");
}

#[test]
fn a_gate_fails_the_build_and_names_the_cells() {
    let dir = project(LETTERS, &page(&[]));
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    let gated = text.replace("[output]", "[gate]\nmax_error = 0.001\n[output]");
    fs::write(&path, gated).expect("a project");
    let out = khatt(dir.path(), &["build", "font.toml"]);
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(1));
    assert!(
        stderr.contains("page.png, cell 1 “H”: max_error is "),
        "{stderr}"
    );
    assert!(!dir.path().join("out").exists(), "nothing may be written");
}

#[test]
fn a_folder_with_somebodys_files_is_not_replaced() {
    let dir = project(LETTERS, &page(&[]));
    fs::create_dir_all(dir.path().join("out/svg")).expect("a folder");
    fs::write(dir.path().join("out/svg/letter.txt"), "mine").expect("a file");
    let out = khatt(dir.path(), &["build", "font.toml"]);
    let stderr = String::from_utf8_lossy(&out.stderr);
    assert_eq!(out.status.code(), Some(1));
    assert!(
        stderr.contains("letter.txt, which khatt did not make"),
        "{stderr}"
    );
    assert_eq!(
        files(&dir.path().join("out")).len(),
        1,
        "nothing is written, nothing is lost"
    );
}

/// Exit status of a build and what it said.
fn build_in(dir: &Path, args: &[&str]) -> (Option<i32>, String) {
    let out = khatt(dir, &[&["build", "font.toml"], args].concat());
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    (out.status.code(), said)
}

#[test]
fn a_proof_shows_what_has_changed_and_stays_the_same_until_something_does() {
    let dir = project(LETTERS, &page(&[]));
    let proof = || fs::read_to_string(dir.path().join("out/test.html")).expect("a proof");
    assert_eq!(build_in(dir.path(), &["--no-cache"]).0, Some(0));
    let first = proof();
    assert!(!first.contains("Changed since the build before"));
    assert_eq!(build_in(dir.path(), &["--no-cache"]).0, Some(0));
    assert_eq!(proof(), first, "nothing has changed");

    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    let lower = format!("{text}[cells.o]\nbaseline_shift = -20\n");
    fs::write(&path, lower).expect("a project");
    assert_eq!(build_in(dir.path(), &[]).0, Some(0));
    let second = proof();
    let (_, row) = second
        .split_once("<a href=\"#glyph-o\">o</a>")
        .expect("a change");
    assert!(row.starts_with("</td><td>20."), "{}", &row[..50]);
    assert_eq!(build_in(dir.path(), &["--no-cache"]).0, Some(0));
    assert_eq!(proof(), second, "what was before stays");
    assert_eq!(build_in(dir.path(), &["--locked", "--no-cache"]).0, Some(0));
}

#[test]
fn what_a_build_remarks_and_why_it_fails_is_in_the_sarif_log() {
    let dir = project(LETTERS, &page(&[]));
    let log = || -> serde_json::Value {
        let bytes = fs::read(dir.path().join("log/out.sarif")).expect("a log");
        serde_json::from_slice(&bytes).expect("JSON")
    };
    let args = ["--sarif", "log/out.sarif"];
    assert_eq!(build_in(dir.path(), &args).0, Some(0));
    let good = log();
    // o and c are one drawing in the page, and so on: that is remarked
    assert!(!results(&good).is_empty());
    for result in results(&good) {
        assert_ne!(result["level"], "error", "{result}");
        let place = &result["locations"][0];
        let uri = &place["physicalLocation"]["artifactLocation"]["uri"];
        assert_eq!(uri, "page.png", "{result}");
        assert_eq!(place["logicalLocations"][0]["kind"], "glyph", "{result}");
    }

    fs::write(dir.path().join("page.png"), page(&[4, 7])).expect("a picture");
    assert_eq!(build_in(dir.path(), &args).0, Some(1));
    let bad = log();
    let said: Vec<&str> = results(&bad)
        .iter()
        .filter_map(|r| r["message"]["text"].as_str())
        .collect();
    assert_eq!(said.len(), 2, "{said:?}");
    let first = "page.png, cell 5 “e”: the cell is empty";
    assert!(said[0].contains(first), "{said:?}");
    let errors = results(&bad).iter().filter(|r| r["level"] == "error");
    assert_eq!(errors.count(), 2, "{said:?}");
}

/// The results of a SARIF log, whose shape is that of version 2.1.0: what its schema demands of the parts used
/// (sarifLog, run, tool, toolComponent, reportingDescriptor, result, location, artifactLocation, message).
fn results(log: &serde_json::Value) -> &[serde_json::Value] {
    let shape = |value: &serde_json::Value, wanted: &[&str]| {
        assert_eq!(keys(value), wanted, "{value}");
    };
    let level = |value: &serde_json::Value| {
        let known = matches!(value.as_str(), Some("error" | "warning" | "note"));
        assert!(known, "{value} is no level");
    };
    shape(log, &["$schema", "runs", "version"]);
    assert_eq!(log["version"], "2.1.0", "{log}");
    let run = &log["runs"][0];
    shape(run, &["results", "tool"]);
    shape(&run["tool"], &["driver"]);
    let driver = &run["tool"]["driver"];
    shape(driver, &["name", "rules", "semanticVersion"]);
    let rules = driver["rules"].as_array().expect("a list");
    for rule in rules {
        shape(rule, &["defaultConfiguration", "id", "shortDescription"]);
        shape(&rule["shortDescription"], &["text"]);
        level(&rule["defaultConfiguration"]["level"]);
    }
    let results = run["results"].as_array().expect("a list");
    for result in results {
        let parts = ["level", "locations", "message", "ruleId", "ruleIndex"];
        shape(result, &parts);
        shape(&result["message"], &["text"]);
        level(&result["level"]);
        let index = result["ruleIndex"].as_u64().expect("a number");
        let rule = &rules[usize::try_from(index).expect("a few")];
        assert_eq!(rule["id"], result["ruleId"], "{result}");
        for place in result["locations"].as_array().expect("a list") {
            let known = ["logicalLocations", "physicalLocation"];
            assert!(keys(place).iter().all(|k| known.contains(k)), "{place}");
            let uri = &place["physicalLocation"]["artifactLocation"]["uri"];
            let reference = uri.as_str().is_some_and(|u| !u.contains([' ', '\\']));
            assert!(reference, "{place}");
        }
    }
    results
}

/// The keys of a table, sorted.
fn keys(value: &serde_json::Value) -> Vec<&str> {
    let mut keys: Vec<&str> = value
        .as_object()
        .expect("a table")
        .keys()
        .map(String::as_str)
        .collect();
    keys.sort_unstable();
    keys
}

#[test]
fn a_changed_correction_redoes_no_other_page() {
    let dir = project(LETTERS, &page(&[]));
    fs::write(dir.path().join("more.png"), page(&[])).expect("a picture");
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    let second = "[[sheet]]\nimage = \"more.png\"\nlayout = { grid = [3, 3] }\n\
                  glyphs = \"A p i B j C q k r\"\npixels_per_em = 150\n[output]";
    let text = text.replace("[output]", second);
    fs::write(&path, &text).expect("a project");
    let args = ["--quiet", "--cache-dir", "kept"];
    let kept = || files(&dir.path().join("kept")).len();
    assert_eq!(build_in(dir.path(), &args).0, Some(0));
    assert_eq!(kept(), 3, "two pages and a build");
    fs::write(&path, format!("{text}[cells.p]\nbaseline_shift = 9\n")).expect("a project");
    assert_eq!(build_in(dir.path(), &args).0, Some(0));
    assert_eq!(kept(), 5, "one page and a build more");
}

/// Words of H, o and l, a row of 150 px a word, so many px between any two letters.
fn words(all: &[&str], gap: f64) -> Vec<u8> {
    png(
        600,
        150 * u32::try_from(all.len()).expect("few words"),
        |x, y| {
            let word = all[(y / 150) as usize];
            let (x, y) = (f64::from(x) + 0.5, f64::from(y % 150) + 0.5);
            let bar = |x0: f64, y0: f64, x1: f64, y1: f64| {
                edge((x0 - x).max(x - x1).max((y0 - y).max(y - y1)))
            };
            let mut left = 40.0;
            let mut ink = 0;
            for letter in word.chars() {
                let (width, drawn) = match letter {
                    'H' => (
                        80.0,
                        bar(left, 25.0, left + 16.0, 125.0)
                            .max(bar(left + 64.0, 25.0, left + 80.0, 125.0))
                            .max(bar(left + 10.0, 67.0, left + 70.0, 83.0)),
                    ),
                    'o' => (
                        70.0,
                        edge(((x - left - 35.0).hypot(y - 91.0) - 26.0).abs() - 9.0),
                    ),
                    _ => (16.0, bar(left, 15.0, left + 16.0, 125.0)),
                };
                ink = ink.max(drawn);
                left += width + gap;
            }
            ink
        },
    )
}

#[test]
fn written_words_say_how_loosely_letters_stand() {
    let all = ["oHol", "loHo", "Holo", "lolo"];
    let built = |gap: f64| {
        let dir = project(LETTERS, &page(&[]));
        fs::write(dir.path().join("words.png"), words(&all, gap)).expect("a picture");
        let path = dir.path().join("font.toml");
        let text = fs::read_to_string(&path).expect("the project");
        let table = format!(
            "report = \"out/report.json\"\n[[sheet]]\nimage = \"words.png\"\ncontent = \"words\"\n\
             layout = {{ grid = [4, 1] }}\nglyphs = \"{}\"\npixels_per_em = 150\n",
            all.join(" ")
        );
        fs::write(&path, text + &table).expect("a project");
        let out = khatt(dir.path(), &["build", "font.toml"]);
        assert_eq!(
            out.status.code(),
            Some(0),
            "{}",
            String::from_utf8_lossy(&out.stderr)
        );
        let report = fs::read(dir.path().join("out/report.json")).expect("a report");
        let report: serde_json::Value = serde_json::from_slice(&report).expect("JSON");
        let gaps = report["gaps"].as_array().expect("gaps");
        assert_eq!(gaps.len(), 12);
        // words are no glyphs
        assert_eq!(report["glyphs"].as_array().expect("glyphs").len(), 9);
        for found in gaps {
            let [written, set] = ["written", "set"].map(|k| found[k].as_f64().expect("a length"));
            assert!((written - gap / 0.15).abs() < 1.0, "{found}");
            assert!((written - set).abs() < 10.0, "{found}");
        }
    };
    built(12.0);
    built(40.0);
}

#[test]
fn what_is_no_word_is_told() {
    let dir = project(LETTERS, &page(&[]));
    fs::write(dir.path().join("words.png"), words(&["oHol"], 12.0)).expect("a picture");
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    let table = "[[sheet]]\nimage = \"words.png\"\ncontent = \"words\"\nlayout = { grid = [3, 1] }\n\
                 glyphs = \"oHol H beh-ar.init\"\n";
    fs::write(&path, text + table).expect("a project");
    let out = khatt(dir.path(), &["build", "font.toml"]);
    assert_ne!(out.status.code(), Some(0));
    let said = String::from_utf8_lossy(&out.stderr);
    for wrong in [
        "words.png: word 2 “H” is none",
        "words.png: word 3 “beh-ar.init” is none",
        "words.png: words do not tell how large the em is",
    ] {
        assert!(said.contains(wrong), "{said}");
    }
}
