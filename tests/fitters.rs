//! What every fitter owes its caller, over the whole menu.

use crate::common::menu::is_complete;
use crate::common::shapes::{Shape, circle, degenerate, hard, line, smooth};
use khatt::fit::Method;
use khatt::fit::judge::{judge, points_to_curve};
use khatt::numeric::angles;
use khatt::types::{Fitted, Verdict};
use kurbo::{Affine, BezPath, ParamCurve, PathEl, Point, Shape as _};

const TOLERANCE_PX: f64 = 0.5;

fn fit(method: &Method, shape: &Shape, tolerance_px: f64) -> Fitted {
    let fitted = method.fitter().fit(shape.span(), tolerance_px);
    fitted.expect("default options are legal")
}

/// Runs `check` for every method and shape; the label names both.
fn each(shapes: &[Shape], check: impl Fn(&Method, &Shape, &str)) {
    let methods = Method::all();
    assert!(!methods.is_empty() && !shapes.is_empty(), "nothing to test");
    for method in &methods {
        for shape in shapes {
            check(
                method,
                shape,
                &format!("{} on {}", method.key(), shape.name),
            );
        }
    }
}

fn everything() -> Vec<Shape> {
    let mut all = smooth();
    all.push(line());
    all.extend(hard());
    all.extend(degenerate());
    all
}

/// The larger distance between two curves, both ways, by samples 1/16 of a segment apart.
fn apart(a: &BezPath, b: &BezPath) -> f64 {
    let samples = |p: &BezPath| -> Vec<Point> {
        let at = |s: kurbo::PathSeg| (0..=16).map(move |i| s.eval(f64::from(i) / 16.0));
        p.segments().flat_map(at).collect()
    };
    let one = |a: &BezPath, b: &BezPath| points_to_curve(&samples(a), b).max_px;
    one(a, b).max(one(b, a))
}

fn assert_form(fitted: &Fitted, shape: &Shape, what: &str) {
    let els = fitted.path.elements();
    assert!(els.len() >= 2, "{what}: nothing drawn");
    assert!(fitted.path.is_finite(), "{what}: not finite");
    let PathEl::MoveTo(start) = els[0] else {
        unreachable!("{what}: no move at the start");
    };
    assert!(shape.ring || start == shape.points[0], "{what}: the start");
    let body = if shape.ring {
        &els[1..els.len() - 1]
    } else {
        &els[1..]
    };
    let known = |e: &PathEl| matches!(e, PathEl::LineTo(_) | PathEl::CurveTo(..));
    assert!(
        body.iter().all(known),
        "{what}: one move, then lines and cubics"
    );
    if shape.ring {
        assert_eq!(els.last(), Some(&PathEl::ClosePath), "{what}: not closed");
    } else {
        let end = els.last().and_then(PathEl::end_point);
        assert_eq!(end, shape.points.last().copied(), "{what}: the end");
    }
}

#[test]
fn paths_are_well_formed_with_exact_ends() {
    each(&everything(), |method, shape, what| {
        assert_form(&fit(method, shape, TOLERANCE_PX), shape, what);
    });
}

#[test]
fn the_same_input_gives_the_same_curve() {
    each(&smooth(), |method, shape, what| {
        let (a, b) = (
            fit(method, shape, TOLERANCE_PX),
            fit(method, shape, TOLERANCE_PX),
        );
        assert_eq!(a, b, "{what}");
    });
}

#[test]
fn smooth_shapes_meet_the_tolerance() {
    let mut shapes = smooth();
    shapes.push(line());
    each(&shapes, |method, shape, what| {
        let fitted = fit(method, shape, TOLERANCE_PX);
        let j = judge(shape.span(), &fitted.path);
        assert!(
            j.max_px() <= TOLERANCE_PX + 0.01,
            "{what}: {j:?} {:?}",
            fitted.verdict
        );
        assert_eq!(fitted.verdict, Verdict::Met, "{what}");
    });
}

#[test]
fn met_is_true_and_no_curve_strays() {
    each(&everything(), |method, shape, what| {
        let fitted = fit(method, shape, TOLERANCE_PX);
        let j = judge(shape.span(), &fitted.path);
        if fitted.verdict == Verdict::Met {
            assert!(
                j.max_px() <= TOLERANCE_PX + 0.01,
                "{what} claims it is met: {j:?}"
            );
        }
        let size = shape
            .span()
            .points()
            .iter()
            .fold(shape_box(shape), |b, &p| b.union_pt(p));
        let slack = 0.1 * (size.width() + size.height()) + TOLERANCE_PX;
        assert!(
            j.max_px() <= slack,
            "{what} strays: {j:?}, {:?}",
            fitted.verdict
        );
    });
}

fn shape_box(shape: &Shape) -> kurbo::Rect {
    kurbo::Rect::from_points(shape.points[0], shape.points[0])
}

#[test]
fn error_falls_with_the_tolerance() {
    each(&smooth(), |method, shape, what| {
        let error = |t: f64| {
            judge(shape.span(), &fit(method, shape, t).path)
                .points
                .max_px
        };
        let (coarse, middle, fine) = (error(4.0), error(1.0), error(0.1));
        assert!(
            middle <= coarse.max(1.0) + 1e-6,
            "{what}: {coarse} {middle}"
        );
        assert!(fine <= middle.max(0.1) + 1e-6, "{what}: {middle} {fine}");
    });
}

#[test]
fn a_tighter_tolerance_never_costs_fewer_numbers() {
    each(&smooth(), |method, shape, what| {
        let (a, b) = (
            fit(method, shape, 2.0).parameters,
            fit(method, shape, 0.1).parameters,
        );
        assert!(a <= b, "{what}: {a} numbers at 2 px, {b} at 0.1 px");
    });
}

#[test]
fn the_reversed_span_gives_the_same_curve() {
    each(&everything(), |method, shape, what| {
        let (a, b) = (
            fit(method, shape, TOLERANCE_PX),
            fit(method, &shape.reversed(), TOLERANCE_PX),
        );
        let d = apart(&a.path, &b.path);
        assert!(d <= 0.05 * TOLERANCE_PX, "{what}: {d} px apart");
    });
}

#[test]
fn shift_scale_and_turn_carry_over() {
    let moves = [
        ("shift", Affine::translate((1000.0, -300.0)), 1.0, 0.05),
        ("scale", Affine::scale(2.0), 2.0, 0.05),
        // Nodes at extrema are elsewhere once turned: another curve, as good.
        ("turn", angles::rotation(0.5), 1.0, 0.25),
    ];
    each(&smooth(), |method, shape, what| {
        let here = fit(method, shape, TOLERANCE_PX);
        for (name, map, scale, part) in moves {
            let there = fit(method, &shape.map(|p| map * p), TOLERANCE_PX * scale);
            let d = apart(&(map * &here.path), &there.path);
            assert!(
                d <= part * TOLERANCE_PX * scale,
                "{what}, {name}: {d} px apart"
            );
        }
    });
}

#[test]
fn a_line_stays_straight() {
    each(&[line()], |method, shape, what| {
        let fitted = fit(method, shape, TOLERANCE_PX);
        assert!(
            judge(shape.span(), &fitted.path).max_px() < 0.05,
            "{what}: bent"
        );
    });
}

#[test]
fn a_circle_keeps_its_area() {
    each(&[circle()], |method, shape, what| {
        let area = fit(method, shape, TOLERANCE_PX).path.area();
        let true_area = std::f64::consts::PI * 2500.0;
        assert!((area / true_area - 1.0).abs() < 0.01, "{what}: area {area}");
    });
}

#[test]
fn numbers_are_counted() {
    each(&smooth(), |method, shape, what| {
        let n = fit(method, shape, TOLERANCE_PX).parameters;
        assert!(
            n >= 4 && n <= 2 * shape.points.len() + 4,
            "{what}: {n} numbers"
        );
    });
}

#[test]
fn the_menu_is_complete() {
    is_complete(&Method::all(), Method::key, Method::about);
}
