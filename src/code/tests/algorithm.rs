//! The search against Algorithm 1 as it stands: every pair of pairs, no edge or group of them put aside, and each
//! piece looked at whole.

use super::{SPLINES, boundary, code};
use crate::code::band::{Band, Begin, Vertex, near};
use crate::code::line::LOOK;
use crate::code::places::to_edge;
use crate::code::search::Search;
use crate::code::{Bounds, Closing, Kind, Steps, Width, encode};
use kurbo::Point;

const BOUNDS: Bounds = Bounds {
    t_max: 1.5,
    t_min: 1.0,
};

/// A shape's band, and what is asked of it without the search's tables.
struct Plain<'a> {
    band: &'a Band,
    kind: Kind,
}

impl Plain<'_> {
    /// Whether a point lies in the tube's part along the boundary from one point to another.
    fn holds(&self, p: Point, (first, last): (usize, usize)) -> bool {
        let (boundary, squares) = (&self.band.boundary, &self.band.squares);
        let edges = first.saturating_sub(1)..=last.min(boundary.len() - 2);
        let wide = |j: usize| f64::max(squares[j], squares[j + 1]);
        { edges }.any(|j| to_edge(p, &boundary[j..j + 2]) <= wide(j))
    }

    /// The boundary point that an edge is parted at; none if its middle lies outside.
    fn foot(&self, v: Vertex, w: Vertex) -> Option<usize> {
        let middle = v.point().midpoint(w.point());
        let off = |i: &usize| self.band.boundary[*i].distance_squared(middle);
        let nearest = (v.stage..=w.stage).min_by(|i, j| off(i).total_cmp(&off(j)));
        nearest.filter(|_| self.holds(middle, (v.stage, w.stage)))
    }

    /// Whether the piece of three vertices stays within the bounds, both ways.
    fn fits(&self, [a, q, c]: [Vertex; 3], feet: (usize, usize)) -> bool {
        let Kind::Spline(pull) = self.kind else {
            return true;
        };
        let (p, q, r) = (
            a.point().midpoint(q.point()),
            q.point(),
            q.point().midpoint(c.point()),
        );
        let dot = |k: usize| {
            let [x, y, z] = pull.quadratic(k as f64 / LOOK as f64);
            (p.to_vec2() * x + q.to_vec2() * y + r.to_vec2() * z).to_point()
        };
        let line: Vec<Point> = (0..=LOOK).map(dot).collect();
        let near = |i: usize| {
            let edges = line.windows(2);
            let off = edges.map(|w| to_edge(self.band.boundary[i], w));
            off.fold(f64::INFINITY, f64::min) <= self.band.squares[i]
        };
        line.iter().all(|&p| self.holds(p, feet)) && (feet.0..=feet.1).all(near)
    }

    /// The least bits of all that begin so.
    fn bits(&self, steps: Steps, begin: Begin) -> Option<u64> {
        let vertices = &self.band.vertices;
        let (last, around, run) = (vertices.len() - 1, self.band.around, steps.longest());
        let mut least = vec![Vec::new(); last + 1];
        let (second, end, end_foot) = match begin {
            Begin::Corner => {
                least[0].push((0, 0, 0, None));
                (0, vertices[last], around)
            }
            Begin::Edge([from, to]) => {
                let second = self.band.find(to)?;
                let foot = self.foot(vertices[0], vertices[second])?;
                let step = steps.step((to.0 - from.0, to.1 - from.1))?;
                least[second].push((steps.cost(None, step)?, 0, foot, Some(step)));
                (second, vertices[second], around + foot)
            }
        };
        let places = (-run..=run).flat_map(|dy| (-run..=run).map(move |dx| (dx, dy)));
        let places: Vec<_> = places.filter_map(|d| Some((d, steps.step(d)?))).collect();
        for at in second..last {
            for &((dx, dy), step) in &places {
                let v = vertices[at];
                let Some(to) = self.band.find((v.at.0 + dx, v.at.1 + dy)) else {
                    continue;
                };
                let w = vertices[to];
                if w.stage <= v.stage || w.stage - v.stage > 4 * around / 10 {
                    continue;
                }
                let Some(foot) = self.foot(v, w) else {
                    continue;
                };
                let cost = |&(cost, before, behind, taken): &(u64, usize, usize, _)| {
                    let fits = self.fits([vertices[before], v, w], (behind, foot));
                    Some(cost + fits.then(|| steps.cost(taken, step))??)
                };
                if let Some(cost) = least[at].iter().filter_map(cost).min() {
                    least[to].push((cost, at, foot, Some(step)));
                }
            }
        }
        let closes = |p: &&(u64, usize, usize, _)| {
            self.fits([vertices[p.1], vertices[last], end], (p.2, end_foot))
        };
        least[last].iter().filter(closes).map(|p| p.0).min()
    }
}

#[test]
fn what_is_not_looked_at_would_not_be_cheaper() {
    let shape = boundary(0.5);
    for kind in SPLINES {
        for steps in [Steps::Eight, Steps::Any, Steps::Far] {
            if steps == Steps::Far && kind != SPLINES[2] {
                continue;
            }
            let search = Search {
                boundary: &shape,
                kind,
                bounds: BOUNDS,
                steps,
            };
            let mut begin = Begin::Corner;
            for _ in 0..2 {
                let width = (Width::Bound, steps.longest());
                let band = Band::new(&shape, begin, BOUNDS, kind, width);
                let plain = Plain { band: &band, kind };
                let (vertices, bits) = search.cheapest(begin, Width::Bound).unwrap();
                assert_eq!(
                    Some(bits),
                    plain.bits(steps, begin),
                    "{kind:?} {steps:?} {begin:?}"
                );
                let edge = |i: usize| (near(vertices[i].x), near(vertices[i].y));
                let half = vertices.len() / 2;
                begin = Begin::Edge([edge(half - 1), edge(half)]);
            }
        }
    }
}

#[test]
fn the_bits_are_those_of_the_search_before_it_was_made_quicker() {
    // vertices within T and within W, on eight directions and to any place
    let shape = boundary(1.0);
    let bits = |kind, width, steps| {
        let code = code(steps, width, Closing::Corner);
        encode(&shape, kind, BOUNDS, code).unwrap().bits
    };
    let all = SPLINES.map(|kind| {
        [Width::Tolerance, Width::Bound]
            .map(|width| [Steps::Eight, Steps::Any].map(|steps| bits(kind, width, steps)))
    });
    let found = [
        [[88, 97], [83, 95]],
        [[83, 95], [83, 95]],
        [[81, 95], [81, 95]],
    ];
    assert_eq!(all, found);
}
