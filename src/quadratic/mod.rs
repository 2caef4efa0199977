//! Cubic Outline → quadratic Outline.
