//! Ink of several letters that touch → a piece of ink for each, cut along borders between them.
//!
//! Which of the ink there is whose nobody knows: such letters are warned of.

mod overlap;
mod pale;
mod seam;

pub(super) use seam::Along;

use crate::numeric::view::View;
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

/// Ink that is of several letters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Touch {
    /// Indices of its components.
    ink: Vec<usize>,
    along: Along,
    /// Where one letter ends and the next one begins, upright px.
    ends: Vec<Range<f64>>,
    /// How far apart the middles of the cells are, px, where letters stand in the middle of theirs.
    cells: Option<f64>,
}

impl Touch {
    /// Letters in cells so many upright px apart, of which one ends and the next one begins in each of some
    /// stretches.
    pub(super) fn at(ends: Vec<Range<f64>>, (along, ink): (Along, Vec<usize>), pitch: f64) -> Self {
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
        let end = |k: usize| {
            let middle = bounds.x0 + k as f64 * width;
            middle - UNEQUAL * width..middle + UNEQUAL * width
        };
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
        let end = middle - UNEQUAL * pitch..middle + UNEQUAL * pitch;
        Self {
            ink,
            along: Along::Column,
            ends: vec![end],
            cells: None,
        }
    }

    /// Cuts the ink of `page` in `all`, where new pieces go to the end, and says which pieces were cut from others.
    pub(super) fn part(
        &self,
        all: &mut Vec<Component>,
        (page, upright): (&Gray, &View),
    ) -> Vec<usize> {
        let ink: Vec<Component> = self.ink.iter().map(|&i| all[i].clone()).collect();
        let ink: Vec<&Component> = ink.iter().collect();
        let mut pieces: Vec<Vec<Component>> = ink.iter().map(|&c| vec![c.clone()]).collect();
        for (k, stretch) in self.ends.iter().enumerate() {
            let border = Border {
                along: self.along,
                stretch,
                upright,
                cells: self.cells,
                is_last: k + 1 == self.ends.len(),
            };
            let seam = OnceCell::new();
            let seam = || seam.get_or_init(|| Seam::within(stretch, (self.along, &ink), upright));
            let cut = |piece: &Component| {
                let apart = pale::part(piece, page, &border);
                let over = || overlap::part(piece, page, &border).map(|parts| parts.concat());
                let cut = || {
                    seam()
                        .as_ref()
                        .map(|s| piece.parted(|x, y| s.is_before(x, y)))
                };
                apart
                    .or_else(over)
                    .or_else(cut)
                    .unwrap_or_else(|| vec![piece.clone()])
            };
            for of in &mut pieces {
                *of = of.iter().flat_map(cut).collect();
            }
        }
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

/// Where one letter ends and the next one begins.
struct Border<'a> {
    along: Along,
    /// Upright px.
    stretch: &'a Range<f64>,
    upright: &'a View,
    /// How far apart the middles of the cells are, px, where letters stand in the middle of theirs.
    cells: Option<f64>,
    /// One letter follows, not several.
    is_last: bool,
}

impl Border<'_> {
    /// Where the middles of the letter before it and of the one after it are, in halves of the stretch behind its
    /// middle, if that is known.
    fn middles(&self) -> [Option<f64>; 2] {
        let off = self.cells.map(|pitch| pitch / 2.0 / self.half());
        [off.map(|v| -v), off.filter(|_| self.is_last)]
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
