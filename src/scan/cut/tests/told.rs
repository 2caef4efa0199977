//! What users are told: names and cells that do not agree, and ink where it should not be.

use super::*;

#[test]
fn rows_without_names_are_told() {
    let cut = |names: &str| cut_page(&grid_page(0.0), names, &options(Layout::Grid(4, 5)));
    for (names, place) in [
        ("n", (1, 2)),
        ("n i p n l", (2, 1)),
        ("n i p n l n n p i n", (3, 1)),
    ] {
        let error = cut(names).unwrap_err();
        let Fault::TooFewNames { row, column, .. } = error else {
            panic!("{error}");
        };
        assert_eq!((row, column), place, "{names}");
    }
    assert!(matches!(cut("_ _ _"), Err(Fault::NoNames)));
}

#[test]
fn a_box_without_a_name_is_told_from_the_left() {
    let rtl = Options {
        direction: Direction::Rtl,
        ..options(Layout::Boxes)
    };
    let error = cut_page(&boxed(0.0), "l i", &rtl).unwrap_err();
    let told = Fault::TooFewNames {
        row: 1,
        column: 2,
        names: 2,
    };
    assert_eq!(error, told);
}

#[test]
fn a_line_that_is_no_column_is_told_as_that() {
    let columns = Options {
        order: Order::Columns,
        lines: vec![4, 3, 4, 4, 4],
        ..options(Layout::Grid(4, 5))
    };
    let error = cut_page(&grid_page(0.0), &NAMES[..NAMES.len() - 2], &columns);
    let error = error.unwrap_err().to_string();
    assert!(
        error.contains("4 letters in column 2, and line 2 of"),
        "{error}"
    );
    assert!(!error.contains("row"), "{error}");
}

#[test]
fn ink_that_reaches_the_next_row_is_told() {
    let mut paper = grid_page(0.0);
    let cut = |paper: &Paper| cut_page(paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
    let told = |cut: &Cut| {
        let reach = cut.warnings.iter().filter(|w| w.message.contains("row"));
        reach
            .map(|w| (w.index, w.message.clone()))
            .collect::<Vec<_>>()
    };
    assert_eq!(told(&cut(&paper)), []);
    // a tail of the letter in the second row ends beside the one under it
    paper.bar(236.0, 214.0, 14.0, 6.0);
    paper.bar(244.0, 214.0, 6.0, 110.0);
    let told = told(&cut(&paper));
    assert!(!told.is_empty(), "{told:?}");
    assert!(
        told.iter().all(|t| t.0 == Some(6) || t.0 == Some(11)),
        "{told:?}"
    );
}

#[test]
fn names_and_cells_must_agree() {
    let paper = grid_page(0.0);
    let grid = options(Layout::Grid(4, 5));
    let many = cut_page(&paper, &format!("{NAMES} x"), &grid).unwrap_err();
    let told = Fault::TooManyNames {
        cells: 20,
        names: 21,
        extra: "x".to_owned(),
    };
    assert_eq!(many, told);
    let few = cut_page(&paper, &NAMES[..NAMES.len() - 2], &grid).unwrap_err();
    let told = Fault::TooFewNames {
        row: 4,
        column: 5,
        names: 19,
    };
    assert_eq!(few, told);
    let blank = cut_page(&Paper::new(300, 300, 0.0), "a", &grid).unwrap_err();
    assert!(matches!(blank, Fault::Blank), "{blank}");
    for (rows, columns) in [(0, 5), (4, 99_999_999_999), (usize::MAX, usize::MAX)] {
        let none = cut_page(&paper, NAMES, &options(Layout::Grid(rows, columns))).unwrap_err();
        assert!(matches!(none, Fault::NoGrid { .. }), "{none}");
    }
    let mut holed = grid_page(0.0);
    holed
        .bars
        .retain(|b| !(b.0.x0 > 190.0 && b.0.x0 < 300.0 && b.0.y0 < 130.0));
    let cut = cut_page(&holed, NAMES, &grid).unwrap();
    assert_eq!(cut.cells.len(), 19);
    assert_eq!(cut.warnings.len(), 1, "the empty cell is warned of");
    assert_eq!(cut.warnings[0].index, Some(1));
}

#[test]
fn names_that_have_slipped_are_told() {
    let names: Vec<&str> = NAMES.split(' ').collect();
    let told = |names: String| {
        let cut = cut_page(&grid_page(0.0), &names, &options(Layout::Grid(4, 5))).unwrap();
        let messages = cut.warnings.into_iter().map(|w| w.message);
        messages.collect::<Vec<_>>()
    };
    assert!(told(NAMES.to_owned()).is_empty());
    let lacking = [&names[..2], &names[3..], &["_"]].concat();
    let told_of = told(lacking.join(" "));
    assert_eq!(told_of.len(), 1, "{told_of:?}");
    assert!(
        told_of[0].contains("had the name before its own: is a name missing"),
        "{told_of:?}"
    );
}

#[test]
fn an_error_of_a_page_whose_ink_was_guessed_names_polarity() {
    use crate::types::Shade;
    let names = format!("{NAMES} n i p");
    let said = |guessed: Option<Shade>| {
        let mut sheet = grid_page(0.0).scan();
        sheet.guessed = guessed;
        let page = clean(sheet, Texture::default()).unwrap();
        let cut = cut(&page, &labels(&names), &options(Layout::Grid(4, 5)), &[]);
        cut.unwrap_err().to_string()
    };
    let plain = said(None);
    assert!(!plain.contains("polarity"), "{plain}");
    let dark = said(Some(Shade::Dark));
    assert!(dark.starts_with(&plain), "{dark}");
    assert!(dark.contains("darker than its paper") && dark.contains("polarity = \"light-ink\""));
    let light = said(Some(Shade::Light));
    assert!(light.contains("polarity = \"dark-ink\""), "{light}");
    let empty = Sheet {
        gray: Gray::from_fn(300, 200, |_, _| 0.1),
        guessed: Some(Shade::Light),
        ..grid_page(0.0).scan()
    };
    let blank = clean(empty, Texture::default()).unwrap_err().to_string();
    assert!(blank.contains("polarity"), "{blank}");
}
