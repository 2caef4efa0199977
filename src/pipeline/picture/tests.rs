//! Whole pictures: letters that lie askew on their pixels.

use super::*;
use crate::numeric::angles;
use crate::numeric::coverage::{Coverage, blur};
use crate::numeric::curves::polygon;
use kurbo::{ParamCurve, ParamCurveNearest, Point};

/// A stem with serifs, and an arch that is open below, px.
const LETTER: &str = "\
    M20.3 18.2L44.1 18.2L44.1 22.6L37.4 24.9L37.4 50.3C41.2 56.8 49.5 58.2 55.3 55.1C62.4 51.3 64.2 41.5 60.9 34.2\
    L68.6 31.1C74.4 43.2 70.1 58.3 58.8 63.6C51.4 67 42.6 65.2 37.4 58.9L37.4 78.4L20.3 78.4L20.3 74.2L27.6 71.9\
    L27.6 24.9L20.3 22.6Z";

/// The letter as pixels see it that are turned by so many degrees, under a lens of `lens` px.
fn askew(turn_deg: f64, lens: f64) -> (BezPath, Gray) {
    const SIZE: usize = 96;
    let path = BezPath::from_svg(LETTER).expect("a path");
    let middle = Point::new(SIZE as f64 / 2.0, SIZE as f64 / 2.0);
    let turn = angles::rotation_about(turn_deg.to_radians(), middle);
    let mut fill = Coverage::new(SIZE, SIZE).mapped(turn);
    fill.add(&polygon(&path, 0.001));
    let mut samples = fill.samples();
    blur(&mut samples, SIZE, lens, 0);
    let gray = Gray::new(SIZE, SIZE, samples).expect("samples of a coverage");
    (path, gray.with_upright(turn.inverse()))
}

/// How far the curves of a picture lie from a path: in the mean, and at most, px.
fn off(path: &BezPath, gray: &Gray) -> (f64, f64) {
    let curves = trace_picture(gray, InkStreaks::Keep, &Options::default()).expect("curves");
    let segments = || curves.paths.iter().flat_map(BezPath::segments);
    let points = segments().flat_map(|s| (0..10).map(move |k| s.eval(f64::from(k) / 10.0)));
    let near = |p: Point| {
        let off = path.segments().map(|s| s.nearest(p, 1e-6).distance_sq);
        off.fold(f64::INFINITY, f64::min).sqrt()
    };
    let offs: Vec<f64> = points.map(near).collect();
    let most = offs.iter().copied().fold(0.0, f64::max);
    (offs.iter().sum::<f64>() / offs.len() as f64, most)
}

#[test]
fn letters_askew_on_their_pixels_are_traced_as_well_as_upright_ones() {
    let turns = [0.0, 0.3, 1.0, -2.0, -7.0, 30.0, 90.0];
    let all = turns.map(|turn| {
        let (path, gray) = askew(turn, 0.0);
        let (mean, most) = off(&path, &gray);
        assert!(mean < 0.02 && most < 0.25, "{mean} {most} at {turn}°");
        // what interpolated pixels would cost
        (mean, off(&path, &scan::upright(&gray)).0)
    });
    let [own, between] = [all.map(|a| a.0), all.map(|a| a.1)].map(|a| a[1..6].iter().sum::<f64>());
    assert!(own < between / 2.0, "{own} {between}");
}

#[test]
fn letters_askew_are_traced_out_of_focus_too() {
    for turn in [0.0, 1.0, -7.0] {
        let (path, gray) = askew(turn, 2.4);
        let (mean, most) = off(&path, &gray);
        assert!(mean < 0.3 && most < 1.5, "{mean} {most} at {turn}°");
    }
}
