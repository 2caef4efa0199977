//! What outputs do to files that lie where they go: nothing of the user's is lost; `--locked` tells all that differs.

use crate::common::demo;
use crate::common::desk::{BUILD, Desk};
use std::fs;

/// The command fails, names `what`, and leaves every file as it was.
fn refused(desk: &Desk, args: &[&str], what: &str) {
    let before = desk.files("");
    let said = desk.fails(args);
    assert!(
        said.contains(what) && said.contains("help: "),
        "{args:?}: {said}"
    );
    let after = desk.files("");
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
fn outputs(desk: &Desk, lines: &str) {
    desk.edit(|text| {
        let (head, _) = text.split_once("[output]").expect("outputs");
        format!("{head}[output]\n{lines}\n")
    });
}

#[cfg(unix)]
#[test]
fn a_link_stays_one_and_a_pipe_takes_what_is_written() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let desk = Desk::letters();
    desk.write("real/old.ttf", b"mine");
    symlink("real/old.ttf", desk.path("out.ttf")).expect("a link");
    outputs(&desk, "ttf = \"out.ttf\"");
    desk.done(&BUILD);
    let link = fs::symlink_metadata(desk.path("out.ttf")).expect("a link");
    assert!(link.is_symlink());
    let font = desk.read("real/old.ttf");
    assert!(font.len() > 1000, "{} bytes", font.len());
    let pipe = desk.path("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.is_ok_and(|s| s.success()));
    outputs(&desk, "ttf = \"pipe\"");
    // the second time nothing has changed, but what went through is not there
    for _ in 0..2 {
        let reader = std::thread::spawn({
            let pipe = pipe.clone();
            move || fs::read(pipe)
        });
        desk.done(&BUILD);
        let through = reader.join().expect("a reader").expect("bytes");
        assert!(through == font, "{} bytes", through.len());
    }
    assert!(fs::metadata(&pipe).expect("the pipe").file_type().is_fifo());
}

#[test]
fn a_folder_of_the_users_files_is_not_replaced_by_files_of_the_same_kind() {
    let desk = Desk::letters();
    desk.write("scans/other.png", b"mine");
    refused(
        &desk,
        &["cut", "font.toml", "-o", "scans"],
        "scans/other.png",
    );
    desk.write("pics/holiday.png", b"mine");
    let keep = ["build", "font.toml", "--keep", "pics"];
    refused(&desk, &keep, "pics/holiday.png");
    // names that the build itself would write
    desk.write("drawings/o.svg", b"mine");
    outputs(&desk, "svg = \"drawings\"");
    refused(&desk, &BUILD, "drawings/o.svg");
    desk.write("ours.ufo/metainfo.plist", b"mine");
    desk.write("ours.ufo/glyphs/o.glif", b"mine");
    outputs(&desk, "ufo = \"ours.ufo\"");
    let build = ["build", "font.toml", "--overwrite"];
    refused(&desk, &build, "ours.ufo/glyphs/o.glif");
    desk.write("file", b"mine");
    let cut = ["cut", "font.toml", "-o", "file"];
    refused(&desk, &cut, "file is a file");
}

#[test]
fn a_folder_that_khatt_made_is_replaced_until_somebody_puts_a_file_into_it() {
    let desk = Desk::letters();
    outputs(&desk, "svg = \"svg\"\nufo = \"a.ufo\"");
    desk.done(&BUILD);
    let first = desk.files("svg");
    assert!(first.contains_key("L_.svg"), "{:?}", first.keys());

    desk.edit(|text| text.replace("N c L", "N c _"));
    desk.done(&BUILD);
    let second = desk.files("");
    for gone in ["svg/L_.svg", "a.ufo/glyphs/L_.glif"] {
        assert!(!second.contains_key(gone), "{gone} is not built any more");
    }

    desk.write("svg/drawing.svg", b"mine");
    refused(&desk, &BUILD, "svg/drawing.svg");
    desk.remove("svg/drawing.svg");
    desk.write("a.ufo/notes.txt", b"mine");
    refused(&desk, &BUILD, "a.ufo/notes.txt");
}

#[test]
fn a_folder_of_an_older_khatt_is_replaced_where_it_holds_what_is_written() {
    let desk = Desk::letters();
    let cut = ["cut", "font.toml", "-o", "cells"];
    desk.done(&cut);
    let made = desk.files("cells");
    // the list of what khatt made
    desk.remove("cells/.khatt");
    desk.done(&cut);
    assert!(desk.files("cells") == made, "the list is back");
    desk.remove("cells/.khatt");
    desk.write("cells/01-010.png", b"mine");
    refused(&desk, &cut, "cells/01-001.png");
}

#[test]
fn a_ufo_of_khatts_is_converted_anew_and_somebody_elses_is_not() {
    let desk = Desk::letters();
    desk.done(&BUILD);
    let convert = ["convert", "out/test.otf", "-o", "made.ufo"];
    desk.done(&convert);
    // its own
    desk.done(&convert);
    let lib = desk.text("made.ufo/lib.plist");
    let lib = lib.replace("khatt.built", "somebody.built");
    desk.write("made.ufo/lib.plist", lib);
    refused(&desk, &convert, "made.ufo/");

    let trace = ["trace", "page.png", "--centerline", "-o", "line.ufo"];
    desk.done(&trace);
    desk.done(&trace);
}

#[test]
fn outputs_take_the_place_of_no_input_and_of_no_other_output() {
    let desk = Desk::letters();
    for (lines, what) in [
        ("report = \"font.toml\"", "font.toml"),
        ("proof = \"page.png\"", "page.png"),
        ("report = \"none/../page.png\"", "page.png"),
        ("ttf = \"a\"\notf = \"a\"", "two outputs"),
        ("ttf = \"a\"\notf = \"out/../a\"", "two outputs"),
        ("svg = \"new\"\notf = \"new/a.otf\"", "new/a.otf"),
        ("svg = \".\"", "font.toml"),
    ] {
        outputs(&desk, lines);
        refused(&desk, &BUILD, what);
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(".", desk.path("here")).expect("a link");
        outputs(&desk, "report = \"here/page.png\"");
        desk.fails(&BUILD);
        desk.remove("here");
    }
    outputs(&desk, "ttf = \"a.ttf\"");
    for option in ["--depfile", "--sarif", "--keep"] {
        for (path, what) in [("./page.png", "page.png"), ("a.ttf", "a.ttf")] {
            refused(&desk, &["build", "font.toml", option, path], what);
        }
    }
}

#[test]
fn no_command_writes_over_what_it_reads() {
    let desk = Desk::letters();
    desk.done(&BUILD);
    desk.edit(|text| format!("cells_file = \"cells.toml\"\n{text}"));
    desk.write("cells.toml", b"[o]\nrotation = 1\n");
    // a picture, whatever its name
    desk.write("page.svg", desk.read("page.png"));
    let cases: [(&[&str], &str); 10] = [
        (&["trace", "page.svg", "-o", "out/../page.svg"], "page.svg"),
        (&["features", "page.svg", "-o", "./page.svg"], "page.svg"),
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
        refused(&desk, args, what);
    }
    desk.write("font.toml", b"no project");
    let build = ["build", "font.toml", "--sarif", "font.toml"];
    refused(&desk, &build, "font.toml");
}

#[test]
fn no_command_writes_over_what_the_project_names() {
    let desk = Desk::letters();
    desk.done(&BUILD);
    for (output, key) in [
        ("out/test.ttf", "[output] ttf"),
        ("out/../out/test.otf", "[output] otf"),
        ("out/svg/a.bin", "[output] svg"),
        ("page.png", "[[sheet]] image"),
        ("font.toml", "the project file"),
    ] {
        let page = ["page", "font.toml", "--sheet", "1", "-o", output];
        for args in [
            &["proof", "font.toml", "-o", output][..],
            &page,
            &["cut", "font.toml", "-o", output],
            &["cut", "font.toml", "--write-overrides", output],
        ] {
            refused(&desk, args, key);
        }
    }
    refused(&desk, &["cut", "font.toml", "-o", "out"], "[output] ttf");
    // its own place
    desk.done(&["proof", "font.toml", "-o", "out/test.html"]);
    desk.done(&["cut", "font.toml", "-o", "cells"]);
}

#[test]
fn a_dash_is_standard_output() {
    let desk = Desk::letters();
    let page = desk.run(&["page", "font.toml", "--sheet", "1", "-o", "-"]);
    desk.done(&["page", "font.toml", "--sheet", "1", "-o", "a.page"]);
    assert!(
        page.stdout == desk.read("a.page"),
        "{} bytes",
        page.stdout.len()
    );
    let rule = desk.run(&["build", "font.toml", "--depfile", "-"]).stdout;
    let rule = String::from_utf8(rule).expect("text");
    assert!(
        rule.contains("out/test.ttf") && rule.contains(": font.toml"),
        "{rule}"
    );
    // the second time, too, when nothing is to be done else
    for _ in 0..2 {
        let log = desk.run(&["build", "font.toml", "--sarif", "-"]).stdout;
        let log: serde_json::Value = serde_json::from_slice(&log).expect("JSON");
        assert_eq!(log["version"], "2.1.0");
    }
    let cells = desk
        .run(&["cut", "font.toml", "--write-overrides", "-"])
        .stdout;
    assert!(String::from_utf8_lossy(&cells).contains("[H]"));
    refused(
        &desk,
        &["build", "font.toml", "--sarif", "-", "--depfile", "-"],
        "-",
    );
    let (status, said) = desk.told(&["build", "font.toml", "--keep", "-"]);
    assert_eq!(status, Some(2), "{said}");
    assert!(!desk.has("-"), "no file has that name");
}

#[test]
fn make_knows_the_outputs_of_a_project_in_a_folder_by_its_own_names() {
    let desk = Desk::letters();
    outputs(&desk, "ttf = \"../build/./test.ttf\"");
    for name in ["font.toml", "page.png"] {
        desk.write(&format!("source/{name}"), desk.read(name));
    }
    let build = |file: &str| {
        let made = desk.run(&["build", file, "--depfile", "-"]);
        String::from_utf8(made.stdout).expect("text")
    };
    let rule = build("source/font.toml");
    let first = "build/test.ttf: source/font.toml source/page.png\n";
    assert!(rule.starts_with(first), "{rule}");
    // what lies above a link is not what lies above its name
    #[cfg(unix)]
    {
        desk.write("far/build/kept", "");
        std::os::unix::fs::symlink("../source", desk.path("far/link")).expect("a link");
        let rule = build("far/link/font.toml");
        assert!(rule.starts_with("far/link/../build/test.ttf: "), "{rule}");
        assert!(!desk.has("far/build/test.ttf"));
    }
}

#[test]
fn locked_tells_all_that_a_build_would_change() {
    let desk = Desk::letters();
    outputs(
        &desk,
        "svg = \"svg\"\nufo = \"a.ufo\"\nreport = \"report.json\"",
    );
    desk.done(&BUILD);
    let locked = ["build", "font.toml", "--locked"];
    desk.done(&locked);
    let report = desk.read("report.json");
    for (stray, content) in [
        ("svg/zz.svg", &b"<svg/>"[..]),
        ("a.ufo/glyphs/zz.glif", b"<glyph/>"),
        ("report.json", b"junk"),
    ] {
        desk.write(stray, content);
        refused(&desk, &locked, stray);
        if stray == "report.json" {
            desk.write(stray, &report);
        } else {
            desk.remove(stray);
        }
        desk.done(&locked);
    }
    // no note of an older khatt's that it made the folder
    desk.remove("svg/.khatt");
    desk.done(&locked);
    for more in [
        &["--depfile", "a.d"][..],
        &["--keep", "kept"],
        &["--timings"],
    ] {
        assert_eq!(desk.told(&[&locked, more].concat()).0, Some(2));
    }
}

#[test]
fn outputs_older_than_an_input_that_has_not_changed_are_dated_anew() {
    let desk = Desk::letters();
    let dates = || {
        let outputs = ["test.ttf", "test.ufo", "svg", "svg/o.svg", "test.html"];
        outputs.map(|name| {
            let output = fs::metadata(desk.path("out").join(name));
            output.and_then(|m| m.modified()).expect("a date")
        })
    };
    let locked = ["build", "font.toml", "--locked"];
    desk.done(&BUILD);
    desk.done(&locked);
    let (built, files) = (dates(), desk.files("out"));
    desk.done(&BUILD);
    assert_eq!(dates(), built, "nothing is older than an input");

    desk.write("page.png", desk.read("page.png"));
    let touched = fs::metadata(desk.path("page.png")).and_then(|m| m.modified());
    let touched = touched.expect("a date");
    assert!(built.iter().all(|date| *date < touched), "{built:?}");
    assert!(desk.done(&locked).contains("nothing to do"));
    assert_eq!(dates(), built, "--locked writes nothing, and no date");
    assert!(desk.done(&BUILD).contains("nothing to do"));
    let dated = dates();
    assert!(dated.iter().all(|date| *date >= touched), "{dated:?}");
    assert!(desk.files("out") == files, "and nothing else");
}

/// The report is not rounded: it has the last bits of all that was measured. On a page of nine letters they need not
/// differ, on one of 84 they did.
#[test]
fn processors_with_fused_multiply_add_build_as_others_do() {
    let desk = Desk::new();
    for file in ["rasm.toml", "rasm.jpg"] {
        let content = fs::read(demo::folder().join(file)).expect("the demo");
        desk.write(&format!("glyphs/{file}"), content);
    }
    let text = desk.text("glyphs/rasm.toml");
    desk.write(
        "glyphs/rasm.toml",
        text.replace("[output]", "[output]\nreport = \"../build/rasm.json\""),
    );
    let args = ["build", "--no-cache", "glyphs/rasm.toml"];
    desk.done(&args);
    let built = desk.files("build");
    desk.remove("build");
    // glibc's way to go by another processor; other systems' libraries do not hear it
    let without = "glibc.cpu.hwcaps=-FMA,-FMA4,-AVX2,-AVX512F";
    let status = desk.command(&args).env("GLIBC_TUNABLES", without).status();
    assert!(status.is_ok_and(|s| s.success()));
    let again = desk.files("build");
    assert_eq!(built.len(), again.len());
    let other: Vec<_> = built
        .iter()
        .filter(|(name, bytes)| again[*name] != **bytes)
        .map(|b| b.0)
        .collect();
    assert!(other.is_empty(), "other bytes: {other:?}");
}

#[cfg(target_os = "linux")]
#[test]
fn a_path_may_be_no_text_and_have_colons() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt;
    let desk = Desk::letters();
    let odd = OsStr::from_bytes(b"12:30 \xff.toml");
    fs::copy(desk.path("font.toml"), desk.path("").join(odd)).expect("a project");
    let mut command = desk.command(&["build", "--depfile", "out/a.d", "--sarif", "out/a.sarif"]);
    let out = command.arg(odd).output().expect("the program runs");
    assert!(out.status.success(), "{out:?}");
    let rule = desk.read("out/a.d");
    assert!(
        String::from_utf8_lossy(&rule).contains(" 12\\:30\\ "),
        "{rule:?}"
    );
}
