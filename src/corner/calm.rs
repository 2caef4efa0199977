//! Contours of ragged ink, smoothed for the search of corners.

use crate::{numeric::cast::index, types::Contour};
use kurbo::Vec2;
use std::borrow::Cow;

/// Of its kernel what lies further out, in deviations, is left out.
const CUT: f64 = 2.5;

/// The contour's points, each averaged with its neighbours.
pub(super) fn calm(contour: &Contour) -> Cow<'_, Contour> {
    let p = contour.points();
    let n = p.len();
    let step = contour.length() / n as f64;
    let sigma = contour.ragged_px() / step;
    let reach = index(CUT * sigma);
    if reach == 0 || 2 * reach >= n {
        return Cow::Borrowed(contour);
    }
    let kernel: Vec<f64> = (0..=reach)
        .map(|k| libm::exp(-0.5 * (k as f64 / sigma).powi(2)))
        .collect();
    let total = 2.0 * kernel.iter().sum::<f64>() - kernel[0];
    let average = |i: usize| {
        let mut sum = Vec2::ZERO;
        for (k, w) in kernel.iter().enumerate().skip(1) {
            sum += *w * ((p[(i + k) % n] - p[i]) + (p[(i + n - k) % n] - p[i]));
        }
        p[i] + sum / total
    };
    match contour.through((0..n).map(average).collect()) {
        Ok(c) if c.points().len() == n => Cow::Owned(c),
        _ => Cow::Borrowed(contour),
    }
}
