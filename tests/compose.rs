//! The page of skeletons and dots: composed letters set text, their dots clear of their bodies.

use crate::common::approved;
use crate::common::demo::{self, Demo, output};
use crate::common::read::set;
use khatt::numeric::distance::Polyline;
use khatt::types::{Component, Font, Glyph};
use kurbo::{Point, flatten};
use std::fmt::Write;

/// White between dots and body that `[compose]` asks for where it says nothing, em.
const GAP: f64 = 0.05;

#[test]
fn the_skeletons_become_letters() {
    let Demo { built, outputs, .. } = demo::built("rasm");
    assert_eq!(built.letters.len(), 84);
    let mut list = String::new();
    let composed = built
        .font
        .glyphs()
        .iter()
        .filter(|g| !g.components.is_empty());
    for glyph in composed {
        let part = |c: &Component| {
            let [.., x, y] = c.place.as_coeffs();
            format!(" {}({x} {y})", c.base)
        };
        let parts: String = glyph.components.iter().map(part).collect();
        writeln!(list, "{} {}:{parts}", glyph.name, glyph.advance).expect("a String takes all");
    }
    approved::check("fonts", "rasm-composed", &list);
    for ending in ["ttf", "otf"] {
        let bytes = output(outputs, ending);
        let words = include_str!("words.txt").split_whitespace();
        let others =
            "پنجره آشپزخانه گشوده چراغ ژاله ٹھنڈا پانی لڑکے نے پیا اور چھت ہے ۂ ۓ ۃ".split(' ');
        let words: Vec<&str> = words.chain(others).collect();
        assert_eq!(words.len(), 216);
        for word in words {
            let names = set(bytes, word);
            assert!(
                !names.iter().any(|n| n == ".notdef"),
                "{ending} {word}: {names:?}"
            );
        }
    }
}

/// The outline of a part as points, hardly off its curves.
fn rings(font: &Font, part: &Component) -> Vec<Vec<Point>> {
    let base = font.glyph(part.base.as_str()).expect("a part is a glyph");
    let ring = |c: &kurbo::BezPath| {
        let mut points: Vec<Point> = Vec::new();
        flatten(part.place * c, 0.2, |el| points.extend(el.end_point()));
        points.extend(points.first().copied());
        points
    };
    base.outline.contours().iter().map(ring).collect()
}

fn apart(a: &[Vec<Point>], b: &[Vec<Point>]) -> f64 {
    let lines: Vec<Polyline> = b
        .iter()
        .filter_map(|ring| Polyline::new(ring.clone()))
        .collect();
    let to = |p: &Point| {
        lines
            .iter()
            .map(|l| l.nearest(*p).distance)
            .fold(f64::INFINITY, f64::min)
    };
    a.iter().flatten().map(to).fold(f64::INFINITY, f64::min)
}

#[test]
fn dots_are_clear_of_bodies() {
    let font = &demo::built("rasm").built.font;
    let is_dot = |c: &&Component| c.base.as_str() == "uniFBB2";
    let dotted = font
        .glyphs()
        .iter()
        .filter(|g| g.components.iter().any(|c| is_dot(&c)));
    let dotted: Vec<&Glyph> = dotted.collect();
    assert_eq!(dotted.len(), 72);
    for glyph in dotted {
        let body = rings(font, &glyph.components[0]);
        for dot in glyph.components.iter().filter(is_dot) {
            let gap = apart(&rings(font, dot), &body);
            // columns lie 5 units apart, components stand on whole units
            assert!(gap >= 1000.0 * GAP - 5.0, "{}: {gap:.1}", glyph.name);
        }
    }
}
