mod algorithm;
mod words;

use super::{Bounds, Closing, Code, CodeError, Kind, Steps, Width, distortion, encode};
use crate::numeric::angles::angle;
use crate::numeric::qbc::Pull;
use kurbo::Point;

/// The boundary pixels of a three-lobed shape, 8-connected.
fn boundary(scale: f64) -> Vec<Point> {
    let at = |k: u32| {
        let a = f64::from(k) * std::f64::consts::TAU / 4000.0;
        let r = scale * (14.0 + 4.0 * libm::cos(3.0 * a));
        Point::new((r * libm::cos(a)).round(), (r * libm::sin(a)).round())
    };
    let mut out: Vec<Point> = (0..4000).map(at).collect();
    out.dedup();
    if out.first() == out.last() {
        out.pop();
    }
    out
}

const fn code(steps: Steps, width: Width, closing: Closing) -> Code {
    Code {
        width,
        steps,
        closing,
    }
}

const SPLINES: [Kind; 3] = [
    Kind::Spline(Pull::Bezier),
    Kind::Spline(Pull::Qbc),
    Kind::Spline(Pull::QbcN),
];

#[test]
fn curves_stay_within_the_bounds_and_need_fewer_bits_as_these_grow() {
    let shape = boundary(1.0);
    for kind in [Kind::Polygon].into_iter().chain(SPLINES) {
        let mut before = u64::MAX;
        for t in [1.0, 2.0] {
            let coded = encode(
                &shape,
                kind,
                Bounds { t_max: t, t_min: t },
                code(Steps::Eight, Width::Bound, Closing::Corner),
            )
            .unwrap();
            assert!(coded.d_max <= t + 0.05, "{kind:?}: {} > {t}", coded.d_max);
            assert!(coded.bits < before, "{kind:?}: {} at {t}", coded.bits);
            assert_eq!(coded.vertices.first(), coded.vertices.last());
            before = coded.bits;
        }
    }
}

#[test]
fn with_vertices_no_farther_than_the_curve_more_pull_needs_fewer_bits() {
    // Table 4's order; farther vertices cost none of the kinds more, and B-splines gain most by them
    let (shape, bounds) = (
        boundary(2.0),
        Bounds {
            t_max: 1.0,
            t_min: 1.0,
        },
    );
    let bits = |kind, width| {
        encode(
            &shape,
            kind,
            bounds,
            code(Steps::Any, width, Closing::Corner),
        )
        .unwrap()
        .bits
    };
    let near = SPLINES.map(|kind| bits(kind, Width::Tolerance));
    let far = SPLINES.map(|kind| bits(kind, Width::Bound));
    assert!(near.is_sorted_by(|a, b| a > b), "{near:?}");
    assert!(
        near.iter().zip(far).all(|(n, f)| *n >= f),
        "{near:?} {far:?}"
    );
    assert!(near[0] - far[0] > near[2] - far[2], "{near:?} {far:?}");
}

#[test]
fn splines_need_fewer_bits_than_polygons() {
    let (shape, bounds) = (
        boundary(4.0),
        Bounds {
            t_max: 2.0,
            t_min: 1.0,
        },
    );
    let polygon = encode(
        &shape,
        Kind::Polygon,
        bounds,
        code(Steps::Eight, Width::Bound, Closing::Corner),
    )
    .unwrap()
    .bits;
    for kind in SPLINES {
        let spline = encode(
            &shape,
            kind,
            bounds,
            code(Steps::Eight, Width::Bound, Closing::Corner),
        )
        .unwrap()
        .bits;
        assert!(spline < polygon, "{kind:?}: {spline} and {polygon}");
    }
}

#[test]
fn rings_need_fewer_bits_and_have_no_corner() {
    // all of a spline's pieces end where the next begins, along the same line
    let (shape, bounds) = (
        boundary(2.0),
        Bounds {
            t_max: 1.0,
            t_min: 1.0,
        },
    );
    for kind in [Kind::Polygon].into_iter().chain(SPLINES) {
        let [corner, ring] = [Closing::Corner, Closing::Ring].map(|closing| {
            let code = code(Steps::Far, Width::Bound, closing);
            encode(&shape, kind, bounds, code).unwrap()
        });
        assert!(
            ring.bits < corner.bits,
            "{kind:?}: {} and {}",
            ring.bits,
            corner.bits
        );
        assert!(ring.d_max <= 1.05, "{kind:?}: {}", ring.d_max);
        assert_eq!(ring.curve.first(), ring.curve.last());
        let bits = Steps::Far.write(&ring.vertices).unwrap();
        assert_eq!(
            (bits.len() as u64, Steps::Far.read(ring.vertices[0], &bits)),
            (ring.bits, Some(ring.vertices.clone()))
        );
        let n = ring.curve.len();
        let [before, after] = [[n - 2, n - 1], [0, 1]].map(|[i, j]| ring.curve[j] - ring.curve[i]);
        let turn = angle(before, after).abs();
        assert!(
            kind == Kind::Polygon || turn < 0.1,
            "{kind:?}: a turn of {turn} where it begins"
        );
    }
}

#[test]
fn the_same_control_points_come_closer_with_more_pull() {
    // Tables 1 to 3: D_max and D_ms of the Bézier curve are the largest, of QBC-n the smallest.
    let shape: Vec<Point> = (0..=60)
        .map(|k| Point::new(f64::from(k), 40.0 - (f64::from(k) - 30.0).abs()))
        .collect();
    let controls = [
        Point::new(0.0, 10.0),
        Point::new(30.0, 42.0),
        Point::new(60.0, 10.0),
    ];
    let measured = [Pull::Bezier, Pull::Qbc, Pull::QbcN].map(|pull| {
        let dots: Vec<Point> = (0..=400)
            .map(|k| pull.eval(&controls, f64::from(k) / 400.0).0)
            .collect();
        distortion(&shape, &dots)
    });
    assert!(
        measured
            .windows(2)
            .all(|m| m[0].0 > m[1].0 && m[0].1 > m[1].1),
        "{measured:?}"
    );
}

#[test]
fn what_cannot_be_coded_is_told() {
    let bounds = Bounds {
        t_max: 1.0,
        t_min: 1.0,
    };
    assert_eq!(
        encode(
            &[],
            Kind::Polygon,
            bounds,
            code(Steps::Any, Width::Bound, Closing::Ring)
        ),
        Err(CodeError::Short(0))
    );
    for far in [f64::NAN, 5000.0] {
        let mut shape = boundary(1.0);
        shape[3].x = far;
        let coded = encode(
            &shape,
            Kind::Polygon,
            bounds,
            code(Steps::Any, Width::Bound, Closing::Ring),
        );
        assert!(matches!(coded, Err(CodeError::Large(..))), "{coded:?}");
    }
    let wrong = Bounds {
        t_max: 1.0,
        t_min: 2.0,
    };
    assert_eq!(
        encode(
            &boundary(1.0),
            Kind::Polygon,
            wrong,
            code(Steps::Any, Width::Bound, Closing::Ring)
        ),
        Err(CodeError::Bounds(1.0, 2.0))
    );
}
