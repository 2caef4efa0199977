//! Where rows stand: from the many letters of a page, never from one letter's own ink.

use crate::numeric::median::{NORMAL, median};
use crate::scan::cut::Levels;
use crate::scan::letters::{Foot, Kind, Shape};
use kurbo::Rect;
use std::iter;

/// How far bows reach past a flat edge, as a share of the letter's height.
pub(super) const OVERSHOOT: f64 = 0.015;
/// A row's own letters weigh against the whole page as this many letters of it do, or more where they scatter by more
/// than rows do.
const SHRINK: f64 = 2.0;
/// The variance of a median in that of a mean, where values are normal ones.
const OF_MEDIAN: f64 = 1.57;
/// How far a foot may lie off the page's common line and still be one, as a share of the usual letter's
/// height: a hand's rows drift by less, a letter that hangs is farther off.
const ASTRAY: f64 = 0.1;
/// Pairs of letters in two rows that tell how rows drift: one alone may have a tail.
const SLOPES: usize = 2;

/// A letter as far as heights go.
pub(super) struct Letter {
    pub(super) row: usize,
    pub(super) level: f64,
    pub(super) shape: Shape,
    /// The box of the largest part of Arabic letters, and of the whole of others; below it ends where all ink but
    /// signs below does.
    pub(super) body: Rect,
    /// The whole ink's box.
    pub(super) whole: Rect,
    /// Where strokes that join it to its neighbours end.
    pub(super) joins: Vec<f64>,
    /// How far letters of its kind hang below the line, px.
    pub(super) hangs: f64,
}

impl Letter {
    /// Where its row's line lies if it stands as letters of its kind do, px below its level.
    pub(super) fn foot(&self) -> f64 {
        self.body.y1 - self.hangs - self.level
    }

    /// Upright px.
    pub(super) fn baseline(&self, drop: &[f64]) -> f64 {
        self.level + drop[self.row]
    }
}

/// How far each row's baseline lies below its slots' levels, px, on a page whose rows are even or at printed
/// `levels`.
pub(super) fn ruled(letters: &[Letter], rows: usize, levels: Levels) -> Vec<f64> {
    let off = feet_on_line(letters, rows);
    drops(off, near(letters), (levels, &vec![0.0; rows]))
}

/// How far a foot may lie off its row's line, px.
pub(super) fn near(letters: &[Letter]) -> f64 {
    ASTRAY * median(letters.iter().map(|l| l.body.height())).unwrap_or(0.0)
}

/// How far each row's baseline lies below the levels, px. But for their strays all rows share it, up to a drift along
/// the page where no levels are printed; the letters of a row move their own baseline as far as their number
/// justifies.
pub(super) fn drops(
    mut off: Vec<(usize, f64)>,
    near: f64,
    (levels, strays): (Levels, &[f64]),
) -> Vec<f64> {
    off.iter_mut().for_each(|o| o.1 -= strays[o.0]);
    let through = match levels {
        Levels::Printed => Line::level,
        Levels::Even | Levels::Loose => Line::through,
    };
    let (common, steady) = Line::steady(&off, near, through);
    let own = |r: usize| -> Vec<f64> { of_row(&steady, r).map(|o| o - common.at(r)).collect() };
    let own: Vec<Vec<f64>> = (0..strays.len()).map(own).collect();
    let shrink = shrink(&own);
    let row = |(r, stray): (usize, &f64)| {
        let n = own[r].len() as f64;
        let off = median(own[r].iter().copied());
        stray + common.at(r) + off.map_or(0.0, |off| off * n / (n + shrink))
    };
    strays.iter().enumerate().map(row).collect()
}

/// As how many letters of a row the whole page weighs: the variance of one letter's foot about its row's line, over
/// that of the rows about theirs. `own` are the feet of each row about the page's line, px.
fn shrink(own: &[Vec<f64>]) -> f64 {
    let medians = own
        .iter()
        .filter_map(|o| Some((median(o.iter().copied())?, o)));
    let medians: Vec<(f64, &Vec<f64>)> = medians.collect();
    let about = medians.iter().filter(|(_, o)| o.len() > 1);
    let about = about.flat_map(|(m, o)| o.iter().map(move |v| (v - m).abs()));
    let letters = (NORMAL * median(about).unwrap_or(0.0)).powi(2) * OF_MEDIAN;
    let by_chance: f64 = medians.iter().map(|(_, o)| letters / o.len() as f64).sum();
    let seen: f64 = medians.iter().map(|(m, _)| m * m).sum();
    let rows = (seen - by_chance).max(0.0) / medians.len().max(1) as f64;
    // nothing over nothing counts as little
    (letters / rows).max(SHRINK)
}

/// Row, and distance from the level, of the feet that tell where rows stand: flat ones, else bows, else all there
/// are.
pub(super) fn feet_on_line(letters: &[Letter], rows: usize) -> Vec<(usize, f64)> {
    let mut off = standing(letters);
    if off.len() < rows || off.len() < 3 {
        let bows = feet(letters, Foot::Round, |_| true).into_iter();
        off.extend(bows.map(|(row, off, height)| (row, off - OVERSHOOT * height)));
    }
    if off.is_empty() {
        off = letters.iter().map(|l| (l.row, l.foot())).collect();
    }
    off
}

/// The values of one row.
pub(super) fn of_row(points: &[(usize, f64)], row: usize) -> impl Iterator<Item = f64> {
    points.iter().filter(move |p| p.0 == row).map(|p| p.1)
}

/// A straight line through values of rows, by medians.
#[derive(Clone, Copy)]
pub(super) struct Line {
    level: f64,
    slope: f64,
}

impl Line {
    /// At the height of most.
    fn level(points: &[(usize, f64)]) -> Self {
        Self {
            level: median(points.iter().map(|p| p.1)).unwrap_or(0.0),
            slope: 0.0,
        }
    }

    pub(super) fn through(points: &[(usize, f64)]) -> Self {
        let slopes = pairs(points);
        let enough = slopes.len() >= SLOPES;
        let slope = median(slopes).filter(|_| enough).unwrap_or(0.0);
        let flat: Vec<f64> = points.iter().map(|p| p.1 - slope * p.0 as f64).collect();
        Self {
            level: median(flat).unwrap_or(0.0),
            slope,
        }
    }

    /// A line through the points that lie within `near` of the line through all, and these points.
    pub(super) fn steady(
        points: &[(usize, f64)],
        near: f64,
        through: fn(&[(usize, f64)]) -> Self,
    ) -> (Self, Vec<(usize, f64)>) {
        let all = through(points);
        let is_near = |p: &&(usize, f64)| (p.1 - all.at(p.0)).abs() <= near;
        let steady: Vec<(usize, f64)> = points.iter().filter(is_near).copied().collect();
        let line = if steady.is_empty() {
            all
        } else {
            through(&steady)
        };
        (line, steady)
    }

    pub(super) fn at(self, row: usize) -> f64 {
        self.level + self.slope * row as f64
    }
}

/// Row, how far the lowest ink lies below the level, and height of the body, of every letter that meets the baseline
/// so.
fn feet(letters: &[Letter], foot: Foot, of: impl Fn(&Letter) -> bool) -> Vec<(usize, f64, f64)> {
    let such = letters.iter().filter(|l| l.shape.foot == foot && of(l));
    such.map(|l| (l.row, l.foot(), l.body.height())).collect()
}

/// Row, and distance of the foot from the level, of the letters that stand flat. Where small letters reach as deep as
/// their own bows do, and capitals do not, they end in an italic's hooks: these are raised to the capitals' line.
fn standing(letters: &[Letter]) -> Vec<(usize, f64)> {
    let of = |foot: Foot, small: bool| -> Vec<(usize, f64)> {
        let all = feet(letters, foot, |l| (l.shape.kind == Kind::Small) == small);
        all.into_iter().map(|(row, off, _)| (row, off)).collect()
    };
    let (capitals, mut small) = (of(Foot::Flat, false), of(Foot::Flat, true));
    let bows = [false, true].map(|s| of(Foot::Round, s));
    let (dip, own) = (dip(&bows[0], &capitals), dip(&bows[1], &small));
    if let Some((dip, _)) = dip
        .zip(own)
        .filter(|(dip, own)| *dip > 0.0 && *own < dip / 2.0)
    {
        let drift = median([pairs(&capitals), pairs(&small)].concat()).unwrap_or(0.0);
        let level = |v: &[(usize, f64)]| median(v.iter().map(|o| o.1 - drift * o.0 as f64));
        let hook = level(&small).unwrap_or(0.0) - level(&capitals).unwrap_or(0.0);
        small.iter_mut().for_each(|o| o.1 -= hook.clamp(0.0, dip));
    }
    capitals.into_iter().chain(small).collect()
}

/// How far bows reach below flat feet in the rows that have both.
fn dip(bows: &[(usize, f64)], flat: &[(usize, f64)]) -> Option<f64> {
    let flat = medians(flat);
    let beside = medians(bows).into_iter().filter_map(|(row, bow)| {
        let foot = flat.iter().find(|f| f.0 == row)?;
        Some(bow - foot.1)
    });
    median(beside)
}

/// Rows and the medians of their values.
fn medians(points: &[(usize, f64)]) -> Vec<(usize, f64)> {
    let last = points.iter().map(|p| p.0).max().unwrap_or(0);
    let rows = (0..=last).filter_map(|r| Some((r, median(of_row(points, r))?)));
    rows.collect()
}

/// The slopes through the medians of all pairs of rows, each as many times as the row with fewer letters has letters:
/// one letter with a tail is no row.
fn pairs(points: &[(usize, f64)]) -> Vec<f64> {
    let rows = medians(points);
    let count = |row: usize| points.iter().filter(|p| p.0 == row).count();
    let pairs = rows
        .iter()
        .enumerate()
        .flat_map(|(i, a)| rows[i + 1..].iter().map(move |b| (a, b)));
    let weighed = pairs.flat_map(|(a, b)| {
        let slope = (b.1 - a.1) / (b.0 - a.0) as f64;
        iter::repeat_n(slope, count(a.0).min(count(b.0)))
    });
    weighed.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::Label;

    impl Letter {
        /// A letter of a row that is 100 px high and ends at `foot`, px from the level.
        pub(in crate::scan::cut::guides) fn ending(row: usize, label: &str, foot: f64) -> Self {
            let body = Rect::new(0.0, foot - 100.0, 50.0, foot);
            Self {
                row,
                level: 0.0,
                shape: Shape::of(&Label(label.to_owned())),
                body,
                whole: body,
                joins: Vec::new(),
                hangs: 0.0,
            }
        }
    }

    /// Letters of rows of a height of 100 px whose lowest ink lies at these depths.
    fn letters(rows: &[&[(&str, f64)]]) -> Vec<Letter> {
        let all = rows.iter().enumerate();
        all.flat_map(|(r, row)| row.iter().map(move |&(l, d)| Letter::ending(r, l, d)))
            .collect()
    }

    #[test]
    fn hooks_of_an_italic_are_no_baseline() {
        let capitals: &[_] = &[("H", 0.0), ("E", 0.1), ("O", 10.0), ("T", 0.0)];
        let hooks: &[_] = &[("n", 7.0), ("i", 7.1), ("o", 7.0), ("m", 7.0)];
        let feet: &[_] = &[("n", 0.0), ("i", 0.1), ("o", 7.0), ("m", 0.0)];
        let figures: &[_] = &[("1", 0.0), ("2", 0.0)];
        for small in [hooks, feet] {
            let rows = [capitals, capitals, capitals, small, small, figures];
            let drop = ruled(&letters(&rows), rows.len(), Levels::Even);
            assert!(drop.iter().all(|d| d.abs() < 0.5), "{drop:?}");
        }
    }

    #[test]
    fn a_letter_with_a_tail_is_no_row() {
        let capitals: &[_] = &[("H", 0.0), ("E", 0.1), ("T", 0.0), ("O", 2.0)];
        let both: &[_] = &[("H", 0.0), ("R", 0.0), ("f", 31.0), ("h", 1.5)];
        let hooks: &[_] = &[("n", 1.7), ("i", 1.7), ("o", 1.7), ("m", 1.7)];
        let tail: &[_] = &[("z", 12.0), ("0", 2.0), ("1", 0.0)];
        for rows in [
            [capitals, capitals, capitals, tail],
            [capitals, both, hooks, tail],
        ] {
            let drop = ruled(&letters(&rows), 4, Levels::Even);
            assert!(drop.iter().all(|d| d.abs() < 0.5), "{drop:?}");
        }
    }

    #[test]
    fn rows_between_printed_lines_do_not_drift() {
        let hanging: &[_] = &[("H", 9.0), ("E", 9.1), ("T", 9.0)];
        let standing: &[_] = &[("n", 0.0), ("i", 0.1), ("m", 0.0)];
        let rows = [hanging, hanging, hanging, standing, standing, standing];
        let of = |levels| {
            let drop = ruled(&letters(&rows), rows.len(), levels);
            (drop[0] - drop[2]).abs() + (drop[3] - drop[5]).abs()
        };
        let (printed, even) = (of(Levels::Printed), of(Levels::Even));
        assert!(printed < 0.01 && even > 0.5, "{printed} {even}");
    }

    #[test]
    fn two_rows_have_baselines_of_their_own() {
        let first: &[_] = &[("A", 0.0), ("B", 0.1), ("C", 2.0), ("D", 0.0), ("E", 0.0)];
        let second: &[_] = &[("F", 9.0), ("G", 11.0), ("H", 9.0), ("I", 9.1), ("J", 14.0)];
        let drop = ruled(&letters(&[first, second]), 2, Levels::Even);
        assert!(
            drop[0].abs() < 0.5 && (drop[1] - 9.0).abs() < 0.5,
            "{drop:?}"
        );
    }

    #[test]
    fn letters_that_bounce_move_no_row() {
        let bounce = [12.0, -9.0, 4.0, -13.0, 8.0, -2.0, 14.0, -6.0, 3.0, -11.0];
        let names = ["H", "E", "T", "M", "N"];
        let row = |r: usize, line: f64, wide: f64| -> Vec<(&str, f64)> {
            let depth = |i: usize| line + wide * bounce[(3 * r + i) % bounce.len()];
            names
                .iter()
                .enumerate()
                .map(|(i, n)| (*n, depth(i)))
                .collect()
        };
        let lines = [0.0, 6.0, -5.0, 7.0, -4.0, 3.0];
        let of = |strays: f64, wide: f64| {
            let rows: Vec<_> = (0..6).map(|r| row(r, strays * lines[r], wide)).collect();
            let rows: Vec<&[_]> = rows.iter().map(Vec::as_slice).collect();
            let drop = ruled(&letters(&rows), rows.len(), Levels::Even);
            let mean = drop.iter().sum::<f64>() / 6.0;
            drop.iter().map(|d| (d - mean).abs()).fold(0.0, f64::max)
        };
        let (bouncing, straying) = (of(0.0, 1.0), of(1.0, 0.1));
        assert!(bouncing < 2.0, "{bouncing}");
        assert!(straying > 4.0, "{straying}");
    }

    #[test]
    fn bowls_of_arabic_letters_are_no_baseline() {
        let bowls: &[_] = &[("ب", 20.0), ("uni0628.fina", 20.0), ("uni0628.init", 0.0)];
        let stems: &[_] = &[("ا", 0.0), ("uni0637.medi", 0.0), ("ط", 0.0)];
        let drop = ruled(&letters(&[stems, bowls, bowls, stems]), 4, Levels::Even);
        assert!(drop.iter().all(|d| d.abs() < 0.5), "{drop:?}");
    }
}
