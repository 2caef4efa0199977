//! Fitted curves in px → Outline in font units: place, direction, extrema, rounding.

pub mod direction;
pub mod place;
pub mod round;
