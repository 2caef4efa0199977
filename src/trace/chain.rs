//! The boundary as a chain of pixels: 8-connected border following [rasheed05 sec. 4.1.1].

use crate::types::{Bitmap, Gray};
use image::GrayImage;
use imageproc::contours::{self, BorderType, find_contours};
use imageproc::point;
use kurbo::Point;

/// The rings of border pixels' centres around ink and holes, px, y up, ink on the left. Strokes one pixel
/// wide are walked there and back.
pub(super) fn rings(gray: &Gray, level: f64) -> Vec<Vec<Point>> {
    #[expect(
        clippy::cast_possible_truncation,
        reason = "coverage needs no more digits"
    )]
    let bits = Bitmap::threshold(gray, level as f32);
    let (Ok(w), Ok(h)) = (u32::try_from(bits.width()), u32::try_from(bits.height())) else {
        return Vec::new();
    };
    let pixels = bits.bits().iter().map(|&b| u8::from(b)).collect();
    let Some(image) = GrayImage::from_vec(w, h, pixels) else {
        return Vec::new();
    };
    let height = f64::from(h);
    let found = find_contours::<u32>(&image);
    let ring = |c: &contours::Contour<u32>| {
        let centre =
            |p: &point::Point<u32>| Point::new(f64::from(p.x) + 0.5, height - f64::from(p.y) - 0.5);
        let mut points: Vec<Point> = c.points.iter().map(centre).collect();
        if (area(&points) > 0.0) != (c.border_type == BorderType::Outer) {
            points.reverse();
        }
        points
    };
    found.iter().map(ring).collect()
}

/// Twice the signed area.
fn area(points: &[Point]) -> f64 {
    let Some(&first) = points.first() else {
        return 0.0;
    };
    let pairs = points.windows(2);
    pairs.map(|w| (w[0] - first).cross(w[1] - first)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::{Boundary, Options, trace};

    #[test]
    fn a_ring_of_ink_has_two_chains() {
        let inside =
            |x: usize, y: usize, a: usize, b: usize| (a..b).contains(&x) && (a..b).contains(&y);
        let ink = |x, y| f32::from(u8::from(inside(x, y, 2, 18) && !inside(x, y, 7, 13)));
        let gray = Gray::from_fn(20, 20, ink);
        let options = Options {
            boundary: Boundary::Chain,
            ..Options::default()
        };
        let contours = trace(&gray, &options);
        let areas: Vec<f64> = contours.iter().map(|c| c.area()).collect();
        // through pixels' centres: half a pixel inside the ink's edge
        assert_eq!(
            areas,
            [225.0, -47.0],
            "outer ring and hole, its corners cut"
        );
        assert_eq!(contours[0].points().len(), 60);
        for c in &contours {
            let p = c.points();
            let step = |i: usize| p[i].distance(p[(i + 1) % p.len()]);
            assert!((0..p.len()).all(|i| step(i) < 1.5), "8-connected");
        }
    }
}
