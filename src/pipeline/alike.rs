//! Letters that came out the same: one drawing in two cells, or one page cut twice.

use super::letter::Letter;
use crate::assemble::{Drawn, Note};
use crate::numeric::distance::Polyline;
use kurbo::{Affine, BezPath, Point, Rect, Vec2, flatten};
use rayon::prelude::*;

/// Two outlines are one drawing where they lie nowhere farther apart than this share of the em: a hand never
/// repeats itself that well.
const SAME: f64 = 0.004;

/// Remarks on letters whose outlines coincide once they stand on one place.
pub(super) fn notes(letters: &[Letter], drawn: &[Drawn], units_per_em: u16) -> Vec<Note> {
    let near = SAME * f64::from(units_per_em);
    let shapes: Vec<Option<Shape>> = drawn.par_iter().map(Shape::of).collect();
    let note = |(i, shape): (usize, &Option<Shape>)| {
        let twin = shapes[..i].iter().position(|other| {
            let pair = shape.as_ref().zip(other.as_ref());
            pair.is_some_and(|(a, b)| a.lies_on(b, near) && b.lies_on(a, near))
        });
        let place = letters.get(twin?)?.spot();
        Some(Note {
            glyph: letters.get(i)?.label.0.clone(),
            message: format!("its outline is that of {place}: is one of them in the wrong cell?"),
        })
    };
    shapes.par_iter().enumerate().filter_map(note).collect()
}

/// An outline as points and as lines between them, its box's corner at the origin.
struct Shape {
    size: Rect,
    points: Vec<Point>,
    lines: Vec<Polyline>,
}

impl Shape {
    fn of(drawn: &Drawn) -> Option<Self> {
        let bounds = drawn.outline.bounds()?;
        let home = Affine::translate(-Vec2::new(bounds.x0, bounds.y0));
        let rings = drawn.outline.contours().iter();
        let rings: Vec<Vec<Point>> = rings.map(|c| ring(&(home * c))).collect();
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

/// The points of a closed path's chords.
fn ring(contour: &BezPath) -> Vec<Point> {
    let mut points = Vec::new();
    flatten(contour, 0.5, |el| points.extend(el.end_point()));
    points.extend(points.first().copied());
    points
}
