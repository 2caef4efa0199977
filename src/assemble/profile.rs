//! A glyph's sides as scan lines see them.

use crate::numeric::cast::index;
use crate::numeric::median::median;
use crate::types::Outline;
use kurbo::{Affine, PathEl, Point, flatten};
use std::ops::Range;

/// Distance between scan lines, em.
const STEP: f64 = 0.01;

/// Lowest and highest scan line, em: beyond what text reaches.
const SPAN: (f64, f64) = (-0.5, 1.2);

/// How far the polygon that is scanned may leave the curve, em.
const FLATNESS: f64 = 0.0005;

/// What scan lines find of a glyph.
#[derive(Debug, Clone)]
pub(super) struct Profile {
    /// Left and right edge of the upright shape, font units.
    pub(super) extremes: (f64, f64),
    /// Height and crossings of every scan line, from below; crossings in order of x.
    rows: Vec<(f64, Vec<f64>)>,
}

/// A side's white in some zone, font units.
#[derive(Debug, Clone, Copy)]
pub(super) struct White {
    /// Mean distance from the side's extreme to the ink, no deeper than the first depth.
    pub(super) shallow: f64,
    /// The same, no deeper than the second.
    pub(super) deep: f64,
    /// The least distance.
    pub(super) least: f64,
}

impl Profile {
    /// Scans an outline whose stems lean by `slant` (dx/dy); it is set upright about the height `pivot`.
    pub(super) fn of(outline: &Outline, em: f64, slant: f64, pivot: f64) -> Option<Self> {
        let upright = Affine::new([1.0, 0.0, -slant, 1.0, slant * pivot, 0.0]);
        let edges = edges(&outline.transformed(upright), FLATNESS * em);
        let xs = || edges.iter().flat_map(|(a, b)| [a.x, b.x]);
        let extremes = (xs().reduce(f64::min)?, xs().reduce(f64::max)?);
        let count = |v: f64| (v / STEP).round();
        let mut rows = Vec::new();
        let mut n = count(SPAN.0);
        while n < count(SPAN.1) {
            let y = (n + 0.5) * STEP * em;
            rows.push((y, crossings(&edges, y)));
            n += 1.0;
        }
        Some(Self { extremes, rows })
    }

    /// Rows between two heights.
    fn zone(&self, (low, high): (f64, f64)) -> impl Iterator<Item = &(f64, Vec<f64>)> {
        self.rows
            .iter()
            .filter(move |(y, _)| (low..=high).contains(y))
    }

    /// Distance from the left extreme to the ink on every row of the zone; none where there is no ink.
    pub(super) fn left(&self, zone: (f64, f64)) -> Vec<Option<f64>> {
        let rows = self.zone(zone).map(|(_, xs)| xs.first());
        rows.map(|x| Some(x? - self.extremes.0)).collect()
    }

    /// Distance from the ink to the right extreme on every row of the zone.
    pub(super) fn right(&self, zone: (f64, f64)) -> Vec<Option<f64>> {
        let rows = self.zone(zone).map(|(_, xs)| xs.last());
        rows.map(|x| Some(self.extremes.1 - x?)).collect()
    }

    /// The places among all rows of those between two heights.
    pub(super) fn band(&self, (low, high): (f64, f64)) -> Range<usize> {
        let start = self.rows.partition_point(|(y, _)| *y < low);
        start..self.rows.partition_point(|(y, _)| *y <= high).max(start)
    }

    /// The leftmost ink between two heights, x.
    pub(super) fn leftmost(&self, zone: (f64, f64)) -> Option<f64> {
        let firsts = self.zone(zone).filter_map(|(_, xs)| xs.first().copied());
        firsts.reduce(f64::min)
    }

    /// The rightmost ink between two heights, x.
    pub(super) fn rightmost(&self, zone: (f64, f64)) -> Option<f64> {
        let lasts = self.zone(zone).filter_map(|(_, xs)| xs.last().copied());
        lasts.reduce(f64::max)
    }

    /// The leftmost ink of every row, x.
    pub(super) fn lefts(&self) -> Vec<Option<f64>> {
        self.rows
            .iter()
            .map(|(_, xs)| xs.first().copied())
            .collect()
    }

    /// Distance from the rightmost ink of every row to the right extreme.
    pub(super) fn rights(&self) -> Vec<Option<f64>> {
        let far = |xs: &Vec<f64>| Some(self.extremes.1 - xs.last()?);
        self.rows.iter().map(|(_, xs)| far(xs)).collect()
    }

    /// Median width of the first gap between two strokes in the zone, and of the stroke before it.
    pub(super) fn counter(&self, zone: (f64, f64)) -> Option<(f64, f64)> {
        let rows = || {
            self.zone(zone).filter_map(|(_, xs)| match xs[..] {
                [a, b, c, _, ..] => Some((c - b, b - a)),
                _ => None,
            })
        };
        Some((median(rows().map(|r| r.0))?, median(rows().map(|r| r.1))?))
    }
}

/// White of one side from its distances; rows without ink count as deep as is looked.
pub(super) fn white(distances: &[Option<f64>], depths: (f64, f64)) -> White {
    let mean = |depth: f64| {
        let each = distances.iter().map(|d| d.map_or(depth, |d| d.min(depth)));
        each.sum::<f64>() / distances.len().max(1) as f64
    };
    let least = distances.iter().flatten().copied().reduce(f64::min);
    White {
        shallow: mean(depths.0),
        deep: mean(depths.1),
        least: least.unwrap_or(0.0),
    }
}

/// How many scan lines lie within a height, em.
pub(super) fn rows(height: f64) -> usize {
    index((height / STEP).round())
}

/// The outline as straight edges.
pub(super) fn edges(outline: &Outline, tolerance: f64) -> Vec<(Point, Point)> {
    let mut out = Vec::new();
    for contour in outline.contours() {
        let (mut start, mut at) = (Point::ORIGIN, Point::ORIGIN);
        flatten(contour, tolerance, |el| match el {
            PathEl::MoveTo(p) => (start, at) = (p, p),
            PathEl::LineTo(p) => {
                out.push((at, p));
                at = p;
            }
            _ => out.push((at, start)),
        });
    }
    out
}

/// Where the edges cross a height, in order.
pub(super) fn crossings(edges: &[(Point, Point)], y: f64) -> Vec<f64> {
    let mut out: Vec<f64> = edges
        .iter()
        .filter(|(a, b)| (a.y <= y) != (b.y <= y))
        .map(|(a, b)| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
        .collect();
    out.sort_by(f64::total_cmp);
    out
}
