//! Which of dark and light is a picture's ink.
//!
//! Paper surrounds the ink and there is more of it. Dark and light are told by the picture's own two levels, not by
//! those of the file: edges of ink lie halfway between it and its paper, wherever on the scale these are, and light
//! that falls off has none. A light page on a dark table is surrounded by dark and can be less than half of the
//! picture; it is told from light ink by its size and by what is drawn on it.

use crate::numeric::cast::index;
use crate::numeric::median::quantile;
use crate::scan::paper::{beside, regions, with_holes};
use crate::types::Shade;

/// Share of dark pixels, of the outermost ring, from which the picture counts as light on dark.
const DARK_RING: f32 = 0.9;
/// Pixels across the shorter side that say enough of the levels.
const ACROSS: usize = 1000;
/// Share of the pixels beyond each end of a range: the ink of a page with a few letters is no more.
const BEYOND: f64 = 0.0001;
/// Less of a difference says nothing, of black against white: as on pages.
const LEAST: f32 = 0.1;
/// Pixels between the two sides of an edge: what a lens blurs.
const EDGE_PX: usize = 3;
/// How far its sides differ at least, as a share of how far those of the steepest edges do.
const STEEP: f32 = 0.25;
/// Parts across and down the picture, each with a level of its own, since light falls off.
const PARTS: usize = 4;
/// Edges that tell a part's level, as a share of what a part has on average.
const ENOUGH: f32 = 0.1;
/// Blocks across the shorter side by which a page is looked for, and the least side of one, px.
const BLOCKS: (usize, usize) = (100, 4);
/// Share of the picture that a page covers at least: no letter of a page is as large.
const PAGE: f32 = 0.1;
/// Share of the rectangle around it that a page fills at least, one in perspective and half in shadow too.
const FILL: f64 = 0.5;
/// Share of dark pixels of a block that is inked.
const INKED: f32 = 0.1;
/// Pieces of ink on a page at least: few letters have as many holes.
const PIECES: usize = 8;

/// What a picture says of its ink.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Guess {
    pub(super) shade: Shade,
    /// Whether all that was looked at says so.
    pub(super) certainty: Certainty,
}

/// How far a guess can be relied upon.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Certainty {
    Sure,
    Doubtful,
}

/// Guesses the shade of the ink from the darkness of a picture's pixels.
pub(super) fn guess(ink: &[f32], width: usize) -> Guess {
    if ink.is_empty() {
        return Guess {
            shade: Shade::Dark,
            certainty: Certainty::Sure,
        };
    }
    let picture = Thresholded::new(ink, width);
    let share = |places: &[(usize, usize)]| {
        let dark = places.iter().filter(|p| picture.is_dark(**p)).count();
        dark as f32 / places.len().max(1) as f32
    };
    let around = share(&picture.ring());
    let most = picture.dark_share();
    let surrounded = around > DARK_RING && most > 0.5;
    let shade = if surrounded && !picture.shows_page() {
        Shade::Light
    } else {
        Shade::Dark
    };
    let certainty = if around > 0.5 || most > 0.5 {
        Certainty::Doubtful
    } else {
        Certainty::Sure
    };
    Guess { shade, certainty }
}

/// The darkness of a picture's pixels, of which every `step`-th of every `step`-th row says enough, and what is dark
/// in each part.
struct Thresholded<'a> {
    ink: &'a [f32],
    width: usize,
    height: usize,
    step: usize,
    /// The part, of those in a row of them, in which each column lies.
    across: Vec<usize>,
    /// The level between dark and light in each part, by rows.
    middles: Vec<f32>,
}

impl<'a> Thresholded<'a> {
    fn new(ink: &'a [f32], width: usize) -> Self {
        let height = ink.len() / width.max(1);
        let mut new = Self {
            ink,
            width,
            height,
            step: (width.min(height) / ACROSS).max(1),
            across: (0..width).map(|x| x * PARTS / width).collect(),
            middles: Vec::new(),
        };
        new.middles = new.middles();
        new
    }

    /// Column and row of the pixels looked at.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let (w, h, step) = (self.width, self.height, self.step);
        let rows = (0..h).step_by(step);
        rows.flat_map(move |y| (0..w).step_by(step).map(move |x| (x, y)))
    }

    /// Column and row of the outermost pixels.
    fn ring(&self) -> Vec<(usize, usize)> {
        let (w, h) = (self.width, self.height);
        let sides = (0..h).flat_map(|y| [(0, y), (w - 1, y)]);
        let ends = (0..w).flat_map(|x| [(x, 0), (x, h - 1)]);
        sides.chain(ends).collect()
    }

    fn at(&self, (x, y): (usize, usize)) -> f32 {
        self.ink[y * self.width + x]
    }

    fn part(&self, (x, y): (usize, usize)) -> usize {
        y * PARTS / self.height * PARTS + self.across[x]
    }

    fn is_dark(&self, place: (usize, usize)) -> bool {
        self.at(place) > self.middles[self.part(place)]
    }

    /// The share of the pixels looked at that are dark.
    fn dark_share(&self) -> f32 {
        let (mut dark, mut all) = (0, 0);
        for y in (0..self.height).step_by(self.step) {
            let parts = &self.middles[self.part((0, y))..];
            let row = &self.ink[y * self.width..][..self.width];
            for (v, part) in row.iter().zip(&self.across).step_by(self.step) {
                dark += usize::from(*v > parts[*part]);
                all += 1;
            }
        }
        dark as f32 / all as f32
    }

    /// The level of most steep edges in each part, or of all where it has few. In a picture out of focus that of the
    /// middle, and half of black where all looks alike.
    fn middles(&self) -> Vec<f32> {
        let Some(steepest) = self.steepest() else {
            let mut all: Vec<f32> = self.places().map(|p| self.at(p)).collect();
            let (low, high) = (nth(&mut all, BEYOND), nth(&mut all, 1.0 - BEYOND));
            let told = high - low >= LEAST;
            return vec![if told { f32::midpoint(low, high) } else { 0.5 }; PARTS * PARTS];
        };
        let mut all = Vec::new();
        let mut parts = vec![Vec::new(); PARTS * PARTS];
        self.edges(|place, a, b| {
            if (a - b).abs() > STEEP * steepest {
                all.push(f32::midpoint(a, b));
                parts[self.part(place)].push(f32::midpoint(a, b));
            }
        });
        let enough = ENOUGH * all.len() as f32 / parts.len() as f32;
        let usual = nth(&mut all, 0.5);
        let own = |part: &mut Vec<f32>| {
            if part.len() as f32 > enough {
                nth(part, 0.5)
            } else {
                usual
            }
        };
        parts.iter_mut().map(own).collect()
    }

    /// How far the two sides of the steepest edges differ, where that says something.
    fn steepest(&self) -> Option<f32> {
        // all that is even is only counted
        let (mut count, mut steep) = (0_usize, Vec::new());
        self.edges(|_, a, b| {
            count += 1;
            let off = (a - b).abs();
            if off >= LEAST {
                steep.push(off);
            }
        });
        let last = count.checked_sub(1)?;
        let steeper = last - index((1.0 - BEYOND) * last as f64);
        let place = steep.len().checked_sub(steeper + 1)?;
        Some(*steep.select_nth_unstable_by(place, f32::total_cmp).1)
    }

    /// What may be an edge, across and down: a place and the levels of both sides.
    fn edges(&self, mut tell: impl FnMut((usize, usize), f32, f32)) {
        for y in (0..self.height).step_by(self.step) {
            let row = &self.ink[y * self.width..][..self.width];
            let right = row.get(EDGE_PX..).unwrap_or_default();
            let below = self.ink.get((y + EDGE_PX) * self.width..);
            for other in [right, below.unwrap_or_default()] {
                let pairs = row.len().min(other.len());
                for x in (0..pairs).step_by(self.step) {
                    tell((x, y), row[x], other[x]);
                }
            }
        }
    }

    /// Whether what is light is a page that dark surrounds, rather than ink.
    fn shows_page(&self) -> bool {
        let block = (self.width.min(self.height) / BLOCKS.0).max(BLOCKS.1);
        let (columns, rows) = (self.width / block, self.height / block);
        let count = columns * rows;
        let dark_share = |i: usize| {
            let (x0, y0) = (i % columns * block, i / columns * block);
            let pixels = (y0..y0 + block).flat_map(|y| (x0..x0 + block).map(move |x| (x, y)));
            let dark = pixels.filter(|p| self.is_dark(*p)).count();
            dark as f32 / (block * block) as f32
        };
        let shares: Vec<f32> = (0..count).map(dark_share).collect();
        let light = |i: usize| shares[i] < 0.5;
        let region = regions(count, columns, |a, b| light(a) == light(b));
        let mut sizes = vec![0; count];
        (0..count)
            .filter(|&i| light(i))
            .for_each(|i| sizes[region[i]] += 1);
        let largest = (0..count).max_by_key(|&i| sizes[i]);
        let Some(largest) = largest.filter(|&i| sizes[i] > 0) else {
            return false;
        };
        let page = with_holes(&region, largest, columns);
        let size = page.iter().filter(|i| **i).count();
        size as f32 >= PAGE * count as f32
            && fill(&page, columns) >= FILL
            && pieces(&page, &shares, columns) >= PIECES
    }
}

/// The level below which this share of them lies; 0 of none.
fn nth(levels: &mut [f32], share: f64) -> f32 {
    quantile(levels, share, f32::total_cmp).unwrap_or(0.0)
}

/// The share of the narrowest rectangle around some blocks that they fill.
fn fill(blocks: &[bool], columns: usize) -> f64 {
    let inside = || (0..blocks.len()).filter(|&i| blocks[i]);
    let places: Vec<(f64, f64)> = inside()
        .map(|i| ((i % columns) as f64, (i / columns) as f64))
        .collect();
    let filled = |degrees: u32| {
        let (s, c) = libm::sincos(f64::from(degrees).to_radians());
        let length = |of: &dyn Fn(&(f64, f64)) -> f64| {
            let none = (f64::INFINITY, f64::NEG_INFINITY);
            let ends = places.iter().map(of);
            let (low, high) = ends.fold(none, |(a, b), v| (a.min(v), b.max(v)));
            high - low + s + c
        };
        places.len() as f64 / (length(&|p| p.0 * c + p.1 * s) * length(&|p| p.1 * c - p.0 * s))
    };
    (0..90).step_by(3).map(filled).fold(0.0, f64::max)
}

/// How many pieces of ink lie on a page and do not reach its edge.
fn pieces(page: &[bool], dark_share: &[f32], columns: usize) -> usize {
    let count = page.len();
    let inked = |i: usize| page[i] && dark_share[i] >= INKED;
    let region = regions(count, columns, |a, b| inked(a) && inked(b));
    let mut within = vec![false; count];
    (0..count)
        .filter(|&i| inked(i))
        .for_each(|i| within[region[i]] = true);
    for i in (0..count).filter(|&i| inked(i)) {
        let mut near = beside(i, columns, count);
        within[region[i]] &= near.all(|b| page[b]);
    }
    within.iter().filter(|w| **w).count()
}
