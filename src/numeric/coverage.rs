//! Exact area coverage of polygons, and what a lens makes of it.

use super::cast::{index, single};
use kurbo::{Affine, Point};
use std::array;

/// A picture in the making: the signed area that polygons cover in each pixel.
///
/// Rows run from the top, as in a picture; the polygons' y runs up from its bottom edge. Rings that go
/// counter-clockwise add, clockwise ones take away.
#[derive(Debug, Clone)]
pub struct Coverage {
    width: usize,
    height: usize,
    /// From the polygons' px to the picture's, both y up.
    map: Affine,
    /// Differences along each row, one column wider than the picture; [`Coverage::samples`] sums them up.
    differences: Vec<f32>,
}

impl Coverage {
    /// Nothing covered, `width` × `height` px.
    #[must_use]
    pub fn new(width: usize, height: usize) -> Self {
        let differences = vec![0.0; (width + 2) * height];
        Self {
            width,
            height,
            map: Affine::IDENTITY,
            differences,
        }
    }

    /// The same for polygons that `map` takes to the picture, px, both y up.
    #[must_use]
    pub const fn mapped(mut self, map: Affine) -> Self {
        self.map = map;
        self
    }

    /// Columns, px.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Adds a closed polygon, px, y up. Points that are not finite are passed over.
    pub fn add(&mut self, ring: &[Point]) {
        let finite = || ring.iter().copied().filter(|p| p.is_finite());
        self.chords(finite().chain(finite().take(1)));
    }

    /// Adds a part of a polygon's edge, px, y up; parts that make a ring add what the ring does.
    pub fn line(&mut self, points: &[Point]) {
        self.chords(points.iter().copied().filter(|p| p.is_finite()));
    }

    fn chords(&mut self, points: impl Iterator<Item = Point>) {
        let (top, map) = (self.height as f64, self.map);
        let mut ends = points.map(|p| map * p).map(|p| (p.x, top - p.y));
        let Some(mut from) = ends.next() else { return };
        for to in ends {
            self.edge(from, to);
            from = to;
        }
    }

    /// One edge, y down. Ink lies to the right of a way down the picture's left side.
    fn edge(&mut self, a: (f64, f64), b: (f64, f64)) {
        let (a, b, sign) = if a.1 <= b.1 {
            (a, b, 1.0)
        } else {
            (b, a, -1.0)
        };
        let (top, bottom) = (a.1.max(0.0), b.1.min(self.height as f64));
        let right = self.width as f64;
        if bottom <= top || a.0.min(b.0) >= right {
            return;
        }
        let slope = (b.0 - a.0) / (b.1 - a.1);
        let x = |y: f64| a.0 + slope * (y - a.1);
        let (mut y1, mut x1) = (top, x(top));
        for row in index(top)..=index(bottom).min(self.height - 1) {
            let (y0, x0) = (y1, x1);
            y1 = bottom.min((row + 1) as f64);
            if y1 <= y0 {
                continue;
            }
            x1 = x(y1);
            let (low, high) = if x0 < x1 { (x0, x1) } else { (x1, x0) };
            if low >= 0.0 && high <= right {
                self.run(row, (low, high), sign * (y1 - y0));
                continue;
            }
            let inside = (low.max(0.0), high.min(right));
            // left of the picture an edge covers the whole row, right of it nothing
            let wide = (high - low).max(f64::MIN_POSITIVE);
            let height = |part: f64| sign * (y1 - y0) * (part / wide).clamp(0.0, 1.0);
            if low < 0.0 {
                let left = if high > 0.0 {
                    height(-low)
                } else {
                    height(wide)
                };
                self.run(row, (0.0, 0.0), left);
            }
            if inside.0 < inside.1 {
                self.run(row, inside, height(inside.1 - inside.0));
            }
        }
    }

    /// Part of an edge within one row, from column `x.0` to `x.1`, `height` px high with its sign.
    fn run(&mut self, row: usize, x: (f64, f64), height: f64) {
        let (first, last) = (index(x.0), index(x.1));
        let line = &mut self.differences[row * (self.width + 2)..][..self.width + 2];
        if first == last {
            let left = 1.0 - ((x.0 + x.1) / 2.0 - first as f64);
            line[first] += single(height * left);
            line[first + 1] += single(height * (1.0 - left));
            return;
        }
        // the edge covers the whole of a pixel that it has passed, and what lies right of it where it is
        let per_px = height / (x.1 - x.0);
        let mut before = 0.0;
        for (c, cell) in line.iter_mut().enumerate().take(last + 2).skip(first) {
            let (l, r) = ((c as f64).max(x.0), (c + 1) as f64);
            let end = r.min(x.1);
            let inside = (end - l).max(0.0) * (r - (l + end) / 2.0);
            let here = if c > last {
                height
            } else {
                per_px * (l - x.0 + inside)
            };
            *cell += single(here - before);
            before = here;
        }
    }

    /// Nothing covered again.
    pub fn clear(&mut self) {
        self.differences.fill(0.0);
    }

    /// The covered part of each pixel, row-major from the top.
    #[must_use]
    pub fn samples(&self) -> Vec<f32> {
        let mut out = Vec::new();
        self.write(&mut out);
        out
    }

    /// The same in place of what `out` held.
    pub fn write(&self, out: &mut Vec<f32>) {
        /// Neighbours that are looked at together: most lie far from any edge.
        const TOGETHER: usize = 8;
        out.resize(self.width * self.height, 0.0);
        let lines = self.differences.chunks_exact(self.width + 2);
        for (line, row) in lines.zip(out.chunks_exact_mut(self.width.max(1))) {
            let mut sum: f32 = 0.0;
            let (blocks, rest) = line[..self.width].as_chunks::<TOGETHER>();
            let (to, last) = row.as_chunks_mut::<TOGETHER>();
            for (block, to) in blocks.iter().zip(to) {
                add_up(&mut sum, block, to);
            }
            add_up(&mut sum, rest, last);
        }
    }
}

/// Sums of a row's differences from `sum` on; one that is off by rounding becomes whole where nothing differs.
#[inline]
fn add_up(sum: &mut f32, differences: &[f32], to: &mut [f32]) {
    /// What differs by less from all or nothing is that.
    const ROUNDING: f32 = 1e-6;
    if differences.iter().fold(0, |any, d| any | d.to_bits()) == 0 {
        let whole = if sum.abs() < 0.5 {
            0.0
        } else {
            f32::copysign(1.0, *sum)
        };
        if (*sum - whole).abs() < ROUNDING {
            *sum = whole;
        }
        to.fill(*sum);
        return;
    }
    for (d, to) in differences.iter().zip(to) {
        *sum += d;
        *to = *sum;
    }
}

/// Pixels of a row that are blurred together.
const LANES: usize = 16;

/// Weights of a Gaussian at whole pixels from its middle on, as far as they tell; those to both sides add up to 1.
/// One weight for `sigma_px` below a tenth of a pixel.
#[must_use]
pub fn kernel(sigma_px: f64) -> Vec<f32> {
    if sigma_px < 0.1 {
        return vec![1.0];
    }
    let weight = |i: usize| libm::exp(-0.5 * (i as f64 / sigma_px).powi(2));
    let radius = index((3.5 * sigma_px).ceil());
    let norm = 1.0 / (2.0 * (1..=radius).map(weight).sum::<f64>() + 1.0);
    (0..=radius).map(|i| single(weight(i) * norm)).collect()
}

/// A separable Gaussian over a row-major picture of rows of `width`, in its place; beyond its edges lies nothing.
/// `sigma_px` below a tenth of a pixel changes nothing. Of the result, `margin` px at each side are left out.
pub fn blur(samples: &mut Vec<f32>, width: usize, sigma_px: f64, margin: usize) {
    let kernel = kernel(sigma_px);
    let radius = kernel.len() - 1;
    let rows = samples.len().checked_div(width).unwrap_or(0);
    let [wide, high] = [width, rows].map(|n| n.saturating_sub(2 * margin));
    if radius + margin > 0 && wide * high > 0 {
        let blocks = wide.div_ceil(LANES);
        // as many rows, blurred along themselves, as one of the result needs
        let ring = 2 * radius + 1;
        let mut along = vec![[0.0; LANES]; ring * blocks];
        // what the last rows of a block hold if they are even, and how many those are
        let mut even = vec![(0.0_f32, ring); blocks];
        let mut line = vec![0.0; 2 * radius + width.max(margin + blocks * LANES)];
        // where in `along` the rows above and below the one of the result begin
        let mut sides = Vec::with_capacity(radius);
        for y in 0..rows + radius {
            let newest = y % ring;
            match samples.get(y * width..(y + 1) * width) {
                Some(row) => line[radius..radius + width].copy_from_slice(row),
                None => line.fill(0.0),
            }
            let to = along[newest * blocks..].iter_mut();
            for ((block, even), to) in even.iter_mut().enumerate().zip(to) {
                let around = &line[margin + block * LANES..][..2 * radius + LANES];
                if is_even(around) {
                    let same = around[0].to_bits() == even.0.to_bits();
                    let rows = if same { even.1 } else { 0 };
                    *even = (around[0], rows + 1);
                    *to = [around[0]; LANES];
                } else {
                    even.1 = 0;
                    *to = across(around, &kernel);
                }
            }
            let Some(to) = y.checked_sub(radius + margin).filter(|to| *to < high) else {
                continue;
            };
            let row = |back: usize| (newest + ring - back) % ring * blocks;
            sides.clear();
            let pairs = (1..).zip(&kernel[1..]);
            sides.extend(pairs.map(|(d, k)| (row(radius + d), row(radius - d), *k)));
            let middle = (row(radius), kernel[0]);
            // never past what has been read
            let out = samples[to * wide..(to + 1) * wide].chunks_mut(LANES);
            for ((block, out), even) in out.enumerate().zip(&even) {
                let sum = if even.1 >= ring {
                    [even.0; LANES]
                } else {
                    down(&along[block..], middle, &sides)
                };
                match out.first_chunk_mut() {
                    Some(out) => *out = sum,
                    None => out.copy_from_slice(&sum[..out.len()]),
                }
            }
        }
    }
    samples.truncate(wide * high);
}

/// Whether values are all the same.
fn is_even(values: &[f32]) -> bool {
    let first = values.first().map_or(0, |v| v.to_bits());
    let is_first =
        |some: &[f32; LANES]| some.iter().fold(0, |any, v| any | v.to_bits() ^ first) == 0;
    // the last ones overlap others: whole blocks are quick to look at
    let last = values.last_chunk();
    last.is_some_and(is_first) && values.as_chunks().0.iter().all(is_first)
}

/// A block of a row weighed with what lies left and right of it; `around` holds both.
fn across(around: &[f32], kernel: &[f32]) -> [f32; LANES] {
    let radius = kernel.len() - 1;
    let middle = &around[radius..][..LANES];
    let mut sum: [f32; LANES] = array::from_fn(|i| kernel[0] * middle[i]);
    for (d, k) in kernel.iter().enumerate().skip(1) {
        let (left, right) = (
            &around[radius - d..][..LANES],
            &around[radius + d..][..LANES],
        );
        sum = array::from_fn(|i| sum[i] + k * left[i] + k * right[i]);
    }
    sum
}

/// A block, the first of some, weighed with those above and below it: `middle` and `sides` say how far on they are
/// and what they weigh.
fn down(
    blocks: &[[f32; LANES]],
    (middle, weight): (usize, f32),
    sides: &[(usize, usize, f32)],
) -> [f32; LANES] {
    let mut sum = blocks[middle].map(|v| weight * v);
    for (above, below, k) in sides {
        let (above, below) = (&blocks[*above], &blocks[*below]);
        sum = array::from_fn(|i| sum[i] + k * (above[i] + below[i]));
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(w: usize, h: usize, ring: &[(f64, f64)]) -> (Vec<f32>, f64) {
        let mut c = Coverage::new(w, h);
        c.add(&ring.iter().map(|&p| p.into()).collect::<Vec<_>>());
        let s = c.samples();
        let sum = s.iter().map(|v| f64::from(*v)).sum();
        (s, sum)
    }

    #[test]
    fn a_square_covers_its_pixels() {
        let (s, sum) = area(4, 3, &[(0.5, 0.25), (2.5, 0.25), (2.5, 2.0), (0.5, 2.0)]);
        assert!((sum - 3.5).abs() < 1e-6, "{sum}");
        let want = [
            0.0, 0.0, 0.0, 0.0, 0.5, 1.0, 0.5, 0.0, 0.375, 0.75, 0.375, 0.0,
        ];
        assert!(
            s.iter()
                .zip(want)
                .all(|(a, b): (_, f32)| (a - b).abs() < 1e-6),
            "{s:?}"
        );
    }

    #[test]
    fn slanted_edges_cover_exactly() {
        let (s, sum) = area(8, 8, &[(1.3, 0.7), (7.1, 2.2), (4.4, 6.9)]);
        let exact = ((7.1 - 1.3) * (6.9 - 0.7) - (4.4 - 1.3) * (2.2 - 0.7)) / 2.0;
        assert!((sum - exact).abs() < 1e-5, "{sum} {exact}");
        assert!(s.iter().all(|v| (-1e-5..=1.00001).contains(v)), "{s:?}");
        // the diagonal of a pixel halves it
        let (s, _) = area(2, 2, &[(0.0, 0.0), (2.0, 0.0), (2.0, 2.0)]);
        assert!(
            s.iter()
                .zip([0.0, 0.5, 0.5, 1.0])
                .all(|(a, b): (_, f32)| (a - b).abs() < 1e-6),
            "{s:?}"
        );
    }

    #[test]
    fn what_sticks_out_is_cut_off() {
        let (_, sum) = area(4, 4, &[(-3.0, -3.0), (9.0, -3.0), (9.0, 9.0), (-3.0, 9.0)]);
        assert!((sum - 16.0).abs() < 1e-6, "{sum}");
        assert!(
            area(0, 0, &[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)])
                .0
                .is_empty()
        );
    }

    #[test]
    fn a_window_is_cut_out_of_the_whole() {
        // edges that leave the window's sides within a row, in two rows, upright on a side and far beyond it
        let ring = [
            (3.2, 5.4),
            (28.8, 6.1),
            (30.0, 14.0),
            (21.0, 14.5),
            (22.6, 21.2),
            (10.0, 25.9),
            (10.0, 18.3),
            (7.4, 19.9),
            (1.7, 18.8),
        ];
        let (w, h) = (32, 30);
        for ring in [ring.to_vec(), ring.into_iter().rev().collect()] {
            let (whole, _) = area(w, h, &ring);
            for (left, top, right, bottom) in [
                (10, 4, 22, 27),
                (4, 0, 29, 30),
                (14, 9, 15, 26),
                (31, 0, 32, 30),
            ] {
                let moved = |&(x, y): &(f64, f64)| (x - left as f64, y - (h - bottom) as f64);
                let (cut, _) = area(
                    right - left,
                    bottom - top,
                    &ring.iter().map(moved).collect::<Vec<_>>(),
                );
                let wanted = (top..bottom).flat_map(|y| &whole[y * w + left..y * w + right]);
                let off = cut
                    .iter()
                    .zip(wanted)
                    .map(|(a, b)| (a - b).abs())
                    .fold(0.0, f32::max);
                assert!(off < 1e-5, "{left} {top}: {off}");
            }
        }
    }

    /// Each pixel from all of them.
    fn slowly(s: &[f32], w: usize, sigma: f64) -> Vec<f32> {
        let kernel = kernel(sigma);
        let weight = |a: usize, b: usize| kernel.get(a.abs_diff(b)).copied().unwrap_or(0.0);
        let at = |i: usize| {
            let of = |(j, v): (usize, &f32)| v * weight(i % w, j % w) * weight(i / w, j / w);
            s.iter().enumerate().map(of).sum()
        };
        (0..s.len()).map(at).collect()
    }

    #[test]
    fn blur_is_a_sum_over_all_pixels() {
        let (w, h) = (41, 23);
        let (s, _) = area(w, h, &[(3.2, 2.1), (39.4, 5.0), (36.0, 20.7), (5.5, 21.6)]);
        for (sigma, margin) in [(0.05, 2), (0.7, 0), (0.7, 3), (1.9, 0), (1.9, 7), (1.9, 12)] {
            let whole = slowly(&s, w, sigma);
            let wanted: Vec<f32> = (margin..h.saturating_sub(margin))
                .flat_map(|y| &whole[y * w + margin..(y + 1) * w - margin])
                .copied()
                .collect();
            let mut got = s.clone();
            blur(&mut got, w, sigma, margin);
            assert_eq!(got.len(), wanted.len(), "{sigma} {margin}");
            let off = got.iter().zip(&wanted).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f32::max);
            assert!(off < 1e-5, "{sigma} {margin}: {off}");
        }
    }

    #[test]
    fn blur_keeps_the_sum() {
        let mut s = vec![0.0; 21 * 21];
        s[10 * 21 + 10] = 1.0;
        blur(&mut s, 21, 1.5, 0);
        assert!((s.iter().sum::<f32>() - 1.0).abs() < 1e-4);
        assert!((s[10 * 21 + 10] - 1.0 / (2.0 * std::f32::consts::PI * 2.25)).abs() < 1e-3);
    }
}
