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
