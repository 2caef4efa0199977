//! Cubic outline → quadratic outline, which is all that TrueType can draw.
//!
//! | takes | gives |
//! |---|---|
//! | [`Outline`] of lines, quadratics and cubics; a tolerance, font units | [`Outline`] of lines and quadratics |
//!
//! A room a method, each a struct of options; [`Method`] is the menu. Both directions of the
//! distance between the two outlines stay below the tolerance. A point that joins two quadratics
//! half way between their control points need not be stored: TrueType implies it.

mod bounded;
pub mod merge;
pub mod rate;
pub mod split;

use crate::types::{Outline, OutlineError};
use serde::{Deserialize, Serialize};
use thiserror::Error;

/// Why an outline has no quadratic form.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum QuadraticError {
    /// The tolerance is not a positive number.
    #[error("the tolerance is {0} units; it must be a positive number")]
    Tolerance(f64),
    /// An option of the method is outside its range.
    #[error("{option} is {value}; it must be {least} to {most}")]
    Option {
        /// name of the option
        option: &'static str,
        /// value given
        value: f64,
        /// what it may be at least
        least: f64,
        /// what it may be at most
        most: f64,
    },
    /// No run of points on the grid comes as close as asked.
    #[error(
        "contour {contour} cannot be met within {tolerance} units by points on the grid of whole font units; allow more, or use more units an em"
    )]
    Grid {
        /// which contour
        contour: usize,
        /// units
        tolerance: f64,
    },
    /// More points than a glyph can count.
    #[error("{0} points; a TrueType glyph holds 65535 at most: allow a larger error")]
    Points(usize),
    /// The curves are no outline: a coordinate left the range of numbers.
    #[error(transparent)]
    Outline(#[from] OutlineError),
}

/// The conversions one can choose, with their options.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Method {
    /// The whole contour at once, fewest bytes.
    Rate(rate::Rate),
    /// Each cubic alone.
    Split(split::Split),
}

impl Default for Method {
    fn default() -> Self {
        Self::Split(split::Split::default())
    }
}

impl Method {
    /// Every method with its default options.
    #[must_use]
    pub fn all() -> Vec<Self> {
        vec![
            Self::Rate(rate::Rate::default()),
            Self::Split(split::Split::default()),
        ]
    }

    /// The word for it on the command line, in project files and snapshots.
    #[must_use]
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Rate(_) => "rate",
            Self::Split(_) => "split",
        }
    }

    /// One line for `khatt methods`.
    #[must_use]
    pub const fn about(&self) -> &'static str {
        match self {
            Self::Rate(_) => "the whole contour at once, fewest bytes",
            Self::Split(_) => "each cubic alone, implied points where they fall out",
        }
    }

    /// Whether the method's options are in their ranges.
    ///
    /// # Errors
    /// One is not.
    pub fn check(&self) -> Result<(), QuadraticError> {
        match self {
            Self::Rate(m) => m.check(),
            Self::Split(split::Split {}) => Ok(()),
        }
    }

    /// The outline in lines and quadratics, nowhere farther than `tolerance` (font units) from the given one.
    ///
    /// # Errors
    /// The tolerance is not positive, or an option is outside its range.
    pub fn convert(&self, outline: &Outline, tolerance: f64) -> Result<Outline, QuadraticError> {
        if !(tolerance > 0.0 && tolerance.is_finite()) {
            return Err(QuadraticError::Tolerance(tolerance));
        }
        self.check()?;
        match self {
            Self::Rate(m) => m.convert(outline, tolerance),
            Self::Split(m) => m.convert(outline, tolerance),
        }
    }
}

#[cfg(test)]
mod tests;
