//! One picture's curves as SVG, in its own px.

use crate::numeric::svg::path_data;
use kurbo::{Affine, BezPath};

/// Decimals of a coordinate, px.
const DECIMALS: usize = 4;

/// One path of all contours, which are px with y up; user space is the picture's px, y down.
#[must_use]
pub fn svg((w, h): (usize, usize), paths: &[BezPath]) -> String {
    let down = to_picture(h);
    let data = |path: &BezPath| path_data(&(down * path), pixels);
    let d: String = paths.iter().map(data).collect();
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
         <path d=\"{d}\"/>\n</svg>\n"
    )
}

/// A coordinate, px.
pub(super) fn pixels(v: f64) -> String {
    format!("{v:.DECIMALS$}")
}

/// The map from the curves' space (y up) to that of a picture so many px high (y down).
#[must_use]
pub fn to_picture(height: usize) -> Affine {
    Affine::new([1.0, 0.0, 0.0, -1.0, 0.0, height as f64])
}
