//! A picture in its own range: for drawings that are nowhere darker than half of black, or everywhere.

use super::paper::is_outermost;
use crate::numeric::median::quantile;
use crate::types::Gray;

/// Share of the samples beyond each end of the range.
const BEYOND: f64 = 0.001;
/// The least difference of ink and paper, of black against white: as on pages.
const LEAST: f32 = 0.1;

/// Whether even a picture's lightest level is darker than half of black, so that its paper would pass for ink.
#[must_use]
pub fn is_all_dark(gray: &Gray) -> bool {
    let light = gray.samples().iter().filter(|v| **v <= 0.5).count();
    (light as f64) < BEYOND * gray.samples().len() as f64
}

/// The picture with its lightest level at 0 and its darkest at 1, or the other way round where its edge is nearer to
/// the darkest: paper lies there. `None` where all of it looks alike.
#[must_use]
pub fn full_range(gray: &Gray) -> Option<Gray> {
    let (w, h) = (gray.width(), gray.height());
    let mut all = gray.samples().to_vec();
    let mut at = |share: f64| quantile(&mut all, share, f32::total_cmp);
    let (low, high) = (at(BEYOND)?, at(1.0 - BEYOND)?);
    if high - low < LEAST {
        return None;
    }
    let middle = 0.5 * (low + high);
    let outermost = |i: &usize| is_outermost(*i, w, w * h);
    let edge: Vec<usize> = (0..w * h).filter(outermost).collect();
    let dark = edge.iter().filter(|&&i| gray.samples()[i] > middle).count();
    let (paper, ink) = if 2 * dark > edge.len() {
        (high, low)
    } else {
        (low, high)
    };
    let samples = gray.samples().iter();
    let samples = samples
        .map(|v| ((v - paper) / (ink - paper)).clamp(-Gray::OVERSHOOT, 1.0 + Gray::OVERSHOOT));
    Gray::new(w, h, samples.collect()).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paper_is_what_the_edge_shows_whatever_the_levels() {
        for (paper, ink) in [(0.02, 0.4), (0.55, 0.95), (0.6, 0.3), (0.1, 0.25)] {
            let level = |i: usize| {
                if (3..7).contains(&(i % 10)) && (3..7).contains(&(i / 10)) {
                    ink
                } else {
                    paper
                }
            };
            let full =
                full_range(&Gray::new(10, 10, (0..100).map(level).collect()).unwrap()).unwrap();
            let [edge, middle] = [full.row(0)[0], full.row(5)[5]];
            assert!(
                edge.abs() < 0.01 && (middle - 1.0).abs() < 0.01,
                "{paper} {ink}: {edge} {middle}"
            );
        }
        let plain = Gray::new(10, 10, vec![0.3; 100]).unwrap();
        assert!(full_range(&plain).is_none());
    }
}
