//! Contour direction from nesting: outer contours counter-clockwise, holes clockwise.
//!
//! A contour's depth is the number of larger contours around it; even depths are ink, odd ones
//! holes, so a drop of ink in a counter is ink again. Approximate only where contours cross: a
//! contour then counts as inside when its own sample point is.

use kurbo::{BezPath, ParamCurve, Point, Rect, Shape};

/// A contour with what nesting asks of it.
struct Ring {
    area: f64,
    bounds: Rect,
    sample: Option<Point>,
}

impl Ring {
    fn of(path: &BezPath) -> Self {
        Self {
            area: path.area(),
            bounds: path.bounding_box(),
            sample: path.segments().next().map(|s| s.eval(0.5)),
        }
    }
}

/// The contours in the same order, each running the way its depth asks.
///
/// Needs closed contours; an empty or flat one stays as it is.
#[must_use]
pub fn set(contours: Vec<BezPath>) -> Vec<BezPath> {
    let rings: Vec<Ring> = contours.iter().map(Ring::of).collect();
    let depths: Vec<usize> = rings.iter().map(|r| depth(r, &rings, &contours)).collect();
    contours
        .into_iter()
        .zip(rings.iter().zip(depths))
        .map(|(path, (ring, depth))| {
            let is_hole = depth % 2 == 1;
            let runs_clockwise = ring.area < 0.0;
            if is_hole == runs_clockwise {
                path
            } else {
                path.reverse_subpaths()
            }
        })
        .collect()
}

/// The number of larger contours around this one.
fn depth(ring: &Ring, rings: &[Ring], contours: &[BezPath]) -> usize {
    let Some(sample) = ring.sample else { return 0 };
    rings
        .iter()
        .zip(contours)
        .filter(|(other, path)| {
            other.area.abs() > ring.area.abs()
                && other.bounds.contains(sample)
                && path.winding(sample) != 0
        })
        .count()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square(side: f64, sign: f64) -> BezPath {
        let r = Rect::new(-side, -side, side, side).to_path(0.1);
        if r.area() * sign > 0.0 {
            r
        } else {
            r.reverse_subpaths()
        }
    }

    #[test]
    fn every_mix_of_directions_comes_out_the_same() {
        for mask in 0..16_u32 {
            let sign = |bit: u32| if mask >> bit & 1 == 0 { 1.0 } else { -1.0 };
            // an annulus, ink inside its counter, and a hole in that ink
            let paths = [40.0, 30.0, 20.0, 10.0]
                .iter()
                .zip(0..)
                .map(|(&side, bit)| square(side, sign(bit)))
                .collect();
            let signs: Vec<f64> = set(paths).iter().map(|p| p.area().signum()).collect();
            assert_eq!(signs, [1.0, -1.0, 1.0, -1.0], "mask {mask}");
        }
    }

    #[test]
    fn nothing_stays_nothing() {
        assert!(set(Vec::new()).is_empty(), "no contours in, none out");
    }
}
