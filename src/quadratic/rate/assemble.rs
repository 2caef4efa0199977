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

/// Where a contour may begin: at an on-curve point, or behind an implied one. Of a long one some places stand
/// for all.
fn begins(c: &[Stored]) -> impl Iterator<Item = usize> {
    /// Places that are tried at most.
    const MANY: usize = 512;
    let n = c.len();
    let all = (0..n).filter(move |&i| c[i].on || !c[(i + n - 1) % n].on);
    all.step_by(1 + n / MANY)
}

/// Cheapest start of each contour, by shortest path over (contour, start).
fn starts(contours: &[Vec<Stored>]) -> Vec<usize> {
    let origin = Stored {
        x: 0,
        y: 0,
        on: false,
    };
    // Of each start of a contour: the bytes so far, and which start of the one before led there.
    let mut layers: Vec<Vec<(u32, usize, usize)>> = Vec::new();
    let mut before = vec![(0, origin)];
    for c in contours {
        let layer = begins(c).map(|s| {
            let step = |&(cost, from): &(u32, Stored)| cost + Pen::after(from).store(c[s]);
            let steps = before.iter().map(step).enumerate().map(|(k, v)| (v, k));
            let (cost, k) = steps.min().unwrap_or_default();
            (cost + around(c, s), k, s)
        });
        let layer: Vec<_> = layer.collect();
        let last = |s: usize| c[(s + c.len() - 1) % c.len()];
        before = layer.iter().map(|&(cost, _, s)| (cost, last(s))).collect();
        layers.push(layer);
    }
    let mut out = Vec::new();
    let mut at = None;
    for layer in layers.iter().rev() {
        let cheapest = (0..layer.len()).min_by_key(|&k| layer[k].0).unwrap_or(0);
        let (_, from, s) = layer[at.unwrap_or(cheapest)];
        out.push(s);
        at = Some(from);
    }
    out.reverse();
    out
}

/// Bytes of all points but the first, begun where they are fewest.
pub(super) fn bytes(c: &[Stored]) -> u32 {
    begins(c).map(|s| around(c, s)).min().unwrap_or(0)
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
