//! Glyph shapes in font units, and the way there.

use kurbo::{Affine, BezPath, PathEl, Rect, Shape};
use thiserror::Error;

/// Why paths are no outline.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum OutlineError {
    /// Contour `0` does not end with a close.
    #[error("contour {0} is open")]
    Open(usize),
    /// Contour `0` has a coordinate that is NaN or infinite.
    #[error("contour {0} is not finite")]
    NotFinite(usize),
}

/// Closed contours, font units, y up, origin on the baseline; outer ones counter-clockwise,
/// holes clockwise. Coordinates are not rounded before `finish::round`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Outline {
    contours: Vec<BezPath>,
}

impl Outline {
    /// Nothing to draw.
    pub const EMPTY: Self = Self {
        contours: Vec::new(),
    };

    /// An outline of closed contours, each one path: a move, segments, a close.
    ///
    /// # Errors
    /// A contour is open or not finite.
    pub fn new(contours: Vec<BezPath>) -> Result<Self, OutlineError> {
        for (i, path) in contours.iter().enumerate() {
            let els = path.elements();
            let shaped = els.len() >= 2
                && matches!(els[0], PathEl::MoveTo(_))
                && matches!(els[els.len() - 1], PathEl::ClosePath)
                && !els[1..els.len() - 1]
                    .iter()
                    .any(|e| matches!(e, PathEl::MoveTo(_) | PathEl::ClosePath));
            if !shaped {
                return Err(OutlineError::Open(i));
            }
            if !path.is_finite() {
                return Err(OutlineError::NotFinite(i));
            }
        }
        Ok(Self { contours })
    }

    /// The contours in order.
    #[must_use]
    pub fn contours(&self) -> &[BezPath] {
        &self.contours
    }

    /// The same outline after `change` has put its contours in another order or direction.
    /// What it gives back must be closed and finite like what it was given.
    #[must_use]
    pub(crate) fn map_contours(self, change: impl FnOnce(Vec<BezPath>) -> Vec<BezPath>) -> Self {
        Self {
            contours: change(self.contours),
        }
    }

    /// The outline moved, scaled or turned. Contour directions follow the map.
    #[must_use]
    pub fn transformed(&self, map: Affine) -> Self {
        let contours = self.contours.iter().map(|c| map * c).collect();
        Self { contours }
    }

    /// All contours as one path.
    #[must_use]
    pub fn to_path(&self) -> BezPath {
        self.contours
            .iter()
            .flat_map(|c| c.elements().iter().copied())
            .collect()
    }

    /// The smallest upright rectangle around the ink, font units; `None` when there is none.
    #[must_use]
    pub fn bounds(&self) -> Option<Rect> {
        let boxes = self.contours.iter().map(Shape::bounding_box);
        boxes.reduce(|a, b| a.union(b))
    }

    /// Whether there is nothing to draw.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.contours.is_empty()
    }
}

/// From the picture of a cell to the em: shape and placement are two things.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    /// Font units a pixel; finite and positive.
    pub units_per_px: f64,
    /// The baseline's y in the contour's space, px above the picture's bottom edge.
    pub baseline_px: f64,
    /// The glyph origin's x in the contour's space, px.
    pub origin_px: f64,
}

impl Frame {
    /// The map from contour px (y up) to font units.
    #[must_use]
    pub fn to_units(self) -> Affine {
        Affine::scale(self.units_per_px) * Affine::translate((-self.origin_px, -self.baseline_px))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::Point;

    #[test]
    fn only_closed_contours() {
        let ok = BezPath::from_svg("M0 0L1 0L1 1Z").unwrap();
        assert!(Outline::new(vec![ok.clone()]).is_ok());
        for bad in ["M0 0L1 0L1 1", "M0 0L1 0ZM2 2L3 3Z", "M0 0"] {
            let path = BezPath::from_svg(bad).unwrap();
            assert_eq!(
                Outline::new(vec![ok.clone(), path]),
                Err(OutlineError::Open(1)),
                "{bad}"
            );
        }
        assert_eq!(Outline::default().bounds(), None);
    }

    #[test]
    fn a_frame_puts_the_baseline_at_zero() {
        let f = Frame {
            units_per_px: 2.0,
            baseline_px: 30.0,
            origin_px: 5.0,
        };
        assert_eq!(f.to_units() * Point::new(5.0, 30.0), Point::ORIGIN);
        assert_eq!(f.to_units() * Point::new(6.0, 31.0), Point::new(2.0, 2.0));
    }
}
