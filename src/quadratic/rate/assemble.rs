//! Stored points → paths, each contour begun where that costs least.

use super::glyf::{Pen, Stored};
use kurbo::{BezPath, Point};

/// Closed paths of these contours, which run as TrueType stores them, clockwise outside; the paths run
/// the other way. The starts are chosen together, so that the steps from one contour to the next are
/// small and flags repeat.
pub(super) fn paths(contours: &[Vec<Stored>]) -> Vec<BezPath> {
    let starts = starts(contours);
    let written = contours.iter().zip(starts).map(|(c, s)| path(c, s));
    written.map(|p| p.reverse_subpaths()).collect()
}

/// A contour may begin at an on-curve point, or behind an implied one.
fn may_begin(c: &[Stored], i: usize) -> bool {
    c[i].on || !c[(i + c.len() - 1) % c.len()].on
}

/// Cheapest start of each contour, by shortest path over (contour, start).
fn starts(contours: &[Vec<Stored>]) -> Vec<usize> {
    let origin = Stored {
        x: 0,
        y: 0,
        on: false,
    };
    let mut layers: Vec<Vec<(u32, usize)>> = Vec::new();
    let mut before = vec![(0, origin)];
    for c in contours {
        let n = c.len();
        let layer: Vec<(u32, usize)> = (0..n)
            .map(|s| {
                let around = around(c, s);
                let step = |&(cost, from): &(u32, Stored)| cost + Pen::after(from).store(c[s]);
                let best = before
                    .iter()
                    .map(step)
                    .enumerate()
                    .map(|(k, v)| (v, k))
                    .min();
                let (cost, k) = best.unwrap_or_default();
                (
                    if may_begin(c, s) {
                        cost + around
                    } else {
                        u32::MAX / 2
                    },
                    k,
                )
            })
            .collect();
        before = (0..n).map(|s| (layer[s].0, c[(s + n - 1) % n])).collect();
        layers.push(layer);
    }
    let mut out = Vec::new();
    let mut at = None;
    for layer in layers.iter().rev() {
        let cheapest = (0..layer.len()).min_by_key(|&s| layer[s].0).unwrap_or(0);
        let s = at.unwrap_or(cheapest);
        out.push(s);
        at = Some(layer[s].1);
    }
    out.reverse();
    out
}

/// Bytes of all points but the first, begun where they are fewest.
pub(super) fn bytes(c: &[Stored]) -> u32 {
    let starts = (0..c.len()).filter(|&s| may_begin(c, s));
    starts.map(|s| around(c, s)).min().unwrap_or(0)
}

/// Bytes of all points but the first, begun at `s`.
fn around(c: &[Stored], s: usize) -> u32 {
    let mut pen = Pen::after(c[s]);
    pen.store(c[s]);
    let rest = (1..c.len()).map(|i| pen.store(c[(s + i) % c.len()]));
    rest.sum()
}

fn path(c: &[Stored], start: usize) -> BezPath {
    let n = c.len();
    let at = |i: usize| c[(start + i) % n];
    let before = at(n - 1);
    let begin = if at(0).on {
        at(0).point()
    } else {
        before.point().midpoint(at(0).point())
    };
    let mut path = BezPath::new();
    path.move_to(begin);
    let mut control: Option<Point> = None;
    for i in usize::from(at(0).on)..n {
        let p = at(i).point();
        match (at(i).on, control.take()) {
            (true, None) => path.line_to(p),
            (true, Some(q)) => path.quad_to(q, p),
            (false, None) => control = Some(p),
            (false, Some(q)) => {
                path.quad_to(q, q.midpoint(p));
                control = Some(p);
            }
        }
    }
    match control {
        Some(q) => path.quad_to(q, begin),
        // Said out loud, so that the path begins at the same point either way around.
        None => path.line_to(begin),
    }
    path.close_path();
    path
}
