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
    /// Corners of what upright is a rectangle in the page's picture, px: top left, top right, bottom right, bottom
    /// left. The ink inside is the letter's, and is seen straight.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub quad: Option<[[f64; 2]; 4]>,
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
    /// More than one place is given, or one that holds nothing.
    pub(crate) fn region(&self) -> Result<Option<Region>, String> {
        let point = |&[x, y]: &[f64; 2]| Point::new(x, y);
        let polygon: Vec<Point> = self.polygon.iter().map(point).collect();
        let given = [
            self.bounds.is_some(),
            !polygon.is_empty(),
            self.quad.is_some(),
        ];
        if given.iter().filter(|g| **g).count() > 1 {
            return Err("box, polygon and quad all say where the ink lies; give one".to_owned());
        }
        match (self.bounds, polygon.len(), self.quad) {
            (Some([x0, y0, x1, y1]), ..) if x0 < x1 && y0 < y1 => {
                Ok(Some(Region::Box(Rect::new(x0, y0, x1, y1))))
            }
            (Some(_), ..) => Err("box is left, top, right, bottom".to_owned()),
            (_, 3.., _) => Ok(Some(Region::Polygon(polygon))),
            (_, 1.., _) => Err("a polygon needs three corners".to_owned()),
            (.., Some(corners)) => {
                let corners = corners.map(|c| point(&c));
                let turns = (0..4).map(|i| {
                    let [a, b, c] = [i, i + 1, i + 2].map(|k| corners[k % 4]);
                    (b - a).cross(c - b)
                });
                if turns.into_iter().all(|t| t > 0.0) {
                    Ok(Some(Region::Quad(corners)))
                } else {
                    Err("quad is top left, top right, bottom right, bottom left of a shape without dents".to_owned())
                }
            }
            (None, 0, None) => Ok(None),
        }
    }
}
