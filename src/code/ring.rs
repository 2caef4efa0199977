//! Curves without a corner where they begin.

use super::band::{Begin, near};
use super::search::{Found, Search};
use super::{Steps, Width};
use kurbo::Point;

/// The cheapest ring through an edge of one that was found before, each time one on its other side, until it is no
/// cheaper than the last. The first edge is of a curve with a corner, whose vertices lie no farther from the boundary
/// than the curve: half way around little is left of the corner.
pub(super) fn cheapest(search: &Search<'_>, width: Width) -> Option<Found> {
    let (mut ring, _) = search.cheapest(Begin::Corner, Width::Tolerance)?;
    let mut best: Option<Found> = None;
    while let Some(other) = through(search, width, &ring) {
        let found = begun(&other, search.steps)?;
        if best.as_ref().is_some_and(|b| found.1 >= b.1) {
            break;
        }
        best = Some(found);
        ring = other;
    }
    best
}

/// The cheapest ring that has the edge half way around another; where there is none the edge after it.
fn through(search: &Search<'_>, width: Width, ring: &[Point]) -> Option<Vec<Point>> {
    let edges = ring.windows(2).map(|w| [whole(w[0]), whole(w[1])]);
    let edges: Vec<_> = edges.collect();
    let (before, after) = edges.split_at(edges.len() / 2);
    let mut edges = after.iter().chain(before);
    edges.find_map(|&edge| Some(search.cheapest(Begin::Edge(edge), width)?.0))
}

/// A ring from the vertex that it takes the least bits from.
fn begun(ring: &[Point], steps: Steps) -> Option<Found> {
    let round = &ring[1..];
    let from = |first: usize| {
        let vertices = (0..=round.len()).map(|k| round[(first + k) % round.len()]);
        let vertices: Vec<Point> = vertices.collect();
        let bits = steps.write(&vertices)?.len() as u64;
        Some((vertices, bits))
    };
    (0..round.len()).filter_map(from).min_by_key(|f| f.1)
}

fn whole(p: Point) -> (i32, i32) {
    (near(p.x), near(p.y))
}
