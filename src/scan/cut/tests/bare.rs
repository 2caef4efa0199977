//! Bare pages of Arabic letters: signs, dust, rows and names that do not agree.

use super::*;

/// How far letters stand apart, px.
const PITCH: (f64, f64) = (80.0, 110.0);

/// Draws the letter of a name with its foot at (x, y), 6 px thick: alef is 45 px high, other letters 20 or less.
fn draw(paper: &mut Paper, name: &str, x: f64, y: f64) {
    let (base, form) = name.split_once('.').unwrap_or((name, ""));
    let tooth = matches!(form, "init" | "medi");
    match base {
        "uni0627" | "uni0623" => paper.bar(x + 17.0, y - 45.0, 6.0, 45.0),
        "uni0621" => hamza(paper, x + 12.0, y - 16.0),
        "uni0645" => {
            // hangs below the line
            paper.bar(x, y - 4.0, 22.0, 12.0);
            paper.bar(x, y - 4.0, 6.0, 40.0);
        }
        _ if tooth => {
            paper.bar(x + 10.0, y - 16.0, 6.0, 16.0);
            paper.bar(x + 10.0, y - 6.0, 20.0, 6.0);
        }
        _ => {
            paper.bar(x, y - 20.0, 6.0, 20.0);
            paper.bar(x, y - 6.0, 40.0, 6.0);
            paper.bar(x + 34.0, y - 20.0, 6.0, 20.0);
        }
    }
    let top = y - if tooth { 16.0 } else { 20.0 };
    match base {
        "uni0623" => hamza(paper, x + 13.0, y - 68.0),
        "uni0626" => hamza(paper, x + 9.0, top - 24.0),
        "uni0628" => paper.bar(x + 17.0, y + 7.0, 6.0, 6.0),
        "uni0646" => paper.bar(x + 17.0, top - 6.0, 6.0, 6.0),
        "uni062B" => {
            paper.bar(x + 7.0, top - 14.0, 6.0, 6.0);
            paper.bar(x + 17.0, top - 14.0, 6.0, 6.0);
            paper.bar(x + 12.0, top - 23.0, 6.0, 6.0);
        }
        _ => {}
    }
}

/// A hamza, 16 px high.
fn hamza(paper: &mut Paper, x: f64, y: f64) {
    paper.bar(x, y, 6.0, 16.0);
    paper.bar(x, y + 10.0, 14.0, 6.0);
    paper.bar(x, y, 14.0, 6.0);
}

/// A page of rows that are read from the right and drift by so many px a letter.
fn page(rows: &[&str], skew_deg: f64, drift: f64) -> Paper {
    let mut paper = Paper::new(760, 120 + 110 * rows.len(), skew_deg);
    for (row, names) in (0u32..).zip(rows) {
        for (i, name) in (0u32..).zip(names.split(' ')) {
            let x = 660.0 - PITCH.0 * f64::from(i);
            let y = 100.0 + PITCH.1 * f64::from(row) + drift * f64::from(i);
            draw(&mut paper, name, x, y);
        }
    }
    paper
}

const ROWS: [&str; 4] = [
    "uni0627 uni0623 uni0628 uni062B uni0646 uni0621 uni0627 uni0623",
    "uni0628.init uni062B.init uni0646.init uni0626.init uni062D uni0628.medi uni0626.medi uni062B.medi",
    "uni0644 uni0627 uni0645 uni0645.fina uni0646 uni062B uni0623 uni0628",
    "uni0623 uni0646 uni0626 uni0628 uni062D uni0621 uni062B",
];

fn free() -> Options {
    Options {
        direction: Direction::Rtl,
        ..options(Layout::Free)
    }
}

/// That each cell of a page of [`ROWS`] is where its letter was drawn, and has all of its ink.
fn assert_whole(cut: &Cut, drift: f64, of: &str) {
    let row = |row: usize| 100.0 + PITCH.1 * row as f64;
    assert_drawn(
        cut,
        &ROWS,
        |r, i| (660.0 - PITCH.0 * i, row(r) + drift * i),
        of,
    );
}

/// That each cell is where its letter was drawn, with its foot `at` the row and place in it, and has all of its ink.
fn assert_drawn(cut: &Cut, rows: &[&str], at: impl Fn(usize, f64) -> (f64, f64), of: &str) {
    let places = rows.iter().enumerate().flat_map(|(r, row)| {
        let names = row.split(' ').enumerate();
        names.map(move |(i, name)| (r, i, name))
    });
    assert_eq!(cut.cells.len(), places.clone().count(), "{of}");
    for (cell, (row, i, name)) in cut.cells.iter().zip(places) {
        let mut alone = Paper::new(1, 1, 0.0);
        let (x, y) = at(row, i as f64);
        draw(&mut alone, name, x, y);
        let bars = alone.bars.iter().map(|b| b.0);
        let want = bars.reduce(|a, b| a.union(b)).unwrap();
        let got = cell.in_sheet;
        let off = [
            got.x0 - want.x0,
            got.y0 - want.y0,
            got.x1 - want.x1,
            got.y1 - want.y1,
        ];
        assert!(
            off.iter().all(|d| d.abs() < 2.5),
            "{of}: {name} of row {row}, letter {i}: {got:?} for {want:?}"
        );
    }
}

#[test]
fn signs_go_with_their_letters() {
    for drift in [-3.0, 0.0, 3.0] {
        let cut = cut_page(&page(&ROWS, 0.0, drift), &ROWS.join(" "), &free()).unwrap();
        assert_whole(&cut, drift, "clean");
        assert!(cut.rejected.is_empty(), "{:?}", cut.rejected);
    }
}

#[test]
fn a_turned_page_is_read_alike() {
    let cut = cut_page(&page(&ROWS, 2.0, 0.0), &ROWS.join(" "), &free()).unwrap();
    let names: Vec<&str> = cut.cells.iter().map(|c| c.label.0.as_str()).collect();
    assert_eq!(names.join(" "), ROWS.join(" "));
    let areas = |name: &str| {
        let cells = cut.cells.iter().filter(|c| c.label.0 == name);
        let areas = cells.map(|c| c.gray.samples().iter().sum::<f32>());
        areas.collect::<Vec<_>>()
    };
    for name in ["uni0623", "uni062B", "uni0628", "uni0646"] {
        let (all, mean) = (areas(name), areas(name).iter().sum::<f32>());
        let mean = mean / all.len() as f32;
        let alike = all.iter().all(|a| (a / mean - 1.0).abs() < 0.06);
        assert!(alike, "{name}: {all:?}");
    }
}

#[test]
fn dust_is_in_no_letter_and_takes_no_name() {
    let mut paper = page(&ROWS, 0.0, 0.0);
    // on the margins, between the rows and between the letters
    for i in 0..24u32 {
        let (x, y) = (
            40.0 + f64::from(i * 151 % 690),
            30.0 + f64::from(i * 97 % 480),
        );
        let near = |b: &(Rect, f32)| b.0.inflate(16.0, 16.0).contains(Point::new(x, y));
        if !paper.bars.iter().any(near) {
            paper.bar(x, y, 4.0, 4.0);
        }
    }
    let cut = cut_page(&paper, &ROWS.join(" "), &free()).unwrap();
    assert_whole(&cut, 0.0, "dust");
}

#[test]
fn a_torn_stroke_is_one_letter() {
    let mut paper = page(&ROWS, 0.0, 0.0);
    // the pen left a gap of 2 px in the first alef
    let alef = paper.bars.remove(0).0;
    paper.bar(alef.x0, alef.y0, 6.0, 20.0);
    paper.bar(alef.x0, alef.y0 + 22.0, 6.0, 23.0);
    let cut = cut_page(&paper, &ROWS.join(" "), &free()).unwrap();
    assert_whole(&cut, 0.0, "torn");
}

#[test]
fn a_dot_between_two_letters_is_that_ones_whose_name_has_it() {
    for (names, owner) in [("uni0646 uni062D", 0), ("uni062D uni0646", 1)] {
        let mut paper = page(&ROWS, 0.0, 0.0);
        let y = 100.0 + PITCH.1 * 4.0;
        paper.height += 110;
        for x in [400.0, 450.0] {
            draw(&mut paper, "uni062D", x, y);
        }
        // over the white between them
        paper.bar(442.0, y - 30.0, 6.0, 6.0);
        let all = format!("{} {names}", ROWS.join(" "));
        let cut = cut_page(&paper, &all, &free()).unwrap();
        let tall: Vec<bool> = cut
            .cells
            .iter()
            .map(|c| c.in_sheet.height() > 25.0)
            .collect();
        let last = &tall[tall.len() - 2..];
        assert_eq!([last[0], last[1]], [owner == 0, owner == 1], "{names}");
    }
}

#[test]
fn a_forgotten_name_is_told() {
    let paper = page(&ROWS, 0.0, 0.0);
    let mut names: Vec<&str> = ROWS.iter().flat_map(|r| r.split(' ')).collect();
    let forgotten = names.remove(12);
    assert_eq!(forgotten, "uni062D");
    let error = cut_page(&paper, &names.join(" "), &free()).unwrap_err();
    let told = error.to_string();
    for part in [
        "has 31 letters in rows of 8, 8, 8, 7, and 30 names",
        "of row 2 seems to have no name",
    ] {
        assert!(told.contains(part), "{told}");
    }
}

/// Letters that look alike may each be the one without a name, and names of letters that look alike the one without a
/// letter.
#[test]
fn all_places_where_a_name_may_be_forgotten_are_told() {
    let rows = [
        "uni0628 uni062D uni062D uni062D uni062D uni0628 uni0628 uni0628",
        "uni0628 uni0628 uni062D uni0628 uni0628 uni0628 uni0628 uni0628",
    ];
    let paper = page(&rows, 0.0, 0.0);
    let all: Vec<&str> = rows.iter().flat_map(|r| r.split(' ')).collect();
    let told = |names: &[&str]| match cut_page(&paper, &names.join(" "), &free()) {
        Err(Fault::Count { doubts, .. }) => doubts,
        other => panic!("{other:?}"),
    };
    let mut fewer = all.clone();
    fewer.remove(3);
    assert_eq!(
        told(&fewer),
        "one of letters 2 to 5 of row 1 seems to have no name"
    );
    let mut more = all.clone();
    more.insert(3, "uni062D");
    assert_eq!(
        told(&more),
        "one of those from “uni062D” (number 2) to “uni062D” (number 6) seems to have no letter"
    );
    let mut across = all;
    across.remove(7);
    assert_eq!(
        told(&across),
        "one of those from letter 6 of row 1 to letter 1 of row 2 seems to have no name"
    );
}

/// A letter below one that hangs is no part of that, which would hide the name that is missing.
#[test]
fn a_letter_under_a_tail_hides_no_forgotten_name() {
    let rows = [
        "uni062F uni0644 uni0627 uni062F uni0645 uni062F",
        "uni0644 uni062F uni062F uni0627 uni062F uni0627",
        "uni0645 uni0644 uni062F uni0627 uni0644 uni062F",
        // alone in its row
        "uni062F",
    ];
    let mut paper = Paper::new(600, 400, 0.0);
    for (row, names) in (0u32..).zip(rows) {
        for (i, name) in (0u32..).zip(names.split(' ')) {
            let x = 500.0 - PITCH.0 * f64::from(i);
            draw(&mut paper, name, x, 100.0 + 68.0 * f64::from(row));
        }
    }
    let all = rows.join(" ");
    assert_eq!(cut_page(&paper, &all, &free()).unwrap().cells.len(), 19);
    for forgotten in 0..19 {
        let mut names: Vec<&str> = all.split(' ').collect();
        names.remove(forgotten);
        let told = cut_page(&paper, &names.join(" "), &free());
        assert!(
            matches!(told, Err(Fault::Count { .. })),
            "{forgotten} of {all}"
        );
    }
}

/// Which would take minutes and gigabytes to find out by reading.
#[test]
fn far_more_names_than_ink_are_refused_before_they_are_read() {
    let names = vec!["uni062D"; 20_000].join(" ");
    let told = cut_page(&page(&ROWS, 0.0, 0.0), &names, &free());
    assert!(matches!(told, Err(Fault::FewPieces { names: 20_000, .. })));
}

#[test]
fn a_page_of_lines_alone_is_told() {
    let mut paper = Paper::new(760, 400, 0.0);
    paper.bar(60.0, 100.0, 640.0, 20.0);
    paper.bar(60.0, 250.0, 640.0, 20.0);
    let error = cut_page(&paper, "A B", &free()).unwrap_err();
    assert!(matches!(error, Fault::NoLetters(2)), "{error}");
}

/// A name whose letter was not drawn takes no other one's dot.
#[test]
fn a_name_too_many_is_told() {
    let rows = [
        "uni0627 uni0628 uni062D uni0646 uni0646 uni062D uni0627 uni0628",
        "uni0628.init uni062D uni0646.init uni0646 uni0628.medi uni0627 uni0628.medi uni062D",
        "uni062D uni0646 uni0628 uni0627 uni0628 uni062D uni0646",
    ];
    let paper = page(&rows, 0.0, 0.0);
    for at in 0..=23 {
        let mut names: Vec<&str> = rows.iter().flat_map(|r| r.split(' ')).collect();
        names.insert(at, "uni0648");
        let told = cut_page(&paper, &names.join(" "), &free());
        assert!(matches!(told, Err(Fault::Count { .. })), "before {at}");
    }
}

/// Nor one of three dots, two of which lie below it, unless lines of names say that each row has as many letters.
#[test]
fn a_name_too_many_that_takes_one_of_three_dots_is_told() {
    let rows = [
        "uni0627 uni062B uni062D uni062B uni0646 uni062B uni0627 uni0628",
        "uni062B uni062D uni062B.init uni0646 uni062B.medi uni0627 uni062B.medi uni062D",
        "uni062D uni062B uni0628 uni062B uni0628 uni062D uni062B",
    ];
    let paper = page(&rows, 0.0, 0.0);
    let cut = |names: &[&str], lines: &[usize]| {
        let lines = lines.to_vec();
        cut_page(&paper, &names.join(" "), &Options { lines, ..free() })
    };
    let all: Vec<&str> = rows.iter().flat_map(|r| r.split(' ')).collect();
    assert_eq!(cut(&all, &[]).unwrap().warnings, []);
    let mut spare = 0;
    for at in 0..=all.len() {
        let mut names = all.clone();
        names.insert(at, "uni0648");
        match cut(&names, &[]).unwrap_err() {
            Fault::Count { .. } => {}
            Fault::SpareName { among, .. } => {
                let told = among.split("number ").skip(1);
                let told = told.filter_map(|s| s.split(')').next()?.parse().ok());
                let told: Vec<usize> = told.collect();
                assert!(
                    told[0] <= at + 2 && at <= told[told.len() - 1],
                    "{among} for {}",
                    at + 1
                );
                spare += 1;
                let mut lines = [8, 8, 7];
                lines[at.min(all.len() - 1) / 8] += 1;
                let asserted = cut(&names, &lines);
                // near a row's end it may be the next one's
                let is_clear = (1..7).contains(&(at % 8));
                assert!(
                    asserted.map_or(!is_clear, |cut| !cut.warnings.is_empty()),
                    "{at}"
                );
            }
            error => panic!("{error}"),
        }
    }
    assert!(spare > 12, "{spare}");
}

#[test]
fn letters_whose_place_is_said_stand_in_the_rows_of_their_neighbours() {
    let all: Vec<&str> = ROWS.iter().flat_map(|r| r.split(' ')).collect();
    // one within a row, a row's first and last, and a whole row
    for pinned in [vec![17], vec![16, 23], (8..16).collect()] {
        let paper = page(&ROWS, 0.0, 0.0);
        let pin = |&index: &usize| {
            let mut alone = Paper::new(1, 1, 0.0);
            let (row, i) = ((index / 8) as f64, (index % 8) as f64);
            draw(
                &mut alone,
                all[index],
                660.0 - PITCH.0 * i,
                100.0 + PITCH.1 * row,
            );
            let bars = alone.bars.iter().map(|b| b.0);
            let bounds = bars.reduce(|a, b| a.union(b)).unwrap();
            Pin {
                index,
                region: Some(Region::Box(bounds.inflate(2.0, 2.0))),
                rotation_deg: 0.0,
            }
        };
        let pins: Vec<Pin> = pinned.iter().map(pin).collect();
        let page = clean(paper.scan(), Texture::default()).unwrap();
        let cut = cut(&page, &labels(&ROWS.join(" ")), &free(), &pins).unwrap();
        assert_whole(&cut, 0.0, "pinned");
        for cell in &cut.cells {
            let foot = 100.0 + PITCH.1 * (cell.index / 8) as f64;
            let at = cell.to_sheet * Point::new(0.0, cell.guides.baseline_px);
            assert!((at.y - foot).abs() < 1.5, "{pinned:?}: {at:?} for {foot}");
        }
    }
}

#[test]
fn rows_stand_on_their_line_whatever_hangs_or_has_dots_below() {
    const HANGING: &str = "uni0645 uni0645.fina uni0645 uni0645.fina uni0645 uni0646";
    const STANDING: &str = "uni0627 uni0628.init uni062F uni0645.fina uni0626.medi uni0645";
    const DOTTED: &str = "uni0628 uni0628.fina uni0628.medi uni0626.init uni0628.init uni0623";
    // a hamza of these is larger than the tooth that it stands over
    const SIGNS: &str =
        "uni0626.init uni0626.medi uni0626.init uni0626.medi uni0626.init uni0626.medi";
    let rows = [STANDING, HANGING, SIGNS, STANDING, HANGING, DOTTED];
    let even = [100.0, 210.0, 320.0, 430.0, 540.0, 650.0];
    let uneven = [100.0, 226.0, 366.0, 496.0, 578.0, 696.0];
    // letters that hang, and signs that rise from a row 94 px below: their middles are 58 px apart
    let close = [100.0, 236.0, 330.0, 470.0, 552.0, 670.0];
    for feet in [even, uneven, close] {
        let mut paper = Paper::new(600, 740, 0.0);
        for (names, foot) in rows.iter().zip(feet) {
            for (i, name) in (0u32..).zip(names.split(' ')) {
                draw(&mut paper, name, 500.0 - PITCH.0 * f64::from(i), foot);
            }
        }
        for layout in [Layout::Free, Layout::Grid(6, 6)] {
            let options = Options { layout, ..free() };
            let cut = cut_page(&paper, &rows.join(" "), &options).unwrap();
            let drawn = |r: usize, i| (500.0 - PITCH.0 * i, feet[r]);
            if layout == Layout::Free {
                assert_drawn(&cut, &rows, drawn, "rows");
            }
            assert_eq!(cut.cells.len(), 36);
            for (i, cell) in cut.cells.iter().enumerate() {
                let foot = Point::new(cell.in_sheet.x0, feet[i / 6]);
                let off = cell.guides.baseline_px - (cell.to_sheet.inverse() * foot).y;
                let row = i / 6;
                assert!(
                    off.abs() < 1.0,
                    "row {row} at {feet:?}, {layout:?}: {off} px"
                );
            }
        }
    }
}

/// The cells that are warned of with some words.
fn warned(cut: &Cut, words: &str) -> Vec<usize> {
    let about = cut.warnings.iter().filter(|w| w.message.contains(words));
    about.filter_map(|w| w.index).collect()
}

#[test]
fn letters_that_touch_are_cut_apart_and_told() {
    let rows = [
        "uni0627 uni062F uni062F uni0644 uni0627 uni062F uni0627 uni062F",
        "uni062D uni0627 uni0644 uni062D uni0627 uni062D",
        "uni0644 uni0627 uni062D uni0645.fina uni0644 uni062D uni0627 uni062D",
        "uni0627 uni062D uni062D uni0627 uni062D uni0644 uni0627",
    ];
    let mut paper = page(&rows, 0.0, 0.0);
    // a stroke from a letter's foot to that of the next one
    paper.bar(535.0, 94.0, 50.0, 6.0);
    let cut = cut_page(&paper, &rows.join(" "), &free()).unwrap();
    assert_eq!(warned(&cut, "touches a letter"), [1, 2]);
    assert_eq!(cut.cells.len(), 29);
    let middle = |i: usize| cut.cells[i].in_sheet.center();
    let [a, b] = [1, 2].map(middle);
    let apart = (a.x - b.x).abs().max((a.y - b.y).abs());
    assert!(apart > 50.0, "{a:?} {b:?}");
}

#[test]
fn letters_of_two_rows_that_touch_are_cut_apart_and_told() {
    let mut paper = page(&ROWS, 0.0, 0.0);
    // from the foot of the fifth letter of the third row to that of the one below it
    let touch = Rect::new(357.0, 318.0, 363.0, 426.0);
    paper.bars.push((touch, 1.0));
    let cut = cut_page(&paper, &ROWS.join(" "), &free()).unwrap();
    let names: Vec<&str> = cut.cells.iter().map(|c| c.label.0.as_str()).collect();
    assert_eq!(names.join(" "), ROWS.join(" "));
    let both = [20, 28];
    assert_eq!(warned(&cut, "touches a letter"), both);
    // neither is a part of the other where a name is missing
    let forgotten = ROWS.join(" ").replace("uni0621 uni0627", "uni0621");
    assert!(cut_page(&paper, &forgotten, &free()).is_err());
    for (i, cell) in cut.cells.iter().enumerate() {
        let (row, column) = if i < 28 { (i / 8, i % 8) } else { (3, i - 24) };
        let x = 660.0 - PITCH.0 * column as f64;
        let foot = 100.0 + PITCH.1 * row as f64;
        let middle = cell.in_sheet.center();
        assert!((x..x + 45.0).contains(&middle.x), "{i}: {middle:?}");
        assert!(
            (foot - 60.0..foot + 45.0).contains(&middle.y),
            "{i}: {middle:?}"
        );
    }
}

#[test]
fn a_line_of_names_that_is_no_row_is_told() {
    let rows = [ROWS[0], ROWS[1], ROWS[2], ROWS[3], ROWS[0]];
    let paper = page(&rows, 0.0, 0.0);
    let names = |lines: &[usize]| Options {
        lines: lines.to_vec(),
        ..free()
    };
    let cut = |lines: &[usize]| cut_page(&paper, &rows.join(" "), &names(lines));
    // as the rows are, and wrapped anywhere
    for lines in [&[8, 8, 8, 7, 8][..], &[16, 16, 7]] {
        assert_eq!(cut(lines).map(|c| c.cells.len()), Ok(39), "{lines:?}");
    }
    let error = cut(&[8, 7, 8, 8, 8]).map(|c| c.cells.len()).unwrap_err();
    let told = Fault::Line {
        order: Order::Rows,
        line: 2,
        names: 7,
        cells: 8,
    };
    assert_eq!(error, told);
    // a name forgotten
    let all = rows.join(" ");
    let fewer: Vec<&str> = all
        .split(' ')
        .take(12)
        .chain(all.split(' ').skip(13))
        .collect();
    let error = cut_page(&paper, &fewer.join(" "), &names(&[8, 7, 8, 7, 8])).unwrap_err();
    let told = "with them: line 2 of `glyphs` has 7 names and row 2 8 letters";
    assert!(error.to_string().contains(told), "{error}");
}

/// A page of [`ROWS`] whose longer strokes are each in two parts.
fn in_pieces() -> Paper {
    let mut paper = page(&ROWS, 0.0, 0.0);
    for (bar, shade) in std::mem::take(&mut paper.bars) {
        let (w, h) = (bar.width(), bar.height());
        let parts = if w.max(h) > 16.0 { 2.0 } else { 1.0 };
        // 3 px of paper between the parts and before them
        let long = |all: f64| if all > 16.0 { all / parts - 3.0 } else { all };
        for k in [0.0, 1.0].into_iter().take_while(|k| *k < parts) {
            let along = k * w.max(h) / parts + if parts > 1.0 { 3.0 } else { 0.0 };
            let (x, y) = if w > h { (along, 0.0) } else { (0.0, along) };
            let at = Rect::from_origin_size((bar.x0 + x, bar.y0 + y), (long(w), long(h)));
            paper.bars.push((at, shade));
        }
    }
    paper
}

#[test]
fn letters_in_pieces_lose_no_stripes() {
    let mut paper = in_pieces();
    // a rule is no stripe
    paper.bar(20.0, 150.0, 700.0, 3.0);
    assert!(cut_page(&paper, &ROWS.join(" "), &free()).is_ok());
    for row in 0..4 {
        for i in 0..7 {
            let (x, y) = (662.0 - PITCH.0 * f64::from(i), PITCH.1 * f64::from(row));
            paper.bar(x, y + 136.0, 60.0, 2.0);
        }
    }
    let error = cut_page(&paper, &ROWS.join(" "), &free()).unwrap_err();
    assert!(error.to_string().contains("grid"), "{error}");
}

#[test]
fn a_letter_drawn_in_pieces_is_one() {
    let cut = cut_page(&in_pieces(), &ROWS.join(" "), &free()).unwrap();
    let names: Vec<&str> = cut.cells.iter().map(|c| c.label.0.as_str()).collect();
    assert_eq!(names.join(" "), ROWS.join(" "));
    let alefs = cut.cells.iter().filter(|c| c.label.0 == "uni0627");
    assert!(alefs.clone().count() > 0 && alefs.clone().all(|c| c.in_sheet.height() > 38.0));
}

#[test]
fn letters_on_a_printed_lattice_are_read() {
    let mut paper = grid_page(0.0);
    for i in 0..6 {
        paper.bar(45.0 + 120.0 * f64::from(i), 50.0, 2.0, 402.0);
    }
    for i in 0..5 {
        paper.bar(45.0, 50.0 + 100.0 * f64::from(i), 602.0, 2.0);
    }
    // one that reaches over a line
    paper.bar(150.0, 92.0, 24.0, 6.0);
    paper.bar(118.0, 92.0, 40.0, 6.0);
    let cut = cut_page(&paper, NAMES, &options(Layout::Free)).unwrap();
    assert_eq!(cut.cells.len(), 20);
    let lines = cut.rejected.iter().filter(|r| r.reason == Reason::Line);
    assert_eq!(lines.count(), 1, "{:?}", cut.rejected);
    let large = cut.cells.iter().filter(|c| c.in_sheet.width() > 90.0);
    assert_eq!(large.count(), 0);
}
