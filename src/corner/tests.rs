//! Corners of known shapes, smooth and ragged.

use super::{Detector as _, sharpen, sides::Sides};
use crate::numeric::angles;
use crate::{numeric::cast::index, types::Contour};
use kurbo::{
    BezPath, Circle, ParamCurve as _, ParamCurveArclen as _, Point, Rect, RoundedRect, Shape as _,
};

/// A shape's contour with points 0.8 px apart, moved off it by what `stray` says, px outwards.
fn contour(path: &BezPath, stray: impl Fn(usize) -> f64) -> Contour {
    let mut points: Vec<Point> = Vec::new();
    for seg in path.segments() {
        let n = index((seg.arclen(1e-3) / 0.8).ceil());
        points.extend((0..n).map(|i| seg.eval(i as f64 / n as f64)));
    }
    let n = points.len();
    let moved = (0..n).map(|i| {
        let along = (points[(i + 1) % n] - points[(i + n - 1) % n]).normalize();
        points[i] - along.turn_90() * stray(i)
    });
    Contour::new(moved.collect()).unwrap()
}

fn square() -> BezPath {
    angles::rotation(0.35) * Rect::new(0.0, 0.0, 60.0, 60.0).to_path(1e-3)
}

/// Teeth 1.8 px high, 0.9 in the mean, twelve points long each: what paper's fibres make of a felt pen's edge.
fn bumps(i: usize) -> f64 {
    0.3 * (i % 12).abs_diff(6) as f64
}

const RAGGED_PX: f64 = 3.0;

#[test]
fn a_square_has_its_corners_smooth_or_ragged() {
    let corners = [(0.0, 0.0), (60.0, 0.0), (60.0, 60.0), (0.0, 60.0)];
    let corners = corners.map(|p| angles::rotation(0.35) * Point::from(p));
    for (c, within) in [
        (contour(&square(), |_| 0.0), 0.01),
        (contour(&square(), bumps).with_ragged(RAGGED_PX), 2.0),
    ] {
        let found = Sides::default().corners(&c);
        assert_eq!(found.len(), 4, "{} {found:?}", c.ragged_px());
        let (sharp, at) = sharpen(&c, &found);
        for i in at {
            let off = corners.map(|p| p.distance(sharp.points()[i]));
            let off = off.into_iter().fold(f64::INFINITY, f64::min);
            assert!(off < within, "{off}");
        }
    }
}

#[test]
fn bumps_of_ragged_ink_are_no_corners() {
    let disk = Circle::new((50.0, 50.0), 40.0).to_path(1e-4);
    let smooth = contour(&disk, |_| 0.0);
    assert_eq!(Sides::default().corners(&smooth), [0usize; 0]);
    let ragged = contour(&disk, bumps);
    let taken_at_its_word = Sides::default().corners(&ragged).len();
    assert!(
        taken_at_its_word > 4,
        "{taken_at_its_word}: the bumps are too flat for this test"
    );
    assert_eq!(
        Sides::default().corners(&ragged.with_ragged(RAGGED_PX)),
        [0usize; 0]
    );
}

#[test]
fn round_corners_are_none() {
    for radius in [6.0, 9.0, 14.0] {
        let path = RoundedRect::new(0.0, 0.0, 60.0, 60.0, radius).to_path(1e-4);
        let found = Sides::default().corners(&contour(&path, |_| 0.0));
        assert_eq!(found, [0usize; 0], "radius {radius}");
    }
}
