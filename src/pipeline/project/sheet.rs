//! `[[sheet]]`: a page and what is drawn on it.

use super::check;
use crate::scan::{
    self, InkGrain, InkStreaks, Inks, Options, Order, Polarity, Scale, Texture, Tones, Turn,
};
use crate::types::Direction;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// A picture and what is drawn on it, or the pictures of all pages of a template.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SheetTable {
    /// The picture, relative to the project file; for a template as many as there are, in any order, and none
    /// before it is scanned.
    #[serde(default, deserialize_with = "check::paths")]
    pub image: Vec<PathBuf>,
    /// Which page of a file that holds several, from 1; a template takes all.
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
    /// Degrees by which the picture must be turned clockwise to stand upright: 0, 90, 180 or 270; left out, 0 unless
    /// the letters stand far better for their names another way up.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub turn: Option<Turn>,
    /// Which of dark and light is the ink.
    #[serde(default)]
    pub polarity: Polarity,
    /// How the picture's numbers tell light.
    #[serde(default)]
    pub tones: Tones,
    /// What becomes of ink that is grain, as of a pencil or a dry brush.
    #[serde(default)]
    pub grain: InkGrain,
    /// What becomes of pale streaks in ink, as of a ballpoint.
    #[serde(default)]
    pub streaks: InkStreaks,
    /// Which ink the letters are drawn with, where the page has other colours too; a list of inks makes each of them
    /// a layer of a colour font, the lowest first.
    #[serde(default)]
    pub ink: Inks,
    /// What the cells hold, in reading order.
    pub glyphs: Labels,
    /// Whether these are letters or written words.
    #[serde(default)]
    pub content: Content,
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

/// How the cells lie on a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Layout {
    /// Equal cells in rows and columns, with or without printed lines between them.
    Grid(usize, usize),
    /// Letters in rows on a bare page.
    Free,
    /// Printed boxes, each around one letter.
    Boxes,
    /// Pages that `khatt sheet` printed: they say themselves what stands where.
    Template,
}

/// What the cells of a page hold.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Content {
    /// Glyphs of the font.
    #[default]
    Letters,
    /// Words, which show how much room there is between letters.
    Words,
}

impl Layout {
    /// What the page is cut by; `None` for a template.
    const fn of_scan(self) -> Option<scan::Layout> {
        Some(match self {
            Self::Grid(rows, columns) => scan::Layout::Grid(rows, columns),
            Self::Free => scan::Layout::Free,
            Self::Boxes => scan::Layout::Boxes,
            Self::Template => return None,
        })
    }
}

/// Labels in reading order.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(
    untagged,
    expecting = "must be one text of names with spaces between, \"A B C\", or a file of them, { file = \"names.txt\" }"
)]
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
    pub(crate) fn is_auto(&self) -> bool {
        matches!(self, Self::Text(text) if text.trim() == "auto")
    }
}

impl SheetTable {
    /// What messages call the page.
    #[must_use]
    pub fn name(&self) -> String {
        let images: Vec<String> = self.image.iter().map(|i| i.display().to_string()).collect();
        match (self.layout, images.as_slice(), self.page) {
            (Layout::Template, [], _) => "template".to_owned(),
            (_, [image], Some(page)) => format!("{image}, page {page}"),
            _ => images.join(", "),
        }
    }

    /// What becomes of ink that is not one even tone.
    pub(crate) const fn texture(&self) -> Texture {
        Texture {
            grain: self.grain,
            streaks: self.streaks,
        }
    }

    /// How the page is cut, for a font of so many units an em, the lines of `glyphs` left open.
    ///
    /// # Errors
    /// More than one key says how large the letters are, or the page is a template's, which says so itself.
    pub(crate) fn cut_options(&self, units_per_em: u16) -> Result<Options, String> {
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
        let given = all.into_iter();
        let given: Vec<(&str, Scale)> = given.filter_map(|(k, s)| Some((k, s?))).collect();
        if let [(first, _), (second, _), ..] = given.as_slice() {
            return Err(format!(
                "{first} and {second} both say how large the letters are; give one"
            ));
        }
        let Some(layout) = self.layout.of_scan() else {
            return Err("a template's pages say themselves how they are cut".to_owned());
        };
        Ok(Options {
            layout,
            direction: self.direction,
            order: self.order,
            ink: self.ink.clone(),
            scale: given.first().map(|(_, scale)| *scale),
            lines: Vec::new(),
        })
    }
}
