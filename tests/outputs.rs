//! What outputs do to files that lie where they go: nothing of the user's is lost; `--locked` tells all that differs.
#![expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who writes files"
)]

use crate::cli::khatt;
use crate::sheets::{LETTERS, files, page, project};
use std::fs;
use std::path::Path;

/// Exit status of a command and what it said.
fn run(folder: &Path, args: &[&str]) -> (Option<i32>, String) {
    let out = khatt(folder, args);
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    (out.status.code(), said)
}

/// The command fails, names `what`, and leaves every file as it was.
fn refused(folder: &Path, args: &[&str], what: &str) {
    let before = files(folder);
    let (status, said) = run(folder, args);
    assert_eq!(status, Some(1), "{args:?}: {said}");
    assert!(
        said.contains(what) && said.contains("help: "),
        "{args:?}: {said}"
    );
    let after = files(folder);
    let lost: Vec<_> = before.keys().filter(|k| !after.contains_key(*k)).collect();
    assert!(lost.is_empty(), "{args:?}: {lost:?}");
    assert!(
        kept(&after) == kept(&before),
        "{args:?}: files have changed"
    );
}

/// All but the cache.
fn kept(files: &std::collections::BTreeMap<String, Vec<u8>>) -> Vec<(&String, &Vec<u8>)> {
    let all = files.iter();
    all.filter(|(name, _)| !name.starts_with("cache")).collect()
}

/// The project with other outputs.
fn outputs(folder: &Path, lines: &str) {
    edit(folder, |text| {
        let (head, _) = text.split_once("[output]").expect("outputs");
        format!("{head}[output]\n{lines}\n")
    });
}

fn edit(folder: &Path, change: impl FnOnce(String) -> String) {
    let path = folder.join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    fs::write(path, change(text)).expect("a project");
}

fn put(folder: &Path, name: &str, content: &[u8]) {
    let path = folder.join(name);
    fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
    fs::write(path, content).expect("a file");
}

#[cfg(unix)]
#[test]
fn a_link_stays_one_and_a_pipe_takes_what_is_written() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let dir = project(LETTERS, &page(&[]));
    let folder = dir.path();
    put(folder, "real/old.ttf", b"mine");
    symlink("real/old.ttf", folder.join("out.ttf")).expect("a link");
    outputs(folder, "ttf = \"out.ttf\"");
    assert_eq!(run(folder, &["build", "font.toml"]).0, Some(0));
    let link = fs::symlink_metadata(folder.join("out.ttf")).expect("a link");
    assert!(link.is_symlink());
    let font = fs::read(folder.join("real/old.ttf")).expect("a font");
    assert!(font.len() > 1000, "{} bytes", font.len());
    let pipe = folder.join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|s| s.success()));
    let reader = std::thread::spawn({
        let pipe = pipe.clone();
        move || fs::read(pipe)
    });
    outputs(folder, "ttf = \"pipe\"");
    assert_eq!(run(folder, &["build", "font.toml"]).0, Some(0));
    let through = reader.join().expect("a reader").expect("bytes");
    assert!(through == font, "{} bytes", through.len());
    assert!(fs::metadata(&pipe).expect("the pipe").file_type().is_fifo());
}

#[test]
fn a_folder_of_the_users_files_is_not_replaced_by_files_of_the_same_kind() {
    let dir = project(LETTERS, &page(&[]));
    let folder = dir.path();
    put(folder, "scans/other.png", b"mine");
    refused(
        folder,
        &["cut", "font.toml", "-o", "scans"],
        "scans/other.png",
    );
    put(folder, "pics/holiday.png", b"mine");
    let keep = ["build", "font.toml", "--keep", "pics"];
    refused(folder, &keep, "pics/holiday.png");
    // names that the build itself would write
    put(folder, "drawings/o.svg", b"mine");
    outputs(folder, "svg = \"drawings\"");
    refused(folder, &["build", "font.toml"], "drawings/o.svg");
    put(folder, "ours.ufo/metainfo.plist", b"mine");
    put(folder, "ours.ufo/glyphs/o.glif", b"mine");
    outputs(folder, "ufo = \"ours.ufo\"");
    let build = ["build", "font.toml", "--overwrite"];
    refused(folder, &build, "ours.ufo/glyphs/o.glif");
    put(folder, "file", b"mine");
    let cut = ["cut", "font.toml", "-o", "file"];
    refused(folder, &cut, "file is a file");
}

#[test]
fn a_folder_that_khatt_made_is_replaced_until_somebody_puts_a_file_into_it() {
    let dir = project(LETTERS, &page(&[]));
    let folder = dir.path();
    outputs(folder, "svg = \"svg\"\nufo = \"a.ufo\"");
    let build = ["build", "font.toml"];
    assert_eq!(run(folder, &build).0, Some(0));
    let first = files(&folder.join("svg"));
    assert!(first.contains_key("L_.svg"), "{:?}", first.keys());

    edit(folder, |text| text.replace("N c L", "N c _"));
    assert_eq!(run(folder, &build).0, Some(0));
    let second = files(folder);
    for gone in ["svg/L_.svg", "a.ufo/glyphs/L_.glif"] {
        assert!(!second.contains_key(gone), "{gone} is not built any more");
    }

    put(folder, "svg/drawing.svg", b"mine");
    refused(folder, &build, "svg/drawing.svg");
    fs::remove_file(folder.join("svg/drawing.svg")).expect("a file");
    put(folder, "a.ufo/notes.txt", b"mine");
    refused(folder, &build, "a.ufo/notes.txt");
}

#[test]
fn a_folder_of_an_older_khatt_is_replaced_where_it_holds_what_is_written() {
    let dir = project(LETTERS, &page(&[]));
    let folder = dir.path();
    let cut = ["cut", "font.toml", "-o", "cells"];
    assert_eq!(run(folder, &cut).0, Some(0));
    let made = files(&folder.join("cells"));
    let list = folder.join("cells/.khatt");
    fs::remove_file(&list).expect("the list of what khatt made");
    assert_eq!(run(folder, &cut).0, Some(0));
    assert!(files(&folder.join("cells")) == made, "the list is back");
    fs::remove_file(&list).expect("the list");
    put(folder, "cells/01-010.png", b"mine");
    refused(folder, &cut, "cells/01-001.png");
}

#[test]
fn a_ufo_of_khatts_is_converted_anew_and_somebody_elses_is_not() {
    let dir = project(LETTERS, &page(&[]));
    let folder = dir.path();
    assert_eq!(run(folder, &["build", "font.toml"]).0, Some(0));
    let convert = ["convert", "out/test.otf", "-o", "made.ufo"];
    assert_eq!(run(folder, &convert).0, Some(0));
    assert_eq!(run(folder, &convert).0, Some(0), "its own");
    let lib = folder.join("made.ufo/lib.plist");
    let text = fs::read_to_string(&lib).expect("the lib");
    fs::write(&lib, text.replace("khatt.built", "somebody.built")).expect("a lib");
    refused(folder, &convert, "made.ufo/");

    let trace = ["trace", "page.png", "--centerline", "-o", "line.ufo"];
    assert_eq!(run(folder, &trace).0, Some(0));
    assert_eq!(run(folder, &trace).0, Some(0), "its own");
}

#[test]
fn outputs_take_the_place_of_no_input_and_of_no_other_output() {
    let dir = project(LETTERS, &page(&[]));
    let folder = dir.path();
    let build = ["build", "font.toml"];
    for (lines, what) in [
        ("report = \"font.toml\"", "font.toml"),
        ("proof = \"page.png\"", "page.png"),
        ("report = \"none/../page.png\"", "page.png"),
        ("ttf = \"a.ttf\"\notf = \"a.ttf\"", "a.ttf"),
        ("ttf = \"a.ttf\"\notf = \"out/../a.ttf\"", "a.ttf"),
        ("svg = \"new\"\notf = \"new/a.otf\"", "new/a.otf"),
        ("svg = \".\"", "font.toml"),
    ] {
        outputs(folder, lines);
        refused(folder, &build, what);
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(".", folder.join("here")).expect("a link");
        outputs(folder, "report = \"here/page.png\"");
        let (status, said) = run(folder, &build);
        assert_eq!(status, Some(1), "{said}");
        fs::remove_file(folder.join("here")).expect("the link");
    }
    outputs(folder, "ttf = \"a.ttf\"");
    for option in ["--depfile", "--sarif", "--keep"] {
        for (path, what) in [("./page.png", "page.png"), ("a.ttf", "a.ttf")] {
            refused(folder, &["build", "font.toml", option, path], what);
        }
    }
}

#[test]
fn no_command_writes_over_what_it_reads() {
    let dir = project(LETTERS, &page(&[]));
    let folder = dir.path();
    assert_eq!(run(folder, &["build", "font.toml"]).0, Some(0));
    edit(folder, |text| {
        format!("cells_file = \"cells.toml\"\n{text}")
    });
    put(folder, "cells.toml", b"[o]\nrotation = 1\n");
    let cases: [(&[&str], &str); 10] = [
        (&["trace", "page.png", "-o", "out/../page.png"], "page.png"),
        (&["features", "page.png", "-o", "./page.png"], "page.png"),
        (&["proof", "font.toml", "-o", "page.png"], "page.png"),
        (&["sheet", "font.toml", "-o", "page.png"], "page.png"),
        (
            &["page", "font.toml", "--sheet", "1", "-o", "font.toml"],
            "font.toml",
        ),
        (
            &["convert", "out/test.ttf", "-o", "out/test.ttf"],
            "out/test.ttf",
        ),
        (&["convert", "out/svg", "-o", "out/svg"], "out/svg"),
        (
            &["cut", "font.toml", "--write-overrides", "cells.toml"],
            "cells.toml",
        ),
        (&["cut", "font.toml", "-o", "."], "font.toml"),
        // what a failed build has to say goes nowhere else, either
        (
            &["build", "font.toml", "--sarif", "cells.toml"],
            "cells.toml",
        ),
    ];
    for (args, what) in cases {
        refused(folder, args, what);
    }
    put(folder, "font.toml", b"no project");
    let build = ["build", "font.toml", "--sarif", "font.toml"];
    refused(folder, &build, "font.toml");
}

#[test]
fn locked_tells_all_that_a_build_would_change() {
    let dir = project(LETTERS, &page(&[]));
    let folder = dir.path();
    outputs(
        folder,
        "svg = \"svg\"\nufo = \"a.ufo\"\nreport = \"report.json\"",
    );
    assert_eq!(run(folder, &["build", "font.toml"]).0, Some(0));
    let locked = ["build", "font.toml", "--locked"];
    assert_eq!(run(folder, &locked).0, Some(0));
    let report = fs::read(folder.join("report.json")).expect("a report");
    for (stray, content) in [
        ("svg/zz.svg", &b"<svg/>"[..]),
        ("a.ufo/glyphs/zz.glif", b"<glyph/>"),
        ("report.json", b"junk"),
    ] {
        put(folder, stray, content);
        refused(folder, &locked, stray);
        if stray == "report.json" {
            put(folder, stray, &report);
        } else {
            fs::remove_file(folder.join(stray)).expect("a file");
        }
        assert_eq!(run(folder, &locked).0, Some(0));
    }
    // no note of an older khatt's that it made the folder
    fs::remove_file(folder.join("svg/.khatt")).expect("the list");
    assert_eq!(run(folder, &locked).0, Some(0));
    for more in [
        &["--depfile", "a.d"][..],
        &["--keep", "kept"],
        &["--timings"],
    ] {
        assert_eq!(run(folder, &[&locked, more].concat()).0, Some(2));
    }
}
