//! The middle of what a pen drew.

use kurbo::{BezPath, Point};

/// A line that the pen drew.
#[derive(Debug, Clone)]
pub struct PenLine {
    /// Its middle, px, y down.
    pub path: BezPath,
    /// The ink's width at each node of the path in order, px; of a closed one the first is not repeated.
    pub widths: Vec<f64>,
}

/// What the pen drew.
#[derive(Debug, Clone, Default)]
pub struct Centerline {
    /// Lines in reading order of their first pixel.
    pub lines: Vec<PenLine>,
    /// Spots.
    pub dots: Vec<PenDot>,
}

/// A compact spot of ink.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PenDot {
    /// Centre of its ink, px, y down.
    pub centre: Point,
    /// Radius of the disc of the same area, px.
    pub radius: f64,
}
