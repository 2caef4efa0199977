//! Letters → how far capitals and figures hang: in scripts and display styles they end below the small letters' line.
//!
//! Only rows at even distances tell, since uneven ones of one kind each look alike: with the feet of the letters of
//! kind `k` in row `r` at
//!
//! ```text
//! a + b r + h(k)
//! ```
//!
//! px below their levels, `b` being 0 where these are printed, least squares over the rows' medians, what is left
//! must be far less than `h`. Of two letters one may have a swash, so that where the medians do not tell two letters
//! say no more than that their foot lies between theirs: the nearest place there to the line counts.

use super::baselines::{Letter, OVERSHOOT, near};
use crate::numeric::median::median;
use crate::scan::cut::Levels;
use crate::scan::letters::{Foot, Kind};
use nalgebra::{DMatrix, DVector};

/// The kinds that stand on a line of their own; where the first has letters it is the page's.
const KINDS: [Kind; 3] = [Kind::Small, Kind::Capital, Kind::Figure];
/// Letters of a kind that tell where they stand in a row, and rows of those that hang, at least.
const ENOUGH: usize = 2;
/// Weight of rows that do not drift, since their levels are printed.
const HELD: f64 = 1e9;
/// Letters of a row whose median is but the middle of two.
const PAIR: usize = 2;
/// Times that pairs are told from the lines, and lines from the pairs: beyond the third nothing moves by a tenth of a
/// px.
const ROUNDS: usize = 4;
/// Medians that are more than enough to tell all lines, at least.
const SPARE: usize = 2;
/// How far a kind hangs at least and at most that does, in times of what letters stray: more than an italic's hooks,
/// less than half a letter.
const FAR: (f64, f64) = (0.5, 5.0);
/// What is left at most, as a share of how far letters hang: strays of uneven rows are as small by chance on 1.5 % of
/// pages of eight rows with a kind each, and on none where three rows or more have two kinds.
const LEFT: f64 = 0.15;

/// Where letters of a kind end in a row, px below their level.
struct Feet {
    row: usize,
    kind: usize,
    at: f64,
    /// The least and the most that it may be.
    within: (f64, f64),
    letters: usize,
}

/// Tells letters of kinds that hang by how much they do; whether there are any, so that the rows are known to stand
/// at even distances.
pub(super) fn tell(letters: &mut [Letter], rows: usize, levels: Levels) -> bool {
    let Some(depths) = depths(letters, rows, levels) else {
        return false;
    };
    for letter in letters {
        let kind = KINDS.iter().position(|k| *k == letter.shape.kind);
        letter.hangs = kind.map_or(0.0, |k| depths[k]);
    }
    true
}

/// How far the letters of each kind hang, px; `None` where the rows do not tell, or nothing hangs.
fn depths(letters: &[Letter], rows: usize, levels: Levels) -> Option<[f64; KINDS.len()]> {
    let feet = feet(letters, rows);
    let present = (0..KINDS.len()).filter(|&k| feet.iter().any(|f| f.kind == k));
    let kinds: Vec<usize> = present.collect();
    let spare = feet.len().checked_sub(1 + kinds.len())?;
    if kinds.len() < 2 || spare < SPARE {
        return None;
    }
    let mut fits = [0, ROUNDS].into_iter().map(|rounds| {
        let (lines, left) = lines(&feet, (&kinds, levels), rounds)?;
        told(&feet, &kinds, &lines, left / spare as f64, near(letters))
    });
    fits.find_map(|depths| depths)
}

/// How far the letters of each kind hang, px, by a fit that leaves such a variance of one letter's foot, px²; `None`
/// where it does not tell.
fn told(
    feet: &[Feet],
    kinds: &[usize],
    lines: &DVector<f64>,
    left: f64,
    near: f64,
) -> Option<[f64; KINDS.len()]> {
    let usual = feet.iter().map(|f| f.letters as f64).sum::<f64>() / feet.len() as f64;
    let mut depths = [0.0; KINDS.len()];
    for (i, &k) in kinds.iter().enumerate() {
        depths[k] = lines[1 + i] - lines[1];
    }
    let stands = |k: usize| feet.iter().filter(|f| f.kind == k).count() >= ENOUGH;
    let hangs = (0..KINDS.len())
        .filter(|&k| stands(k))
        .map(|k| depths[k].abs());
    let far = hangs.reduce(f64::max)?;
    if !(FAR.0 * near..FAR.1 * near).contains(&far) {
        return None;
    }
    ((left / usual).sqrt() <= LEFT * far).then_some(depths)
}

/// The slope of the rows and a line for each kind, px, and the weighed squares of what is left; `rounds` times feet
/// of pairs go to where they fit best.
fn lines(
    feet: &[Feet],
    (kinds, levels): (&[usize], Levels),
    rounds: usize,
) -> Option<(DVector<f64>, f64)> {
    let column = |f: &Feet, i: usize| match i {
        0 => f.row as f64,
        i => f64::from(u8::from(kinds[i - 1] == f.kind)),
    };
    let weight = |f: &Feet| (f.letters as f64).sqrt();
    let rows = DMatrix::from_fn(feet.len(), 1 + kinds.len(), |i, j| {
        weight(&feet[i]) * column(&feet[i], j)
    });
    let mut square = rows.transpose() * &rows;
    square[(0, 0)] += match levels {
        Levels::Printed => HELD,
        Levels::Even | Levels::Loose => 0.0,
    };
    let square = square.cholesky()?;
    let fit = |at: &DVector<f64>| square.solve(&(rows.transpose() * at));
    let weighed = feet.iter().map(|f| weight(f) * f.at);
    let mut at = DVector::from_iterator(feet.len(), weighed);
    for _ in 0..rounds {
        at = &rows * fit(&at);
        for (at, f) in at.iter_mut().zip(feet) {
            *at = at.clamp(weight(f) * f.within.0, weight(f) * f.within.1);
        }
    }
    let lines = fit(&at);
    let left = (&rows * &lines - &at).norm_squared();
    Some((lines, left))
}

/// The median foot of each kind in each row that has some of its letters.
fn feet(letters: &[Letter], rows: usize) -> Vec<Feet> {
    let foot = |l: &Letter| match l.shape.foot {
        Foot::Flat => Some(l.foot()),
        Foot::Round => Some(l.foot() - OVERSHOOT * l.body.height()),
        Foot::Tail | Foot::None => None,
    };
    let places = (0..rows).flat_map(|row| (0..KINDS.len()).map(move |kind| (row, kind)));
    let feet = places.filter_map(|(row, kind)| {
        let own = letters
            .iter()
            .filter(|l| l.row == row && l.shape.kind == KINDS[kind]);
        let all: Vec<f64> = own.filter_map(foot).collect();
        let letters = all.len();
        let ends = all.iter().copied().reduce(f64::min);
        let ends = ends.zip(all.iter().copied().reduce(f64::max));
        let at = median(all).filter(|_| letters >= ENOUGH)?;
        Some(Feet {
            row,
            kind,
            at,
            within: ends.filter(|_| letters == PAIR).unwrap_or((at, at)),
            letters,
        })
    });
    feet.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::cut::guides::baselines::ruled;

    const CAPITALS: &[(&str, f64)] = &[("H", 40.0), ("E", 43.0), ("T", 38.0), ("O", 41.0)];
    const SMALL: &[(&str, f64)] = &[("n", 0.0), ("i", 2.0), ("m", -1.0), ("a", 1.0), ("g", 90.0)];
    const FIGURES: &[(&str, f64)] = &[("1", 30.0), ("2", 32.0), ("8", 30.0), ("0", 31.0)];
    const ROWS: [&[(&str, f64)]; 7] =
        [CAPITALS, CAPITALS, CAPITALS, SMALL, SMALL, FIGURES, FIGURES];

    /// Letters of 100 px that end so far below the lines of their rows.
    fn page(rows: &[&[(&str, f64)]], lines: impl Fn(usize) -> f64) -> Vec<Letter> {
        let all = rows.iter().enumerate();
        let letters = all.flat_map(|(r, row)| row.iter().map(move |&(l, d)| (r, l, d)));
        letters
            .map(|(r, l, d)| Letter::ending(r, l, lines(r) + d))
            .collect()
    }

    #[test]
    fn capitals_and_figures_that_hang_leave_the_rows_even() {
        let mut letters = page(&ROWS, |r| 3.0 * r as f64);
        assert!(tell(&mut letters, ROWS.len(), Levels::Loose));
        let drop = ruled(&letters, ROWS.len(), Levels::Even);
        for (r, drop) in drop.iter().enumerate() {
            assert!((drop - 3.0 * r as f64).abs() < 2.0, "{drop:?}");
        }
    }

    #[test]
    fn a_swash_beside_one_letter_tells_no_line() {
        // the last capitals of a hand, before its small letters: untold, rows would be off by half of what capitals
        // hang, 20 px
        let swash: &[_] = &[
            ("Y", 41.0),
            ("Z", 170.0),
            ("c", 1.0),
            ("a", -1.0),
            ("b", 0.0),
        ];
        let rows = [
            CAPITALS, CAPITALS, CAPITALS, swash, SMALL, SMALL, FIGURES, FIGURES,
        ];
        let mut letters = page(&rows, |r| 3.0 * r as f64);
        assert!(tell(&mut letters, rows.len(), Levels::Loose));
        let drop = ruled(&letters, rows.len(), Levels::Even);
        for (r, drop) in drop.iter().enumerate() {
            assert!((drop - 3.0 * r as f64).abs() < 4.0, "{drop:?}");
        }
    }

    #[test]
    fn rows_that_stray_hang_by_nothing() {
        let strays = [0.0, 41.0, -27.0, 12.0, 38.0, -16.0, 25.0];
        for rows in [ROWS, [CAPITALS; 7], [SMALL; 7]] {
            let mut letters = page(&rows, |r| strays[r]);
            assert!(!tell(&mut letters, rows.len(), Levels::Loose));
            assert!(letters.iter().all(|l| l.hangs.abs() < 1e-9));
        }
    }

    #[test]
    fn uneven_rows_seldom_hang_by_chance() {
        let names = [
            "ABDEHIKLM",
            "NORSTUVXZ",
            "ABDEHIKL",
            "acehiklm",
            "nosuvxzr",
            "tuvxz12",
            "12806",
        ];
        let mut seed = 1u32;
        let mut even = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(seed >> 8) / f64::from(1 << 24)
        };
        let told = (0..1000).filter(|_| {
            // nearly normal
            let strays: Vec<f64> = names
                .iter()
                .map(|_| (0..12).map(|_| even()).sum::<f64>())
                .collect();
            let letters = names
                .iter()
                .enumerate()
                .flat_map(|(r, row)| row.chars().map(move |c| (r, c)));
            let letter =
                |(r, c): (usize, char)| Letter::ending(r, &c.to_string(), 15.0 * strays[r]);
            tell(
                &mut letters.map(letter).collect::<Vec<_>>(),
                names.len(),
                Levels::Loose,
            )
        });
        let told = told.count();
        assert!(told <= 30, "{told} of 1000");
    }

    #[test]
    fn a_page_on_its_side_hangs_by_nothing() {
        let far: &[_] = &[("H", 160.0), ("E", 163.0), ("T", 158.0), ("O", 161.0)];
        let rows = ROWS.map(|r| if r == CAPITALS { far } else { r });
        assert!(!tell(&mut page(&rows, |_| 0.0), rows.len(), Levels::Loose));
    }

    #[test]
    fn few_rows_do_not_tell() {
        for rows in [
            vec![CAPITALS, SMALL, SMALL, SMALL],
            vec![CAPITALS, CAPITALS, SMALL, SMALL],
        ] {
            assert!(!tell(&mut page(&rows, |_| 0.0), rows.len(), Levels::Loose));
        }
    }
}
