//! Pages without lines whose rows slope each in its own way.

use super::*;

const ROW: &str = "nilnpinlin";

/// The foot of a letter of a row that slopes.
fn foot(slopes: &[f64], row: usize, i: usize) -> (f64, f64) {
    let x = 70.0 + 80.0 * i as f64;
    (x, 140.0 + 130.0 * row as f64 + slopes[row] * (x - 430.0))
}

/// Pages without lines of six rows of ten letters.
const LAYOUTS: [Layout; 2] = [Layout::Free, Layout::Grid(6, 10)];

/// A page of rows of such slopes, cut; its letters must stand on them.
fn cut_rows(layout: Layout, slopes: [f64; 6]) -> Cut {
    let mut paper = Paper::new(900, 900, 0.0);
    for row in 0..slopes.len() {
        for (i, c) in ROW.chars().enumerate() {
            let (x, y) = foot(&slopes, row, i);
            paper.letter(c, x, y);
        }
    }
    let names: Vec<String> = ROW.chars().map(String::from).collect();
    let names = vec![names.join(" "); slopes.len()].join(" ");
    let cut = cut_page(&paper, &names, &options(layout)).unwrap();
    assert_eq!(cut.cells.len(), slopes.len() * ROW.len());
    for (k, cell) in cut.cells.iter().enumerate() {
        let (row, i) = (k / ROW.len(), k % ROW.len());
        let at = cell.to_sheet.inverse() * Point::from(foot(&slopes, row, i));
        let off = cell.guides.baseline_px - at.y;
        assert!(
            off.abs() < 2.0,
            "{layout:?}, row {row}, letter {i}: {off} px"
        );
    }
    cut
}

/// Whether all letters of a page were seen alike.
fn from_above(cut: &Cut) -> bool {
    let first = cut.cells[0].to_sheet;
    let alike = |c: &Cell| c.to_sheet.as_coeffs()[..4] == first.as_coeffs()[..4];
    cut.cells.iter().all(alike)
}

#[test]
fn letters_stand_on_rows_that_climb_and_fall() {
    let slopes = [
        [0.05, -0.03, 0.0, 0.04, -0.05, 0.02],
        [0.06, 0.02, 0.05, 0.0, 0.03, 0.04],
    ];
    for (layout, slopes) in LAYOUTS.into_iter().flat_map(|l| slopes.map(|s| (l, s))) {
        let cut = cut_rows(layout, slopes);
        let mean = slopes.iter().sum::<f64>() / slopes.len() as f64;
        let turn = cut.skew_deg - libm::atan(mean).to_degrees();
        assert!(turn.abs() < 0.3, "{layout:?}: {turn}");
        assert!(from_above(&cut), "{layout:?}");
    }
}

#[test]
fn rows_that_climb_and_fall_can_be_seen_in_perspective() {
    for layout in LAYOUTS {
        let cut = cut_rows(layout, [-0.071, -0.051, -0.012, 0.021, 0.04, 0.073]);
        assert!(!from_above(&cut), "{layout:?}");
    }
}
