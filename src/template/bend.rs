//! How paper and lens bend a page, from the guides that are printed all over it.
//!
//! The marks say where a flat page lies. Its guides lie elsewhere in the picture of a page that is curled, or taken
//! through a lens that bends lines. They are looked for from the marks inwards, near where those before them let them
//! expect, all lines of a block together; then each piece of a line says its own place.

use super::draw::guides;
use super::find::Found;
use super::layout::{Layout, Place};
use crate::numeric::bilinear::bilinear;
use crate::numeric::cast::index;
use crate::numeric::median::{median, quantile};
use crate::numeric::surface::{Bend, Seen, Stiffness, Surface};
use crate::types::{Gray, Sheet};
use kurbo::{Line, Point, Vec2};
use rayon::prelude::*;
use std::collections::BTreeMap;

/// A guide is read in pieces of this length at most. mm
const PIECE: f64 = 7.0;
/// Shorter lines are ticks. mm
const SHORTEST: f64 = 2.6;
/// Left off at a piece's ends, where other lines cross. mm
const END: f64 = 0.4;
/// Sides of blocks whose lines are looked for together: while nothing is known of how they turn, and then. mm
const BLOCKS: (f64, f64) = (15.0, 25.0);
/// How a block's lines are looked for, and a single piece's.
const SEARCH: Search = Search {
    reach: 1.2,
    step: 0.15,
    along: 0.3,
};
const FINE: Search = Search {
    reach: 0.4,
    step: 0.05,
    along: 0.15,
};
/// Deviation of the bell by which a line's profile is read: a line's width and its blur. mm
const BELL: f64 = 0.12;
/// Grey that is ink, and how far its blur reaches. share of the contrast that the page's marks have; mm
const INK: f64 = 0.3;
const RIM: f64 = 0.25;
/// Least share of a row of samples that is free of ink.
const FREE: f64 = 0.25;
/// Guides are at least as grey as this. share of the contrast
const FAINTEST: f64 = 0.015;
/// Grey of one piece of a line counts no more than this. share of the contrast
const GREYEST: f64 = 0.15;
/// A block's lines lie where they are greyer than elsewhere by this factor.
const SURE: f64 = 1.3;
/// Times that all blocks are read once more, now that all about them is known; a block counts where it is as grey as
/// this share of what is usual: where lines of two kinds lie over each other by chance, others do not.
const AGAIN: usize = 2;
const RIGHT: f64 = 0.7;
/// Least share of the pieces, and number of them, that tell a bend.
const TELLING: (f64, usize) = (0.3, 24);
/// What a mark counts beside a piece of a line.
const MARK: f64 = 20.0;

impl Found {
    /// The same page bent as its printed guides show; as it was where they show nothing.
    #[must_use]
    pub fn bent(self, sheet: &Sheet, layout: &Layout, places: &[Place]) -> Self {
        let reader = Reader {
            gray: &sheet.gray,
            contrast: self.contrast,
        };
        let surface = reader.bent(&self.surface, layout, places);
        Self {
            surface: surface.unwrap_or_else(|| self.surface.clone()),
            ..self
        }
    }
}

/// A piece of a guide.
#[derive(Clone, Copy)]
struct Piece {
    middle: Point,
    /// From its middle to its end.
    half: Vec2,
    /// The coordinate that it tells: 0 for x, 1 for y.
    axis: usize,
}

impl Piece {
    /// The pieces of the guides of some places.
    fn of(layout: &Layout, places: &[Place]) -> Vec<Self> {
        let lines = places.iter().flat_map(|place| {
            let f = place.field;
            let corners = [(f.x0, f.y0), (f.x1, f.y0), (f.x1, f.y1), (f.x0, f.y1)];
            let side = move |k: usize| Line::new(corners[k], corners[(k + 1) % 4]);
            guides(layout, place).into_iter().chain((0..4).map(side))
        });
        let long = lines
            .map(|l| (l.p1 - l.p0, l))
            .filter(|(d, _)| d.hypot() > SHORTEST);
        let pieces = long.flat_map(|(d, line)| {
            let count = index((d.hypot() / PIECE).ceil()).max(1);
            let half = d / (2.0 * count as f64);
            let axis = usize::from(d.y.abs() < d.x.abs());
            (0..count).map(move |k| Self {
                middle: line.p0 + half * (2 * k + 1) as f64,
                half: half * (1.0 - END / half.hypot()),
                axis,
            })
        });
        pieces.collect()
    }

    fn across(&self) -> Vec2 {
        if self.axis == 0 {
            Vec2::new(1.0, 0.0)
        } else {
            Vec2::new(0.0, 1.0)
        }
    }

    /// That its line lies so far across from where `surface` has it.
    fn seen(&self, surface: &Surface, off: f64) -> Seen {
        let moved = surface.moved(self.middle + off * self.across());
        Seen {
            at: self.middle,
            axis: self.axis,
            by: off + moved.dot(self.across()),
            weight: 1.0,
        }
    }
}

/// How a line is looked for. mm
#[derive(Clone, Copy)]
struct Search {
    /// How far from where it is expected.
    reach: f64,
    /// Distance of samples across it.
    step: f64,
    /// Along it, a px at least.
    along: f64,
}

impl Search {
    /// How far a place of a profile lies from where the line is expected.
    fn off(self, place: f64) -> f64 {
        place * self.step - self.reach
    }
}

/// Reads guides in a picture.
struct Reader<'a> {
    gray: &'a Gray,
    /// Between ink and paper.
    contrast: f64,
}

impl Reader<'_> {
    fn bent(&self, flat: &Surface, layout: &Layout, places: &[Place]) -> Option<Surface> {
        let (size, marks) = (layout.paper_mm(), layout.marks());
        let pieces = Piece::of(layout, places);
        let held: Vec<Seen> = marks
            .iter()
            .flat_map(|&at| {
                [0, 1].map(|axis| Seen {
                    at,
                    axis,
                    by: 0.0,
                    weight: MARK,
                })
            })
            .collect();
        let fitted = |seen: &[Seen], stiffness| {
            let all: Vec<Seen> = held.iter().chain(seen).copied().collect();
            let bend = Bend::fitted(size, &all, stiffness)?;
            Some(flat.clone().with_bend(bend))
        };
        let mut surface = flat.clone();
        let mut seen: Vec<Seen> = Vec::new();
        for ring in Block::inwards(&pieces, &marks) {
            let more = ring.par_iter().filter_map(|b| self.block(&surface, b));
            seen.extend(more.map(|(_, seen)| seen).collect::<Vec<_>>());
            surface = fitted(&seen, Stiffness::STRAIGHT)?;
        }
        let blocks = Block::of(&pieces, BLOCKS.1);
        for _ in 0..AGAIN {
            let all = blocks.par_iter().filter_map(|b| self.block(&surface, b));
            let all: Vec<(f64, Seen)> = all.collect();
            let usual = median(all.iter().map(|(grey, _)| *grey))?;
            let right = all.iter().filter(|(grey, _)| *grey >= RIGHT * usual);
            let right: Vec<Seen> = right.map(|(_, seen)| *seen).collect();
            surface = fitted(&right, Stiffness::STRAIGHT)?;
        }
        let each = pieces.par_iter();
        let seen: Vec<Seen> = each.filter_map(|p| self.piece(&surface, p)).collect();
        let least = TELLING.1.max(index(TELLING.0 * pieces.len() as f64));
        (seen.len() >= least).then(|| fitted(&seen, Stiffness::CURVED))?
    }

    /// How far from its expected place a block's lines are, at its middle, and how grey they are there.
    fn block(&self, surface: &Surface, block: &Block) -> Option<(f64, Seen)> {
        let profiles = block
            .pieces
            .iter()
            .filter_map(|p| self.profile(surface, p, SEARCH));
        let profiles: Vec<Vec<f64>> = profiles.collect();
        let grey = |k: usize| {
            profiles
                .iter()
                .map(|p| p[k].clamp(0.0, GREYEST))
                .sum::<f64>()
        };
        let sums: Vec<f64> = (0..profiles.first()?.len()).map(grey).collect();
        let best = peak(&sums)?;
        let near = |k: usize| (k as f64 - best).abs() * SEARCH.step < 3.0 * BELL;
        let others = sums.iter().enumerate().filter(|(k, _)| !near(*k));
        let next = others.map(|(_, v)| *v).fold(0.0, f64::max);
        let top = index(best + 0.5).min(sums.len() - 1);
        let telling = profiles.iter().filter(|p| p[top] > FAINTEST).count();
        let piece = Piece {
            middle: block.middle,
            ..*block.pieces.first()?
        };
        let is_sure = sums[top] > SURE * next && 2 * telling >= profiles.len();
        let seen = piece.seen(surface, SEARCH.off(best));
        is_sure.then_some((sums[top] / profiles.len() as f64, seen))
    }

    /// How far from its expected place the line of one piece is.
    fn piece(&self, surface: &Surface, piece: &Piece) -> Option<Seen> {
        let profile = self.profile(surface, piece, FINE)?;
        let best = peak(&profile)?;
        let inside = best > 1.0 && best < (profile.len() - 2) as f64;
        let is_line = profile[index(best + 0.5)] > FAINTEST;
        (inside && is_line).then(|| piece.seen(surface, FINE.off(best)))
    }

    /// How grey a piece is across its line, in steps from one side to the other, weighed by a bell, above what is usual
    /// there; share of the contrast. None where the picture ends, or ink hides all of it.
    fn profile(
        &self,
        surface: &Surface,
        piece: &Piece,
        Search { reach, step, along }: Search,
    ) -> Option<Vec<f64>> {
        let bell = index((2.5 * BELL / step).ceil());
        let rows = 2 * (index(reach / step + 0.5) + bell) + 1;
        // so little of the page hardly bends
        let near = surface.near(piece.middle);
        let along = near.determinant().abs().sqrt().recip().max(along);
        let columns = index(2.0 * piece.half.hypot() / along).max(2);
        let place = |k: usize, i: usize| {
            let off = (k as f64 - (rows / 2) as f64) * step;
            let share = (2 * i + 1) as f64 / columns as f64 - 1.0;
            near * (piece.middle + share * piece.half + off * piece.across())
        };
        let (w, h) = (self.gray.width() as f64, self.gray.height() as f64);
        let corners = [
            (0, 0),
            (0, columns - 1),
            (rows - 1, 0),
            (rows - 1, columns - 1),
        ];
        let is_seen = |p: Point| p.x >= 0.0 && p.y >= 0.0 && p.x < w && p.y < h;
        if !corners.iter().all(|&(k, i)| is_seen(place(k, i))) {
            return None;
        }
        let all = (0..rows).flat_map(|k| (0..columns).map(move |i| (k, i)));
        let samples: Vec<f64> = all
            .map(|(k, i)| {
                bilinear(self.gray.samples(), self.gray.width(), place(k, i)) / self.contrast
            })
            .collect();
        let paper = quantile(&mut samples.clone(), 0.3, f64::total_cmp)?;
        let dark: Vec<bool> = samples.iter().map(|v| *v > paper + INK).collect();
        let [wide, high] = [along, step].map(|apart| index((RIM / apart).ceil()));
        let hidden = spread(&spread(&dark, wide, 1), high, columns);
        let row = |k: usize| {
            let row = k * columns..(k + 1) * columns;
            let free = samples[row.clone()]
                .iter()
                .zip(&hidden[row])
                .filter(|(_, hidden)| !**hidden);
            let (sum, count) = free.fold((0.0, 0.0), |(sum, n), (v, _)| (sum + v, n + 1.0));
            (count >= FREE * columns as f64).then(|| sum / count)
        };
        let means: Vec<Option<f64>> = (0..rows).map(row).collect();
        let usual = median(means.iter().copied().flatten())?;
        let weight = |d: usize| libm::exp(-0.5 * (d as f64 * step / BELL).powi(2));
        let weighed = |k: usize| {
            let rows = k..=k + 2 * bell;
            let near = rows.filter_map(|j| Some((weight(j.abs_diff(k + bell)), means[j]? - usual)));
            let (sum, total) = near.fold((0.0, 0.0), |(sum, n), (w, v)| (sum + w * v, n + w));
            if total > 0.0 { sum / total } else { 0.0 }
        };
        Some((0..rows - 2 * bell).map(weighed).collect())
    }
}

/// The flags, and as many before and after each one that is set, `stride` apart.
fn spread(flags: &[bool], reach: usize, stride: usize) -> Vec<bool> {
    let mut out = flags.to_vec();
    for i in (0..flags.len()).filter(|&i| flags[i]) {
        for far in (1..=reach).map(|k| k * stride) {
            let both = [i.checked_sub(far), Some(i + far)];
            let both = both.into_iter().flatten().filter(|k| *k < flags.len());
            both.for_each(|k| out[k] = true);
        }
    }
    out
}

/// Where values are greatest, between their places.
fn peak(values: &[f64]) -> Option<f64> {
    let best = values
        .iter()
        .enumerate()
        .max_by(|a, b| a.1.total_cmp(b.1))?
        .0;
    let at = |k: usize| values.get(k).copied();
    let off = best.checked_sub(1).and_then(|k| {
        let (a, b, c) = (at(k)?, at(k + 1)?, at(k + 2)?);
        let fall = 2.0 * b - a - c;
        (fall > 0.0).then(|| (c - a) / (2.0 * fall))
    });
    Some(best as f64 + off.unwrap_or(0.0))
}

/// A block of pieces of one axis.
struct Block {
    pieces: Vec<Piece>,
    /// Of its pieces.
    middle: Point,
}

impl Block {
    /// Pieces in blocks with sides of so many mm, and in as many that lie half a side aside: two lines that are near to
    /// each other tell more than one, and one of the two holds both.
    fn of(pieces: &[Piece], side: f64) -> Vec<Self> {
        let mut blocks: BTreeMap<_, Vec<Piece>> = BTreeMap::new();
        for (piece, aside) in pieces.iter().flat_map(|p| [(p, 0.0), (p, 0.5)]) {
            let at = |v: f64| index((v / side + aside).max(0.0));
            let place = (aside > 0.0, at(piece.middle.x), at(piece.middle.y));
            blocks.entry((place, piece.axis)).or_default().push(*piece);
        }
        let of = |pieces: Vec<Piece>| {
            let sum = pieces
                .iter()
                .fold(Vec2::ZERO, |sum, p| sum + p.middle.to_vec2());
            let middle = (sum / pieces.len() as f64).to_point();
            Self { pieces, middle }
        };
        blocks.into_values().map(of).collect()
    }

    /// Small blocks, those nearest to a mark first, in rings as wide as a block.
    fn inwards(pieces: &[Piece], marks: &[Point; 4]) -> Vec<Vec<Self>> {
        let mut rings: BTreeMap<usize, Vec<Self>> = BTreeMap::new();
        for block in Self::of(pieces, BLOCKS.0) {
            let far = marks.iter().map(|m| m.distance(block.middle));
            let ring = index(far.fold(f64::INFINITY, f64::min) / BLOCKS.0);
            rings.entry(ring).or_default().push(block);
        }
        rings.into_values().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peak_lies_between_its_places() {
        let bell = |k: i32| libm::exp(-0.5 * ((f64::from(k) - 6.3) / 3.0).powi(2));
        let values: Vec<f64> = (0..14).map(bell).collect();
        let found = peak(&values).expect("values");
        assert!((found - 6.3).abs() < 0.02, "{found}");
        assert_eq!(peak(&[2.0, 1.0, 0.0]), Some(0.0));
        assert_eq!(peak(&[]), None);
    }

    #[test]
    fn ink_hides_what_lies_near_it() {
        let mut dark = vec![false; 5 * 7];
        dark[2 * 7 + 3] = true;
        let hidden = spread(&spread(&dark, 2, 1), 1, 7);
        let near = |k: usize| (1..=3).contains(&(k / 7)) && (1..=5).contains(&(k % 7));
        assert!(hidden.iter().enumerate().all(|(k, h)| *h == near(k)));
    }

    #[test]
    fn blocks_of_two_lattices_hold_every_piece_twice() {
        let piece = |x: f64, axis: usize| Piece {
            middle: Point::new(x, 40.0),
            half: Vec2::new(3.0, 0.0),
            axis,
        };
        // two lines of neighbours, at both sides of a border of the first lattice
        let pieces = [piece(104.6, 0), piece(105.4, 0), piece(104.6, 1)];
        let blocks = Block::of(&pieces, 15.0);
        let held: usize = blocks.iter().map(|b| b.pieces.len()).sum();
        assert_eq!(held, 2 * pieces.len());
        assert_eq!(blocks.iter().filter(|b| b.pieces.len() == 2).count(), 1);
    }
}
