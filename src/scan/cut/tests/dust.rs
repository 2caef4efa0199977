//! Dust beside letters: names and the page's other letters tell it from dots.

use super::*;
use crate::types::Colours;

#[test]
fn dust_without_end_is_told() {
    let speck = |at: usize| (4..9).contains(&(at % 14));
    let dusty = Gray::from_fn(
        1_400,
        1_000,
        |x, y| {
            if speck(x) && speck(y) { 0.8 } else { 0.05 }
        },
    );
    let sheet = Sheet {
        gray: dusty,
        ..Paper::new(10, 10, 0.0).scan()
    };
    let page = clean(sheet, Texture::default()).unwrap();
    let names = labels(&vec![NAMES; 150].join(" "));
    let told = cut(&page, &names, &options(Layout::Free), &[]).map_err(|e| e.fault);
    let told = told.map(|c| c.cells.len());
    let many = |f: &Fault| {
        matches!(
            f,
            Fault::ManyPieces {
                pieces: 7_000..,
                names: 3_000
            }
        )
    };
    assert!(told.as_ref().is_err_and(many), "{told:?}");
}

/// The box of the letter in the second cell of a page of letters with a stroke of 6, one of which is called `name`:
/// its dot lies from 58 to 64, its body from 70 to 100.
fn second(name: &str, bars: &[(f64, f64, f64, f64)]) -> Rect {
    let mut paper = grid_page(0.0);
    for &(x, y, w, h) in bars {
        paper.bar(x, y + 20.0, w, h);
    }
    let names = NAMES.replacen('i', name, 1);
    let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
    cut.cells[1].in_sheet - Vec2::new(0.0, 20.0)
}

/// Takes the second letter's dot from the page.
fn take_dot(paper: &mut Paper) {
    let is_dot = |r: &Rect| r.y0 <= 79.0 && (200.0..=225.0).contains(&r.x0);
    paper.bars.retain(|b| !is_dot(&b.0));
}

#[test]
fn dust_smaller_than_dots_is_none_where_a_letter_has_no_dots() {
    for mote in [(209.0, 112.0, 4.0, 4.0), (215.0, 65.0, 4.0, 4.0)] {
        let found = second("ن", &[mote]);
        assert!(found.height() < 44.0 && found.width() < 8.0, "{found:?}");
    }
}

#[test]
fn dots_are_as_large_as_other_letters_of_the_page_have_them() {
    // two dots that touch, and three that do not; the dust is as large as one of them
    let touching = vec![(216.0, 58.0, 6.0, 6.0)];
    let three = vec![(216.0, 58.0, 6.0, 6.0), (213.0, 48.0, 6.0, 6.0)];
    for (name, dots) in [("ت", touching), ("ث", three)] {
        let alone = second(name, &dots);
        for mote in [(228.0, 64.0, 6.0, 6.0), (209.0, 26.0, 6.0, 6.0)] {
            let found = second(name, &[dots.clone(), vec![mote]].concat());
            assert!(
                (found.area() - alone.area()).abs() < 30.0,
                "{name}: {found:?}"
            );
        }
    }
    // the nearer of two dots is the letter's, though dust is larger
    let found = second("ن", &[(207.0, 36.0, 8.0, 8.0)]);
    assert!((found.height() - 42.0).abs() < 3.0, "{found:?}");
    // two dots that stand far from each other are both its own
    let found = second("ت", &[(226.0, 58.0, 6.0, 6.0)]);
    assert!(found.x1 > 228.0, "{found:?}");
    // and so is the third of three that stands high over the others, and the smaller of two of which one is large
    let found = second("ث", &[(216.0, 58.0, 6.0, 6.0), (213.0, 42.0, 6.0, 6.0)]);
    assert!(found.y0 < 45.0, "{found:?}");
    let found = second("ت", &[(226.0, 57.0, 7.0, 7.0)]);
    assert!(found.x1 > 228.0, "{found:?}");
}

#[test]
fn letters_without_signs_have_none() {
    for name in ["ء", "uni06440627", "lam_alef-ar", "&", "ø"] {
        let mut paper = grid_page(0.0);
        paper.bar(235.0, 70.0, 8.0, 8.0);
        let names = NAMES.replacen('i', name, 1);
        take_dot(&mut paper);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let found = cut.cells[1].in_sheet;
        assert!(found.width() < 10.0, "{name}: {found:?}");
    }
}

/// Between the stems of the first n, nearer to both than it is large.
#[test]
fn dust_within_a_letter_is_told_by_dust_beside_the_others() {
    let places = [(30.0, 30.0), (660.0, 30.0), (345.0, 25.0)];
    for (count, side, kept) in [
        (0, 6.0, true),
        (3, 6.0, false),
        (2, 6.0, true),
        (3, 14.0, true),
    ] {
        let mut paper = grid_page(0.0);
        paper.bar(101.0, 106.0, 6.0, 6.0);
        for &(x, y) in &places[..count] {
            paper.bar(x, y, side, side);
        }
        let cut = cut_page(&paper, NAMES, &options(Layout::Grid(4, 5))).unwrap();
        let cell = &cut.cells[0];
        let at = Point::new(104.0, 109.0) - (cell.to_sheet * Point::ORIGIN);
        let seen = cell.gray.at(index(at.x), index(at.y)) > 0.5;
        assert_eq!(seen, kept, "{count} of {side} px: {:?}", cut.rejected);
    }
}

#[test]
fn the_sign_of_a_kaf_lies_within_it() {
    let stroke = (216.0, 94.0, 24.0, 6.0);
    for (name, mote, kept) in [
        ("ك", (222.0, 78.0, 8.0, 8.0), true),
        ("ك", (222.0, 78.0, 4.0, 4.0), true),
        ("ك.medi", (222.0, 78.0, 4.0, 4.0), false),
        ("ك", (250.0, 78.0, 8.0, 8.0), false),
        ("ك", (222.0, 56.0, 4.0, 4.0), false),
        ("ك.medi", (222.0, 112.0, 8.0, 8.0), false),
    ] {
        let mut paper = grid_page(0.0);
        take_dot(&mut paper);
        for (x, y, w, h) in [stroke, mote] {
            paper.bar(x, y + 20.0, w, h);
        }
        let names = NAMES.replacen('i', name, 1);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let cell = &cut.cells[1];
        let origin = cell.to_sheet * Point::ORIGIN;
        let at = Point::new(mote.0 + mote.2 / 2.0, mote.1 + 20.0 + mote.3 / 2.0) - origin;
        let (x, y) = (index(at.x.max(0.0)), index(at.y.max(0.0)));
        let seen = x < cell.gray.width() && y < cell.gray.height() && cell.gray.at(x, y) > 0.5;
        assert_eq!(seen, kept, "{name}: {mote:?}");
    }
}

#[test]
fn dust_thicker_than_the_strokes_is_no_piece_of_them() {
    for (side, kept) in [(6.0, true), (12.0, false)] {
        let mut paper = grid_page(0.0);
        take_dot(&mut paper);
        paper.bar(219.0, 96.0, side, side);
        let names = NAMES.replacen('i', "l", 1);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        assert_eq!(cut.cells[1].in_sheet.width() > 10.0, kept, "{side}");
    }
}

#[test]
fn a_thin_end_that_is_parted_stays_with_its_letter() {
    // less ink than dust may have, in the line of a stroke and close to it; straight and bent
    let straight = [(217.0, 97.0, 11.0, 2.0)].as_slice();
    let bent = [(217.0, 95.0, 7.0, 2.0), (222.0, 97.0, 2.0, 5.0)].as_slice();
    for bars in [straight, bent] {
        let mut paper = grid_page(0.0);
        take_dot(&mut paper);
        for &(x, y, w, h) in bars {
            paper.bar(x, y, w, h);
        }
        let names = NAMES.replacen('i', "l", 1);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let width = cut.cells[1].in_sheet.width();
        assert!(width > 12.0, "{width} {:?} {}", cut.rejected, cut.specks);
    }
}

/// The segments of a clock's figures in four rows of five cells: most have the same ones at the same places. In some
/// cells, a square of a side stands apart from all of them.
fn clock(squares: &[(usize, f64)]) -> Cut {
    let place = |i: usize| {
        let (column, row) = (i % 5, i / 5);
        (90.0 + 120.0 * column as f64, 70.0 + 100.0 * row as f64)
    };
    let mut paper = Paper::new(700, 500, 0.0);
    for (x, y) in (0..20).map(place) {
        paper.bar(x, y, 6.0, 22.0);
        paper.bar(x + 8.0, y + 14.0, 22.0, 6.0);
        paper.bar(x + 8.0, y + 21.5, 5.0, 5.0);
    }
    for &(i, side) in squares {
        let (x, y) = place(i);
        paper.bar(x + 20.0, y - side, side, side);
    }
    let names = "n h p n l n n p h n h n l n n n p n h n";
    cut_page(&paper, names, &options(Layout::Grid(4, 5))).unwrap()
}

#[test]
fn letters_drawn_in_pieces_keep_them() {
    let cut = clock(&[]);
    assert!(cut.rejected.is_empty(), "{:?}", cut.rejected);
    assert!(cut.cells.iter().all(|c| c.in_sheet.width() > 28.0));
}

#[test]
fn of_letters_in_pieces_what_is_no_smaller_than_a_piece_is_one() {
    let cut = clock(&[(7, 7.0), (12, 3.5)]);
    let heights: Vec<f64> = [7, 12, 0]
        .map(|i| cut.cells[i].in_sheet.height().round())
        .into();
    assert_eq!(heights, [34.0, 27.0, 27.0], "a piece, dust, and none");
}

#[test]
fn letters_of_dots_that_lie_apart_keep_them() {
    let place = |i: usize| (80.0 + 120.0 * (i % 5) as f64, 70.0 + 100.0 * (i / 5) as f64);
    let mut paper = Paper::new(700, 500, 0.0);
    for (x, y) in (0..20).map(place) {
        for (column, row) in [(0, 0), (0, 1), (0, 2), (1, 0), (2, 0), (2, 1), (2, 2)] {
            paper.bar(
                x + 14.0 * f64::from(column),
                y + 14.0 * f64::from(row),
                6.0,
                6.0,
            );
        }
    }
    // dust, and some as large as the dots
    paper.bar(place(7).0 + 14.0, place(7).1 + 28.0, 3.5, 3.5);
    paper.bar(place(9).0 - 36.0, place(9).1 - 28.0, 6.0, 6.0);
    let names = ["n"; 20].join(" ");
    let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
    let size = |c: &Cell| (c.in_sheet.width().round(), c.in_sheet.height().round());
    let sizes: Vec<(f64, f64)> = cut.cells.iter().map(size).collect();
    assert_eq!(sizes, [(34.0, 34.0); 20]);
    let rejected = cut.rejected.len() + cut.specks;
    assert_eq!(rejected, 2, "{:?}", cut.rejected);
}

/// Four forms of feh, each a body with a dot over it; in so many of them, a spot below.
fn with_spots(spots: usize) -> Vec<f64> {
    let mut paper = grid_page(0.0);
    let mut names: Vec<&str> = NAMES.split(' ').collect();
    let forms = ["uni0641", "uni0641.fina", "uni0641.init", "uni0641.medi"];
    let cells = (0..names.len()).filter(|&i| names[i] == "i");
    let cells: Vec<usize> = cells.collect();
    for (&i, form) in cells.iter().zip(forms) {
        names[i] = form;
    }
    for &i in &cells[..spots] {
        let (x, y) = foot(i);
        paper.bar(x, y + 4.0, 5.0, 5.0);
    }
    let cut = cut_page(&paper, &names.join(" "), &options(Layout::Grid(4, 5))).unwrap();
    let height = |&i: &usize| cut.cells[i].in_sheet.height();
    cells.iter().map(height).collect()
}

#[test]
fn what_all_forms_of_a_letter_have_is_no_dust() {
    let bare = with_spots(0);
    let taller = |spots| -> Vec<bool> {
        let pairs = with_spots(spots).into_iter().zip(&bare);
        pairs.map(|(a, b)| a > b + 4.0).collect()
    };
    assert_eq!(taller(3), [false; 4]);
    assert_eq!(taller(4), [true; 4]);
}

/// How wide khah is where a spot as large as a dot lies beside it, and one at the same place beside so many letters
/// hah of the same form.
fn with_spots_beside(others: usize) -> f64 {
    let mut paper = grid_page(0.0);
    let mut names: Vec<&str> = NAMES.split(' ').collect();
    (names[8], names[1]) = ("uni062D.medi", "uni062E.medi");
    let is_dot_of_hah = |b: &Rect| (440.0..460.0).contains(&b.x0) && (170.0..180.0).contains(&b.y0);
    paper.bars.retain(|(b, _)| !is_dot_of_hah(b));
    paper.bar(218.0, 102.0, 6.0, 6.0);
    (0..others).for_each(|_| paper.bar(458.0, 202.0, 6.0, 6.0));
    let cut = cut_page(&paper, &names.join(" "), &options(Layout::Grid(4, 5))).unwrap();
    cut.cells[1].in_sheet.width()
}

#[test]
fn what_another_letter_of_the_same_body_has_at_the_same_place_is_no_dust() {
    let widths = [0, 1].map(with_spots_beside);
    assert!(widths[0] < 8.0 && widths[1] > 12.0, "{widths:?}");
}

/// How wide the first two letters are, n and alef with hamza, where so large a spot lies so far to their left.
fn with_a_spot(side: f64, gap: f64) -> [f64; 2] {
    with_a_spot_of(side, side, gap)
}

fn with_a_spot_of(width: f64, height: f64, gap: f64) -> [f64; 2] {
    let mut paper = grid_page(0.0);
    for x in [90.0, 210.0] {
        paper.bar(x - gap - width, 105.0, width, height);
    }
    let names = NAMES.replacen("n i", "n uni0623", 1);
    let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
    [0, 1].map(|i| cut.cells[i].in_sheet.width().round())
}

#[test]
fn a_spot_that_lies_clear_of_a_letter_is_dust() {
    let bare = with_a_spot(2.0, 20.0);
    let clear = with_a_spot(5.5, 5.0);
    assert!((0..2).all(|i| clear[i] < bare[i] + 1.0), "{clear:?}");
    let parted = with_a_spot(5.5, 2.0);
    assert!(
        parted[0] > bare[0] + 6.0 && parted[1] > bare[1] + 6.0,
        "{parted:?}"
    );
    let long = with_a_spot_of(5.5, 9.5, 5.0);
    assert!(long[0] > bare[0] + 9.0, "a short stroke: {long:?}");
    let larger = with_a_spot(8.0, 5.0);
    assert!(
        larger[1] > bare[1] + 12.0,
        "larger than the sign: {larger:?}"
    );
}

/// The grid page with a ring in place of its second letter, 30 × 44 px with a stroke of 6.
fn with_a_ring() -> Paper {
    let mut paper = grid_page(0.0);
    let second = Rect::new(200.0, 60.0, 240.0, 130.0);
    paper.bars.retain(|b| !second.contains(b.0.center()));
    for (x, y, w, h) in [
        (205.0, 76.0, 30.0, 6.0),
        (205.0, 114.0, 30.0, 6.0),
        (205.0, 76.0, 6.0, 44.0),
        (229.0, 76.0, 6.0, 44.0),
    ] {
        paper.bar(x, y, w, h);
    }
    paper
}

#[test]
fn a_zero_keeps_the_dot_in_its_middle() {
    for (name, off, keeps) in [("0", 0.0, true), ("0", 9.0, false), ("O", 0.0, false)] {
        let mut paper = with_a_ring();
        paper.bar(217.5, 95.5 + off, 5.0, 5.0);
        let names = NAMES.replacen('i', name, 1);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let gray = &cut.cells[1].gray;
        let (x, y) = (gray.width() / 2, gray.height() / 2 + index(off));
        assert_eq!(gray.at(x, y) > 0.5, keeps, "{name}, {off} px off");
    }
}

#[test]
fn a_sign_lies_no_farther_off_than_its_letter_is_large() {
    for (gap, keeps) in [(12.0, true), (54.0, false)] {
        let mut paper = grid_page(0.0);
        // beside the l of the third row, whose foot is at 320
        paper.bar(336.0 + gap, 300.0, 8.0, 8.0);
        let names = labels(NAMES);
        let mut names: Vec<&str> = names.iter().map(|l| l.0.as_str()).collect();
        names[12] = "uni0623";
        let cut = cut_page(&paper, &names.join(" "), &options(Layout::Grid(4, 5))).unwrap();
        let wide = cut.cells[12].in_sheet.width() > 14.0;
        assert_eq!(wide, keeps, "{gap} px: {:?}", cut.cells[12].in_sheet);
    }
}

#[test]
fn dust_beside_a_grid_does_not_move_it() {
    // 3 rows of 23 small letters, as wide apart as they are high
    let mut paper = Paper::new(1200, 400, 0.0);
    for i in 0..69 {
        let (x, y) = (
            130.0 + 44.0 * f64::from(i % 23),
            90.0 + 90.0 * f64::from(i / 23),
        );
        paper.letter(if i % 4 == 3 { 'l' } else { 'n' }, x, y);
    }
    let names = "n n n l ".repeat(17) + "n";
    let letters = |paper: &Paper| {
        let cut = cut_page(paper, &names, &options(Layout::Grid(3, 23)))?;
        let boxes = cut.cells.iter().map(|c| c.in_sheet);
        Ok::<Vec<Rect>, Fault>(boxes.collect())
    };
    for place in 0..10 {
        let mut dusty = paper.clone();
        dusty.bar(20.0 + 9.0 * f64::from(place), 40.0, 8.0, 8.0);
        let found = letters(&dusty);
        assert_eq!(found, letters(&paper), "dust at {place}");
    }
}

/// The second letter's body lies from 210 to 216 and from 70 to 100.
#[test]
fn dots_and_marks_lie_where_names_say() {
    let hamza = (202.0, 50.0, 16.0, 6.0);
    let under = (202.0, 108.0, 16.0, 6.0);
    for (name, sign, mote, kept) in [
        // beside a letter whose dot is not drawn, and over it, though it is far to one side
        ("i", None, (228.0, 84.0, 6.0, 6.0), false),
        ("i", None, (214.0, 56.0, 6.0, 6.0), true),
        ("ب", None, (190.0, 80.0, 6.0, 6.0), false),
        // a mark may be beside its letter, where nothing else is
        ("أ", None, (228.0, 84.0, 6.0, 6.0), true),
        ("أ", Some(hamza), (228.0, 84.0, 6.0, 6.0), false),
        ("أ", Some(hamza), (206.0, 108.0, 6.0, 6.0), false),
        ("إ", Some(under), (206.0, 56.0, 6.0, 6.0), false),
        ("é", Some(hamza), (206.0, 108.0, 6.0, 6.0), false),
        // thicker than the strokes
        ("أ", Some(hamza), (226.0, 48.0, 12.0, 12.0), false),
        ("é", Some(hamza), (226.0, 48.0, 12.0, 12.0), true),
    ] {
        let mut paper = grid_page(0.0);
        take_dot(&mut paper);
        for (x, y, w, h) in sign.into_iter().chain([mote]) {
            paper.bar(x, y + 20.0, w, h);
        }
        let names = NAMES.replacen('i', name, 1);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let (x, y, w, h) = mote;
        let found = cut.cells[1].in_sheet;
        let seen = found.contains(Point::new(x + w / 2.0, y + 20.0 + h / 2.0));
        assert_eq!(seen, kept, "{name}: {mote:?}: {found:?}");
    }
}

/// Beside the second letter, nearer than a piece that is parted from its stroke.
#[test]
fn dust_close_to_a_letter_is_told_by_dust_beside_the_others() {
    let places = [(30.0, 30.0), (660.0, 30.0), (345.0, 25.0)];
    for (count, height, kept) in [
        (0, 6.0, true),
        (2, 6.0, true),
        (3, 6.0, false),
        (3, 14.0, true),
    ] {
        let mut paper = grid_page(0.0);
        take_dot(&mut paper);
        paper.bar(219.0, 96.0, 6.0, height);
        for &(x, y) in &places[..count] {
            paper.bar(x, y, 6.0, 6.0);
        }
        let names = NAMES.replacen('i', "l", 1);
        let cut = cut_page(&paper, &names, &options(Layout::Grid(4, 5))).unwrap();
        let found = cut.cells[1].in_sheet;
        assert_eq!(found.x1 > 221.0, kept, "{count}, {height}: {found:?}");
    }
}

#[test]
fn ink_with_a_hue_is_no_dust_where_it_becomes_a_layer() {
    // a dot beside the letters, over all of them, and black dust as large
    let mut paper = grid_page(0.0);
    let mut dots = Vec::new();
    for i in 0..20 {
        let (x, y) = foot(i);
        let dot = Rect::from_origin_size((x + 36.0, y - 12.0), (6.0, 6.0));
        paper.bars.push((dot, 1.0));
        dots.push(dot);
    }
    let (x, y) = foot(0);
    paper.bar(x + 10.0, y - 60.0, 6.0, 6.0);
    let mut sheet = paper.scan();
    let hued = |i: usize| {
        let p = Point::new((i % 700) as f64 + 0.5, (i / 700) as f64 + 0.5);
        dots.iter().any(|d| d.inflate(1.0, 1.0).contains(p))
    };
    let swallowed = sheet.gray.samples().iter().enumerate().map(|(i, v)| {
        let [red, black] = [[40.0, 220.0, 200.0], [240.0; 3]];
        let ink = if hued(i) { red } else { black };
        ink.map(|full| u8::try_from(index(full * f64::from(v.min(1.0)))).unwrap())
    });
    sheet.colours = Some(Colours {
        block: 1,
        columns: 700,
        swallowed: swallowed.collect(),
    });
    let page = clean(sheet, Texture::default()).unwrap();
    let asked = Options {
        ink: serde_json::from_str("[\"black\", \"red\"]").unwrap(),
        ..options(Layout::Grid(4, 5))
    };
    let cut = cut(&page, &labels(NAMES), &asked, &[]).unwrap();
    for (cell, dot) in cut.cells.iter().zip(&dots) {
        let holds = cell.in_sheet.inflate(1.0, 1.0).contains_rect(*dot);
        assert!(holds, "{:?} has lost its mark", cell.label);
    }
    let reasons: Vec<Reason> = cut.rejected.iter().map(|r| r.reason).collect();
    assert_eq!(reasons, [Reason::Dirt]);
}
