//! Drawings with a known edge through the whole trace: where their outlines run, and what they never do.

use khatt::numeric::angles;
use khatt::numeric::cast::single;
use khatt::numeric::coverage::blur;
use khatt::pipeline::picture::{Options, trace_picture};
use khatt::scan::InkStreaks;
use khatt::trace::{self, Edges};
use khatt::types::Gray;
use khatt::write::picture::to_picture;
use kurbo::{Affine, BezPath, ParamCurve, ParamCurveArclen, PathEl, PathSeg, Point, Shape, Vec2};

/// A picture of `side` px squared, y down, of the points where `distance` is below 0; 8 × 8 samples a pixel.
fn picture(side: usize, distance: impl Fn(Point) -> f64) -> Gray {
    Gray::from_fn(side, side, |x, y| {
        let at = |p: usize, i: u16| p as f64 + (f64::from(i) + 0.5) / 8.0;
        let inside = |i: &u16| distance(Point::new(at(x, i % 8), at(y, i / 8))) < 0.0;
        (0..64).filter(inside).count() as f32 / 64.0
    })
}

/// Outlines in the picture's own space, y down.
fn outlines(gray: &Gray) -> Vec<BezPath> {
    traced(gray, &Options::default())
}

fn traced(gray: &Gray, options: &Options) -> Vec<BezPath> {
    let flip = to_picture(gray.height());
    let traced = trace_picture(gray, InkStreaks::default(), options);
    let paths = traced.expect("default options are in their ranges").paths;
    paths.iter().map(|p| flip * p).collect()
}

/// Points along a path, a quarter of a pixel apart.
fn points(path: &BezPath) -> Vec<Point> {
    let along = |s: PathSeg| {
        let n = (s.arclen(0.1) * 4.0).ceil().max(1.0);
        let steps = (0..).map(f64::from).take_while(move |i| *i < n);
        steps.map(move |i| s.eval(i / n))
    };
    path.segments().flat_map(along).collect()
}

/// The largest distance of outlines from the drawn edge.
fn off(paths: &[BezPath], distance: impl Fn(Point) -> f64) -> f64 {
    let all = paths.iter().flat_map(points);
    all.map(|p| distance(p).abs()).fold(0.0, f64::max)
}

/// Turns at the nodes of a path, degrees.
fn turns(path: &BezPath) -> Vec<f64> {
    let way = |s: &PathSeg, from: f64, to: f64| {
        let d = s.eval(to) - s.eval(from);
        d / d.hypot().max(1e-12)
    };
    let all: Vec<PathSeg> = path.segments().filter(|s| s.arclen(0.1) > 1e-6).collect();
    let before = all.iter().cycle().skip(all.len() - 1);
    let pairs = all.iter().zip(before);
    let turn = |(b, a): (&PathSeg, &PathSeg)| {
        let (u, v) = (way(a, 1.0 - 1e-4, 1.0), way(b, 0.0, 1e-4));
        libm::atan2(u.cross(v), u.dot(v)).abs().to_degrees()
    };
    pairs.map(turn).collect()
}

fn nodes(path: &BezPath) -> usize {
    path.segments().filter(|s| s.arclen(0.1) > 1e-6).count()
}

/// Distance from a box of half sides `half` around `centre` with rounded corners.
fn rounded(p: Point, centre: Point, half: f64, radius: f64) -> f64 {
    let d = p - centre;
    let q = Vec2::new(d.x.abs() - half + radius, d.y.abs() - half + radius);
    let outside = Vec2::new(q.x.max(0.0), q.y.max(0.0)).hypot();
    outside + q.x.max(q.y).min(0.0) - radius
}

const CENTRE: Point = Point::new(48.3, 47.8);

/// A picture under a lens of `sigma` px, in greys that scatter by a hundredth.
fn out_of_focus(gray: &Gray, sigma: f64) -> Gray {
    let mut samples = gray.samples().to_vec();
    blur(&mut samples, gray.width(), sigma, 0);
    let grain = (0_u32..).map(|i| (i.wrapping_mul(2_654_435_761) >> 16) as f32 / 65536.0 - 0.5);
    let grainy = samples.iter().zip(grain).map(|(v, g)| v + 0.035 * g);
    gray.with_samples(grainy.collect())
}

#[test]
fn a_picture_out_of_focus_is_no_other_drawing() {
    let middle = Point::new(127.7, 130.2);
    // corners, rounds, and both
    let ring = |p: Point| (p.distance(middle) - 70.4).abs() - 22.3;
    let square = |p: Point| rounded(p, middle, 80.3, 0.0);
    let shapes: [&dyn Fn(Point) -> f64; 4] =
        [&square, &|p| rounded(p, middle, 80.3, 30.0), &ring, &|p| {
            ring(p).max(middle.y - p.y)
        }];
    for (i, shape) in shapes.into_iter().enumerate() {
        let sharp = picture(256, shape);
        let wanted: Vec<usize> = outlines(&sharp).iter().map(nodes).collect();
        for sigma in [2.2, 3.1, 4.6, 6.2] {
            let got = outlines(&out_of_focus(&sharp, sigma));
            let seen: Vec<usize> = got.iter().map(nodes).collect();
            let surplus = seen.iter().zip(&wanted).map(|(s, w)| s.abs_diff(*w));
            let off = off(&got, shape);
            let case = format!(
                "shape {i}, a blur of {sigma} px: nodes {seen:?} for {wanted:?}, {off} px off"
            );
            assert!(
                seen.len() == wanted.len() && surplus.sum::<usize>() <= 1,
                "{case}"
            );
            assert!(off < 0.2 * sigma, "{case}");
        }
    }
}

#[test]
fn a_disk_has_its_extrema() {
    let disk = |p: Point| p.distance(CENTRE) - 36.4;
    let got = outlines(&picture(96, disk));
    assert_eq!((got.len(), nodes(&got[0])), (1, 4));
    assert!(off(&got, disk) < 0.05, "{}", off(&got, disk));
    for s in got[0].segments() {
        let d = s.start() - CENTRE;
        assert!(d.x.abs().min(d.y.abs()) < 0.1, "{d:?}");
    }
}

#[test]
fn a_square_has_four_lines() {
    let square = |p: Point| rounded(p, CENTRE, 30.2, 0.0);
    let got = outlines(&picture(96, square));
    assert_eq!((got.len(), nodes(&got[0])), (1, 4));
    assert!(got[0].segments().all(|s| matches!(s, PathSeg::Line(_))));
    assert!(off(&got, square) < 0.03, "{}", off(&got, square));
}

#[test]
fn a_rounded_square_has_no_corner() {
    let drawn = |p: Point| rounded(p, CENTRE, 36.2, 12.0);
    let got = outlines(&picture(96, drawn));
    assert!(off(&got, drawn) < 0.1, "{}", off(&got, drawn));
    assert!(nodes(&got[0]) <= 8, "{}", nodes(&got[0]));
    assert!(turns(&got[0]).iter().all(|t| *t < 1.0));
}

#[test]
fn a_cusp_keeps_its_tip() {
    // a drop: a disk and the two tangents from a point
    let tip = Point::new(48.3, 8.2);
    let (centre, radius) = (Point::new(48.3, 64.0), 22.0);
    let half = libm::asin(radius / tip.distance(centre));
    let inside = |p: Point| {
        let d = p - tip;
        let wedge = libm::atan2(d.x, d.y).abs() < half
            && d.dot(d) < (centre - tip).hypot2() - radius * radius;
        p.distance(centre) < radius || wedge
    };
    let got = outlines(&picture(96, |p| if inside(p) { -1.0 } else { 1.0 }));
    assert_eq!(got.len(), 1);
    let sharp = turns(&got[0]).iter().filter(|t| **t > 40.0).count();
    assert_eq!(sharp, 1, "{:?}", turns(&got[0]));
    let top = got[0].bounding_box().min_y();
    assert!((top - tip.y).abs() < 0.5, "{top}");
}

#[test]
fn an_s_is_smooth() {
    // a wave with rounded ends
    let wave = |x: f64| Point::new(x, 48.0 + 20.0 * libm::sin(x / 11.0));
    let spine: Vec<Point> = (0..=720)
        .map(|i| wave(12.0 + f64::from(i) / 10.0))
        .collect();
    let stroke = |p: Point| {
        let d = spine
            .iter()
            .map(|q| p.distance_squared(*q))
            .fold(f64::INFINITY, f64::min);
        d.sqrt() - 5.3
    };
    let got = outlines(&picture(96, stroke));
    assert_eq!(got.len(), 1);
    assert!(off(&got, stroke) < 0.15, "{}", off(&got, stroke));
    assert!(
        turns(&got[0]).iter().all(|t| *t < 1.0),
        "{:?}",
        turns(&got[0])
    );
    assert!(nodes(&got[0]) <= 24, "{}", nodes(&got[0]));
}

#[test]
fn hairlines_keep_their_width() {
    let (a, b) = (Point::new(10.0, 20.0), Point::new(84.0, 71.0));
    let along = (b - a) / (b - a).hypot();
    let line = |p: Point| {
        let d = p - a;
        let (x, y) = (d.dot(along), d.cross(along));
        (y.abs() - 0.75).max(-x).max(x - (b - a).hypot())
    };
    let got = outlines(&picture(96, line));
    assert_eq!(got.len(), 1);
    let width = got[0].area().abs() / (b - a).hypot();
    assert!((width - 1.5).abs() < 0.1, "{width}");
}

/// Part of a step's height that a lens leaves at distance `d` px inside of it; nearly a Gaussian of 0.95 px, the
/// pixel's box included.
fn step(d: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-1.702 * d / 0.95))
}

#[test]
fn a_scanned_line_thinner_than_a_pixel_keeps_its_width() {
    // beside a disk, which tells what ink is
    let (a, b) = (Point::new(12.0, 30.0), Point::new(90.0, 71.0));
    let along = (b - a) / (b - a).hypot();
    for width in [0.7, 1.0, 1.3] {
        let gray = Gray::from_fn(120, 96, |x, y| {
            let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
            let (u, v) = ((p - a).dot(along), (p - a).cross(along));
            let line = (step(v + width / 2.0) - step(v - width / 2.0))
                * (step(u) - step(u - (b - a).hypot()));
            let disk = step(14.0 - p.distance(Point::new(96.0, 22.0)));
            single(0.1 + 0.75 * (line + disk))
        });
        let got = outlines(&gray);
        assert_eq!(got.len(), 2, "{width}");
        let areas = got.iter().map(|p| p.area().abs());
        let line = areas.fold(f64::INFINITY, f64::min) / (b - a).hypot();
        assert!((line - width).abs() < 0.12, "{width}: {line}");
    }
}

#[test]
fn a_thin_pen_keeps_its_width_in_ink_of_any_level() {
    let middle = Point::new(47.6, 48.3);
    for width in [2.6, 3.3, 4.1] {
        let sharp = picture(96, |p| (p.distance(middle) - 27.4).abs() - width / 2.0);
        let mut seen = sharp.samples().to_vec();
        blur(&mut seen, 96, 0.9, 0);
        for ink in [0.6, 0.8, 1.0] {
            let gray = sharp.with_samples(seen.iter().map(|v| 0.1 + (ink - 0.1) * v).collect());
            let got = outlines(&gray);
            assert_eq!(got.len(), 2, "{width} {ink}");
            let area: f64 = got.iter().map(Shape::area).sum();
            let found = area.abs() / (std::f64::consts::TAU * 27.4);
            assert!((found - width).abs() < 0.15, "{width} {ink}: {found}");
        }
    }
}

#[test]
fn what_almost_touches_stays_apart() {
    let (a, b) = (Point::new(27.1, 48.0), Point::new(68.3, 48.0));
    let both = |p: Point| (p.distance(a) - 20.0).min(p.distance(b) - 20.0);
    let got = outlines(&picture(96, both));
    assert_eq!(got.len(), 2, "the gap is 1.2 px");
    assert!(off(&got, both) < 0.25, "{}", off(&got, both));
    let [left, right] = [&got[0], &got[1]].map(|p| p.bounding_box());
    assert!(left.max_x().min(right.max_x()) < left.min_x().max(right.min_x()));
}

#[test]
fn a_contour_of_six_pixels_is_there() {
    let dot = |p: Point| p.distance(Point::new(12.4, 11.7)) - 3.0;
    let got = outlines(&picture(24, dot));
    assert_eq!(got.len(), 1);
    assert!(off(&got, dot) < 0.15, "{}", off(&got, dot));
}

/// A shape with curves, corners and lines, moved by `by`.
fn leaf(p: Point, by: Vec2) -> f64 {
    let p = p - by;
    let lens =
        (p.distance(Point::new(20.0, 48.0)) - 46.0).max(p.distance(Point::new(70.0, 40.0)) - 46.0);
    lens.max(p.y - 70.0)
}

#[test]
fn a_shift_shifts() {
    let still = outlines(&picture(96, |p| leaf(p, Vec2::ZERO)));
    for by in [(0.37, 0.21), (0.5, 0.5), (0.81, 0.09)] {
        let by = Vec2::from(by);
        let moved = outlines(&picture(96, |p| leaf(p, by)));
        assert_eq!(nodes(&moved[0]), nodes(&still[0]), "{by:?}");
        let off = off(&moved, |p| leaf(p, by));
        assert!(off < 0.25, "{by:?}: {off}");
    }
}

#[test]
fn a_quarter_turn_turns() {
    let gray = picture(96, |p| leaf(p, Vec2::ZERO));
    let turned = Gray::from_fn(96, 96, |x, y| gray.at(y, 95 - x));
    let (a, b) = (outlines(&gray), outlines(&turned));
    // (x, y) came from (y, 96 − x): back again
    let back = Affine::new([0.0, -1.0, 1.0, 0.0, 0.0, 96.0]);
    let b: Vec<BezPath> = b.iter().map(|p| back * p).collect();
    assert_eq!(nodes(&a[0]), nodes(&b[0]));
    let near = |p: &Point| {
        points(&b[0])
            .iter()
            .map(|q| q.distance(*p))
            .fold(f64::INFINITY, f64::min)
    };
    let worst = points(&a[0]).iter().map(near).fold(0.0, f64::max);
    // the points along both are a quarter of a pixel apart
    assert!(worst < 0.25, "{worst}");
}

#[test]
fn the_level_moves_outlines_by_little() {
    let gray = picture(96, |p| leaf(p, Vec2::ZERO));
    let at = |level: f64| {
        let mut options = Options::default();
        options.trace.level = level;
        let area: f64 = traced(&gray, &options).iter().map(Shape::area).sum();
        area.abs()
    };
    let edge = outlines(&gray)[0].perimeter(0.1);
    for level in [0.4, 0.45, 0.5, 0.55] {
        let moved = (at(level) - at(level + 0.02)).abs() / edge;
        assert!(moved < 0.05, "{level}: {moved} px");
    }
}

/// A blob of some waves around a circle.
fn blob(p: Point, seed: u32) -> f64 {
    let d = p - Point::new(48.0, 48.0);
    let phase = f64::from(seed) * 1.7;
    let waves = [
        (2.0, 4.0),
        (3.0, 3.0),
        (5.0, 2.0),
        (7.0, f64::from(seed % 3)),
    ];
    let bumps: f64 = waves
        .iter()
        .map(|(k, a)| a * libm::sin(k * angles::heading(d) + phase * k))
        .sum();
    d.hypot() - 30.0 - bumps
}

#[test]
fn outlines_do_not_cross_themselves() {
    for seed in 0..12 {
        let gray = picture(96, |p| blob(p, seed));
        for path in outlines(&gray) {
            let mut ring = Vec::new();
            kurbo::flatten(&path, 0.05, |el| match el {
                PathEl::MoveTo(p) | PathEl::LineTo(p) => ring.push(p),
                _ => {}
            });
            assert_eq!(crossings(&ring), 0, "{seed}");
        }
    }
}

/// Pairs of edges of a ring that cross, neighbours left out.
fn crossings(ring: &[Point]) -> usize {
    let edges: Vec<(Point, Point)> = ring
        .iter()
        .copied()
        .zip(ring.iter().copied().cycle().skip(1))
        .collect();
    let side = |a: Point, b: Point, p: Point| (b - a).cross(p - a);
    let cross = |(a, b): (Point, Point), (c, d): (Point, Point)| {
        side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
    };
    let pairs = (0..edges.len()).flat_map(|i| (i + 2..edges.len()).map(move |j| (i, j)));
    pairs.filter(|&(i, j)| cross(edges[i], edges[j])).count()
}

#[test]
fn no_ink_is_lost() {
    // disks of 1.3 to 4.3 px, on a jittered grid, all above the speckle limit of 4 px²
    let dots: Vec<(Point, f64)> = (0..36_u32)
        .map(|i| {
            let jitter = |k: u32| f64::from((i * k) % 17) / 17.0;
            let at = Point::new(
                10.0 + 15.0 * f64::from(i % 6) + jitter(5),
                10.0 + 15.0 * f64::from(i / 6) + jitter(11),
            );
            (at, 1.3 + 3.0 * jitter(7))
        })
        .collect();
    let ink = |p: Point| {
        dots.iter()
            .map(|(c, r)| p.distance(*c) - r)
            .fold(f64::INFINITY, f64::min)
    };
    let got = outlines(&picture(96, ink));
    assert_eq!(got.len(), dots.len());
    for (c, r) in dots {
        let here = got.iter().filter(|p| p.winding(c) != 0).count();
        assert_eq!(here, 1, "a disk of {r} px at {c}");
    }
}

/// How far ink runs along paper's fibres at a place, px: in blots of 2 and of 6 px.
fn fibres(p: Point) -> f64 {
    let blots = |px: f64, salt: u64| {
        let (x, y) = (p.x / px, p.y / px);
        let at = |i: f64, j: f64| {
            let mixed = (i.to_bits() ^ j.to_bits().rotate_left(29) ^ salt)
                .wrapping_mul(0x9e37_79b9_7f4a_7c15);
            f64::from((mixed >> 40) as u32) / f64::from(1_u32 << 23) - 1.0
        };
        let (i, j) = (x.floor(), y.floor());
        let (u, v) = (x - i, y - j);
        let row = |j: f64| at(i, j) * (1.0 - u) + at(i + 1.0, j) * u;
        row(j) * (1.0 - v) + row(j + 1.0) * v
    };
    blots(2.0, 1) + 0.8 * blots(6.0, 2)
}

#[test]
fn ragged_ink_is_drawn_as_smoothly_as_it_was_meant() {
    let drawn = |p: Point| rounded(p, Point::new(100.3, 99.8), 70.2, 25.0);
    let gray = out_of_focus(&picture(200, |p| drawn(p) + fibres(p)), 0.5);
    let kept = Options {
        trace: trace::Options {
            edges: Edges::Keep,
            ..trace::Options::default()
        },
        ..Options::default()
    };
    let (found, kept) = (outlines(&gray), traced(&gray, &kept));
    assert_eq!((found.len(), kept.len()), (1, 1));
    let mean = |path: &BezPath| {
        let all = points(path);
        all.iter().map(|p| drawn(*p).abs()).sum::<f64>() / all.len() as f64
    };
    let (smooth, ragged) = (&found[0], &kept[0]);
    assert!(nodes(smooth) <= 16, "{} nodes of 8", nodes(smooth));
    assert!(
        nodes(ragged) >= 2 * nodes(smooth),
        "{} nodes kept",
        nodes(ragged)
    );
    assert!(
        mean(smooth) < 0.7 * mean(ragged),
        "{} {}",
        mean(smooth),
        mean(ragged)
    );
}

/// A picture of two levels: each pixel is what its middle is.
fn two_levels(side: usize, distance: impl Fn(Point) -> f64) -> Gray {
    let middle = |x: usize, y: usize| Point::new(x as f64 + 0.5, y as f64 + 0.5);
    Gray::from_fn(side, side, |x, y| {
        f32::from(u8::from(distance(middle(x, y)) < 0.0))
    })
}

#[test]
fn the_steps_of_two_levels_are_no_drawing() {
    let disk = |p: Point| p.distance(Point::new(100.3, 99.8)) - 80.2;
    let found = outlines(&two_levels(200, disk));
    assert!(off(&found, disk) < 0.5, "{}", off(&found, disk));
    assert_eq!(turns(&found[0]).len(), 4, "nodes of a disk");
    for deg in [-3.0, 1.0, 2.0, 20.0] {
        // a stem aslant, whose sides run in steps of 3 to 60 px
        let stem = |p: Point| {
            let to = angles::direction(f64::to_radians(deg));
            let from = p - Point::new(100.2, 99.9);
            let (x, y) = (from.dot(to).abs() - 21.3, from.cross(to).abs() - 80.6);
            x.max(y).min(0.0) + Vec2::new(x.max(0.0), y.max(0.0)).hypot()
        };
        let found = outlines(&two_levels(200, stem));
        assert_eq!(
            turns(&found[0]).len(),
            4,
            "nodes of a stem at {deg} degrees"
        );
        assert!(off(&found, stem) < 1.0, "{} at {deg}", off(&found, stem));
    }
}

#[test]
fn pictures_of_a_few_columns_in_two_levels_end() {
    for (width, height, seed) in (1..12).flat_map(|w| (8..28).map(move |h| (w, h, w * 31 + h))) {
        let ink = |x: usize, y: usize| {
            let mixed = (x + 1) * 2_654_435 + (y + 1) * 40_503 * (seed + 7);
            f32::from(u8::from((mixed ^ (mixed >> 7)) % 5 > seed % 4))
        };
        let picture = Gray::from_fn(width, height, ink);
        let paths = outlines(&picture);
        assert!(paths.iter().all(BezPath::is_finite), "{width} × {height}");
    }
}

/// A stem on a foot whose serifs are as short as three to four of the lens' deviations.
#[test]
fn short_serifs_are_not_cut_off() {
    let lost = |k: &u32| {
        let k = f64::from(*k);
        let serif = 3.0 + 0.1 * (k % 11.0);
        let middle = CENTRE + Vec2::new(0.13 * k % 1.0, 0.29 * k % 1.0);
        let turn = angles::rotation_about((7.0 * k % 5.0 - 2.0).to_radians(), middle);
        let distance = |p: Point| {
            let d = turn.inverse() * p - middle;
            let stem = (d.x.abs() - 2.1).max(d.y.abs() - 18.0);
            let foot = Vec2::new((d.x.abs() - 2.1 - serif + 0.7).max(0.0), d.y - 17.2);
            stem.min(foot.hypot() - 0.8)
        };
        let paths = outlines(&out_of_focus(&picture(96, distance), 0.9));
        let inside = |p: Point| paths.iter().map(|path| path.winding(p)).sum::<i32>() != 0;
        let serifs = [-1.0, 1.0].map(|side| (side * (2.1 + 0.6 * serif), 17.2));
        serifs
            .iter()
            .any(|s| !inside(turn * (middle + Vec2::from(*s))))
    };
    // of 1100 of them, those others that had lost one
    let others = [228, 230, 305, 352, 427, 494, 589, 592, 654, 845, 970];
    let all = (0..55).chain(others);
    assert_eq!(all.filter(lost).collect::<Vec<_>>(), [0_u32; 0]);
}
