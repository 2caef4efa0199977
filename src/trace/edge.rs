//! How blurred a picture's edges are.

use crate::{
    numeric::cast::index,
    types::{Contour, Gray},
};
use std::mem;

/// Pixels this close to a contour hold its edge, px.
const BAND_PX: f64 = 4.0;
/// No edge is taken for softer than this, px.
const MAX_BLUR_PX: f64 = 4.0;

/// The standard deviation of the edges' profile, px, the pixel's own box included.
///
/// Across a straight edge whose profile is a Gaussian's distribution function F, the integral of
/// F (1 - F) is sigma / sqrt(pi); so is the sum of c (1 - c) over the pixels along a contour, divided by
/// its length. Nothing is differentiated, and noise takes away no more than its variance a pixel.
pub(super) fn blur_px(gray: &Gray, contours: &[Contour]) -> f64 {
    let (w, h) = (gray.width(), gray.height());
    let mut near = vec![false; w * h];
    let mut length = 0.0;
    let (mut sum, mut last) = (0.0, None);
    for c in contours {
        let p = c.points();
        for (i, at) in p.iter().enumerate() {
            length += at.distance(p[(i + 1) % p.len()]);
            let y = h as f64 - at.y;
            let span = |v: f64, n: usize| index(v - BAND_PX)..index(v + BAND_PX).min(n);
            let place = (index(at.x), index(y));
            if last == Some(place) {
                continue;
            }
            last = Some(place);
            let columns = span(at.x, w);
            for y in span(y, h) {
                let near = near[y * w..].get_mut(columns.clone());
                let pixels = gray.row(y).iter().skip(columns.start);
                for (near, v) in near.into_iter().flatten().zip(pixels) {
                    if !mem::replace(near, true) {
                        let v = f64::from(*v);
                        sum += v * (1.0 - v);
                    }
                }
            }
        }
    }
    let blur = if length > 0.0 {
        sum / length * std::f64::consts::PI.sqrt()
    } else {
        0.0
    };
    blur.clamp(Contour::PIXEL_BLUR_PX, MAX_BLUR_PX)
}
