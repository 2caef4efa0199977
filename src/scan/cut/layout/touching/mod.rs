//! Ink of several letters that touch → a piece of ink for each, cut along borders between them.
//!
//! Which of the ink there is whose nobody knows: such letters are warned of.

mod seam;

pub(super) use seam::Along;

use crate::numeric::view::View;
use crate::scan::components::Component;
use kurbo::Rect;
use seam::Seam;
use std::ops::Range;

/// Letters that touch are so unequal at most: each ends within this share of a mean width from where equal ones would.
const UNEQUAL: f64 = 0.25;

/// Ink that is of several letters.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Touch {
    /// Indices of its components.
    ink: Vec<usize>,
    along: Along,
    /// Where one letter ends and the next one begins, upright px.
    ends: Vec<Range<f64>>,
}

impl Touch {
    /// Letters of which one ends and the next one begins in each of some stretches of upright px.
    pub(super) fn at(ends: Vec<Range<f64>>, (along, ink): (Along, Vec<usize>)) -> Self {
        Self { ink, along, ends }
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
        }
    }

    /// Cuts the ink in `all`, where new pieces go to the end, and says which pieces were cut from others.
    pub(super) fn part(&self, all: &mut Vec<Component>, upright: &View) -> Vec<usize> {
        let ink: Vec<&Component> = self.ink.iter().map(|&i| &all[i]).collect();
        let seams = self.ends.iter();
        let seams = seams.filter_map(|end| Seam::within(end, (self.along, &ink), upright));
        let seams: Vec<Seam> = seams.collect();
        let mut parted = Vec::new();
        for &i in &self.ink {
            let mut pieces = vec![all[i].clone()];
            for seam in &seams {
                let parts = pieces.iter().map(|p| p.parted(|x, y| seam.is_before(x, y)));
                pieces = parts.flatten().collect();
            }
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
