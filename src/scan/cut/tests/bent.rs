//! Pages that do not lie flat, and the lines that are printed on them.

use super::*;
use crate::scan::bent::upright;

/// The page of a grid, with its lines printed, as dark as ink or lighter.
fn printed(darkness: f32) -> Paper {
    let mut paper = grid_page(1.0);
    let line = |x: f64, y: f64, w: f64, h: f64| (Rect::new(x, y, x + w, y + h), darkness);
    let down = (0..6).map(|i| line(45.0 + 120.0 * f64::from(i), 50.0, 2.0, 402.0));
    let across = (0..5).map(|i| line(45.0, 50.0 + 100.0 * f64::from(i), 602.0, 2.0));
    paper.bars.extend(down.chain(across));
    paper
}

/// How far baselines are off where letters stand, px: the mean and the farthest.
fn off(cut: &Cut, paper: &Paper) -> (f64, f64) {
    assert_eq!(cut.cells.len(), 20);
    let off = cut.cells.iter().enumerate().map(|(i, cell)| {
        let (x, y) = foot(i);
        let at = cell.to_sheet.inverse() * paper.at(Point::new(x + 3.0, y));
        (at.y - cell.guides.baseline_px).abs()
    });
    let off: Vec<f64> = off.collect();
    let most = off.iter().copied().fold(0.0, f64::max);
    (off.iter().sum::<f64>() / 20.0, most)
}

#[test]
fn printed_lines_tell_how_a_page_is_bent() {
    for (darkness, bow) in [(1.0, [9.0, 0.0]), (1.0, [-6.0, 7.0]), (0.2, [9.0, -5.0])] {
        let mut paper = printed(darkness);
        paper.bow = bow;
        for layout in [Layout::Grid(4, 5), Layout::Free] {
            let cut = cut_page(&paper, NAMES, &options(layout)).unwrap();
            let (mean, most) = off(&cut, &paper);
            assert!(
                mean < 0.2 && most < 0.6,
                "{darkness}, {bow:?}, {layout:?}: {mean} {most}"
            );
            for (cell, i) in cut.cells.iter().zip(0..) {
                let (x, y) = foot(i);
                let seen = |dx: f64, dy: f64| {
                    cell.to_sheet.inverse() * paper.at(Point::new(x + dx, y + dy))
                };
                let lean = seen(0.0, -30.0).x - seen(0.0, 0.0).x;
                let slope = seen(28.0, 0.0).y - seen(0.0, 0.0).y;
                let aslant = lean.abs().max(slope.abs());
                assert!(aslant < 0.3, "{bow:?}, cell {i}: {lean}, {slope}");
            }
        }
    }
}

#[test]
fn lines_that_lie_straight_leave_a_page_flat() {
    for (darkness, tilt) in [(1.0, [0.0; 2]), (0.2, [0.0; 2]), (1.0, [0.06, 0.03])] {
        let mut paper = printed(darkness);
        paper.tilt = tilt;
        let page = clean(paper.scan(), Texture::default()).unwrap();
        let view = paper.view().inverse();
        assert_eq!(upright(&page, view), view.into(), "{darkness}, {tilt:?}");
    }
}

#[test]
fn lines_that_a_hand_drew_each_in_its_own_way_are_no_bend() {
    let mut paper = grid_page(0.0);
    // five rows of strokes 4 px long, which stray by up to 4 px, each row by itself
    for (i, phase) in [0.0, 2.1, 4.4, 1.0, 3.3].into_iter().enumerate() {
        for k in 0..150 {
            let x = 45.0 + 4.0 * f64::from(k);
            let y = 50.0 + 100.0 * i as f64 + 4.0 * libm::sin(x / 60.0 + phase);
            paper.bar(x, y, 4.0, 2.0);
        }
    }
    let page = clean(paper.scan(), Texture::default()).unwrap();
    let view = View::from(Affine::IDENTITY);
    assert_eq!(upright(&page, view), view.into());
}

#[test]
fn printed_boxes_tell_how_a_page_is_bent() {
    let mut paper = boxed(0.0);
    paper.bow = [-8.0, 6.0];
    let names = "n p i l _ _ i l n p i l";
    let cut = cut_page(&paper, names, &options(Layout::Boxes)).unwrap();
    assert_eq!(cut.cells.len(), 10);
    for cell in cut.cells {
        let (column, row) = (cell.index % 4, cell.index / 4);
        let foot = Point::new(105.0 + 150.0 * column as f64, 125.0 + 150.0 * row as f64);
        let seen = |dx: f64, dy: f64| cell.to_sheet.inverse() * paper.at(foot + Vec2::new(dx, dy));
        let lean = seen(0.0, -30.0).x - seen(0.0, 0.0).x;
        let slope = seen(28.0, 0.0).y - seen(0.0, 0.0).y;
        assert!(lean.abs().max(slope.abs()) < 0.3, "{lean}, {slope}");
    }
}
