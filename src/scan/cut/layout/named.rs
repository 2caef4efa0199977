//! Places on a page and the ink in them → letters with their labels.

use crate::numeric::median::middle;
use crate::scan::components::Component;
use crate::scan::cut::{Reason, Slot};
use crate::scan::error::Fault;
use crate::scan::letters::Shape;
use crate::types::Label;

/// Ink in a place without a name counts from this share of a usual place's ink.
pub(super) const COUNTS: f64 = 0.1;

/// Ink of a place that counts, px², where all places have so much.
pub(super) fn least(inks: impl Iterator<Item = usize>) -> f64 {
    COUNTS * middle(inks.filter(|&ink| ink > 0), usize::cmp).unwrap_or(0) as f64
}

/// A cell of a grid, or a box.
pub(super) struct Place {
    /// Where it comes in reading order.
    pub(super) index: usize,
    pub(super) row: usize,
    pub(super) column: usize,
    /// As in [`Slot`].
    pub(super) level: f64,
    /// The ink in it.
    pub(super) parts: Vec<usize>,
}

/// The letters of a page of so many names, in reading order; what lies in places that are skipped, and dirt in those
/// without a name, is rejected.
///
/// # Errors
/// A letter has no name.
pub(super) fn named(
    all: &[Component],
    places: Vec<Place>,
    labels: &[Label],
    rejected: &mut Vec<(usize, Reason)>,
) -> Result<Vec<Slot>, Fault> {
    let ink = |parts: &[usize]| parts.iter().map(|&i| all[i].area).sum::<usize>();
    let least = least(places.iter().map(|p| ink(&p.parts)));
    let mut slots = Vec::new();
    for place in places {
        match labels.get(place.index) {
            Some(label) if label.0 == "_" => {
                rejected.extend(place.parts.iter().map(|&i| (i, Reason::Skipped)));
            }
            Some(label) => slots.push(Slot {
                label: label.clone(),
                shape: Shape::of(label),
                index: place.index,
                row: place.row,
                level: place.level,
                parts: place.parts,
            }),
            None if ink(&place.parts) as f64 > least => {
                return Err(Fault::TooFewNames {
                    row: place.row + 1,
                    column: place.column + 1,
                    names: labels.len(),
                });
            }
            None => rejected.extend(place.parts.iter().map(|&i| (i, Reason::Dirt))),
        }
    }
    slots.sort_by_key(|s| s.index);
    Ok(slots)
}
