//! What a project says by hand: names, anchors, where outputs go.

use crate::common::desk::{BUILD, Desk};
use crate::convert::{files, patched, table, written};
use khatt::read;
use write_fonts::read::{FontRef, TableProvider};
use write_fonts::types::NameId;

/// What a build of the project says, with keys of the font and tables at its end.
fn built(desk: &Desk, font: &str, more: &str) -> (Option<i32>, String) {
    let text = Desk::letters().text("font.toml");
    let text = text.replace("N c L", "N f_l acutecomb");
    let text = text.replace("[font]", &format!("[font]\n{font}"));
    desk.write("font.toml", format!("{text}{more}"));
    desk.told(&["build", "font.toml", "--no-cache"])
}

#[test]
fn anchors_that_nothing_attaches_by_are_noted() {
    let desk = Desk::letters();
    let anchors = |text: &str| {
        let (status, said) = built(&desk, "", &format!("[anchors]\n{text}\n"));
        assert_eq!(status, Some(0), "{said}");
        let notes = said.lines().filter(|l| l.contains("[anchors]"));
        notes.collect::<Vec<_>>().join("\n")
    };
    let said = anchors("H = { topp = [50, 710] }");
    assert!(said.contains("H: ") && said.contains("_topp"), "{said}");
    assert!(said.contains("did you mean top?"), "{said}");
    let said = anchors("acutecomb = { _topp = [50, 710] }");
    assert!(said.contains("did you mean _top?"), "{said}");
    let said = anchors("f_l = { top = [50, 710] }");
    assert!(said.contains("top_1, top_2"), "{said}");
    for fine in [
        "H = { top = [50, 710] }",
        "H = { above = [50, 710] }",
        "f_l = { top_1 = [50, 710] }",
        "acutecomb = { _top = [50, 710] }",
        "H = { own = [50, 710] }\nacutecomb = { _own = [0, 5] }",
    ] {
        assert_eq!(anchors(fine), "", "{fine}");
    }
}

/// Weight class and PostScript name of what is built with these keys.
fn style(keys: &str) -> (u16, String) {
    let desk = Desk::letters();
    let (status, said) = built(&desk, keys, "");
    assert_eq!(status, Some(0), "{said}");
    let ttf = desk.read("out/test.ttf");
    let font = FontRef::new(&ttf).expect("a font");
    let name = font.name().expect("names");
    let record = name.name_record();
    let record = record.iter().find(|r| r.name_id() == NameId::new(6));
    let text = record.expect("a name").string(name.string_data());
    let weight = font.os2().expect("OS/2").us_weight_class();
    (weight, text.expect("text").to_string())
}

#[test]
fn styles_have_their_weights_and_fonts_names_of_their_own() {
    for (keys, weight, name) in [
        ("style = \"Bold\"", 700, "Test-Bold"),
        ("style = \"Semi Bold Italic\"", 600, "Test-SemiBoldItalic"),
        ("style = \"Bold\"\nweight = 650", 650, "Test-Bold"),
        ("style = \"Boldly\"", 400, "Test-Boldly"),
        ("style = \"عريض\"", 700, "Test-Bold"),
        ("style = \"عادي\"", 400, "Test-Regular"),
        ("style = \"مزخرف\"", 400, "Test-u0645u0632u062Eu0631u0641"),
        ("postscript_name = \"Own-Name\"", 400, "Own-Name"),
    ] {
        assert_eq!(style(keys), (weight, name.to_owned()), "{keys}");
    }
    let desk = Desk::letters();
    let (status, said) = built(&desk, "postscript_name = \"a name\"", "");
    assert_eq!(status, Some(1), "{said}");
    assert!(said.contains("must be a PostScript name"), "{said}");
}

#[test]
fn outputs_are_named_as_what_they_are() {
    let desk = Desk::letters();
    for (line, ending) in [
        ("ttf = \"a.otf\"", ".ttf"),
        ("otf = \"a.TTF\"", ".otf"),
        ("woff2 = \"a.woff\"", ".woff2"),
        ("ufo = \"a\"", ".ufo"),
        ("svg = \"a.svg\"", "folder"),
        ("proof = \"a.ttf\"", ".html"),
        ("report = \"a.otf\"", ".json"),
        ("ttf = \"-\"", ".ttf"),
    ] {
        desk.edit(|text| {
            let (head, _) = text.split_once("[output]").expect("outputs");
            format!("{head}[output]\n{line}\n")
        });
        let said = desk.fails(&BUILD);
        assert!(said.contains(line), "{line}: {said}");
        assert!(said.contains("must") && said.contains(ending), "{said}");
    }
    assert!(!desk.has("a.otf") && !desk.has("-"));
}

#[test]
fn a_list_of_glyphs_is_told_how_to_write_it() {
    let desk = Desk::letters();
    desk.edit(|text| text.replace("\"H o l E e I N c L\"", "[\"H\", \"o\"]"));
    let said = desk.fails(&BUILD);
    assert!(
        said.contains("must be") && said.contains("\"A B C\""),
        "{said}"
    );
    assert!(!said.contains("untagged"), "{said}");
}

#[test]
fn heights_of_hhea_and_of_typo_are_told_apart_in_a_ufo() {
    let ttf = written("ttf");
    let [mut hhea, mut os2] = [b"hhea", b"OS/2"].map(|tag| table(&ttf, tag));
    for (at, value) in [(4, 951_i16), (6, -251), (8, 37)] {
        hhea[at..at + 2].copy_from_slice(&value.to_be_bytes());
    }
    for (at, value) in [(68, 812_i16), (70, -188), (72, 90)] {
        os2[at..at + 2].copy_from_slice(&value.to_be_bytes());
    }
    let file = patched(&ttf, &[(b"hhea", hhea), (b"OS/2", os2)]);
    let font = read::font(&file, None, &[]).expect("a font").font;
    let files = files(&font, "ufo").0;
    let info = plist::Value::from_reader_xml(&files["fontinfo.plist"][..]).expect("a plist");
    let number = |key: &str| {
        let value = info.as_dictionary().and_then(|d| d.get(key));
        value.and_then(plist::Value::as_signed_integer)
    };
    let said = ["Hhea", "OS2Typo"].map(|table| {
        ["Ascender", "Descender", "LineGap"].map(|key| number(&format!("openType{table}{key}")))
    });
    let wanted = [[951, -251, 37], [812, -188, 90]];
    assert_eq!(said, wanted.map(|heights| heights.map(Some)));
}
