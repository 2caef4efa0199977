//! A font as it was read → the files of another format.

use super::problem::Problem;
use crate::quadratic::{self, merge};
use crate::types::{Files, Font, Glyph, Outline};
use crate::write::{Curves, Format};
use kurbo::PathEl;

/// How outlines change their kind.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Largest error, thousandths of the em.
    pub tolerance: f64,
    /// Cubic → quadratic.
    pub quadratic: quadratic::Method,
    /// Whether outlines of the right kind are converted all the same.
    pub outlines: Outlines,
}

/// Which outlines are converted.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Outlines {
    /// Those that the format cannot store.
    #[default]
    Needed,
    /// All of them: quadratics are optimised again.
    All,
}

impl Default for Options {
    fn default() -> Self {
        /// Half a unit of 1000: a quarter of a pixel at 500 px an em.
        const TOLERANCE: f64 = 0.5;
        Self {
            tolerance: TOLERANCE,
            quadratic: quadratic::Method::default(),
            outlines: Outlines::default(),
        }
    }
}

/// The font in the format's curves, written.
///
/// # Errors
/// Every outline that cannot be converted within the tolerance, or the format cannot hold the font.
pub fn convert(font: &Font, format: &Format, options: &Options) -> Result<Files, Vec<Problem>> {
    let units = options.tolerance * f64::from(font.info.units_per_em) / 1000.0;
    let changed = font.try_map_outlines(|g| outline(g, format.curves, units, options))?;
    (format.write)(&changed).map_err(|e| vec![e.into()])
}

fn outline(
    glyph: &Glyph,
    curves: Curves,
    units: f64,
    options: &Options,
) -> Result<Outline, Problem> {
    let has = |kind: fn(&PathEl) -> bool| {
        glyph
            .outline
            .contours()
            .iter()
            .any(|c| c.elements().iter().any(kind))
    };
    let (cubic, quad) = (
        has(|e| matches!(e, PathEl::CurveTo(..))),
        has(|e| matches!(e, PathEl::QuadTo(..))),
    );
    let all = options.outlines == Outlines::All;
    match curves {
        // What has only lines may still begin where that costs fewest bytes.
        Curves::Quadratic if cubic || all || !quad => options
            .quadratic
            .convert(&glyph.outline, units)
            .map_err(|why| Problem::quadratic(glyph, why)),
        Curves::Cubic if quad => Ok(merge::merge(&glyph.outline, units)),
        _ => Ok(glyph.outline.clone()),
    }
}
