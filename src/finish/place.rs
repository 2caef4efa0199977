//! Contour px → font units: the only place where the two meet.

use super::direction;
use crate::types::{Frame, Outline, OutlineError};
use kurbo::BezPath;

/// Closed paths of one glyph, px with y up, as an [`Outline`] in font units: moved to the baseline,
/// scaled, and with directions put right by nesting. Paths without any extent are dropped.
///
/// # Errors
/// A path is open or not finite; so is everything when the frame's scale is not.
pub fn outline(paths: &[BezPath], frame: Frame) -> Result<Outline, OutlineError> {
    let to_units = frame.to_units();
    let placed = paths
        .iter()
        .filter(|p| p.segments().next().is_some())
        .map(|p| to_units * p)
        .collect();
    Ok(Outline::new(placed)?.map_contours(direction::set))
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Shape;

    const FRAME: Frame = Frame {
        units_per_px: 2.0,
        baseline_px: 10.0,
        origin_px: 5.0,
    };

    #[test]
    fn placed_and_directed() {
        let ring = BezPath::from_svg("M5 10L5 30L25 30L25 10Z").unwrap();
        let hole = BezPath::from_svg("M10 15L10 20L15 20L15 15Z").unwrap();
        let out = outline(&[ring, hole], FRAME).unwrap();
        let areas: Vec<f64> = out.contours().iter().map(Shape::area).collect();
        assert_eq!(areas, [1600.0, -100.0]);
        assert_eq!(out.bounds().unwrap().origin(), kurbo::Point::ORIGIN);
    }

    #[test]
    fn open_paths_are_refused() {
        let open = BezPath::from_svg("M5 10L5 30L25 30").unwrap();
        assert_eq!(outline(&[open], FRAME), Err(OutlineError::Open(0)));
    }
}
