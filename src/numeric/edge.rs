//! How blurred a picture's edges are.

use super::cast::index;
use kurbo::Point;
use std::mem;

/// Pixels this close to a contour hold its edge, px.
const BAND_PX: f64 = 4.0;

/// The standard deviation of the profile of edges that run along `rings` (px, y up), px, the pixel's own box included;
/// 0 where there are none. `samples` are coverages, row-major from the top.
///
/// Across a straight edge whose profile is a Gaussian's distribution function F, the integral of
/// F (1 - F) is sigma / sqrt(pi); so is the sum of c (1 - c) over the pixels along a contour, divided by
/// its length. Nothing is differentiated, and noise takes away no more than its variance a pixel.
pub fn blur_px<'r>(
    samples: &[f32],
    width: usize,
    rings: impl IntoIterator<Item = &'r [Point]>,
) -> f64 {
    let height = samples.len() / width.max(1);
    let mut near = vec![false; samples.len()];
    let mut length = 0.0;
    let (mut sum, mut last) = (0.0, None);
    for p in rings {
        for (i, at) in p.iter().enumerate() {
            length += at.distance(p[(i + 1) % p.len()]);
            let y = height as f64 - at.y;
            let span = |v: f64, n: usize| index(v - BAND_PX)..index(v + BAND_PX).min(n);
            let place = (index(at.x), index(y));
            if last == Some(place) {
                continue;
            }
            last = Some(place);
            let columns = span(at.x, width);
            for y in span(y, height) {
                let row = y * width..(y + 1) * width;
                let near = near[row.clone()].get_mut(columns.clone());
                let pixels = samples[row].iter().skip(columns.start);
                for (near, v) in near.into_iter().flatten().zip(pixels) {
                    if !mem::replace(near, true) {
                        let v = f64::from(*v);
                        sum += v * (1.0 - v);
                    }
                }
            }
        }
    }
    if length > 0.0 {
        sum / length * std::f64::consts::PI.sqrt()
    } else {
        0.0
    }
}
