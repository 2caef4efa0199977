//! What every corner detector owes its caller, over the whole menu.

use crate::common::menu::is_complete;
use crate::common::shapes::{Shape, circle, degenerate, noisy, polygon, smooth};
use khatt::corner::Method;
use khatt::numeric::angles;
use khatt::types::Contour;
use kurbo::{Affine, Point};

/// How far a corner found may lie from the true one, px.
const NEAR_PX: f64 = 2.5;

fn found(method: &Method, shape: &Shape) -> Vec<Point> {
    let contour = Contour::new(shape.points.clone()).expect("a contour");
    let corners = method.detector().corners(&contour);
    let what = format!("{} on {}", method.key(), shape.name);
    assert!(
        corners.windows(2).all(|w| w[0] < w[1]),
        "{what}: not increasing: {corners:?}"
    );
    let point = |&i: &usize| *contour.points().get(i).expect("an index of the contour");
    corners.iter().map(point).collect()
}

/// What a published method is known not to do: key, property, why. Taken off as soon as it does it.
const FAILS: &[(&str, &str, &str)] = &[
    (
        "srm05",
        "smooth",
        "a slope changes its sign at every extremum of a round shape",
    ),
    (
        "srm05",
        "noise",
        "noise of a part of a pixel on a straight side changes the slope's sign everywhere",
    ),
];

/// Runs `check` over all methods but those known to fail; those must fail indeed.
fn each_but(property: &str, check: impl Fn(&Method) + std::panic::RefUnwindSafe) {
    each(|m| {
        if FAILS.iter().any(|f| (f.0, f.1) == (m.key(), property)) {
            let caught = std::panic::catch_unwind(|| check(m));
            assert!(
                caught.is_err(),
                "{} no longer fails at {property}: take it off the list",
                m.key()
            );
        } else {
            check(m);
        }
    });
}

fn polygons() -> Vec<(Shape, Vec<Point>)> {
    let table: [(&str, &[(f64, f64)]); 4] = [
        (
            "square",
            &[(0.0, 0.0), (60.0, 0.0), (60.0, 60.0), (0.0, 60.0)],
        ),
        ("triangle", &[(0.0, 0.0), (80.0, 10.0), (30.0, 70.0)]),
        (
            "ell",
            &[
                (0.0, 0.0),
                (70.0, 0.0),
                (70.0, 20.0),
                (20.0, 20.0),
                (20.0, 90.0),
                (0.0, 90.0),
            ],
        ),
        (
            "diamond",
            &[(50.0, 0.0), (90.0, 60.0), (50.0, 120.0), (10.0, 60.0)],
        ),
    ];
    let one = |&(name, corners): &(&'static str, &[(f64, f64)])| {
        (
            polygon(name, corners),
            corners.iter().map(|&p| p.into()).collect(),
        )
    };
    table.iter().map(one).collect()
}

/// Every point of one list has a partner of its own in the other.
fn assert_same(a: &[Point], b: &[Point], what: &str) {
    assert_eq!(a.len(), b.len(), "{what}: {a:?} and {b:?}");
    for p in a {
        assert!(
            b.iter().any(|q| p.distance(*q) <= NEAR_PX),
            "{what}: {p:?} is not in {b:?}"
        );
    }
}

fn each(check: impl Fn(&Method)) {
    let methods = Method::all();
    assert!(!methods.is_empty(), "nothing to test");
    methods.iter().for_each(check);
}

#[test]
fn corners_of_polygons_are_found() {
    each(|m| {
        for (shape, corners) in polygons() {
            assert_same(
                &found(m, &shape),
                &corners,
                &format!("{} on {}", m.key(), shape.name),
            );
        }
    });
}

#[test]
fn smooth_rings_have_none() {
    each_but("smooth", |m| {
        for shape in smooth().iter().filter(|s| s.ring) {
            assert_eq!(found(m, shape), [], "{} on {}", m.key(), shape.name);
        }
    });
}

#[test]
fn start_and_direction_do_not_matter() {
    each(|m| {
        for (shape, _) in polygons() {
            let here = found(m, &shape);
            let mut turned = shape.clone();
            turned.points.rotate_left(37);
            for other in [turned, shape.reversed()] {
                assert_same(
                    &here,
                    &found(m, &other),
                    &format!("{} on {}", m.key(), shape.name),
                );
            }
        }
    });
}

#[test]
fn shift_and_turn_carry_over() {
    each(|m| {
        for (shape, _) in polygons() {
            for map in [
                Affine::translate((500.0, -40.0)),
                angles::rotation(0.3),
                angles::rotation(1.2),
            ] {
                let here: Vec<_> = found(m, &shape).into_iter().map(|p| map * p).collect();
                let there = found(m, &shape.map(|p| map * p));
                assert_same(
                    &here,
                    &there,
                    &format!("{} on {} {map:?}", m.key(), shape.name),
                );
            }
        }
    });
}

#[test]
fn a_larger_picture_has_the_same_corners() {
    each(|m| {
        for factor in [1.0, 2.0, 5.0] {
            let corners = [(0.0, 0.0), (60.0, 0.0), (80.0, 50.0), (0.0, 60.0)]
                .map(|(x, y)| (x * factor, y * factor));
            let want = corners.map(Point::from);
            assert_same(
                &found(m, &polygon("quad", &corners)),
                &want,
                &format!("{} at {factor}", m.key()),
            );
        }
    });
}

#[test]
fn noise_makes_no_crowd_and_loses_no_right_angle() {
    each_but("noise", |m| {
        let (square, corners) = polygons().swap_remove(0);
        for seed in 1..4 {
            let here = found(m, &noisy(&square, 0.1, seed));
            for c in &corners {
                assert!(
                    here.iter().any(|p| p.distance(*c) <= NEAR_PX),
                    "{} loses {c:?}: {here:?}",
                    m.key()
                );
            }
            let ring = found(m, &noisy(&circle(), 0.1, seed));
            assert!(
                ring.len() <= 8,
                "{}: {} corners on a noisy circle",
                m.key(),
                ring.len()
            );
        }
    });
}

#[test]
fn short_and_degenerate_rings_work() {
    each(|m| {
        let mut tried = 0;
        for shape in degenerate() {
            if Contour::new(shape.points.clone()).is_ok() {
                found(m, &shape);
                tried += 1;
            }
        }
        assert!(tried >= 8, "only {tried} rings");
    });
}

#[test]
fn the_menu_is_complete() {
    is_complete(&Method::all(), Method::key, Method::about);
}
