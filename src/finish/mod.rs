//! Fitted curves in px → Outline in font units: place, direction, extrema, rounding.

pub mod direction;
mod joins;
pub mod place;
pub mod round;
pub mod straight;
