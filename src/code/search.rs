//! Algorithm 1: the cheapest vertices by shortest path over pairs of them.

use super::band::{Band, extent};
use super::piece::Piece;
use super::vertex::{RUN, Step};
use super::{Bounds, CodeError, Coded, Kind, Steps, Width, distortion};
use kurbo::{Point, Rect};
use std::collections::BTreeMap;

/// Boundary points that a step may pass: a longer way round lies farther from it than any bound.
const AHEAD: usize = 8 * RUN as usize;

/// A pair of vertices, kept with the second.
#[derive(Debug, Clone, Copy)]
struct Pair {
    cost: u64,
    before: usize,
    /// The pair that came before: its place among those of `before`.
    prev: usize,
    /// None at the start.
    step: Option<Step>,
    /// Boundary point nearest to the middle of the edge.
    foot: usize,
}

/// An edge that may leave a vertex.
#[derive(Debug, Clone, Copy)]
struct Edge {
    to: usize,
    step: Step,
    foot: usize,
}

/// The vertices of least bits whose curve stays within the bounds of a closed boundary (whole px, the
/// first point not repeated). The curve begins and ends on the first point, as Algorithm 1's does.
///
/// # Errors
/// The boundary is too short, the bounds are out of order, or no vertices meet them.
pub fn encode(
    boundary: &[Point],
    kind: Kind,
    bounds: Bounds,
    width: Width,
    steps: Steps,
) -> Result<Coded, CodeError> {
    /// Fewer points enclose nothing worth a curve.
    const FEW: usize = 8;
    /// Larger shapes take too long, and their tubes too much memory, px.
    const LARGE: f64 = 1024.0;
    if boundary.len() < FEW {
        return Err(CodeError::Short(boundary.len()));
    }
    if !(bounds.t_min > 0.0 && bounds.t_min <= bounds.t_max && bounds.t_max.is_finite()) {
        return Err(CodeError::Bounds(bounds.t_max, bounds.t_min));
    }
    let size = extent(boundary).size();
    if size.max_side() > LARGE || !boundary.iter().all(|p| p.is_finite()) {
        return Err(CodeError::Large(size.width, size.height));
    }
    let band = Band::new(boundary, bounds, kind, width);
    let piece = Piece::new(&band, kind);
    let last = band.vertices.len() - 1;
    let mut pairs: Vec<Vec<Pair>> = vec![Vec::new(); last + 1];
    pairs[0].push(Pair {
        cost: 0,
        before: 0,
        prev: 0,
        step: None,
        foot: 0,
    });
    let words = steps.words();
    for at in 0..last {
        // All pairs that end here are known: their first vertices come earlier.
        let here = std::mem::take(&mut pairs[at]);
        let near = neighbours(&band, &here, at);
        for edge in edges(&piece, &words, at) {
            if let Some(pair) = cheapest(&piece, steps, (at, &here), &near, edge) {
                pairs[edge.to].push(pair);
            }
        }
        pairs[at] = here;
    }
    let closes = |p: &&Pair| piece.fits([p.before, last, last], (p.foot, boundary.len()));
    let end = pairs[last].iter().filter(closes).min_by_key(|p| p.cost);
    let end = end.ok_or(CodeError::Unreachable)?;
    let mut vertices = vec![band.vertices[last].point()];
    let mut pair = end;
    while pair.step.is_some() {
        vertices.push(band.vertices[pair.before].point());
        pair = &pairs[pair.before][pair.prev];
    }
    vertices.reverse();
    let curve = piece.curve(&vertices);
    let (d_max, d_ms) = distortion(boundary, &curve);
    Ok(Coded {
        vertices,
        bits: end.cost,
        curve,
        d_max,
        d_ms,
    })
}

/// The cheapest pair that ends here and that an edge may follow; the edge with it.
fn cheapest(
    piece: &Piece<'_>,
    steps: Steps,
    (at, here): (usize, &[Pair]),
    near: &[Group],
    edge: Edge,
) -> Option<Pair> {
    let least = steps.least(edge.step);
    let mut best: Option<(u64, usize)> = None;
    let worse = |cost: u64, best: Option<(u64, usize)>| best.is_some_and(|b| cost >= b.0);
    for group in near {
        if worse(group.cost + least, best) {
            break;
        }
        if piece.kind != Kind::Polygon
            && group.pairs.len() > 2
            && piece.strays(group.disc, [at, edge.to], (group.foot, edge.foot))
        {
            continue;
        }
        for &prev in &group.pairs {
            let p = here[prev];
            if worse(p.cost + least, best) {
                break;
            }
            let Some(bits) = steps.cost(p.step, edge.step) else {
                continue;
            };
            if !worse(p.cost + bits, best)
                && piece.fits([p.before, at, edge.to], (p.foot, edge.foot))
            {
                best = Some((p.cost + bits, prev));
            }
        }
    }
    best.map(|(cost, prev)| Pair {
        cost,
        before: at,
        prev,
        step: Some(edge.step),
        foot: edge.foot,
    })
}

/// Pairs whose edges' middles are near each other.
#[derive(Debug)]
struct Group {
    /// Of the cheapest.
    cost: u64,
    /// The middles lie in it: its own middle and radius, px.
    disc: (Point, f64),
    /// The last of their feet.
    foot: usize,
    /// The cheapest first.
    pairs: Vec<usize>,
}

/// The pairs that end at a vertex in groups, that of the cheapest first.
fn neighbours(band: &Band, here: &[Pair], at: usize) -> Vec<Group> {
    /// Side of the squares that the first vertices of a group lie in, px.
    const SIDE: i32 = 2;
    let mut squares: BTreeMap<(i32, i32), Vec<usize>> = BTreeMap::new();
    for (i, p) in here.iter().enumerate() {
        let (x, y) = band.vertices[p.before].at;
        let square = (x.div_euclid(SIDE), y.div_euclid(SIDE));
        squares.entry(square).or_default().push(i);
    }
    let group = |mut pairs: Vec<usize>| {
        pairs.sort_by_key(|&i| here[i].cost);
        let first = |i: &usize| band.vertices[here[*i].before].point();
        let around = pairs.iter().map(first).map(|p| Rect::from_points(p, p));
        let around = around.reduce(|a, b| a.union(b)).unwrap_or_default();
        let middle = around.center().midpoint(band.vertices[at].point());
        Group {
            cost: pairs.first().map_or(0, |&i| here[i].cost),
            foot: pairs.iter().map(|&i| here[i].foot).max().unwrap_or(0),
            disc: (middle, 0.25 * around.size().to_vec2().hypot()),
            pairs,
        }
    };
    let mut groups: Vec<Group> = squares.into_values().map(group).collect();
    groups.sort_by_key(|g| g.cost);
    groups
}

/// The edges from a vertex to later ones whose middle is near the boundary between.
fn edges(piece: &Piece<'_>, words: &[((i32, i32), Step)], from: usize) -> Vec<Edge> {
    let band = piece.band;
    let (at, stage) = (band.vertices[from].at, band.vertices[from].stage);
    let most = stage + (4 * (band.boundary.len() - 1) / 10).min(AHEAD);
    let edge = |&((dx, dy), step): &((i32, i32), Step)| {
        let to = band.find((at.0 + dx, at.1 + dy))?;
        let there = band.vertices[to].stage;
        let foot = (stage < there && there <= most && !piece.leaves(from, to))
            .then(|| piece.foot(from, to))??;
        Some(Edge { to, step, foot })
    };
    words.iter().filter_map(edge).collect()
}
