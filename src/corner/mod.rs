//! Contour → corners: where a contour's direction jumps.
//!
//! | takes | gives |
//! |---|---|
//! | [`Contour`], px, y up | strictly increasing indices of its corner points |
//!
//! A room a method, each a struct of options that implements [`Detector`]; [`Method`] is the menu.

pub mod angle;
mod beside;
mod calm;
pub mod sides;
pub mod srm05;
#[cfg(test)]
mod tests;

pub use beside::sharpen;

use crate::types::Contour;
use serde::{Deserialize, Serialize};

/// Finds the corners of a contour.
pub trait Detector {
    /// Strictly increasing indices into [`Contour::points`]; none for a smooth ring.
    fn corners(&self, contour: &Contour) -> Vec<usize>;

    /// Corners and places that may be some, for whom the picture may decide: strictly increasing indices. Nothing
    /// of a method whose answer is final.
    fn possible(&self, _contour: &Contour) -> Option<Vec<usize>> {
        None
    }
}

/// The detectors one can choose, with their options.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(tag = "method", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Method {
    /// Crossings of the two fitted sides.
    Sides(sides::Sides),
    /// Jumps of direction between two chords.
    Angle(angle::Angle),
    /// Changes of slope along a chain of pixels.
    Srm05(srm05::Srm05),
}

impl Default for Method {
    fn default() -> Self {
        Self::Sides(sides::Sides::default())
    }
}

impl Method {
    /// Every method with its default options.
    #[must_use]
    pub fn all() -> Vec<Self> {
        vec![
            Self::Sides(sides::Sides::default()),
            Self::Angle(angle::Angle::default()),
            Self::Srm05(srm05::Srm05::default()),
        ]
    }

    /// The word for it on the command line, in project files, snapshots and the bibliography.
    #[must_use]
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Sides(_) => "sides",
            Self::Angle(_) => "angle",
            Self::Srm05(_) => "srm05",
        }
    }

    /// One line for `khatt methods`.
    #[must_use]
    pub const fn about(&self) -> &'static str {
        match self {
            Self::Sides(_) => "crossings of the two fitted sides (default)",
            Self::Angle(_) => "jumps of direction between two chords [samavati98 sec. 3]",
            Self::Srm05(_) => "changes of slope along a chain of pixels [rasheed05 sec. 2.1]",
        }
    }

    /// The method itself.
    #[must_use]
    pub fn detector(&self) -> &dyn Detector {
        match self {
            Self::Sides(d) => d,
            Self::Angle(d) => d,
            Self::Srm05(d) => d,
        }
    }
}
