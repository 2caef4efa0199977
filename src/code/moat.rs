//! How far places lie outside the tube.

use super::places::{extent, to_edge};
use kurbo::{Point, Rect};

/// Distances are known up to this, px.
const FAR: f64 = 8.0;

/// Cells in a px.
const FINE: f64 = 4.0;

/// Steps in a px that distances are told in, downwards: what is [`FAR`] fits into a byte.
const LEVELS: f64 = 31.0;

/// Least distances from the tube in cells of a quarter px.
#[derive(Debug)]
pub(super) struct Moat {
    origin: Point,
    width: usize,
    height: usize,
    levels: Vec<u8>,
}

impl Moat {
    /// Around a boundary, its first point again at the end, with the half width of the tube at each of its edges.
    pub(super) fn new(boundary: &[Point], halves: &[f64]) -> Self {
        // what is farther from an edge than this is FAR from its part of the tube
        let reach = |half: f64| half + FAR + 1.0;
        let margin = halves.iter().copied().map(reach).fold(0.0, f64::max) + 1.0;
        let all = extent(boundary).inflate(margin, margin);
        let (width, height) = (cells(all.width()), cells(all.height()));
        let origin = all.origin();
        let mut levels = vec![level(FAR); width * height];
        for (edge, half) in boundary.windows(2).zip(halves) {
            let around = Rect::from_points(edge[0], edge[1]).inflate(reach(*half), reach(*half));
            let from = (around.origin() - origin) * FINE;
            let (right, down) = (cells(around.width()), cells(around.height()));
            let (left, top) = (whole(from.x), whole(from.y));
            for y in top..(top + down).min(height) {
                for x in left..(left + right).min(width) {
                    let off = to_edge(middle(origin, (x, y)), edge).sqrt() - half;
                    let least = &mut levels[y * width + x];
                    *least = level(off - std::f64::consts::FRAC_1_SQRT_2 / FINE).min(*least);
                }
            }
        }
        Self {
            origin,
            width,
            height,
            levels,
        }
    }

    /// Whether all points of a disc surely lie outside; no for radii beyond [`FAR`].
    #[inline]
    pub(super) fn misses(&self, p: Point, radius: f64) -> bool {
        let from = (p - self.origin) * FINE;
        let (x, y) = (whole(from.x), whole(from.y));
        // what lies beyond the cells is farther than the last of them
        let at = y.min(self.height - 1) * self.width + x.min(self.width - 1);
        let level = self.levels.get(at).copied();
        f64::from(level.unwrap_or(0)) > radius * LEVELS + 1e-3
    }
}

/// Cells along so many px, and one to spare on each side.
fn cells(px: f64) -> usize {
    whole(px * FINE) + 2
}

fn middle(origin: Point, (x, y): (usize, usize)) -> Point {
    Point::new(
        origin.x + (x as f64 + 0.5) / FINE,
        origin.y + (y as f64 + 0.5) / FINE,
    )
}

/// A distance in levels.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates: nothing less than 0, and FAR fits"
)]
fn level(px: f64) -> u8 {
    (px.min(FAR) * LEVELS) as u8
}

/// The whole part of what is at least 0 and less than 2^31; 0 below.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates; by way of i32, as the processor does it"
)]
fn whole(v: f64) -> usize {
    (v as i32).max(0) as usize
}
