//! Two hundred Arabic words, set: every join overlaps and has no step.

use crate::common::demo::{self, Demo, output};
use crate::common::read::{placed, set};
use crate::fonts::single;
use khatt::assemble::joining::Method;
use khatt::assemble::{self, Assembled, Drawn, Options};
use khatt::types::{Font, Info, Label, Outline};
use khatt::write::layout;
use kurbo::{Affine, BezPath, Line, ParamCurve, PathEl, Point, Rect, Shape};
use std::collections::BTreeSet;

/// Letters that join on both sides, and those that join only the letter before them.
const DUAL: &str = "بتثجحخسشصضطظعغفقكلمنهيئ";
const RIGHT: &str = "اأإآدذرزوؤة";
/// Unicode lets it join on both sides; Arabic writes it at the end of words alone.
const FINAL: &str = "ى";
const ALEFS: &str = "اأإآ";
const HARAKAT: &str = "\u{64b}\u{64c}\u{64d}\u{64e}\u{64f}\u{650}\u{651}\u{652}";

/// How far two strokes may differ at a join, thousandths of the em.
const STEP: f64 = 2.0;

/// A drawn form: a body, and strokes that leave it as unevenly as a hand draws them.
fn drawn(label: &str, seed: u32) -> Drawn {
    let before = label.ends_with(".fina") || label.ends_with(".medi");
    let after = label.ends_with(".init") || label.ends_with(".medi");
    let wobble =
        |factor: u32, range: u32| f64::from(seed * factor % (2 * range + 1)) - f64::from(range);
    let body = Rect::new(250.0, -60.0 + wobble(3, 40), 360.0, 420.0 + wobble(5, 90)).to_path(0.1);
    let stroke = |from: f64, to: f64, low: f64, high: f64| {
        let round = 7.0 * (to - from).signum();
        let mut path = BezPath::new();
        path.move_to((from, -5.0));
        path.line_to((to - round, low));
        path.curve_to((to, low), (to, low + 4.0), (to, low + 9.0));
        path.line_to((to, high - 9.0));
        path.curve_to((to, high - 4.0), (to, high), (to - round, high));
        path.line_to((from, 65.0));
        path.close_path();
        if path.area() > 0.0 {
            path
        } else {
            path.reverse_subpaths()
        }
    };
    let mut contours = vec![body];
    if after {
        contours.push(stroke(
            300.0,
            wobble(7, 30),
            wobble(11, 12),
            62.0 + wobble(13, 12),
        ));
    }
    if before {
        contours.push(stroke(
            300.0,
            600.0 + wobble(17, 30),
            wobble(19, 12),
            62.0 + wobble(23, 12),
        ));
    }
    Drawn {
        label: Label(label.to_owned()),
        outline: Outline::new(contours).expect("closed contours"),
        plates: Vec::new(),
        advance: None,
    }
}

fn arabic() -> Assembled {
    let hex = |c: char| format!("{:04X}", u32::from(c));
    let mut labels: Vec<String> = Vec::new();
    for c in DUAL.chars().chain(RIGHT.chars()).chain(FINAL.chars()) {
        let forms: &[&str] = if DUAL.contains(c) {
            &["", ".init", ".medi", ".fina"]
        } else {
            &["", ".fina"]
        };
        labels.extend(forms.iter().map(|f| format!("uni{}{f}", hex(c))));
    }
    for alef in ALEFS.chars() {
        labels.extend(["", ".fina"].map(|f| format!("uni0644{}{f}", hex(alef))));
    }
    labels.extend(
        HARAKAT
            .chars()
            .chain("ءـ".chars())
            .map(|c| format!("uni{}", hex(c))),
    );
    let shapes = (0..)
        .zip(&labels)
        .map(|(seed, label)| drawn(label, seed))
        .collect();
    assemble::font(shapes, Info::default(), &Options::default()).expect("a font of these letters")
}

/// Lower and upper edge of the ink at `x` around a height.
fn edges(font: &Font, name: &str, x: f64, middle: f64) -> Option<(f64, f64)> {
    let shape = font.shape(font.glyph(name)?).to_path();
    let line = Line::new((x, -2000.0), (x, 2000.0));
    let hits = |s: kurbo::PathSeg| {
        s.intersect_line(line)
            .into_iter()
            .map(move |i| s.eval(i.segment_t).y)
            .collect::<Vec<_>>()
    };
    let ys: Vec<f64> = shape.segments().flat_map(hits).collect();
    let low = ys
        .iter()
        .copied()
        .filter(|y| *y <= middle)
        .reduce(f64::max)?;
    let high = ys
        .iter()
        .copied()
        .filter(|y| *y >= middle)
        .reduce(f64::min)?;
    Some((low, high))
}

/// Checks the join between a glyph and the one to its right; both names in visual order.
fn check(font: &Font, left: &str, right: &str, middle: f64) {
    let advance = font.glyph(left).expect("a glyph").advance;
    let a = edges(font, left, advance - 0.5, middle).expect("a stroke on the right");
    let b = edges(font, right, 0.5, middle).expect("a stroke on the left");
    let step = (a.0 - b.0).abs().max((a.1 - b.1).abs());
    assert!(step <= STEP, "{left} + {right}: {a:?} {b:?}");
    let inked = |name: &str, x: f64| {
        let shape = font.shape(font.glyph(name).expect("a glyph")).to_path();
        shape.winding(Point::new(x, middle)) != 0
    };
    assert!(
        inked(left, advance + 5.0) && inked(right, -5.0),
        "{left} + {right}: no overlap"
    );
}

#[test]
fn two_hundred_words_join() {
    let built = arabic();
    assert!(built.notes.is_empty(), "{:?}", built.notes);
    let contract = built.joining.contract.expect("joins");
    let middle = 0.5 * (contract.edges.0 + contract.edges.1);
    let font = built.font;
    let otf = single(&font, "otf");
    let words: Vec<&str> = include_str!("words.txt").split_whitespace().collect();
    assert_eq!(words.len(), 200);
    let mut joins = 0;
    for word in words {
        let names = set(&otf, word);
        assert!(!names.iter().any(|n| n == ".notdef"), "{word}: {names:?}");
        for pair in names.windows(2) {
            let joins_left = pair[1].ends_with(".init") || pair[1].ends_with(".medi");
            let joins_right = pair[0].ends_with(".fina") || pair[0].ends_with(".medi");
            assert_eq!(joins_left, joins_right, "{word}: {pair:?}");
            if joins_left {
                check(&font, &pair[0], &pair[1], middle);
                joins += 1;
            }
        }
    }
    assert!(joins > 350, "the words have {joins} joins");
}

/// Pieces of ink of a shape drawn at that size that have ink at a height: letters' bodies. Dots may touch.
fn bodies(shape: &BezPath, px_per_em: f64, height: f64) -> usize {
    let line = (height - shape.bounding_box().y0) * px_per_em / 1000.0;
    let is_there = |row: usize| (row as f64 - 1.0..row as f64).contains(&line);
    let pieces = pieces(shape, px_per_em).into_iter();
    pieces
        .filter(|p| p.iter().any(|(_, row)| is_there(*row)))
        .count()
}

/// Pieces of ink of a shape drawn at that size: columns and rows of their px, from 1.
fn pieces(shape: &BezPath, px_per_em: f64) -> Vec<Vec<(usize, usize)>> {
    let shape = Affine::scale(px_per_em / 1000.0) * shape.clone();
    let (ink, mut edges) = (shape.bounding_box(), Vec::new());
    let (mut first, mut last) = (Point::ORIGIN, Point::ORIGIN);
    kurbo::flatten(&shape, 0.05, |el| match el {
        PathEl::MoveTo(to) => (first, last) = (to, to),
        _ => {
            let to = el.end_point().unwrap_or(first);
            edges.push((last, to));
            last = to;
        }
    });
    let columns = |y: f64| -> Vec<usize> {
        let cross = |&(a, b): &(Point, Point)| {
            let up = i32::from(b.y > y) - i32::from(a.y > y);
            (up != 0).then(|| (a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x) - ink.x0, up))
        };
        let mut crossings: Vec<(f64, i32)> = edges.iter().filter_map(cross).collect();
        crossings.sort_by(|a, b| a.0.total_cmp(&b.0));
        let winding = |x: f64| {
            crossings
                .iter()
                .take_while(|c| c.0 <= x)
                .map(|c| c.1)
                .sum::<i32>()
        };
        (0_u32..)
            .take_while(|x| f64::from(*x) < ink.width())
            .filter(|x| winding(f64::from(*x) + 0.5) != 0)
            .map(|x| x as usize)
            .collect()
    };
    let rows = (0_u32..).take_while(|y| f64::from(*y) < ink.height());
    let mut left: BTreeSet<(usize, usize)> = rows
        .flat_map(|y| {
            columns(ink.y0 + f64::from(y) + 0.5)
                .into_iter()
                .map(move |x| (x + 1, y as usize + 1))
        })
        .collect();
    let mut pieces = Vec::new();
    while let Some(first) = left.pop_first() {
        let (mut piece, mut at) = (vec![first], 0);
        while let Some(&(x, y)) = piece.get(at) {
            let around = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| (x, y)));
            piece.extend(around.filter(|p| left.remove(p)));
            at += 1;
        }
        pieces.push(piece);
    }
    pieces
}

/// Checks that a word has one body less for each join than its glyphs by themselves.
fn is_one_body((font, otf): (&Font, &[u8]), word: &str, px_per_em: f64, height: f64) {
    let names = set(otf, word);
    let (mut whole, mut x, mut single, mut joins) = (BezPath::new(), 0.0, 0, 0);
    for name in &names {
        let glyph = font.glyph(name).expect("a glyph");
        let shape = font.shape(glyph).to_path();
        single += bodies(&shape, px_per_em, height);
        joins += usize::from(name.ends_with(".fina") || name.ends_with(".medi"));
        whole.extend(Affine::translate((x, 0.0)) * shape);
        x += glyph.advance;
    }
    let found = bodies(&whole, px_per_em, height);
    assert_eq!(found, single - joins, "{word} at {px_per_em} px: {names:?}");
}

#[test]
fn joined_letters_are_one_body() {
    let words: Vec<&str> = include_str!("words.txt").split_whitespace().collect();
    for name in ["arabic", "rasm"] {
        let Demo { built, outputs, .. } = demo::built(name);
        for word in &words {
            is_one_body((&built.font, output(outputs, "otf")), word, 96.0, 45.0);
        }
    }
}

#[test]
fn cursive_strokes_meet_where_they_were_drawn() {
    // strokes that leave 150 units above where they come in, as in a slanted style
    let labels = ["", ".init", ".medi", ".fina"].map(|form| format!("uni0628{form}"));
    let raised = |mut drawn: Drawn| {
        let rises = |p: &PathEl| {
            let up = |p: Point| Point::new(p.x, p.y + 0.25 * (300.0 - p.x).max(0.0));
            match *p {
                PathEl::MoveTo(p) => PathEl::MoveTo(up(p)),
                PathEl::LineTo(p) => PathEl::LineTo(up(p)),
                PathEl::CurveTo(a, b, p) => PathEl::CurveTo(up(a), up(b), up(p)),
                other => other,
            }
        };
        let contours = drawn.outline.contours().iter();
        let contours = contours.map(|c| c.elements().iter().map(rises).collect());
        drawn.outline = Outline::new(contours.collect()).expect("closed contours");
        drawn
    };
    let shapes: Vec<Drawn> = (0..)
        .zip(&labels)
        .map(|(seed, label)| raised(drawn(label, seed)))
        .collect();
    let mut options = Options::default();
    options.joining.method = Method::Cursive;
    let built = assemble::font(shapes, Info::default(), &options).expect("a font");
    assert!(built.notes.is_empty(), "{:?}", built.notes);
    assert!(
        built.joining.joins.iter().all(|j| j.moved == (0.0, 0.0)),
        "strokes stay"
    );
    let font = built.font;
    let (mut x, mut exits, mut entries) = (0.0, Vec::new(), Vec::new());
    let mut heights = Vec::new();
    for (id, advance, dx, dy) in placed(&single(&font, "otf"), "ببببب") {
        let at = |name: &str| {
            let anchor = font.glyphs()[id].anchors.iter().find(|a| a.name == name)?;
            Some(anchor.at + kurbo::Vec2::new(x + f64::from(dx), f64::from(dy)))
        };
        entries.extend(at("entry"));
        exits.extend(at("exit"));
        heights.push(dy);
        x += f64::from(advance);
    }
    assert_eq!((entries.len(), exits.len()), (4, 4));
    for (entry, exit) in entries.iter().zip(&exits) {
        assert!(entry.distance(*exit) < 1e-9, "{entries:?} {exits:?}");
    }
    assert_eq!(heights[0], 0, "the last letter stands on the line");
    assert!(heights[4] < -150, "the first far from it: {heights:?}");
}

#[test]
fn letters_that_do_not_join_are_kerned_from_the_right() {
    let Demo { built, outputs, .. } = demo::built("arabic");
    let font = &built.font;
    let otf = output(outputs, "otf");
    let mut kerned = 0;
    for word in ["وح", "رد", "رس", "دا", "وع", "اك", "رر"] {
        let [left, right] = placed(otf, word)[..] else {
            panic!("two letters");
        };
        let (a, b) = (&font.glyphs()[left.0], &font.glyphs()[right.0]);
        let pull = f64::from(right.1) - b.advance;
        // the right one moves left by what its advance loses
        assert!(
            (f64::from(right.2) - pull).abs() < 1e-9 && left.2 == 0,
            "{word}"
        );
        assert!(pull <= 0.0, "{word}: {pull}");
        kerned += usize::from(pull < 0.0);
        let both = Affine::translate((a.advance + pull, 0.0)) * font.shape(b).to_path();
        let mut all = font.shape(a).to_path();
        let count = |shape: &BezPath| pieces(shape, 96.0).len();
        let single = count(&all) + count(&both);
        all.extend(both);
        assert_eq!(count(&all), single, "{word}: they touch");
    }
    assert!(kerned >= 2, "{kerned} pairs are kerned");
    assert!(
        !font.kerning.first.is_empty() || !font.kerning.second.is_empty(),
        "groups"
    );
}

#[test]
fn every_letter_in_every_context() {
    let font = arabic().font;
    let otf = single(&font, "otf");
    for c in DUAL.chars() {
        let name = format!("uni{:04X}", u32::from(c));
        let names = set(&otf, &format!("{c}{c}{c} {c}"));
        let forms: Vec<String> = names.iter().map(|n| n.replace(&name, "")).collect();
        assert_eq!(forms, ["", "space", ".fina", ".medi", ".init"], "{c}");
    }
    for c in RIGHT.chars() {
        let name = format!("uni{:04X}", u32::from(c));
        assert_eq!(
            set(&otf, &format!("{c}ب{c}")),
            [format!("{name}.fina"), "uni0628.init".to_owned(), name]
        );
    }
    for alef in ALEFS.chars() {
        let name = format!("uni0644{:04X}", u32::from(alef));
        // with a vowel sign between the two as well
        for text in [format!("ل{alef}"), format!("ل\u{64e}{alef}")] {
            assert!(set(&otf, &text).contains(&name), "{text}");
        }
        let joined = set(&otf, &format!("بل{alef}"));
        assert!(joined.contains(&format!("{name}.fina")), "{joined:?}");
    }
}

#[test]
fn marks_attach_and_take_no_room() {
    let font = arabic().font;
    let text = layout::text(&font);
    for wanted in [
        "feature mark",
        "feature mkmk",
        "ligComponent",
        "GlyphClassDef",
        "@mark.bottom",
    ] {
        assert!(text.contains(wanted), "{wanted}");
    }
    for c in HARAKAT.chars() {
        let glyph = font
            .glyphs()
            .iter()
            .find(|g| g.codepoints == [c])
            .expect("a mark");
        assert!(glyph.advance.abs() < 1e-9, "{}", glyph.name);
        assert!(
            glyph.anchors.iter().any(|a| a.name.starts_with('_')),
            "{}",
            glyph.name
        );
    }
}
