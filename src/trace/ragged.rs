//! How ragged a picture's edges are.

use crate::numeric::median::NORMAL;
use crate::types::Contour;
use kurbo::{Point, Vec2};

/// Points on each side of the one that a parabola is laid through.
const REACH: usize = 6;
/// Rings of fewer points, in reaches, bend too much for that.
const SMALL: usize = 12;
/// Tracing itself leaves points this far off, px: the bilinear surface follows the pixels' steps, and a scan's grain
/// moves them about as much.
const FLOOR_PX: f64 = 0.07;

/// Length along a ragged edge that tells nothing, in its standard deviations.
const BLIND: f64 = 10.0;
/// Ragged edges waver over tens of px, too: as noise that is this many times what they stray within a few, with which
/// outlines come nearest to what was drawn. Four to eight times do as well.
const WAVES: f64 = 5.0;
/// Both are at most this part of a stroke's width: what is larger was drawn.
const OF_WIDTH: f64 = 0.05;
/// The pixels' steps along edges that slant by so many degrees are as large once more; those of others are part of it.
const STEEP_DEG: (f64, f64) = (8.0, 16.0);
/// What passes for raggedness and does not waver: steps that are larger yet, px, and the bends of thin strokes, px of
/// a stroke of 1 px.
const STEPS_PX: f64 = 0.035;
const BENDS_PX: f64 = 0.7;

/// How ragged a picture's edges are.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ragged {
    /// Length along the edges within which that hides what is drawn, px.
    pub(super) hidden_px: f64,
    /// How far the edges waver, a standard deviation, px: what a curve need not follow.
    pub(super) waver_px: f64,
}

impl Ragged {
    /// Of the contours of a picture; nothing for edges as smooth as tracing makes them.
    pub(super) fn of(contours: &[Contour]) -> Self {
        let rough = rough_px(contours);
        let area: f64 = contours.iter().map(Contour::area).sum();
        let length: f64 = contours.iter().map(Contour::length).sum();
        let width = 2.0 * area.abs() / length;
        let passes = STEPS_PX.hypot(BENDS_PX / width);
        let waver = (rough * rough - passes * passes).max(0.0).sqrt();
        Self {
            hidden_px: (BLIND * rough).min(OF_WIDTH * width),
            waver_px: (WAVES * waver).min(OF_WIDTH * width),
        }
    }
}

/// Robust standard deviation of contours' points from parabolas through their neighbours, px, without what
/// tracing alone makes; 0 where that explains all of it.
fn rough_px(contours: &[Contour]) -> f64 {
    let mut off: Vec<f64> = contours.iter().flat_map(excess).collect();
    if off.is_empty() {
        return 0.0;
    }
    let mid = off.len() / 2;
    let median = *off.select_nth_unstable_by(mid, f64::total_cmp).1;
    median.max(0.0).sqrt()
}

/// Squared distance of each point from the middle of the parabola through its neighbours and itself, without what
/// tracing makes, px²; scaled so that of normal draws the median is the variance.
fn excess(contour: &Contour) -> Vec<f64> {
    let p = contour.points();
    let n = p.len();
    if n < SMALL * REACH {
        return Vec::new();
    }
    // Σ i² and Σ i⁴ over −REACH…REACH
    let r = REACH as f64;
    let s2 = r * (r + 1.0) * (2.0 * r + 1.0) / 3.0;
    let s4 = s2 * (3.0 * r * r + 3.0 * r - 1.0) / 5.0;
    let s0 = 2.0 * r + 1.0;
    let of = |around: &[Point]| {
        let (mut m0, mut m1, mut m2) = (Vec2::ZERO, Vec2::ZERO, Vec2::ZERO);
        for (i, p) in around.iter().enumerate() {
            let x = i as f64 - r;
            let q = *p - around[REACH];
            m0 += q;
            m1 += q * x;
            m2 += q * (x * x);
        }
        let middle = (m0 * s4 - m2 * s2) / (s0 * s4 - s2 * s2);
        let along = m1 / s2;
        let off = NORMAL * middle.cross(along) / along.hypot().max(1e-12);
        let (flat, steep) = (along.x.abs(), along.y.abs());
        let slant = libm::atan2(flat.min(steep), flat.max(steep)).to_degrees();
        let stepped = (STEEP_DEG.0..STEEP_DEG.1).contains(&slant);
        off * off - FLOOR_PX * FLOOR_PX * if stepped { 2.0 } else { 1.0 }
    };
    let ring = [&p[n - REACH..], p, &p[..REACH]].concat();
    ring.windows(2 * REACH + 1).map(of).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::angles;
    use crate::numeric::coverage::{Coverage, blur};
    use crate::trace::{Options, trace};
    use crate::types::Gray;
    use kurbo::{Affine, Rect};

    #[test]
    fn slanting_edges_are_not_ragged() {
        for half_deg in 0..180 {
            let turn = angles::rotation((0.5 * f64::from(half_deg)).to_radians());
            let place = Affine::translate((150.3, 149.9)) * turn;
            let bar = Rect::new(-120.0, -20.0, 120.0, 20.0);
            let mut drawn = Coverage::new(300, 300);
            drawn.add(&corners(bar).map(|c| place * c));
            for lens in [0.0, 0.4, 0.5, 0.7] {
                let mut samples = drawn.samples();
                blur(&mut samples, 300, lens, 0);
                let gray = Gray::from_fn(300, 300, |x, y| samples[y * 300 + x]);
                let found = trace(&gray, &Options::default());
                assert_eq!(found.len(), 1);
                let waver = found[0].scatter_px();
                assert!(waver <= 0.0, "{half_deg} half degrees, {lens} px: {waver}");
            }
        }
    }

    fn corners(bar: Rect) -> [Point; 4] {
        [
            (bar.x0, bar.y0),
            (bar.x1, bar.y0),
            (bar.x1, bar.y1),
            (bar.x0, bar.y1),
        ]
        .map(Point::from)
    }
}
