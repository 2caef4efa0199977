//! What a user should look at: letters that may be torn, joined or cut off.

use super::{Slot, Warning, signs};
use crate::numeric::median::median;
use crate::scan::components::Component;
use crate::scan::letters::Shape;
use glyphs_reader::glyphdata::GlyphData;
use kurbo::Rect;

/// A letter larger than this many usual letters may be two, or hold a line.
const LARGE: f64 = 2.5;

/// A letter smaller than this share of the usual one may be a blot, or a part of one.
pub const SMALL: f64 = 0.3;
/// What is said of it.
pub const SMALL_LETTER: &str =
    "it is far smaller than the usual letter: is the rest of it missing, or is this a blot?";

/// Ink that comes so near to the baseline of the row below, as a share of the rows' distance, reaches it: letters there stand on it. What
/// touches one above passes that row's baseline.
const REACH: f64 = 0.15;

/// Whether a character is as large as most are: letters and figures; no marks, no hamza, no punctuation.
#[must_use]
pub fn is_full(c: char) -> bool {
    c.is_alphanumeric() && c != 'ء'
}

/// Warns of the cells whose ink is odd; `is_freed` says which pieces were cut off a printed box.
pub(super) fn warnings(
    slots: &[&Slot],
    all: &[Component],
    picture: Rect,
    is_freed: impl Fn(usize) -> bool,
) -> Vec<Warning> {
    let bounds = |s: &Slot, of: fn(&Component) -> Rect| {
        let boxes = s.parts.iter().map(|&i| of(&all[i]));
        boxes.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
    };
    let size = |s: &Slot| {
        let b = bounds(s, |c| c.upright);
        b.width().max(b.height())
    };
    let mut sizes: Vec<f64> = slots.iter().map(|s| size(s)).collect();
    sizes.sort_by(f64::total_cmp);
    let usual = sizes.get(sizes.len() / 2).copied().unwrap_or(0.0);
    let names = GlyphData::default();
    let letters = slots.iter().filter(|s| Shape::of(&s.label, &names).full);
    let mut full: Vec<f64> = letters.map(|s| size(s)).collect();
    full.sort_by(f64::total_cmp);
    let full = full.get(full.len() / 2).copied().unwrap_or(0.0);
    let mut out = Vec::new();
    for slot in slots {
        let b = bounds(slot, |c| c.bounds);
        if b.x0 <= picture.x0 || b.y0 <= picture.y0 || b.x1 >= picture.x1 || b.y1 >= picture.y1 {
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
        if size(slot) < SMALL * full && Shape::of(&slot.label, &names).full {
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
    out.extend(signs::warnings(slots, all));
    out
}

/// Warns of the letters whose ink reaches the baseline of the row above or below, upright px: they may touch a letter there.
pub(super) fn across(
    slots: &[&Slot],
    all: &[Component],
    baseline: impl Fn(&Slot) -> f64,
) -> Vec<Warning> {
    let row = |r: usize| median(slots.iter().filter(|s| s.row == r).map(|s| baseline(s)));
    let rows = slots.iter().map(|s| s.row + 1).max().unwrap_or(0);
    let lines: Vec<Option<f64>> = (0..rows).map(row).collect();
    let reaches = |slot: &&Slot| {
        let boxes = slot.parts.iter().map(|&i| all[i].upright);
        let ink = boxes.reduce(|a, b| a.union(b))?;
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
