mod across;
mod bare;
mod bent;
mod boxes;
mod dust;
mod lid;
mod listed;
mod paper;
mod signs;
mod slopes;
mod small;
mod told;
mod turned;

use super::super::clean::{Texture, clean, clean_otherwise};
use super::super::options::{Layout, Order, Scale};
use super::*;
use crate::numeric::cast::index;
use crate::numeric::view::View;
use crate::types::{Direction, Gray, Sheet};
use kurbo::Vec2;
use paper::Paper;

fn labels(text: &str) -> Vec<Label> {
    text.split_whitespace()
        .map(|s| Label(s.to_owned()))
        .collect()
}

fn options(layout: Layout) -> Options {
    Options {
        layout,
        scale: Some(Scale::PixelsPerEm(60.0)),
        ..Options::default()
    }
}

fn cut_page(paper: &Paper, names: &str, options: &Options) -> Result<Cut, Fault> {
    let page = clean(paper.scan(), Texture::default()).map_err(|e| e.fault)?;
    cut(&page, &labels(names), options, &[]).map_err(|e| e.fault)
}

/// Where a letter of [`grid_page`] stands.
fn foot(i: usize) -> (f64, f64) {
    (
        90.0 + 120.0 * (i % 5) as f64,
        120.0 + 100.0 * (i / 5) as f64,
    )
}

/// Four by five cells of 120 × 100 px; the feet stand 70 px below the cells' tops.
fn grid_page(skew_deg: f64) -> Paper {
    let mut paper = Paper::new(700, 500, skew_deg);
    for (i, c) in "nipnlnnpininlnnnpnin".chars().enumerate() {
        let (x, y) = foot(i);
        paper.letter(c, x, y);
    }
    paper
}

const NAMES: &str = "n i p n l n n p i n i n l n n n p n i n";

#[test]
fn a_grid_is_cut_into_its_letters() {
    for skew in [0.0, 2.5, -6.0] {
        let paper = grid_page(skew);
        let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
        assert_eq!(cut.cells.len(), 20);
        assert!(
            cut.rejected.is_empty() && cut.warnings.is_empty(),
            "{:?}",
            cut.warnings
        );
        assert!(
            (cut.skew_deg - skew).abs() < 0.1,
            "{} for {skew}",
            cut.skew_deg
        );
        for (i, cell) in cut.cells.iter().enumerate() {
            let (x, y) = foot(i);
            let foot = paper.view().at(Point::new(x + 3.0, y));
            let at = cell.to_sheet.inverse() * foot;
            assert_eq!(cell.index, i);
            assert!(
                (at.y - cell.guides.baseline_px).abs() < 0.25,
                "cell {i} at {skew}°: {at:?} {:?}",
                cell.guides
            );
            assert!(
                cell.gray.at(index(at.x), index(at.y) - 6) > 0.7,
                "the stem stands there"
            );
            let ink: f32 = cell.gray.samples().iter().filter(|v| **v > 0.3).sum();
            let want = match cell.label.0.as_str() {
                "i" => 216.0,
                "l" => 270.0,
                "p" => 678.0,
                _ => 456.0,
            };
            assert!(
                (ink / want - 1.0).abs() < 0.06,
                "{}: {ink} px of ink for {want}",
                cell.label.0
            );
        }
    }
}

#[test]
fn reading_order_runs_from_either_side_and_down_columns() {
    let paper = grid_page(0.0);
    let rtl = Options {
        direction: Direction::Rtl,
        ..options(Layout::Grid(4, 5))
    };
    let cut = cut_page(&paper, "l n p i n  n i p n n  n n l n i  n i n p _", &rtl).unwrap();
    assert_eq!(cut.cells.len(), 19);
    assert!(
        cut.cells[0].in_sheet.x0 > 500.0,
        "the first letter stands on the right"
    );
    assert_eq!(cut.rejected.len(), 1, "the skipped letter is listed");
    assert_eq!(cut.rejected[0].reason, Reason::Skipped);
    let columns = Options {
        order: Order::Columns,
        ..options(Layout::Grid(4, 5))
    };
    let cut = cut_page(&paper, "n n i n i n n p p p l n n i n i l n n n", &columns).unwrap();
    assert!(cut.cells[1].in_sheet.y0 > cut.cells[0].in_sheet.y1);
    assert!(cut.cells[4].in_sheet.x0 > cut.cells[0].in_sheet.x1);
}

/// The lines between and around the cells of [`grid_page`], 3 px thick.
fn rule(paper: &mut Paper, shade: f32) {
    for i in 0..=5 {
        let at = 48.0 + 120.0 * f64::from(i);
        paper
            .bars
            .push((Rect::new(at, 48.0, at + 3.0, 451.0), shade));
    }
    for i in 0..=4 {
        let at = 48.0 + 100.0 * f64::from(i);
        paper
            .bars
            .push((Rect::new(48.0, at, 651.0, at + 3.0), shade));
    }
}

#[test]
fn printed_lines_are_no_ink() {
    for shade in [0.25, 1.0] {
        let mut paper = grid_page(1.0);
        rule(&mut paper, shade);
        let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
        assert_eq!(cut.cells.len(), 20);
        assert!(
            cut.rejected.iter().all(|r| r.reason == Reason::Line),
            "{:?}",
            cut.rejected
        );
        let widest = cut
            .cells
            .iter()
            .map(|c| c.in_sheet.width())
            .fold(0.0, f64::max);
        assert!(widest < 34.0, "letters only");
    }
}

#[test]
fn faint_printed_lines_beside_a_letter_are_no_ink_of_its() {
    let mut paper = grid_page(0.0);
    // one runs by below the first row's feet, one through the second row's letters
    for at in [125.0, 205.0] {
        let line = Rect::new(48.0, at, 651.0, at + 3.0);
        paper.bars.push((line, 0.25));
    }
    let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
    for i in [0, 5] {
        let cell = &cut.cells[i];
        let (w, h) = (cell.gray.width(), cell.gray.height());
        let ink = |x: usize, y: usize| cell.gray.at(x, y);
        // the margin is 12 px wide
        let faint = |x: usize, y: usize| ink(x, y) > 0.15;
        assert!(!(0..w).any(|x| faint(x, h - 7)), "{i}: below");
        assert!(!(0..h).any(|y| faint(7, y)), "{i}: beside");
    }
}

#[test]
fn capitals_that_hang_stand_on_the_line_of_the_small_letters() {
    let mut paper = Paper::new(620, 760, 0.0);
    let rows = ["HETM", "NKLX", "IDFA", "nhmi", "rkxz", "nmhk"];
    for (r, row) in rows.iter().enumerate() {
        let hang = if r < 3 { 10.0 } else { 0.0 };
        for i in 0..row.len() {
            let x = 90.0 + 140.0 * i as f64;
            paper.letter('n', x, 100.0 + 110.0 * r as f64 + hang);
        }
    }
    let names: Vec<String> = rows.concat().chars().map(String::from).collect();
    let layout = options(Layout::Grid(6, 4));
    let cut = cut_page(&paper, &names.join(" "), &layout).unwrap();
    for (i, cell) in cut.cells.iter().enumerate() {
        // the letters end 12 px above the lower border of their pictures
        let foot = (cell.gray.height() - 12) as f64;
        let hang = if i < 12 { 10.0 } else { 0.0 };
        let below = foot - cell.guides.baseline_px;
        assert!((below - hang).abs() < 1.5, "cell {i}: {below}");
    }
}

#[test]
fn the_end_of_a_stroke_that_fades_out_is_its_own() {
    let mut paper = grid_page(0.0);
    paper.bars.push((Rect::new(90.0, 120.0, 96.0, 130.0), 0.25));
    let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
    let gray = &cut.cells[0].gray;
    let below = gray.height() - 12 + 5;
    assert!((0..gray.width()).any(|x| gray.at(x, below) > 0.15));
}

#[test]
fn letters_that_touch_printed_lines_are_cut_free() {
    let mut paper = grid_page(1.0);
    rule(&mut paper, 1.0);
    // one hangs across the line below, one reaches up to the line above
    paper.bar(330.0, 240.0, 6.0, 24.0);
    paper.bar(90.0, 50.0, 6.0, 44.0);
    let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
    let touched = [(7, 190.0, 264.0), (0, 52.0, 120.0)];
    for (i, top, bottom) in touched {
        let height = cut.cells[i].in_sheet.height();
        assert!((height - (bottom - top)).abs() < 3.0, "{i}: {height}");
    }
    let told = cut.warnings.iter().map(|w| w.index);
    assert_eq!(told.collect::<Vec<_>>(), [Some(0), Some(7)]);
    assert!(
        cut.rejected.iter().all(|r| r.reason == Reason::Line),
        "{:?}",
        cut.rejected
    );
}

#[test]
fn letters_of_a_bare_page_keep_their_dots_and_rows() {
    let mut paper = Paper::new(640, 420, 1.5);
    for (row, letters) in ["ninpl", "npin", "lninn"].iter().enumerate() {
        for (i, c) in letters.chars().enumerate() {
            // rows drift down to the right, and a descender reaches into the next one
            paper.letter(
                c,
                60.0 + 95.0 * i as f64,
                90.0 + 80.0 * row as f64 + 4.0 * i as f64,
            );
        }
    }
    paper.bar(40.0, 400.0, 480.0, 2.0);
    let names = "n i n p l n p i n l n i n n";
    let cut = cut_page(&paper, names, &options(Layout::Free)).unwrap();
    assert_eq!(cut.cells.len(), 14);
    for cell in &cut.cells {
        let tall = cell.in_sheet.height();
        let want = match cell.label.0.as_str() {
            "i" => 42.0,
            "l" => 45.0,
            "p" => 55.0,
            _ => 30.0,
        };
        assert!(
            (tall - want).abs() < 4.0,
            "{} {}: {tall}",
            cell.index,
            cell.label.0
        );
    }
    assert!(
        cut.rejected.iter().all(|r| r.reason == Reason::Line),
        "{:?}",
        cut.rejected
    );
    let wrong = cut_page(&paper, &names[2..], &options(Layout::Free)).unwrap_err();
    let told = wrong.to_string();
    let counts = "has 14 letters in rows of 5, 4, 5, and 13 names";
    assert!(told.contains(counts), "{told}");
}

/// Columns of a picture in which more than so many pixels are inked.
fn tall_columns(gray: &Gray, least: usize) -> usize {
    let inked = |x: &usize| (0..gray.height()).filter(|&y| gray.at(*x, y) > 0.5).count();
    (0..gray.width()).filter(|x| inked(x) > least).count()
}

#[test]
fn a_grid_seen_in_perspective_comes_out_straight() {
    for (skew, tilt) in [
        (0.0, [0.07, 0.0]),
        (2.0, [-0.05, 0.06]),
        (-3.0, [0.0, -0.07]),
    ] {
        let mut paper = grid_page(skew);
        paper.tilt = tilt;
        let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
        assert_eq!(cut.cells.len(), 20, "{tilt:?}");
        assert!(cut.rejected.is_empty(), "{:?}", cut.rejected);
        let area = |c: &Cell| c.gray.samples().iter().sum::<f32>();
        let of = |name: &str| {
            cut.cells
                .iter()
                .filter(|c| c.label.0 == name)
                .map(area)
                .collect::<Vec<_>>()
        };
        let (all, mean) = (of("n"), of("n").iter().sum::<f32>() / 11.0);
        assert_eq!(all.len(), 11);
        assert!(
            all.iter().all(|a| (a / mean - 1.0).abs() < 0.05),
            "{tilt:?}: {all:?}"
        );
        assert_on_baselines(&cut, &paper);
    }
}

/// That all cells of a page of [`grid_page`]'s letters have their baselines where these stand.
fn assert_on_baselines(cut: &Cut, paper: &Paper) {
    for (i, cell) in cut.cells.iter().enumerate() {
        let (x, y) = foot(i);
        let at = cell.to_sheet.inverse() * paper.view().at(Point::new(x + 3.0, y));
        let off = (at.y - cell.guides.baseline_px).abs();
        assert!(
            off < 1.5,
            "{:?}, cell {i}: {off} px off the baseline",
            paper.tilt
        );
    }
}

#[test]
fn a_letter_far_smaller_than_the_others_is_warned_of() {
    let mut paper = grid_page(0.0);
    // the third letter is a blot, and so small is the full stop that is the last one
    paper.bars.retain(|b| {
        let place = b.0.center();
        let third = (310.0..410.0).contains(&place.x) && place.y < 150.0;
        let last = place.x > 550.0 && place.y > 370.0;
        !(third || last)
    });
    paper.bar(340.0, 112.0, 8.0, 8.0);
    paper.bar(580.0, 412.0, 8.0, 8.0);
    let names = NAMES.replacen("n i p", "n i z", 1);
    let names = format!("{}.", &names[..names.len() - 1]);
    let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
    let warned: Vec<_> = cut
        .warnings
        .iter()
        .map(|w| (w.index, w.message.as_str()))
        .collect();
    assert_eq!(warned, [(Some(2), SMALL_LETTER)]);
}

#[test]
fn a_flat_page_is_left_as_it_is() {
    for layout in [Layout::Grid(4, 5), Layout::Free] {
        let cut = cut_page(&grid_page(1.0), NAMES, &options(layout)).unwrap();
        let map = cut.upright.as_coeffs();
        assert!((cut.upright.determinant() - 1.0).abs() < 1e-9 && (map[0] - map[3]).abs() < 1e-9);
    }
}

#[test]
fn rows_of_a_bare_page_in_perspective_come_out_level() {
    let mut paper = grid_page(1.0);
    paper.tilt = [0.08, 0.0];
    let cut = cut_page(&paper, NAMES, &options(Layout::Free)).unwrap();
    assert_on_baselines(&cut, &paper);
}

#[test]
fn corner_pins_straighten_a_letter() {
    let mut paper = grid_page(0.0);
    paper.tilt = [0.0, 0.3];
    // the first letter of the second row, an n of 28 × 30 px
    let corners = [(80.0, 184.0), (128.0, 184.0), (128.0, 226.0), (80.0, 226.0)];
    let quad = corners.map(|p| paper.view().at(p.into()));
    let pin = |region| Pin {
        index: 5,
        region: Some(region),
        rotation_deg: 0.0,
    };
    let page = clean(paper.scan(), Texture::default()).unwrap();
    let cut = |pin: Pin| cut(&page, &labels(NAMES), &options(Layout::Free), &[pin]).unwrap();
    let columns = |region: Region| tall_columns(&cut(pin(region)).cells[5].gray, 24);
    let straight = columns(Region::Quad(quad));
    assert!(
        (11..=15).contains(&straight),
        "two stems of 6 px stand upright: {straight}"
    );
    assert!(
        columns(Region::Polygon(quad.to_vec())) < straight,
        "seen as they lie, they lean"
    );
}

#[test]
fn what_every_cell_has_at_the_same_place_is_printed() {
    // marks of the letters' own ink: a bar in a corner of each cell and a cross where cells meet
    let mut paper = grid_page(1.0);
    for i in 0..20 {
        let (x, y) = (
            60.0 + 120.0 * f64::from(i % 5),
            50.0 + 100.0 * f64::from(i / 5),
        );
        paper.bar(x + 4.0, y + 10.0, 5.0 + f64::from(i % 3), 12.0);
        paper.bar(x - 6.0, y - 2.0, 12.0, 4.0);
    }
    let single = "n h p n l n n p h n h n l n n n p n h n";
    let cut = cut_page(&paper, single, &options(Layout::Grid(4, 5))).unwrap();
    assert_eq!(cut.cells.len(), 20);
    for cell in &cut.cells {
        assert!(
            cell.in_sheet.width() < 34.0,
            "{}: {:?}",
            cell.label.0,
            cell.in_sheet
        );
    }
    let printed = cut
        .rejected
        .iter()
        .filter(|r| r.reason == Reason::Furniture);
    assert_eq!(printed.count(), 40, "{:?}", cut.rejected);

    // accents that every letter has are theirs
    let mut paper = grid_page(0.0);
    for i in 0..20 {
        let (x, y) = (
            94.0 + 120.0 * f64::from(i % 5),
            60.0 + 100.0 * f64::from(i / 5),
        );
        paper.bar(x, y, 20.0, 6.0);
    }
    let accented = ["ā"; 20].join(" ");
    let cut = cut_page(&paper, &accented, &options(Layout::Grid(4, 5))).unwrap();
    assert!(cut.rejected.is_empty(), "{:?}", cut.rejected);
}

/// Three rows of four printed boxes, n p i l in each, and a label under each; the fifth is empty, and the sixth holds
/// a letter that touches it.
fn boxed(skew: f64) -> Paper {
    let mut paper = Paper::new(700, 520, skew);
    for i in 0..12 {
        let (x, y) = (
            60.0 + 150.0 * f64::from(i % 4),
            50.0 + 150.0 * f64::from(i / 4),
        );
        for (dx, dy, w, h) in [
            (0.0, 0.0, 120.0, 3.0),
            (0.0, 107.0, 120.0, 3.0),
            (0.0, 0.0, 3.0, 110.0),
            (117.0, 0.0, 3.0, 110.0),
        ] {
            paper.bar(x + dx, y + dy, w, h);
        }
        paper.letter('n', x + 55.0, y + 146.0); // a printed label under the box
        match i {
            4 => {}
            5 => paper.bar(x + 40.0, y, 6.0, 70.0), // a letter that touches its box
            _ => paper.letter(
                ['n', 'p', 'i', 'l'][usize::try_from(i % 4).unwrap_or(0)],
                x + 45.0,
                y + 75.0,
            ),
        }
    }
    paper
}

#[test]
fn printed_boxes_hold_one_letter_each() {
    for skew in [0.0, -2.0] {
        let paper = boxed(skew);
        let cut = cut_page(&paper, "n p i l n l i l n p i l", &options(Layout::Boxes)).unwrap();
        assert_eq!(cut.cells.len(), 11, "at {skew}°");
        let warned: Vec<_> = cut.warnings.iter().map(|w| w.index).collect();
        assert_eq!(warned, [Some(4), Some(5)], "the empty and the touched box");
        assert!(
            cut.cells.iter().all(|c| c.in_sheet.width() < 36.0),
            "letters only"
        );
        let outside = cut
            .rejected
            .iter()
            .filter(|r| r.reason == Reason::Outside)
            .count();
        assert_eq!(outside, 12, "labels are listed: {:?}", cut.rejected);
        let many =
            cut_page(&paper, "n p i l n l i l n p i l n", &options(Layout::Boxes)).unwrap_err();
        assert!(
            matches!(many, Fault::TooManyNames { cells: 12, .. }),
            "{many}"
        );
    }
}

#[test]
fn a_page_without_boxes_is_told_from_one_with_too_many_names() {
    let mut open = Paper::new(700, 500, 0.0);
    for i in 0..5 {
        open.letter('n', 90.0 + 120.0 * f64::from(i), 120.0);
    }
    // the counters of the other page's three p are paper that ink encloses
    for (paper, places) in [(open, 0), (grid_page(0.0), 3)] {
        let why = cut_page(&paper, NAMES, &options(Layout::Boxes)).unwrap_err();
        assert!(
            matches!(why, Fault::NoBoxes { found, names: 20, .. } if found == places),
            "{why}"
        );
    }
}
