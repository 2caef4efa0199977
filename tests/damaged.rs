//! Files that cannot be read as fonts: what is wrong with them is named, and nothing is read as empty.

use crate::common::desk::Desk;
use crate::convert::{patched, table, written};
use khatt::read;
use write_fonts::read::{FontRef, TableProvider};
use write_fonts::types::GlyphId;

/// Why it is not read.
fn why(file: &[u8]) -> String {
    let read = read::font(file, None, &[]);
    read.map(|r| r.font.glyphs().len())
        .expect_err("it is damaged")
        .to_string()
}

#[test]
fn tables_that_do_not_hold_what_they_should_are_named() {
    let ttf = written("ttf");
    let [glyf, loca, hmtx] = [b"glyf", b"loca", b"hmtx"].map(|tag| table(&ttf, tag));
    let swapped = [&loca[..2], &loca[4..6], &loca[2..4], &loca[6..]].concat();
    let mut far = loca.clone();
    far[loca.len() - 2..].copy_from_slice(&[0xff, 0xff]);
    let wrong: [(&[u8; 4], &[u8]); 7] = [
        (b"glyf", &glyf[..glyf.len() / 2]),
        (b"loca", &loca[..loca.len() - 2]),
        (b"loca", &swapped),
        (b"loca", &far),
        (b"hmtx", &hmtx[..hmtx.len() - 2]),
        (b"hmtx", &[]),
        (b"hhea", &[0; 20]),
    ];
    for (tag, bytes) in wrong {
        let said = why(&patched(&ttf, &[(tag, bytes.to_vec())]));
        let name = String::from_utf8_lossy(tag);
        assert!(said.contains(&*name), "{name}: {said}");
        assert!(said.contains("font editor"), "{name}: {said}");
    }
    let otf = written("otf");
    let cff = table(&otf, b"CFF ");
    let said = why(&patched(&otf, &[(b"CFF ", cff[..cff.len() / 2].to_vec())]));
    assert!(
        said.contains("CFF") && said.contains("font editor"),
        "{said}"
    );
    // what is too long holds all the same
    let long = [&hmtx[..], &[0; 3]].concat();
    assert!(read::font(&patched(&ttf, &[(b"hmtx", long)]), None, &[]).is_ok());
}

#[test]
fn tables_that_the_file_does_not_have_whole_are_named() {
    for (name, tag) in [("ttf", b"hmtx"), ("otf", b"hmtx"), ("otf", b"CFF ")] {
        let whole = written(name);
        let at = whole.windows(4).position(|w| w == tag).expect("its entry");
        let mut gone = whole.clone();
        gone[at..at + 4].copy_from_slice(b"none");
        let said = why(&gone);
        let text = String::from_utf8_lossy(tag);
        assert!(said.contains(text.trim()) || *tag == *b"CFF ", "{said}");
        let mut cut = whole.clone();
        cut[at + 8] = 1;
        let said = why(&cut);
        assert!(
            said.contains(text.trim()) && said.contains("ends"),
            "{said}"
        );
    }
    let whole = written("ttf");
    let said = why(&whole[..whole.len() - 40]);
    assert!(said.contains("ends"), "{said}");
}

#[test]
fn a_glyph_that_cannot_be_drawn_is_named() {
    let ttf = written("ttf");
    let font = FontRef::new(&ttf).expect("a font");
    let loca = font.loca(None).expect("loca");
    let at = |id: u32| loca.get_raw(id as usize).expect("a place") as usize;
    let o = font.charmap_of('O');
    let mut glyf = table(&ttf, b"glyf");
    // as many contours as no glyph has room for
    glyf[at(o)..at(o) + 2].copy_from_slice(&[0x40, 0]);
    let said = why(&patched(&ttf, &[(b"glyf", glyf)]));
    assert!(said.contains("O ("), "{said}");

    let mut otf = written("otf");
    let charstring = otf.windows(2).rposition(|w| w == [14, 14]);
    assert!(charstring.is_none(), "no glyph ends twice");
    let cff = table(&otf, b"CFF ");
    let start = otf.windows(cff.len()).position(|w| w == cff).expect("CFF");
    // calls of subroutines that are not there
    let end = start + cff.iter().rposition(|b| *b == 14).expect("its end");
    otf[end - 3..=end].fill(10);
    let said = why(&otf);
    assert!(said.contains("l.alt ("), "{said}");
}

/// A character's glyph.
trait Mapped {
    fn charmap_of(&self, c: char) -> u32;
}

impl Mapped for FontRef<'_> {
    fn charmap_of(&self, c: char) -> u32 {
        let cmap = self.cmap().expect("cmap");
        let id: GlyphId = cmap.map_codepoint(c).expect("a glyph");
        id.to_u32()
    }
}

#[test]
fn what_is_no_font_but_belongs_to_one_is_told_with_what_to_do() {
    let desk = Desk::with("a.woff", b"wOFF\0\x01\0\0 and more");
    desk.write("b.glyphs", b"{\n.appVersion = \"3\";\n}\n");
    desk.write("c.glyphspackage/fontinfo.plist", b"{}");
    desk.write("d.designspace", b"<designspace format=\"5.0\"/>");
    for (name, what, remedy) in [
        ("a.woff", "WOFF 1", "WOFF2"),
        ("b.glyphs", "Glyphs", "export"),
        ("c.glyphspackage", "Glyphs", "export"),
        ("d.designspace", "designspace", "UFO"),
    ] {
        let said = desk.fails(&["convert", name, "-o", "out.otf"]);
        assert!(said.contains(name), "{said}");
        assert!(said.contains(what) && said.contains(remedy), "{said}");
    }
}

#[test]
fn a_font_without_names_keeps_its_characters_in_a_folder_of_drawings() {
    let ttf = written("ttf");
    let mut post = table(&ttf, b"post");
    post.truncate(32);
    post[..4].copy_from_slice(&[0, 3, 0, 0]);
    let desk = Desk::with("nameless.ttf", patched(&ttf, &[(b"post", post)]));
    desk.done(&["convert", "nameless.ttf", "-o", "drawings"]);
    let names: Vec<_> = desk.files("drawings").into_keys().collect();
    assert!(names.contains(&"O_.svg".to_owned()), "{names:?}");
    assert!(names.contains(&"uni0628.svg".to_owned()), "{names:?}");
    desk.done(&["convert", "drawings", "-o", "again.ttf"]);
    let again = desk.read("again.ttf");
    let again = FontRef::new(&again).expect("a font");
    for c in ['O', 'ب'] {
        assert_ne!(again.charmap_of(c), 0, "{c}");
    }
}
