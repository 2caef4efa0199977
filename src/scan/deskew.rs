//! The angle at which a page lies.
//!
//! Rows of letters stand on common lines, so the lower and upper edges of the ink, projected along the
//! right direction, pile up. The sum of squares of that projection is climbed from coarse to fine.

use super::components::Component;
use crate::numeric::cast::index;
use crate::numeric::median::middle;
use kurbo::{Point, Vec2};
use rayon::prelude::*;

/// Largest angle looked at, degrees.
const REACH_DEG: f64 = 15.0;
/// Distance of the first angles looked at, degrees.
const COARSE_DEG: f64 = 0.25;
/// Each round looks this many times closer.
const CLOSER: f64 = 4.0;
/// Rounds after the first.
const ROUNDS: i32 = 3;
/// Edge points that say enough about a page.
const POINTS: usize = 60_000;
/// How far the best angle must stand out of the middle one, as a ratio.
const CLEAR: f64 = 1.15;

/// Degrees by which the page is turned clockwise on the picture (y down); 0 where nothing says so.
pub(super) fn skew_deg(edges: &Edges) -> f64 {
    let Some(bounds) = edges.extent() else {
        return 0.0;
    };
    let steps = (REACH_DEG / COARSE_DEG).round();
    let angles: Vec<f64> = (0..=index(2.0 * steps))
        .map(|i| (i as f64 - steps) * COARSE_DEG)
        .collect();
    let bin = |step: f64| (step.to_radians() * bounds / 2.0).max(1.0);
    let energies: Vec<f64> = angles
        .par_iter()
        .map(|a| edges.energy(*a, bin(COARSE_DEG)))
        .collect();
    let usual = middle(energies.iter().copied(), f64::total_cmp).unwrap_or(0.0);
    let best = (0..angles.len()).max_by(|&a, &b| energies[a].total_cmp(&energies[b]));
    let Some(best) = best.filter(|&b| energies[b] > CLEAR * usual) else {
        return 0.0;
    };
    (1..=ROUNDS).fold(angles[best], |angle, round| {
        let step = COARSE_DEG / CLOSER.powi(round);
        climb(|a| edges.energy(a, bin(step)), angle, step)
    })
}

/// The best of the angles up to one and a half coarser steps around `angle`, between its neighbours.
fn climb(energy: impl Fn(f64) -> f64 + Sync, angle: f64, step: f64) -> f64 {
    let reach = 1.5 * CLOSER;
    let tries: Vec<f64> = (0..=index(2.0 * reach))
        .map(|i| angle + (i as f64 - reach) * step)
        .collect();
    let found: Vec<f64> = tries.par_iter().map(|a| energy(*a)).collect();
    let best = (0..found.len())
        .max_by(|&a, &b| found[a].total_cmp(&found[b]))
        .unwrap_or(0);
    let at = |i: usize| found.get(i).copied();
    let bend = match (best.checked_sub(1).and_then(at), at(best), at(best + 1)) {
        (Some(a), Some(b), Some(c)) if a + c < 2.0 * b => (a - c) / (2.0 * (a + c - 2.0 * b)),
        _ => 0.0,
    };
    tries[best] + bend * step
}

/// Points on the ink's lower and upper edges, px.
pub(super) struct Edges {
    lower: Vec<Point>,
    upper: Vec<Point>,
}

impl Edges {
    /// Where the picture of this height ends, ink has no edge of its own.
    pub(super) fn new(components: &[&Component], height: usize) -> Self {
        let edge: f64 = components.iter().map(|c| c.bounds.width()).sum();
        let step = index(edge / POINTS as f64).max(1);
        let mut new = Self {
            lower: Vec::new(),
            upper: Vec::new(),
        };
        for c in components {
            for r in &c.runs {
                for x in (r.start.next_multiple_of(step)..r.end).step_by(step) {
                    let at = |dy: f64| Point::new(x as f64 + 0.5, r.y as f64 + dy);
                    if r.y + 1 < height && !c.covers(x, r.y + 1) {
                        new.lower.push(at(1.0));
                    }
                    if r.y > 0 && !c.covers(x, r.y - 1) {
                        new.upper.push(at(0.0));
                    }
                }
            }
        }
        new
    }

    /// Lower and upper ones from a middle.
    pub(super) fn about(&self, middle: Point) -> [Vec<Vec2>; 2] {
        [&self.lower, &self.upper].map(|set| set.iter().map(|p| *p - middle).collect())
    }

    /// Length of the page's ink along its rows, px.
    fn extent(&self) -> Option<f64> {
        let xs = || self.lower.iter().map(|p| p.x);
        let (low, high) = (xs().reduce(f64::min)?, xs().reduce(f64::max)?);
        Some((high - low).max(1.0))
    }

    /// Sum of squares of the projections along `angle`, in bins of `bin` px.
    fn energy(&self, angle: f64, bin: f64) -> f64 {
        energy(&self.lower, angle, bin) + energy(&self.upper, angle, bin)
    }
}

fn energy(points: &[Point], angle: f64, bin: f64) -> f64 {
    let (s, c) = libm::sincos(angle.to_radians());
    energy_of(points.iter().map(|p| (p.y * c - p.x * s) / bin)) / bin
}

/// Sum of squares of how many places fall into each bin of length 1 and the next one.
pub(super) fn energy_of(places: impl Iterator<Item = f64> + Clone) -> f64 {
    let low = places.clone().fold(f64::INFINITY, f64::min);
    let mut bins: Vec<f64> = Vec::new();
    for place in places {
        let place = place - low;
        let (i, t) = (index(place), place.fract());
        if bins.len() < i + 2 {
            bins.resize(i + 2, 0.0);
        }
        bins[i] += 1.0 - t;
        bins[i + 1] += t;
    }
    let pairs = bins.windows(2).map(|w| (w[0] + w[1]).powi(2));
    pairs.sum()
}
