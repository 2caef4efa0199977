//! Pieces in reading order, and the letters that they make.

use super::pieces::{Piece, Tie, Usual};
use super::reading::{Body, Reading, Role, Seen, align, unwanted};
use crate::scan::letters::Shape;

/// The pieces of a page in reading order.
pub(super) struct Lines<'a> {
    pub(super) pieces: Vec<&'a Piece>,
    /// What each of them may be a part of, by places in reading order.
    ties: Vec<Vec<Tie>>,
    usual: Usual,
}

impl<'a> Lines<'a> {
    /// Pieces as rows have them; those in no row are left out.
    pub(super) fn new(
        pieces: &'a [Piece],
        ties: &[Vec<Tie>],
        rows: &[Vec<usize>],
        usual: Usual,
    ) -> Self {
        let order: Vec<usize> = rows.iter().flatten().copied().collect();
        let mut place = vec![None; pieces.len()];
        for (at, &i) in order.iter().enumerate() {
            place[i] = Some(at);
        }
        let placed = |t: &Tie| place[t.to].map(|to| Tie { to, ..*t });
        let own = |&i: &usize| ties[i].iter().filter_map(placed).collect();
        Self {
            ties: order.iter().map(own).collect(),
            pieces: order.iter().map(|&i| &pieces[i]).collect(),
            usual,
        }
    }

    /// What each piece is, and of which name its letter is. `dirt` says which pieces may be none.
    pub(super) fn read(
        &self,
        names: &[Option<Shape>],
        dirt: &[bool],
    ) -> (Reading, Vec<Option<usize>>) {
        let mut seen = self.seen(dirt);
        loop {
            let reading = align(&seen, names);
            let owners = self.share(&reading.roles, names);
            let is_lost = |i: &usize| reading.roles[*i] == Role::Part && owners[*i].is_none();
            let lost: Vec<usize> = (0..seen.len()).filter(is_lost).collect();
            if lost.is_empty() || !reading.agrees() {
                return (reading, owners);
            }
            // parts of each other: dust is dust, and of others the heaviest must be something else
            let weight = |i: usize| self.pieces[i].weight();
            let heaviest = lost.iter().copied().filter(|&i| !dirt[i]);
            let heaviest = heaviest.max_by(|&a, &b| weight(a).total_cmp(&weight(b)));
            let dust = lost.iter().copied().filter(|&i| dirt[i]);
            dust.chain(heaviest).for_each(|i| seen[i].body = None);
        }
    }

    /// What is seen of each piece.
    fn seen(&self, dirt: &[bool]) -> Vec<Seen> {
        let body: Vec<Option<Tie>> = (0..self.pieces.len()).map(|i| self.body(i)).collect();
        let seen = |(i, piece): (usize, &&Piece)| Seen {
            full: piece.full(self.usual),
            above: false,
            below: false,
            body: body[i].map(|b| Body {
                off: b.off,
                before: b.to < i,
                above: self.is_above(i, b.to),
            }),
            dirt: dirt[i],
        };
        let mut seen: Vec<Seen> = self.pieces.iter().enumerate().map(seen).collect();
        for i in 0..seen.len() {
            if let Some(to) = body[i].filter(|_| seen[i].full < 1.0).map(|b| b.to) {
                let above = self.is_above(i, to);
                seen[to].above |= above;
                seen[to].below |= !above;
            }
        }
        seen
    }

    /// The nearest piece, no smaller than it, that one may be a part of.
    fn body(&self, i: usize) -> Option<Tie> {
        let ties = self.ties[i].iter();
        ties.min_by(|a, b| a.off.total_cmp(&b.off)).copied()
    }

    /// Whether the middle of a piece lies over another's.
    fn is_above(&self, i: usize, other: usize) -> bool {
        self.pieces[i].bounds.center().y < self.pieces[other].bounds.center().y
    }

    /// The name of whose letter each piece is: parts go to the letter that lies best for them and whose name wants them, the most likely
    /// first, and with the part of which they are parts.
    fn share(&self, roles: &[Role], names: &[Option<Shape>]) -> Vec<Option<usize>> {
        let letter = |role: &Role| match role {
            Role::Letter(k) => Some(*k),
            _ => None,
        };
        let mut owners: Vec<Option<usize>> = roles.iter().map(letter).collect();
        let mut left: Vec<usize> = (0..owners.len()).collect();
        left.retain(|&i| roles[i] == Role::Part);
        let cost = &|i: usize, tie: &Tie, k: usize| {
            let wish = names.get(k).copied().flatten();
            tie.off + wish.map_or(0.0, |s| unwanted(&s, self.is_above(i, tie.to)))
        };
        loop {
            let owners_now = &owners;
            let pairs = left.iter().flat_map(|&i| {
                let owned = move |t: &Tie| owners_now[t.to].map(|k| (cost(i, t, k), i, k));
                self.ties[i].iter().filter_map(owned)
            });
            let Some((_, i, k)) = pairs.min_by(|a, b| a.0.total_cmp(&b.0)) else {
                return owners;
            };
            owners[i] = Some(k);
            left.retain(|&l| l != i);
        }
    }
}
