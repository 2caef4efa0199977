//! `[[sheet]]`: a page and what is drawn on it.

use super::check;
use crate::scan::{Direction, Layout, Options, Order, Polarity, Scale};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// One picture and what is drawn on it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SheetTable {
    /// The picture, relative to the project file.
    pub image: PathBuf,
    /// Which page of a file that holds several, from 1.
    #[serde(default)]
    pub page: Option<usize>,
    /// How the cells lie on the page.
    pub layout: Layout,
    /// The order in which cells are read.
    #[serde(default)]
    pub direction: Direction,
    /// Whether rows or columns come first.
    #[serde(default)]
    pub order: Order,
    /// Which of dark and light is the ink.
    #[serde(default)]
    pub polarity: Polarity,
    /// What the cells hold, in reading order.
    pub glyphs: Labels,
    /// Pixels an em.
    #[serde(default, deserialize_with = "check::optional_size")]
    pub pixels_per_em: Option<f64>,
    /// Millimetres an em on paper; the picture must say its resolution.
    #[serde(default, deserialize_with = "check::optional_size")]
    pub em_mm: Option<f64>,
    /// Font units that the height of x measures.
    #[serde(default, deserialize_with = "check::optional_size")]
    pub x_height: Option<f64>,
    /// Font units that the height of H measures.
    #[serde(default, deserialize_with = "check::optional_size")]
    pub cap_height: Option<f64>,
    /// Font units from the highest ink to the lowest.
    #[serde(default, deserialize_with = "check::optional_size")]
    pub ascender_to_descender: Option<f64>,
}

/// Labels in reading order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Labels {
    /// Characters and glyph names between spaces; `_` skips a cell. `auto` alone: what the cells look like.
    Text(String),
    /// A text file of them, relative to the project file.
    File {
        /// The file.
        file: PathBuf,
    },
}

impl Labels {
    /// Whether the letters are to be read from the cells: `"auto"`.
    #[must_use]
    pub fn is_auto(&self) -> bool {
        matches!(self, Self::Text(text) if text.trim() == "auto")
    }
}

impl SheetTable {
    /// What messages call the page.
    #[must_use]
    pub fn name(&self) -> String {
        let image = self.image.display();
        match self.page {
            Some(page) => format!("{image}, page {page}"),
            None => image.to_string(),
        }
    }

    /// How the page is cut, for a font of so many units an em.
    ///
    /// # Errors
    /// More than one key says how large the letters are.
    pub fn cut_options(&self, units_per_em: u16) -> Result<Options, String> {
        let em = f64::from(units_per_em);
        let all = [
            ("pixels_per_em", self.pixels_per_em.map(Scale::PixelsPerEm)),
            ("em_mm", self.em_mm.map(Scale::EmMm)),
            ("x_height", self.x_height.map(|v| Scale::XHeight(v / em))),
            (
                "cap_height",
                self.cap_height.map(|v| Scale::CapHeight(v / em)),
            ),
            (
                "ascender_to_descender",
                self.ascender_to_descender
                    .map(|v| Scale::AscenderToDescender(v / em)),
            ),
        ];
        let given: Vec<(&str, Scale)> = all
            .into_iter()
            .filter_map(|(key, scale)| Some((key, scale?)))
            .collect();
        if let [(first, _), (second, _), ..] = given.as_slice() {
            return Err(format!(
                "{first} and {second} both say how large the letters are; give one"
            ));
        }
        Ok(Options {
            layout: self.layout,
            direction: self.direction,
            order: self.order,
            scale: given.first().map(|(_, scale)| *scale),
        })
    }
}
