//! A UFO is built again: what was done to it by hand stays.

use crate::common::desk::{BUILD, Desk};
use norad::{Anchor, Font, Name};

#[test]
fn a_ufo_built_again_keeps_hand_work() {
    let desk = Desk::letters();
    let ufo = desk.path("out/test.ufo");
    let name = |n: &str| Name::new(n).expect("a name");
    let font = || Font::load(&ufo).expect("a UFO");
    let width = |letter: &str| font().get_glyph(letter).expect("a letter").width;
    desk.done(&BUILD);
    let mut changed = font();
    changed.get_glyph_mut("H").expect("H").width = 999.0;
    let anchor = Anchor::new(30.0, 0.0, Some(name("ogonek")), None, None);
    changed.get_glyph_mut("E").expect("E").anchors.push(anchor);
    let kerned = changed.kerning.entry(name("L")).or_default();
    kerned.insert(name("o"), -33.0);
    changed.save(&ufo).expect("saved");

    let said = desk.done(&BUILD);
    for kept in ["outline of H", "anchor ogonek of E", "kerning L o"] {
        assert!(said.contains(kept), "{said}");
    }
    let holds = || {
        let font = font();
        let anchors = font.get_glyph("E").expect("E").anchors.len();
        let pair = font.kerning.get("L").and_then(|l| l.get("o")).copied();
        ((width("H") - 999.0).abs() < 1e-9, anchors, pair)
    };
    assert_eq!(holds(), (true, 1, Some(-33.0)));
    assert!(desk.done(&BUILD).contains("nothing to do"));

    // all letters become wider: H was changed on both sides, the others follow the build
    let before = width("o");
    desk.edit(|text| format!("{text}[spacing.letters]\ntracking = 0.05\n"));
    let said = desk.done(&BUILD);
    assert!(
        said.contains("outline of H was changed by hand and by this build"),
        "{said}"
    );
    assert_eq!(holds(), (true, 1, Some(-33.0)));
    let after = width("o");
    assert!((after - before - 100.0).abs() < 1e-9, "{before} {after}");
    desk.done(&["build", "font.toml", "--locked"]);

    desk.done(&["build", "font.toml", "--overwrite"]);
    assert_eq!(holds(), (false, 0, None));
}

#[test]
fn data_and_images_are_not_overwritten() {
    let desk = Desk::letters();
    desk.done(&BUILD);
    let files = [
        ("out/test.ufo/data/notes.txt", b"mine".to_vec()),
        ("out/test.ufo/images/page.png", desk.read("page.png")),
    ];
    files.iter().for_each(|(name, file)| desk.write(name, file));
    desk.edit(|text| format!("{text}[spacing.letters]\ntracking = 0.05\n"));
    desk.done(&BUILD);
    let said = desk.fails(&["build", "font.toml", "--overwrite"]);
    let named = said.contains("data/notes.txt") && said.contains("without --overwrite");
    assert!(named, "{said}");
    for (name, file) in files {
        assert_eq!(desk.read(name), file, "{name}");
        desk.remove(name);
    }
    desk.done(&["build", "font.toml", "--overwrite"]);
}

#[test]
fn a_damaged_ufo_is_told_with_its_file_and_the_reason() {
    let desk = Desk::letters();
    desk.done(&BUILD);
    for (file, content) in [("glyphs/H_.glif", "<glyph"), ("groups.plist", "<plist")] {
        let path = format!("out/test.ufo/{file}");
        let whole = desk.has(&path).then(|| desk.read(&path));
        desk.write(&path, content);
        let said = desk.fails(&BUILD);
        let name = file.rsplit('/').next().expect("a name");
        assert!(said.contains("the UFO there cannot be read"), "{said}");
        assert!(said.contains(name), "{file}: {said}");
        match whole {
            Some(whole) => desk.write(&path, whole),
            None => desk.remove(&path),
        }
    }
}
