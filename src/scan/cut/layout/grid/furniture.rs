//! What is printed in every cell of a grid with the letters' own ink: marks, numbers, labels.
//!
//! A letter of one piece leaves no second piece in its cell. Where nearly all cells of such letters have one, at the
//! same place and with less ink than the rest of the cell, it is printed, and so is what lies there in the others.

use super::axis::line;
use super::shared::Shared;
use crate::numeric::cast::ceiling;
use crate::scan::components::Component;
use crate::scan::cut::largest;
use kurbo::{Point, Rect, Vec2};
use std::collections::BTreeSet;

/// Share of the asked cells that must have a piece at the place.
const NEARLY_ALL: f64 = 0.8;
/// Cells asked at least.
const ENOUGH: usize = 6;
/// Cells whose pieces say which places to look at.
const SEEDS: usize = 12;
/// How far a piece may reach beyond the place of another, as a share of the cell.
const SPREAD: f64 = 0.07;
/// A place is smaller than this share of the cell in either direction.
const LARGEST: f64 = 0.5;
/// Kinds of furniture that are taken out.
const KINDS: usize = 12;

/// The pieces of ink that are furniture; `asked` are the cells whose letters are of one piece.
pub(super) fn find(all: &[Component], shared: &Shared, asked: &[usize]) -> BTreeSet<usize> {
    let mut out = BTreeSet::new();
    let Some(shared) = &Cells::new(all, shared, asked).filter(|_| asked.len() >= ENOUGH) else {
        return out;
    };
    let few = asked.len() - ceiling(NEARLY_ALL * asked.len() as f64);
    for _ in 0..KINDS {
        let step = asked.len().div_ceil(SEEDS);
        let seeds = asked.iter().step_by(step);
        let seeds = seeds.flat_map(|&cell| shared.ink.cells[cell].iter().map(move |&i| (cell, i)));
        let places = seeds
            .filter(|(_, i)| !out.contains(i))
            .filter_map(|(cell, i)| {
                let place = shared.place(cell, all[i].upright)?;
                let lacking = asked
                    .iter()
                    .filter(|&&c| !has(all, shared, (c, place), &out));
                let lacking = lacking.take(few + 1).count();
                (lacking <= few).then_some((lacking, i, place))
            });
        let Some((_, _, place)) = places.min_by_key(|p| (p.0, p.1)) else {
            break;
        };
        for cell in 0..shared.ink.cells.len() {
            let there: Vec<usize> = at(all, shared, (cell, place)).collect();
            out.extend(there);
        }
    }
    out
}

/// Cells and where the letters stand in them: the axes that the ink's profile gave are too coarse for marks.
struct Cells<'a> {
    ink: &'a Shared,
    /// The usual middle of the first cell's letter, upright px, and the distance to the next.
    x: (f64, f64),
    y: (f64, f64),
}

impl<'a> Cells<'a> {
    fn new(all: &[Component], ink: &'a Shared, asked: &[usize]) -> Option<Self> {
        let columns = ink.x.count;
        let bodies = asked
            .iter()
            .filter_map(|&cell| Some((cell, all[largest(all, &ink.cells[cell])?].centre)));
        let bodies: Vec<(usize, Point)> = bodies.collect();
        let across: Vec<(f64, f64)> = bodies
            .iter()
            .map(|b| ((b.0 % columns) as f64, b.1.x))
            .collect();
        let down: Vec<(f64, f64)> = bodies
            .iter()
            .map(|b| ((b.0 / columns) as f64, b.1.y))
            .collect();
        Some(Self {
            x: line(&across).unwrap_or((ink.x.begin(0), ink.x.pitch)),
            y: line(&down).unwrap_or((ink.y.begin(0), ink.y.pitch)),
            ink,
        })
    }

    /// Where a piece lies beside the usual middle, a little enlarged; nothing for what fills its cell.
    fn place(&self, cell: usize, piece: Rect) -> Option<Rect> {
        let (w, h) = (self.x.1, self.y.1);
        let fits = piece.width() < LARGEST * w && piece.height() < LARGEST * h;
        fits.then(|| (piece - self.middle(cell)).inflate(SPREAD * w, SPREAD * h))
    }

    fn middle(&self, cell: usize) -> Vec2 {
        let columns = self.ink.x.count;
        let (r, c) = ((cell / columns) as f64, (cell % columns) as f64);
        Vec2::new(self.x.0 + c * self.x.1, self.y.0 + r * self.y.1)
    }
}

/// The pieces at a place of a cell, also those that stand over its border.
fn at<'a>(
    all: &'a [Component],
    shared: &'a Cells<'a>,
    (cell, place): (usize, Rect),
) -> impl Iterator<Item = usize> + 'a {
    let here = place + shared.middle(cell);
    let near = shared
        .ink
        .around(cell)
        .flat_map(|c| shared.ink.cells[c].iter().copied());
    near.filter(move |&i| here.contains_rect(all[i].upright))
}

/// Whether a cell has pieces at a place, and more ink elsewhere.
fn has(
    all: &[Component],
    shared: &Cells<'_>,
    (cell, place): (usize, Rect),
    gone: &BTreeSet<usize>,
) -> bool {
    let there: Vec<usize> = at(all, shared, (cell, place))
        .filter(|i| !gone.contains(i))
        .collect();
    let ink = |i: &usize| all[*i].area;
    let own: usize = there.iter().map(ink).sum();
    let rest = shared.ink.cells[cell]
        .iter()
        .filter(|i| !there.contains(i) && !gone.contains(i));
    own > 0 && own < rest.map(ink).sum()
}
