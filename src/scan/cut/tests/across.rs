//! Letters of neighbouring cells of a grid that touch.

use super::*;

fn touched(paper: &Paper, told: &[usize]) -> Cut {
    let cut = cut_page(paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
    assert_eq!(cut.cells.len(), 20);
    let warned = cut.warnings.iter();
    let warned = warned.filter(|w| w.message.starts_with("it touches a letter"));
    let warned: Vec<usize> = warned.filter_map(|w| w.index).collect();
    assert_eq!(warned, told, "{:?}", cut.warnings);
    cut
}

/// The left and the right end of a cell's ink on the upright page of [`grid_page`].
fn ends(cut: &Cut, i: usize) -> (f64, f64) {
    (cut.cells[i].in_sheet.x0, cut.cells[i].in_sheet.x1)
}

#[test]
fn letters_of_one_row_that_touch_are_cut_apart_and_told() {
    for lined in [false, true] {
        let mut paper = grid_page(0.0);
        if lined {
            rule(&mut paper, 1.0);
        }
        // the feet of the sixth and the seventh letter, and of the seventh and the eighth
        paper.bar(90.0, 214.0, 240.0, 6.0);
        let cut = touched(&paper, &[5, 6, 7]);
        let (left, middle, right) = (ends(&cut, 5), ends(&cut, 6), ends(&cut, 7));
        assert!((left.0 - 90.0).abs() < 2.0 && (right.1 - 356.0).abs() < 2.0);
        for (a, b) in [(left, middle), (middle, right)] {
            assert!((a.1 - b.0).abs() < 2.0, "{a:?} {b:?}");
        }
        assert!(
            (left.1 - 169.0).abs() < 8.0,
            "at the border of the cells: {left:?}"
        );
    }
}

#[test]
fn letters_of_one_column_that_touch_are_cut_apart_and_told() {
    let mut paper = grid_page(0.0);
    // the tail of p in the first row reaches down to the letter below it
    paper.bar(330.0, 120.0, 6.0, 75.0);
    let cut = touched(&paper, &[2, 7]);
    let (upper, lower) = (cut.cells[2].in_sheet, cut.cells[7].in_sheet);
    assert!((upper.y1 - lower.y0).abs() < 2.0, "{upper:?} {lower:?}");
    assert!(upper.y1 > 140.0 && lower.y0 < 190.0, "{upper:?} {lower:?}");
}

/// Its letter was not drawn: what reaches into its cell is its neighbour's.
#[test]
fn a_letter_that_reaches_into_an_empty_cell_is_left_whole() {
    let mut paper = grid_page(0.0);
    paper
        .bars
        .retain(|(b, _)| !(b.y0 > 150.0 && b.y0 < 230.0 && b.x0 > 200.0 && b.x0 < 250.0));
    // beyond the stretch in which borders are looked for, and not to the middle of the cell
    paper.bar(118.0, 214.0, 97.0, 6.0);
    let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
    assert_eq!(cut.cells.len(), 19);
    assert!((ends(&cut, 5).1 - 215.0).abs() < 2.0);
    let empty = cut
        .warnings
        .iter()
        .any(|w| w.index == Some(6) && w.message.contains("is empty"));
    assert!(empty, "{:?}", cut.warnings);
}

/// Their feet make a line as long as the printed ones, and twice as thick.
#[test]
fn a_row_of_letters_that_touch_is_no_printed_line() {
    let mut paper = grid_page(0.0);
    rule(&mut paper, 1.0);
    paper.bar(90.0, 211.0, 508.0, 9.0);
    let cut = touched(&paper, &[5, 6, 7, 8, 9]);
    for i in 5..10 {
        let foot = cut.cells[i].in_sheet.y1;
        assert!((foot - 220.0).abs() < 2.0 || i == 7, "{i}: {foot}");
    }
}

/// The arms of the seventh letter, of which the right one runs through a stem of the eighth: both have what they
/// share.
#[test]
fn strokes_that_cross_are_in_both_letters() {
    let mut paper = grid_page(0.0);
    paper.bar(132.0, 198.0, 184.0, 6.0);
    paper.bar(300.0, 170.0, 6.0, 50.0);
    paper.bar(306.0, 214.0, 24.0, 6.0);
    let cut = touched(&paper, &[6, 7]);
    assert!((ends(&cut, 6).1 - 316.0).abs() < 2.0, "the arm");
    assert!((ends(&cut, 7).0 - 300.0).abs() < 2.0, "the stem");
}

/// Their feet lie in line with each other and leave a slit of paler ink, far from the border of the cells.
#[test]
fn letters_that_pale_ink_alone_joins_are_cut_there() {
    let mut paper = grid_page(0.0);
    paper.bar(90.0, 214.0, 57.0, 6.0);
    paper
        .bars
        .push((Rect::new(147.0, 214.0, 148.0, 220.0), 0.42));
    paper.bar(148.0, 214.0, 90.0, 6.0);
    let cut = touched(&paper, &[5, 6]);
    let (left, right) = (ends(&cut, 5), ends(&cut, 6));
    assert!((left.1 - 147.0).abs() < 1.5, "{left:?}");
    assert!((right.0 - 148.0).abs() < 1.5, "{right:?}");
}

/// The hook at the right end of the seventh letter lies beneath a block of the eighth; another form of the same letter
/// shows it.
#[test]
fn letters_drawn_alike_show_how_hidden_edges_go_on() {
    let mut paper = grid_page(0.0);
    let is_drawn = |b: &Rect| {
        let (column, row) = ((b.x0 - 90.0) / 120.0, (b.y1 - 120.0) / 100.0);
        ![(1.0, 1.0), (2.0, 1.0), (1.0, 2.0)].contains(&(column.floor(), row.ceil()))
    };
    paper.bars.retain(|(b, _)| is_drawn(b));
    for (x, y) in [(190.0, 220.0), (175.0, 320.0)] {
        paper.bar(x, y - 30.0, 6.0, 30.0);
        paper.bar(x + 50.0, y - 30.0, 6.0, 30.0);
        paper.bar(x, y - 6.0, 84.0, 6.0);
        // the hook
        paper.bar(x + 78.0, y - 24.0, 6.0, 24.0);
    }
    paper.bar(256.0, 180.0, 24.0, 50.0);
    paper.bar(274.0, 224.0, 150.0, 6.0);
    let mut names: Vec<&str> = NAMES.split(' ').collect();
    (names[6], names[11]) = ("uni0635", "uni0635.init");
    let cut = cut_page(&paper, &names.join(" "), &options(Layout::Grid(4, 5))).unwrap();
    let [hidden, free] = [6, 11].map(|i| ends(&cut, i));
    assert!((free.1 - 259.0).abs() < 1.0, "{free:?}");
    assert!((hidden.1 - 274.0).abs() < 1.5, "{hidden:?}");
    let cell = &cut.cells[6];
    let within = cell.to_sheet.inverse() * Point::new(271.0, 200.0);
    assert!(
        cell.gray.at(index(within.x), index(within.y)) > 0.7,
        "the hook"
    );
}

#[test]
fn low_letters_close_below_high_ones_are_a_row() {
    let mut paper = Paper::new(700, 420, 0.0);
    for i in 0..6 {
        let x = 80.0 + 90.0 * f64::from(i);
        paper.letter('n', x, 130.0);
        paper.letter('p', x, 200.0);
        if i < 4 {
            // 5 px below the tails of the row above
            paper.letter('n', x + 4.0, 260.0);
        }
    }
    let names = "n n n n n n p p p p p p n n n n";
    let cut = cut_page(&paper, names, &options(Layout::Free)).unwrap();
    let feet: Vec<f64> = cut.cells.iter().map(|c| c.in_sheet.y1.round()).collect();
    let is_low = |y: &f64| (y - 260.0).abs() < 3.0;
    assert!(feet[12..].iter().all(is_low), "{feet:?}");
    assert!(!feet[..12].iter().any(is_low), "{feet:?}");
}
