//! Printed boxes whose lines are faint or broken, and tables with labels between their cells.

use super::*;

const BOXED: &str = "n p i l n l i l n p i l";

fn is_line(bar: &Rect) -> bool {
    bar.size().max_side() > 100.0
}

#[test]
fn boxes_of_faint_lines_are_found() {
    for shade in [0.25, 0.15] {
        let mut paper = boxed(0.0);
        let lines = paper.bars.iter_mut().filter(|b| is_line(&b.0));
        lines.for_each(|b| b.1 = shade);
        let cut = cut_page(&paper, BOXED, &options(Layout::Boxes)).unwrap();
        assert_eq!(cut.cells.len(), 11, "{shade}");
        assert!(cut.cells.iter().all(|c| c.in_sheet.width() < 36.0));
    }
}

#[test]
fn a_box_that_is_open_lies_where_the_others_say() {
    let mut paper = boxed(0.0);
    // the sides of the seventh and of the last box
    let sides = |b: &(Rect, f32)| is_line(&b.0) && b.0.width() < 4.0;
    let open = |b: &(Rect, f32)| {
        let here = |x: f64, y: f64| Rect::new(x, y, x + 120.0, y + 110.0).contains(b.0.center());
        sides(b) && (here(360.0, 200.0) || here(510.0, 350.0))
    };
    paper.bars.retain(|b| !open(b));
    let cut = cut_page(&paper, BOXED, &options(Layout::Boxes)).unwrap();
    assert_eq!(cut.cells.len(), 11);
    assert!(cut.cells.iter().all(|c| c.in_sheet.height() < 72.0));
}

/// A table of three rows and four columns with a label over each cell, and a mark and a line of print above it.
fn labelled(shade: f32) -> Paper {
    let mut paper = Paper::new(700, 620, 0.0);
    paper.bar(60.0, 20.0, 36.0, 36.0);
    paper.bar(500.0, 30.0, 100.0, 12.0);
    for i in 0..=4 {
        let x = 100.0 + 120.0 * f64::from(i);
        paper.bars.push((Rect::new(x, 80.0, x + 3.0, 494.0), shade));
    }
    for i in 0..=3 {
        let y = 80.0 + 138.0 * f64::from(i);
        for y in [y, y + 30.0] {
            paper
                .bars
                .push((Rect::new(100.0, y, 583.0, y + 3.0), shade));
        }
    }
    for (i, letter) in (0u32..).zip("npi".repeat(4).chars()) {
        let (x, y) = (
            100.0 + 120.0 * f64::from(i % 4),
            80.0 + 138.0 * f64::from(i / 4),
        );
        paper.bar(x + 8.0, y + 10.0, 4.0 + 2.0 * f64::from(i % 3), 14.0);
        paper.letter(letter, x + 50.0, y + 95.0);
    }
    paper
}

#[test]
fn labels_between_the_cells_of_a_table_are_no_letters() {
    let names = ["n p i"; 4].join(" ");
    for (layout, shade) in [
        (Layout::Grid(3, 4), 1.0),
        (Layout::Grid(3, 4), 0.2),
        (Layout::Boxes, 1.0),
        (Layout::Boxes, 0.2),
    ] {
        let cut = cut_page(&labelled(shade), &names, &options(layout)).unwrap();
        assert_eq!(cut.cells.len(), 12, "{layout:?}, {shade}");
        for cell in &cut.cells {
            let size = cell.in_sheet.size();
            assert!(size.max_side() < 60.0, "{layout:?}, {shade}: {size}");
        }
    }
}

#[test]
fn boxes_that_stand_apart_are_a_grid() {
    let names = BOXED.replacen("n l i l", "_ l i l", 1);
    let cut = cut_page(&boxed(0.0), &names, &options(Layout::Grid(3, 4))).unwrap();
    assert_eq!(cut.cells.len(), 11);
    assert!(cut.cells.iter().all(|c| c.in_sheet.width() < 36.0));
}

#[test]
fn the_counters_of_letters_are_no_boxes() {
    let mut paper = Paper::new(700, 500, 0.0);
    for i in 0..12 {
        let (column, row) = (f64::from(i % 4), f64::from(i / 4));
        paper.letter('p', 90.0 + 150.0 * column, 100.0 + 150.0 * row);
    }
    let names = ["p"; 12].join(" ");
    let cut = cut_page(&paper, &names, &options(Layout::Grid(3, 4))).unwrap();
    assert_eq!(cut.cells.len(), 12);
    assert!(cut.cells.iter().all(|c| c.in_sheet.height() > 50.0));
}
