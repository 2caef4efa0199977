//! Ink that touches the printed lines of a grid, cut free of them.
//!
//! Lines are straight: on the upright page the heights at which a lattice has ink for more than half of its width are its
//! lines', and so for its columns. What lies there goes, unless it has ink on both sides of the line, which then crosses a letter.

use crate::numeric::view::View;
use crate::scan::components::Component;
use crate::scan::whole::floor;
use kurbo::Point;
use std::ops::Range;

/// Share of the lattice's length that a line of it covers at least.
const LONG: f64 = 0.5;
/// How far a line's blurred and ragged edge reaches beyond where it covers so much, px.
const EDGE: f64 = 1.5;

/// What is left of a lattice, or of a single line, without its lines: pieces that are wider than a line is thick.
pub(super) fn freed(lattice: &Component, upright: &View) -> Vec<Component> {
    let b = lattice.upright;
    let at = |x: usize, y: usize| upright.at(Point::new(x as f64 + 0.5, y as f64 + 0.5));
    let mut profiles = [b.width(), b.height()].map(|length| vec![0.0; floor(length) + 2]);
    for (x, y) in lattice.pixels() {
        let p = at(x, y) - b.origin();
        for (profile, v) in profiles.iter_mut().zip([p.x, p.y]) {
            if let Some(ink) = profile.get_mut(floor(v)) {
                *ink += 1.0;
            }
        }
    }
    let columns = stripes(&profiles[0], b.x0, b.height());
    let rows = stripes(&profiles[1], b.y0, b.width());
    let thick = columns.iter().chain(&rows).map(|s| s.end - s.start);
    let Some(thick) = thick.reduce(f64::max) else {
        return Vec::new();
    };
    let back = upright.inverse();
    let ink = |x: f64, y: f64| {
        let p = back.at(Point::new(x, y));
        lattice.covers(floor(p.x.max(0.0)), floor(p.y.max(0.0)))
    };
    let is_line = |x: usize, y: usize| {
        let p = at(x, y);
        let of = |stripes: &[Range<f64>], v: f64| stripes.iter().find(|s| s.contains(&v)).cloned();
        match (of(&columns, p.x), of(&rows, p.y)) {
            (None, None) => false,
            (Some(c), None) => !(ink(c.start - 1.0, p.y) && ink(c.end + 1.0, p.y)),
            (None, Some(r)) => !(ink(p.x, r.start - 1.0) && ink(p.x, r.end + 1.0)),
            (Some(_), Some(_)) => true,
        }
    };
    let mut pieces = lattice.without(is_line);
    pieces.iter_mut().for_each(|c| c.stand(upright));
    pieces.retain(|c| c.upright.width().min(c.upright.height()) > thick);
    pieces
}

/// Where a profile that begins at `start` is that of a line of this length.
fn stripes(profile: &[f64], start: f64, length: f64) -> Vec<Range<f64>> {
    let mut out = Vec::new();
    let mut at = start;
    for bins in profile.chunk_by(|a, b| (*a < LONG * length) == (*b < LONG * length)) {
        let end = at + bins.len() as f64;
        if bins.iter().all(|ink| *ink >= LONG * length) {
            out.push(at - EDGE..end + EDGE);
        }
        at = end;
    }
    out
}
