use super::{Method, QuadraticError, rate::Rate, split::Split};
use crate::numeric::distance::Polyline;
use crate::types::Outline;
use kurbo::{BezPath, ParamCurve, PathSeg, Point, Shape};
use proptest::prelude::*;

/// The largest distance of samples of `a` from `b`.
fn apart(a: &Outline, b: &Outline) -> f64 {
    // kurbo's nearest place on a quadratic can be one of its ends where the middle is near
    let chord = |i: u16| f64::from(i) / 4096.0;
    let chords = |s: PathSeg| Polyline::new((0..=4096).map(|i| s.eval(chord(i))).collect());
    let lines: Vec<Polyline> = b.to_path().segments().filter_map(chords).collect();
    let near = |p: Point| {
        let all = lines.iter().map(|l| l.nearest(p).distance);
        all.fold(f64::INFINITY, f64::min)
    };
    let ts = (0..=24).map(|i| f64::from(i) / 24.0);
    let samples = a
        .to_path()
        .segments()
        .collect::<Vec<_>>()
        .into_iter()
        .flat_map(|s| ts.clone().map(move |t| s.eval(t)).collect::<Vec<_>>());
    samples.map(near).fold(0.0, f64::max)
}

fn outline(svg: &str) -> Outline {
    Outline::new(vec![BezPath::from_svg(svg).unwrap()]).unwrap()
}

fn coordinate() -> impl Strategy<Value = f64> {
    (-800.0..1200.0f64).prop_map(|v| (v * 4.0).round() / 4.0)
}

prop_compose! {
    fn ring()(p in prop::collection::vec((coordinate(), coordinate()), 4..20), kinds in prop::collection::vec(0..3u8, 8)) -> Outline {
        let mut points = p.into_iter().map(Point::from);
        let mut path = BezPath::new();
        path.move_to(points.next().unwrap());
        for kind in kinds {
            let mut next = || points.next();
            match kind {
                0 => if let Some(p) = next() { path.line_to(p) },
                1 => if let (Some(a), Some(b)) = (next(), next()) { path.quad_to(a, b) },
                _ => if let (Some(a), Some(b), Some(c)) = (next(), next(), next()) { path.curve_to(a, b, c) },
            }
        }
        path.close_path();
        Outline::new(vec![path]).unwrap()
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn within_the_tolerance_both_ways(o in ring(), tolerance in 0.3..4.0f64) {
        for method in Method::all() {
            // Whole units may be too coarse below 1 unit, and the error says so.
            let q = match method.convert(&o, tolerance) {
                Err(QuadraticError::Grid { .. }) if tolerance < 1.0 => continue,
                q => q.unwrap(),
            };
            // Contours that are nowhere wider than a point or a line may go.
            if q.is_empty() {
                prop_assert!(o.to_path().area().abs() < 1.0);
                continue;
            }
            let (there, back) = (apart(&o, &q), apart(&q, &o));
            prop_assert!(there <= tolerance * 1.001, "{}: {there} > {tolerance}", method.key());
            prop_assert!(back <= tolerance * 1.001, "{}: {back} > {tolerance}", method.key());
            prop_assert!(q.to_path().segments().all(|s| !matches!(s, PathSeg::Cubic(_))));
        }
    }
}

#[test]
fn a_tolerance_is_positive() {
    for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let err = Method::default().convert(&Outline::EMPTY, bad);
        assert!(matches!(err, Err(QuadraticError::Tolerance(_))), "{bad}");
    }
}

#[test]
fn options_have_ranges() {
    let rate = Rate::default();
    let (nan, wide) = (f64::NAN, 1e300);
    for (option, bad) in [
        (
            "corner_deg",
            Rate {
                corner_deg: nan,
                ..rate.clone()
            },
        ),
        (
            "lambda",
            Rate {
                lambda: wide,
                ..rate.clone()
            },
        ),
        (
            "lambda",
            Rate {
                lambda: -1.0,
                ..rate.clone()
            },
        ),
        (
            "grain",
            Rate {
                grain: 0.0,
                ..rate.clone()
            },
        ),
    ] {
        let said = Method::Rate(bad).convert(&Outline::EMPTY, 1.0).unwrap_err();
        assert!(
            said.to_string().starts_with(&format!("{option} is ")),
            "{said}"
        );
    }
}

#[test]
fn lines_and_quadratics_stay() {
    let o = outline("M0 0L100 0Q150 50 100 100L0 100Z");
    let split = Method::Split(Split::default());
    assert_eq!(split.convert(&o, 1.0).unwrap(), o);
}
