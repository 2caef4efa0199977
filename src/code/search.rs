//! Algorithm 1: the cheapest vertices by shortest path over pairs of them.

use super::band::{Band, Begin};
use super::fan::{Edge, Group, Pair, Words, arrivals, departures};
use super::piece::{Disc, Piece};
use super::{Bounds, Kind, Steps, Width};
use kurbo::Point;
use std::cell::Cell;

/// Vertices, the first again at the end, and their bits.
pub(super) type Found = (Vec<Point>, u64);

/// What is coded.
pub(super) struct Search<'a> {
    pub(super) boundary: &'a [Point],
    pub(super) kind: Kind,
    pub(super) bounds: Bounds,
    pub(super) steps: Steps,
}

impl Search<'_> {
    /// The cheapest of all that begin so; none within the bounds.
    pub(super) fn cheapest(&self, begin: Begin, width: Width) -> Option<Found> {
        let longest = self.steps.longest();
        let band = Band::new(
            self.boundary,
            begin,
            self.bounds,
            self.kind,
            (width, longest),
        );
        let piece = Piece::new(&band, self.kind, longest);
        let last = band.vertices.len() - 1;
        let (first, [second, foot]) = self.first(&piece, begin)?;
        let pairs = pairs(&piece, self.steps, (first, second));
        // the last piece ends where the first edge does, a turn later
        let (next, foot) = match begin {
            Begin::Corner => (last, band.around),
            Begin::Edge(_) => (second, band.around + foot),
        };
        let nothing = Cell::new(usize::MAX);
        let closes = |p: &&Pair| piece.fits([p.before, last, next], (p.foot, foot), &nothing);
        let end = pairs[last].iter().filter(closes).min_by_key(|p| p.cost)?;
        let mut vertices = vec![band.vertices[last].point()];
        let mut pair = end;
        while pair.before > 0 {
            vertices.push(band.vertices[pair.before].point());
            pair = &pairs[pair.before][pair.prev];
        }
        vertices.push(band.vertices[0].point());
        vertices.reverse();
        Some((vertices, end.cost))
    }

    /// The pair that all curves begin with, its second vertex, and the boundary point nearest to its middle.
    fn first(&self, piece: &Piece<'_>, begin: Begin) -> Option<(Pair, [usize; 2])> {
        let pair = |cost, step, foot| Pair {
            cost,
            before: 0,
            prev: 0,
            step,
            foot,
        };
        let Begin::Edge([from, to]) = begin else {
            return Some((pair(0, None, 0), [0, 0]));
        };
        let second = piece.band.find(to)?;
        let step = self.steps.step((to.0 - from.0, to.1 - from.1))?;
        let foot = piece.foot(0, second)?;
        let cost = self.steps.cost(None, step)?;
        Some((pair(cost, Some(step), foot), [second, foot]))
    }
}

/// The cheapest ways from a pair to all pairs of vertices, each kept with its second.
fn pairs(piece: &Piece<'_>, steps: Steps, (first, second): (Pair, usize)) -> Vec<Vec<Pair>> {
    let (band, words) = (piece.band, Words::new(steps));
    let last = band.vertices.len() - 1;
    let mut pairs: Vec<Vec<Pair>> = vec![Vec::new(); last + 1];
    pairs[second].push(first);
    // a longer way round lies farther from the step than any bound
    let ahead = usize::try_from(8 * steps.longest()).unwrap_or(usize::MAX);
    let ahead = (4 * band.around / 10).min(ahead);
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
