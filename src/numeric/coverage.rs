//! Exact area coverage of polygons, and what a lens makes of it.

use super::cast::{index, single};
use kurbo::Point;

/// A picture in the making: the signed area that polygons cover in each pixel.
///
/// Rows run from the top, as in a picture; the polygons' y runs up from its bottom edge. Rings that go
/// counter-clockwise add, clockwise ones take away.
#[derive(Debug, Clone)]
pub struct Coverage {
    width: usize,
    height: usize,
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
            differences,
        }
    }

    /// Columns, px.
    #[must_use]
    pub const fn width(&self) -> usize {
        self.width
    }

    /// Rows, px.
    #[must_use]
    pub const fn height(&self) -> usize {
        self.height
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
        let top = self.height as f64;
        let mut ends = points.map(|p| (p.x, top - p.y));
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
        for row in index(top)..=index(bottom).min(self.height - 1) {
            let (y0, y1) = (top.max(row as f64), bottom.min((row + 1) as f64));
            if y1 <= y0 {
                continue;
            }
            let x = |y: f64| (a.0 + slope * (y - a.1)).clamp(0.0, right);
            let (x0, x1) = (x(y0), x(y1));
            self.run(row, (x0.min(x1), x0.max(x1)), sign * (y1 - y0));
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
            let mut sum = 0.0;
            for (line, row) in line[..self.width]
                .chunks(TOGETHER)
                .zip(row.chunks_mut(TOGETHER))
            {
                if line.iter().fold(0, |any, d| any | d.to_bits()) == 0 {
                    row.fill(sum);
                    continue;
                }
                for (d, to) in line.iter().zip(row) {
                    sum += d;
                    *to = sum;
                }
            }
        }
    }
}

/// A separable Gaussian over a row-major picture, in its place; beyond its edges lies nothing.
/// `sigma_px` below a tenth of a pixel changes nothing.
pub fn blur(samples: &mut [f32], width: usize, sigma_px: f64) {
    if sigma_px < 0.1 || width == 0 {
        return;
    }
    let radius = index((3.5 * sigma_px).ceil());
    let weight = |i: usize| (-0.5 * (i as f64 / sigma_px).powi(2)).exp();
    let norm = 1.0 / (2.0 * (1..=radius).map(weight).sum::<f64>() + 1.0);
    let kernel: Vec<f32> = (0..=radius).map(|i| single(weight(i) * norm)).collect();
    let mut line = vec![0.0; width];
    for row in samples.chunks_exact_mut(width) {
        line.iter_mut()
            .zip(&*row)
            .for_each(|(t, f)| *t = kernel[0] * f);
        for (d, &k) in kernel.iter().enumerate().skip(1).take(width - 1) {
            add(&mut line[d..], row, k);
            add(&mut line, &row[d..], k);
        }
        row.copy_from_slice(&line);
    }
    // rows above are overwritten by the time they are asked for
    let mut above = vec![0.0; radius * width];
    let rows = samples.len() / width;
    for y in 0..rows {
        let at = y * width;
        line.iter_mut()
            .zip(&samples[at..])
            .for_each(|(t, f)| *t = kernel[0] * f);
        for (d, &k) in kernel.iter().enumerate().skip(1) {
            let below = (y + d < rows).then(|| &samples[at + d * width..]);
            let above = (d <= y).then(|| &above[(y - d) % radius * width..]);
            if let (Some(above), Some(below)) = (above, below) {
                let both = above.iter().zip(below);
                line.iter_mut()
                    .zip(both)
                    .for_each(|(t, (a, b))| *t += k * (a + b));
            } else if let Some(one) = above.or(below) {
                add(&mut line, one, k);
            }
        }
        let row = &mut samples[at..at + width];
        above[y % radius * width..][..width].copy_from_slice(row);
        row.copy_from_slice(&line);
    }
}

/// Adds `k` times the values of one line to those of another, as far as both go.
fn add(to: &mut [f32], from: &[f32], k: f32) {
    to.iter_mut().zip(from).for_each(|(t, f)| *t += k * f);
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
    fn blur_keeps_the_sum() {
        let mut s = vec![0.0; 21 * 21];
        s[10 * 21 + 10] = 1.0;
        blur(&mut s, 21, 1.5);
        assert!((s.iter().sum::<f32>() - 1.0).abs() < 1e-4);
        assert!((s[10 * 21 + 10] - 1.0 / (2.0 * std::f32::consts::PI * 2.25)).abs() < 1e-3);
    }
}
