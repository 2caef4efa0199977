//! Normal equations of a window: how the squares of what is left change with the numbers of a chain.
//!
//! A piece of an edge that moves outwards adds ink in the pixel that it runs through, as much as its length times its way,
//! and a lens spreads that. So no picture is drawn for a number: with `d` the ink that each number adds to the pixels along
//! the edges, `G` the lens, and `r` what is left,  `Jᵀr = −dᵀ G r`  and  `JᵀJ = dᵀ (Gᵀ G) d`, of which `Gᵀ G` is a product of
//! a factor a column and a factor a row. Exact but for the bend of an edge within a pixel.

use super::{
    Drawn, Window,
    numbers::{Number, nudge},
};
use crate::numeric::{
    cast::{ceiling, index},
    chain::Chain,
    coverage::{blur, kernel},
    skyline::Skyline,
};
use kurbo::{Affine, Point, Vec2};
use std::array;

/// Differences that the ways of control points are taken by, px and radians.
const DELTA: f64 = 0.01;
/// Added to each diagonal place, so that a number on which nothing depends stays where it is.
const STILL: f64 = 1e-9;

/// The matrix, and minus half of the slope.
#[derive(Debug)]
pub(super) struct Normal {
    matrix: Skyline,
    slope: Vec<f64>,
}

impl Normal {
    /// Those of a chain that leaves `now`.
    pub(super) fn new(
        window: &Window,
        chain: &Chain,
        numbers: &[(usize, Number)],
        now: &Drawn,
    ) -> Self {
        let mut out = Self {
            matrix: Skyline::default(),
            slope: vec![0.0; numbers.len()],
        };
        out.matrix.reset(&vec![0; numbers.len()]);
        (0..numbers.len()).for_each(|i| out.matrix.add(i, i, STILL));
        let ways = ways(window, chain, numbers);
        out.add_pixels(window, &ways, now);
        out.add_anchors(window, &ways, now);
        out.add_handles(window, &ways, now);
        out
    }

    /// The step of the least squares with Levenberg's damping.
    pub(super) fn step(&mut self, lambda: f64) -> Option<Vec<f64>> {
        let mut step = self.slope.clone();
        let solved = self.matrix.solve_damped(lambda, &mut step);
        solved.then_some(step)
    }

    fn add_pixels(&mut self, window: &Window, ways: &[Vec<Way>], now: &Drawn) {
        let mut inked = Inked::new(window, self.slope.len());
        for (ways, chords) in ways.iter().zip(&now.chords) {
            if !ways.is_empty() {
                inked.add(ways, chords);
            }
        }
        let light = window.light(&now.left);
        for (cell, row) in inked.rows() {
            let light = f64::from(light[inked.at(cell)]);
            let pairs = self.slope.iter_mut().zip(row);
            pairs.for_each(|(slope, ink)| *slope += ink * light);
        }
        let spread = inked.spread(window.shared());
        for ((_, ink), spread) in inked
            .rows()
            .zip(spread.chunks_exact(self.slope.len().max(1)))
        {
            // an edge's light reaches few numbers
            let zeros = spread.iter().take_while(|v| **v == 0.0).count();
            for (i, a) in ink.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                self.matrix.add_row(i, (zeros, &spread[zeros..]), *a);
            }
        }
    }

    fn add_anchors(&mut self, window: &Window, ways: &[Vec<Way>], now: &Drawn) {
        let left = &now.left[index(window.pixels())..];
        let mut grows = Vec::new();
        for ((anchor, &(segment, t)), left) in window.anchors.iter().zip(&now.feet).zip(left) {
            let weighed = anchor.weight * anchor.outward;
            let basis = bernstein(t);
            let ways = ways[segment].iter();
            grows.clear();
            grows.extend(ways.map(|w| (w.number, w.along(weighed, &basis))));
            self.add_row(&grows, f64::from(*left));
        }
    }

    fn add_handles(&mut self, window: &Window, ways: &[Vec<Way>], now: &Drawn) {
        let left = &now.left[index(window.pixels()) + window.anchors.len()..];
        let mut grows = Vec::new();
        for (ways, left) in ways.iter().zip(left.chunks_exact(4)) {
            for (k, left) in left.iter().enumerate() {
                grows.clear();
                grows.extend(ways.iter().map(|w| (w.number, w.handles[k])));
                self.add_row(&grows, f64::from(*left));
            }
        }
    }

    /// One difference that is `left`, and how much it grows with numbers in rising order.
    fn add_row(&mut self, grows: &[(usize, f64)], left: f64) {
        let moving = grows.iter().enumerate().filter(|(_, (_, a))| *a != 0.0);
        for (k, &(i, a)) in moving {
            self.slope[i] -= a * left;
            for &(j, b) in &grows[..=k] {
                self.matrix.add(i, j, a * b);
            }
        }
    }
}

/// How the control points of a segment go with a number, and what is wrong with its handles.
struct Way {
    number: usize,
    points: [Vec2; 4],
    handles: [f64; 4],
}

impl Way {
    /// How far the curve goes in a direction where the control points have those weights.
    fn along(&self, direction: Vec2, basis: &[f64; 4]) -> f64 {
        weighed(&self.points.map(|p| direction.dot(p)), basis)
    }
}

/// The sum of what control points have, by their weights.
fn weighed(values: &[f64; 4], basis: &[f64; 4]) -> f64 {
    values.iter().zip(basis).map(|(v, b)| b * v).sum()
}

/// Weights of a cubic's control points at `t`.
fn bernstein(t: f64) -> [f64; 4] {
    let s = 1.0 - t;
    [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t]
}

/// Of each segment the ways of the numbers that move it.
fn ways(window: &Window, chain: &Chain, numbers: &[(usize, Number)]) -> Vec<Vec<Way>> {
    let handles = |chain: &Chain, segment: usize| window.handles(chain, segment);
    let from: Vec<_> = (0..chain.kinds.len())
        .map(|segment| (chain.cubic(segment), handles(chain, segment)))
        .collect();
    let mut ways: Vec<Vec<Way>> = from.iter().map(|_| Vec::new()).collect();
    for (number, what) in numbers.iter().enumerate() {
        let mut moved = chain.clone();
        nudge(&mut moved, *what, DELTA);
        moved.settle();
        for (segment, ((from, before), ways)) in from.iter().zip(&mut ways).enumerate() {
            let to = moved.cubic(segment);
            let points = [
                to.p0 - from.p0,
                to.p1 - from.p1,
                to.p2 - from.p2,
                to.p3 - from.p3,
            ];
            if points == [Vec2::ZERO; 4] {
                continue;
            }
            let after = handles(&moved, segment);
            ways.push(Way {
                number,
                points: points.map(|v| v / DELTA),
                handles: array::from_fn(|k| (after[k] - before[k]) / DELTA),
            });
        }
    }
    ways
}

/// The ink that numbers add to pixels.
struct Inked {
    width: usize,
    height: usize,
    /// one more than the place of each pixel among the cells
    places: Vec<u32>,
    /// column, and row from the top
    cells: Vec<(usize, usize)>,
    /// from px of the outlines to its own, y up
    to_own: Affine,
    numbers: usize,
    values: Vec<f64>,
}

impl Inked {
    fn new(window: &Window, numbers: usize) -> Self {
        let (width, height) = (window.columns.len(), window.rows.len());
        Self {
            width,
            height,
            places: vec![0; width * height],
            cells: Vec::new(),
            to_own: window.to_own,
            numbers,
            values: Vec::new(),
        }
    }

    fn at(&self, (x, y): (usize, usize)) -> usize {
        y * self.width + x
    }

    /// Pixels that an edge runs through, and what each number adds there.
    fn rows(&self) -> impl Iterator<Item = ((usize, usize), &[f64])> {
        let rows = self.values.chunks_exact(self.numbers.max(1));
        self.cells.iter().copied().zip(rows)
    }

    /// The chords of a segment, evenly in its parameter.
    fn add(&mut self, ways: &[Way], chords: &[Point]) {
        let count = (chords.len() - 1) as f64;
        let [xx, yx, xy, yy, ..] = self.to_own.as_coeffs();
        let (mut parts, mut along) = (Vec::new(), Vec::new());
        for (k, (a, b)) in chords.iter().zip(chords.iter().skip(1)).enumerate() {
            if self.is_beyond(*a, *b) {
                continue;
            }
            let outward = Vec2::new(b.y - a.y, a.x - b.x);
            // as the outlines have it, by whose px the ways are
            let outward = Vec2::new(
                xx * outward.x + yx * outward.y,
                xy * outward.x + yy * outward.y,
            );
            along.clear();
            along.extend(
                ways.iter()
                    .map(|w| (w.number, w.points.map(|p| outward.dot(p)))),
            );
            crossings(*a, *b, (self.width, self.height), &mut parts);
            let mut from = 0.0;
            for &to in &parts {
                let (part, mid) = (to - from, (from + to) / 2.0);
                from = to;
                let p = a.lerp(*b, mid);
                let Some(row) = self.row(p) else { continue };
                let basis = bernstein((k as f64 + mid) / count);
                for (number, along) in &along {
                    row[*number] += part * weighed(along, &basis);
                }
            }
        }
    }

    /// Whether a chord lies beyond one side of the picture.
    fn is_beyond(&self, a: Point, b: Point) -> bool {
        /// px, so that rounding makes no difference
        const CLEAR_PX: f64 = 1.0;
        let axes = [(a.x, b.x, self.width), (a.y, b.y, self.height)];
        let beyond = |(a, b, size): (f64, f64, usize)| {
            let far = size as f64 + CLEAR_PX;
            (a < -CLEAR_PX && b < -CLEAR_PX) || (a > far && b > far)
        };
        axes.into_iter().any(beyond)
    }

    /// What numbers add to the pixel of a place.
    fn row(&mut self, p: Point) -> Option<&mut [f64]> {
        let inside =
            (0.0..self.width as f64).contains(&p.x) && (0.0..self.height as f64).contains(&p.y);
        if !inside {
            return None;
        }
        let cell = (index(p.x), self.height - 1 - index(p.y));
        let at = self.at(cell);
        if self.places[at] == 0 {
            self.cells.push(cell);
            self.values.resize(self.cells.len() * self.numbers, 0.0);
            self.places[at] = u32::try_from(self.cells.len()).unwrap_or(u32::MAX);
        }
        let start = (self.places[at] as usize - 1) * self.numbers;
        self.values.get_mut(start..start + self.numbers)
    }

    /// What a lens there and back makes of the values, in the same pixels.
    fn spread(&self, shared: &Shared) -> Vec<f64> {
        let n = self.numbers;
        let mut out = vec![0.0; self.values.len()];
        // an edge is moved by the few numbers of its own nodes
        let moving = |(_, row): (_, &[f64])| {
            let first = row.iter().position(|v| *v != 0.0).unwrap_or(n);
            let last = row.iter().rposition(|v| *v != 0.0).unwrap_or(n);
            (first, (last + 1).min(n))
        };
        let moving: Vec<(usize, usize)> = self.rows().map(moving).collect();
        let mut add = |to: usize, from: usize, light: f64| {
            let (first, last) = moving[from];
            let values = &self.values[from * n + first..from * n + last];
            let to = out[to * n + first..].iter_mut().zip(values);
            to.for_each(|(to, v)| *to += light * v);
        };
        let mut order: Vec<usize> = (0..self.cells.len()).collect();
        order.sort_unstable_by_key(|i| (self.cells[*i].1, self.cells[*i].0));
        for (k, &i) in order.iter().enumerate() {
            let a = self.cells[i];
            let near = |j: &&usize| self.cells[**j].1 - a.1 <= shared.reach;
            for &j in order[k..].iter().take_while(near) {
                let b = self.cells[j];
                if a.0.abs_diff(b.0) > shared.reach {
                    continue;
                }
                let light = shared.of(a, b);
                add(i, j, light);
                if i != j {
                    add(j, i, light);
                }
            }
        }
        out
    }
}

/// Parts of the way from `a` to `b` at which it enters another pixel of a picture or the picture itself, in order,
/// and in the end the whole, in place of what `out` held.
fn crossings(a: Point, b: Point, (width, height): (usize, usize), out: &mut Vec<f64>) {
    out.clear();
    for (from, to, size) in [(a.x, b.x, width), (a.y, b.y, height)] {
        let (low, high) = (from.min(to).max(0.0), from.max(to).min(size as f64));
        if low <= high {
            let lines =
                (ceiling(low)..index(high) + 1).map(|line| (line as f64 - from) / (to - from));
            out.extend(lines.filter(|part| (0.0..1.0).contains(part)));
        }
    }
    out.sort_unstable_by(f64::total_cmp);
    out.push(1.0);
}

/// How much light two pixels share: what a lens makes of the one times what it makes of the other, over all pixels
/// that count.
#[derive(Debug)]
pub(super) struct Shared {
    reach: usize,
    /// a factor for a column and one of those from it on
    columns: Vec<f64>,
    rows: Vec<f64>,
}

impl Shared {
    /// In a picture of that size of which `margin` px at each side do not count.
    pub(super) fn new((width, height): (usize, usize), margin: usize, lens: f64) -> Self {
        let kernel = kernel(lens);
        let reach = 2 * (kernel.len() - 1);
        Self {
            reach,
            columns: shared(width, margin, &kernel),
            rows: shared(height, margin, &kernel),
        }
    }

    /// Of two pixels within `reach` columns and rows of each other.
    fn of(&self, a: (usize, usize), b: (usize, usize)) -> f64 {
        let (dx, dy) = (a.0.abs_diff(b.0), a.1.abs_diff(b.1));
        let stride = self.reach + 1;
        self.columns[a.0.min(b.0) * stride + dx] * self.rows[a.1.min(b.1) * stride + dy]
    }
}

/// One axis: for each place, what it shares with itself and the next ones.
fn shared(size: usize, margin: usize, kernel: &[f32]) -> Vec<f64> {
    let radius = kernel.len() - 1;
    let weight = |x: usize, a: usize| kernel.get(x.abs_diff(a)).map_or(0.0, |k| f64::from(*k));
    let counted = margin..size.saturating_sub(margin);
    let at = |a: usize, b: usize| {
        let reached = counted.start.max(b.saturating_sub(radius))..counted.end.min(a + radius + 1);
        reached.map(|x| weight(x, a) * weight(x, b)).sum()
    };
    (0..size)
        .flat_map(|a| (0..=2 * radius).map(move |d| (a, a + d)))
        .map(|(a, b)| at(a, b))
        .collect()
}

impl Window {
    /// What is left, as far as it counts, seen through the lens once more.
    fn light(&self, left: &[f32]) -> Vec<f32> {
        let (width, m) = (self.columns.len(), self.margin);
        let mut out = vec![0.0; width * self.rows.len()];
        let inner = width.saturating_sub(2 * m);
        let lines = out.chunks_exact_mut(width.max(1)).skip(m);
        let lines = lines.take(self.rows.len().saturating_sub(2 * m));
        // of a picture as narrow as the margins no pixel counts, and what is left is the anchors'
        let pixels = left.get(..index(self.pixels())).unwrap_or_default();
        for (to, from) in lines.zip(pixels.chunks_exact(inner.max(1))) {
            to[m..m + inner].copy_from_slice(from);
        }
        blur(&mut out, width, self.lens, 0);
        out
    }

    fn shared(&self) -> &Shared {
        let size = (self.columns.len(), self.rows.len());
        self.shared
            .get_or_init(|| Shared::new(size, self.margin, self.lens))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::{angles, chain::Join, coverage::Coverage};
    use crate::refine::{curves::polygon, mend::window::numbers::numbers, residual::Residual};
    use crate::types::{Contour, Gray};
    use kurbo::BezPath;

    const SIZE: usize = 48;

    /// A ring's fill on pixels that are turned by so many degrees.
    fn drawn(ring: &[Point], lens: f64, turn_deg: f64) -> Gray {
        let middle = (SIZE as f64 / 2.0, SIZE as f64 / 2.0);
        let turn = angles::rotation_about(turn_deg.to_radians(), middle);
        let mut fill = Coverage::new(SIZE, SIZE).mapped(turn);
        fill.add(ring);
        let mut samples = fill.samples();
        blur(&mut samples, SIZE, lens, 0);
        Gray::new(SIZE, SIZE, samples)
            .unwrap()
            .with_upright(turn.inverse())
    }

    #[test]
    fn slopes_are_those_of_the_squares() {
        let read = |svg: &str| BezPath::from_svg(svg).unwrap();
        let path =
            read("M6.2 4.3L40.1 4.3C44.3 12.2 36.1 18.4 27.1 20.6L24.1 33.2L20.4 20.6L6.2 20.6Z");
        let seen =
            read("M6.2 4.3L40.3 4.3C43.9 12.6 36.9 18.6 27.4 20.1L24.5 34.1L20.2 20.9L6.2 20.6Z");
        // the smaller window has edges that leave it level, upright and aslant
        let pictures = [
            (0.0, 24.0, 0.0),
            (0.9, 24.0, 0.0),
            (0.0, 11.0, 0.0),
            (0.9, 11.0, 0.0),
            (0.0, 11.0, 1.0),
            (0.9, 11.0, 30.0),
        ];
        for (lens, reach, turn) in pictures {
            let gray = drawn(&polygon(&seen, 0.001), lens, turn);
            let ring = polygon(&path, 0.001);
            let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
            let residual = Residual::new(&gray, std::iter::once(ring.as_slice()), blur);
            let chain = Chain::from_path(&path, 0.0175).unwrap();
            let (mut part, rest) = (chain.part(1..5), chain.part(5..chain.kinds.len()));
            for i in [0, 4] {
                part.nodes[i].join = Join::End;
            }
            part.settle();
            let lines = [
                polygon(&rest.to_path(), 0.001),
                polygon(&chain.part(0..1).to_path(), 0.001),
            ];
            let place = (Point::new(24.0, 24.0), reach);
            let lines = lines.iter().map(Vec::as_slice);
            let window = Window::new(&residual, place, lines, &part, 1e-3);
            let numbers = numbers(&part);
            assert!(numbers.len() > 8, "{}", numbers.len());
            let normal = Normal::new(&window, &part, &numbers, &window.drawn(&part));
            for (number, slope) in numbers.iter().zip(&normal.slope) {
                let sum = |by: f64| {
                    let mut moved = part.clone();
                    nudge(&mut moved, *number, by);
                    moved.settle();
                    window.drawn(&moved).sum
                };
                let wanted = (sum(-DELTA) - sum(DELTA)) / (4.0 * DELTA);
                let off = (slope - wanted).abs();
                assert!(
                    off < 0.02 + 0.03 * wanted.abs(),
                    "lens {lens}, reach {reach}, turned by {turn}, {number:?}: {slope} {wanted}"
                );
            }
        }
    }
}
