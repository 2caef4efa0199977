//! Pieces of ink → rows, as they are read.

use super::pieces::{Piece, Tie, Usual};
use crate::numeric::median::{median, middle};
use crate::scan::cut::layout::rows::rows;
use kurbo::Rect;
use std::ops::Range;

/// A piece as large as a letter that is so near to a heavier one, in usual sizes, is taken for a part of that while
/// rows are looked for.
const CLOSE: f64 = 0.2;
/// A piece that has no heavier one beside it is a letter if it is so much of a full one.
const LIKELY: f64 = 0.5;
/// What is smaller than a letter belongs to a row within this share of a usual letter's size.
const REACH: f64 = 0.75;

/// What a piece as large as a letter is that is close to a heavier one, while rows are looked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Close {
    /// A part of it, as a stem is that stands apart from its bowl.
    Part,
    /// A letter: low ones hang close below those of the row above.
    Letter,
}

/// Indices of pieces in rows from the top, each row from the left.
///
/// Letters make the rows. What is smaller or touches one is in the row that it stands in, in that of its letter, or
/// in the nearest. What is in none of these makes rows of its own, but not what `is_dirt` says: that is in no row.
pub(super) fn in_rows(
    pieces: &[Piece],
    ties: &[Vec<Tie>],
    (usual, close): (Usual, Close),
    is_dirt: impl Fn(usize) -> bool,
) -> Vec<Vec<usize>> {
    let letters = Letters::new(pieces, ties, (usual, close));
    let boxes = letters.boxes(pieces, usual);
    let (frame, mut rest): (Vec<usize>, Vec<usize>) =
        (0..pieces.len()).partition(|&i| letters.is_letter[i]);
    let mut frame = among(&boxes, &frame);
    let mut row_of: Vec<Option<usize>> = vec![None; pieces.len()];
    for (row, members) in frame.iter().enumerate() {
        members.iter().for_each(|&i| row_of[i] = Some(row));
    }
    let mut order = frame.clone();
    let mut left = Vec::new();
    rest.sort_by(|&a, &b| pieces[b].weight().total_cmp(&pieces[a].weight()));
    for i in rest {
        let doubt = pieces[i].full(usual) > 0.0;
        let stands = (0..frame.len()).find(|&r| doubt && stands_in(&boxes, &frame[r], i));
        if let Some(row) = stands {
            frame[row].push(i);
        }
        let near = || nearest(&boxes, &frame, i, REACH * usual.size);
        match stands.or_else(|| row_of[letters.own(i)]).or_else(near) {
            Some(row) => order[row].push(i),
            None if is_dirt(i) => {}
            None => left.push(i),
        }
    }
    order.extend(among(&boxes, &left));
    sorted(order, pieces)
}

/// Pieces that reach from the middle of one row to that of the next, each with these, upright px: letters of both
/// that touch. On 156 pages no single letter reached farther than two thirds of the way.
pub(super) fn across(pieces: &[Piece], usual: Usual) -> Vec<(usize, Range<f64>)> {
    let boxes: Vec<Rect> = pieces.iter().map(|p| p.bounds).collect();
    let full = (0..pieces.len()).filter(|&i| pieces[i].full(usual) >= 1.0);
    // such a piece would make one row of both
    let (high, some): (Vec<usize>, Vec<usize>) = full.partition(|&i| pieces[i].is_high(usual));
    let rows = among(&boxes, &some);
    let middle = |row: &Vec<usize>| median(row.iter().map(|&i| boxes[i].center().y));
    let middles: Vec<f64> = rows.iter().filter_map(middle).collect();
    let reach = |i: usize| {
        let mut two = middles.windows(2);
        let two = two.find(|m| boxes[i].y0 <= m[0] && boxes[i].y1 >= m[1])?;
        Some((i, two[0]..two[1]))
    };
    high.into_iter().filter_map(reach).collect()
}

/// Which pieces are letters by their size and place alone.
struct Letters {
    is_letter: Vec<bool>,
    /// The nearest heavier piece that each may be a part of.
    body: Vec<Option<Tie>>,
}

impl Letters {
    fn new(pieces: &[Piece], ties: &[Vec<Tie>], (usual, close): (Usual, Close)) -> Self {
        let all = 0..pieces.len();
        let body: Vec<Option<Tie>> = all.map(|i| heavier(pieces, ties, i)).collect();
        let is_letter = |(piece, body): (&Piece, &Option<Tie>)| match (piece.full(usual), body) {
            (full, None) => full >= LIKELY,
            (full, Some(body)) => full >= 1.0 && (body.off >= CLOSE || close == Close::Letter),
        };
        Self {
            is_letter: pieces.iter().zip(&body).map(is_letter).collect(),
            body,
        }
    }

    /// The letter of which a piece is a part, or the heaviest piece on the way to one.
    fn own(&self, mut i: usize) -> usize {
        while let Some(body) = self.body[i].filter(|_| !self.is_letter[i]) {
            i = body.to;
        }
        i
    }

    /// The boxes of pieces, px. What is no full letter makes its row together with its parts: a hamza can be more
    /// than the tooth that it stands over.
    fn boxes(&self, pieces: &[Piece], usual: Usual) -> Vec<Rect> {
        let mut boxes: Vec<Rect> = pieces.iter().map(|p| p.bounds).collect();
        for i in (0..pieces.len()).filter(|&i| !self.is_letter[i]) {
            let letter = self.own(i);
            if pieces[letter].full(usual) < 1.0 {
                boxes[letter] = boxes[letter].union(pieces[i].bounds);
            }
        }
        boxes
    }
}

/// Rows from the top, each from the left.
fn sorted(mut rows: Vec<Vec<usize>>, pieces: &[Piece]) -> Vec<Vec<usize>> {
    let middle = |row: &[usize]| {
        let heights = row.iter().map(|&i| pieces[i].bounds.center().y);
        middle(heights, f64::total_cmp).unwrap_or(0.0)
    };
    rows.sort_by(|a, b| middle(a).total_cmp(&middle(b)));
    let x = |i: usize| pieces[i].bounds.center().x;
    for row in &mut rows {
        row.sort_by(|&a, &b| x(a).total_cmp(&x(b)));
    }
    rows
}

/// The rows of some of the boxes.
fn among(boxes: &[Rect], some: &[usize]) -> Vec<Vec<usize>> {
    let boxes: Vec<Rect> = some.iter().map(|&i| boxes[i]).collect();
    let rows = rows(&boxes).into_iter();
    rows.map(|r| r.into_iter().map(|k| some[k]).collect())
        .collect()
}

/// The nearest heavier piece that one may be a part of.
fn heavier(pieces: &[Piece], ties: &[Vec<Tie>], i: usize) -> Option<Tie> {
    let rank = |j: usize| (pieces[j].weight(), j);
    let heavier = ties[i].iter().filter(|t| rank(t.to) > rank(i));
    heavier.min_by(|a, b| a.off.total_cmp(&b.off)).copied()
}

/// The boxes of a row on both sides of a piece.
fn beside(boxes: &[Rect], row: &[usize], i: usize) -> impl Iterator<Item = Rect> {
    let away = |j: &usize| boxes[*j].center().x - boxes[i].center().x;
    let nearest = |a: &&usize, b: &&usize| away(a).abs().total_cmp(&away(b).abs());
    let (left, right): (Vec<usize>, Vec<usize>) = row.iter().partition(|j| away(j) < 0.0);
    let both = [left.iter().min_by(nearest), right.iter().min_by(nearest)];
    both.map(|j| j.map(|&j| boxes[j])).into_iter().flatten()
}

/// Whether a piece stands beside the nearest letters of a row.
fn stands_in(boxes: &[Rect], row: &[usize], i: usize) -> bool {
    let one = boxes[i];
    let common = |other: &Rect| one.y1.min(other.y1) - one.y0.max(other.y0);
    beside(boxes, row, i).any(|other| common(&other) > one.height() / 2.0)
}

/// The row whose letters beside a piece are nearest to its height, within `reach` px.
fn nearest(boxes: &[Rect], rows: &[Vec<usize>], i: usize, reach: f64) -> Option<usize> {
    let y = boxes[i].center().y;
    let away = |r: usize| {
        let all = beside(boxes, &rows[r], i);
        all.map(|b| (b.y0 - y).max(y - b.y1))
            .fold(f64::INFINITY, f64::min)
    };
    let rows = (0..rows.len()).map(|r| (away(r), r));
    let near = rows.filter(|r| r.0 < reach);
    near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|r| r.1)
}
