//! What was done and how well: a row a glyph.

use super::budget::{Budget, Measured};
use super::build::Built;
use super::letter::Letter;
use super::page::Page;
use super::problem::{Place, Problem};
use super::project::GateTable;
use crate::assemble::words::Gap;
use crate::assemble::{Note, names};
use crate::numeric::distance::largest;
use crate::template::Gain;
use crate::types::Font;
use kurbo::{Point, Rect};
use schemars::JsonSchema;
use serde::Serialize;

/// What was done and how well.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Report {
    /// Name and version of the program.
    pub program: String,
    /// Family and style name.
    pub font: String,
    /// Units an em.
    pub units_per_em: u16,
    /// A row a page.
    pub pages: Vec<PageRow>,
    /// A row a drawn glyph, in reading order.
    pub glyphs: Vec<Row>,
    /// A row a composed glyph, in glyph order.
    pub composed: Vec<Composed>,
    /// The gaps of written words beside those of the font, in the order in which they were written.
    pub gaps: Vec<Gap>,
    /// What could not be met.
    pub notes: Vec<Remark>,
}

/// A glyph that nobody drew.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Composed {
    /// Its name in the font.
    pub name: String,
    /// The glyphs that it consists of.
    pub parts: Vec<String>,
}

/// A page.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct PageRow {
    /// The picture.
    pub sheet: String,
    /// Degrees by which the page lay turned clockwise.
    pub skew_deg: f64,
    /// Standard deviation of the blur of printer, paper and scanner, mm, where a template's margin tells it.
    pub blur_mm: Option<f64>,
    /// How far black reaches beyond its true edge, mm, where a template's margin tells it.
    pub spread_mm: Option<f64>,
    /// Coverage at which edges were taken to lie.
    pub contour_level: f64,
    /// Ink in no glyph.
    pub rejected: Vec<Removed>,
    /// Pieces of ink smaller than any dot, which are in no list.
    pub specks: usize,
    /// What to look at.
    pub warnings: Vec<CellRemark>,
}

/// A piece of ink in no glyph.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Removed {
    /// Left, top, right and bottom in the page's picture, px.
    pub box_px: [f64; 4],
    /// px²
    pub area_px: usize,
    /// Why.
    pub reason: String,
}

/// A remark about a cell.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct CellRemark {
    /// The cell in the page's reading order, from 1, where it is about one.
    pub cell: Option<usize>,
    /// What it is said to hold.
    pub label: Option<String>,
    /// What is odd and what to do.
    pub message: String,
}

/// A glyph.
#[derive(Debug, Clone, PartialEq, Serialize, JsonSchema)]
pub struct Row {
    /// Its name in the font.
    pub name: String,
    /// The text that it draws.
    pub text: String,
    /// The page.
    pub sheet: String,
    /// The cell in the page's reading order, from 1.
    pub cell: usize,
    /// Left, top, right and bottom of its ink in the page's picture, px.
    pub box_px: [f64; 4],
    /// Pixels an em.
    pub pixels_per_em: f64,
    /// Advance width, font units.
    pub advance: f64,
    /// Contours.
    pub contours: usize,
    /// On-curve points of the cubic outline.
    pub nodes: usize,
    /// Largest distance from the scanned edge to the outline as it is compiled, rounding included, font units.
    pub max_error: f64,
    /// Root mean square of that distance, font units.
    pub rms_error: f64,
    /// What each step adds.
    pub budget: Budget,
    /// Millimetres of paper that a font unit measured where the letter was drawn, where the page or its file tells.
    pub mm_per_unit: Option<f64>,
}

/// A remark about a glyph.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, JsonSchema)]
pub struct Remark {
    /// The glyph.
    pub glyph: String,
    /// What could not be done, and what to do about it.
    pub message: String,
}

impl Report {
    /// What was done, with every letter's glyph as it was measured.
    #[must_use]
    pub(super) fn new(built: &Built, measured: &[Option<Measured>]) -> Self {
        let info = &built.font.info;
        let pairs = built.letters.iter().zip(measured);
        let rows = pairs.filter_map(|(l, m)| row(built, l, m.as_ref()?));
        let remark = |n: &Note| Remark {
            glyph: n.glyph.clone(),
            message: n.message.clone(),
        };
        Self {
            program: format!("khatt {}", env!("CARGO_PKG_VERSION")),
            font: format!("{} {}", info.family, info.style),
            units_per_em: info.units_per_em,
            pages: built.pages.iter().map(page_row).collect(),
            glyphs: rows.collect(),
            composed: composed(&built.font),
            gaps: built.gaps.clone(),
            notes: built.notes.iter().map(remark).collect(),
        }
    }

    /// The glyphs that a project's gates do not let through.
    pub(super) fn gated(&self, gate: &GateTable) -> Vec<Problem> {
        let limits = [("max_error", gate.max_error), ("rms_error", gate.rms_error)];
        let mut out = Vec::new();
        for row in &self.glyphs {
            for ((what, limit), value) in limits.iter().zip([row.max_error, row.rms_error]) {
                if let Some(limit) = limit.filter(|l| value > *l) {
                    out.push(Problem::Gate {
                        place: Place {
                            sheet: row.sheet.clone(),
                            index: row.cell - 1,
                            label: Some(row.name.clone()),
                        },
                        what,
                        value,
                        limit,
                    });
                }
            }
        }
        out
    }
}

/// Left, top, right and bottom.
pub(super) const fn corners(r: Rect) -> [f64; 4] {
    [r.x0, r.y0, r.x1, r.y1]
}

fn composed(font: &Font) -> Vec<Composed> {
    let made = font.glyphs().iter().filter(|g| !g.components.is_empty());
    made.map(|glyph| Composed {
        name: glyph.name.to_string(),
        parts: glyph
            .components
            .iter()
            .map(|c| c.base.to_string())
            .collect(),
    })
    .collect()
}

fn page_row(page: &Page) -> PageRow {
    let gain = page.gain.as_ref();
    let removed = page.cut.rejected.iter().map(|r| Removed {
        box_px: corners(r.in_sheet),
        area_px: r.area_px,
        reason: r.reason.to_string(),
    });
    let warnings = page.cut.warnings.iter().map(|w| CellRemark {
        cell: w.index.map(|i| i + 1),
        label: w.label.as_ref().map(|l| l.0.clone()),
        message: w.message.clone(),
    });
    PageRow {
        sheet: page.name.clone(),
        skew_deg: page.cut.skew_deg,
        blur_mm: gain.map(|g| g.blur_mm),
        spread_mm: gain.map(|g| g.spread_mm),
        contour_level: gain.map_or(0.5, Gain::level),
        rejected: removed.collect(),
        specks: page.cut.specks,
        warnings: warnings.collect(),
    }
}

fn row(built: &Built, letter: &Letter, measured: &Measured) -> Option<Row> {
    let identity = names::identify(&letter.label).ok()?;
    let glyph = built.font.glyph(identity.name.as_str())?;
    let (max_error, rms_error) = errors(&measured.edge);
    let contours = glyph.outline.contours();
    let nodes = contours.iter().map(|c| c.segments().count());
    Some(Row {
        name: identity.name.to_string(),
        text: identity.chars.iter().collect(),
        sheet: letter.sheet.clone(),
        cell: letter.index + 1,
        box_px: corners(letter.in_sheet),
        pixels_per_em: letter.guides.px_per_em,
        advance: glyph.advance,
        contours: contours.len(),
        nodes: nodes.sum(),
        max_error,
        rms_error,
        budget: measured.budget,
        mm_per_unit: mm_per_unit(built, letter),
    })
}

/// Millimetres of paper that a font unit measured where a letter was drawn, where that is known.
pub(super) fn mm_per_unit(built: &Built, letter: &Letter) -> Option<f64> {
    let page = built.page_of(letter)?;
    let px_per_unit = letter.guides.px_per_em / f64::from(built.font.info.units_per_em);
    Some(px_per_unit / page.px_per_mm?)
}

/// Largest and root mean square of the distances.
fn errors(edge: &[Vec<(Point, f64)>]) -> (f64, f64) {
    let all = edge.iter().flatten().map(|(_, d)| *d);
    let all: Vec<f64> = all.filter(|d| d.is_finite()).collect();
    let squares: f64 = all.iter().map(|d| d * d).sum();
    let mean = squares / all.len().max(1) as f64;
    (largest(edge), mean.sqrt())
}
