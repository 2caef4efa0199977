//! Values between samples, along straight lines.

use crate::numeric::cast::index;
use kurbo::Point;

/// The value at a point of a picture of so many samples a row, whose first one has its centre at (½, ½); nothing
/// outside the picture.
#[must_use]
pub fn bilinear(samples: &[f32], width: usize, p: Point) -> f64 {
    let height = samples.len() / width.max(1);
    let (x, y) = (p.x - 0.5, p.y - 0.5);
    let inside = x > -1.0 && y > -1.0 && x < width as f64 && y < height as f64;
    if !inside || height == 0 {
        return 0.0;
    }
    let (left, top) = (x.max(0.0).floor(), y.max(0.0).floor());
    let (s, t) = ((x - left).max(0.0), (y - top).max(0.0));
    let (i, j) = (index(left), index(top));
    let (i1, j1) = ((i + 1).min(width - 1), (j + 1).min(height - 1));
    let row = |j: usize| {
        let v = |i: usize| f64::from(samples[j * width + i]);
        v(i) * (1.0 - s) + v(i1) * s
    };
    row(j) * (1.0 - t) + row(j1) * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn planes_come_back_and_nothing_lies_outside() {
        let samples: Vec<f32> = (0..12u8).map(|i| f32::from(i % 4 + 2 * (i / 4))).collect();
        let at = |x: f64, y: f64| bilinear(&samples, 4, Point::new(x, y));
        for (x, y) in [(0.5, 0.5), (1.75, 1.25), (3.5, 2.5)] {
            assert!((at(x, y) - (x - 0.5) - 2.0 * (y - 0.5)).abs() < 1e-12);
        }
        assert!((at(0.1, 0.2) - at(0.5, 0.5)).abs() < 1e-12);
        assert!(
            [(-0.6, 1.0), (1.0, 3.6), (4.6, 1.0)]
                .iter()
                .all(|p| at(p.0, p.1).abs() < 1e-12)
        );
        assert!(bilinear(&[], 0, Point::ORIGIN).abs() < 1e-12);
    }
}
