//! `[cells.NAME]`: what a user says better about one letter than the page does.

use super::check;
use crate::pipeline::picture;
use crate::scan::Region;
use kurbo::{Point, Rect};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// What is corrected, by the glyph's name as in `glyphs`.
pub type Cells = BTreeMap<String, CellTable>;

/// One letter's corrections; what is left out stays as it is found.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct CellTable {
    /// Nothing is drawn here: the glyph is left out of the font.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub ignore: bool,
    /// Left, top, right and bottom in the page's picture, px: every piece of ink that lies in it for the larger part
    /// is the letter's.
    #[serde(rename = "box", skip_serializing_if = "Option::is_none")]
    pub bounds: Option<[f64; 4]>,
    /// Corners in the page's picture, px: the ink inside is the letter's, cut at its edge.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub polygon: Vec<[f64; 2]>,
    /// Turns the letter clockwise about the middle of its baseline, degrees.
    #[serde(
        skip_serializing_if = "Option::is_none",
        deserialize_with = "check::optional_angle"
    )]
    pub rotation: Option<f64>,
    /// Moves the letter up, font units.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub baseline_shift: Option<f64>,
    /// Coverage at which its contour runs, 0.1…0.9.
    #[serde(
        skip_serializing_if = "Option::is_none",
        deserialize_with = "check::optional_level"
    )]
    pub threshold: Option<f64>,
    /// How it is traced, instead of `[trace]`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub trace: Option<picture::Options>,
}

impl CellTable {
    /// Where the letter's ink lies, if that is said.
    ///
    /// # Errors
    /// Both a box and a polygon are given, or one that holds nothing.
    pub fn region(&self) -> Result<Option<Region>, String> {
        let polygon: Vec<Point> = self
            .polygon
            .iter()
            .map(|&[x, y]| Point::new(x, y))
            .collect();
        match (self.bounds, polygon.len()) {
            (Some(_), 1..) => {
                Err("box and polygon both say where the ink lies; give one".to_owned())
            }
            (None, 0) => Ok(None),
            (None, 3..) => Ok(Some(Region::Polygon(polygon))),
            (None, _) => Err("a polygon needs three corners".to_owned()),
            (Some([x0, y0, x1, y1]), 0) if x0 < x1 && y0 < y1 => {
                Ok(Some(Region::Box(Rect::new(x0, y0, x1, y1))))
            }
            (Some(_), 0) => Err("box is left, top, right, bottom".to_owned()),
        }
    }
}
