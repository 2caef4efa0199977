//! Picture → Contours at half coverage, subpixel.
//!
//! | takes | gives |
//! |---|---|
//! | [`Gray`], px, y down, 1 = ink | [`Contour`]s, px, y up, origin at the picture's bottom left, ink on the left |
//!
//! The contours come in the order in which a reader meets them, row by row from the top. They neither
//! cross nor touch. Every ink component and every hole above the speckle limit is there.

mod iso;
#[cfg(test)]
mod tests;

use crate::types::{Contour, Gray};
use serde::{Deserialize, Serialize};

/// Options of the contour tracer.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Coverage at which the contour runs, 0…1.
    pub level: f64,
    /// Ink and holes of a smaller area are dust, px².
    pub speckle_px2: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            level: 0.5,
            // a blot of 2 × 2 px: no scanner resolves a drawn mark that small
            speckle_px2: 4.0,
        }
    }
}

/// The contours of a picture's ink.
#[must_use]
pub fn trace(gray: &Gray, options: &Options) -> Vec<Contour> {
    let rings = iso::rings(gray, options.level);
    let contours = rings.into_iter().filter_map(|r| Contour::new(r).ok());
    contours
        .filter(|c| c.area().abs() >= options.speckle_px2)
        .collect()
}
