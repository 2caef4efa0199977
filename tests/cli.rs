//! The program as a user types it: help, errors, exit status, nothing written when it fails.
#![expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who writes files"
)]

use crate::common::approved;
use kurbo::{BezPath, ParamCurve, ParamCurveNearest};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the program in `folder`.
pub(crate) fn khatt(folder: &Path, args: &[&str]) -> Output {
    command(folder, args).output().expect("the program runs")
}

/// The program with these arguments in `folder`, told no date; what it keeps between runs lies there too.
pub(crate) fn command(folder: &Path, args: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_khatt"));
    command.args(args).current_dir(folder);
    command.env_remove("SOURCE_DATE_EPOCH");
    command.env("XDG_CACHE_HOME", folder.join("cache"));
    command
}

/// Status, standard output and standard error as one text.
pub(crate) fn transcript(args: &[&str], out: &Output) -> String {
    let (stdout, stderr) = (
        String::from_utf8_lossy(&out.stdout),
        String::from_utf8_lossy(&out.stderr),
    );
    let status = out
        .status
        .code()
        .map_or("killed".to_owned(), |c| c.to_string());
    format!(
        "$ khatt {}\n{stdout}{stderr}status {status}\n",
        args.join(" ")
    )
}

/// A grey PNG of `width` × `height` px whose ink is `ink(x, y)`, 0…255.
pub(crate) fn png(width: u32, height: u32, ink: impl Fn(u32, u32) -> u8) -> Vec<u8> {
    let picture = image::GrayImage::from_fn(width, height, |x, y| image::Luma([255 - ink(x, y)]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("a picture in memory");
    bytes.into_inner()
}

/// A disc's coverage, 0…255, roughly antialiased.
fn disc(x: u32, y: u32) -> u8 {
    let (dx, dy) = (f64::from(x) + 0.5 - 40.0, f64::from(y) + 0.5 - 30.0);
    let inside = (20.5 - dx.hypot(dy)).clamp(0.0, 1.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0…255 by the clamp"
    )]
    let ink = (255.0 * inside).round() as u8;
    ink
}

#[test]
fn help_is_approved() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
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
        let out = khatt(here, &args);
        assert_eq!(out.status.code(), Some(0), "{command}");
        approved::check("cli", &format!("help-{name}"), &transcript(&args, &out));
    }
}

#[test]
fn wrong_use_exits_2_with_a_usage_line() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let split = ["--quadratic", "split", "--keep", "corners"];
    let split = [&["convert", "a.otf", "-o", "a.ttf"], &split[..]].concat();
    let cases: [&[&str]; 6] = [
        &split,
        &[],
        &["trac"],
        &["trace", "a.png"],
        &["trace", "a.png", "-o", "-", "--fit", "nonsense"],
        &["trace", "a.png", "-o", "-", "--tolerance", "-1"],
    ];
    for args in cases {
        let out = khatt(here, args);
        assert_eq!(out.status.code(), Some(2), "{args:?}");
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert!(
            stderr.contains("Usage:") || stderr.contains("--help"),
            "{stderr}"
        );
    }
}

#[test]
fn a_tolerance_is_what_projects_may_have() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for px in ["0", "0.0009", "1000.1", "inf", "NaN"] {
        let out = khatt(here, &["trace", "a.png", "-o", "-", "--tolerance", px]);
        let said = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(2), "{px}: {said}");
        let range = "must be between 0.001 and 1000 pixels";
        assert!(said.contains(range), "{px}: {said}");
    }
    for px in ["0.001", "1000"] {
        let out = khatt(here, &["trace", "a.png", "-o", "-", "--tolerance", px]);
        assert_eq!(out.status.code(), Some(1), "there is no a.png");
    }
}

#[test]
fn a_picture_is_the_same_on_any_number_of_threads() {
    let dir = tempfile::tempdir().expect("a folder");
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
    fs::write(dir.path().join("rings.png"), png(300, 250, rings)).expect("a picture");
    let run = |jobs: &str| {
        khatt(
            dir.path(),
            &["trace", "rings.png", "-o", "-", "--jobs", jobs],
        )
    };
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
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("many.tif"), tiff(64, (40, 30), 32_000_000)).expect("a file");
    let limited = "ulimit -v 1500000; exec \"$0\" trace many.tif -o out.svg --jobs 1";
    let mut shell = Command::new("sh");
    let shell = shell.args(["-c", limited, env!("CARGO_BIN_EXE_khatt")]);
    let out = shell.current_dir(dir.path()).output().expect("a shell");
    let said = String::from_utf8_lossy(&out.stderr);
    assert!(said.contains("holds 64 pictures"), "{said}");
}

#[test]
fn a_picture_becomes_one_path_in_its_own_pixels() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("disc.png"), png(80, 60, disc)).expect("a picture");
    let out = khatt(dir.path(), &["trace", "disc.png", "-o", "disc.svg"]);
    assert_eq!(
        out.status.code(),
        Some(0),
        "{}",
        String::from_utf8_lossy(&out.stderr)
    );
    let svg = fs::read_to_string(dir.path().join("disc.svg")).expect("the SVG");
    assert_eq!(svg.matches("<path").count(), 1);
    assert!(svg.contains("viewBox=\"0 0 80 60\""), "{svg}");
    let data = svg.split(" d=\"").nth(1).and_then(|s| s.split('"').next());
    let path = BezPath::from_svg(data.expect("path data")).expect("a path");
    let centre = kurbo::Shape::bounding_box(&path).center();
    assert!(centre.distance((40.0, 30.0).into()) < 0.1, "{centre}");
    let same = khatt(dir.path(), &["trace", "disc.png", "-o", "-"]);
    assert_eq!(same.stdout, svg.as_bytes());
}

#[test]
fn dust_is_what_the_user_says() {
    let dir = tempfile::tempdir().expect("a folder");
    let blotted = |x: u32, y: u32| {
        let blot = (10..13).contains(&x) && y == 10;
        if blot { 255 } else { disc(x, y) }
    };
    fs::write(dir.path().join("disc.png"), png(80, 60, blotted)).expect("a picture");
    let contours = |args: &[&str]| {
        let out = khatt(
            dir.path(),
            &[&["trace", "disc.png", "-o", "-"], args].concat(),
        );
        String::from_utf8_lossy(&out.stdout).matches('M').count()
    };
    assert_eq!(contours(&[]), 1);
    assert_eq!(contours(&["--speckle", "1"]), 2);
    assert_eq!(contours(&["--speckle", "5000"]), 0);
}

#[test]
fn faint_ink_and_dark_paper_are_traced_and_nothing_is_told() {
    let dir = tempfile::tempdir().expect("a folder");
    for (paper, ink, contours) in [(255, 160, 1), (120, 10, 1), (90, 200, 1), (255, 255, 0)] {
        let level = |x: u32, y: u32| (20..60).contains(&x) && (20..60).contains(&y);
        let picture = image::GrayImage::from_fn(80, 80, |x, y| {
            image::Luma([if level(x, y) { ink } else { paper }])
        });
        picture.save(dir.path().join("in.png")).expect("a picture");
        let out = khatt(dir.path(), &["trace", "in.png", "-o", "out.svg"]);
        let svg = fs::read_to_string(dir.path().join("out.svg")).expect("an SVG");
        assert_eq!(svg.matches('M').count(), contours, "{paper} {ink}: {svg}");
        let said = String::from_utf8_lossy(&out.stderr);
        assert_eq!(
            said.contains("no ink to trace"),
            contours == 0,
            "{paper} {ink}: {said}"
        );
    }
}

#[test]
fn pencil_is_averaged_unless_its_grain_is_to_stay() {
    let dir = tempfile::tempdir().expect("a folder");
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
    fs::write(dir.path().join("in.png"), png(44, 60, level)).expect("a picture");
    for (more, one, told) in [
        (&[][..], true, true),
        (&["--grain", "soften", "--quiet"], true, false),
        (&["--grain", "keep"], false, false),
    ] {
        let args = [&["trace", "in.png", "-o", "out.svg"], more].concat();
        let out = khatt(dir.path(), &args);
        let svg = fs::read_to_string(dir.path().join("out.svg")).expect("an SVG");
        assert_eq!(svg.matches('M').count() == 1, one, "{more:?}: {svg}");
        let said = String::from_utf8_lossy(&out.stderr);
        assert_eq!(said.contains("grain"), told, "{more:?}: {said}");
    }
}

#[test]
fn pictures_that_cannot_be_traced() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("text.png"), "this is no picture").expect("a file");
    for picture in ["missing.png", "text.png"] {
        let args = ["trace", picture, "-o", "out.svg"];
        let out = khatt(dir.path(), &args);
        assert_eq!(out.status.code(), Some(1), "{picture}");
        assert!(!dir.path().join("out.svg").exists(), "{picture}");
        approved::check("cli", &format!("trace-{picture}"), &transcript(&args, &out));
    }
}

#[test]
fn options_are_written_in_snake_case() {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let out = khatt(here, &["methods", "--json"]);
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
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (args, has) in [
        (&["completions", "bash"][..], "_khatt"),
        (&["man"], ".TH khatt"),
        (&["schema"], "\"max_error\""),
    ] {
        let out = khatt(here, args);
        assert_eq!(out.status.code(), Some(0), "{args:?}");
        assert!(
            String::from_utf8_lossy(&out.stdout).contains(has),
            "{args:?}"
        );
    }
}

#[test]
fn features_are_plotted() {
    let dir = tempfile::tempdir().expect("a folder");
    let bar = |x: u32, y: u32| {
        if (20..60).contains(&x) && (20..120).contains(&y) {
            255
        } else {
            0
        }
    };
    fs::write(dir.path().join("bar.png"), png(80, 140, bar)).expect("a picture");
    let out = khatt(dir.path(), &["features", "bar.png", "-o", "bar.svg"]);
    assert_eq!(out.status.code(), Some(0), "{out:?}");
    let svg = fs::read_to_string(dir.path().join("bar.svg")).expect("a diagram");
    assert!(svg.contains("4 corners (SC), 4 straight runs"), "{svg}");
    assert_eq!(
        svg.matches("class=\"sc\"").count(),
        8,
        "each corner in both drawings"
    );
    fs::write(dir.path().join("blank.png"), png(20, 20, |_, _| 0)).expect("a picture");
    let blank = khatt(dir.path(), &["features", "blank.png", "-o", "blank.svg"]);
    assert_eq!(blank.status.code(), Some(1));
    assert!(
        String::from_utf8_lossy(&blank.stderr).contains("no ink"),
        "{blank:?}"
    );
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
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("line.png"), png(160, 120, slanting)).expect("a picture");
    let out = khatt(dir.path(), &["features", "line.png", "-o", "line.svg"]);
    assert_eq!(out.status.code(), Some(0), "{out:?}");
    let svg = fs::read_to_string(dir.path().join("line.svg")).expect("a diagram");
    // in steps its sides were five runs with eight ends
    assert!(svg.contains(" 2 straight runs"), "{svg}");
}

#[test]
fn the_middle_of_a_line_of_two_levels_is_where_it_was_drawn() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("line.png"), png(160, 120, slanting)).expect("a picture");
    let out = khatt(
        dir.path(),
        &["trace", "--centerline", "line.png", "-o", "line.svg"],
    );
    assert_eq!(out.status.code(), Some(0), "{out:?}");
    let svg = fs::read_to_string(dir.path().join("line.svg")).expect("a drawing");
    let d = svg
        .split(" d=\"")
        .nth(1)
        .and_then(|rest| rest.split('"').next());
    let path = BezPath::from_svg(d.expect("a path")).expect("curves");
    let line = kurbo::Line::new((20.0, 30.0), (140.0, 75.0));
    for p in path
        .segments()
        .flat_map(|s| [0.0, 0.25, 0.5, 0.75, 1.0].map(|t| s.eval(t)))
    {
        let off = line.nearest(p, 1e-6).distance_sq.sqrt();
        // 0.44 in steps
        assert!(off < 0.25, "{off}: {svg}");
    }
}

/// As after `khatt methods | head -1`.
#[test]
fn a_reader_that_has_had_enough_is_no_error() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("disc.png"), png(80, 60, disc)).expect("a picture");
    let closed = || std::io::pipe().expect("a pipe").1;
    let cases: [&[&str]; 5] = [
        &["methods"],
        &["methods", "--json"],
        &["schema"],
        &["init", "letters"],
        &["trace", "disc.png", "-o", "-"],
    ];
    for args in cases {
        let out = command(dir.path(), args).stdout(closed()).output();
        let out = out.expect("the program runs");
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert_eq!((out.status.code(), &*stderr), (Some(0), ""), "{args:?}");
    }
    // nor is one of messages
    let failed = command(dir.path(), &["init", "letters"])
        .stderr(closed())
        .output();
    assert_eq!(failed.expect("the program runs").status.code(), Some(1));
}

#[test]
fn no_more_threads_than_can_be_of_use() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("disc.png"), png(80, 60, disc)).expect("a picture");
    let run = |jobs: &str| {
        let args = ["trace", "disc.png", "-o", "-", "--jobs", jobs];
        khatt(dir.path(), &args)
    };
    for jobs in ["0", "1025", "99999", "99999999999999999999", "-1", "two"] {
        let out = run(jobs);
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(2), "{jobs}: {stderr}");
    }
    let many = run("99999");
    let stderr = String::from_utf8_lossy(&many.stderr);
    assert!(
        stderr.contains("must be a whole number from 1 to 1024"),
        "{stderr}"
    );
    assert_eq!(run("1024").stdout, run("1").stdout);
}

#[test]
fn names_that_promise_another_kind_are_refused() {
    let dir = tempfile::tempdir().expect("a folder");
    fs::write(dir.path().join("disc.png"), png(80, 60, disc)).expect("a picture");
    let wrong: [&[&str]; 5] = [
        &["trace", "disc.png", "-o", "out.png"],
        &["trace", "disc.png", "-o", "out.ufo"],
        &["trace", "disc.png", "-o", "out.ttf", "--centerline"],
        &["features", "disc.png", "-o", "out.pdf"],
        &["cut", "font.toml", "-o", "-"],
    ];
    for args in wrong {
        let out = khatt(dir.path(), args);
        let stderr = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(1), "{args:?}: {stderr}");
        assert!(stderr.contains("  help: "), "{args:?}: {stderr}");
        let left = fs::read_dir(dir.path()).expect("the folder").count();
        assert_eq!(left, 1, "{args:?} wrote something");
    }
    let right: [&[&str]; 4] = [
        &["trace", "disc.png", "-o", "out.SVG"],
        &["trace", "disc.png", "-o", "out"],
        &["trace", "disc.png", "-o", "o.UFO", "--centerline"],
        &["features", "disc.png", "-o", "features.svg"],
    ];
    for args in right {
        let out = khatt(dir.path(), args);
        assert_eq!(out.status.code(), Some(0), "{args:?}: {out:?}");
    }
    assert!(dir.path().join("o.UFO/metainfo.plist").exists());
}
