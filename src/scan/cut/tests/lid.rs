//! What surrounds a page does not turn it, and what only looks like that is no loss.

use super::*;

/// A picture with a margin of black around it, or beside some of its sides: left, top, right and bottom, px.
fn beside_black(sheet: &Sheet, [left, top, right, bottom]: [usize; 4]) -> Sheet {
    let (w, h) = (sheet.gray.width(), sheet.gray.height());
    let gray = Gray::from_fn(left + w + right, top + h + bottom, |x, y| {
        let inside = (left..left + w).contains(&x) && (top..top + h).contains(&y);
        if inside {
            sheet.gray.at(x - left, y - top)
        } else {
            0.94
        }
    });
    Sheet {
        gray,
        ..sheet.clone()
    }
}

/// The skew of a page and how many letters it was cut into.
fn cut_sheet(sheet: Sheet) -> (f64, usize) {
    let page = clean(sheet, Texture::default()).unwrap();
    let cut = cut(&page, &labels(NAMES), &options(Layout::Grid(4, 5)), &[]).unwrap();
    (cut.skew_deg, cut.cells.len())
}

#[test]
fn an_upright_lid_does_not_turn_a_page() {
    for deg in [0.8, -1.3] {
        let sheet = grid_page(deg).scan();
        for black in [[100; 4], [70, 40, 70, 40], [120, 0, 0, 0], [0, 90, 90, 0]] {
            let (found, letters) = cut_sheet(beside_black(&sheet, black));
            assert_eq!(letters, 20, "{deg}, {black:?}");
            assert!((found - deg).abs() < 0.1, "{found} for {deg}, {black:?}");
        }
    }
}

#[test]
fn ink_that_the_picture_ends_has_no_edge_there() {
    for deg in [0.8, -1.3] {
        let mut sheet = grid_page(deg).scan();
        let black = |x: usize, y: usize| {
            let strip = (20..320).contains(&x) && y < 10 || (380..680).contains(&x) && y >= 490;
            if strip { 0.94 } else { sheet.gray.at(x, y) }
        };
        sheet.gray = Gray::from_fn(700, 500, black);
        let (found, _) = cut_sheet(sheet);
        assert!((found - deg).abs() < 0.1, "{found} for {deg}");
    }
}

#[test]
fn printed_lines_on_a_page_beside_a_lid_tell_its_skew() {
    let mut paper = grid_page(0.8);
    rule(&mut paper, 1.0);
    let (found, letters) = cut_sheet(beside_black(&paper.scan(), [100; 4]));
    assert_eq!(letters, 20);
    assert!((found - 0.8).abs() < 0.06, "{found}");
}

#[test]
fn a_letter_that_touches_a_lid_is_cut_free() {
    let mut paper = grid_page(0.8);
    // a stroke from the first letter's foot to beyond the paper's left edge
    paper.bar(-20.0, 114.0, 116.0, 6.0);
    let sheet = beside_black(&paper.scan(), [100; 4]);
    let cut = cut(
        &clean(sheet, Texture::default()).unwrap(),
        &labels(NAMES),
        &options(Layout::Grid(4, 5)),
        &[],
    )
    .unwrap();
    assert_eq!(cut.cells.len(), 20);
    assert!(cut.cells[0].in_sheet.width() > 60.0, "with its stroke");
    assert!(cut.rejected.iter().any(|r| r.reason == Reason::OffPage));
}

#[test]
fn a_shadow_over_half_of_a_page_can_be_read_as_the_page() {
    let plain = grid_page(0.0).scan();
    // from left to right within 30 px
    let shadow = |x: usize| 1.0 - 0.5 * ((x as f32 - 270.0) / 30.0).clamp(0.0, 1.0);
    let sheet = || Sheet {
        gray: Gray::from_fn(700, 500, |x, y| {
            1.0 - shadow(x) * (1.0 - plain.gray.at(x, y))
        }),
        ..plain.clone()
    };
    let cut = |page: &Page| cut(page, &labels(NAMES), &options(Layout::Grid(4, 5)), &[]);
    let lit = cut(&clean(sheet(), Texture::default()).unwrap()).map_or(0, |cut| cut.cells.len());
    assert!(lit < 20, "what is dark seems to lie beside the page");
    let page = clean_otherwise(sheet(), Texture::default())
        .unwrap()
        .expect("another way");
    assert_eq!(cut(&page).unwrap().cells.len(), 20);
}

#[test]
fn slivers_at_the_border_are_what_a_scanning_program_left_of_the_table() {
    let mut sheet = grid_page(0.0).scan();
    let sliver = |x: usize, y: usize| {
        y < 4 && (x / 70).is_multiple_of(2) || x >= 697 && (y / 60).is_multiple_of(2)
    };
    sheet.gray = Gray::from_fn(700, 500, |x, y| {
        if sliver(x, y) {
            0.94
        } else {
            sheet.gray.at(x, y)
        }
    });
    let page = clean(sheet, Texture::default()).unwrap();
    let cut = cut(&page, &labels(NAMES), &options(Layout::Free), &[]).unwrap();
    assert_eq!(cut.cells.len(), 20);
    let mut borders = cut.rejected.iter().map(|r| r.reason);
    assert!(borders.any(|r| r == Reason::Border), "{:?}", cut.rejected);
}

#[test]
fn the_grain_of_a_table_is_no_ink() {
    let plain = grid_page(0.0).scan();
    let mut seed = 1_u32;
    let mut noise = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 16) as f32 / 65_536.0
    };
    // the page covers two thirds of the picture
    let gray = Gray::from_fn(860, 620, |x, y| {
        let on_page = (80..780).contains(&x) && (60..560).contains(&y);
        let grain = 0.55 + 0.3 * noise();
        if on_page {
            plain.gray.at(x - 80, y - 60)
        } else {
            grain
        }
    });
    let page = clean(Sheet { gray, ..plain }, Texture::default()).unwrap();
    assert!(page.paper.is_some(), "the page is told from the table");
    let cut = cut(&page, &labels(NAMES), &options(Layout::Free), &[]).unwrap();
    assert_eq!(cut.cells.len(), 20);
}
