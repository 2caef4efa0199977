//! The light that falls on a page: how dark its paper looks, all over it.
//!
//! It is the paper's level of each block, opened by a window wider than strokes. Strokes that are wider stay dark in
//! it; they are told from shadows by being as dark as ink and not reaching the picture's edge.

use super::paper::{Paper, beside, is_outermost, regions};
use crate::numeric::median::quantile;
use crate::types::{Colours, Gray};
use rayon::prelude::*;
use std::cmp::Reverse;

/// Blocks along the shorter side of a page: shadows are wider than 1/100 of it.
const BLOCKS: usize = 100;
/// Sides that a block may have, px: enough samples for a percentile, and not more than a shadow's width.
const BLOCK_PX: (usize, usize) = (8, 64);
/// Percentile of a block's samples that is paper even where three quarters of it are ink.
const PAPER: f64 = 0.25;
/// Half the window, blocks, of the opening that removes ink: most strokes are thinner than twice this.
const OPENING: usize = 3;
/// What lies between lighter blocks is ink where it sends back less than this share of the light that they do.
const INK: f32 = 0.5;
/// It is all that is darker than the light which reaches it by as much, of black against white.
const DARKER: f32 = 0.05;

/// The paper's level all over the page: a value a block, bilinear between their centres.
pub(super) struct Field {
    block: usize,
    columns: usize,
    values: Vec<f32>,
}

impl Field {
    pub(super) fn measure(gray: &Gray) -> Self {
        let (w, h) = (gray.width(), gray.height());
        let block = (w.min(h) / BLOCKS).clamp(BLOCK_PX.0, BLOCK_PX.1);
        let (columns, rows) = (w.div_ceil(block).max(1), h.div_ceil(block).max(1));
        // every second sample of every second row of a large block says enough
        let step = if block >= 4 * BLOCK_PX.0 { 2 } else { 1 };
        let level = |i: usize| {
            let (x0, y0) = (i % columns * block, i / columns * block);
            let rows = (y0..(y0 + block).min(h)).step_by(step);
            let cut = |y| gray.row(y).get(x0..(x0 + block).min(w)).unwrap_or(&[]);
            let mut all: Vec<f32> = rows
                .flat_map(|y| cut(y).iter().step_by(step))
                .copied()
                .collect();
            quantile(&mut all, PAPER, f32::total_cmp).unwrap_or(0.0)
        };
        let values = (0..columns * rows).into_par_iter().map(level).collect();
        let mut field = Self {
            block,
            columns,
            values,
        };
        field.filter(f32::min);
        field.filter(f32::max);
        field.leave_ink_out();
        field.smooth();
        field
    }

    /// Where the picture shows more than a page, the blocks of the page; `colours` are the picture's.
    pub(super) fn paper(&self, colours: Option<&Colours>) -> Option<Paper> {
        let hues = || -> Option<Vec<[f32; 2]>> {
            let all = (0..self.values.len()).into_par_iter();
            colours.map(|c| all.map(|i| self.hue(c, i)).collect())
        };
        Paper::find(&self.values, hues, self.columns, self.block)
    }

    /// The shares of red and of blue in the light of a block's lighter half.
    fn hue(&self, colours: &Colours, i: usize) -> [f32; 2] {
        let (x0, y0) = (i % self.columns * self.block, i / self.columns * self.block);
        let places = |from: usize| (from..from + self.block).step_by(colours.block.max(1));
        let all = places(y0).flat_map(|y| places(x0).map(move |x| (x, y)));
        let lights = all.map(|(x, y)| colours.at(x, y).map(|v| u32::from(u8::MAX - v)));
        let mut lights: Vec<[u32; 3]> = lights.collect();
        lights.sort_unstable_by_key(|light| Reverse(light.iter().sum::<u32>()));
        let lighter = &lights[..lights.len().div_ceil(2)];
        let of = |part: usize| lighter.iter().map(|light| light[part]).sum::<u32>() as f32;
        let [red, green, blue] = [of(0), of(1), of(2)];
        let whole = (red + green + blue).max(1.0);
        [red / whole, blue / whole]
    }

    /// Ink that is wider than the opening's window gets the level of the paper on its four sides, the nearer the
    /// more.
    fn leave_ink_out(&mut self) {
        let reached = self.reached();
        let dark = |i: usize| self.values[i] > reached[i] + DARKER;
        let regions = regions(reached.len(), self.columns, |a, b| dark(a) && dark(b));
        let mut ink = vec![false; reached.len()];
        for (i, &region) in regions.iter().enumerate() {
            ink[region] |= dark(i) && 1.0 - self.values[i] < INK * (1.0 - reached[i]);
        }
        let is_ink = |i: usize| ink[regions[i]];
        let lit = |i: usize| {
            let (mut sum, mut weights) = (0.0, 0.0);
            for (on, back) in [(1, 0), (0, 1), (self.columns, 0), (0, self.columns)] {
                let (mut at, mut steps) = (i, 0.0);
                // it ends: no such ink reaches the edge
                while is_ink(at) {
                    (at, steps) = (at + on - back, steps + 1.0);
                }
                sum += self.values[at] / steps;
                weights += 1.0 / steps;
            }
            sum / weights
        };
        let inked = (0..regions.len()).filter(|&i| is_ink(i));
        let lit: Vec<(usize, f32)> = inked.map(|i| (i, lit(i))).collect();
        for (i, level) in lit {
            self.values[i] = level;
        }
    }

    /// The darkest level, at most its own, at which each block can be come to from the picture's edge: that of the
    /// lightest block on the darkest way.
    fn reached(&self) -> Vec<f32> {
        let (count, columns) = (self.values.len(), self.columns);
        let mut reached = vec![f32::NEG_INFINITY; count];
        for (i, level) in reached.iter_mut().enumerate() {
            if is_outermost(i, columns, count) {
                *level = self.values[i];
            }
        }
        let mut settled = false;
        while !settled {
            settled = true;
            for i in (0..count).chain((0..count).rev()) {
                let ways = beside(i, columns, count).map(|b| reached[b]);
                let level = ways.fold(reached[i], f32::max).min(self.values[i]);
                settled &= level <= reached[i];
                reached[i] = level;
            }
        }
        reached
    }

    /// A window of 2·[`OPENING`] + 1 blocks in both directions, reduced by `pick`.
    fn filter(&mut self, pick: fn(f32, f32) -> f32) {
        self.separable(|line, i| {
            let window = &line[i.saturating_sub(OPENING)..(i + OPENING + 1).min(line.len())];
            window.iter().copied().reduce(pick).unwrap_or(0.0)
        });
    }

    fn smooth(&mut self) {
        self.separable(|line, i| {
            let window = &line[i.saturating_sub(1)..(i + 2).min(line.len())];
            window.iter().sum::<f32>() / window.len() as f32
        });
    }

    fn separable(&mut self, at: impl Fn(&[f32], usize) -> f32) {
        let columns = self.columns;
        let pass = |line: &[f32]| -> Vec<f32> { (0..line.len()).map(|i| at(line, i)).collect() };
        for line in self.values.chunks_mut(columns) {
            line.copy_from_slice(&pass(line));
        }
        for x in 0..columns {
            let line: Vec<f32> = self
                .values
                .iter()
                .skip(x)
                .step_by(columns)
                .copied()
                .collect();
            let cells = self.values.iter_mut().skip(x).step_by(columns);
            cells.zip(pass(&line)).for_each(|(v, new)| *v = new);
        }
    }

    /// The field at the blocks' centres along pixel row `y`.
    pub(super) fn row(&self, y: usize, out: &mut Vec<f32>) {
        let rows = self.values.len() / self.columns;
        let (a, b, t) = self.between(y, rows);
        let line = |r: usize| &self.values[r * self.columns..(r + 1) * self.columns];
        out.clear();
        out.extend(line(a).iter().zip(line(b)).map(|(p, q)| p + (q - p) * t));
    }

    /// One value a pixel from the values at the blocks' centres.
    pub(super) fn along<'a>(&'a self, row: &'a [f32]) -> impl Iterator<Item = f32> + 'a {
        let half = self.block / 2;
        let step = 1.0 / self.block as f32;
        let ends = |i: usize| (row[i.saturating_sub(1)], row[i.min(row.len() - 1)]);
        // stretch i lies between the centres of blocks i − 1 and i
        (0..=row.len()).flat_map(move |i| {
            let (p, q) = ends(i);
            let (from, to) = if i == 0 {
                (self.block - half, self.block)
            } else {
                (0, self.block)
            };
            (from..to).map(move |k| p + (q - p) * (k as f32 + 0.5) * step)
        })
    }

    fn between(&self, at: usize, count: usize) -> (usize, usize, f32) {
        let shifted = at + self.block - self.block / 2;
        let (i, k) = (shifted / self.block, shifted % self.block);
        let t = (k as f32 + 0.5) / self.block as f32;
        (i.saturating_sub(1).min(count - 1), i.min(count - 1), t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of 420 × 240 px whose light falls off to the right, and of it a square of 180 px with a counter of
    /// 40 px in it that sends back `left` of the light.
    fn square(left: f32) -> Gray {
        let sample = |i: usize| {
            let (x, y) = (i % 420, i / 420);
            let square = (120..300).contains(&x) && (30..210).contains(&y);
            let counter = (190..230).contains(&x) && (100..140).contains(&y);
            let light = 0.9 - x as f32 * 0.001;
            1.0 - light * if square && !counter { left } else { 1.0 }
        };
        Gray::new(420, 240, (0..420 * 240).map(sample).collect()).unwrap()
    }

    /// How dark the paper looks at a pixel.
    fn level(gray: &Gray, x: usize, y: usize) -> f32 {
        let (field, mut row) = (Field::measure(gray), Vec::new());
        field.row(y, &mut row);
        field.along(&row).nth(x).unwrap()
    }

    #[test]
    fn ink_wider_than_any_stroke_is_no_shadow() {
        for (x, y) in [
            (150, 60),
            (210, 65),
            (280, 190),
            (210, 120),
            (60, 120),
            (400, 20),
        ] {
            let light = 1.0 - (0.9 - x as f32 * 0.001);
            let level = level(&square(0.1), x, y);
            assert!((level - light).abs() < 0.04, "{x} {y}: {level} for {light}");
        }
    }

    #[test]
    fn a_stain_and_what_reaches_the_edge_are_no_ink() {
        // a stain keeps its level, but for its rim
        let stain = level(&square(0.7), 210, 65);
        assert!(stain > 0.3, "{stain}");
        // darker than black, as a picture that was sharpened may be
        let table = |i: usize| if i % 420 < 100 { 1.1 } else { 0.1 };
        let gray = Gray::new(420, 240, (0..420 * 240).map(table).collect()).unwrap();
        assert!(level(&gray, 40, 120) > 0.9);
    }
}
