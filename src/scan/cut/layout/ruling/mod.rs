//! Ink that touches the printed lines of a grid, cut free of them.
//!
//! Lines are straight: on the upright page the heights at which a lattice has ink for more than half of its width are
//! its lines', and so for its columns. What lies there goes, unless it has ink on both sides of the line, straight
//! across or aslant: there the line crosses a letter. What a letter's edge encloses that runs along within the line
//! stays too.

mod hidden;
mod stripes;

use crate::numeric::median::middle;
use crate::numeric::surface::Surface;
use crate::scan::components::Component;
use hidden::Hidden;
use kurbo::Point;
use std::ops::Range;
use stripes::{THICK, inked, lines_of};

/// Ways across a line: how far they lead along it, as a share of how far across. A letter's edge goes between two of
/// them.
const WAYS: [f64; 5] = [0.0, -0.5, 0.5, -1.0, 1.0];

/// How far down the page printed lines lie, upright px.
pub(super) fn heights(lines: &[&Component], upright: &Surface) -> Vec<f64> {
    let of = |line: &&Component| {
        let [columns, rows] = lines_of(line, upright);
        let thick = |line: &Range<f64>| line.end - line.start;
        let least = columns.iter().chain(&rows).map(thick);
        let least = least.reduce(f64::min).unwrap_or(0.0);
        // a line down the page is as thick as it is long the other way
        let thin = rows.into_iter().filter(|l| thick(l) <= THICK * least);
        thin.map(|l| (l.start + l.end) / 2.0).collect::<Vec<f64>>()
    };
    lines.iter().flat_map(of).collect()
}

/// What is left of a lattice, or of a single line, without its lines: pieces that are wider than a line is thick.
pub(super) fn freed(lattice: &Component, upright: &Surface) -> Vec<Component> {
    let b = lattice.upright;
    let at = |x: usize, y: usize| upright.at(Point::new(x as f64 + 0.5, y as f64 + 0.5));
    let [mut columns, mut rows] = lines_of(lattice, upright);
    let thick = |line: &Range<f64>| line.end - line.start;
    let usual = columns.iter().chain(&rows).map(thick);
    let usual = middle(usual, f64::total_cmp).unwrap_or(0.0);
    columns.retain(|line| thick(line) <= THICK * usual);
    rows.retain(|line| thick(line) <= THICK * usual);
    let Some(thick) = columns.iter().chain(&rows).map(thick).reduce(f64::max) else {
        return Vec::new();
    };
    let ink = inked(lattice, upright);
    let across = |along: f64, x: f64| ink(x, along);
    let of = |lines: Vec<Range<f64>>, ends: Range<f64>, ink: &dyn Fn(f64, f64) -> bool| {
        let stripe = |line| Stripe {
            hidden: hidden::find(&line, &ends, ink),
            line,
        };
        lines.into_iter().map(stripe).collect::<Vec<Stripe>>()
    };
    let columns = of(columns, b.y0..b.y1, &across);
    let rows = of(rows, b.x0..b.x1, &ink);
    let is_line = |x: usize, y: usize| {
        let p = at(x, y);
        match (Stripe::at(&columns, p.x), Stripe::at(&rows, p.y)) {
            (None, None) => false,
            (Some(c), None) => !c.is_letter((p.y, p.x), across),
            (None, Some(r)) => !r.is_letter((p.x, p.y), &ink),
            (Some(_), Some(_)) => true,
        }
    };
    let mut pieces = lattice.without(is_line);
    pieces.iter_mut().for_each(|c| c.stand(upright));
    pieces.retain(|c| c.upright.size().min_side() > thick);
    pieces
}

/// A printed line and the letters' edges that run along within it.
struct Stripe {
    line: Range<f64>,
    hidden: Vec<Hidden>,
}

impl Stripe {
    /// The line at a place across.
    fn at(all: &[Self], across: f64) -> Option<&Self> {
        all.iter().find(|s| s.line.contains(&across))
    }

    /// Whether a place along it and across is a letter's; `ink` takes such places.
    fn is_letter(&self, (along, across): (f64, f64), ink: impl Fn(f64, f64) -> bool) -> bool {
        crosses(&self.line, across, |to, aside| ink(along + aside, to))
            || self.encloses(along, across)
    }

    /// Whether the edges that run along there, of which a thin stroke has two, all say so.
    fn encloses(&self, along: f64, across: f64) -> bool {
        let mut told = self.hidden.iter().filter_map(|h| h.holds(along, across));
        told.next()
            .is_some_and(|first| first && told.all(|more| more))
    }
}

/// Whether a letter crosses a line where it is at `v` across: whether there is `ink` on both sides of it, on one of
/// the ways through that place.
fn crosses(line: &Range<f64>, v: f64, ink: impl Fn(f64, f64) -> bool) -> bool {
    let (before, after) = (line.start - 1.0, line.end + 1.0);
    let through = |way: &f64| ink(before, way * (before - v)) && ink(after, way * (after - v));
    WAYS.iter().any(through)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stroke_aslant_crosses_a_line_and_what_ends_at_it_does_not() {
        // strokes 3 px thick, a line 4 px thick, and a place in its middle
        let (line, v) = (10.0..14.0, 12.0);
        for slope in [0.0, -0.4, 0.8, -1.2] {
            let stroke =
                |from: f64, to: f64, along: f64| (along - slope * to).abs() < 1.5 && to > from;
            let at = |from: f64, along: f64| {
                crosses(&line, v, |to, aside| stroke(from, to, along + aside))
            };
            assert!(at(0.0, slope * v), "{slope}: within the stroke");
            assert!(!at(0.0, slope * v + 4.0), "{slope}: beside it");
            assert!(!at(11.0, slope * v), "{slope}: it begins in the line");
        }
    }
}
