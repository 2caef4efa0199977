//! Contours cut at a clip path.

use super::farthest;
use kurbo::{BezPath, PathEl, Point, Shape};
use linesweeper::topology::{BinaryWindingNumber, Topology};
use std::collections::BTreeMap;

/// A rectangle's area is that of its box, but for the noise of sums.
const NOISE: f64 = 1e-6;
/// How far a cut outline may lie from the drawn one, font units: far below what a file holds.
const ACCURACY: f64 = 1e-4;
/// The accuracy that coordinates themselves allow, parts of the largest.
const PRECISION: f64 = 64.0 * f64::EPSILON;

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
    let all = frame.union(ink.bounding_box());
    if is_frame && all == frame {
        return Some(contours.to_vec());
    }
    let eps = ACCURACY.max(farthest(all) * PRECISION);
    let cut = Topology::from_paths_binary(&settled(&ink), &settled(&area), eps).ok()?;
    let inside = |w: &BinaryWindingNumber| w.shape_a != 0 && w.shape_b != 0;
    let cut = is_sound(&cut).then(|| cut.contours(inside))?;
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

/// Contours on a grid so fine that nobody sees it, without curves of no length: on ends a hair apart, as strokes have
/// them, the library panics.
fn settled(path: &BezPath) -> BezPath {
    /// Parts of a font unit.
    const GRID: f64 = 1024.0;
    let near = |p: Point| ((p.to_vec2() * GRID).round() / GRID).to_point();
    let mut last = Point::ZERO;
    let mut out = BezPath::new();
    for el in path {
        let (el, is_still) = match el {
            PathEl::MoveTo(p) => (PathEl::MoveTo(near(p)), false),
            PathEl::LineTo(p) => (PathEl::LineTo(near(p)), near(p) == last),
            PathEl::QuadTo(a, p) => {
                let all = [a, p].map(near);
                (PathEl::QuadTo(all[0], all[1]), all == [last; 2])
            }
            PathEl::CurveTo(a, b, p) => {
                let all = [a, b, p].map(near);
                (PathEl::CurveTo(all[0], all[1], all[2]), all == [last; 3])
            }
            PathEl::ClosePath => (PathEl::ClosePath, false),
        };
        last = el.end_point().unwrap_or(last);
        if !is_still {
            out.push(el);
        }
    }
    out
}

/// Whether windings agree around every point: what one curve has on a side the next one has on its other. On tangled
/// curves the library can get this wrong, and would follow a contour forever.
fn is_sound(cut: &Topology<BinaryWindingNumber>) -> bool {
    let mut sides: BTreeMap<_, i32> = BTreeMap::new();
    for curve in cut.segment_indices() {
        for end in [curve.first_half(), curve.second_half()] {
            let at = cut.point(end);
            let mut count = |w: &BinaryWindingNumber, by: i32| {
                let key = (at.x.to_bits(), at.y.to_bits(), w.shape_a, w.shape_b);
                *sides.entry(key).or_default() += by;
            };
            count(cut.winding_clockwise(end), 1);
            count(cut.winding_counter_clockwise(end), -1);
        }
    }
    sides.values().all(|&left| left == 0)
}
