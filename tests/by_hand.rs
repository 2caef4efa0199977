//! What a project says by hand: names, anchors, where outputs go.

use crate::common::desk::{BUILD, Desk};
use crate::convert::{files, patched, table, written};
use khatt::read;
use write_fonts::read::{FontRef, TableProvider};
use write_fonts::types::NameId;

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
