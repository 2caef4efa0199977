//! Contours cut at a clip path.

use kurbo::{BezPath, Shape};
use linesweeper::{BinaryOp, FillRule, binary_op};

/// A rectangle's area is that of its box, but for the noise of sums.
const NOISE: f64 = 1e-6;

/// What of some contours lies within others, both filled by winding, outer ones counter-clockwise; nothing where
/// they cannot be cut.
pub(super) fn within(contours: &[BezPath], clip: &[BezPath]) -> Option<Vec<BezPath>> {
    let one = |paths: &[BezPath]| paths.iter().flatten().collect::<BezPath>();
    let (ink, area) = (one(contours), one(clip));
    if ink.is_empty() || area.is_empty() {
        return Some(Vec::new());
    }
    // a frame around all of it, as drawing programs write it: the contours stay as they are
    let frame = area.bounding_box();
    let is_frame = clip.len() == 1 && area.area().abs() > frame.area() * (1.0 - NOISE);
    if is_frame && frame.union(ink.bounding_box()) == frame {
        return Some(contours.to_vec());
    }
    let cut = binary_op(&ink, &area, FillRule::NonZero, BinaryOp::Intersection).ok()?;
    let turned = cut.contours().map(|c| {
        let outwards = c.path.area() > 0.0;
        if outwards == c.outer {
            c.path.clone()
        } else {
            c.path.reverse_subpaths()
        }
    });
    Some(turned.collect())
}
