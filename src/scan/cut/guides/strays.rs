//! Rows of a page without lines: a hand sets them at uneven distances.
//!
//! Each letter votes for where its row stands (`votes`). A row stands where most of its votes are, and not without
//! reason far from where even distances or its neighbours would have it, its homes: with `v` votes of weights `w`,
//! homes `h`, the votes' reach `r` and the rows' usual stray `s`, at the `y` of the greatest
//!
//! ```text
//! sum over v of w max(0, 1 - ((v - y)/r)^2)  -  min over h of ln(1 + ((y - h)/s)^2)
//! ```
//!
//! On a page whose rows are even `s` is next to nothing, so that letters of an odd style move no row; nor do few
//! votes anywhere.

use super::baselines::{Letter, Line, drops, feet_on_line, near};
use super::votes::{MAY_STAND, Poll, Vote};
use crate::numeric::median::{NORMAL, median};
use crate::scan::cut::Levels;

/// Weight of a row's votes from which on it tells where it stands, and rows that tell how far rows stray, at least.
const SURE: f64 = 2.2;
const ROWS: usize = 3;
/// Votes count for places within so many times `near`, at least and at most, and within so many times what letters
/// stray from their rows.
const REACH: (f64, f64) = (0.5, 1.5);
const SCATTER: f64 = 6.0;
/// Those that agree with a place lie within this share of that.
const AGREE: f64 = 0.67;
/// Most of a row's letters float and hang by these shares of a usual letter's height at most.
const FLOAT: f64 = 0.5;
const HANG: f64 = 1.5;
/// Rows stray by this share of `near` at least.
const LEAST: f64 = 0.05;
/// Times that votes are counted: what the rows tell first tells depths and joins, by which they vote again.
const ROUNDS: usize = 3;

/// How far each row's baseline lies below its slots' levels, px, on a page where no line guided the hand.
pub(super) fn unruled(letters: &[Letter], rows: usize) -> Vec<f64> {
    let (off, near) = (feet_on_line(letters, rows), near(letters));
    let strays = strays(letters, &off, near, rows);
    drops(off, near, (Levels::Loose, &strays))
}

/// How far each of the rows stands from even distances, px: nothing where it is less than `near` of all of them.
///
/// `off` is the row and the distance from the level of the feet that tell where rows stand.
fn strays(letters: &[Letter], off: &[(usize, f64)], near: f64, rows: usize) -> Vec<f64> {
    let poll = Poll::new(
        letters,
        rows,
        Line::steady(off, near, Line::through).0,
        near,
    );
    let (mut votes, mut told) = (Vec::new(), vec![None; rows]);
    for _ in 0..ROUNDS {
        votes = poll.votes(&told);
        told = votes.iter().map(|v| alone(v, REACH.1 * near)).collect();
    }
    let height = median(letters.iter().map(|l| l.whole.height())).unwrap_or(0.0);
    let reach = reach(&votes, &told, near);
    let usual = usual(&told, near);
    let stray = |(r, v): (usize, &Vec<Vote>)| {
        let homes = homes(&told, r).into_iter();
        let homes: Vec<f64> = homes.filter(|h| may_stand(v, *h, height)).collect();
        stand(v, &homes, usual, reach)
    };
    let strays: Vec<f64> = votes.iter().enumerate().map(stray).collect();
    if strays.iter().all(|s| s.abs() <= near) {
        return vec![0.0; rows];
    }
    strays
}

/// Where a row stands, px: in the middle of the votes for the likeliest place, or where it may be expected if these
/// are too few.
fn stand(votes: &[Vote], homes: &[f64], usual: f64, reach: f64) -> f64 {
    let at = likeliest(votes, homes, usual, reach);
    let heard = |at: &&f64| agreement(votes, **at, reach);
    if heard(&&at) < SURE {
        let best = homes.iter().max_by(|a, b| heard(a).total_cmp(&heard(b)));
        return best.copied().unwrap_or(at);
    }
    middle(votes, at, reach)
}

/// Whether a row of such votes may stand at a place: few letters float, and none hangs by more than its height.
fn may_stand(votes: &[Vote], at: f64, height: f64) -> bool {
    let heard = votes.iter().filter(|v| v.weight > 0.0);
    let depth = median(heard.map(|v| v.at - at)).unwrap_or(0.0);
    (-FLOAT * height..HANG * height).contains(&depth)
}

/// Within how many px votes count for a place: by how far letters stray from the rows that are told.
fn reach(votes: &[Vec<Vote>], told: &[Option<f64>], near: f64) -> f64 {
    let rows = votes.iter().zip(told);
    let rows = rows.filter_map(|(row, told)| Some((row, (*told)?)));
    let off = rows.flat_map(|(row, told)| {
        let some = row.iter().filter(|v| v.weight >= MAY_STAND);
        some.map(move |v| (v.at - told).abs())
    });
    let scatter = median(off.filter(|d| *d <= near)).unwrap_or(near);
    (SCATTER * NORMAL * scatter).clamp(REACH.0 * near, REACH.1 * near)
}

/// The median of the votes that agree with a place.
fn middle(votes: &[Vote], at: f64, reach: f64) -> f64 {
    let agree = |v: &&Vote| v.weight >= MAY_STAND && (v.at - at).abs() <= AGREE * reach;
    median(votes.iter().filter(agree).map(|v| v.at)).unwrap_or(at)
}

/// Where a row stands by its own votes, where they say so with some weight.
fn alone(votes: &[Vote], reach: f64) -> Option<f64> {
    let at = likeliest(votes, &[], f64::INFINITY, reach);
    let told = agreement(votes, at, reach) >= SURE;
    told.then(|| middle(votes, at, reach))
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

/// The place with most votes within reach, less what speaks against one that is far from all homes.
fn likeliest(votes: &[Vote], homes: &[f64], usual: f64, reach: f64) -> f64 {
    let score = |at: f64| {
        let against = |h: &f64| libm::log1p(((at - h) / usual).powi(2));
        let least = homes.iter().map(against).reduce(f64::min);
        agreement(votes, at, reach) - least.unwrap_or(0.0)
    };
    let places = votes.iter().filter(|v| v.weight > 0.0).map(|v| v.at);
    let places = places.chain(homes.iter().copied());
    let best = places.max_by(|a, b| score(*a).total_cmp(&score(*b)));
    best.unwrap_or(0.0)
}

/// The weight of the votes for a place, less the farther from it.
fn agreement(votes: &[Vote], at: f64, reach: f64) -> f64 {
    let agree = |v: &Vote| v.weight * (1.0 - ((v.at - at) / reach).powi(2)).max(0.0);
    votes.iter().map(agree).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::letters::{Foot, Shape};

    /// The strays of rows of letters, 100 px high, whose line is at `lines` and which end so far below it; and where
    /// these rows stand.
    fn of(lines: &[f64], rows: &[&[(&str, f64)]]) -> [Vec<f64>; 2] {
        of_joined(lines, rows, |_, _| Vec::new())
    }

    /// The same where joining strokes of a letter end at heights that are told by its row's line and its shape.
    fn of_joined(
        lines: &[f64],
        rows: &[&[(&str, f64)]],
        joins: impl Fn(f64, &Shape) -> Vec<f64>,
    ) -> [Vec<f64>; 2] {
        let letter = |row: usize, label, depth: f64| {
            let letter = Letter::ending(row, label, lines[row] + depth);
            Letter {
                joins: joins(lines[row], &letter.shape),
                ..letter
            }
        };
        let all = rows.iter().enumerate();
        let letters: Vec<Letter> = all
            .flat_map(|(r, row)| row.iter().map(move |&(l, d)| letter(r, l, d)))
            .collect();
        let flat = letters.iter().filter(|l| l.shape.foot == Foot::Flat);
        let off: Vec<(usize, f64)> = flat.map(|l| (l.row, l.body.y1)).collect();
        let strays = strays(&letters, &off, 10.0, rows.len());
        let even = Line::steady(&off, 10.0, Line::through).0;
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

    #[test]
    fn joining_strokes_tell_where_letters_hang_that_no_other_row_has() {
        let lines = [100.0, 330.0, 540.0, 640.0, 860.0, 1170.0];
        let hanging: &[_] = &[
            ("uni0639.fina", 70.0),
            ("uni063A.fina", 70.0),
            ("uni0635.fina", 60.0),
            ("uni0636.fina", 60.0),
        ];
        let rows = [JOINED, HANGING, JOINED, JOINED, hanging, JOINED];
        let ends = |line: f64, shape: &Shape| {
            let ends = shape.joined.iter().filter(|j| **j);
            ends.map(|_| line - 20.0).collect()
        };
        let off = |stand: &[f64]| (stand[4] - lines[4]).abs();
        assert!(off(&of(&lines, &rows)[1]) > 30.0, "nothing else tells");
        let [_, stand] = of_joined(&lines, &rows, ends);
        assert!(off(&stand) < 1.5, "{stand:?}");
        // strokes that end anywhere tell nothing
        let turn = [0.0, 90.0, -60.0, 40.0, -90.0];
        let count = std::cell::Cell::new(0);
        let anywhere = |line: f64, shape: &Shape| {
            count.set(count.get() + 1);
            let ends = ends(line, shape).into_iter();
            ends.map(|y| y + turn[count.get() % 5]).collect()
        };
        let [_, stand] = of_joined(&lines, &rows, anywhere);
        assert!(
            (stand[3] - lines[3]).abs() < 1.5 && (stand[5] - lines[5]).abs() < 1.5,
            "{stand:?}"
        );
    }

    #[test]
    fn two_letters_of_a_steady_hand_tell_where_their_row_stands() {
        let lines = [100.0, 303.0, 497.0, 697.0, 903.0, 1115.0];
        let last: &[_] = &[("?", 1.5), ("!", 1.5)];
        let rows = [CAPITALS, CAPITALS, CAPITALS, CAPITALS, CAPITALS, last];
        let [_, stand] = of(&lines, &rows);
        assert!((stand[5] - lines[5]).abs() < 2.0, "{stand:?}");
    }

    #[test]
    fn a_row_does_not_stand_where_all_of_its_letters_would_float_or_hang_by_their_height() {
        let last: &[_] = &[("6", 1.5), ("7", 3.0), ("8", 1.5), ("9", 0.0), ("0", 1.5)];
        // closer to the row above, and farther from it, than the others are
        for foot in [1010.0, 1290.0] {
            let lines = [100.0, 303.0, 497.0, 702.0, 899.0, foot];
            let rows = [CAPITALS, CAPITALS, CAPITALS, CAPITALS, CAPITALS, last];
            let [_, stand] = of(&lines, &rows);
            assert!((stand[5] - foot).abs() < 2.0, "{stand:?}");
        }
    }
}
