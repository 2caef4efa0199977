use super::*;
use crate::numeric::{
    angles,
    cast::index,
    chain::Chain,
    coverage::{Coverage, blur},
    joins::is_soft,
};
use kurbo::{BezPath, Line, ParamCurve, Shape};
use std::iter::once;

/// The picture of a polygon through a lens.
pub(super) fn picture(ring: &[Point], size: usize, lens: f64) -> Gray {
    let mut c = Coverage::new(size, size);
    c.add(ring);
    let mut samples = c.samples();
    blur(&mut samples, size, lens, 0);
    Gray::new(size, size, samples).unwrap()
}

fn circle(centre: Point, radius: f64, n: usize) -> Vec<Point> {
    let at =
        |i: usize| centre + radius * angles::direction(std::f64::consts::TAU * i as f64 / n as f64);
    (0..n).map(at).collect()
}

/// The largest distance of points from a circle.
fn off(points: &[Point], centre: Point, radius: f64) -> f64 {
    points
        .iter()
        .map(|p| (p.distance(centre) - radius).abs())
        .fold(0.0, f64::max)
}

#[test]
fn a_disk_comes_back_to_its_radius() {
    for (lens, radius, limit) in [
        (0.0, 3.0, 0.05),
        (0.0, 9.0, 0.035),
        (0.9, 9.0, 0.02),
        (1.2, 5.0, 0.06),
    ] {
        let centre = Point::new(16.3, 15.8);
        let gray = picture(&circle(centre, radius, 720), 32, lens);
        let start = Contour::new(circle(centre, radius - 0.2, index(radius * 7.8))).unwrap();
        let start = (
            start.with_blur(Contour::PIXEL_BLUR_PX.hypot(lens)),
            Vec::new(),
        );
        let got = contours(&gray, &[start]);
        let worst = off(got[0].0.points(), centre, radius);
        assert!(worst < limit, "lens {lens}, radius {radius}: {worst}");
    }
}

#[test]
fn a_square_keeps_its_corners_where_the_sides_meet() {
    let square = [(6.3, 5.8), (26.4, 5.8), (26.4, 25.1), (6.3, 25.1)].map(Point::from);
    for lens in [0.0, 0.9] {
        let gray = picture(&square, 32, lens);
        let clear = 2.5;
        let mut points = Vec::new();
        let mut corners = Vec::new();
        for i in 0..4 {
            let (a, b) = (square[i], square[(i + 1) % 4]);
            corners.push(points.len());
            points.push(a + Vec2::new(0.3, 0.2));
            let n = 20;
            let d = a.distance(b);
            points.extend((0..=n).map(|j| {
                a.lerp(
                    b,
                    (clear + (d - 2.0 * clear) * f64::from(j) / f64::from(n)) / d,
                ) + Vec2::new(0.1, -0.1)
            }));
        }
        let start = Contour::new(points)
            .unwrap()
            .with_blur(Contour::PIXEL_BLUR_PX.hypot(lens));
        let (got, at) = contours(&gray, &[(start, corners)]).remove(0);
        for (i, want) in at.iter().zip(square) {
            assert!(
                got.points()[*i].distance(want) < 0.035,
                "lens {lens}: {:?} {want:?}",
                got.points()[*i]
            );
        }
    }
}

#[test]
fn a_hairline_keeps_its_width() {
    let line = [(4.0, 10.1), (60.0, 10.1), (60.0, 11.6), (4.0, 11.6)].map(Point::from);
    let gray = picture(&line, 64, 0.0);
    let wide = |y0: f64, y1: f64| {
        let go = (0..56).map(move |i| Point::new(4.0 + f64::from(i), y0));
        let back = (0..56).map(move |i| Point::new(60.0 - f64::from(i), y1));
        Contour::new(go.chain(back).collect()).unwrap()
    };
    let got = contours(&gray, &[(wide(10.25, 11.45), Vec::new())]);
    for p in got[0]
        .0
        .points()
        .iter()
        .filter(|p| (8.0..56.0).contains(&p.x))
    {
        let d = (p.y - 10.1).abs().min((p.y - 11.6).abs());
        assert!(d < 0.06, "{p:?}");
    }
}

#[test]
fn nothing_runs_away() {
    let centre = Point::new(16.0, 16.0);
    let start = Contour::new(circle(centre, 6.0, 40)).unwrap();
    for gray in [
        Gray::from_fn(32, 32, |_, _| 0.0),
        Gray::from_fn(32, 32, |x, y| ((x * 7 + y * 13) % 5) as f32 / 4.0),
    ] {
        let got = contours(&gray, &[(start.clone(), Vec::new())]);
        assert!(off(got[0].0.points(), centre, 6.0) <= REACH_PX + 1e-9);
    }
    assert!(contours(&Gray::from_fn(0, 0, |_, _| 0.0), &[]).is_empty());
}

/// A square whose last corner is an arc of `radius` px.
pub(super) fn rounded(radius: f64) -> BezPath {
    let mut path = BezPath::new();
    let k = 0.5523 * radius;
    path.move_to((8.2, 8.4));
    path.line_to((40.3, 8.4));
    path.line_to((40.3, 40.1 - radius));
    path.curve_to(
        (40.3, 40.1 - radius + k),
        (40.3 - radius + k, 40.1),
        (40.3 - radius, 40.1),
    );
    path.line_to((8.2, 40.1));
    path.close_path();
    path
}

pub(super) fn square() -> BezPath {
    BezPath::from_svg("M8.2 8.4L40.3 8.4L40.3 40.1L8.2 40.1Z").unwrap()
}

pub(super) fn photograph(path: &BezPath, lens: f64) -> Gray {
    picture(&curves::polygon(path, 0.001), 48, lens)
}

fn doubts(gray: &Gray, path: &BezPath, blur: f64) -> Vec<Doubts> {
    let path = std::slice::from_ref(path);
    Comparison::new(gray, path, blur).doubts(path)
}

fn settled(gray: &Gray, path: &BezPath, blur: f64) -> BezPath {
    let path = std::slice::from_ref(path);
    Comparison::new(gray, path, blur).settled(path).remove(0)
}

#[test]
fn a_short_curve_in_a_corners_place_is_doubted() {
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let doubts = doubts(&photograph(&square(), lens), &rounded(2.0), blur);
        assert!(doubts[0].round.is_empty(), "{doubts:?}");
        assert_eq!(doubts[0].sharp.len(), 1, "{doubts:?}");
        assert!(doubts[0].sharp[0].tip.distance(Point::new(40.3, 40.1)) < 1e-6);
    }
}

#[test]
fn a_corner_that_is_drawn_round_is_doubted_and_one_that_is_not_is_left() {
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let round = photograph(&rounded(5.0), lens);
        let sharp = photograph(&square(), lens);
        let at = |gray: &Gray, path: &BezPath| doubts(gray, path, blur);
        let found = at(&round, &square());
        assert_eq!(found[0].round, [Point::new(40.3, 40.1)], "lens {lens}");
        assert_eq!(at(&round, &rounded(5.0)), [Doubts::default()]);
        assert_eq!(at(&sharp, &square()), [Doubts::default()]);
    }
}

#[test]
fn a_corner_that_a_new_fit_draws_too_long_is_given_up() {
    let (tip, other) = (Point::new(40.3, 40.1), Point::new(8.2, 8.4));
    let new = Doubts {
        sharp: vec![Overlooked {
            tip,
            nodes: Vec::new(),
        }],
        ..Doubts::default()
    };
    let elsewhere = Doubts {
        round: vec![other],
        ..Doubts::default()
    };
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let (before, after) = ([rounded(5.0)], [square()]);
        let gray = photograph(&before[0], lens);
        let seen = Comparison::new(&gray, &before, blur);
        let revised = |doubts: &Doubts| seen.revised(&after, std::slice::from_ref(doubts));
        assert_eq!(revised(&new), [Doubts::default()], "lens {lens}");
        assert_eq!(revised(&elsewhere)[0].round, [other, tip], "lens {lens}");
        assert_eq!(revised(&Doubts::default()), [Doubts::default()]);
        let gray = photograph(&after[0], lens);
        let drawn = Comparison::new(&gray, &before, blur);
        let kept = drawn.revised(&after, std::slice::from_ref(&new));
        assert_eq!(kept, std::slice::from_ref(&new));
    }
}

/// A block with a wedge cut into it from above, so high.
pub(super) fn notched(tip: f64) -> BezPath {
    let text = format!("M6.2 4.3L42.1 4.3L42.1 43.6L32.2 43.6L24.1 {tip}L17.4 43.6L6.2 43.6Z");
    BezPath::from_svg(&text).unwrap()
}

#[test]
fn levels_are_those_that_the_rings_leave() {
    // a slit that the first model did not know passes for paler ink
    let slit = |tip: f64| {
        let text = format!("M6.2 4.3L42.1 4.3L42.1 43.6L25.4 43.6L24.6 {tip}L23.9 43.6L6.2 43.6Z");
        curves::polygon(&BezPath::from_svg(&text).unwrap(), 0.01)
    };
    let (drawn, short) = (slit(10.0), slit(40.0));
    let lens = 0.9;
    let gray = picture(&drawn, 48, lens);
    let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
    let left = |r: &Residual<'_>| r.squares(Point::new(24.6, 24.0), 12.0);
    let first = Residual::new(&gray, once(short.as_slice()), blur);
    let mut now = first.against(once(drawn.as_slice()));
    let before = left(&now);
    now.level(std::iter::empty());
    let after = left(&now);
    let known = left(&Residual::new(&gray, once(drawn.as_slice()), blur));
    assert!(after < 0.05 * before, "{before} {after}");
    assert!((after - known).abs() < 1e-6, "{after} {known}");
    // nor does it where that model says that it may go on
    let mut doubted = first.against(once(short.as_slice()));
    let before = left(&doubted);
    doubted.level(once(Line::new((24.6, 40.0), (24.6, 10.0))));
    let after = left(&doubted);
    assert!(after > 1.3 * before, "{before} {after}");
}

#[test]
fn a_part_that_is_drawn_again_is_that_of_the_whole() {
    let before = [square(), rounded(9.0)];
    let after = [notched(15.0), rounded(9.0)];
    let ring = |p: &BezPath| {
        let mut ring = curves::polygon(p, 0.01);
        ring.extend(ring.first().copied());
        (p.bounding_box(), ring)
    };
    let rings = |paths: &[BezPath]| paths.iter().map(ring).collect::<Vec<_>>();
    let [old, new] = [rings(&before), rings(&after)];
    for lens in [0.0, 0.9] {
        let gray = photograph(&before[0], lens);
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let first = Residual::new(&gray, old.iter().map(|r| r.1.as_slice()), blur);
        let mut redrawn = first.against(old.iter().map(|r| r.1.as_slice()));
        let whole = first.against(new.iter().map(|r| r.1.as_slice()));
        let changed = old[0].0.union(new[0].0);
        redrawn.redraw(changed, new.iter().map(|r| (r.0, r.1.as_slice())));
        for at in circle(Point::new(24.0, 24.0), 20.0, 60) {
            let [a, b] = [&redrawn, &whole].map(|r| r.squares(at, 4.0));
            assert!((a - b).abs() < 1e-4, "lens {lens}, {at}: {a} {b}");
        }
        // nothing changes where nothing is, on the picture's side or far from it
        for corner in [(-90.0, -90.0), (46.0, 46.0), (56.0, 56.0), (1e30, 1e30)] {
            let side = kurbo::Rect::from_origin_size(corner, (3.0, 3.0));
            let grown = redrawn.redraw(side, new.iter().map(|r| (r.0, r.1.as_slice())));
            assert!(grown.abs() < 1e-6, "lens {lens}, {corner:?}: {grown}");
        }
    }
}

#[test]
fn a_run_is_met_wherever_the_path_begins() {
    let picture = photograph(&square(), 0.9);
    let segments: Vec<_> = rounded(2.0).segments().collect();
    for start in 0..segments.len() {
        let turned = segments.iter().cycle().skip(start).take(segments.len());
        let mut path = BezPath::from_path_segments(turned.copied());
        path.close_path();
        let found = doubts(&picture, &path, Contour::PIXEL_BLUR_PX.hypot(0.9));
        assert_eq!(found[0].sharp.len(), 1, "from segment {start}");
    }
}

#[test]
fn nodes_go_where_the_picture_has_them() {
    let truth = "M8.2 8.4L40.3 8.4C40.3 22.4 30.1 40.1 8.2 40.1Z";
    let start = "M8.6 8.1L39.9 8.2C40.5 22.1 30.2 40.4 8.5 40.5Z";
    let [truth, start] = [truth, start].map(|s| BezPath::from_svg(s).unwrap());
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let got = settled(&photograph(&truth, lens), &start, blur);
        let places = |p: &BezPath| p.segments().map(|s| s.start()).collect::<Vec<_>>();
        let (before, after, want) = (places(&start), places(&got), places(&truth));
        for (k, want) in want.iter().enumerate() {
            // each comparison leaves some two thirds of a corner's error
            let left = 0.35 * before[k].distance(*want);
            assert!(
                after[k].distance(*want) < left,
                "lens {lens}: {:?} {want:?}",
                after[k]
            );
        }
    }
}

#[test]
fn a_node_that_would_go_far_holds_no_other_back() {
    // the notch goes eight px deeper, and the foot lies aside
    let truth = "M8.2 8.4L40.3 8.4L40.3 40.1L27.2 40.1L24.2 16.4L21.2 40.1L8.2 40.1Z";
    let start = "M8.6 8.1L39.9 8.2L40.1 40.4L27.4 40.2L24.2 24.4L21.1 39.9L8.5 40.5Z";
    let [truth, start] = [truth, start].map(|s| BezPath::from_svg(s).unwrap());
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let got = settled(&photograph(&truth, lens), &start, blur);
        let place = |path: &BezPath, i: usize| path.segments().nth(i).unwrap().start();
        for i in [0, 1, 2, 6] {
            let [before, after] = [&start, &got].map(|p| place(p, i).distance(place(&truth, i)));
            assert!(after < 0.6 * before, "lens {lens}: {before} {after}");
        }
        assert!(place(&got, 4).distance(place(&start, 4)) <= 2.0);
    }
}

#[test]
fn no_node_goes_far_where_the_picture_tells_nothing() {
    for gray in [
        Gray::from_fn(48, 48, |_, _| 0.0),
        Gray::from_fn(48, 48, |x, y| ((x * 7 + y * 13) % 5) as f32 / 4.0),
    ] {
        let start = rounded(5.0);
        let got = settled(&gray, &start, 0.6);
        let pairs = got.segments().zip(start.segments());
        for (a, b) in pairs {
            assert!(a.start().distance(b.start()) <= 2.0 + 1e-9);
        }
    }
    let gray = Gray::from_fn(0, 0, |_, _| 0.0);
    let nothing = Comparison::new(&gray, &[], 0.6);
    assert!(nothing.settled(&[]).is_empty());
}

#[test]
fn a_ring_of_more_chords_than_any_letters_stays() {
    let square = [(8.2, 8.4), (40.3, 8.4), (40.3, 40.1), (8.2, 40.1)].map(Point::from);
    let gray = picture(&square, 48, 0.9);
    let blur = Contour::PIXEL_BLUR_PX.hypot(0.9);
    for (chords, moves) in [(4, true), (nodes::RING_CHORDS + 4, false)] {
        let mut path = BezPath::from_svg("M8.6 8.7").unwrap();
        for k in 1..chords {
            let (side, t) = (4 * k / chords, (4.0 * k as f64 / chords as f64).fract());
            let [a, b] = [square[side], square[(side + 1) % 4]];
            path.line_to(a.lerp(b, t) + Vec2::new(0.4, 0.3));
        }
        path.close_path();
        let paths = [path];
        let seen = Comparison::new(&gray, &paths, blur);
        assert_eq!(seen.settled(&paths) != paths, moves, "{chords} settle");
        assert_eq!(seen.mended(&paths).0 != paths, moves, "{chords} mended");
    }
}

#[test]
fn a_join_that_turns_too_little_for_a_corner_is_smooth_once_places_are_mended() {
    let arch = |degrees: f64, handle: f64| {
        let (x, y) = (40.3, 28.1);
        let along = handle * angles::direction((90.0 + degrees).to_radians());
        let mut path = BezPath::from_svg("M28.3 40.1L8.2 40.1L8.2 8.4").unwrap();
        path.line_to((40.3, 8.4));
        path.line_to((x, y));
        path.curve_to((x + along.x, y + along.y), (34.9, 40.1), (28.3, 40.1));
        path.close_path();
        path
    };
    for lens in [0.0, 0.9] {
        for degrees in [5.0, 10.0, 15.0, 20.0] {
            let gray = photograph(&arch(degrees, 6.6), lens);
            let fit = [arch(40.0, 1.0)];
            let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
            let (got, _) = Comparison::new(&gray, &fit, blur).mended(&fit);
            let chain = Chain::from_path(&got[0], 1e-3).unwrap();
            let soft = (0..chain.nodes.len()).find(|i| is_soft(&chain, *i));
            assert_eq!(soft, None, "{degrees}, lens {lens}: {}", got[0].to_svg());
        }
    }
}
