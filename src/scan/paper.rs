//! Where the paper lies in a picture that shows more than it: a table, a hand, the scanner's lid.
//!
//! Light changes slowly on paper and at once where it ends. Blocks whose paper levels hardly differ from their
//! neighbours' grow together; of these regions the one that is large and light, with the holes in it, is the page.

use crate::numeric::pieces::around;
use kurbo::{Point, Rect};

/// Neighbouring blocks of one sheet of paper differ by less than this, of black against white.
const STEP: f32 = 0.03;
/// And their shares of red and blue light by less than this, of all light, where a corner of the page is as dark as the
/// table.
const HUE: f32 = 0.012;
/// The page covers at least this share of the picture.
const LEAST: f64 = 0.1;
/// A page that covers more than this share of the picture is all of it: the rest are corners and punched holes.
const MOST: f64 = 0.97;

/// Blocks beyond the page's end by which the light is smoothed there, and those of the end itself.
const RIM: usize = 4;

/// The blocks that show the page.
#[derive(Debug, Clone)]
pub(super) struct Paper {
    block: usize,
    columns: usize,
    inside: Vec<bool>,
    /// Share of the picture that it covers.
    pub(super) share: f64,
}

impl Paper {
    /// Finds the page among a picture's blocks by their paper levels, or, where these do not part it from what lies
    /// beside it, by `hues`, too, their shares of red and of blue light, which a grey picture has not; `None` where the
    /// picture shows nothing else, or no region is large enough to be a page.
    pub(super) fn find(
        levels: &[f32],
        hues: impl FnOnce() -> Option<Vec<[f32; 2]>>,
        columns: usize,
        block: usize,
    ) -> Option<Self> {
        let is_level = |a: usize, b: usize| (levels[a] - levels[b]).abs() < STEP;
        let page = |regions: Vec<usize>| {
            let inside = lightest(&regions, levels, columns)?;
            let share = inside.iter().filter(|i| **i).count() as f64 / levels.len() as f64;
            (LEAST..MOST).contains(&share).then_some(Self {
                block,
                columns,
                inside,
                share,
            })
        };
        page(regions(levels.len(), columns, is_level)).or_else(|| {
            let hues = hues()?;
            let is_hue = |a: usize, b: usize| (0..2).all(|i| (hues[a][i] - hues[b][i]).abs() < HUE);
            let is_alike = |a, b| is_level(a, b) && is_hue(a, b);
            page(regions(levels.len(), columns, is_alike))
        })
    }

    /// The left and right edges of the page where the picture shows them and they are straight: where each meets the
    /// picture's upper edge, px, and how far it runs to the right for each px down.
    pub(super) fn sides(&self) -> Option<[(f64, f64); 2]> {
        let block = self.block as f64;
        let rows = self.inside.chunks(self.columns.max(1)).enumerate();
        let ends = rows.filter_map(|(y, row)| {
            let (first, last) = (row.iter().position(|i| *i)?, row.iter().rposition(|i| *i)?);
            let seen = first > 0 && last + 1 < row.len();
            let middle = (y as f64 + 0.5) * block;
            Some(seen.then_some((middle, first as f64 * block, (last + 1) as f64 * block)))
        });
        let ends: Option<Vec<(f64, f64, f64)>> = ends.collect();
        let ends = ends?;
        let of = |x: fn(&(f64, f64, f64)) -> f64| -> Vec<(f64, f64)> {
            ends.iter().map(|e| (e.0, x(e))).collect()
        };
        Some([line(&of(|e| e.1), block)?, line(&of(|e| e.2), block)?])
    }

    /// What lies along the page's end outside of it: where a lid's level is smoothed into the page's.
    pub(super) fn rim(&self) -> Self {
        let (columns, inside) = (self.columns, &self.inside);
        let rows = inside.len() / columns.max(1);
        let beside =
            |i: usize| around((i % columns, i / columns), RIM, (columns, rows)).any(|j| inside[j]);
        let rim = (0..inside.len()).map(|i| !inside[i] && beside(i));
        let rim: Vec<bool> = rim.collect();
        let share = rim.iter().filter(|r| **r).count() as f64 / rim.len().max(1) as f64;
        Self {
            block: self.block,
            columns,
            inside: rim,
            share,
        }
    }

    /// The rectangle around it, px; it can reach beyond the picture.
    pub(super) fn bounds(&self) -> Rect {
        let block = self.block as f64;
        let own = (0..self.inside.len()).filter(|&i| self.inside[i]);
        let blocks = own.map(|i| {
            let (x, y) = (i % self.columns, i / self.columns);
            let corner = Point::new(x as f64 * block, y as f64 * block);
            Rect::from_origin_size(corner, (block, block))
        });
        blocks.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
    }

    /// Side of a block, px.
    pub(super) const fn block_px(&self) -> f64 {
        self.block as f64
    }

    /// Whether the pixel in column `x` of row `y` is on the page.
    pub(super) fn holds(&self, x: usize, y: usize) -> bool {
        let i = y / self.block * self.columns + x / self.block;
        self.inside.get(i).copied().unwrap_or(false)
    }
}

/// Share of the rows of blocks in which an edge must lie on its line, and how far off it may, blocks.
const STRAIGHT: (f64, f64) = (0.8, 0.8);

/// The straight line x = a + b y through most of the points (y, x).
fn line(points: &[(f64, f64)], block: f64) -> Option<(f64, f64)> {
    let fit = |part: &[(f64, f64)]| {
        let n = part.len() as f64;
        let mean = |of: fn(&(f64, f64)) -> f64| part.iter().map(of).sum::<f64>() / n;
        let (y, x) = (mean(|p| p.0), mean(|p| p.1));
        let (xy, yy) = part.iter().fold((0.0, 0.0), |(xy, yy), p| {
            (xy + (p.0 - y) * (p.1 - x), yy + (p.0 - y).powi(2))
        });
        (x - xy / yy * y, xy / yy)
    };
    let near = |(a, b): (f64, f64), reach: f64| -> Vec<(f64, f64)> {
        let off = |p: &&(f64, f64)| (p.1 - a - b * p.0).abs() < reach * block;
        points.iter().filter(off).copied().collect()
    };
    if points.len() < 8 {
        return None;
    }
    let part = near(fit(points), 3.0);
    let line = fit(if part.len() < 8 { points } else { &part });
    let on = near(line, STRAIGHT.1);
    let fine = on.len() as f64 >= STRAIGHT.0 * points.len() as f64;
    fine.then(|| fit(&on)).filter(|l| l.1.is_finite())
}

/// The blocks of the region that is large and light, and of the holes in it.
fn lightest(regions: &[usize], levels: &[f32], columns: usize) -> Option<Vec<bool>> {
    let mut light = vec![0.0f32; levels.len()];
    for (&r, level) in regions.iter().zip(levels) {
        light[r] += (1.0 - level).powi(2);
    }
    let page = (0..levels.len()).max_by(|&a, &b| light[a].total_cmp(&light[b]))?;
    Some(with_holes(regions, page, columns))
}

/// The blocks of one region and of the holes in it.
pub(super) fn with_holes(regions: &[usize], one: usize, columns: usize) -> Vec<bool> {
    let outside: Vec<bool> = regions.iter().map(|&r| r != one).collect();
    let count = outside.len();
    let holes = self::regions(count, columns, |a, b| outside[a] && outside[b]);
    let mut reach_edge = vec![false; count];
    for (i, &hole) in holes.iter().enumerate() {
        reach_edge[hole] |= is_outermost(i, columns, count);
    }
    let inside = |i: usize| !outside[i] || !reach_edge[holes[i]];
    (0..count).map(inside).collect()
}

/// Whether one of `count` blocks, or pixels, in rows of `columns` lies at the edge.
pub(super) fn is_outermost(i: usize, columns: usize, count: usize) -> bool {
    let (x, y) = (i % columns, i / columns);
    x == 0 || y == 0 || x + 1 == columns || y + 1 == count / columns
}

/// The blocks to the left and right of one of `count` in rows of `columns`, above and below it.
pub(super) fn beside(i: usize, columns: usize, count: usize) -> impl Iterator<Item = usize> {
    let left = (!i.is_multiple_of(columns)).then(|| i - 1);
    let right = (!(i + 1).is_multiple_of(columns)).then_some(i + 1);
    let up = i.checked_sub(columns);
    let down = Some(i + columns).filter(|&d| d < count);
    [left, right, up, down].into_iter().flatten()
}

/// The region of each of `count` blocks in rows of `columns`: neighbours that are `alike` share one.
pub(super) fn regions(
    count: usize,
    columns: usize,
    alike: impl Fn(usize, usize) -> bool,
) -> Vec<usize> {
    let mut region: Vec<usize> = vec![usize::MAX; count];
    let mut stack = Vec::new();
    for first in 0..count {
        if region[first] != usize::MAX {
            continue;
        }
        region[first] = first;
        stack.push(first);
        while let Some(i) = stack.pop() {
            for next in beside(i, columns, count) {
                if region[next] == usize::MAX && alike(i, next) {
                    region[next] = first;
                    stack.push(next);
                }
            }
        }
    }
    region
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::ops::Range;

    /// Levels of 30 × 20 blocks: a page in these columns and rows, shaded from left to right, on a dark table, and a
    /// blot on the page.
    fn table(across: Range<usize>, down: Range<usize>) -> Vec<f32> {
        let level = |i: usize| {
            let (x, y) = (i % 30, i / 30);
            let page = across.contains(&x) && down.contains(&y);
            let blot = (8..11).contains(&x) && (5..8).contains(&y);
            match (page, blot) {
                (true, false) => 0.05 + 0.01 * x as f32,
                (true, true) => 0.9,
                (false, _) => 0.6 + 0.1 * ((7 * x + 5 * y) % 3) as f32,
            }
        };
        (0..600).map(level).collect()
    }

    /// The page among grey blocks, 10 px wide.
    fn found(levels: &[f32], columns: usize) -> Option<Paper> {
        Paper::find(levels, || None, columns, 10)
    }

    #[test]
    fn a_page_on_a_table_as_light_as_it_is_told_by_its_hue() {
        let levels = vec![0.3; 600];
        assert!(found(&levels, 30).is_none());
        let hue = |i: usize| {
            let page = (3..22).contains(&(i % 30)) && (2..19).contains(&(i / 30));
            if page { [0.33, 0.34] } else { [0.41, 0.28] }
        };
        let hues: Vec<[f32; 2]> = (0..600).map(hue).collect();
        let page = Paper::find(&levels, || Some(hues), 30, 10).unwrap();
        assert!(page.holds(35, 25) && !page.holds(25, 25) && !page.holds(225, 100));
    }

    #[test]
    fn a_page_on_a_table_is_told_from_it() {
        let paper = found(&table(3..22, 2..19), 30).unwrap();
        assert!(paper.holds(35, 25) && paper.holds(215, 185) && paper.holds(95, 65));
        assert!(!paper.holds(25, 25) && !paper.holds(225, 100) && !paper.holds(299, 199));
        assert!(!paper.holds(5000, 5000));
    }

    #[test]
    fn the_sides_of_a_page_are_lines() {
        let level = |i: usize| {
            let (x, y) = (i % 60, i / 60);
            // a page that grows wider towards its foot
            let page = (20 - y / 5..35 + y / 4).contains(&x) && (2..38).contains(&y);
            if page { 0.05 } else { 0.7 }
        };
        let levels: Vec<f32> = (0..2400).map(level).collect();
        let [left, right] = found(&levels, 60).unwrap().sides().unwrap();
        assert!(
            (left.1 + 0.2).abs() < 0.02 && (left.0 - 204.0).abs() < 8.0,
            "{left:?}"
        );
        assert!(
            (right.1 - 0.25).abs() < 0.02 && (right.0 - 346.0).abs() < 8.0,
            "{right:?}"
        );
    }

    #[test]
    fn a_page_that_fills_its_picture_needs_no_telling() {
        assert!(found(&table(0..30, 0..20), 30).is_none());
        assert!(found(&[], 0).is_none());
    }
}
