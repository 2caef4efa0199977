//! A UFO is built again: what was done to it by hand stays.
#![expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who edits a UFO"
)]

use crate::cli::khatt;
use crate::sheets::{LETTERS, page, project};
use norad::{Anchor, Font, Name};
use std::fs;
use std::path::Path;

fn build(folder: &Path, more: &[&str]) -> String {
    let out = khatt(folder, &[&["build", "font.toml"], more].concat());
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(0), "{said}");
    said
}

#[test]
fn a_ufo_built_again_keeps_hand_work() {
    let dir = project(LETTERS, &page(&[]));
    let ufo = dir.path().join("out/test.ufo");
    let name = |n: &str| Name::new(n).expect("a name");
    build(dir.path(), &[]);
    let mut font = Font::load(&ufo).expect("a UFO");
    font.get_glyph_mut("H").expect("H").width = 999.0;
    let anchor = Anchor::new(30.0, 0.0, Some(name("ogonek")), None, None);
    font.get_glyph_mut("E").expect("E").anchors.push(anchor);
    font.kerning
        .entry(name("L"))
        .or_default()
        .insert(name("o"), -33.0);
    font.save(&ufo).expect("saved");

    let said = build(dir.path(), &[]);
    for kept in ["outline of H", "anchor ogonek of E", "kerning L o"] {
        assert!(said.contains(kept), "{said}");
    }
    let holds = || {
        let font = Font::load(&ufo).expect("a UFO");
        let width = font.get_glyph("H").expect("H").width;
        let anchors = font.get_glyph("E").expect("E").anchors.len();
        let pair = font.kerning.get("L").and_then(|l| l.get("o")).copied();
        ((width - 999.0).abs() < 1e-9, anchors, pair)
    };
    assert_eq!(holds(), (true, 1, Some(-33.0)));
    assert!(build(dir.path(), &[]).contains("nothing to do"));

    // all letters become wider: H was changed on both sides, the others follow the build
    let before = Font::load(&ufo)
        .expect("a UFO")
        .get_glyph("o")
        .expect("o")
        .width;
    let path = dir.path().join("font.toml");
    let text = fs::read_to_string(&path).expect("the project");
    fs::write(&path, format!("{text}[spacing.letters]\ntracking = 0.05\n")).expect("a project");
    let said = build(dir.path(), &[]);
    assert!(
        said.contains("outline of H was changed by hand and by this build"),
        "{said}"
    );
    assert_eq!(holds(), (true, 1, Some(-33.0)));
    let after = Font::load(&ufo)
        .expect("a UFO")
        .get_glyph("o")
        .expect("o")
        .width;
    assert!((after - before - 100.0).abs() < 1e-9, "{before} {after}");
    build(dir.path(), &["--locked"]);

    build(dir.path(), &["--overwrite"]);
    assert_eq!(holds(), (false, 0, None));
}

#[test]
fn a_damaged_ufo_is_told_with_its_file_and_the_reason() {
    let dir = project(LETTERS, &page(&[]));
    let ufo = dir.path().join("out/test.ufo");
    build(dir.path(), &[]);
    for (file, content) in [("glyphs/H_.glif", "<glyph"), ("groups.plist", "<plist")] {
        let whole = fs::read(ufo.join(file)).ok();
        fs::write(ufo.join(file), content).expect("a damaged file");
        let out = khatt(dir.path(), &["build", "font.toml"]);
        let said = String::from_utf8_lossy(&out.stderr);
        assert_eq!(out.status.code(), Some(1), "{file}: {said}");
        let name = file.rsplit('/').next().expect("a name");
        assert!(said.contains("the UFO there cannot be read"), "{said}");
        assert!(said.contains(name), "{file}: {said}");
        match whole {
            Some(whole) => fs::write(ufo.join(file), whole).expect("the file again"),
            None => fs::remove_file(ufo.join(file)).expect("no such file before"),
        }
    }
}
