//! The program as a user types it: help, errors, exit status, nothing written when it fails.

use crate::common::approved;
use crate::common::desk::{Desk, said, transcript};
use crate::common::pictures::{edge, encoded, png};
use crate::convert::{converted, font};
use image::{GrayImage, ImageFormat, Luma};
use kurbo::{BezPath, ParamCurve, ParamCurveNearest};

/// A disc's coverage, 0…255, roughly antialiased.
fn disc(x: u32, y: u32) -> u8 {
    edge((f64::from(x) + 0.5 - 40.0).hypot(f64::from(y) + 0.5 - 30.0) - 20.0)
}

/// A folder with the picture of a disc.
fn with_disc() -> Desk {
    Desk::with("disc.png", png(80, 60, disc))
}

/// The first path of a drawing.
fn first_path(svg: &str) -> BezPath {
    let data = svg.split(" d=\"").nth(1).and_then(|s| s.split('"').next());
    BezPath::from_svg(data.expect("path data")).expect("a path")
}

#[test]
fn help_is_approved() {
    let desk = Desk::new();
    for command in [
        "",
        "build",
        "watch",
        "page",
        "merge",
        "sheet",
        "trace",
        "cut",
        "proof",
        "methods",
        "features",
        "init",
        "completions",
        "man",
        "match",
        "convert",
        "designspace",
        "schema",
    ] {
        let args: Vec<&str> = [command, "--help"]
            .into_iter()
            .filter(|a| !a.is_empty())
            .collect();
        let name = if command.is_empty() { "khatt" } else { command };
        let out = desk.run(&args);
        assert_eq!(out.status.code(), Some(0), "{command}");
        approved::check("cli", &format!("help-{name}"), &transcript(&args, &out));
    }
}

#[test]
fn wrong_use_exits_2_with_a_usage_line() {
    let desk = Desk::new();
    let split = ["--quadratic", "split", "--keep", "corners"];
    let split = [&["convert", "a.otf", "-o", "a.ttf"], &split[..]].concat();
    let cases: [&[&str]; 8] = [
        &split,
        &["page", "font.toml", "--sheet", "0", "-o", "one"],
        &["sheet", "font.toml", "-o", "a.png", "--dpi", "0"],
        &[],
        &["trac"],
        &["trace", "a.png"],
        &["trace", "a.png", "-o", "-", "--fit", "nonsense"],
        &["trace", "a.png", "-o", "-", "--tolerance", "-1"],
    ];
    for args in cases {
        let (status, said) = desk.told(args);
        assert_eq!(status, Some(2), "{args:?}");
        let usage = said.contains("Usage:") || said.contains("--help");
        assert!(usage, "{said}");
    }
}

#[test]
fn a_tolerance_is_what_projects_may_have() {
    let desk = Desk::new();
    for px in ["0", "0.0009", "1000.1", "inf", "NaN"] {
        let (status, said) = desk.told(&["trace", "a.png", "-o", "-", "--tolerance", px]);
        assert_eq!(status, Some(2), "{px}: {said}");
        let range = "must be between 0.001 and 1000 pixels";
        assert!(said.contains(range), "{px}: {said}");
    }
    for px in ["0.001", "1000"] {
        // there is no a.png
        desk.fails(&["trace", "a.png", "-o", "-", "--tolerance", px]);
    }
}

#[test]
fn a_picture_is_the_same_on_any_number_of_threads() {
    let desk = Desk::new();
    // rings of many sizes, some with corners and some that touch
    let rings = |x: u32, y: u32| {
        let (column, row) = (x / 48, y / 48);
        let (dx, dy) = (f64::from(x % 48) - 23.5, f64::from(y % 48) - 23.5);
        let off = if row % 2 == 0 {
            dx.hypot(dy)
        } else {
            dx.abs().max(dy.abs())
        };
        let inside = off < 24.5 - f64::from(column) && off > 3.0 * f64::from(row);
        if inside { 255 } else { 0 }
    };
    desk.write("rings.png", png(300, 250, rings));
    let run = |jobs: &str| desk.run(&["trace", "rings.png", "-o", "-", "--jobs", jobs]);
    let one = run("1");
    assert!(String::from_utf8_lossy(&one.stdout).matches('M').count() > 20);
    for jobs in ["2", "7"] {
        assert!(run(jobs).stdout == one.stdout, "{jobs} threads");
    }
}

/// A grey TIFF whose pages all show the same strip, with `spare` bytes between header and strip.
#[cfg(target_os = "linux")]
fn tiff(pages: usize, (width, height): (u32, u32), spare: usize) -> Vec<u8> {
    let mut file = b"II*\0\0\0\0\0".to_vec();
    file.resize(8 + spare, 0);
    let (strip, size) = (file.len(), width * height);
    file.extend((0..size).map(|i| if i % width < width / 2 { 0 } else { 255 }));
    let whole = |n: usize| u32::try_from(n).expect("32 bits");
    let mut link = 4;
    for _ in 0..pages {
        let at = whole(file.len()).to_le_bytes();
        file[link..link + 4].copy_from_slice(&at);
        let fields = [
            (256u16, width),
            (257, height),
            (258, 8),
            (259, 1),
            (262, 1),
            (273, whole(strip)),
            (277, 1),
            (278, height),
            (279, size),
        ];
        file.extend([9, 0]);
        for (tag, value) in fields {
            file.extend(tag.to_le_bytes());
            file.extend([4, 0, 1, 0, 0, 0]);
            file.extend(value.to_le_bytes());
        }
        link = file.len();
        file.extend([0; 4]);
    }
    file
}

#[test]
#[cfg(target_os = "linux")]
fn pages_of_one_file_share_its_bytes() {
    let desk = Desk::with("many.tif", tiff(64, (40, 30), 32_000_000));
    let limited = "ulimit -v 1500000; exec \"$0\" trace many.tif -o out.svg --jobs 1";
    let mut shell = std::process::Command::new("sh");
    let shell = shell.args(["-c", limited, env!("CARGO_BIN_EXE_khatt")]);
    let out = shell.current_dir(desk.path("")).output().expect("a shell");
    let said = said(&out);
    assert!(said.contains("holds 64 pictures"), "{said}");
}

#[test]
fn a_picture_becomes_one_path_in_its_own_pixels() {
    let desk = with_disc();
    desk.done(&["trace", "disc.png", "-o", "disc.svg"]);
    let svg = desk.text("disc.svg");
    assert_eq!(svg.matches("<path").count(), 1);
    assert!(svg.contains("viewBox=\"0 0 80 60\""), "{svg}");
    let centre = kurbo::Shape::bounding_box(&first_path(&svg)).center();
    assert!(centre.distance((40.0, 30.0).into()) < 0.1, "{centre}");
    let same = desk.run(&["trace", "disc.png", "-o", "-"]);
    assert_eq!(same.stdout, svg.as_bytes());
}

#[test]
fn dust_is_what_the_user_says() {
    let desk = Desk::new();
    let blotted = |x: u32, y: u32| {
        let blot = (10..13).contains(&x) && y == 10;
        if blot { 255 } else { disc(x, y) }
    };
    desk.write("disc.png", png(80, 60, blotted));
    let contours = |args: &[&str]| {
        let out = desk.run(&[&["trace", "disc.png", "-o", "-"], args].concat());
        String::from_utf8_lossy(&out.stdout).matches('M').count()
    };
    assert_eq!(contours(&[]), 1);
    assert_eq!(contours(&["--speckle", "1"]), 2);
    assert_eq!(contours(&["--speckle", "5000"]), 0);
}

#[test]
fn faint_ink_and_dark_paper_are_traced_and_nothing_is_told() {
    let desk = Desk::new();
    for (paper, ink, contours) in [(255, 160, 1), (120, 10, 1), (90, 200, 1), (255, 255, 0)] {
        let level = |x: u32, y: u32| (20..60).contains(&x) && (20..60).contains(&y);
        let level = |x: u32, y: u32| Luma([if level(x, y) { ink } else { paper }]);
        let picture = GrayImage::from_fn(80, 80, level);
        desk.write("in.png", encoded(picture, ImageFormat::Png));
        let said = desk.done(&["trace", "in.png", "-o", "out.svg"]);
        let svg = desk.text("out.svg");
        assert_eq!(svg.matches('M').count(), contours, "{paper} {ink}: {svg}");
        let blank = said.contains("no ink to trace");
        assert_eq!(blank, contours == 0, "{paper} {ink}: {said}");
    }
}

#[test]
fn pencil_is_averaged_unless_its_grain_is_to_stay() {
    let desk = Desk::new();
    // a bar of which the paper's teeth have taken two thirds
    let grain = |x: u32, y: u32| {
        let mixed = x.wrapping_mul(0x9e37_79b9) ^ y.wrapping_mul(0x85eb_ca6b);
        mixed.wrapping_mul(0xc2b2_ae35) >> 24
    };
    let level = |x: u32, y: u32| {
        let inked = (16..28).contains(&x) && (20..38).contains(&y);
        let ink = (8 * grain(x, y) / 5).saturating_sub(102).min(255);
        if inked {
            u8::try_from(ink).expect("0…255")
        } else {
            0
        }
    };
    desk.write("in.png", png(44, 60, level));
    for (more, one, told) in [
        (&[][..], true, true),
        (&["--grain", "soften", "--quiet"], true, false),
        (&["--grain", "keep"], false, false),
    ] {
        let args = [&["trace", "in.png", "-o", "out.svg"], more].concat();
        let said = desk.done(&args);
        let svg = desk.text("out.svg");
        assert_eq!(svg.matches('M').count() == 1, one, "{more:?}: {svg}");
        assert_eq!(said.contains("grain"), told, "{more:?}: {said}");
    }
}

#[test]
fn pictures_that_cannot_be_traced() {
    let desk = Desk::with("text.png", "this is no picture");
    for picture in ["missing.png", "text.png"] {
        let args = ["trace", picture, "-o", "out.svg"];
        desk.refuses(&args, &format!("trace-{picture}"));
        assert!(!desk.has("out.svg"), "{picture}");
    }
}

#[test]
fn options_are_written_in_snake_case() {
    let desk = Desk::new();
    let out = desk.run(&["methods", "--json"]);
    let rows: serde_json::Value = serde_json::from_slice(&out.stdout).expect("JSON");
    let rows = rows.as_array().expect("a list");
    assert!(rows.len() >= 3, "only {} methods", rows.len());
    for row in rows {
        let options = row["options"].as_object().expect("a table");
        for key in options.keys() {
            assert!(
                !key.contains('-'),
                "{key} of {}: options are snake_case",
                row["method"]
            );
        }
    }
}

#[test]
fn completions_manual_and_schema_come_from_the_same_sources() {
    let desk = Desk::new();
    for (args, has) in [
        (&["completions", "bash"][..], "_khatt"),
        (&["man"], ".TH khatt"),
        (&["schema"], "\"max_error\""),
    ] {
        let out = desk.run(args);
        assert_eq!(out.status.code(), Some(0), "{args:?}");
        assert!(
            String::from_utf8_lossy(&out.stdout).contains(has),
            "{args:?}"
        );
    }
}

#[test]
fn every_command_has_a_manual_page_with_its_options() {
    let desk = Desk::with("man1/other.1", "mine");
    desk.done(&["man", "-o", "man1"]);
    assert_eq!(desk.text("man1/other.1"), "mine");
    assert_eq!(
        desk.text("man1/khatt.1").as_bytes(),
        desk.run(&["man"]).stdout
    );
    for (command, option) in [("build", r"\-\-depfile"), ("man", r"\-\-output")] {
        let page = desk.text(&format!("man1/khatt-{command}.1"));
        assert!(page.contains(option), "{command}: {page}");
        assert!(page.contains("\"khatt 0"), "its program: {page}");
    }
    let commands = desk.text("man1/khatt.1").matches("khatt\\-").count();
    assert!(commands >= 17, "only {commands} commands");
    assert_eq!(desk.files("man1").len(), commands + 2);
    // its own pages are replaced
    desk.done(&["man", "-o", "man1"]);
}

#[test]
fn features_are_plotted() {
    let desk = Desk::new();
    let bar = |x: u32, y: u32| {
        if (20..60).contains(&x) && (20..120).contains(&y) {
            255
        } else {
            0
        }
    };
    desk.write("bar.png", png(80, 140, bar));
    desk.done(&["features", "bar.png", "-o", "bar.svg"]);
    let svg = desk.text("bar.svg");
    assert!(svg.contains("4 corners (SC), 4 straight runs"), "{svg}");
    assert_eq!(
        svg.matches("class=\"sc\"").count(),
        8,
        "each corner in both drawings"
    );
    desk.write("blank.png", png(20, 20, |_, _| 0));
    let said = desk.fails(&["features", "blank.png", "-o", "blank.svg"]);
    assert!(said.contains("no ink"), "{said}");
}

/// A line of 10 px with round ends from (20, 30) to (140, 75), of two levels.
fn slanting(x: u32, y: u32) -> u8 {
    let (x, y) = (f64::from(x) + 0.5 - 20.0, f64::from(y) + 0.5 - 30.0);
    let (u, v) = (120.0, 45.0);
    let t = ((x * u + y * v) / (u * u + v * v)).clamp(0.0, 1.0);
    if (x - t * u).hypot(y - t * v) < 5.0 {
        255
    } else {
        0
    }
}

#[test]
fn features_of_two_levels_are_those_of_the_drawing() {
    let desk = Desk::with("line.png", png(160, 120, slanting));
    desk.done(&["features", "line.png", "-o", "line.svg"]);
    let svg = desk.text("line.svg");
    // in steps its sides were five runs with eight ends
    assert!(svg.contains(" 2 straight runs"), "{svg}");
}

#[test]
fn the_middle_of_a_line_of_two_levels_is_where_it_was_drawn() {
    let desk = Desk::with("line.png", png(160, 120, slanting));
    desk.done(&["trace", "--centerline", "line.png", "-o", "line.svg"]);
    let svg = desk.text("line.svg");
    let line = kurbo::Line::new((20.0, 30.0), (140.0, 75.0));
    let along = |s: kurbo::PathSeg| [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| s.eval(t));
    for p in first_path(&svg).segments().flat_map(along) {
        let off = line.nearest(p, 1e-6).distance_sq.sqrt();
        // 0.44 in steps
        assert!(off < 0.25, "{off}: {svg}");
    }
}

/// As after `khatt methods | head -1`.
#[test]
fn a_reader_that_has_had_enough_is_no_error() {
    let desk = with_disc();
    let closed = || std::io::pipe().expect("a pipe").1;
    let cases: [&[&str]; 5] = [
        &["methods"],
        &["methods", "--json"],
        &["schema"],
        &["init", "letters"],
        &["trace", "disc.png", "-o", "-"],
    ];
    for args in cases {
        let out = desk.command(args).stdout(closed()).output();
        let out = out.expect("the program runs");
        let told = (out.status.code(), said(&out));
        assert_eq!(told, (Some(0), String::new()), "{args:?}");
    }
    // nor is one of messages
    let failed = desk.command(&["init", "letters"]).stderr(closed()).output();
    assert_eq!(failed.expect("the program runs").status.code(), Some(1));
}

#[test]
fn no_more_threads_than_can_be_of_use() {
    let desk = with_disc();
    let run = |jobs: &str| desk.run(&["trace", "disc.png", "-o", "-", "--jobs", jobs]);
    for jobs in ["0", "1025", "99999", "99999999999999999999", "-1", "two"] {
        let out = run(jobs);
        assert_eq!(out.status.code(), Some(2), "{jobs}: {out:?}");
    }
    let said = said(&run("99999"));
    let range = "must be a whole number from 1 to 1024";
    assert!(said.contains(range), "{said}");
    assert_eq!(run("1024").stdout, run("1").stdout);
}

#[test]
fn names_that_promise_another_kind_are_refused() {
    let desk = with_disc();
    let wrong: [&[&str]; 9] = [
        &["trace", "disc.png", "-o", "out.png"],
        &["trace", "disc.png", "-o", "out.ufo"],
        &["trace", "disc.png", "-o", "out.ttf", "--centerline"],
        &["features", "disc.png", "-o", "out.pdf"],
        // whether or not there is such a file to read
        &["cut", "font.toml", "-o", "-"],
        &["sheet", "font.toml", "-o", "page.txt"],
        &["designspace", "a.ufo", "-o", "-"],
        &["convert", "a.ttf", "-o", "a.txt"],
        &["man", "-o", "-"],
    ];
    for args in wrong {
        let (status, stderr) = desk.told(args);
        assert_eq!(status, Some(2), "{args:?}: {stderr}");
        assert!(stderr.contains("  help: "), "{args:?}: {stderr}");
        assert_eq!(desk.files("").len(), 1, "{args:?} wrote something");
    }
    let sheet = ["sheet", "font.toml", "-o", "page.txt"];
    approved::check(
        "cli",
        "sheet-ending",
        &transcript(&sheet, &desk.run(&sheet)),
    );
    let right: [&[&str]; 4] = [
        &["trace", "disc.png", "-o", "out.SVG"],
        &["trace", "disc.png", "-o", "out"],
        &["trace", "disc.png", "-o", "o.UFO", "--centerline"],
        &["features", "disc.png", "-o", "features.svg"],
    ];
    for args in right {
        desk.done(args);
    }
    assert!(desk.has("o.UFO/metainfo.plist"));
}

#[test]
fn what_drawings_do_not_say_of_a_font_is_named() {
    let mut large = font();
    large.info.units_per_em = 2048;
    let desk = Desk::with("large.ttf", converted(&large, "ttf"));
    desk.write("usual.ttf", converted(&font(), "ttf"));
    let said = |name: &str| desk.done(&["convert", name, "-o", &name[..5]]);
    let (large, usual) = (said("large.ttf"), said("usual.ttf"));
    assert!(
        large.contains("not carried over: 2048 units an em"),
        "{large}"
    );
    assert!(!usual.contains("units an em"), "{usual}");
    // beh has two
    assert!(
        usual.contains("second characters (glyphs that have some: 1"),
        "{usual}"
    );
}

#[test]
fn a_dash_is_no_folder() {
    let desk = Desk::with("font.ttf", converted(&font(), "ttf"));
    let run = desk.run(&["convert", "font.ttf", "-o", "-"]);
    assert_eq!(run.status.code(), Some(2), "{}", said(&run));
    assert!(!desk.has("-"));
}
