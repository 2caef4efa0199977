//! The project file: what a user writes to say how pages become a font.

mod cell;
mod check;
mod font;
mod parse;
mod sheet;

pub use cell::{CellTable, Cells};
pub use font::FontTable;
pub use parse::ProjectError;
pub use sheet::{Content, Labels, Layout, SheetTable};

use super::{Repeated, picture};
use crate::assemble::metrics::Heights;
use crate::write::{FORMATS, Format};
use crate::{assemble, quadratic, recognise, template};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::PathBuf;

/// A whole project file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Project {
    /// What the font says about itself.
    pub font: FontTable,
    /// The pages, in order.
    #[serde(rename = "sheet", deserialize_with = "check::some_sheets")]
    pub sheets: Vec<SheetTable>,
    /// Corrections of single letters, by the glyph's name as in `glyphs`.
    #[serde(default, skip_serializing_if = "Cells::is_empty")]
    pub cells: Cells,
    /// A file of such tables, relative to the project file; what stands here goes before.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cells_file: Option<PathBuf>,
    /// What becomes of glyphs that are drawn more than once.
    #[serde(default)]
    pub repeated: Repeated,
    /// How pages to draw on are laid out.
    #[serde(default)]
    pub template: template::Layout,
    /// How a cell's picture becomes curves.
    #[serde(default)]
    pub trace: picture::Options,
    /// Room between letters, overlap of joined ones, vertical measures.
    #[serde(default)]
    pub spacing: assemble::Options,
    /// Letters that are composed of others.
    #[serde(default)]
    pub compose: assemble::compose::Options,
    /// Anchors by glyph name and their own name, font units: they win over those that follow from shapes.
    #[serde(default)]
    pub anchors: assemble::Anchors,
    /// Kerning by two glyph names with a space between, font units: it wins over what is measured.
    #[serde(default)]
    pub kerning: BTreeMap<String, f64>,
    /// How cubics become TrueType's quadratics.
    #[serde(default)]
    pub quadratic: QuadraticTable,
    /// What a glyph must hold to for the build to succeed.
    #[serde(default)]
    pub gate: GateTable,
    /// How cells are compared with a reference's letters.
    #[serde(default, rename = "match")]
    pub matching: MatchTable,
    /// What to make.
    #[serde(default)]
    pub output: OutputTable,
}

impl Project {
    /// Vertical measures by hand: those of the whole font, else those by which a page says how large its letters are.
    pub(crate) fn heights(&self) -> Heights {
        let em = f64::from(self.font.units_per_em);
        let given = &self.spacing.heights;
        let said = |of: fn(&SheetTable) -> Option<f64>| {
            self.sheets.iter().find_map(of).map(|units| units / em)
        };
        Heights {
            x_height: given.x_height.or_else(|| said(|sheet| sheet.x_height)),
            cap_height: given.cap_height.or_else(|| said(|sheet| sheet.cap_height)),
            ..given.clone()
        }
    }

    /// The files that are read, relative to the project file.
    pub fn inputs(&self) -> impl Iterator<Item = &PathBuf> {
        let pages = self.sheets.iter().flat_map(|sheet| {
            let names = match &sheet.glyphs {
                Labels::File { file } => Some(file),
                Labels::Text(_) => None,
            };
            sheet.image.iter().chain(names)
        });
        let single = self.cells_file.iter().chain(&self.font.features);
        pages.chain(single).chain(&self.matching.reference)
    }
}

/// How cells are compared with a reference's letters.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MatchTable {
    /// TTF or OTF fonts, relative to the project file, one or a list of which the nearest letter counts;
    /// without one labels are believed.
    #[serde(deserialize_with = "check::paths")]
    pub reference: Vec<PathBuf>,
    /// What is compared.
    pub method: recognise::Method,
}

/// How cubics become TrueType's quadratics.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct QuadraticTable {
    /// The method and its options.
    #[serde(deserialize_with = "check::conversion")]
    pub convert: quadratic::Method,
    /// How far the quadratics may lie from the cubics, parts of the em.
    pub tolerance_em: f64,
}

impl Default for QuadraticTable {
    fn default() -> Self {
        Self {
            convert: quadratic::Method::default(),
            // a quarter of a unit at 1000 units an em: less than rounding to the grid moves a point
            tolerance_em: 0.000_25,
        }
    }
}

/// Limits that fail the build, font units.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GateTable {
    /// Largest distance from the scanned edge to the outline that is compiled.
    #[serde(deserialize_with = "check::optional_size")]
    pub max_error: Option<f64>,
    /// Root mean square of that distance.
    #[serde(deserialize_with = "check::optional_size")]
    pub rms_error: Option<f64>,
}

/// The outputs to make, relative to the project file; those left out are not made.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OutputTable {
    /// Font with TrueType outlines.
    pub ttf: Option<PathBuf>,
    /// Font with cubic (CFF) outlines.
    pub otf: Option<PathBuf>,
    /// The TrueType font compressed for the web.
    pub woff2: Option<PathBuf>,
    /// Source for font editors: a folder.
    pub ufo: Option<PathBuf>,
    /// One SVG a glyph: a folder.
    pub svg: Option<PathBuf>,
    /// Web page that shows every cell with its outline.
    pub proof: Option<PathBuf>,
    /// What was done and how well, JSON.
    pub report: Option<PathBuf>,
}

impl OutputTable {
    /// The fonts to make: each format that is named, and where it goes.
    #[must_use]
    pub fn fonts(&self) -> Vec<(&'static Format, &PathBuf)> {
        let path = |name: &str| match name {
            "ttf" => self.ttf.as_ref(),
            "otf" => self.otf.as_ref(),
            "woff2" => self.woff2.as_ref(),
            "ufo" => self.ufo.as_ref(),
            "svg" => self.svg.as_ref(),
            _ => None,
        };
        let named = FORMATS.iter().filter_map(|f| Some((f, path(f.name)?)));
        named.collect()
    }

    /// Where all that is made goes.
    pub fn paths(&self) -> impl Iterator<Item = &PathBuf> {
        let fonts = self.fonts().into_iter().map(|(_, path)| path);
        fonts.chain(&self.proof).chain(&self.report)
    }
}
