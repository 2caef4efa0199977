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
    // a small letter reaches into its neighbour's box
    paper.bar(443.0, 218.0, 9.0, 9.0);
    // dots at equal distances under two letters that stand side by side
    paper.letter('n', 500.0, 100.0);
    paper.letter('n', 532.0, 100.0);
    (0..4).for_each(|i| dot(&mut paper, 501.0 + 16.0 * f64::from(i), 106.0));
    let cut = cut_page(&paper, "a b c t y y p q r s h", &options(Layout::Free)).unwrap();
    let size = |i: usize| {
        (
            cut.cells[i].in_sheet.width().round(),
            cut.cells[i].in_sheet.height().round(),
        )
    };
    assert_eq!(size(3), (38.0, 46.0), "both dots are the letter's");
    let pairs = (size(4), size(5));
    assert_eq!(pairs, ((28.0, 44.0), (28.0, 44.0)), "two dots each");
    assert_eq!(size(10), (9.0, 9.0), "a letter of its own");
}

#[test]
fn pinholes_are_filled() {
    for (side, open) in [(4.0, false), (12.0, true)] {
        let mut paper = Paper::new(420, 200, 1.0);
        paper.letter('n', 90.0, 120.0);
        paper.letter('n', 210.0, 120.0);
        let (x, y, rest) = (320.0, 80.0, (40.0 - side) / 2.0);
        paper.bar(x, y, 40.0, rest);
        paper.bar(x, y + 40.0 - rest, 40.0, rest);
        paper.bar(x, y, rest, 40.0);
        paper.bar(x + 40.0 - rest, y, rest, 40.0);
        let cut = cut_page(&paper, "n n o", &options(Layout::Grid(1, 3))).unwrap();
        let gray = &cut.cells[2].gray;
        let middle = gray.at(gray.width() / 2, gray.height() / 2);
        assert_eq!(middle < 0.5, open, "a hole of {side} px: {middle}");
    }
}

#[test]
fn three_dots_go_to_one_letter() {
    let mut paper = grid_page(0.0);
    // the tail above is a little nearer to the dots than the letter below is, and much nearer to the topmost one
    paper.bar(216.0, 120.0, 6.0, 31.0);
    for (x, y) in [(220.0, 160.0), (214.0, 172.0), (226.0, 172.0)] {
        paper.bar(x, y, 8.0, 8.0);
    }
    let names = "n p p n l n ث p i n i n l n n n p n i n";
    let cut = cut_page(&paper, names, &options(Layout::Grid(4, 5))).unwrap();
    let dotted: Vec<f64> = cut.cells.iter().map(|c| c.in_sheet.y0).collect();
    assert!(
        (dotted[6] - 160.0).abs() < 1.0,
        "{:?}",
        cut.cells[6].in_sheet
    );
    assert!(
        cut.cells[1].in_sheet.y1 < 155.0,
        "{:?}",
        cut.cells[1].in_sheet
    );
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
