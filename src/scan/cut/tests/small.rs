//! What is smaller than letters: dots, dust and pinholes.

use super::*;

#[test]
fn two_dots_stay_together_and_leave_their_neighbours_alone() {
    let mut paper = Paper::new(600, 300, 0.0);
    let dot = |paper: &mut Paper, x: f64, y: f64| paper.bar(x, y, 8.0, 8.0);
    for x in [60.0, 180.0, 300.0, 420.0] {
        paper.letter('n', x, 100.0);
        paper.letter('p', x, 200.0);
    }
    // one of the two dots stands beside its letter rather than over it
    dot(&mut paper, 410.0, 54.0);
    dot(&mut paper, 422.0, 54.0);
    // a full stop reaches into its neighbour's box
    paper.bar(443.0, 218.0, 9.0, 9.0);
    // dots at equal distances under two letters that stand side by side
    paper.letter('n', 500.0, 100.0);
    paper.letter('n', 532.0, 100.0);
    (0..4).for_each(|i| dot(&mut paper, 501.0 + 16.0 * f64::from(i), 106.0));
    let cut = cut_page(&paper, "a b c ت ي ي p q r s .", &options(Layout::Free)).unwrap();
    let size = |i: usize| {
        (
            cut.cells[i].in_sheet.width().round(),
            cut.cells[i].in_sheet.height().round(),
        )
    };
    assert_eq!(size(3), (38.0, 46.0), "both dots are the letter's");
    let pairs = (size(4), size(5));
    assert_eq!(pairs, ((28.0, 44.0), (28.0, 44.0)), "two dots each");
    assert_eq!(size(10), (9.0, 9.0), "a cell of its own");
}

#[test]
fn dots_far_thinner_than_strokes_are_dots_where_letters_have_no_others() {
    // letters of 48 px whose strokes are 40 thick, with a dot of 12, and dust as large beside the last one
    for (names, high) in [("ن ن ن ن", 4), ("د د د د", 0)] {
        let mut paper = Paper::new(560, 200, 0.0);
        for i in 0..4 {
            let x = 60.0 + 120.0 * f64::from(i);
            paper.bar(x, 80.0, 48.0, 48.0);
            paper.bar(x + 18.0, 60.0, 12.0, 12.0);
        }
        let cut = cut_page(&paper, names, &options(Layout::Grid(1, 4))).unwrap();
        let heights = cut.cells.iter().map(|c| c.in_sheet.height());
        assert_eq!(heights.filter(|h| *h > 66.0).count(), high, "{names}");
    }
}

#[test]
fn slits_are_no_pinholes() {
    for (width, open) in [(4.0, false), (14.0, true)] {
        let mut paper = Paper::new(420, 200, 0.0);
        for x in [60.0, 180.0] {
            paper.bar(x, 60.0, 24.0, 60.0);
        }
        // a block with a slit of 3 px in it
        let rest = (30.0 - width) / 2.0;
        paper.bar(300.0, 75.0, 30.0, 13.0);
        paper.bar(300.0, 91.0, 30.0, 14.0);
        paper.bar(300.0, 75.0, rest, 30.0);
        paper.bar(330.0 - rest, 75.0, rest, 30.0);
        let cut = cut_page(&paper, "n n e", &options(Layout::Grid(1, 3))).unwrap();
        let gray = &cut.cells[2].gray;
        let ink = gray.at(gray.width() / 2, gray.height() / 2);
        assert_eq!(ink < 0.5, open, "a slit of {width} px: {ink}");
    }
}

#[test]
fn pinholes_are_filled() {
    // as light as paper, and as pale ink
    for (side, shade, open) in [(4.0, 0.0, false), (12.0, 0.0, true), (12.0, 0.45, false)] {
        let mut paper = Paper::new(420, 200, 1.0);
        paper.letter('n', 90.0, 120.0);
        paper.letter('n', 210.0, 120.0);
        let (x, y, rest) = (320.0, 80.0, (40.0 - side) / 2.0);
        paper.bar(x, y, 40.0, rest);
        paper.bar(x, y + 40.0 - rest, 40.0, rest);
        paper.bar(x, y, rest, 40.0);
        paper.bar(x + 40.0 - rest, y, rest, 40.0);
        let hole = Rect::new(x + rest, y + rest, x + rest + side, y + rest + side);
        paper.bars.push((hole, shade));
        let cut = cut_page(&paper, "n n o", &options(Layout::Grid(1, 3))).unwrap();
        let gray = &cut.cells[2].gray;
        let middle = gray.at(gray.width() / 2, gray.height() / 2);
        assert_eq!(
            middle < 0.5,
            open,
            "a hole of {side} px, {shade} dark: {middle}"
        );
    }
}

/// Three of the other letters' strokes are as wide as the ink on each side of it.
#[test]
fn a_small_eye_in_much_ink_is_no_pinhole() {
    let mut paper = grid_page(0.0);
    let (x, y, rest) = (204.0, 180.0, 18.0);
    paper.bar(x, y, 40.0, rest);
    paper.bar(x, y + 22.0, 40.0, rest);
    paper.bar(x, y, rest, 40.0);
    paper.bar(x + 22.0, y, rest, 40.0);
    let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
    let eye = cut.cells[6].to_sheet.inverse() * Point::new(x + 20.0, y + 20.0);
    let gray = &cut.cells[6].gray;
    assert!(gray.at(index(eye.x), index(eye.y)) < 0.5);
}

#[test]
fn three_dots_go_to_one_letter() {
    let large = [(220.0, 160.0), (214.0, 172.0), (226.0, 172.0)];
    let small = [(220.0, 168.0), (217.5, 173.0), (222.5, 173.0)];
    for (side, dots) in [(8.0, large), (3.5, small)] {
        let mut paper = grid_page(0.0);
        // the tail above is nearer to the topmost dot than the letter below is, and hardly nearer to all of them
        paper.bar(216.0, 120.0, 6.0, 31.0);
        for (x, y) in dots {
            paper.bar(x, y, side, side);
        }
        let names = "n p p n l n ث p i n i n l n n n p n i n";
        let cut = cut_page(&paper, names, &options(Layout::Grid(4, 5))).unwrap();
        let place = |i: usize| cut.cells[i].in_sheet;
        assert!((place(6).y0 - dots[0].1).abs() < 1.1, "{:?}", place(6));
        assert!(place(1).y1 < 155.0, "{:?}", place(1));
    }
}

#[test]
fn dots_smaller_than_dust_go_to_letters_that_have_dots() {
    for layout in [Layout::Grid(4, 5), Layout::Free] {
        let mut paper = grid_page(1.0);
        for i in 0..2 {
            paper.bar(100.0 + 360.0 * f64::from(i), 75.0, 3.0, 3.0);
        }
        paper.bar(221.0, 305.0, 5.0, 5.0);
        let names = "ṅ i p n l n n p i n i n l n n n p n i n";
        let cut = cut_page(&paper, names, &options(layout)).unwrap();
        let height = |i: usize| cut.cells[i].in_sheet.height();
        assert!(height(0) > 42.0, "the dot is the letter's: {}", height(0));
        assert!(height(3) < 36.0, "this letter has none: {}", height(3));
        assert_eq!(cut.specks, 1, "and the other one is dust");
        assert_eq!(
            cut.rejected.len(),
            1,
            "as is what lies in a letter of one piece"
        );
        assert_eq!(cut.rejected[0].reason, Reason::Dirt);
    }
}

#[test]
fn dust_beside_a_letter_with_dots_is_none_of_them() {
    let mut paper = grid_page(1.0);
    // as large as a dot may be, beside and far below letters that have dots of their own
    paper.bar(240.0, 95.0, 5.0, 5.0);
    paper.bar(98.0, 254.0, 5.0, 5.0);
    paper.bar(88.0, 176.0, 8.0, 8.0);
    paper.bar(206.0, 74.0, 8.0, 8.0);
    // and as large as the dot or smaller than dust may be, but far from it
    paper.bar(350.0, 176.0, 6.5, 6.5);
    paper.bar(296.0, 174.0, 6.5, 6.5);
    paper.bar(380.0, 176.0, 4.0, 4.0);
    for sign in ["ن", "ṅ"] {
        let names = format!("n {sign} p n l {sign} n {sign} i n i n l n n n p n i n");
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let place = |i: usize| cut.cells[i].in_sheet;
        assert!(
            place(1).x1 < 242.0 && place(1).height() > 42.0,
            "{:?}",
            place(1)
        );
        assert!(
            place(5).y1 < 230.0 && place(5).height() > 40.0,
            "{:?}",
            place(5)
        );
        assert!(
            place(7).x0 > 325.0 && place(7).x1 < 375.0 && place(7).height() > 42.0,
            "{:?}",
            place(7)
        );
    }
}

#[test]
fn dust_apart_from_a_letter_of_one_piece_is_none_of_it() {
    // larger than a stroke is wide, beside the letter and below it; what a pen's lift tears off lies closer
    for (x, y, torn) in [
        (240.0, 100.0, false),
        (209.0, 132.0, false),
        (220.0, 100.0, true),
    ] {
        let mut paper = grid_page(1.0);
        paper.bars.retain(|b| b.0.y0 > 79.0 || b.0.x0 > 300.0);
        paper.bar(x, y, 8.0, 8.0);
        let names = NAMES.replacen('i', "h", 1);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let found = cut.cells[1].in_sheet;
        let alone = found.width() < 10.0 && found.height() < 34.0;
        assert_eq!(alone, !torn, "{x}, {y}: {found:?}");
    }
}

#[test]
fn dust_where_a_letter_has_no_dots_is_none_of_them() {
    let mut paper = grid_page(1.0);
    // as large as the dot above, and below the letter, clear of it
    paper.bar(209.0, 132.0, 6.0, 6.0);
    let names = NAMES.replacen('i', "ت", 1);
    let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
    let found = cut.cells[1].in_sheet.height();
    assert!((found - 42.0).abs() < 3.0, "{found}");
}

#[test]
fn dust_in_empty_rows_does_not_move_the_grid() {
    let mut paper = grid_page(0.0);
    paper.bars.retain(|b| b.0.y1 < 260.0);
    for (x, y) in [
        (120.0, 320.0),
        (600.0, 380.0),
        (300.0, 410.0),
        (460.0, 440.0),
        (200.0, 470.0),
    ] {
        paper.bar(x, y, 5.0, 5.0);
    }
    let names = &NAMES[..NAMES.len() / 2];
    let cut = cut_page(&paper, names, &options(Layout::Grid(4, 5))).unwrap();
    assert_eq!(cut.cells.len(), 10, "{:?}", cut.warnings);
    assert!(cut.cells.iter().all(|c| c.in_sheet.height() < 60.0));
}

#[test]
fn a_letter_of_one_dot_has_no_second_one_farther_off() {
    let mut paper = grid_page(1.0);
    paper.bar(211.0, 68.0, 6.0, 5.0);
    // and a smaller one nearer by
    paper.bar(218.0, 90.0, 4.5, 4.5);
    // what the pen left of the body beside it is none
    paper.bar(220.0, 108.0, 10.0, 10.0);
    for (name, height) in [("ن", 42.0), ("ت", 52.0)] {
        let names = format!("n {name} p n l n n p i n i n l n n n p n i n");
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let found = cut.cells[1].in_sheet.height();
        assert!((found - height).abs() < 3.0, "{name}: {found}");
    }
}

#[test]
fn a_sign_above_the_grid_goes_to_the_letter_that_lacks_it() {
    let mut paper = grid_page(0.0);
    paper.bar(566.0, 40.0, 14.0, 6.0);
    for (name, height) in [("l", 45.0), ("ĺ", 80.0)] {
        let names = NAMES.replacen('l', name, 1);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let found = cut.cells[4].in_sheet.height();
        assert!((found - height).abs() < 2.0, "{name}: {found}");
    }
}

#[test]
fn dust_beside_a_hairline_is_none_of_its_letter() {
    let mut paper = Paper::new(500, 300, 1.0);
    for x in [60.0, 180.0, 300.0, 420.0] {
        // a ring of two pixels, 160 px high
        paper.bar(x, 60.0, 2.0, 160.0);
        paper.bar(x + 50.0, 60.0, 2.0, 160.0);
        paper.bar(x, 60.0, 52.0, 2.0);
        paper.bar(x, 218.0, 52.0, 2.0);
    }
    paper.bar(200.0, 225.0, 4.0, 4.0);
    let cut = cut_page(&paper, "o o o o", &options(Layout::Grid(1, 4))).unwrap();
    let bottoms: Vec<f64> = cut.cells.iter().map(|c| c.in_sheet.y1).collect();
    assert!(bottoms.iter().all(|y| *y < 225.0), "{bottoms:?}");
}

#[test]
fn printed_lines_do_not_say_how_thick_strokes_are() {
    let mut paper = Paper::new(700, 500, 1.0);
    rule(&mut paper, 1.0);
    for (x, y) in [(90.0, 120.0), (210.0, 220.0)] {
        paper.bar(x, y - 30.0, 10.0, 30.0);
        paper.bar(x + 30.0, y - 30.0, 10.0, 30.0);
        paper.bar(x, y - 30.0, 40.0, 10.0);
    }
    let page = clean(paper.scan(), Texture::default()).unwrap();
    let (_, ink) = level::pieces(&page.sheet.gray, page.noise);
    let width = stroke_width(&ink);
    assert!((8.0..13.0).contains(&width), "{width}");
}

#[test]
fn a_dot_nearer_to_the_row_before_is_that_letters_whose_name_has_it() {
    // the second letter of the first row reaches down to 4 px over the dot of the one below it, which is 12 px away
    for (under, keeps) in [("ن", true), ("د", false)] {
        let mut paper = Paper::new(600, 400, 0.0);
        for x in [60.0, 200.0, 340.0, 480.0] {
            for y in [100.0, 180.0, 260.0] {
                paper.letter('n', x, y);
            }
            paper.bar(x + 10.0, 130.0, 8.0, 8.0);
            paper.bar(x + 10.0, 210.0, 8.0, 8.0);
        }
        paper.bar(222.0, 100.0, 6.0, 26.0);
        let names = format!("د د د د ن {under} ن ن ن ن ن ن");
        let cut = cut_page(&paper, &names, &options(Layout::Grid(3, 4))).unwrap();
        let high = |i: usize| cut.cells[i].in_sheet.height().round();
        assert!(high(4) > 40.0 && high(6) > 40.0, "{under}");
        assert_eq!(high(5) > 40.0, keeps, "{under}: {}", high(5));
    }
}

#[test]
fn a_grid_of_many_cells_is_cut() {
    let mut paper = Paper::new(2_400, 2_400, 0.0);
    for i in 0..40 {
        paper.bar(
            30.0 + 60.0 * f64::from(i),
            30.0 + 60.0 * f64::from(i),
            3.0,
            4.0,
        );
    }
    let names = vec!["n"; 600 * 600].join(" ");
    let cut = cut_page(&paper, &names, &options(Layout::Grid(600, 600))).unwrap();
    // one may lie in two cells
    assert!((40..50).contains(&cut.cells.len()), "{}", cut.cells.len());
}

#[test]
fn columns_are_read_from_the_right() {
    let options = Options {
        direction: Direction::Rtl,
        order: Order::Columns,
        ..options(Layout::Grid(4, 5))
    };
    let names = "l n n n n i n i p p l n i n n p n n i n";
    let cut = cut_page(&grid_page(0.0), names, &options).unwrap();
    let middle = |i: usize| cut.cells[i].in_sheet.center();
    assert!(cut.warnings.is_empty(), "{:?}", cut.warnings);
    assert!(middle(0).x > 500.0 && middle(4).x < 500.0 && middle(19).x < 120.0);
    assert!((1..4).all(|i| middle(i).y > middle(i - 1).y + 60.0));
}

/// A shadow's strokes, too small to be told from dust by their size, beside letters that a pen draws in one piece, of
/// which the last has a dot.
#[test]
fn strokes_of_letters_in_pieces_stay() {
    let mut paper = Paper::new(800, 200, 0.0);
    for x in (0..6).map(|i| 60.0 + 120.0 * f64::from(i)) {
        paper.bar(x, 60.0, 40.0, 60.0);
        // the last of them too far off to be a torn end
        for off in [44.0, 54.0, 64.0, 74.0] {
            paper.bar(x + off, 64.0, 5.0, 44.0);
        }
    }
    // dust as large is compact, or is there once
    for x in (0..4).map(|i| 60.0 + 120.0 * f64::from(i)) {
        paper.bar(x + 12.0, 132.0, 14.0, 15.0);
    }
    paper.bar(555.0, 144.0, 7.0, 31.0);
    let cut = cut_page(&paper, "a b c d e ?", &options(Layout::Grid(1, 6))).unwrap();
    for ink in cut.cells.iter().map(|c| c.in_sheet) {
        let off = (ink.size().to_vec2() - Vec2::new(79.0, 60.0)).hypot();
        assert!(off < 3.0, "{ink:?}");
    }
}
