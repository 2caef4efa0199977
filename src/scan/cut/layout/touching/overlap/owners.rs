//! Corners inwards → whose the stretches of edge between them are.
//!
//! Of two letters. At a corner at which the owner changes the first one's edge goes into the ink and comes out at
//! another such corner, and so does the other one's. All ways to share the stretches out are compared: what the
//! hidden edges cost, how far the stretches lie on the wrong side of the border, how far the letters are from the
//! middle of their cells, and which corners are left that no crossing explains. The prices were chosen on 190 borders
//! of 25 fonts (docs/tried.md, "Letters that lie over each other"), each half of them tried on the other.

use super::edges::{Edges, Lie};
use super::hidden::{Hidden, Stub};
use super::shape::Stretch;
use crate::numeric::assignment::assign;
use kurbo::Point;
use std::collections::BTreeMap;

/// What an edge as long as half the border's stretch costs that lies as far from its middle, on the wrong side.
const ASTRAY: f64 = 0.4;
/// A stretch that costs so much more one way than the other has an owner for certain.
const CERTAIN: f64 = 4.0;
/// What a sharp corner at the border costs that stays one letter's own.
const OWN: f64 = 0.5;
/// What it costs that a letter's middle is half the border's stretch from its cell's.
const MIDDLE: f64 = 3.0;
/// What each stroke's width of an edge costs that lies along the example of the other letter alone.
const TOLD: f64 = 1.0;
/// What it costs to cut through a stroke, where no edge goes on beneath the other letter.
const SEVERED: f64 = 0.6;
/// Ways that cost more are not believed.
const DEAREST: f64 = 4.0;
/// So many corners of each kind may be between two letters.
const CROSSINGS: usize = 3;
/// What an edge costs that cannot be.
const NEVER: f64 = 1e6;
/// So many of the likeliest ways are given.
const WAYS: usize = 16;
/// So many choices are looked at.
const CHOICES: usize = 250_000;

/// Whose an edge is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Owner {
    /// The letter before the border.
    First,
    /// The one after it.
    Second,
}

/// A way to share edges out.
#[derive(Debug, Clone)]
pub(super) struct Split {
    /// How unlikely it is.
    pub(super) cost: f64,
    /// Of the stretch after each corner.
    owners: Vec<Owner>,
    /// Of each ring without a corner.
    whole: Vec<(usize, Owner)>,
    /// From the corner where an edge goes into the ink to the one where it comes out, and how.
    hidden: BTreeMap<(Owner, usize), (usize, Vec<Point>)>,
}

impl Split {
    /// The closed outlines of one letter.
    pub(super) fn outlines(&self, edges: &Edges, owner: Owner) -> Vec<Vec<Stretch>> {
        let rings = self.whole.iter().filter(|(_, o)| *o == owner);
        let rings = rings.map(|(r, _)| vec![Stretch::Seen(edges.rings[*r].clone())]);
        let mut out: Vec<Vec<Stretch>> = rings.collect();
        let before = edges.before();
        let is_cut = |corner: usize| self.owners[before[corner]] != self.owners[corner];
        let own = |k: &usize| self.owners[*k] == owner;
        let mut left: Vec<usize> = (0..self.owners.len()).filter(own).collect();
        while let Some(&start) = left.first() {
            let mut outline = Vec::new();
            let mut at = start;
            while left.contains(&at) {
                left.retain(|&k| k != at);
                let end = edges.next(at);
                outline.push(Stretch::Seen(edges.cut(at, [is_cut(at), is_cut(end)])));
                at = end;
                if let Some((to, path)) = self.hidden.get(&(owner, end)) {
                    outline.push(Stretch::Hidden(path.clone()));
                    at = *to;
                }
            }
            out.push(outline);
        }
        out
    }
}

/// The likeliest ways to share out edges, the likeliest first. `middles` says where both letters' middles are, in
/// halves of the border's stretch behind it, as far as that is known.
pub(super) fn likeliest(edges: &Edges, middles: [Option<f64>; 2]) -> Vec<Split> {
    let whole: Vec<(usize, Owner, Lie)> = edges
        .whole()
        .map(|(ring, lie)| {
            let behind = lie.beyond[1] > lie.beyond[0];
            let owner = if behind { Owner::Second } else { Owner::First };
            (ring, owner, lie)
        })
        .collect();
    let n = edges.corners.len();
    let before = edges.before();
    let between = |(owner, i, j): (usize, usize, usize)| {
        let (from, to) = (edges.finish(before[i]), (i != j).then(|| edges.begin(j))?);
        let is_joint = [i, j].iter().all(|&k| edges.corners[k].is_joint);
        let along = is_joint.then(|| edges.across.along());
        let example = edges.examples[owner].as_ref();
        let example = example.and_then(|e| e.between(from.at, to.at));
        Hidden::between(from, to, (edges.stroke, along), example, |p| {
            edges.is_ink(p)
        })
    };
    let hidden = [0, 1].map(|owner| {
        let to = |i: usize| (0..n).map(|j| between((owner, i, j))).collect();
        (0..n).map(to).collect::<Vec<Vec<Option<Hidden>>>>()
    });
    let least =
        |to: &Vec<Option<Hidden>>| to.iter().flatten().map(|h| h.cost).fold(NEVER, f64::min);
    let known = |k: usize| middles[k].filter(|_| edges.examples[k].is_none());
    let mut search = Search {
        edges,
        middles: [known(0), known(1)],
        told: (0..n).map(|k| edges.told(k)).collect(),
        lies: (0..n).map(|k| edges.lie(k)).collect(),
        whole: &whole,
        doubts: (0..n).map(|k| edges.doubt(k)).collect(),
        least: hidden.each_ref().map(|h| h.iter().map(least).collect()),
        before: &before,
        hidden: &hidden,
        found: Vec::new(),
        left: CHOICES,
    };
    search.go_on(&mut Vec::new(), So::default());
    let split = |(cost, owners): (f64, Vec<Owner>)| {
        let pairs = search.pairs(&owners).unwrap_or_default().into_iter();
        let path = |owner: Owner, i: usize, j: usize| {
            let hidden = hidden[owner as usize][i][j].as_ref()?;
            Some(hidden.path(search.farther(&owners, owner, hidden)))
        };
        let paths = pairs.filter_map(|(owner, i, j)| Some(((owner, i), (j, path(owner, i, j)?))));
        Split {
            cost,
            hidden: paths.collect(),
            whole: whole
                .iter()
                .map(|(ring, owner, _)| (*ring, *owner))
                .collect(),
            owners,
        }
    };
    search.found.clone().into_iter().map(split).collect()
}

/// What the owners of some stretches say.
#[derive(Debug, Clone, Copy, Default)]
struct So {
    /// What it costs where they lie.
    place: f64,
    /// And their hidden edges and own corners, at least.
    least: f64,
    /// At how many corners each letter's edge comes out.
    crossings: [usize; 2],
}

/// The search for the likeliest owners of the stretches after each corner.
struct Search<'a> {
    edges: &'a Edges,
    middles: [Option<f64>; 2],
    lies: Vec<Lie>,
    /// How much of each stretch lies along the example of the one letter alone, and of the other.
    told: Vec<[f64; 2]>,
    /// The rings without a corner.
    whole: &'a [(usize, Owner, Lie)],
    doubts: Vec<f64>,
    /// What the edge that goes into the ink at each corner costs at least.
    least: [Vec<f64>; 2],
    before: &'a [usize],
    hidden: &'a [Vec<Vec<Option<Hidden>>>; 2],
    /// What ways cost, the likeliest first.
    found: Vec<(f64, Vec<Owner>)>,
    /// How many more choices are looked at.
    left: usize,
}

impl Search<'_> {
    /// Cost from which on a way is not looked at.
    fn worst(&self) -> f64 {
        let last = self.found.last().filter(|_| self.found.len() >= WAYS);
        last.map_or(DEAREST, |s| s.0)
    }

    /// Gives the next stretch each owner that it may have.
    fn go_on(&mut self, owners: &mut Vec<Owner>, so: So) {
        let k = owners.len();
        if k == self.lies.len() {
            return self.take(owners, so.place);
        }
        let [before, behind] = self.lies[k].beyond.map(|v| ASTRAY * v);
        let [first, second] = self.told[k].map(|v| TOLD * v);
        let (behind, before) = (behind + first, before + second);
        let mut choices = [
            (Owner::First, behind, before),
            (Owner::Second, before, behind),
        ];
        // the likelier one first
        choices.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (owner, astray, other) in choices {
            let mut next = So {
                place: so.place + astray,
                ..so
            };
            match owners.get(self.before[k]) {
                Some(same) if *same == owner => next.least += OWN * self.doubts[k],
                Some(other) => {
                    next.least += self.least[*other as usize][k];
                    next.crossings[owner as usize] += 1;
                }
                None => (),
            }
            let likely = astray - other < CERTAIN && next.place + next.least < self.worst();
            let few = next.crossings.iter().all(|n| *n <= CROSSINGS);
            if likely && few && self.left > 0 {
                self.left -= 1;
                owners.push(owner);
                self.go_on(owners, next);
                owners.pop();
            }
        }
    }

    /// Keeps a way if it is one of the likeliest.
    fn take(&mut self, owners: &[Owner], place: f64) {
        let Some(pairs) = self.pairs(owners) else {
            return;
        };
        let edges = || {
            pairs
                .iter()
                .filter_map(|&(owner, i, j)| self.hidden[owner as usize][i][j].as_ref())
        };
        // of the two edges at a crossing one goes on
        let severed = edges()
            .filter(|h| h.is_cut)
            .count()
            .saturating_sub(pairs.len() / 2);
        let own = (0..owners.len()).filter(|&k| owners[k] == owners[self.before[k]]);
        let own: f64 = own.map(|k| self.doubts[k]).sum();
        let hidden: f64 = edges().map(|h| h.cost).sum();
        let off = MIDDLE * self.off(owners, &pairs);
        let cost = place + hidden + OWN * own + SEVERED * severed as f64 + off;
        if cost < self.worst() {
            let at = self.found.partition_point(|s| s.0 <= cost);
            self.found.insert(at, (cost, owners.to_vec()));
            self.found.truncate(WAYS);
        }
    }

    /// How far the letters' middles are from where they belong, halves of the border's stretch.
    fn off(&self, owners: &[Owner], pairs: &[(Owner, usize, usize)]) -> f64 {
        let off = |(owner, middle): (Owner, Option<f64>)| {
            let own = pairs.iter().filter(|p| p.0 == owner);
            let hidden = own.filter_map(|&(_, i, j)| self.hidden[owner as usize][i][j].as_ref());
            let ends = hidden.filter_map(|h| {
                let stub = h.stub?;
                let end = stub.at + self.farther(owners, owner, h) * stub.way;
                Some(self.edges.across.at(end))
            });
            let [from, to] =
                ends.fold(self.extent(owners, owner), |[a, b], e| [a.min(e), b.max(e)]);
            middle.map_or(0.0, |m| ((from + to) / 2.0 - m).abs())
        };
        let letters = [Owner::First, Owner::Second].into_iter();
        letters.zip(self.middles).map(off).sum()
    }

    /// From where to where the edges of a letter reach that are seen.
    fn extent(&self, owners: &[Owner], owner: Owner) -> [f64; 2] {
        let stretches = owners.iter().zip(&self.lies).map(|(o, l)| (*o, l.extent));
        let rings = self.whole.iter().map(|(_, o, l)| (*o, l.extent));
        let own = stretches.chain(rings).filter(|(o, _)| *o == owner);
        own.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], (_, e)| {
            [a.min(e[0]), b.max(e[1])]
        })
    }

    /// How much farther a letter's stroke that ends beneath the ink goes on, px: until the letter's middle is where it
    /// belongs, if that is known.
    fn farther(&self, owners: &[Owner], owner: Owner, hidden: &Hidden) -> f64 {
        let middle = self.middles[owner as usize];
        let farther = |(stub, middle): (Stub, f64)| {
            let across = &self.edges.across;
            let [from, to] = self.extent(owners, owner);
            let forth = stub.way.dot(across.along());
            let other = if forth > 0.0 { from } else { to };
            let end = 2.0 * middle - other;
            ((end - across.at(stub.at)) / (forth * across.step())).clamp(0.0, stub.most)
        };
        hidden.stub.zip(middle).map_or(0.0, farther)
    }

    /// The corners between which each letter's hidden edges run at the least cost; none where there is no such edge,
    /// or too many.
    fn pairs(&self, owners: &[Owner]) -> Option<Vec<(Owner, usize, usize)>> {
        let ends = |of: Owner| {
            let ends =
                (0..owners.len()).filter(|&k| owners[self.before[k]] == of && owners[k] != of);
            ends.collect::<Vec<usize>>()
        };
        // where the first letter's edge goes in the second's comes out
        let (first, second) = (ends(Owner::First), ends(Owner::Second));
        if !(1..=CROSSINGS).contains(&first.len()) || first.len() != second.len() {
            return None;
        }
        let mut out = Vec::new();
        let both = [
            (Owner::First, &first, &second),
            (Owner::Second, &second, &first),
        ];
        for (owner, from, to) in both {
            let hidden = &self.hidden[owner as usize];
            let cost = |i: usize, j: usize| hidden[i][j].as_ref().map_or(NEVER, |h| h.cost);
            let row = |&i: &usize| to.iter().map(|&j| cost(i, j)).collect();
            let costs: Vec<Vec<f64>> = from.iter().map(row).collect();
            let pairs = assign(&costs).into_iter().enumerate();
            for (i, j) in pairs {
                if costs[i][j] >= NEVER {
                    return None;
                }
                out.push((owner, from[i], to[j]));
            }
        }
        Some(out)
    }
}
