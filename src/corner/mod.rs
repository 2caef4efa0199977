//! Contour → corners: where a contour's direction jumps.
//!
//! | takes | gives |
//! |---|---|
//! | [`Contour`], px, y up | strictly increasing indices of its corner points |
//!
//! A room a method, each a struct of options that implements [`Detector`]; [`Method`] is the menu.

pub mod angle;
pub mod sides;

use crate::types::Contour;
use serde::{Deserialize, Serialize};

/// Finds the corners of a contour.
pub trait Detector {
    /// Strictly increasing indices into [`Contour::points`]; none for a smooth ring.
    fn corners(&self, contour: &Contour) -> Vec<usize>;
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
        ]
    }

    /// The word for it on the command line, in project files, snapshots and the bibliography.
    #[must_use]
    pub const fn key(&self) -> &'static str {
        match self {
            Self::Sides(_) => "sides",
            Self::Angle(_) => "angle",
        }
    }

    /// One line for `khatt methods`.
    #[must_use]
    pub const fn about(&self) -> &'static str {
        match self {
            Self::Sides(_) => "crossings of the two fitted sides (default)",
            Self::Angle(_) => "jumps of direction between two chords [samavati98 sec. 3]",
        }
    }

    /// The method itself.
    #[must_use]
    pub fn detector(&self) -> &dyn Detector {
        match self {
            Self::Sides(d) => d,
            Self::Angle(d) => d,
        }
    }
}
