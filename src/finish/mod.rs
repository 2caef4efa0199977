//! Fitted curves in px → Outline in font units: place, direction, extrema, rounding.
