//! Letters of a page without lines → where each says that its row stands.
//!
//! By its foot: most say those that stand flat or on a bow, and Arabic letters of whose body other rows tell the
//! depth; less those of which nobody knows. And by its joining strokes, which on a page all end at one height: what
//! hangs is joined where the rest is.

use super::baselines::{Letter, Line, OVERSHOOT};
use crate::numeric::median::median;
use crate::scan::letters::{Foot, Kind};
use std::collections::BTreeMap;

/// How much the vote of a letter counts of which nobody knows whether it stands, and of an Arabic one that often
/// hangs.
pub(super) const MAY_STAND: f64 = 0.5;
const MAY_HANG: f64 = 0.2;
/// How much the ends of a letter's joining strokes count.
const JOINED: f64 = 2.0;
/// So many of them, at least, tell the height of all, where half of them lie within this share of `near`.
const ENDS: usize = 8;
const STEADY: f64 = 0.5;
/// The letters of a row with fewer count as much as so many.
const FEW: f64 = 4.0;

/// Where a letter's row stands if its foot does as it should, px, and how much that counts.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vote {
    pub(super) at: f64,
    pub(super) weight: f64,
}

/// The letters of a page by rows, whose heights are measured from rows at even distances.
pub(super) struct Poll<'a> {
    rows: Vec<Vec<&'a Letter>>,
    even: Line,
    /// How far a foot may lie off its row's line, px.
    near: f64,
}

/// How far below their rows the feet of each kind of Arabic body lie, px, with the row that says so.
type Depths = BTreeMap<usize, Vec<(usize, f64)>>;

impl<'a> Poll<'a> {
    pub(super) fn new(letters: &'a [Letter], rows: usize, even: Line, near: f64) -> Self {
        let row = |r: usize| letters.iter().filter(|l| l.row == r).collect();
        Self {
            rows: (0..rows).map(row).collect(),
            even,
            near,
        }
    }

    /// The votes of each row's letters; `told` is where rows stand that are known, px.
    pub(super) fn votes(&self, told: &[Option<f64>]) -> Vec<Vec<Vote>> {
        let depths = self.depths(told);
        let votes = |(r, row): (usize, &Vec<&Letter>)| {
            let few = (FEW / row.len().max(1) as f64).max(1.0);
            let feet = row.iter().map(|l| self.by_foot(l, row, &depths));
            let all = feet.chain(self.by_joins(r, told));
            let all = all.map(|v| Vote {
                weight: few * v.weight,
                ..v
            });
            all.collect()
        };
        self.rows.iter().enumerate().map(votes).collect()
    }

    fn foot(&self, letter: &Letter) -> f64 {
        letter.foot() - self.even.at(letter.row)
    }

    /// The ends of a letter's joining strokes.
    fn joins(&self, letter: &'a Letter) -> impl Iterator<Item = f64> + use<'a> {
        let even = letter.level + self.even.at(letter.row);
        letter.joins.iter().map(move |y| y - even)
    }

    /// The depths that rows tell which tell where they stand.
    fn depths(&self, told: &[Option<f64>]) -> Depths {
        let mut kinds = Depths::new();
        for (row, told) in self.rows.iter().zip(told) {
            for letter in row {
                if let Some((body, level)) = letter.shape.body.zip(*told) {
                    let depth = (letter.row, self.foot(letter) - level);
                    kinds.entry(body).or_default().push(depth);
                }
            }
        }
        kinds
    }

    /// The vote of a letter of a row by where its ink ends below.
    fn by_foot(&self, letter: &Letter, row: &[&Letter], depths: &Depths) -> Vote {
        let (shape, foot) = (letter.shape, self.foot(letter));
        let known = shape.body.and_then(|b| depths.get(&b));
        let others = known.into_iter().flatten().filter(|d| d.0 != letter.row);
        let depth = median(others.map(|d| d.1));
        let overshoot = OVERSHOOT * letter.body.height();
        let (at, weight) = match (depth, shape.foot, shape.kind) {
            (Some(depth), ..) => (foot - depth, 1.0),
            (None, Foot::Flat, Kind::Arabic) => {
                // letters of one kind are right or wrong together
                let alike = |l: &&&Letter| {
                    l.shape.foot == Foot::Flat && l.shape.skeleton() == shape.skeleton()
                };
                (foot, 1.0 / (row.iter().filter(alike).count() as f64).sqrt())
            }
            (None, Foot::Flat, _) => (foot, 1.0),
            (None, _, Kind::Arabic) => (foot, MAY_HANG),
            (None, Foot::Round, _) => (foot - overshoot, 1.0),
            (None, Foot::Tail, _) => (foot, 0.0),
            (None, Foot::None, _) => (foot, MAY_STAND),
        };
        Vote { at, weight }
    }

    /// The votes of a row's letters by where their joining strokes end: all do at one height, which the other rows
    /// tell.
    fn by_joins(&self, row: usize, told: &[Option<f64>]) -> Vec<Vote> {
        let others = self.rows.iter().zip(told).enumerate();
        let others = others.filter_map(|(r, (o, level))| Some((o, level.filter(|_| r != row)?)));
        let all = others.flat_map(|(o, level)| {
            let ends = o.iter().flat_map(|l| self.joins(l));
            ends.map(move |y| y - level)
        });
        let all: Vec<f64> = all.collect();
        let Some(height) = median(all.iter().copied()).filter(|_| all.len() >= ENDS) else {
            return Vec::new();
        };
        let scatter = median(all.iter().map(|y| (y - height).abs()));
        if scatter.is_none_or(|s| s > STEADY * self.near) {
            return Vec::new();
        }
        let vote = |l: &&'a Letter| {
            let weight = JOINED / l.joins.len().max(1) as f64;
            let ends = self.joins(l);
            ends.map(move |y| Vote {
                at: y - height,
                weight,
            })
        };
        self.rows[row].iter().flat_map(vote).collect()
    }
}
