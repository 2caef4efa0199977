//! Labels against drawings, dots, and the way of the pen.

use crate::common::demo::{self, Demo};
use crate::common::desk::Desk;
use crate::common::dots;
use crate::common::pictures::{edge, png};
use khatt::pipeline::project::{CellTable, Labels};
use khatt::pipeline::reference::{Script, samples};
use khatt::pipeline::{World, match_letters};
use khatt::recognise::centerline;
use khatt::types::{Glyph, Gray, Outline};
use khatt::write;
use kurbo::{Affine, BezPath, ParamCurve, ParamCurveNearest, PathSeg, Point};
use std::convert::Infallible;
use std::fs;
use std::path::Path;

/// The demo font with every outline changed, as OTF.
fn recut(demo: &Demo, map: Affine) -> Vec<u8> {
    let change = |g: &Glyph| Ok::<Outline, Infallible>(g.outline.transformed(map));
    let font = demo.built.font.try_map_outlines(change).expect("outlines");
    let otf = write::format("otf").expect("a format");
    let files = (otf.write)(&font).expect("a font");
    files.0.into_values().next().expect("one file")
}

/// What is remarked on the Latin demo sheet when `spoil` has changed its labels; the reference is a narrow
/// italic cut of the font.
fn remarks(spoil: impl Fn(&mut Vec<String>)) -> Vec<String> {
    let (cells, remarks) = corrected(spoil, &[]);
    assert_eq!(cells, 89, "cells of the sheet");
    remarks
}

/// The same with corrections of letters; and how many cells there are.
fn corrected(
    spoil: impl Fn(&mut Vec<String>),
    corrections: &[(&str, CellTable)],
) -> (usize, Vec<String>) {
    let demo = demo::built("latin");
    let reference = recut(demo, Affine::new([0.85, 0.0, 0.2, 1.0, 0.0, 0.0]));
    let read = |path: &Path| match path.to_str() {
        Some("reference.otf") => Ok(reference.clone()),
        _ => fs::read(demo::folder().join(path)).map_err(|e| e.to_string()),
    };
    let mut project = demo.project.clone();
    project.matching.reference = vec!["reference.otf".into()];
    let Labels::Text(text) = &project.sheets[0].glyphs else {
        unreachable!("the demo's labels stand in the project");
    };
    let mut labels: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
    spoil(&mut labels);
    project.sheets[0].glyphs = Labels::Text(labels.join(" "));
    let owned = |(name, table): &(&str, CellTable)| ((*name).to_owned(), table.clone());
    project.cells.extend(corrections.iter().map(owned));
    let world = World::of(&read);
    let (cells, remarks) = match_letters(&project, world).expect("a page");
    let remarks = remarks.iter().map(ToString::to_string);
    (cells.len(), remarks.collect())
}

#[test]
fn letters_are_looked_at_where_corrections_say_that_they_are() {
    let demo = demo::built("latin");
    let at = |name: &str| {
        let drawn = demo.built.letters.iter().find(|l| l.label.0 == name);
        let r = drawn.expect("a letter of the demo").in_sheet;
        CellTable {
            bounds: Some([r.x0, r.y0, r.x1, r.y1]),
            ..CellTable::default()
        }
    };
    let boxes = [("b", at("b")), ("R", at("R"))];
    let found = corrected(|labels| labels.swap(17, 27), &boxes);
    assert_eq!(found, (89, vec![]));
    let ignored = CellTable {
        ignore: true,
        ..CellTable::default()
    };
    let found = corrected(|_| (), &[("R", ignored)]);
    assert_eq!(found, (88, vec![]), "nobody misses what is ignored");
}

#[test]
fn right_labels_are_not_doubted() {
    assert_eq!(remarks(|_| ()), [""; 0]);
}

#[test]
fn two_labels_swapped() {
    let found = remarks(|labels| labels.swap(17, 27));
    let want = "latin.jpg: cells 18 and 28 look as if their labels b and R were swapped";
    assert_eq!(found, [want]);
}

#[test]
fn a_row_shifted() {
    // "k l m n o p q r s" was written as "l m n o p q r s k"
    let found = remarks(|labels| labels[36..45].rotate_left(1));
    let want = [
        "latin.jpg: cell 37 (l) looks like no label near it",
        "latin.jpg: cells 38 to 45 are shifted: each looks like the label 1 before its own",
        "latin.jpg: no cell looks like label 45 (k)",
    ];
    assert_eq!(found, want);
}

#[test]
fn a_letter_forgotten() {
    // ķ was listed before k and not drawn: all after it stand one cell early
    let found = remarks(|labels| {
        labels.insert(36, "kcedilla".to_owned());
        labels.pop();
    });
    let want = [
        "latin.jpg: cells 37 to 89 are shifted: each looks like the label 1 after its own",
        "latin.jpg: no cell looks like label 37 (kcedilla)",
    ];
    assert_eq!(found, want);
}

#[test]
fn dots_tell_letters_apart_at_every_size() {
    let demo = demo::built("arabic");
    let cuts = [
        Affine::IDENTITY,
        Affine::new([1.0, 0.0, 0.2, 1.0, 0.0, 0.0]),
        Affine::new([0.75, 0.0, 0.0, 1.0, 0.0, 0.0]),
    ];
    for cut in cuts {
        let drawn = samples(&recut(demo, cut), Script::Arabic.letters()).expect("letters");
        for size in [40.0, 75.0, 150.0] {
            let told = dots::compare(&drawn, size);
            assert_eq!(told.pairs, 20, "the groups' pairs");
            assert_eq!(told.alike, [""; 0], "at {size} px an em");
            if size > 100.0 {
                assert_eq!(told.misread, [""; 0], "{cut:?} at {size} px an em");
            }
        }
    }
}

/// Three dots of 40 px an em are one blot of 12 px; up to some 120 px it is where pixels happen to lie that tells them.
#[test]
fn small_dots_are_mostly_told() {
    let demo = demo::built("arabic");
    let mut misread = Vec::new();
    for slant in [0.0, 0.2] {
        let cut = Affine::new([1.0, 0.0, slant, 1.0, 0.0, 0.0]);
        let drawn = samples(&recut(demo, cut), Script::Arabic.letters()).expect("letters");
        for size in (61..120).map(f64::from) {
            let wrong = dots::compare(&drawn, size).misread;
            misread.extend(wrong.into_iter().map(|w| format!("{w} {slant} {size}")));
        }
    }
    assert!(misread.len() <= 24, "of 118 fonts and sizes: {misread:?}");
}

/// Letters as a pen draws them, px, in a square of 200: Latin S, e, n, k and Arabic seen, ain, heh, beh's body.
const PEN: [(&str, &str); 8] = [
    (
        "S",
        "M140 50C125 25 65 25 62 65C60 105 145 90 145 135C145 180 70 180 55 150",
    ),
    (
        "e",
        "M50 105L150 105C150 60 55 45 50 105C48 160 110 180 145 145",
    ),
    ("n", "M55 60L55 160M55 100C70 55 145 45 145 105L145 160"),
    ("k", "M60 30L60 170M140 70L60 115M88 99L145 170"),
    (
        "seen",
        "M175 70C172 100 150 100 148 78C146 100 122 100 120 78C118 140 105 165 70 165C30 165 25 130 32 105",
    ),
    (
        "ain",
        "M120 50C85 30 55 60 75 85C85 97.5 110 92 125 85C70 95 45 130 60 155C75 180 115 180 145 165",
    ),
    (
        "heh",
        "M100 50C60 60 45 120 70 140C100 160 145 140 140 105C137 80 115 60 100 50",
    ),
    ("beh", "M170 80C178 120 160 130 100 132C40 133 25 120 35 80"),
];

/// Ink of a round pen along a path: coverage by the distance to the path.
fn stroked(path: &BezPath, pen: f64) -> Gray {
    let lines: Vec<PathSeg> = flat(path).segments().collect();
    Gray::from_fn(200, 200, |x, y| {
        let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let squared = lines.iter().map(|l| l.nearest(p, 1e-3).distance_sq);
        coverage(pen / 2.0 - squared.fold(f64::INFINITY, f64::min).sqrt() + 0.5)
    })
}

#[expect(clippy::cast_possible_truncation, reason = "coverage")]
const fn coverage(v: f64) -> f32 {
    v.clamp(0.0, 1.0) as f32
}

fn flat(path: &BezPath) -> BezPath {
    let mut out = BezPath::new();
    kurbo::flatten(path, 0.01, |el| out.push(el));
    out
}

/// Points along a segment.
fn along(segment: PathSeg) -> impl Iterator<Item = Point> {
    (0..=40).map(move |i| segment.eval(f64::from(i) / 40.0))
}

/// Corners, and places where the pen's ink runs into its own from elsewhere on the way.
fn junctions(path: &BezPath, pen: f64) -> Vec<Point> {
    /// Length that parts two lines.
    const ELSEWHERE: f64 = 1e6;
    let mut meet = Vec::new();
    let mut way: Vec<(Point, f64)> = Vec::new();
    let mut last: Option<PathSeg> = None;
    for segment in path.segments() {
        let mut length = way.last().map_or(0.0, |w| w.1);
        match last.filter(|l| l.end() == segment.start()) {
            Some(before) => {
                let into = before.end() - before.eval(0.95);
                let out = segment.eval(0.05) - segment.start();
                if libm::atan2(into.cross(out), into.dot(out)).abs() > 0.5 {
                    meet.push(segment.start());
                }
            }
            None => length += ELSEWHERE,
        }
        let mut before = segment.start();
        for p in along(segment) {
            length += p.distance(before);
            before = p;
            way.push((p, length));
        }
        last = Some(segment);
    }
    for (i, (p, s)) in way.iter().enumerate() {
        // a half turn as tight as the pen is wide is π/2 pens long
        let met = way[i..]
            .iter()
            .filter(|q| q.1 - s > 1.6 * pen && q.0.distance(*p) < pen);
        meet.extend(met.map(|q| q.0.midpoint(*p)));
    }
    meet
}

#[test]
fn the_centreline_is_the_way_of_the_pen() {
    for (name, d) in PEN {
        let path = BezPath::from_svg(d).expect("a path");
        let truth = flat(&path);
        for pen in [6.0, 10.0, 14.0] {
            let junctions = junctions(&path, pen);
            let drawn = centerline(&stroked(&path, pen));
            let away = |p: &Point| junctions.iter().all(|j| j.distance(*p) > 1.5 * pen);
            let off = |from: &[Point], to: &BezPath| {
                let lines: Vec<PathSeg> = to.segments().collect();
                let near = |p: &Point| {
                    let squared = lines.iter().map(|l| l.nearest(*p, 1e-4).distance_sq);
                    squared.fold(f64::INFINITY, f64::min).sqrt()
                };
                from.iter()
                    .filter(|p| away(p))
                    .map(near)
                    .fold(0.0, f64::max)
            };
            let mut found = BezPath::new();
            drawn.lines.iter().for_each(|l| found.extend(l.path.iter()));
            let points = |p: &BezPath| p.segments().flat_map(along).collect::<Vec<Point>>();
            let extra = off(&points(&found), &truth);
            let lost = off(&points(&path), &flat(&found));
            assert!(
                extra.max(lost) <= 0.03 * pen,
                "{name}, pen {pen}: {extra:.3} px beside the path, {lost:.3} px of it lost"
            );
        }
    }
}

#[test]
fn a_centreline_as_ufo_has_open_contours_widths_and_dots() {
    let path = BezPath::from_svg("M60 80C80 40 120 40 120 160").expect("a path");
    let mut ink = stroked(&path, 10.0);
    let dot = |x: usize, y: usize| (x as f64 - 60.0).hypot(y as f64 - 30.0) < 6.0;
    ink = Gray::from_fn(200, 200, |x, y| if dot(x, y) { 1.0 } else { ink.at(x, y) });
    let level = |x, y| edge(0.5 - f64::from(ink.at(x as usize, y as usize)));
    let desk = Desk::with("in.png", png(200, 200, level));
    desk.done(&["trace", "--centerline", "in.png", "-o", "i.ufo"]);
    let font = norad::Font::load(desk.path("i.ufo")).expect("a UFO");
    let glyph = font.get_glyph("i").expect("the glyph is named by the file");
    assert!(glyph.codepoints.contains('i'));
    let [line, dot] = glyph.contours.as_slice() else {
        panic!("{} contours", glyph.contours.len());
    };
    assert!(!line.is_closed() && !dot.is_closed());
    assert_eq!(dot.points.len(), 2);
    let (x, y) = (dot.points[0].x, dot.points[0].y);
    assert!(
        (x - 60.5).abs() < 0.5 && (y - 169.5).abs() < 0.5,
        "dot at {x}, {y}"
    );
    let widths = glyph
        .lib
        .get("khatt.strokeWidths")
        .and_then(|v| v.as_array());
    let widths = widths.and_then(|w| w[0].as_array()).expect("widths");
    let nodes = line
        .points
        .iter()
        .filter(|p| p.typ != norad::PointType::OffCurve);
    assert_eq!(widths.len(), nodes.count());
    let wide = |w: &plist::Value| w.as_real().is_some_and(|w| (w - 10.0).abs() < 1.0);
    assert!(widths.iter().all(wide), "{widths:?}");
}
