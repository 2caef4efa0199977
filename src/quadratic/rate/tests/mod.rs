//! Bytes, places and extrema of converted outlines.

mod exact;

use super::{
    Rate, Strictness,
    curve::{Course, Span, direction},
    glyf::points,
    glyf_bytes,
};
use crate::{numeric::angles, quadratic::split::Split, types::Outline};
use kurbo::{
    Affine, BezPath, Circle, Ellipse, ParamCurve, ParamCurveNearest, PathEl, PathSeg, Point, Shape,
};
use write_fonts::{dump_table, tables::glyf::SimpleGlyph};

/// The bytes write-fonts makes of it, without padding.
fn written(outline: &Outline) -> Vec<u8> {
    // TrueType runs contours the other way.
    let contours = outline
        .contours()
        .iter()
        .flat_map(BezPath::reverse_subpaths);
    let path: BezPath = contours.collect();
    dump_table(&SimpleGlyph::from_bezpath(&path).unwrap()).unwrap()
}

fn ellipse(x: f64, y: f64, turn: f64) -> Outline {
    let mut path = Ellipse::new((300.0, 320.0), (x, y), turn).to_path(1e-3);
    path.close_path();
    Outline::new(vec![path]).unwrap()
}

/// A letter-like contour: serifs, stems, bowls, corners, a hole.
fn letter() -> Outline {
    let outer = "M40 0L240 0L240 20C190 22 180 40 180 80L180 300C260 300 330 340 330 420C330 520 250 560 150 560L40 560L40 540C80 538 90 520 90 480L90 80C90 40 80 22 40 20Z";
    let hole = "M180 330L180 530C230 530 250 500 250 430C250 370 230 330 180 330Z";
    Outline::new(vec![
        BezPath::from_svg(outer).unwrap(),
        BezPath::from_svg(hole).unwrap(),
    ])
    .unwrap()
}

#[test]
fn the_bytes_counted_are_those_written() {
    for outline in [letter(), ellipse(200.0, 260.0, 0.3), ellipse(5.0, 6.0, 0.0)] {
        for tolerance in [0.8, 1.2, 2.0] {
            for q in [
                Split::default().convert(&outline, tolerance).unwrap(),
                Rate::default().convert(&outline, tolerance).unwrap(),
            ] {
                let counted = glyf_bytes(&q) as usize;
                assert_eq!(counted + counted % 2, written(&q).len(), "{tolerance}");
            }
        }
    }
}

#[test]
fn a_circle_takes_a_run_of_eight() {
    let circle = Outline::new(vec![Circle::new((0.0, 0.0), 250.0).to_path(1e-3)]).unwrap();
    let q = Rate::default().convert(&circle, 1.2).unwrap();
    let stored = points(&q.contours()[0]);
    assert_eq!(stored.len(), 8, "{stored:?}");
    assert!(stored.iter().all(|p| !p.on), "{stored:?}");
}

#[test]
fn a_circle_that_may_pass_its_extrema_takes_six() {
    // six quadratics between two circles lie 1.04 units beside the middle one, and the grid moves them
    let circle = Outline::new(vec![Circle::new((0.0, 0.0), 200.0).to_path(1e-3)]).unwrap();
    let rate = Rate {
        keep: Strictness::Corners,
        ..Rate::default()
    };
    let q = rate.convert(&circle, 1.6).unwrap();
    let stored = points(&q.contours()[0]);
    assert!(stored.len() <= 6, "{stored:?}");
    let far = astray(&circle, &q).max(astray(&q, &circle));
    assert!(far <= 1.6, "{far}");
}

#[test]
fn no_answer_has_fewer_bytes_than_the_bound() {
    // of a square's points the flags, two steps of two bytes and one of one; the first lies at the origin
    let square = BezPath::from_svg("M0 0L300 0L300 300L0 300Z").unwrap();
    let square = Outline::new(vec![square]).unwrap();
    let drawn = glyf_bytes(&Rate::default().convert(&square, 1.0).unwrap());
    assert_eq!(Rate::default().least_bytes(&square, 1.0), drawn);
    // eight flags, and of four level or upright steps and four aslant an aslant one is not stored
    let circle = Outline::new(vec![Circle::new((0.0, 0.0), 250.0).to_path(1e-3)]).unwrap();
    assert_eq!(Rate::default().least_bytes(&circle, 1.0), 14 + 8 + 10);
    for outline in [
        letter(),
        circle,
        ellipse(90.0, 40.0, 0.0),
        ellipse(5.0, 6.0, 0.0),
        ellipse(200.0, 260.0, 0.3),
    ] {
        for keep in [Strictness::Corners, Strictness::Extrema] {
            for tolerance in [0.8, 2.0, 8.0] {
                let rate = Rate {
                    keep,
                    ..Rate::default()
                };
                let found = glyf_bytes(&rate.convert(&outline, tolerance).unwrap());
                let least = rate.least_bytes(&outline, tolerance);
                assert!(least <= found, "{found} bytes, at least {least}");
            }
        }
    }
}

#[test]
fn it_needs_fewer_bytes_than_splitting() {
    for outline in [
        letter(),
        ellipse(200.0, 260.0, 0.3),
        ellipse(90.0, 40.0, 0.0),
    ] {
        let (a, b) = (
            Rate::default().convert(&outline, 1.0).unwrap(),
            Split::default().convert(&outline, 1.0).unwrap(),
        );
        assert!(
            glyf_bytes(&a) < glyf_bytes(&b),
            "{} and {}",
            glyf_bytes(&a),
            glyf_bytes(&b)
        );
    }
}

#[test]
fn corners_lines_and_extrema_stay() {
    let places = Rate {
        keep: Strictness::Places,
        ..Rate::default()
    };
    let (o, q) = (letter(), places.convert(&letter(), 1.0).unwrap());
    assert_eq!(o.bounds(), q.bounds());
    let corners = [
        "240 0", "240 20", "180 300", "40 560", "40 540", "40 20", "40 0", "180 330", "180 530",
    ];
    let all: Vec<_> = q
        .contours()
        .iter()
        .flat_map(points)
        .map(|p| format!("{} {}", p.x, p.y))
        .collect();
    for corner in corners {
        assert!(all.iter().any(|p| p == corner), "{corner} of {all:?}");
    }
    let round = Rate::default()
        .convert(&ellipse(200.0, 260.0, 0.3), 1.0)
        .unwrap();
    let (a, b) = (
        ellipse(200.0, 260.0, 0.3).bounds().unwrap(),
        round.bounds().unwrap(),
    );
    assert_eq!(a.round(), b, "extrema stand at the rounded extremes");
}

#[test]
fn a_corner_moves_along_its_level_line_only() {
    // a bow that one quadratic misses by 2 units from corner to corner, between two level lines
    let svg = "M0 0L300 0C260 70 180 130 120 160L-200 160L-200 100L0 100Z";
    let (bow, tolerance) = (
        Outline::new(vec![BezPath::from_svg(svg).unwrap()]).unwrap(),
        2.4,
    );
    let [placed, free] = [Strictness::Places, Strictness::Corners].map(|keep| {
        let rate = Rate {
            keep,
            ..Rate::default()
        };
        rate.convert(&bow, tolerance).unwrap()
    });
    assert!(glyf_bytes(&free) <= glyf_bytes(&placed));
    for y in [0, 100, 160] {
        let stored = points(&free.contours()[0]);
        let level = stored.iter().filter(|p| p.on && p.y == y).count();
        assert_eq!(level, 2, "{y} of {stored:?}");
    }
}

/// The largest distance of an outline from what was made of it.
fn astray(outline: &Outline, made: &Outline) -> f64 {
    let quads: Vec<_> = made.contours().iter().flat_map(BezPath::segments).collect();
    let drawn = outline.contours().iter().flat_map(BezPath::segments);
    let dots = drawn.flat_map(|s| (0..20).map(move |i| s.eval(f64::from(i) / 20.0)));
    let near = |p: Point| {
        let off = |s: &PathSeg| s.nearest(p, 1e-6).distance_sq;
        quads.iter().map(off).fold(f64::INFINITY, f64::min).sqrt()
    };
    dots.map(near).fold(0.0, f64::max)
}

#[test]
fn a_contour_of_one_corner_stays_within_the_tolerance() {
    let svg = "M82 -134C82 -118 89 -100 106 -80C119 -67 144 -42 156 -34C162 -32 172 -34 179 -34C202 -35 252 -39 277 -44C310 -51 357 -72 357 -109C357 -192 287 -250 209 -250C130 -250 82 -200 82 -134Z";
    let drop = Outline::new(vec![BezPath::from_svg(svg).unwrap()]).unwrap();
    for (keep, tolerance) in [(Strictness::Corners, 1.2), (Strictness::Extrema, 2.15)] {
        let rate = Rate {
            keep,
            ..Rate::default()
        };
        let far = astray(&drop, &rate.convert(&drop, tolerance).unwrap());
        assert!(far <= tolerance, "{far}");
    }
}

#[test]
fn a_line_does_not_reach_across_the_bends_behind_it() {
    // a serif whose tip stands in one line with the stem beside it
    let svg = "M144 91L144 275C144 320 147 388 151 429C151 432 148 434 144 434C136 434 91 393 24 377C20 376 17 370 17 365C17 359 20 353 25 352C59 345 71 315 71 279L71 69C71 0 71 -136 42 -197C23 -237 0 -254 -24 -260C-26 -261 -35 -269 -35 -277C-35 -284 -21 -287 -14 -287C26 -287 89 -220 114 -152C143 -72 144 29 144 91Z";
    let j = Outline::new(vec![BezPath::from_svg(svg).unwrap()]).unwrap();
    let rate = Rate {
        keep: Strictness::Corners,
        ..Rate::default()
    };
    let far = astray(&j, &rate.convert(&j, 1.2).unwrap());
    assert!(far <= 1.2, "{far}");
}

#[test]
fn a_line_that_is_drawn_on_into_a_bend_stays_beside_it() {
    // a leaning stem that runs into a narrow foot, which bulges between the line's end and the extremum
    for (bulge, foot) in [(6, 28), (8, 36), (10, 28), (10, 36)] {
        let (low, left) = (60 - foot, 20 - bulge);
        let end = low - 8;
        let svg = format!(
            "M120 420L20 60C{left} {low} {left} {end} 20 {end}C28 {end} 38 {low} 60 {}L280 420Z",
            low + 30
        );
        let stem = Outline::new(vec![BezPath::from_svg(&svg).unwrap()]).unwrap();
        for keep in [Strictness::Corners, Strictness::Extrema] {
            for tolerance in [0.8, 1.2] {
                let rate = Rate {
                    keep,
                    ..Rate::default()
                };
                let made = rate.convert(&stem, tolerance).unwrap();
                let far = astray(&stem, &made).max(astray(&made, &stem));
                assert!(far <= tolerance, "{svg} {keep:?} {tolerance}: {far}");
            }
        }
    }
}

#[test]
fn corners_so_near_that_either_may_be_the_other_lose_no_contour() {
    // a ring that a line closes which is shorter than its corners may move
    for (gap, keep, tolerances) in [
        (1.6e-5, Strictness::Extrema, [1.5, 2.0, 3.0]),
        (0.1, Strictness::Extrema, [1.0, 1.5, 2.0]),
        (0.1, Strictness::Corners, [1.0, 1.5, 2.0]),
    ] {
        let end = 232.8 + gap;
        let svg = format!(
            "M232.8 503C232.8 478.8 252.6 459 276.8 459C301 459 321.9 478.8 321.9 503C321.9 528.3 301 548.1 276.8 548.1\
             C252.6 548.1 {end} 528.3 {end} 503Z"
        );
        let ring = Outline::new(vec![BezPath::from_svg(&svg).unwrap()]).unwrap();
        let rate = Rate {
            keep,
            ..Rate::default()
        };
        for tolerance in tolerances {
            let far = astray(&ring, &rate.convert(&ring, tolerance).unwrap());
            assert!(far <= tolerance, "{gap} {tolerance}: {far}");
        }
    }
}

#[test]
fn a_level_step_on_a_slope_takes_no_extremum_with_it() {
    let svg = "M100 500C100 430 180 360 290 360L294 360C300 360 303 359.9 306 359.9C420 359.9 500 430 500 500L500 900\
               L100 900Z";
    let arch = Outline::new(vec![BezPath::from_svg(svg).unwrap()]).unwrap();
    for tolerance in [0.5, 1.0, 2.0] {
        let made = Rate::default().convert(&arch, tolerance).unwrap();
        let quads = made.contours()[0].segments();
        let mut ends = quads.filter_map(|s| match s {
            PathSeg::Quad(q) => Some((q.p1, q.p2)),
            _ => None,
        });
        let is_top = |(c, p): (Point, Point)| (c.y - p.y).abs() < 1e-9 && (p.y - 360.0).abs() < 1.0;
        assert!(ends.any(is_top), "{tolerance}: {:?}", made.contours());
    }
}

#[test]
fn no_control_point_lies_behind_its_corner() {
    // petals of two curves, more and less bulged, narrow and wide, turned
    let mut seen = 0;
    for (bulge, turn) in (1..12).flat_map(|b| (0..15).map(move |t| (b, t))) {
        let (deep, wide) = (f64::from(bulge) * 9.0, 40.0 + f64::from(turn) * 3.0);
        let svg = format!(
            "M0 0C{deep} {wide} 60 120 90 {}C70 80 {wide} 20 0 0Z",
            100.0 + deep
        );
        let map = Affine::translate((400.0, 400.0)) * angles::rotation(0.41 * f64::from(turn));
        let petal = Outline::new(vec![map * BezPath::from_svg(&svg).unwrap()]).unwrap();
        let drawn: Vec<_> = petal.contours()[0].segments().collect();
        for tolerance in [0.8, 2.0] {
            let made = Rate::default().convert(&petal, tolerance).unwrap();
            for s in made.contours()[0].segments() {
                let PathSeg::Quad(q) = s else { continue };
                for (corner, c, way) in [(q.p0, q.p1, 0.0), (q.p2, q.p1, 1.0)] {
                    let at = drawn
                        .iter()
                        .find(|d| d.eval(way).distance(corner) < tolerance);
                    let Some(at) = at else { continue };
                    let (leg, along) = (c - corner, direction(at, way) * (1.0 - 2.0 * way));
                    assert!(leg.dot(along) > 0.0, "{svg} {turn} {tolerance}: {q:?}");
                    seen += 1;
                }
            }
        }
    }
    assert!(seen > 1000, "{seen}");
}

#[test]
fn less_kept_is_fewer_bytes_and_a_larger_lambda_a_smaller_error() {
    let o = ellipse(240.0, 130.0, 0.5);
    let loose = Rate {
        keep: Strictness::Corners,
        ..Rate::default()
    };
    assert!(
        glyf_bytes(&loose.convert(&o, 1.5).unwrap())
            <= glyf_bytes(&Rate::default().convert(&o, 1.5).unwrap())
    );
    let exact = Rate {
        lambda: 40.0,
        ..Rate::default()
    };
    assert!(
        glyf_bytes(&exact.convert(&o, 1.5).unwrap())
            > glyf_bytes(&Rate::default().convert(&o, 1.5).unwrap())
    );
}

#[test]
fn a_grid_too_coarse_is_named() {
    let path = Affine::translate((0.5, 0.5)) * BezPath::from_svg("M0 0L10 0L10 10Z").unwrap();
    let err = Rate::default()
        .convert(&Outline::new(vec![path]).unwrap(), 0.5)
        .unwrap_err();
    assert!(
        err.to_string().contains("grid of whole font units"),
        "{err}"
    );
}

#[test]
fn more_points_than_a_glyph_counts_are_refused() {
    // a comb of 33,000 teeth, each a corner that stays
    let mut comb = BezPath::new();
    comb.move_to((0.0, 0.0));
    for i in 0..33_000 {
        comb.line_to((40.0 * f64::from(i), 40.0));
        comb.line_to((40.0 * f64::from(i) + 20.0, 400.0));
    }
    comb.close_path();
    let err = Rate::default()
        .convert(&Outline::new(vec![comb]).unwrap(), 1.0)
        .unwrap_err();
    assert!(err.to_string().contains("65535"), "{err}");
}

#[test]
fn nothing_degenerate_panics() {
    for svg in [
        "M0 0Z",
        "M0 0L0 0Z",
        "M0 0L5 0Z",
        "M0 0C0 0 0 0 0 0Z",
        "M0 0C9 9 9 9 0 0Z",
        "M0 0C100 0 -100 0 0 0Z",
        "M0 0Q50 0 100 0Q50 0 0 0Z",
        "M0 0L1e7 0L0 1e7Z",
    ] {
        let o = Outline::new(vec![BezPath::from_svg(svg).unwrap()]).unwrap();
        let _ = Rate::default().convert(&o, 1.0);
    }
    let all_on = Rate::default().convert(&letter(), 1.0).unwrap();
    assert!(
        all_on
            .to_path()
            .elements()
            .iter()
            .any(|e| matches!(e, PathEl::QuadTo(..)))
    );
}

#[test]
fn a_finer_em_takes_no_finer_steps() {
    let scaled = |by: f64| {
        let contours = letter();
        let contours = contours.contours().iter();
        Outline::new(contours.map(|c| Affine::scale(by) * c.clone()).collect()).unwrap()
    };
    let samples = |by: f64| {
        let keep = Rate::default().kept(2.0 * by);
        let outline = scaled(by);
        let courses = outline.contours().iter().map(|c| Course::new(c, keep));
        let of = |course: Option<Course>| match course {
            Some(Course::Spans(spans)) => {
                let curves = spans.iter().map(|(_, span, _)| match span {
                    Span::Line => 0,
                    Span::Curve(curve) => curve.dots.len(),
                });
                curves.sum()
            }
            Some(Course::Ring(curve, _)) => curve.dots.len(),
            None => 0,
        };
        courses.map(of).sum::<usize>()
    };
    assert!(
        samples(16.0) < 3 * samples(1.0),
        "{} {}",
        samples(16.0),
        samples(1.0)
    );
    for keep in [Strictness::Corners, Strictness::Extrema] {
        let rate = Rate {
            keep,
            ..Rate::default()
        };
        let fine = scaled(16.0);
        let q = rate.convert(&fine, 32.0).unwrap();
        let far = astray(&fine, &q).max(astray(&q, &fine));
        assert!(far <= 32.1, "{keep:?}: {far}");
        let usual = rate.convert(&scaled(1.0), 2.0).unwrap();
        let [fine, usual] = [q, usual].map(|q| {
            let stored = q.contours().iter().map(|c| points(c).len());
            stored.sum::<usize>()
        });
        assert!(fine <= usual + 2, "{keep:?}: {fine} {usual}");
    }
}
