use super::band::{Band, near};
use super::piece::Piece;
use super::{Bounds, CodeError, Kind, RUN, Steps, Width, distortion, encode};
use crate::numeric::qbc::Pull;
use kurbo::Point;

/// The boundary pixels of a three-lobed shape, 8-connected.
fn boundary(scale: f64) -> Vec<Point> {
    let at = |k: u32| {
        let a = f64::from(k) * std::f64::consts::TAU / 4000.0;
        let r = scale * (14.0 + 4.0 * (3.0 * a).cos());
        Point::new((r * a.cos()).round(), (r * a.sin()).round())
    };
    let mut out: Vec<Point> = (0..4000).map(at).collect();
    out.dedup();
    if out.first() == out.last() {
        out.pop();
    }
    out
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
                Width::Bound,
                Steps::Eight,
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
        encode(&shape, kind, bounds, width, Steps::Any)
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
fn what_is_not_looked_at_would_not_be_cheaper() {
    // Algorithm 1 as it stands: every pair of pairs, no edge or group of pairs put aside
    let bounds = Bounds {
        t_max: 1.5,
        t_min: 1.0,
    };
    let shape = boundary(0.5);
    for (kind, steps) in SPLINES
        .into_iter()
        .flat_map(|k| [Steps::Eight, Steps::Any].map(|s| (k, s)))
    {
        let band = Band::new(&shape, bounds, kind, Width::Bound);
        let piece = Piece::new(&band, kind);
        let last = band.vertices.len() - 1;
        let mut least = vec![vec![(0, 0, 0, None)]];
        least.resize(last + 1, Vec::new());
        for at in 0..last {
            for &((dx, dy), step) in &steps.words() {
                let (x, y) = band.vertices[at].at;
                let Some(to) = band.find((x + dx, y + dy)) else {
                    continue;
                };
                let (from, there) = (band.vertices[at].stage, band.vertices[to].stage);
                if there <= from || there - from > 4 * shape.len() / 10 {
                    continue;
                }
                let Some(foot) = piece.foot(at, to) else {
                    continue;
                };
                let cost = |&(cost, before, behind, taken): &(u64, usize, usize, _)| {
                    let fits = piece.fits([before, at, to], (behind, foot));
                    Some(cost + fits.then(|| steps.cost(taken, step))??)
                };
                if let Some(cost) = least[at].iter().filter_map(cost).min() {
                    least[to].push((cost, at, foot, Some(step)));
                }
            }
        }
        let closes =
            |p: &&(u64, usize, usize, _)| piece.fits([p.1, last, last], (p.2, shape.len()));
        let all = least[last].iter().filter(closes).map(|p| p.0).min();
        let coded = encode(&shape, kind, bounds, Width::Bound, steps).unwrap();
        assert_eq!(Some(coded.bits), all, "{kind:?} {steps:?}");
    }
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
    let polygon = encode(&shape, Kind::Polygon, bounds, Width::Bound, Steps::Eight)
        .unwrap()
        .bits;
    for kind in SPLINES {
        let spline = encode(&shape, kind, bounds, Width::Bound, Steps::Eight)
            .unwrap()
            .bits;
        assert!(spline < polygon, "{kind:?}: {spline} and {polygon}");
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
fn the_code() {
    let eight = |before, step| Steps::Eight.bits(before, step);
    assert_eq!(eight(None, (1, 0)), Some(6));
    assert_eq!(eight(Some((3, 0)), (15, 0)), Some(7));
    assert_eq!(eight(Some((3, 0)), (-4, -4)), None);
    assert_eq!(eight(Some((3, 3)), (-4, 4)), Some(7));
    assert_eq!(eight(Some((0, 2)), (-1, 1)), Some(5));
    for wrong in [(0, 0), (32, 0), (2, 1)] {
        assert_eq!(eight(None, wrong), None, "{wrong:?}");
    }
    // straight on: the middle of 5 places takes 2 bits of truncated binary, the outer ones 3
    let any = |step| Steps::Any.bits(Some((10, 4)), step);
    assert_eq!(
        [any((5, 2)), any((5, 0)), any((-5, 1))],
        [Some(8), Some(9), None]
    );
}

#[test]
fn the_words_of_a_code_are_all_the_words_of_their_lengths() {
    // Kraft: a complete prefix code's 2^-bits add to 1
    let steps = || (-RUN..=RUN).flat_map(|x| (-RUN..=RUN).map(move |y| (x, y)));
    for code in [Steps::Eight, Steps::Any] {
        for before in [
            None,
            Some((1, 0)),
            Some((-7, 7)),
            Some((0, -31)),
            Some((4, 29)),
            Some((-13, 5)),
        ] {
            if code == Steps::Eight && before.is_some_and(|b| code.bits(None, b).is_none()) {
                continue;
            }
            let words = steps().filter_map(|s| code.bits(before, s));
            let sum: f64 = words.map(|bits| 0.5_f64.powf(bits as f64)).sum();
            assert!(
                (sum - 1.0).abs() < 1e-12,
                "{code:?} after {before:?}: {sum}"
            );
        }
    }
}

#[test]
fn the_bits_are_those_of_the_vertices() {
    let bounds = Bounds {
        t_max: 2.0,
        t_min: 1.0,
    };
    for steps in [Steps::Eight, Steps::Any] {
        let coded = encode(&boundary(1.0), SPLINES[2], bounds, Width::Bound, steps).unwrap();
        let step = |w: &[Point]| {
            let [x, y] = [w[1].x - w[0].x, w[1].y - w[0].y].map(near);
            (x, y)
        };
        let steps_taken: Vec<_> = coded.vertices.windows(2).map(step).collect();
        let before = std::iter::once(None).chain(steps_taken.iter().copied().map(Some));
        let bits = before
            .zip(&steps_taken)
            .map(|(b, s)| steps.bits(b, *s).unwrap());
        assert_eq!(bits.sum::<u64>(), coded.bits, "{steps:?}");
    }
}

#[test]
fn what_cannot_be_coded_is_told() {
    let bounds = Bounds {
        t_max: 1.0,
        t_min: 1.0,
    };
    assert_eq!(
        encode(&[], Kind::Polygon, bounds, Width::Bound, Steps::Any),
        Err(CodeError::Short(0))
    );
    for far in [f64::NAN, 5000.0] {
        let mut shape = boundary(1.0);
        shape[3].x = far;
        let coded = encode(&shape, Kind::Polygon, bounds, Width::Bound, Steps::Any);
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
            Width::Bound,
            Steps::Any
        ),
        Err(CodeError::Bounds(1.0, 2.0))
    );
}
