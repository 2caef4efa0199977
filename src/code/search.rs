//! Algorithm 1: the cheapest vertices by shortest path over pairs of them.

use super::band::Band;
use super::piece::Piece;
use super::vertex::{RUN, Step};
use super::{Bounds, CodeError, Coded, Kind, Steps, distortion};
use kurbo::Point;

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
    steps: Steps,
) -> Result<Coded, CodeError> {
    /// Fewer points enclose nothing worth a curve.
    const FEW: usize = 8;
    if boundary.len() < FEW {
        return Err(CodeError::Short(boundary.len()));
    }
    if !(bounds.t_min > 0.0 && bounds.t_min <= bounds.t_max && bounds.t_max.is_finite()) {
        return Err(CodeError::Bounds(bounds.t_max, bounds.t_min));
    }
    let band = Band::new(boundary, bounds, kind);
    let piece = Piece { band: &band, kind };
    let last = band.vertices.len() - 1;
    let mut pairs: Vec<Vec<Pair>> = vec![Vec::new(); last + 1];
    pairs[0].push(Pair {
        cost: 0,
        before: 0,
        prev: 0,
        step: None,
        foot: 0,
    });
    let mut order: Vec<(u64, usize)> = Vec::new();
    for at in 0..last {
        // All pairs that end here are known: their first vertices come earlier.
        let here = std::mem::take(&mut pairs[at]);
        for edge in edges(&piece, steps, at) {
            let cost = |p: &Pair| steps.cost(p.step, edge.step).map(|bits| p.cost + bits);
            order.clear();
            order.extend((0..here.len()).filter_map(|i| Some((cost(&here[i])?, i))));
            order.sort_unstable();
            // The cheapest whose curve fits; those after it are not looked at.
            let fits = |&&(_, i): &&(u64, usize)| {
                piece.fits([here[i].before, at, edge.to], (here[i].foot, edge.foot))
            };
            if let Some(&(cost, prev)) = order.iter().find(fits) {
                pairs[edge.to].push(Pair {
                    cost,
                    before: at,
                    prev,
                    step: Some(edge.step),
                    foot: edge.foot,
                });
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

/// The edges from a vertex to later ones whose middle is near the boundary between.
fn edges(piece: &Piece<'_>, steps: Steps, from: usize) -> Vec<Edge> {
    let band = piece.band;
    let (at, stage) = (band.vertices[from].at, band.vertices[from].stage);
    let most = stage + (4 * (band.boundary.len() - 1) / 10).min(AHEAD);
    let window = (-RUN..=RUN).flat_map(|dy| (-RUN..=RUN).map(move |dx| (dx, dy)));
    let edge = |(dx, dy): (i32, i32)| {
        let step = Step::new((dx, dy))?;
        steps.cost(None, step)?;
        let to = band.find((at.0 + dx, at.1 + dy))?;
        let there = band.vertices[to].stage;
        let foot = (stage < there && there <= most).then(|| piece.foot(from, to))??;
        Some(Edge { to, step, foot })
    };
    window.filter_map(edge).collect()
}
