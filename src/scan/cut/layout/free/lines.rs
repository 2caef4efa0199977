//! Pieces in reading order, and the letters that they make.

use super::pieces::{Piece, Tie, Usual};
use super::reading::{Body, Names, Reading, Role, Seen, Side, align, unwanted};
use crate::scan::cut::layout::rows::beside;
use crate::scan::cut::layout::touching::Touch;
use crate::scan::letters::Shape;
use std::iter;

/// The pieces of a page in reading order.
pub(super) struct Lines<'a> {
    pub(super) pieces: Vec<&'a Piece>,
    /// The row of each of them.
    row: Vec<usize>,
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
            row: rows
                .iter()
                .enumerate()
                .flat_map(|(r, row)| iter::repeat_n(r, row.len()))
                .collect(),
            pieces: order.iter().map(|&i| &pieces[i]).collect(),
            usual,
        }
    }

    /// What each piece is, and of which name its letter is. `dirt` says which pieces may be none.
    pub(super) fn read(&self, names: Names<'_>, dirt: &[bool]) -> (Reading, Vec<Option<usize>>) {
        let mut bodies: Vec<Option<Tie>> = (0..self.pieces.len()).map(|i| self.body(i)).collect();
        let mut seen = self.seen(&bodies, dirt);
        loop {
            let reading = align(&seen, names);
            let owners = self.share(&reading.roles, names.shapes);
            let mut wrong = self.lost(&reading.roles, &owners, dirt);
            let mut others = self.twins(&reading.roles, &bodies);
            others.extend(self.standing(&reading.roles, &bodies));
            if !reading.agrees() || (wrong.is_empty() && others.is_empty()) {
                return (reading, owners);
            }
            wrong.iter().for_each(|&i| bodies[i] = None);
            for i in others {
                bodies[i] = bodies[i].and_then(|b| self.next_body(i, Some(b)));
                wrong.push(i);
            }
            for i in wrong {
                seen[i].body = bodies[i].map(|b| self.as_body(i, b));
            }
        }
    }

    /// Parts that are in no letter, since they are parts of each other: dust is dust, and of others the heaviest must
    /// be something else.
    fn lost(&self, roles: &[Role], owners: &[Option<usize>], dirt: &[bool]) -> Vec<usize> {
        let is_lost = |i: &usize| roles[*i] == Role::Part && owners[*i].is_none();
        let lost = (0..roles.len()).filter(is_lost);
        let (mut wrong, others): (Vec<usize>, Vec<usize>) = lost.partition(|&i| dirt[i]);
        let weight = |i: usize| self.pieces[i].weight();
        let heaviest = others.into_iter();
        wrong.extend(heaviest.max_by(|&a, &b| weight(a).total_cmp(&weight(b))));
        wrong
    }

    /// Of each two pieces larger than signs that were taken for parts of each other the heavier one: it is no part of
    /// that.
    fn twins(&self, roles: &[Role], bodies: &[Option<Tie>]) -> Vec<usize> {
        let rank = |i: usize| (self.pieces[i].weight(), i);
        let body = |i: usize| Some(bodies[i]?.to).filter(|_| roles[i] == Role::Part);
        let is_twin = |i: &usize| {
            let other = body(*i).filter(|&j| body(j) == Some(*i) && rank(j) < rank(*i));
            other.is_some() && self.pieces[*i].full(self.usual) > 0.0
        };
        (0..roles.len()).filter(is_twin).collect()
    }

    /// Parts of letters in other rows that stand beside the letters of their own, or are as large as letters: where a
    /// name was forgotten, a letter under another one's tail is likelier its part than one without a name. Of 170
    /// pages that were rightly read none had such parts.
    fn standing(&self, roles: &[Role], bodies: &[Option<Tie>]) -> Vec<usize> {
        let is_letter = |j: usize| matches!(roles[j], Role::Letter(_) | Role::Touching(..));
        let stands = |i: usize| {
            let own = |j: &usize| self.row[*j] == self.row[i] && is_letter(*j);
            let next = [(0..i).rev().find(own), (i + 1..roles.len()).find(own)];
            let mut next = next.into_iter().flatten();
            next.any(|j| beside(&self.pieces[i].bounds, &self.pieces[j].bounds))
        };
        let astray = |i: usize| bodies[i].is_some_and(|b| self.row[b.to] != self.row[i]);
        let is_standing = |&i: &usize| {
            let piece = self.pieces[i];
            let is_no_dot = piece.full(self.usual) > 0.0;
            roles[i] == Role::Part
                && astray(i)
                && is_no_dot
                && (piece.is_large(self.usual) || stands(i))
        };
        (0..roles.len()).filter(is_standing).collect()
    }

    /// The ink of letters that touch.
    pub(super) fn touching(&self, reading: &Reading) -> Vec<Touch> {
        let roles = reading.roles.iter().zip(&self.pieces);
        let several = roles.filter_map(|(role, piece)| match role {
            Role::Touching(_, n) => Some(Touch::beside(piece.parts.clone(), piece.bounds, *n)),
            _ => None,
        });
        several.collect()
    }

    /// The ink of each name's letter, by rows; `owners` says of which letter each piece is.
    pub(super) fn letters(
        &self,
        reading: &Reading,
        owners: &[Option<usize>],
    ) -> Vec<Vec<Vec<usize>>> {
        let named = reading.roles.iter().zip(&self.row);
        let named = named.filter_map(|(role, &row)| match role {
            Role::Letter(k) => Some((row, *k)),
            _ => None,
        });
        let named: Vec<(usize, usize)> = named.collect();
        let ink = |&(_, k): &(usize, usize)| {
            let own = owners.iter().zip(&self.pieces);
            let own = own.filter(|(owner, _)| **owner == Some(k));
            own.flat_map(|(_, piece)| &piece.parts).copied().collect()
        };
        let rows = named.chunk_by(|a, b| a.0 == b.0);
        rows.map(|row| row.iter().map(ink).collect()).collect()
    }

    /// What is seen of each piece.
    fn seen(&self, bodies: &[Option<Tie>], dirt: &[bool]) -> Vec<Seen> {
        let seen = |(i, piece): (usize, &&Piece)| Seen {
            full: piece.full(self.usual),
            slight: piece.is_mote(self.usual)
                || piece.full(self.usual) <= 0.0 && bodies[i].is_some(),
            above: false,
            below: false,
            inside: false,
            body: bodies[i].map(|b| self.as_body(i, b)),
            within: bodies[i].is_some_and(|b| self.pieces[b.to].holds(piece)),
            dirt: dirt[i],
            first: i == 0 || self.row[i] != self.row[i - 1],
            letters: piece.letters(self.usual),
        };
        let mut seen: Vec<Seen> = self.pieces.iter().enumerate().map(seen).collect();
        for i in 0..seen.len() {
            if let Some(to) = bodies[i].filter(|_| seen[i].full < 1.0).map(|b| b.to) {
                match (seen[i].within, self.side(i, to)) {
                    (true, _) => seen[to].inside = true,
                    (false, Side::Over) => seen[to].above = true,
                    (false, Side::Under) => seen[to].below = true,
                }
            }
        }
        seen
    }

    fn as_body(&self, i: usize, body: Tie) -> Body {
        Body {
            off: body.off,
            before: body.to < i,
            sign: self.side(i, body.to),
        }
    }

    /// The nearest piece, no smaller than it, that one may be a part of.
    fn body(&self, i: usize) -> Option<Tie> {
        self.next_body(i, None)
    }

    /// The next one after `last`.
    fn next_body(&self, i: usize, last: Option<Tie>) -> Option<Tie> {
        let order = |a: &Tie, b: &Tie| a.off.total_cmp(&b.off).then(a.to.cmp(&b.to));
        let beyond = |t: &&Tie| last.is_none_or(|last| order(t, &last).is_gt());
        let ties = self.ties[i].iter().filter(beyond);
        ties.min_by(|a, b| order(a, b)).copied()
    }

    /// On which side of another piece one lies.
    fn side(&self, i: usize, other: usize) -> Side {
        let middle = |i: usize| self.pieces[i].bounds.center().y;
        if middle(i) < middle(other) {
            Side::Over
        } else {
            Side::Under
        }
    }

    /// The name of whose letter each piece is: parts go to the letter that lies best for them and whose name wants
    /// them, the most likely first, and with the part of which they are parts.
    fn share(&self, roles: &[Role], names: &[Option<Shape>]) -> Vec<Option<usize>> {
        let letter = |role: &Role| match role {
            Role::Letter(k) | Role::Touching(k, _) => Some(*k),
            _ => None,
        };
        let mut owners: Vec<Option<usize>> = roles.iter().map(letter).collect();
        let mut left: Vec<usize> = (0..owners.len()).collect();
        left.retain(|&i| roles[i] == Role::Part);
        let cost = &|i: usize, tie: &Tie, k: usize| {
            let wish = names.get(k).copied().flatten();
            tie.off + wish.map_or(0.0, |s| unwanted(&s, self.side(i, tie.to)))
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
