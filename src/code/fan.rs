//! What meets at a vertex: the pairs that end there and the edges that leave it, in groups by where they go.

use super::Steps;
use super::band::Band;
use super::piece::{Disc, Piece};
use super::vertex::Step;
use kurbo::{Point, Rect};
use std::cell::Cell;
use std::collections::BTreeMap;

/// A pair of vertices, kept with the second.
#[derive(Debug, Clone, Copy)]
pub(super) struct Pair {
    pub(super) cost: u64,
    pub(super) before: usize,
    /// The pair that came before: its place among those of `before`.
    pub(super) prev: usize,
    /// None at the start.
    pub(super) step: Option<Step>,
    /// Boundary point nearest to the middle of the edge.
    pub(super) foot: usize,
}

/// An edge that may leave a vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct Edge {
    pub(super) to: usize,
    pub(super) step: Step,
    pub(super) foot: usize,
}

/// Pairs or edges whose middles are near each other.
#[derive(Debug)]
pub(super) struct Group {
    /// The least of theirs.
    pub(super) cost: u64,
    /// Where their middles lie.
    pub(super) disc: Disc,
    /// Their places, the cheapest first.
    pub(super) members: Vec<usize>,
    /// The boundary point that the last of their pieces passed too far away, much like the next as a rule.
    pub(super) far: Cell<usize>,
}

/// One of a group: its other vertex, foot and cost.
type Member = (usize, usize, u64);

/// The pairs that end at a vertex, that group first which has the cheapest.
pub(super) fn arrivals(band: &Band, at: usize, here: &[Pair]) -> Vec<Group> {
    /// Side of the squares that the first vertices of a group lie in, px.
    const SIDE: i32 = 2;
    let members: Vec<Member> = here.iter().map(|p| (p.before, p.foot, p.cost)).collect();
    groups(band, at, &members, (SIDE, usize::max))
}

/// The edges that leave a vertex, by the least that they take.
pub(super) fn departures(band: &Band, at: usize, edges: &[Edge], steps: Steps) -> Vec<Group> {
    /// The same for the last vertices.
    const SIDE: i32 = 4;
    let member = |e: &Edge| (e.to, e.foot, steps.least(e.step));
    let members: Vec<Member> = edges.iter().map(member).collect();
    groups(band, at, &members, (SIDE, usize::min))
}

fn groups(
    band: &Band,
    at: usize,
    all: &[Member],
    (side, foot): (i32, fn(usize, usize) -> usize),
) -> Vec<Group> {
    let mut squares: BTreeMap<(i32, i32), Vec<usize>> = BTreeMap::new();
    for (i, &(other, ..)) in all.iter().enumerate() {
        let (x, y) = band.vertices[other].at;
        let square = (x.div_euclid(side), y.div_euclid(side));
        squares.entry(square).or_default().push(i);
    }
    let group = |mut members: Vec<usize>| {
        members.sort_by_key(|&i| all[i].2);
        let around = |&i: &usize| Rect::from_points(place(band, all[i].0), place(band, all[i].0));
        let around = members.iter().map(around).reduce(|a, b| a.union(b));
        let around = around.unwrap_or_default();
        Group {
            cost: members.first().map_or(0, |&i| all[i].2),
            disc: Disc {
                middle: around.center().midpoint(place(band, at)),
                radius: 0.25 * around.size().to_vec2().hypot(),
                foot: members.iter().map(|&i| all[i].1).reduce(foot).unwrap_or(0),
            },
            members,
            far: Cell::new(usize::MAX),
        }
    };
    let mut groups: Vec<Group> = squares.into_values().map(group).collect();
    groups.sort_by_key(|g| g.cost);
    groups
}

fn place(band: &Band, vertex: usize) -> Point {
    band.vertices[vertex].point()
}

/// The steps of a code.
#[derive(Debug)]
pub(super) struct Words(Vec<((i32, i32), Step)>);

impl Words {
    pub(super) fn new(steps: Steps) -> Self {
        let run = steps.longest();
        let places = (-run..=run).flat_map(|dy| (-run..=run).map(move |dx| (dx, dy)));
        Self(
            places
                .filter_map(|at| Some((at, steps.step(at)?)))
                .collect(),
        )
    }

    /// The edges from a vertex to later ones whose middle is near the boundary between.
    pub(super) fn edges(&self, piece: &Piece<'_>, from: usize, ahead: usize) -> Vec<Edge> {
        let band = piece.band;
        let (at, stage) = (band.vertices[from].at, band.vertices[from].stage);
        let edge = |&((dx, dy), step): &((i32, i32), Step)| {
            if band.tube.shuts((2 * at.0 + dx, 2 * at.1 + dy)) {
                return None;
            }
            let to = band.find((at.0 + dx, at.1 + dy))?;
            let there = band.vertices[to].stage;
            let foot = (stage < there && there <= stage + ahead && !piece.leaves(from, to))
                .then(|| piece.foot(from, to))??;
            Some(Edge { to, step, foot })
        };
        self.0.iter().filter_map(edge).collect()
    }
}
