//! Baselines and scale of a page.

mod baselines;
mod ends;
mod hanging;
mod joins;
mod slopes;
mod strays;
mod votes;

use super::{Layer, Levels, Slot, Warning, bounds};
use crate::numeric::median::median;
use crate::numeric::surface::Surface;
use crate::scan::clean::Page;
use crate::scan::components::Component;
use crate::scan::cut::largest;
use crate::scan::error::Fault;
use crate::scan::letters::{Head, Kind};
use crate::scan::options::{Options, Scale};
use crate::types::MM_PER_INCH;
use baselines::{Letter, OVERSHOOT, near, ruled};
use ends::ends;
use joins::joins;
use kurbo::Rect;
use slopes::slopes;
use strays::unruled;

/// Heights that letters usually have, as shares of the em, where a user gives no scale: H, x, and alef.
const USUAL: [(Head, f64); 3] = [(Head::Cap, 0.7), (Head::X, 0.5), (Head::Alef, 0.65)];
/// Where no letter of a known height is there: highest to lowest ink, as a share of the em.
const USUAL_EXTENT: f64 = 1.0;

/// What all cells of a page share.
pub(super) struct Guides {
    /// How far the baseline lies below the slots' levels, px, for each row of the layer.
    pub(super) drop: Vec<f64>,
    /// Where rows lie that slope each in its own way, upright px, and how, px down for one to the right.
    pub(super) apart: Option<Vec<(f64, f64)>>,
    pub(super) px_per_em: f64,
    pub(super) warnings: Vec<Warning>,
}

/// Measures baselines and scale, and tells slots that no line guided their levels in rows that slope; `upright` says
/// how a slot's ink is seen.
pub(super) fn measure(
    layer: &mut Layer,
    all: &[Component],
    page: &Page,
    options: &Options,
    upright: impl Fn(&Slot) -> Surface,
) -> Result<Guides, Fault> {
    let letter = |s: &Slot| {
        let (view, gray) = (upright(s), &page.sheet.gray);
        let exact = |i: &usize| {
            let (top, bottom) = ends(&all[*i], gray, &view);
            let rough = all[*i].upright;
            (all[*i].area, Rect::new(rough.x0, top, rough.x1, bottom))
        };
        let mut letter = letter(s, &s.parts.iter().map(exact).collect::<Vec<_>>())?;
        let body = &all[largest(all, &s.parts)?];
        letter.joins = joins(body, letter.shape.joined, &view);
        Some(letter)
    };
    let mut letters: Vec<Letter> = layer.slots.iter().filter_map(letter).collect();
    let hangs = hanging::tell(&mut letters, layer.rows, layer.levels);
    let guided = hangs || !matches!(layer.levels, Levels::Loose);
    let told = if guided {
        None
    } else {
        slopes(&letters, layer.rows, near(&letters))
    };
    if let Some(slopes) = &told {
        slope(layer, slopes, all);
        letters = layer.slots.iter().filter_map(letter).collect();
    }
    let drop = if guided {
        ruled(&letters, layer.rows, layer.levels)
    } else {
        unruled(&letters, layer.rows)
    };
    let (px_per_em, warning) = scale(&letters, &drop, page, options)?;
    let apart = told.map(|slopes| {
        let rows = slopes.into_iter().enumerate();
        rows.filter_map(|(row, slope)| Some((middle(&letters, &drop, row)?, slope)))
            .collect()
    });
    Ok(Guides {
        drop,
        apart,
        px_per_em,
        warnings: warning.into_iter().collect(),
    })
}

/// Slots' levels along rows of such slopes: their row's is that in its middle.
fn slope(layer: &mut Layer, slopes: &[f64], all: &[Component]) {
    let at = |s: &Slot| bounds(all, &s.parts).map(|b| b.center().x);
    let middle = |row: usize| {
        let own = layer.slots.iter().filter(|s| s.row == row);
        let (sum, count) = own
            .filter_map(at)
            .fold((0.0, 0), |(s, n), x| (s + x, n + 1));
        sum / f64::from(count.max(1))
    };
    let middles: Vec<f64> = (0..layer.rows).map(middle).collect();
    for slot in &mut layer.slots {
        if let Some(x) = at(slot) {
            slot.level += slopes[slot.row] * (x - middles[slot.row]);
        }
    }
}

/// The mean of the baselines of a row's letters, upright px; `None` of no letters.
fn middle(letters: &[Letter], drop: &[f64], row: usize) -> Option<f64> {
    let own = letters.iter().filter(|l| l.row == row);
    let (sum, count) = own.fold((0.0, 0), |(s, n), l| (s + l.baseline(drop), n + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// A slot's letter of its parts' areas and boxes.
fn letter(slot: &Slot, parts: &[(usize, Rect)]) -> Option<Letter> {
    let shape = slot.shape;
    let whole = parts.iter().map(|p| p.1).reduce(|a, b| a.union(b))?;
    let largest = parts.iter().max_by_key(|p| p.0)?.1;
    let body = match shape.kind {
        Kind::Arabic if shape.below => largest,
        // a hamza can be larger than the tooth that it stands over
        Kind::Arabic => Rect::new(largest.x0, largest.y0, largest.x1, whole.y1),
        _ => whole,
    };
    Some(Letter {
        row: slot.row,
        level: slot.level,
        shape,
        body,
        whole,
        joins: Vec::new(),
        hangs: 0.0,
    })
}

/// Pixels an em, and a word where nobody gave it.
fn scale(
    letters: &[Letter],
    drop: &[f64],
    page: &Page,
    options: &Options,
) -> Result<(f64, Option<Warning>), Fault> {
    let height = |head, what| head_height(letters, drop, head).ok_or(Fault::NoHeight(what));
    let px = match options.scale {
        Some(Scale::PixelsPerEm(px)) => px,
        Some(Scale::EmMm(mm)) => {
            let dpi = page.sheet.dpi.ok_or(Fault::NoResolution)?;
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
            return Ok((px, Some(Warning::of_page(message))));
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
