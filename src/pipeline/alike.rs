//! Letters that came out the same: one drawing in two cells, or one page cut twice.

use super::letter::Letter;
use crate::assemble::names;
use crate::assemble::{Drawn, Note};
use crate::numeric::distance::Polyline;
use crate::types::{Form, Label, Outline};
use kurbo::{Affine, BezPath, Point, Rect, Vec2, flatten};
use rayon::prelude::*;

/// Two outlines are one drawing where they lie nowhere farther apart than this share of the em: a hand never
/// repeats itself that well.
const SAME: f64 = 0.004;
/// How far the points that are compared lie apart at most, as a share of the outline's longer side.
const STEP: f64 = 0.02;
/// Letters that look the same where another follows, and those that do where none does: who has drawn one may copy
/// it.
const WITHIN_WORDS: [&str; 4] = ["ٯڡ", "ٮںى", "كک", "يی"];
const AT_ENDS: [&str; 2] = ["هہ", "ىی"];

/// Remarks on letters whose outlines coincide once they stand on one place.
pub(super) fn notes(letters: &[Letter], drawn: &[Drawn], units_per_em: u16) -> Vec<Note> {
    let near = SAME * f64::from(units_per_em);
    let shapes: Vec<Option<Shape>> = drawn.par_iter().map(|d| Shape::of(&d.outline)).collect();
    let note = |(i, shape): (usize, &Option<Shape>)| {
        let letter = letters.get(i)?;
        let twin = shapes[..i].iter().zip(letters).position(|(other, twin)| {
            let pair = shape.as_ref().zip(other.as_ref());
            pair.is_some_and(|(a, b)| a.lies_on(b, near) && b.lies_on(a, near))
                && !look_the_same(&letter.label, &twin.label)
        });
        let place = letters.get(twin?)?.spot();
        Some(Note {
            glyph: letter.label.0.clone(),
            message: format!("its outline is that of {place}: is one of them in the wrong cell?"),
        })
    };
    shapes.par_iter().enumerate().filter_map(note).collect()
}

/// Whether two letters look the same in the forms that they name.
fn look_the_same(a: &Label, b: &Label) -> bool {
    let read = |label: &Label| {
        let read = names::identify(label).ok()?;
        let form = read.form().unwrap_or(Form::Isol);
        Some((*read.chars.first()?, form))
    };
    let Some(((a, form), (b, other))) = read(a).zip(read(b)) else {
        return false;
    };
    let sets: &[&str] = match form {
        Form::Init | Form::Medi => &WITHIN_WORDS,
        Form::Isol | Form::Fina => &AT_ENDS,
    };
    form == other && sets.iter().any(|set| set.contains(a) && set.contains(b))
}

/// An outline as points and as lines between them, its box's corner at the origin.
struct Shape {
    size: Rect,
    points: Vec<Point>,
    lines: Vec<Polyline>,
}

impl Shape {
    fn of(outline: &Outline) -> Option<Self> {
        let bounds = outline.bounds()?;
        let home = Affine::translate(-Vec2::new(bounds.x0, bounds.y0));
        let step = STEP * bounds.width().max(bounds.height()).max(1.0);
        let rings = outline.contours().iter();
        let rings: Vec<Vec<Point>> = rings.map(|c| ring(&(home * c), step)).collect();
        let lines = rings.iter().filter_map(|r| Polyline::new(r.clone()));
        Some(Self {
            size: bounds.with_origin(Point::ORIGIN),
            lines: lines.collect(),
            points: rings.concat(),
        })
    }

    /// Whether no point of it is farther than `near` from the other outline.
    fn lies_on(&self, other: &Self, near: f64) -> bool {
        let alike = |a: f64, b: f64| (a - b).abs() < 2.0 * near;
        let sizes = alike(self.size.width(), other.size.width())
            && alike(self.size.height(), other.size.height());
        let on = |p: &Point| other.lines.iter().any(|l| l.nearest(*p).distance < near);
        sizes && self.points.iter().all(on)
    }
}

/// The points of a closed path's chords, none farther than `step` from the next: an i's corners alone lie on an l.
fn ring(contour: &BezPath, step: f64) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    let mut go = |to: Point| {
        let from = *points.last().unwrap_or(&to);
        let parts = (from.distance(to) / step).ceil().max(1.0);
        let mut part = 1.0;
        while part <= parts {
            points.push(from.lerp(to, part / parts));
            part += 1.0;
        }
    };
    let mut first = None;
    flatten(contour, 0.5, |el| {
        if let Some(p) = el.end_point() {
            first = first.or(Some(p));
            go(p);
        }
    });
    first.into_iter().for_each(go);
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape as _;

    #[test]
    fn letters_look_the_same_in_their_forms() {
        let same = |a: &str, b: &str| look_the_same(&Label(a.to_owned()), &Label(b.to_owned()));
        assert!(same("uni066F.init", "uni06A1.init") && !same("uni066F", "uni06A1"));
        assert!(same("uni06C1", "uni0647") && !same("uni06C1.fina", "uni0647.init"));
        assert!(!same("uni0628.init", "uni062A.init") && !same("l", "I"));
    }

    #[test]
    fn a_stem_is_not_a_stem_with_a_dot() {
        let of = |bars: &[(f64, f64)]| {
            let bars = bars
                .iter()
                .map(|(low, high)| Rect::new(0.0, *low, 80.0, *high));
            let paths = bars.map(|bar| bar.to_path(0.1)).collect();
            Shape::of(&Outline::new(paths).unwrap()).unwrap()
        };
        let (l, i) = (of(&[(0.0, 729.0)]), of(&[(0.0, 524.0), (624.0, 729.0)]));
        assert!(l.lies_on(&l, 4.0) && !(i.lies_on(&l, 4.0) && l.lies_on(&i, 4.0)));
    }
}
