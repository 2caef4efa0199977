//! The project file: what a user writes to say how pages become a font.

mod cell;
mod check;
mod font;
mod output;
mod parse;
mod sheet;

pub use cell::{CellTable, Cells};
pub use font::FontTable;
pub use output::OutputTable;
pub use parse::ProjectError;
pub(super) use parse::nearest;
pub use sheet::{Content, Labels, Layout, SheetTable};

use super::{Repeated, picture};
use crate::assemble::metrics::Heights;
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

    /// The files that are read, relative to the project file, each with the key that names it.
    pub fn inputs(&self) -> impl Iterator<Item = (&'static str, &PathBuf)> {
        let pages = self.sheets.iter().flat_map(|sheet| {
            let names = match &sheet.glyphs {
                Labels::File { file } => Some(("[[sheet]] glyphs", file)),
                Labels::Text(_) => None,
            };
            let images = sheet.image.iter().map(|path| ("[[sheet]] image", path));
            images.chain(names)
        });
        let cells = self.cells_file.iter().map(|path| ("cells_file", path));
        let features = self.font.features.iter();
        let features = features.map(|path| ("[font] features", path));
        let references = self.matching.reference.iter();
        let references = references.map(|path| ("[match] reference", path));
        pages.chain(cells).chain(features).chain(references)
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
