//! Ink of two letters that pale pixels alone join → the ink of each.
//!
//! Letters that stand closer than the lens and the pixels part have a slit of paler ink between them, whatever their
//! edges do beside it: joining strokes that lie in line with each other have no corner there.

use super::{Border, LEVEL};
use crate::numeric::cast::index;
use crate::numeric::pieces::around;
use crate::scan::components::Component;
use crate::types::Gray;
use kurbo::Point;
use std::collections::VecDeque;

/// A letter has at least so much ink, in squares of a stroke's width: less is grain, and goes with what is nearest.
const LEAST: f64 = 1.0;
/// Of a letter's ink at most so much lies on the other side of the border's middle.
const ASTRAY: f64 = 0.25;

/// The ink before a border and after it, where what is darker than half falls apart there; none where it hangs
/// together.
pub(super) fn part(ink: &Component, page: &Gray, border: &Border<'_>) -> Option<Vec<Component>> {
    let stroke = ink.stroke().max(1.0);
    let mut dark = ink.without(|x, y| f64::from(page.at(x, y)) < LEVEL);
    dark.retain(|c| c.area as f64 >= LEAST * stroke * stroke);
    let sides: Option<Vec<Side>> = dark.iter().map(|c| Side::of(c, border)).collect();
    let sides = sides?;
    if [Side::Before, Side::After]
        .iter()
        .any(|s| !sides.contains(s))
    {
        return None;
    }
    let nearest = Nearest::to(&dark, &sides, ink);
    Some(ink.parted(|x, y| nearest.at(x, y) == Some(Side::Before)))
}

/// Where a letter lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Before,
    After,
}

impl Side {
    /// That of a piece; none of one that lies on both.
    fn of(piece: &Component, border: &Border<'_>) -> Option<Self> {
        let is_before = |(x, y): &(usize, usize)| {
            border.side(Point::new(*x as f64 + 0.5, *y as f64 + 0.5)) < 0.0
        };
        let before = piece.pixels().filter(is_before).count() as f64 / piece.area.max(1) as f64;
        if before <= ASTRAY {
            Some(Self::After)
        } else if before >= 1.0 - ASTRAY {
            Some(Self::Before)
        } else {
            None
        }
    }
}

/// Which side's piece each pixel of some ink is nearest to, by steps through the ink.
struct Nearest {
    corner: (usize, usize),
    width: usize,
    sides: Vec<Option<Side>>,
}

impl Nearest {
    fn to(pieces: &[Component], sides: &[Side], ink: &Component) -> Self {
        let corner = (index(ink.bounds.x0), index(ink.bounds.y0));
        let (width, height) = (index(ink.bounds.width()), index(ink.bounds.height()));
        let place = |(x, y): (usize, usize)| (y - corner.1) * width + x - corner.0;
        let mut open = vec![false; width * height];
        ink.pixels().for_each(|p| open[place(p)] = true);
        let mut found = vec![None; width * height];
        let mut next = VecDeque::new();
        for (piece, &side) in pieces.iter().zip(sides) {
            for p in piece.pixels().map(place) {
                found[p] = Some(side);
                next.push_back(p);
            }
        }
        while let Some(at) = next.pop_front() {
            for to in around((at % width, at / width), 1, (width, height)) {
                if open[to] && found[to].is_none() {
                    found[to] = found[at];
                    next.push_back(to);
                }
            }
        }
        Self {
            corner,
            width,
            sides: found,
        }
    }

    fn at(&self, x: usize, y: usize) -> Option<Side> {
        self.sides[(y - self.corner.1) * self.width + x - self.corner.0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::surface::Surface;
    use crate::scan::components::components;
    use crate::scan::cut::layout::touching::{Along, Meeting};
    use kurbo::{Affine, Rect};

    /// Where the pieces of some bars begin and end, of which one ends and the next one begins between 40 and 80 px.
    fn ends(bars: &[(Rect, f32)]) -> Option<Vec<(f64, f64)>> {
        let gray = Gray::from_fn(120, 60, |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let here = bars.iter().filter(|b| b.0.contains(p)).map(|b| b.1);
            here.fold(0.0, f32::max)
        });
        let ink = components(&gray, 0.25, 0.5);
        assert_eq!(ink.len(), 1, "pale ink joins them");
        let border = Border {
            along: Along::Row,
            stretch: &(40.0..80.0),
            meeting: Meeting::Any,
            examples: [&[], &[]],
            upright: &Surface::from(Affine::IDENTITY),
            cells: None,
            is_single: [true; 2],
        };
        let parts = part(&ink[0], &gray, &border)?;
        Some(parts.iter().map(|c| (c.bounds.x0, c.bounds.x1)).collect())
    }

    #[test]
    fn letters_fall_apart_where_ink_is_pale() {
        let bar = |x0: f64, x1: f64| Rect::new(x0, 20.0, x1, 30.0);
        let slit = |pale: f32| {
            [
                (bar(5.0, 50.0), 1.0),
                (bar(50.0, 52.0), pale),
                (bar(52.0, 110.0), 1.0),
            ]
        };
        let found = ends(&slit(0.4)).expect("they fall apart");
        assert_eq!(found.len(), 2, "{found:?}");
        let (before, after) = (found[1], found[0]);
        assert_eq!((before.0, after.1), (5.0, 110.0), "{found:?}");
        assert!(
            (before.1 - after.0).abs() < 0.5 && (50.0..=52.0).contains(&after.0),
            "{found:?}"
        );
        // as dark as their edges
        assert_eq!(ends(&slit(0.6)), None);
        // what falls apart is one letter, or a part of it and the other one
        let far = [
            (bar(5.0, 98.0), 1.0),
            (bar(98.0, 100.0), 0.4),
            (bar(100.0, 118.0), 1.0),
        ];
        assert_eq!(ends(&far), None);
        // grain is no letter
        let grain = [
            (bar(5.0, 50.0), 1.0),
            (bar(50.0, 52.0), 0.4),
            (Rect::new(52.0, 22.0, 56.0, 26.0), 1.0),
        ];
        assert_eq!(ends(&grain), None);
    }
}
