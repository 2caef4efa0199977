//! Connected ink: runs along rows, joined where they touch, also at their corners.

use crate::numeric::cast::index;
use crate::numeric::sets::Sets;
use crate::numeric::surface::Surface;
use crate::types::Gray;
use kurbo::{Affine, Point, Rect};
use rayon::prelude::*;
use std::iter;

/// Coverage from which connected ink counts: below the half level, so that thin strokes hold together, and above
/// printed guides in a light colour.
pub(super) const LOW: f32 = 0.33;
/// Coverage that a piece of ink must reach somewhere.
pub(super) const SEED: f32 = 0.5;

/// Ink from column `start` to before `end` of row `y`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Run {
    pub(super) y: usize,
    pub(super) start: usize,
    pub(super) end: usize,
}

impl Run {
    /// Column and row of its pixels.
    pub(super) fn pixels(self) -> impl Iterator<Item = (usize, usize)> {
        (self.start..self.end).map(move |x| (x, self.y))
    }

    /// Its stretches outside and inside of something, and whether each is inside.
    fn cut(self, inside: impl Fn(usize, usize) -> bool) -> impl Iterator<Item = (bool, Self)> {
        let mut start = self.start;
        iter::from_fn(move || {
            let side = (start < self.end).then(|| inside(start, self.y))?;
            let end = (start + 1..self.end).find(|&x| inside(x, self.y) != side);
            let end = end.unwrap_or(self.end);
            let run = Self { start, end, ..self };
            start = end;
            Some((side, run))
        })
    }
}

/// One connected piece of ink.
#[derive(Debug, Clone)]
pub(super) struct Component {
    /// In order of rows, then columns.
    pub(super) runs: Vec<Run>,
    /// px².
    pub(super) area: usize,
    /// Of them, those of at least half coverage.
    full: usize,
    /// Rectangle in the sheet's picture, px.
    pub(super) bounds: Rect,
    /// The rectangle around its half coverage in the upright page, px.
    pub(super) upright: Rect,
    /// Centre of gravity in the upright page, px.
    pub(super) centre: Point,
    /// Pixels of which only a share is its, where its edge runs beneath another letter's ink: column, row and share.
    pub(super) shares: Vec<(usize, usize, f32)>,
}

impl Component {
    fn new(runs: Vec<Run>, full: usize) -> Self {
        let mut new = Self {
            area: runs.iter().map(|r| r.end - r.start).sum(),
            full,
            bounds: Rect::ZERO,
            upright: Rect::ZERO,
            centre: Point::ORIGIN,
            shares: Vec::new(),
            runs,
        };
        let rows = new.runs.iter().map(|r| r.y as f64);
        let (top, bottom) = (rows.clone().reduce(f64::min), rows.reduce(f64::max));
        let left = new.runs.iter().map(|r| r.start).min().unwrap_or(0);
        let right = new.runs.iter().map(|r| r.end).max().unwrap_or(0);
        let ends = (top.unwrap_or(0.0), bottom.unwrap_or(0.0) + 1.0);
        new.bounds = Rect::new(left as f64, ends.0, right as f64, ends.1);
        new.stand(&Affine::IDENTITY.into());
        new
    }

    /// How far its edge lies outside the line of half coverage, px.
    fn rim(&self) -> f64 {
        (1.0 - self.full as f64 / self.area.max(1) as f64).max(0.0) * self.stroke() / 2.0
    }

    /// Measures it on the upright page that `upright` maps the sheet's picture to.
    pub(super) fn stand(&mut self, upright: &Surface) {
        // boxes around the pixels' centres, half a pixel wider: turned corners would widen every box
        let ends = self
            .runs
            .iter()
            .flat_map(|r| [(r.start, r.y), (r.end - 1, r.y)]);
        let centres = ends.map(|(x, y)| upright.at(Point::new(x as f64 + 0.5, y as f64 + 0.5)));
        let boxes = centres.map(|p| Rect::from_points(p, p).inflate(0.5, 0.5));
        let rim = self.rim();
        let ink = boxes.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO);
        self.upright = if ink.size().min_side() > 4.0 * rim {
            ink.inset(-rim)
        } else {
            ink
        };
        let weigh = |(sum, n): (Point, f64), r: &Run| {
            let length = (r.end - r.start) as f64;
            let middle = Point::new((r.start + r.end) as f64 / 2.0, r.y as f64 + 0.5);
            (sum + middle.to_vec2() * length, n + length)
        };
        let (sum, n) = self.runs.iter().fold((Point::ORIGIN, 0.0), weigh);
        self.centre = upright.at((sum.to_vec2() / n.max(1.0)).to_point());
    }

    /// Rough width of its stroke, px: twice the area over the length of its edge.
    pub(super) fn stroke(&self) -> f64 {
        let sides = 2 * self.runs.len();
        let covered: usize = pairs(&self.runs)
            .map(|(a, b)| a.end.min(b.end) - a.start.max(b.start))
            .sum();
        let flats = 2 * (self.area - covered.min(self.area));
        2.0 * self.area as f64 / ((sides.max(flats) + sides.min(flats) / 2) as f64).max(1.0)
    }

    /// Whether a pixel is its.
    pub(super) fn covers(&self, x: usize, y: usize) -> bool {
        let after = self.runs.partition_point(|r| (r.y, r.start) <= (y, x));
        let before = after.checked_sub(1).map(|i| self.runs[i]);
        before.is_some_and(|r| r.y == y && x < r.end)
    }

    /// Column and row of all its pixels.
    pub(super) fn pixels(&self) -> impl Iterator<Item = (usize, usize)> {
        self.runs.iter().copied().flat_map(Run::pixels)
    }

    /// The pieces into which a border through its pixels cuts it.
    pub(super) fn parted(&self, inside: impl Fn(usize, usize) -> bool) -> Vec<Self> {
        let sides = self.sides(inside);
        if sides.iter().any(Vec::is_empty) {
            return vec![self.clone()];
        }
        sides.iter().flat_map(|runs| self.pieces(runs)).collect()
    }

    /// The pieces that are left without some of its pixels.
    pub(super) fn without(&self, gone: impl Fn(usize, usize) -> bool) -> Vec<Self> {
        let [left, _] = self.sides(gone);
        self.pieces(&left)
    }

    /// The pieces of what is left where only a share of each pixel is.
    pub(super) fn shared(&self, share: impl Fn(usize, usize) -> f32) -> Vec<Self> {
        let of = |(x, y): (usize, usize)| (x, y, share(x, y));
        let some = self.pixels().map(of).filter(|p| p.2 < 1.0);
        let shares: Vec<(usize, usize, f32)> = some.collect();
        let mut pieces = self.without(|x, y| share(x, y) <= 0.0);
        pieces.iter_mut().for_each(|p| p.take(&shares));
        pieces
    }

    /// Takes what shares are its.
    fn take(&mut self, shares: &[(usize, usize, f32)]) {
        let own = shares.iter().filter(|(x, y, _)| self.covers(*x, *y));
        self.shares = own.copied().collect();
    }

    /// Its runs outside and inside of something.
    fn sides(&self, inside: impl Fn(usize, usize) -> bool) -> [Vec<Run>; 2] {
        let mut sides = [Vec::new(), Vec::new()];
        for (side, run) in self.runs.iter().flat_map(|r| r.cut(&inside)) {
            sides[usize::from(side)].push(run);
        }
        sides
    }

    /// Connected pieces of some of its runs.
    fn pieces(&self, runs: &[Run]) -> Vec<Self> {
        let full = self.full as f64 / self.area.max(1) as f64;
        let groups = group(runs, Touch::Corners).into_iter();
        let pieces = groups.map(|g| {
            let runs: Vec<Run> = g.into_iter().map(|i| runs[i]).collect();
            let area: usize = runs.iter().map(|r| r.end - r.start).sum();
            let mut piece = Self::new(runs, index(full * area as f64));
            piece.take(&self.shares);
            piece
        });
        pieces.collect()
    }

    /// Whether less than `reach` px of paper lies between its ink and another piece's.
    pub(super) fn is_near(&self, other: &Self, reach: f64) -> bool {
        self.distances(other, reach).any(|d| d < reach)
    }

    /// The paper between its ink and another piece's, px, where that is less than `reach`.
    pub(super) fn paper_to(&self, other: &Self, reach: f64) -> Option<f64> {
        let near = self.distances(other, reach).filter(|d| *d < reach);
        near.min_by(f64::total_cmp)
    }

    /// The paper between its runs and another piece's that lie no more than `reach` px higher or lower, px.
    fn distances<'a>(&'a self, other: &'a Self, reach: f64) -> impl Iterator<Item = f64> + 'a {
        let rows = index(reach) + 1;
        self.runs.iter().flat_map(move |a| {
            let first = a.y.saturating_sub(rows);
            let near = &other.runs[other.runs.partition_point(|r| r.y < first)..];
            let near = near.iter().take_while(move |b| b.y <= a.y + rows);
            near.map(move |b| {
                let across = a.start.max(b.start).saturating_sub(a.end.min(b.end));
                let down = a.y.abs_diff(b.y).saturating_sub(1);
                (across as f64).hypot(down as f64)
            })
        })
    }

    /// The pieces of it whose runs' middles lie inside a rectangle of the upright page.
    pub(super) fn within(&self, upright: &Surface, area: Rect) -> Vec<Self> {
        let back = upright.inverse().bounds(area);
        let clip = |r: &Run| {
            let (start, end) = (r.start.max(index(back.x0)), r.end.min(index(back.x1)));
            let middle = upright.at(Point::new((start + end) as f64 / 2.0, r.y as f64 + 0.5));
            (start < end && area.contains(middle)).then_some(Run { y: r.y, start, end })
        };
        let runs: Vec<Run> = self.runs.iter().filter_map(clip).collect();
        let mut pieces = self.pieces(&runs);
        pieces.iter_mut().for_each(|p| p.stand(upright));
        pieces
    }
}

/// Distance of two boxes, px.
pub(super) fn gap(a: Rect, b: Rect) -> f64 {
    let dx = (a.x0 - b.x1).max(b.x0 - a.x1).max(0.0);
    let dy = (a.y0 - b.y1).max(b.y0 - a.y1).max(0.0);
    dx.hypot(dy)
}

/// Pairs of boxes that are nearer to each other than either's `reach` px, found along the page's width.
pub(super) fn close(
    boxes: &[Rect],
    reach: impl Fn(usize) -> f64,
) -> impl Iterator<Item = (usize, usize)> {
    let mut order: Vec<usize> = (0..boxes.len()).collect();
    order.sort_by(|&a, &b| boxes[a].x0.total_cmp(&boxes[b].x0));
    let mut from = 0;
    let mut next = 1;
    iter::from_fn(move || {
        loop {
            let &i = order.get(from)?;
            let end = boxes[i].x1 + reach(i);
            let after = order.get(next).filter(|&&j| boxes[j].x0 < end);
            let Some(&j) = after else {
                from += 1;
                next = from + 1;
                continue;
            };
            next += 1;
            if gap(boxes[i], boxes[j]) < reach(i).min(reach(j)) {
                return Some((i, j));
            }
        }
    })
}

/// Runs of one row and of the next that overlap by at least a pixel.
fn pairs(runs: &[Run]) -> impl Iterator<Item = (Run, Run)> {
    let mut from = 0;
    runs.iter().flat_map(move |&a| {
        while runs
            .get(from)
            .is_some_and(|b| b.y < a.y + 1 || (b.y == a.y + 1 && b.end <= a.start))
        {
            from += 1;
        }
        let below = runs.get(from..).unwrap_or(&[]).iter();
        below
            .take_while(move |b| b.y == a.y + 1 && b.start < a.end)
            .map(move |&b| (a, b))
    })
}

/// Connected ink of at least `low` coverage that reaches `seed` somewhere, in order of the first run.
pub(super) fn components(gray: &Gray, low: f32, seed: f32) -> Vec<Component> {
    let rows: Vec<Vec<(Run, Coverage)>> = (0..gray.height())
        .into_par_iter()
        .map(|y| runs(gray.row(y), y, low))
        .collect();
    let (runs, coverage): (Vec<Run>, Vec<Coverage>) = rows.into_iter().flatten().unzip();
    let groups = group(&runs, Touch::Corners).into_iter();
    groups
        .filter(|g| g.iter().any(|&i| coverage[i].peak >= seed))
        .map(|g| {
            let full = g.iter().map(|&i| coverage[i].full).sum();
            Component::new(g.into_iter().map(|i| runs[i]).collect(), full)
        })
        .collect()
}

/// What a run covers: its highest coverage, and how many of its pixels are at least half covered.
#[derive(Debug, Clone, Copy)]
struct Coverage {
    peak: f32,
    full: usize,
}

/// The runs of one row.
fn runs(row: &[f32], y: usize, low: f32) -> Vec<(Run, Coverage)> {
    let mut out = Vec::new();
    let mut x = 0;
    while let Some(skip) = row[x..].iter().position(|&v| v >= low) {
        let start = x + skip;
        let length = row[start..].iter().position(|&v| v < low);
        let end = length.map_or(row.len(), |l| start + l);
        let ink = &row[start..end];
        let peak = ink.iter().copied().fold(0.0, f32::max);
        let full = ink.iter().filter(|&&v| v >= 0.5).count();
        out.push((Run { y, start, end }, Coverage { peak, full }));
        x = end;
    }
    out
}

/// What makes neighbours of two pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Touch {
    /// A common side or corner.
    Corners,
    /// A common side.
    Sides,
}

/// Connected paper that does not reach the border of a picture of `width` × `height` px.
pub(super) fn enclosed(
    (width, height): (usize, usize),
    touch: Touch,
    is_paper: impl Fn(usize, usize) -> bool,
) -> Vec<Component> {
    let rows = (0..height).map(|y| (y, 0, width));
    let runs = rows.flat_map(|(y, start, end)| Run { y, start, end }.cut(&is_paper));
    let paper: Vec<Run> = runs.filter(|r| r.0).map(|r| r.1).collect();
    let free = |r: &Run| r.start == 0 || r.end >= width || r.y == 0 || r.y + 1 >= height;
    let groups = group(&paper, touch).into_iter();
    let pieces = groups.map(|g| g.into_iter().map(|i| paper[i]).collect::<Vec<Run>>());
    let inside = pieces.filter(|runs| !runs.iter().any(free));
    inside
        .map(|runs| Component::new(runs, usize::MAX))
        .collect()
}

/// Indices of runs that touch, found along neighbouring rows.
fn group(runs: &[Run], touch: Touch) -> Vec<Vec<usize>> {
    let mut sets = Sets::new(runs.len());
    let reach = usize::from(touch == Touch::Corners);
    let mut above = 0;
    for (i, run) in runs.iter().enumerate() {
        while runs[above].y + 1 < run.y
            || (runs[above].y + 1 == run.y && runs[above].end + reach <= run.start)
        {
            above += 1;
        }
        let touching = runs[above..i]
            .iter()
            .take_while(|a| a.y < run.y && a.start < run.end + reach);
        (above..above + touching.count()).for_each(|j| sets.join(i, j));
    }
    sets.into_groups()
}
