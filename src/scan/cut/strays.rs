//! Rows of a page without lines: a hand sets them at uneven distances.
//!
//! Each letter votes for where its row stands: most those that stand flat or on a bow, and Arabic letters whose depth other rows tell; less
//! those of which nobody knows. A row stands where most of its votes are, and not without reason far from where even distances or its
//! neighbours would have it, its homes: with `v` votes of weights `w`, homes `h`, the votes' reach `r` and the rows' usual stray `s`, at
//! the `y` of the greatest
//!
//! ```text
//! sum over v of w max(0, 1 - ((v - y)/r)^2)  -  min over h of ln(1 + ((y - h)/s)^2)
//! ```
//!
//! On a page whose rows are even `s` is next to nothing, so that letters of an odd style move no row; nor do few votes anywhere.

use super::baselines::{Letter, Line, OVERSHOOT, drops, feet_on_line, near};
use crate::numeric::median::median;
use crate::scan::letters::{Foot, Kind};
use std::collections::BTreeMap;

/// Weight of a row's votes from which on it tells where it stands, and rows that tell how far rows stray, at least.
const SURE: f64 = 2.2;
const ROWS: usize = 3;
/// Votes count for places within so many times `near`.
const REACH: f64 = 1.5;
/// Rows stray by this share of `near` at least.
const LEAST: f64 = 0.05;
/// How much the vote of a letter counts of which nobody knows whether it stands, and of an Arabic one that often hangs.
const MAY_STAND: f64 = 0.5;
const MAY_HANG: f64 = 0.2;
/// The letters of a row with fewer count as much as so many.
const FEW: f64 = 3.0;
/// A standard deviation in medians of the distance, where it is a normal one.
const NORMAL: f64 = 1.4826;

/// How far each row's baseline lies below its slots' levels, px, on a page where no line guided the hand.
pub(super) fn unruled(letters: &[Letter], rows: usize) -> Vec<f64> {
    let (off, near) = (feet_on_line(letters, rows), near(letters));
    let strays = strays(letters, &off, near, rows);
    drops(off, near, &strays)
}

/// How far each of the rows stands from even distances, px: nothing where it is less than `near` of all of them.
///
/// `off` is the row and the distance from the level of the feet that tell where rows stand.
fn strays(letters: &[Letter], off: &[(usize, f64)], near: f64, rows: usize) -> Vec<f64> {
    let even = Line::steady(off, near).0;
    let foot = |l: &Letter| l.body.y1 - l.level - even.at(l.row);
    let rows: Vec<Vec<&Letter>> = (0..rows)
        .map(|r| letters.iter().filter(|l| l.row == r).collect())
        .collect();
    let votes = |depths: &Depths| -> Vec<Vec<Vote>> {
        rows.iter().map(|row| ballot(row, foot, depths)).collect()
    };
    let alone = |votes: &[Vec<Vote>]| -> Vec<Option<f64>> {
        votes.iter().map(|v| alone(v, near)).collect()
    };
    let depths = depths(&rows, &alone(&votes(&Depths::new())), foot);
    let votes = votes(&depths);
    let most = alone(&votes);
    let usual = usual(&most, near);
    let stray = |(r, v): (usize, &Vec<Vote>)| stand(v, &homes(&most, r), usual, near);
    let strays: Vec<f64> = votes.iter().enumerate().map(stray).collect();
    if strays.iter().all(|s| s.abs() <= near) {
        return vec![0.0; rows.len()];
    }
    strays
}

/// The votes of a row's letters.
fn ballot(row: &[&Letter], foot: impl Fn(&Letter) -> f64, depths: &Depths) -> Vec<Vote> {
    let few = (FEW / row.len().max(1) as f64).max(1.0);
    let vote = |l: &&Letter| {
        let vote = Vote::of(l, row, foot(l), depths);
        Vote {
            weight: few * vote.weight,
            ..vote
        }
    };
    row.iter().map(vote).collect()
}

/// Where a row stands, px: in the middle of the votes for the likeliest place, or where it may be expected if these are too few.
fn stand(votes: &[Vote], homes: &[f64], usual: f64, near: f64) -> f64 {
    let at = likeliest(votes, homes, usual, near);
    let heard = |at: &&f64| agreement(votes, **at, near);
    if heard(&&at) < SURE {
        let best = homes.iter().max_by(|a, b| heard(a).total_cmp(&heard(b)));
        return best.copied().unwrap_or(at);
    }
    let agree = |v: &&Vote| v.weight >= MAY_STAND && (v.at - at).abs() <= near;
    median(votes.iter().filter(agree).map(|v| v.at)).unwrap_or(at)
}

/// How far below their rows the feet of each kind of Arabic body lie, px, with the row that says so.
type Depths = BTreeMap<usize, Vec<(usize, f64)>>;

/// The depths that rows tell which tell where they stand.
fn depths(rows: &[Vec<&Letter>], told: &[Option<f64>], foot: impl Fn(&Letter) -> f64) -> Depths {
    let mut kinds = Depths::new();
    for (row, told) in rows.iter().zip(told) {
        for letter in row {
            if let Some((body, level)) = letter.shape.body.zip(*told) {
                let depth = (letter.row, foot(letter) - level);
                kinds.entry(body).or_default().push(depth);
            }
        }
    }
    kinds
}

/// Where a row stands by its own votes, where they say so with some weight.
fn alone(votes: &[Vote], near: f64) -> Option<f64> {
    let at = likeliest(votes, &[], f64::INFINITY, near);
    (agreement(votes, at, near) >= SURE).then_some(at)
}

/// How far rows usually stray from their likeliest home, px; without bounds where too few rows tell.
fn usual(alone: &[Option<f64>], near: f64) -> f64 {
    let away = |(r, at): (usize, &Option<f64>)| {
        let at = (*at)?;
        let homes = homes(alone, r).into_iter();
        homes.map(|h| (at - h).abs()).reduce(f64::min)
    };
    let all: Vec<f64> = alone.iter().enumerate().filter_map(away).collect();
    let enough = all.len() >= ROWS;
    let middle = median(all).filter(|_| enough);
    middle.map_or(f64::INFINITY, |m| (NORMAL * m).max(LEAST * near))
}

/// Where a row may be expected, px: at even distances, or as the next rows above and below stand that tell.
fn homes(alone: &[Option<f64>], row: usize) -> Vec<f64> {
    let above = alone[..row].iter().rev().flatten().next();
    let below = alone[row + 1..].iter().flatten().next();
    let beside = above.into_iter().chain(below).copied();
    beside.chain([0.0]).collect()
}

/// Where a letter's row stands if its foot does as it should, px, and how much that counts.
struct Vote {
    at: f64,
    weight: f64,
}

impl Vote {
    fn of(letter: &Letter, row: &[&Letter], foot: f64, depths: &Depths) -> Self {
        let shape = letter.shape;
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
        Self { at, weight }
    }
}

/// The place with most votes within reach, less what speaks against one that is far from all homes.
fn likeliest(votes: &[Vote], homes: &[f64], usual: f64, near: f64) -> f64 {
    let score = |at: f64| {
        let against = |h: &f64| (((at - h) / usual).powi(2)).ln_1p();
        let least = homes.iter().map(against).reduce(f64::min);
        agreement(votes, at, near) - least.unwrap_or(0.0)
    };
    let places = votes.iter().filter(|v| v.weight > 0.0).map(|v| v.at);
    let places = places.chain(homes.iter().copied());
    let best = places.max_by(|a, b| score(*a).total_cmp(&score(*b)));
    best.unwrap_or(0.0)
}

/// The weight of the votes for a place, less the farther from it.
fn agreement(votes: &[Vote], at: f64, near: f64) -> f64 {
    let agree = |v: &Vote| v.weight * (1.0 - ((v.at - at) / (REACH * near)).powi(2)).max(0.0);
    votes.iter().map(agree).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The strays of rows of letters, 100 px high, whose line is at `lines` and which end so far below it; and where these rows stand.
    fn of(lines: &[f64], rows: &[&[(&str, f64)]]) -> [Vec<f64>; 2] {
        let letter = |row: usize, label, depth: f64| Letter::ending(row, label, lines[row] + depth);
        let all = rows.iter().enumerate();
        let letters: Vec<Letter> = all
            .flat_map(|(r, row)| row.iter().map(move |&(l, d)| letter(r, l, d)))
            .collect();
        let flat = letters.iter().filter(|l| l.shape.foot == Foot::Flat);
        let off: Vec<(usize, f64)> = flat.map(|l| (l.row, l.body.y1)).collect();
        let strays = strays(&letters, &off, 10.0, rows.len());
        let even = Line::steady(&off, 10.0).0;
        let stand = strays.iter().enumerate().map(|(r, s)| even.at(r) + s);
        [strays.clone(), stand.collect()]
    }

    const EVEN: [f64; 6] = [100.0, 300.0, 500.0, 700.0, 900.0, 1100.0];
    const CAPITALS: &[(&str, f64)] = &[("H", 0.0), ("E", 1.0), ("T", 0.0), ("O", 2.0), ("M", 0.0)];
    const FIGURES: &[(&str, f64)] = &[
        ("3", 40.0),
        ("4", 40.0),
        ("5", 40.0),
        ("7", 40.0),
        ("9", 40.0),
    ];
    const JOINED: &[(&str, f64)] = &[
        ("uni0627", 0.0),
        ("uni0628.init", 0.0),
        ("uni062F", 0.0),
        ("uni062C.fina", 60.0),
        ("uni0637.medi", 0.0),
    ];
    const HANGING: &[(&str, f64)] = &[
        ("uni062D.fina", 60.0),
        ("uni062E.fina", 60.0),
        ("uni0686.fina", 60.0),
        ("uni062D", 55.0),
        ("uni062E", 55.0),
    ];

    #[test]
    fn even_rows_do_not_stray() {
        for rows in [
            [CAPITALS, CAPITALS, FIGURES, CAPITALS, CAPITALS, FIGURES],
            [JOINED, HANGING, JOINED, JOINED, HANGING, JOINED],
        ] {
            assert_eq!(of(&EVEN, &rows)[0], [0.0; 6]);
        }
    }

    #[test]
    fn letters_of_an_odd_style_move_no_row_of_an_even_page() {
        let odd: &[_] = &[("I", 45.0), ("K", 45.0), ("N", 45.0), ("Q", 45.0)];
        let rows = [CAPITALS, odd, CAPITALS, CAPITALS, CAPITALS, CAPITALS];
        assert_eq!(of(&EVEN, &rows)[0], [0.0; 6]);
    }

    #[test]
    fn letters_of_one_kind_do_not_bear_out_each_other() {
        let alefs: &[_] = &[
            ("uni0627", 20.0),
            ("uni0627.fina", 20.0),
            ("uni0623", 20.0),
            ("uni0623.fina", 20.0),
            ("uni0622", 20.0),
            ("uni0622.fina", 20.0),
            ("uni0625", 20.0),
            ("uni0625.fina", 20.0),
        ];
        let others = &JOINED[1..];
        let rows = [alefs, others, others, others, others, others];
        assert_eq!(of(&EVEN, &rows)[0], [0.0; 6]);
    }

    #[test]
    fn uneven_rows_stand_where_their_letters_do() {
        let lines = [100.0, 330.0, 540.0, 640.0, 860.0, 1170.0];
        for rows in [
            [CAPITALS; 6],
            [JOINED, HANGING, JOINED, JOINED, HANGING, JOINED],
        ] {
            let stand = &of(&lines, &rows)[1];
            let off = stand.iter().zip(lines).map(|(s, l)| (s - l).abs());
            assert!(off.reduce(f64::max).unwrap() < 1.5, "{stand:?}");
        }
    }

    #[test]
    fn rows_whose_names_tell_nothing_stand_on_their_lower_ends() {
        let lines = [100.0, 330.0, 540.0, 640.0, 860.0, 1170.0];
        let unknown: &[_] = &[
            ("uniE000", 0.0),
            ("uniE001", 1.0),
            ("uniE002", 30.0),
            ("uniE003", 0.0),
            ("uniE004", 0.0),
            ("uniE005", 0.0),
        ];
        let [strays, _] = of(&lines, &[unknown; 6]);
        // nothing tells even distances here, so that heights are the rows' own
        let off = strays.iter().zip(lines).map(|(s, l)| (s - l).abs());
        assert!(off.reduce(f64::max).unwrap() < 1.5, "{strays:?}");
    }
}
