//! Algorithm 1: the cheapest vertices by shortest path over pairs of them.

use super::band::Band;
use super::fan::{Edge, Group, Pair, Words, arrivals, departures};
use super::piece::{Disc, Piece};
use super::places::extent;
use super::{Bounds, CodeError, Coded, Kind, Steps, Width, distortion};
use kurbo::Point;
use std::cell::Cell;

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
    check(boundary, bounds)?;
    let longest = steps.longest();
    let band = Band::new(boundary, bounds, kind, (width, longest));
    let piece = Piece::new(&band, kind, longest);
    let (pairs, last) = (pairs(&piece, steps), band.vertices.len() - 1);
    let nothing = Cell::new(usize::MAX);
    let closes = |p: &&Pair| {
        let feet = (p.foot, boundary.len());
        piece.fits([p.before, last, last], feet, &nothing)
    };
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

fn check(boundary: &[Point], bounds: Bounds) -> Result<(), CodeError> {
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
    Ok(())
}

/// The cheapest ways to all pairs of vertices, each kept with its second.
fn pairs(piece: &Piece<'_>, steps: Steps) -> Vec<Vec<Pair>> {
    let (band, words) = (piece.band, Words::new(steps));
    let last = band.vertices.len() - 1;
    let mut pairs: Vec<Vec<Pair>> = vec![Vec::new(); last + 1];
    pairs[0].push(Pair {
        cost: 0,
        before: 0,
        prev: 0,
        step: None,
        foot: 0,
    });
    // a longer way round lies farther from the step than any bound
    let ahead = usize::try_from(8 * steps.longest()).unwrap_or(usize::MAX);
    let ahead = (4 * (band.boundary.len() - 1) / 10).min(ahead);
    for at in 0..last {
        // All pairs that end here are known: their first vertices come earlier.
        let here = std::mem::take(&mut pairs[at]);
        if here.is_empty() {
            continue;
        }
        let near = arrivals(band, at, &here);
        let edges = words.edges(piece, at, ahead);
        for group in departures(band, at, &edges, steps) {
            let mut fan = Fan {
                piece,
                steps,
                at,
                here: &here,
                near: &near,
                far: group.disc,
                open: vec![None; near.len()],
            };
            for edge in group.members.iter().map(|&i| edges[i]) {
                if let Some(pair) = fan.cheapest(edge) {
                    pairs[edge.to].push(pair);
                }
            }
        }
        pairs[at] = here;
    }
    pairs
}

/// The pairs that end at a vertex, and the edges of a group that leave it.
struct Fan<'a> {
    piece: &'a Piece<'a>,
    steps: Steps,
    at: usize,
    here: &'a [Pair],
    near: &'a [Group],
    far: Disc,
    /// Whether edges of the group may follow pairs of each of the others; none where it is not yet known.
    open: Vec<Option<bool>>,
}

impl Fan<'_> {
    /// The cheapest pair that ends here and that an edge may follow; the edge with it.
    fn cheapest(&mut self, edge: Edge) -> Option<Pair> {
        let least = self.steps.least(edge.step);
        let mut best: Option<(u64, usize)> = None;
        let worse = |cost: u64, best: Option<(u64, usize)>| best.is_some_and(|b| cost >= b.0);
        for g in 0..self.near.len() {
            let group = &self.near[g];
            if worse(group.cost + least, best) {
                break;
            }
            if !self.opens(g, edge) {
                continue;
            }
            for &prev in &group.members {
                let p = self.here[prev];
                if worse(p.cost + least, best) {
                    break;
                }
                let Some(bits) = self.steps.cost(p.step, edge.step) else {
                    continue;
                };
                let (three, feet) = ([p.before, self.at, edge.to], (p.foot, edge.foot));
                if !worse(p.cost + bits, best) && self.piece.fits(three, feet, &group.far) {
                    best = Some((p.cost + bits, prev));
                }
            }
        }
        best.map(|(cost, prev)| Pair {
            cost,
            before: self.at,
            prev,
            step: Some(edge.step),
            foot: edge.foot,
        })
    }

    /// Whether an edge may follow pairs of a group.
    fn opens(&mut self, g: usize, edge: Edge) -> bool {
        /// Smaller groups are not worth a look of their own.
        const FEW: usize = 3;
        let (piece, group) = (self.piece, &self.near[g]);
        if piece.kind == Kind::Polygon {
            return true;
        }
        let strays = |end: Disc| piece.strays(group.disc, self.at, end, &group.far);
        let open = *self.open[g].get_or_insert_with(|| !strays(self.far));
        let few = group.members.len() < FEW;
        open && (few || !strays(piece.end(edge.to, self.at, edge.foot)))
    }
}
