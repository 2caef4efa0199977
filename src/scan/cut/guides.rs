//! Baseline and scale: from the many letters of the rows, never from one letter's own ink.

use super::ends::ends;
use super::{Layer, Slot, Warning};
use crate::numeric::median::median;
use crate::numeric::view::View;
use crate::scan::clean::Page;
use crate::scan::components::Component;
use crate::scan::error::ScanError;
use crate::scan::letters::{Foot, Head, Kind, Shape};
use crate::scan::options::{Options, Scale};
use glyphs_reader::glyphdata::GlyphData;
use kurbo::Rect;
use std::iter;

/// How far bows reach past a flat edge, as a share of the letter's height.
const OVERSHOOT: f64 = 0.015;
/// A row's own letters weigh against the whole page as this many letters of it do.
const SHRINK: f64 = 2.0;
/// How far a foot may lie off the page's common line and still be one, as a share of the usual letter's
/// height: a hand's rows drift by less, a letter that hangs is farther off.
const ASTRAY: f64 = 0.1;
/// Pairs of letters in two rows that tell how rows drift: one alone may have a tail.
const SLOPES: usize = 2;
/// Millimetres an inch.
const MM_PER_INCH: f64 = 25.4;
/// Heights that letters usually have, as shares of the em, where a user gives no scale: H, x, and alef.
const USUAL: [(Head, f64); 3] = [(Head::Cap, 0.7), (Head::X, 0.5), (Head::Alef, 0.65)];
/// Where no letter of a known height is there: highest to lowest ink, as a share of the em.
const USUAL_EXTENT: f64 = 1.0;

/// What all cells of a page share.
pub(super) struct Guides {
    /// How far the baseline lies below the slots' levels, px, for each row of the layer.
    pub(super) drop: Vec<f64>,
    pub(super) px_per_em: f64,
    pub(super) warnings: Vec<Warning>,
}

/// A letter as far as heights go.
struct Letter {
    row: usize,
    level: f64,
    shape: Shape,
    /// The body's box: the largest part of letters that have dots, else the whole.
    body: Rect,
    /// The whole ink's box.
    whole: Rect,
}

impl Letter {
    /// Upright px.
    fn baseline(&self, drop: &[f64]) -> f64 {
        self.level + drop[self.row]
    }
}

/// Measures baselines and scale; `upright` says how a slot's ink is seen.
pub(super) fn measure(
    layer: &Layer,
    all: &[Component],
    page: &Page,
    options: &Options,
    upright: impl Fn(&Slot) -> View,
) -> Result<Guides, ScanError> {
    let names = GlyphData::default();
    let letter = |s: &Slot| {
        let (view, gray) = (upright(s), &page.sheet.gray);
        let exact = |i: &usize| {
            let (top, bottom) = ends(&all[*i], gray, &view);
            let rough = all[*i].upright;
            (all[*i].area, Rect::new(rough.x0, top, rough.x1, bottom))
        };
        letter(s, &s.parts.iter().map(exact).collect::<Vec<_>>(), &names)
    };
    let letters: Vec<Letter> = layer.slots.iter().filter_map(letter).collect();
    let drop = drops(&letters, layer.rows);
    let (px_per_em, warning) = scale(&letters, &drop, page, options)?;
    Ok(Guides {
        drop,
        px_per_em,
        warnings: warning.into_iter().collect(),
    })
}

/// A slot's letter of its parts' areas and boxes.
fn letter(slot: &Slot, parts: &[(usize, Rect)], names: &GlyphData) -> Option<Letter> {
    let shape = Shape::of(&slot.label, names);
    let whole = parts.iter().map(|p| p.1).reduce(|a, b| a.union(b))?;
    let largest = parts.iter().max_by_key(|p| p.0)?.1;
    let body = if shape.kind == Kind::Arabic {
        largest
    } else {
        whole
    };
    Some(Letter {
        row: slot.row,
        level: slot.level,
        shape,
        body,
        whole,
    })
}

/// How far each row's baseline lies below its slots' levels, px. All rows share it, up to a drift along the
/// page; the letters of a row move their own baseline as far as their number justifies.
fn drops(letters: &[Letter], rows: usize) -> Vec<f64> {
    let standing = standing(letters);
    let enough = standing.len() >= rows && standing.len() >= 3;
    let bowed = if enough {
        Vec::new()
    } else {
        let all = feet(letters, Foot::Round, |_| true).into_iter();
        all.map(|(row, off, height)| (row, off - OVERSHOOT * height))
            .collect()
    };
    let mut off: Vec<(usize, f64)> = standing.into_iter().chain(bowed).collect();
    if off.is_empty() {
        off = letters
            .iter()
            .map(|l| (l.row, l.body.y1 - l.level))
            .collect();
    }
    let height = median(letters.iter().map(|l| l.body.height()));
    let common = Line::through(&off);
    let near = |&(r, o): &(usize, f64)| (o - common.at(r)).abs() <= ASTRAY * height.unwrap_or(0.0);
    let steady: Vec<(usize, f64)> = off.iter().copied().filter(near).collect();
    let common = if steady.is_empty() {
        common
    } else {
        Line::through(&steady)
    };
    let row = |r: usize| {
        let own: Vec<f64> = steady
            .iter()
            .filter(|o| o.0 == r)
            .map(|o| o.1 - common.at(r))
            .collect();
        let n = own.len() as f64;
        common.at(r) + median(own.iter().copied()).unwrap_or(0.0) * n / (n + SHRINK)
    };
    (0..rows).map(row).collect()
}

/// A straight line through values of rows, by medians.
#[derive(Clone, Copy)]
struct Line {
    level: f64,
    slope: f64,
}

impl Line {
    fn through(points: &[(usize, f64)]) -> Self {
        let slopes = pairs(points);
        let enough = slopes.len() >= SLOPES;
        let slope = median(slopes).filter(|_| enough).unwrap_or(0.0);
        let flat: Vec<f64> = points.iter().map(|p| p.1 - slope * p.0 as f64).collect();
        Self {
            level: median(flat).unwrap_or(0.0),
            slope,
        }
    }

    fn at(self, row: usize) -> f64 {
        self.level + self.slope * row as f64
    }
}

/// Row, how far the lowest ink lies below the level, and height of the body, of every letter that meets the baseline so.
fn feet(letters: &[Letter], foot: Foot, of: impl Fn(&Letter) -> bool) -> Vec<(usize, f64, f64)> {
    let such = letters.iter().filter(|l| l.shape.foot == foot && of(l));
    such.map(|l| (l.row, l.body.y1 - l.level, l.body.height()))
        .collect()
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
    let of = |r: usize| points.iter().filter(move |p| p.0 == r).map(|p| p.1);
    let rows = (0..=last).filter_map(|r| Some((r, median(of(r))?)));
    rows.collect()
}

/// The slopes through the medians of all pairs of rows, each as many times as the row with fewer letters has letters: one
/// letter with a tail is no row.
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

/// Pixels an em, and a word where nobody gave it.
fn scale(
    letters: &[Letter],
    drop: &[f64],
    page: &Page,
    options: &Options,
) -> Result<(f64, Option<Warning>), ScanError> {
    let source_name = || page.sheet.source.clone();
    let height = |head, what| {
        head_height(letters, drop, head).ok_or_else(|| ScanError::NoHeight {
            source_name: source_name(),
            what,
        })
    };
    let px = match options.scale {
        Some(Scale::PixelsPerEm(px)) => px,
        Some(Scale::EmMm(mm)) => {
            let dpi = page.sheet.dpi.ok_or_else(|| ScanError::NoResolution {
                source_name: source_name(),
            })?;
            mm / MM_PER_INCH * dpi
        }
        Some(Scale::XHeight(em)) => height(Head::X, "the height of x")? / em,
        Some(Scale::CapHeight(em)) => height(Head::Cap, "the height of H")? / em,
        Some(Scale::AscenderToDescender(em)) => extent(letters, drop).unwrap_or(1.0) / em,
        None => {
            let known = USUAL
                .iter()
                .find_map(|(head, em)| Some(head_height(letters, drop, *head)? / em));
            let px = known
                .or_else(|| Some(extent(letters, drop)? / USUAL_EXTENT))
                .unwrap_or(1.0);
            let message = format!(
                "no scale is given: {px:.1} pixels an em are taken from the letters' usual heights; \
                 give pixels_per_em, em_mm, x_height, cap_height or ascender_to_descender"
            );
            return Ok((
                px,
                Some(Warning {
                    index: None,
                    label: None,
                    message,
                }),
            ));
        }
    };
    Ok((px, None))
}

/// The height above the baseline that letters share, px: of flat heads, else of bows.
fn head_height(letters: &[Letter], drop: &[f64], head: Head) -> Option<f64> {
    let of = |head: Head| -> Vec<f64> {
        let such = letters.iter().filter(|l| l.shape.head == head);
        such.map(|l| l.baseline(drop) - l.body.y0)
            .filter(|h| *h > 0.0)
            .collect()
    };
    let bows = match head {
        Head::Cap => Head::CapBow,
        Head::X => Head::XBow,
        other => other,
    };
    median(of(head)).or_else(|| Some(median(of(bows))? / (1.0 + OVERSHOOT)))
}

/// From the highest ink to the lowest, about the baselines, px.
fn extent(letters: &[Letter], drop: &[f64]) -> Option<f64> {
    let above = letters
        .iter()
        .map(|l| l.baseline(drop) - l.whole.y0)
        .reduce(f64::max)?;
    let below = letters
        .iter()
        .map(|l| l.whole.y1 - l.baseline(drop))
        .reduce(f64::max)?;
    Some((above + below).max(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::Label;

    /// Letters of rows of a height of 100 px whose lowest ink lies at these depths.
    fn letters(rows: &[&[(&str, f64)]]) -> Vec<Letter> {
        let names = GlyphData::default();
        let of = |row: usize, label: &str, depth: f64| {
            let body = Rect::new(0.0, depth - 100.0, 50.0, depth);
            Letter {
                row,
                level: 0.0,
                shape: Shape::of(&Label(label.to_owned()), &names),
                body,
                whole: body,
            }
        };
        let all = rows.iter().enumerate();
        all.flat_map(|(r, row)| row.iter().map(move |&(l, d)| of(r, l, d)))
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
            let drop = drops(&letters(&rows), rows.len());
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
            let drop = drops(&letters(&rows), 4);
            assert!(drop.iter().all(|d| d.abs() < 0.5), "{drop:?}");
        }
    }

    #[test]
    fn two_rows_have_baselines_of_their_own() {
        let first: &[_] = &[("A", 0.0), ("B", 0.1), ("C", 2.0), ("D", 0.0), ("E", 0.0)];
        let second: &[_] = &[("F", 9.0), ("G", 11.0), ("H", 9.0), ("I", 9.1), ("J", 14.0)];
        let drop = drops(&letters(&[first, second]), 2);
        assert!(
            drop[0].abs() < 0.5 && (drop[1] - 9.0).abs() < 0.5,
            "{drop:?}"
        );
    }

    #[test]
    fn bowls_of_arabic_letters_are_no_baseline() {
        let bowls: &[_] = &[("ب", 20.0), ("uni0628.fina", 20.0), ("uni0628.init", 0.0)];
        let stems: &[_] = &[("ا", 0.0), ("uni0637.medi", 0.0), ("ط", 0.0)];
        let drop = drops(&letters(&[stems, bowls, bowls, stems]), 4);
        assert!(drop.iter().all(|d| d.abs() < 0.5), "{drop:?}");
    }
}
