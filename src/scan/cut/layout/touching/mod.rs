//! Ink of several letters that touch → a piece of ink for each, cut along borders between them.
//!
//! Which of the ink there is whose nobody knows: such letters are warned of.

mod overlap;
mod pale;
mod seam;
#[cfg(test)]
mod tests;

pub(super) use overlap::{Example, Side};
pub(super) use seam::Along;

use crate::numeric::surface::Surface;
use crate::scan::components::Component;
use crate::types::Gray;
use kurbo::{Point, Rect};
use seam::Seam;
use std::cell::OnceCell;
use std::ops::Range;

/// Letters that touch are so unequal at most: each ends within this share of a mean width from where equal ones
/// would.
const UNEQUAL: f64 = 0.25;

/// Coverage of the ink's edge.
const LEVEL: f64 = 0.5;

/// What meets where one letter ends and the next one begins.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Meeting {
    /// Joining strokes of both, as their names say, which may lie in line with each other.
    Strokes,
    /// Whatever it is.
    Any,
}

/// Where one letter ends and the next one begins.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct End {
    /// Upright px.
    pub(super) stretch: Range<f64>,
    pub(super) meeting: Meeting,
    /// Letters drawn alike as the one before it and the one after it, where they lie free.
    pub(super) examples: [Vec<Example>; 2],
}

impl End {
    /// So far around a place.
    fn around(place: f64, reach: f64) -> Self {
        Self {
            stretch: place - reach..place + reach,
            meeting: Meeting::Any,
            examples: [Vec::new(), Vec::new()],
        }
    }
}

/// Ink that is of several letters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Touch {
    /// Indices of its components.
    ink: Vec<usize>,
    along: Along,
    /// In order.
    ends: Vec<End>,
    /// How far apart the middles of the cells are, px, where letters stand in the middle of theirs.
    cells: Option<f64>,
}

impl Touch {
    /// Letters in cells so many upright px apart.
    pub(super) fn at(ends: Vec<End>, (along, ink): (Along, Vec<usize>), pitch: f64) -> Self {
        Self {
            ink,
            along,
            ends,
            cells: (along == Along::Row).then_some(pitch),
        }
    }

    /// Letters of one row, so many within `bounds`.
    pub(super) fn beside(ink: Vec<usize>, bounds: Rect, letters: usize) -> Self {
        let width = bounds.width() / letters as f64;
        let end = |k: usize| End::around(bounds.x0 + k as f64 * width, UNEQUAL * width);
        Self {
            ink,
            along: Along::Row,
            ends: (1..letters).map(end).collect(),
            cells: None,
        }
    }

    /// A letter of one row and one of the next, whose middles are at `rows`.
    pub(super) fn below(ink: Vec<usize>, rows: Range<f64>) -> Self {
        let (pitch, middle) = (rows.end - rows.start, (rows.start + rows.end) / 2.0);
        Self {
            ink,
            along: Along::Column,
            ends: vec![End::around(middle, UNEQUAL * pitch)],
            cells: None,
        }
    }

    /// Cuts the ink of `page` in `all`, where new pieces go to the end, and says which pieces were cut from others.
    ///
    /// The surest border comes first: where it is tells how far the letters beside it reach, and so of the next ones.
    pub(super) fn part(
        &self,
        all: &mut Vec<Component>,
        (page, upright): (&Gray, &Surface),
    ) -> Parted {
        let ink: Vec<Component> = self.ink.iter().map(|&i| all[i].clone()).collect();
        let mut pieces: Vec<Vec<Component>> = ink.iter().map(|c| vec![c.clone()]).collect();
        let mut left: Vec<usize> = (0..self.ends.len()).collect();
        let mut costs: Vec<Option<f64>> = vec![None; left.len()];
        let mut paid = vec![f64::INFINITY; left.len()];
        while !left.is_empty() {
            // the last one needs no price
            let priced = if left.len() > 1 { &left[..] } else { &[] };
            for &k in priced {
                costs[k] = costs[k].or_else(|| {
                    let border = self.border(k, &left, upright);
                    let all = pieces.iter().flatten();
                    let partings = all.filter_map(|piece| border.parting(piece, page));
                    Some(partings.map(|p| p.cost).fold(f64::INFINITY, f64::min))
                });
            }
            let cost = |k: &usize| costs[*k].unwrap_or(f64::INFINITY);
            let surest = left.iter().copied();
            let surest = surest.min_by(|a, b| cost(a).total_cmp(&cost(b)));
            let Some(k) = surest else { break };
            let border = self.border(k, &left, upright);
            let seam = OnceCell::new();
            let seam = || {
                seam.get_or_init(|| Seam::within(border.stretch, (self.along, &ink), upright))
                    .as_ref()
            };
            let paid = &mut paid[k];
            let mut cut = |piece: &Component| {
                if let Some(told) = border.parting(piece, page) {
                    *paid = paid.min(told.cost);
                    return told.pieces;
                }
                let cut = seam().map(|s| piece.parted(|x, y| s.is_before(x, y)));
                cut.unwrap_or_else(|| vec![piece.clone()])
            };
            for of in &mut pieces {
                *of = of.iter().flat_map(&mut cut).collect();
            }
            left.retain(|&other| other != k);
            // more is known of those beside it
            for beside in left.iter().filter(|other| other.abs_diff(k) == 1) {
                costs[*beside] = None;
            }
        }
        Parted {
            pieces: self.put(pieces, all, upright),
            costs: paid,
        }
    }

    /// The border number `k`, where those that are `left` are not cut yet.
    fn border<'a>(&'a self, k: usize, left: &[usize], upright: &'a Surface) -> Border<'a> {
        let is_left = |k: Option<usize>| k.is_some_and(|k| left.contains(&k));
        let End {
            stretch,
            meeting,
            examples,
        } = &self.ends[k];
        Border {
            along: self.along,
            stretch,
            meeting: *meeting,
            examples: examples.each_ref().map(Vec::as_slice),
            upright,
            cells: self.cells,
            is_single: [!is_left(k.checked_sub(1)), !is_left(Some(k + 1))],
        }
    }

    /// Puts the pieces of each component in its place; which were cut from others.
    fn put(
        &self,
        pieces: Vec<Vec<Component>>,
        all: &mut Vec<Component>,
        upright: &Surface,
    ) -> Vec<usize> {
        let mut parted = Vec::new();
        for (&i, mut pieces) in self.ink.iter().zip(pieces) {
            pieces.iter_mut().for_each(|p| p.stand(upright));
            let first = (pieces.len() > 1).then(|| pieces.swap_remove(0));
            if let Some(first) = first {
                all[i] = first;
                parted.push(i);
                parted.extend(all.len()..all.len() + pieces.len());
                all.append(&mut pieces);
            }
        }
        parted
    }
}

/// What became of ink that is of several letters.
pub(super) struct Parted {
    /// Indices of the components that were cut from others.
    pub(super) pieces: Vec<usize>,
    /// How unlikely the cut at each end is; infinite where neither pixels nor edges tell of one.
    pub(super) costs: Vec<f64>,
}

/// Where one letter ends and the next one begins.
struct Border<'a> {
    along: Along,
    /// Upright px.
    stretch: &'a Range<f64>,
    meeting: Meeting,
    /// Letters drawn alike as the one before it and the one after it, where they lie free.
    examples: [&'a [Example]; 2],
    upright: &'a Surface,
    /// How far apart the middles of the cells are, px, where letters stand in the middle of theirs.
    cells: Option<f64>,
    /// Whether one letter alone is before it, and after it.
    is_single: [bool; 2],
}

/// Ink that is parted.
struct Parting {
    /// How unlikely it is; 0 is what pale pixels alone join.
    cost: f64,
    pieces: Vec<Component>,
}

impl Border<'_> {
    /// A piece of ink parted by what its pixels and edges tell; none where they tell nothing.
    fn parting(&self, piece: &Component, page: &Gray) -> Option<Parting> {
        let pale = || pale::part(piece, page, self).map(|pieces| Parting { cost: 0.0, pieces });
        let is_here = self.reaches(piece.bounds);
        is_here.then(|| pale().or_else(|| overlap::part(piece, page, self)))?
    }

    /// Whether some of a box in the sheet lies within its stretch.
    fn reaches(&self, bounds: Rect) -> bool {
        let Rect { x0, y0, x1, y1 } = bounds;
        let corners = [(x0, y0), (x0, y1), (x1, y0), (x1, y1)];
        let sides = corners.map(|p| self.side(Point::from(p)));
        sides.iter().any(|s| *s > -1.0) && sides.iter().any(|s| *s < 1.0)
    }

    /// Where the middles of the letter before it and of the one after it are, in halves of the stretch behind its
    /// middle, if that is known.
    fn middles(&self) -> [Option<f64>; 2] {
        let off = self.cells.map(|pitch| pitch / 2.0 / self.half());
        let [before, after] = self.is_single;
        [off.filter(|_| before).map(|v| -v), off.filter(|_| after)]
    }

    /// How far behind its middle a place of the sheet is, halves of the stretch.
    fn side(&self, p: Point) -> f64 {
        let p = self.upright.at(p);
        let at = match self.along {
            Along::Row => p.x,
            Along::Column => p.y,
        };
        (at - self.stretch.start) / self.half() - 1.0
    }

    /// Half of the stretch, px.
    fn half(&self) -> f64 {
        ((self.stretch.end - self.stretch.start) / 2.0).max(1.0)
    }
}
