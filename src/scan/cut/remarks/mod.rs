//! What a user should look at: letters that may be torn, joined or cut off.

mod grain;
mod signs;

use super::sieve::at_edge;
use super::{Layer, Slot, Warning, bounds};
use crate::numeric::median::{median, middle};
use crate::scan::clean::Page;
use crate::scan::components::Component;
use crate::scan::options::Options;
use crate::types::Gray;
use std::ops::Range;

/// A letter larger than this many usual letters may be two, or hold a line.
const LARGE: f64 = 2.5;

/// A letter smaller than this share of the usual one may be a blot, or a part of one.
pub(crate) const SMALL_SHARE: f64 = 0.3;
/// What is said of it.
pub(crate) const SMALL_LETTER: &str =
    "it is far smaller than the usual letter: is the rest of it missing, or is this a blot?";

/// Ink that comes so near to the baseline of the row below, as a share of the rows' distance, reaches it: letters
/// there stand on it. What touches one above passes that row's baseline.
const REACH: f64 = 0.15;

/// Whether a character is as large as most are: letters and figures; no marks, no hamza, no punctuation.
pub(crate) fn is_full(c: char) -> bool {
    c.is_alphanumeric() && c != 'ء'
}

/// What is odd about the letters of a page of this picture. Pieces `freed` were cut off printed lines,
/// unless they were off letters; baselines lie by `drop` below the levels of each row.
pub(super) fn warnings(
    layer: &Layer,
    all: &[Component],
    gray: &Gray,
    freed: Range<usize>,
    drop: &[f64],
) -> Vec<Warning> {
    let inked = layer.slots.iter().filter(|s| !s.parts.is_empty());
    let inked: Vec<&Slot> = inked.collect();
    let is_freed = |i: usize| freed.contains(&i) && !layer.parted.contains(&i);
    let baseline = |s: &Slot| s.level + drop[s.row];
    let mut out = odd(&inked, all, (gray.width(), gray.height()), is_freed);
    out.extend(signs::warnings(&inked, all));
    out.extend(doubtful(&inked, layer));
    out.extend(parted(&inked, layer));
    out.extend(across(&inked, all, baseline));
    let empty = layer.slots.iter().filter(|s| s.parts.is_empty());
    out.extend(empty.map(|s| Warning::of(s, "the cell is empty: draw the letter or name it _")));
    out
}

/// Warns of the cells whose ink is odd; `is_freed` says which pieces were cut off printed lines.
fn odd(
    slots: &[&Slot],
    all: &[Component],
    picture: (usize, usize),
    is_freed: impl Fn(usize) -> bool,
) -> Vec<Warning> {
    let size = |s: &Slot| bounds(all, &s.parts).map_or(0.0, |b| b.size().max_side());
    let usual = middle(slots.iter().map(|s| size(s)), f64::total_cmp).unwrap_or(0.0);
    let letters = slots.iter().filter(|s| s.shape.full);
    let full = middle(letters.map(|s| size(s)), f64::total_cmp).unwrap_or(0.0);
    let mut out = Vec::new();
    for slot in slots {
        if slot.parts.iter().any(|&i| at_edge(&all[i], picture)) {
            out.push(Warning::of(
                slot,
                "its ink reaches the picture's edge: scan the whole page",
            ));
        }
        if slot.parts.iter().any(|&i| is_freed(i)) {
            out.push(Warning::of(
                slot,
                "its ink touches a printed line: what lies along it is left out",
            ));
        }
        if size(slot) < SMALL_SHARE * full && slot.shape.full {
            out.push(Warning::of(slot, SMALL_LETTER));
        }
        if size(slot) > LARGE * usual {
            let times = size(slot) / usual;
            out.push(Warning::of(
                slot,
                format!(
                    "it is {times:.1} times as large as the usual letter: two letters or a line?"
                ),
            ));
        }
    }
    out
}

/// Warns of the letters whose ink reaches the baseline of the row above or below, upright px: they may touch a letter
/// there.
fn across(slots: &[&Slot], all: &[Component], baseline: impl Fn(&Slot) -> f64) -> Vec<Warning> {
    let row = |r: usize| median(slots.iter().filter(|s| s.row == r).map(|s| baseline(s)));
    let rows = slots.iter().map(|s| s.row + 1).max().unwrap_or(0);
    let lines: Vec<Option<f64>> = (0..rows).map(row).collect();
    let reaches = |slot: &&Slot| {
        let ink = bounds(all, &slot.parts)?;
        let line = |r: Option<usize>| lines.get(r?).copied().flatten();
        let own = line(Some(slot.row))?;
        let above = line(slot.row.checked_sub(1)).is_some_and(|y| ink.y0 < y);
        let below = line(Some(slot.row + 1)).is_some_and(|y| ink.y1 > y - REACH * (y - own));
        let side = match (above, below) {
            (true, _) => "above",
            (_, true) => "below",
            _ => return None,
        };
        let message = format!("its ink reaches the row {side}: does it touch a letter there?");
        Some(Warning::of(slot, message))
    };
    slots.iter().filter_map(reaches).collect()
}

/// What is odd about the picture as a whole.
pub(super) fn of_picture(page: &Page, options: &Options) -> impl Iterator<Item = Warning> {
    let filled = page.filled.then(Warning::of_filled);
    let texture = grain::warning(page).into_iter().chain(filled);
    texture.chain(colourless(page, options))
}

impl Warning {
    /// What is to be said of a page in whose ink pale streaks were filled.
    pub(crate) fn of_filled() -> Self {
        Self::of_page(
            "the ink has pale streaks, as of a ballpoint: they were filled; streaks = \"keep\" under [[sheet]] \
             leaves them",
        )
    }
}

/// A remark where inks are to be told apart in a picture without colours.
fn colourless(page: &Page, options: &Options) -> Option<Warning> {
    let useless = options.ink.choose() && page.sheet.colours.is_none();
    let message = "the picture has no colours, so `ink` tells nothing apart; scan it in colour, or leave `ink` out";
    useless.then(|| Warning::of_page(message))
}

/// Warns of the letters whose names are hardly likelier than the ones beside them.
fn doubtful(slots: &[&Slot], layer: &Layer) -> Vec<Warning> {
    let doubtful = slots.iter().filter(|s| layer.doubtful.contains(&s.index));
    let message =
        "is this its letter, or one beside it? Its size and dots fit their names nearly as well";
    doubtful.map(|s| Warning::of(s, message)).collect()
}

/// Warns of the letters that were cut off others.
fn parted(slots: &[&Slot], layer: &Layer) -> Vec<Warning> {
    let is_parted = |s: &&&Slot| s.parts.iter().any(|i| layer.parted.contains(i));
    let message = "it touches a letter beside it and was cut off where it most likely ends: draw them clear of each other, or say \
        where it ends by `polygon` under [cells.NAME]";
    let parted = slots.iter().filter(is_parted);
    parted.map(|s| Warning::of(s, message)).collect()
}
