//! Rows that slope each in its own way: a hand that no line guided lets some climb and some fall.
//!
//! Along a row letters that stand on its line have their feet on one slope, Arabic letters of one body theirs, and
//! joining strokes their ends. With that slope `b_r` in row `r`, by medians and off by a standard deviation `s_r`, all
//! slopes of a page are taken for draws from a normal one of mean `m` and variance `t²`, and each row's is
//!
//! ```text
//! m + (b_r - m) t² / (t² + s_r²)
//! ```
//!
//! Rows that are parallel as far as letters tell have none: the page's turn is theirs.

use super::baselines::{Letter, OVERSHOOT};
use crate::numeric::median::{NORMAL, median};
use crate::scan::letters::Foot;
use kurbo::{Point, Vec2};
use std::collections::BTreeMap;

/// Letters of a kind behind its first that tell a row's slope, at least: of fewer nobody knows how far they stray.
const ENOUGH: usize = 3;
/// And of a kind at most: pairs of more take long, and tell no more.
const MOST: usize = 200;
/// Rows that lie aslant beyond doubt, at least, and how many of its deviations such a row's slope is.
const ROWS: usize = 2;
const DOUBT: f64 = 4.0;
/// Letters stray by this share of a usual one's height at least.
const LEAST: f64 = 0.01;

/// What is as high above or below its row's line wherever it stands in a row.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Datum {
    Foot,
    Body(usize),
    Join,
}

/// A row by its letters.
struct Row {
    /// px down for one to the right
    slope: f64,
    /// length along which its letters stand, px
    length: f64,
    /// Σ (x − mean of the kind)² of as many places as it has letters, px²
    lever: f64,
    /// how far letters stray from that slope, px, by pairs of a kind
    off: Vec<f64>,
}

impl Row {
    /// Through places of some letters, by kinds; `None` of too few.
    fn through(kinds: &BTreeMap<Datum, Vec<Point>>, letters: usize) -> Option<Self> {
        let count: usize = kinds.values().map(Vec::len).sum();
        // places of one letter stray together
        let one = |a: &Point, b: &Point| a.x.total_cmp(&b.x).is_eq();
        let behind = |places: &Vec<Point>| places.chunk_by(one).count() - 1;
        let spare = kinds.values().map(behind).sum::<usize>();
        let spare = spare.min(letters.saturating_sub(1));
        if spare < ENOUGH {
            return None;
        }
        let pairs: Vec<Vec2> = kinds.values().flat_map(|v| pairs(v)).collect();
        let slope = median(pairs.iter().map(|d| d.y / d.x))?;
        let lever = |places: &Vec<Point>| -> f64 {
            let mean = places.iter().map(|p| p.x).sum::<f64>() / places.len() as f64;
            places.iter().map(|p| (p.x - mean).powi(2)).sum()
        };
        // all places of a letter stray with it, and a slope leaves not all of what they stray
        let lever = kinds.values().map(lever).sum::<f64>() * letters as f64 / count as f64;
        let free = (0.5 * spare as f64 / (spare - 1) as f64).sqrt();
        let off = pairs.iter().map(|d| (d.y - slope * d.x).abs() * free);
        let xs = || kinds.values().flatten().map(|p| p.x);
        Some(Self {
            slope,
            length: xs().fold(f64::NEG_INFINITY, f64::max) - xs().fold(f64::INFINITY, f64::min),
            lever,
            off: off.collect(),
        })
    }
}

/// From each of a kind's places to each of another letter behind it.
fn pairs(places: &[Point]) -> Vec<Vec2> {
    let step = places.len().div_ceil(MOST).max(1);
    let places: Vec<&Point> = places.iter().step_by(step).collect();
    let pairs = places.iter().enumerate();
    let pairs = pairs.flat_map(|(i, a)| places[i + 1..].iter().map(move |b| **b - **a));
    pairs.filter(|d| d.x != 0.0).collect()
}

/// Slopes of rows, px down for one to the right; `None` where they are parallel, up to `near` px along a row.
pub(super) fn slopes(letters: &[Letter], rows: usize, near: f64) -> Option<Vec<f64>> {
    let mut kinds = vec![BTreeMap::<Datum, Vec<Point>>::new(); rows];
    for letter in letters {
        for (kind, place) in places(letter) {
            kinds[letter.row].entry(kind).or_default().push(place);
        }
    }
    let all = kinds.iter().enumerate().map(|(row, kinds)| {
        let telling = |l: &&Letter| l.row == row && places(l).next().is_some();
        Row::through(kinds, letters.iter().filter(telling).count())
    });
    let all: Vec<Option<Row>> = all.collect();
    let told: Vec<&Row> = all.iter().flatten().collect();
    let height = median(letters.iter().map(|l| l.body.height()))?;
    let stray = NORMAL * median(told.iter().flat_map(|r| r.off.iter().copied()))?;
    let stray = stray.max(LEAST * height);
    let variance = |row: &Row| stray * stray / row.lever;
    let aslant = |row: &&&Row| {
        row.slope.abs() * row.length > near && row.slope.powi(2) > DOUBT * DOUBT * variance(row)
    };
    if told.iter().filter(aslant).count() < ROWS {
        return None;
    }
    let mean = median(told.iter().map(|r| r.slope))?;
    let seen = NORMAL * median(told.iter().map(|r| (r.slope - mean).abs()))?;
    let by_chance = median(told.iter().map(|r| variance(r)))?;
    let spread = (seen * seen - by_chance).max(0.0);
    let shrunk = |row: &Option<Row>| {
        let own = row
            .as_ref()
            .map(|r| (r.slope - mean) * spread / (spread + variance(r)));
        mean + own.filter(|s| s.is_finite()).unwrap_or(0.0)
    };
    Some(all.iter().map(shrunk).collect())
}

/// What of a letter tells its row's slope.
fn places(letter: &Letter) -> impl Iterator<Item = (Datum, Point)> + use<'_> {
    let x = letter.body.center().x;
    let (line, body) = (Some(Datum::Foot), letter.shape.body.map(Datum::Body));
    let (kind, dips) = match letter.shape.foot {
        Foot::Flat => (line, 0.0),
        Foot::Round => (line, OVERSHOOT * letter.body.height()),
        Foot::Tail | Foot::None => (body, 0.0),
    };
    let foot = kind.map(|k| (k, Point::new(x, letter.foot() - dips)));
    let ends = letter.joins.iter();
    let ends = ends.map(move |y| (Datum::Join, Point::new(x, y - letter.level)));
    foot.into_iter().chain(ends)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: f64 = 60.0;
    const NEAR: f64 = 10.0;

    const LATIN: [&str; 7] = ["H", "g", "E", "T", "N", "y", "M"];
    /// Letters of two bodies, none of which ends on the line.
    const BOWLS: [&str; 7] = [
        "uni0628.fina",
        "uni062D.fina",
        "uni062A.fina",
        "uni062E.fina",
        "uni062B.fina",
        "uni062C.fina",
        "uni067E.fina",
    ];

    /// The slopes of rows of letters, 100 px high, that slope so and bounce by so many px.
    fn of(names: [&str; 7], rows: &[f64], bounce: f64) -> Option<Vec<f64>> {
        let bounces = [0.3, -0.8, 1.0, -0.2, 0.5, -1.0, 0.1];
        let letter = |row: usize, k: usize, name: &str| {
            let x = k as f64 * 3.0 * WIDTH;
            let strays = bounce * bounces[(3 * row + k) % bounces.len()];
            let hangs = if name.starts_with("uni") {
                20.0 * (k % 2) as f64
            } else {
                0.0
            };
            let mut letter = Letter::ending(row, name, rows[row] * x + strays + hangs);
            letter.body.x0 = x;
            letter.body.x1 = x + WIDTH;
            letter
        };
        let row = |r: usize| names.iter().enumerate().map(move |(k, n)| (r, k, *n));
        let all = (0..rows.len()).flat_map(row);
        let letters: Vec<Letter> = all.map(|(r, k, n)| letter(r, k, n)).collect();
        slopes(&letters, rows.len(), NEAR)
    }

    #[test]
    fn parallel_rows_have_no_slopes_of_their_own() {
        for (names, bounce) in [LATIN, BOWLS]
            .into_iter()
            .flat_map(|n| [0.0, 2.0, 10.0, 20.0].map(|b| (n, b)))
        {
            assert_eq!(of(names, &[0.0; 6], bounce), None, "{bounce}");
        }
    }

    #[test]
    fn ends_of_one_letter_are_no_two_letters() {
        let strays = [6.0, -5.0, 2.0, -7.0, 4.0, 4.0, -7.0, 2.0, -5.0, 6.0];
        let letter = |row: usize, k: usize| {
            let mut letter = Letter::ending(row, "uni062D.medi", 0.0);
            let y = strays[k] + 2.0 * k as f64;
            letter.body = letter.body + Vec2::new(k as f64 * 3.0 * WIDTH, y);
            letter.joins = vec![y - 30.0, y - 29.0];
            letter
        };
        let row = |r: usize| (0..strays.len()).map(move |k| (r, k));
        let letters: Vec<Letter> = (0..3).flat_map(row).map(|(r, k)| letter(r, k)).collect();
        assert_eq!(slopes(&letters, 3, NEAR), None);
    }

    #[test]
    fn three_letters_of_two_ends_tell_no_slope() {
        let rise = |row: usize| 0.1 + 0.1 * row as f64;
        let letter = |row: usize, k: usize| {
            let mut letter = Letter::ending(row, "uni062D.medi", 0.0);
            let x = k as f64 * 3.0 * WIDTH;
            letter.body = letter.body + Vec2::new(x, rise(row) * x);
            letter.joins = vec![rise(row) * x - 30.0; 2];
            letter
        };
        let of = |count: usize| {
            let row = |r: usize| (0..count).map(move |k| (r, k));
            let letters: Vec<Letter> = (0..3).flat_map(row).map(|(r, k)| letter(r, k)).collect();
            slopes(&letters, 3, NEAR)
        };
        assert_eq!(of(3), None);
        let told = of(5).unwrap();
        assert!(
            (0..3).all(|row| (told[row] - rise(row)).abs() < 0.01),
            "{told:?}"
        );
    }

    #[test]
    fn rows_that_climb_and_fall_are_followed() {
        let drawn = [0.04, 0.0, -0.03, 0.02, 0.05, -0.01];
        for (names, bounce, most) in [
            (LATIN, 0.0, 0.002),
            (LATIN, 4.0, 0.008),
            (BOWLS, 0.0, 0.002),
            (BOWLS, 4.0, 0.012),
        ] {
            let found = of(names, &drawn, bounce).unwrap();
            let off = found.iter().zip(drawn).map(|(a, b)| (a - b).abs());
            let off = off.fold(0.0, f64::max);
            assert!(off < most, "{off} of {found:?}");
        }
    }
}
