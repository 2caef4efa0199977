use super::*;
use crate::numeric::chain::{Chain, Join};
use crate::numeric::curves::{arriving, leaving};
use crate::types::Contour;
use kurbo::{Arc, ParamCurve, ParamCurveArclen, PathEl, Shape, Vec2};

/// Points about a pixel apart along a path.
fn points(path: &BezPath) -> Vec<Point> {
    let mut out: Vec<Point> = Vec::new();
    for seg in path.segments() {
        let n = (seg.arclen(1e-3) / 0.7).ceil();
        let m = (0..).take_while(|&i| f64::from(i) < n);
        out.extend(m.map(|i| seg.eval(f64::from(i) / n)));
    }
    out.extend(path.segments().last().map(|s| s.eval(1.0)));
    out
}

fn fit(span: Span<'_>) -> Fitted {
    Joint::default().fit(span, 0.5).unwrap()
}

fn circle(radius: f64) -> Vec<Point> {
    let arc = Arc::new(
        (50.0, 50.0),
        (radius, radius),
        0.1,
        std::f64::consts::TAU,
        0.0,
    );
    let mut p = points(&arc.path_elements(1e-6).collect());
    p.pop();
    p
}

#[test]
fn a_circle_has_four_nodes_at_its_extrema() {
    let p = circle(30.0);
    let got = fit(Span::Ring(&p)).path;
    assert_eq!(got.segments().count(), 4, "{got:?}");
    for seg in got.segments() {
        let d = seg.start() - Point::new(50.0, 50.0);
        assert!(d.x.abs().min(d.y.abs()) < 0.2, "{d:?}");
        assert!((d.hypot() - 30.0).abs() < 0.05);
    }
}

#[test]
fn a_straight_span_is_one_line() {
    let p: Vec<Point> = (0..80)
        .map(|i| Point::new(f64::from(i), 0.3 * f64::from(i)))
        .collect();
    let got = fit(Span::Open(&p)).path;
    assert_eq!(
        got.elements(),
        [PathEl::MoveTo(p[0]), PathEl::LineTo(p[79])]
    );
}

#[test]
fn a_span_of_which_a_part_is_tried_first_is_fit_whole() {
    let along = (0..=LONG).map(|i| i as f64);
    let p: Vec<Point> = along.map(|x| Point::new(x, 0.3 * x)).collect();
    let got = fit(Span::Open(&p));
    assert_eq!(got.path.segments().count(), 1);
    assert_eq!(got.verdict, Verdict::Met);
}

#[test]
fn a_line_runs_into_a_curve_without_a_kink() {
    let path = BezPath::from_svg("M0 0L0 60C0 90 20 110 50 110L100 110").unwrap();
    let got = fit(Span::Open(&points(&path))).path;
    let els = got.elements();
    assert!(
        matches!(
            els,
            [
                PathEl::MoveTo(_),
                PathEl::LineTo(_),
                PathEl::CurveTo(..),
                PathEl::LineTo(_)
            ]
        ),
        "{got:?}"
    );
    let (PathEl::LineTo(a), PathEl::CurveTo(b, c, d)) = (els[1], els[2]) else {
        panic!("{got:?}");
    };
    assert!((a - Point::new(0.0, 60.0)).hypot() < 1.5 && a.x.abs() < 1e-9 && b.x.abs() < 1e-9);
    assert!((d - Point::new(50.0, 110.0)).hypot() < 1.5 && (c.y - d.y).abs() < 1e-9);
}

#[test]
fn smooth_joins_are_exactly_smooth() {
    let path = BezPath::from_svg("M0 0C30 60 60 60 90 20S140 -40 200 10").unwrap();
    let p: Vec<Point> = points(&path)
        .iter()
        .enumerate()
        .map(|(i, q)| *q + Vec2::new(0.0, 0.05 * libm::sin(i as f64 * 1.7)))
        .collect();
    let got = fit(Span::Open(&p)).path;
    let segs: Vec<_> = got.segments().collect();
    for w in segs.windows(2) {
        let (a, b) = (arriving(&w[0].to_cubic()), leaving(&w[1].to_cubic()));
        assert!(a.cross(b).abs() < 1e-9 * a.hypot() * b.hypot(), "{got:?}");
    }
}

#[test]
fn a_rough_edge_is_not_its_own_polygon() {
    // a pen's stroke of 300 px whose edge wanders by a pixel in no regular way, with whiskers of 4 px
    let mut seed = 12_345_u32;
    let mut noise = || {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(seed >> 16) / 65_536.0 - 0.5
    };
    for turn in 0..12 {
        let bend = 0.004 * f64::from(turn);
        let mut drift = 0.0;
        let points: Vec<Point> = (0..300)
            .map(|i| {
                drift = 0.9 * drift + noise();
                let whisker = if noise() > 0.47 { 4.0 } else { 0.0 };
                let x = f64::from(i);
                Point::new(x, 40.0 * libm::sin(bend * x) + drift + whisker)
            })
            .collect();
        for span in [Span::Open(&points), Span::Ring(&points)] {
            let fitted = Joint::default().fit(span, 0.5).unwrap();
            let segments = fitted.path.segments().count();
            assert!(segments < points.len() / 2, "{turn}: {segments} segments");
            let ends = (fitted.path.segments().next(), fitted.path.segments().last());
            let (first, last) = (ends.0.unwrap().start(), ends.1.unwrap().end());
            let closed = if span.is_ring() {
                first
            } else {
                points[points.len() - 1]
            };
            assert!(last.distance(closed) < 1e-9, "{turn}: {last} {closed}");
        }
    }
}

/// A half disk whose arc strays by up to `stray` px, cut at its two corners.
fn half_disk(stray: f64) -> Spans {
    let arc = Arc::new((50.0, 50.0), (30.0, 30.0), 0.0, std::f64::consts::PI, 0.0);
    let arc = points(&arc.path_elements(1e-6).collect());
    let wave = |i: usize| stray * ((i * 7 % 11) as f64 / 5.0 - 1.0);
    let out = arc.iter().enumerate().map(|(i, p)| {
        let away = *p - Point::new(50.0, 50.0);
        if i == 0 || i + 1 == arc.len() {
            *p
        } else {
            *p + away / 30.0 * wave(i)
        }
    });
    let mut ring: Vec<Point> = out.collect();
    let end = ring.len() - 1;
    ring.extend((1..86).map(|i| Point::new(20.0 + 0.7 * f64::from(i), 50.0)));
    Contour::new(ring).unwrap().cut(&[0, end])
}

#[test]
fn noise_of_one_side_is_no_reason_to_leave_it() {
    for stray in [0.0, 0.15, 0.3] {
        let path = Joint::default().contour(&half_disk(stray), 0.5).unwrap();
        let centre = Point::new(50.0, 50.0);
        let upper = path.segments().filter(|s| s.eval(0.5).y > 51.0);
        let mut off = 0.0_f64;
        for seg in upper {
            for k in 0..=8 {
                off = off.max((seg.eval(f64::from(k) / 8.0).distance(centre) - 30.0).abs());
            }
        }
        assert!(off < 0.02 + 0.5 * stray, "{stray}: {off}");
        assert!(path.segments().count() <= 4, "{stray}: {path:?}");
    }
}

#[test]
fn a_span_that_misses_is_followed_more_closely() {
    // two waves of 0.8 px: too regular for noise, too flat to be seen at first
    let p: Vec<Point> = (0..120)
        .map(|i| Point::new(f64::from(i), 0.8 * libm::sin(f64::from(i) * 0.105)))
        .collect();
    let got = fit(Span::Open(&p));
    assert_eq!(got.verdict, Verdict::Met, "{:?}", got.path);
}

#[test]
fn an_extremum_at_a_line_that_lies_aslant_is_none() {
    // held upright, the line would turn the slope beyond it
    let read = |x: f64| {
        let svg =
            format!("M24.2 448.4C24.2 438 22.3 428 22.3 417.2L{x} 413.2C22.8 410 30 270 32.6 203");
        let mut chain = Chain::from_path(&BezPath::from_svg(&svg).unwrap(), 0.3).unwrap();
        chain.nodes[1].join = Join::Vertical;
        chain.nodes[2].join = Join::Smooth;
        chain
    };
    for (x, join) in [(22.55, Join::Smooth), (22.35, Join::Vertical)] {
        let mut chain = read(x);
        found::turn(&mut chain);
        assert_eq!(chain.nodes[1].join, join, "{x}");
        assert_eq!(chain.nodes[2].join, Join::Smooth);
    }
}
