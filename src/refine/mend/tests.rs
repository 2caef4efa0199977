use super::{
    Ring, SMOOTH, Work,
    bends::{is_cornered, tight_bends},
    budget::Budget,
    ends::{is_blunt, square as squared},
    part::{begun_at, changed, open_part},
    tangle::Crossing,
    tips::{ONE_PX, is_needle, trimmed},
    variants::variants,
};
use crate::{
    numeric::{
        chain::{Chain, Node},
        coverage::blur,
        iso,
        joins::inner_extrema,
    },
    refine::{
        Comparison,
        curves::polygon,
        residual::Residual,
        tests::{notched, photograph, picture, rounded, square},
    },
    types::{Contour, Gray},
};
use kurbo::{Affine, BezPath, ParamCurve, ParamCurveNearest, PathSeg, Point, Rect, Shape};

/// The largest distance of two closed paths.
fn apart(a: &BezPath, b: &BezPath) -> f64 {
    let off = |a: &BezPath, b: &BezPath| {
        let to = |p: Point| {
            let each = b.segments().map(|s| s.nearest(p, 1e-6).distance_sq);
            each.fold(f64::INFINITY, f64::min).sqrt()
        };
        polygon(a, 0.01).into_iter().map(to).fold(0.0, f64::max)
    };
    off(a, b).max(off(b, a))
}

fn mended(gray: &Gray, path: &BezPath, blur: f64) -> BezPath {
    let path = std::slice::from_ref(path);
    Comparison::new(gray, path, blur).mended(path).0.remove(0)
}

#[test]
fn a_wrong_structure_gives_way_to_the_one_drawn() {
    let cut = BezPath::from_svg("M8.2 8.4L40.3 8.4L40.3 36.6L37.1 40.1L8.2 40.1Z").unwrap();
    for (name, drawn, fit) in [
        ("a corner for an arc", rounded(3.5), square()),
        ("a corner for a chamfer", cut.clone(), square()),
        ("a chamfer for a corner", square(), cut),
        ("a tip too far out", notched(15.0), notched(12.0)),
    ] {
        for lens in [0.0, 0.9] {
            let gray = photograph(&drawn, lens);
            let got = mended(&gray, &fit, Contour::PIXEL_BLUR_PX.hypot(lens));
            let off = apart(&got, &drawn);
            // what squares too small to be looked at leave of a tip
            assert!(off < 0.45, "{name}, lens {lens}: {off} {}", got.to_svg());
            // a node more may be left where it does not show
            let [got, drawn] = [&got, &drawn].map(|p| p.segments().count());
            assert!(got <= drawn + 1, "{name}, lens {lens}: {got} {drawn}");
        }
    }
}

#[test]
fn a_bend_that_no_lens_tells_from_a_corner_becomes_one() {
    let corners = |path: &BezPath| {
        let chain = Chain::from_path(path, SMOOTH).unwrap();
        chain.nodes.iter().filter(|n| !n.join.is_smooth()).count()
    };
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let sharp = mended(&photograph(&square(), lens), &rounded(0.6), blur);
        let off = apart(&sharp, &square());
        assert!(
            off < 0.05 && corners(&sharp) == 4,
            "{off} {}",
            sharp.to_svg()
        );
        for radius in [1.5, 2.5] {
            let drawn = rounded(radius);
            let round = mended(&photograph(&drawn, lens), &drawn, blur);
            let off = apart(&round, &drawn);
            assert!(
                off < 0.05 && corners(&round) == 3,
                "{off} {}",
                round.to_svg()
            );
        }
    }
}

#[test]
fn lines_are_on_an_axis_where_the_picture_allows_it() {
    let quad = |off: f64| {
        let (right, top, left) = (40.3 - off, 40.1 + off, 8.2 + off);
        let text = format!("M8.2 8.4L40.3 {}L{right} 40.1L{left} {top}Z", 8.4 + off);
        BezPath::from_svg(&text).unwrap()
    };
    let on_axis = |path: &BezPath| {
        let ways = path.segments().map(|s| s.end() - s.start());
        ways.filter(|w| w.x == 0.0 || w.y == 0.0).count()
    };
    let mut seed = 1_u32;
    let mut grain = |gray: &Gray, amount: f32| {
        let noisy = gray.samples().iter().map(|v| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            v + amount * ((seed >> 8) as f32 / 16_777_216.0 - 0.5)
        });
        gray.with_samples(noisy.collect())
    };
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let clean = photograph(&quad(0.0), lens);
        let noisy = grain(&clean, 0.1);
        // ends as grain leaves them
        assert_eq!(on_axis(&mended(&clean, &quad(0.01), blur)), 4);
        assert_eq!(on_axis(&mended(&noisy, &quad(0.1), blur)), 4);
        // drawn aslant
        let slanted = mended(&photograph(&quad(0.2), lens), &quad(0.2), blur);
        assert_eq!(on_axis(&slanted), 0);
        assert!(apart(&slanted, &quad(0.2)) < 0.02);
        let noisy = grain(&photograph(&quad(0.7), lens), 0.1);
        assert_eq!(on_axis(&mended(&noisy, &quad(0.7), blur)), 0);
    }
}

#[test]
fn a_path_bends_tightly_where_it_is_nearly_a_corner() {
    let tight = |path: &BezPath| {
        let chain = Chain::from_path(path, SMOOTH).unwrap();
        let mut chords = polygon(path, 0.001);
        chords.push(chords[0]);
        tight_bends(&chain, &chords)
    };
    let [bend] = tight(&rounded(1.0))[..] else {
        panic!("one bend")
    };
    assert!(bend.distance(Point::new(40.3, 40.1)) < 0.7, "{bend}");
    assert!(tight(&rounded(6.0)).is_empty() && tight(&square()).is_empty());
    // rings that are shorter than two bends, or a single place
    for small in ["M2 2L4 2L4 4Z", "M2 2L2 2Z"] {
        let chain = Chain::from_path(&BezPath::from_svg(small).unwrap(), SMOOTH);
        assert!(chain.is_none_or(|c| tight_bends(&c, &[Point::ORIGIN]).is_empty()));
    }
}

#[test]
fn a_tip_that_was_cut_short_comes_out_again() {
    let spike = |tip: &str| {
        let text = format!("M6.2 4.3L42.1 4.3L42.1 20.6L27.1 20.6L{tip}L21.4 20.6L6.2 20.6Z");
        BezPath::from_svg(&text).unwrap()
    };
    for (lens, limit) in [(0.0, 1.2), (0.9, 2.0)] {
        let drawn = spike("24.1 44.2");
        let gray = photograph(&drawn, lens);
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let got = mended(&gray, &spike("24.6 37.1"), blur);
        let off = apart(&got, &drawn);
        // of seven px; the squares of the last ones are too small to be looked at
        assert!(off < limit, "lens {lens}: {off} {}", got.to_svg());
    }
}

#[test]
fn a_tip_of_which_hardly_a_pixel_tells_comes_where_it_is_drawn() {
    let wedge = |tip: &str| BezPath::from_svg(&format!("M8.2 18.1L{tip}L8.2 26.7Z")).unwrap();
    let drawn = wedge("40.3 22.4");
    for short in ["39.3 22.4", "39.6 22.4"] {
        for lens in [0.0, 0.9] {
            let gray = photograph(&drawn, lens);
            let got = mended(&gray, &wedge(short), Contour::PIXEL_BLUR_PX.hypot(lens));
            let off = apart(&got, &drawn);
            assert!(off < 0.15, "{short}, lens {lens}: {off} {}", got.to_svg());
        }
    }
}

#[test]
fn a_long_line_gives_way_to_what_no_window_holds() {
    // the edge leaves the line by a third of a pixel, over twice the width of the widest window
    let slab = |top: &str| {
        let text = format!(
            "M6.2 4.3L113.1 4.3L113.1 30.2C113.1 35.9 109 40.2 103.3 40.2{top}C11.1 40.6 6.2 36.4 6.2 30.8Z"
        );
        BezPath::from_svg(&text).unwrap()
    };
    let drawn = slab("C73.2 40.2 46.4 40.6 16.5 40.6");
    let line = slab("L16.5 40.2");
    for lens in [0.0, 0.9] {
        let gray = picture(&polygon(&drawn, 0.001), 120, lens);
        let got = mended(&gray, &line, Contour::PIXEL_BLUR_PX.hypot(lens));
        let off = apart(&got, &drawn);
        assert!(off < 0.1, "lens {lens}: {off} {}", got.to_svg());
    }
}

#[test]
fn the_end_of_a_notch_is_square_to_it() {
    // a notch of 9°; grain leaves the line across its end in any direction
    let slanted = "M0 300L155 20L195.385 286.41L195.99 283.79L196 20L300 300Z";
    let path = BezPath::from_svg(slanted).unwrap();
    let mut chain = open_part(&Chain::from_path(&path, SMOOTH).unwrap(), 5);
    let i = 2;
    assert!(!is_blunt(&chain, i));
    let area = |c: &Chain| c.to_path().area();
    let before = area(&chain);
    squared(&mut chain, i).unwrap();
    assert!(is_blunt(&chain, i), "{chain:?}");
    let line = chain.nodes[i + 1].point - chain.nodes[i].point;
    let sides = [i - 1, i + 1].map(|s| chain.direction(s));
    let axis = sides[0] - sides[1];
    assert!(
        line.normalize().dot(axis.normalize()).abs() < 1e-9,
        "{line}"
    );
    assert!((area(&chain) - before).abs() < 0.5);
}

#[test]
fn a_tip_whose_side_hooks_comes_out_again() {
    let wedge = |side: &str| {
        let text = format!("M6.2 4.3L42.1 4.3L42.1 12.6L31.1 12.6{side}L16.4 12.6L6.2 12.6Z");
        BezPath::from_svg(&text).unwrap()
    };
    let drawn = wedge("C29.1 23 26 34 24.1 42.2");
    let hooked = wedge("C29.4 22 28.4 38.1 23.1 37.6");
    for lens in [0.0, 0.9] {
        let gray = photograph(&drawn, lens);
        let got = mended(&gray, &hooked, Contour::PIXEL_BLUR_PX.hypot(lens));
        let off = apart(&got, &drawn);
        assert!(off < 1.0, "lens {lens}: {off} {}", got.to_svg());
    }
}

#[test]
fn a_corner_beside_which_a_side_bends_goes_back_to_where_the_side_leads() {
    let level = "M8.2 8.4L40.3 8.4L40.3 40.1L12.2 40.1";
    let fit = [
        ("drawn out", "C10 40.1 8.2 40.1 8.2 40.4Z"),
        ("drawn in", "C10 40.1 8.6 40.1 8.2 39.8Z"),
    ];
    for (name, hook) in fit {
        let bent = BezPath::from_svg(&format!("{level}{hook}")).unwrap();
        for lens in [0.0, 0.9] {
            let gray = photograph(&square(), lens);
            let got = mended(&gray, &bent, Contour::PIXEL_BLUR_PX.hypot(lens));
            let off = apart(&got, &square());
            assert!(off < 0.05, "{name}, lens {lens}: {off} {}", got.to_svg());
        }
    }
}

#[test]
fn a_corner_for_a_bend_turns_no_more_just_before_it_than_what_was_there() {
    let chain = |hook: f64| {
        let path = format!("M40.3 40.1C20 40.1 10.2 40.1 8.2 {}L8.2 8.4", 40.1 + hook);
        Chain::from_path(&BezPath::from_svg(&path).unwrap(), SMOOTH).unwrap()
    };
    let round = BezPath::from_svg("M40.3 40.1C8.2 40.1 8.2 40.1 8.2 8.4").unwrap();
    let round = Chain::from_path(&round, SMOOTH).unwrap();
    let [straight, little, more] = [0.0, 0.1, 0.3].map(chain);
    for (of, from, is) in [
        (&straight, &straight, true),
        (&straight, &more, true),
        (&little, &more, true),
        (&little, &straight, false),
        (&more, &little, false),
        (&more, &round, true),
        (&round, &more, false),
    ] {
        assert_eq!(is_cornered(of, Point::new(8.2, 40.1), from), is);
    }
}

#[test]
fn a_needle_whose_sides_touch_when_all_nodes_settle_keeps_its_end() {
    let needle = |inward: f64| {
        let side = "M16.2 8.4L25.6 8.4L25.6 22.1C25.6 31.1 27.766 37 30.2 44.1";
        BezPath::from_svg(&format!("{side}L{} 31.1L16.2 8.4Z", 25.104 - inward)).unwrap()
    };
    let gray = photograph(&needle(0.0), 0.0);
    let got = mended(&gray, &needle(0.1), Contour::PIXEL_BLUR_PX);
    let off = apart(&got, &needle(0.0));
    assert!(off < 0.1, "{off} {}", got.to_svg());
}

#[test]
fn a_slit_that_ends_blunt_goes_on_to_its_tip() {
    let slit = |end: &str| {
        let text = format!("M4.2 4.3L43.1 4.3L43.1 43.6L26.1 43.6{end}L24.1 43.6L4.2 43.6Z");
        BezPath::from_svg(&text).unwrap()
    };
    let drawn = slit("L24.1 12.2");
    // where a lens leaves half of the ink the contour turns
    let blunt = slit("L25.1 28.4C25 26.5 24.6 26.3 24.5 26.3C24.3 26.3 24.1 26.4 24.1 26.8");
    for lens in [0.0, 0.9] {
        let gray = photograph(&drawn, lens);
        let got = mended(&gray, &blunt, Contour::PIXEL_BLUR_PX.hypot(lens));
        let off = apart(&got, &drawn);
        assert!(off < 2.0, "lens {lens}: {off} {}", got.to_svg());
    }
}

#[test]
fn a_hooked_tip_is_tried_with_sides_that_do_not_turn() {
    let hooked =
        BezPath::from_svg("M42.1 12.6L31.1 12.6C29.4 22 28.4 38.1 23.1 37.6L16.4 12.6L6.2 12.6Z");
    let chain = Chain::from_path(&hooked.unwrap(), 0.0175).unwrap();
    let part = open_part(&chain, 4);
    let tip = Point::new(23.1, 37.6);
    let i = part.nodes.iter().position(|n| n.point == tip).unwrap();
    let side = (tip - Point::new(26.6, 33.2)).normalize();
    let leads = |c: &Chain| {
        let node = c.nodes.iter().min_by(|a, b| {
            let off = |n: &&Node| n.point.distance(tip);
            off(a).total_cmp(&off(b))
        });
        node.unwrap().arrive.dot(side)
    };
    assert!(part.nodes[i].arrive.dot(side) < 0.8);
    let tried = variants(&part, tip, 8.0);
    assert!(
        tried
            .iter()
            .any(|c| c.kinds == part.kinds && leads(c) > 0.95)
    );
}

#[test]
fn sides_that_cross_or_run_on_as_one_end_where_they_part() {
    for (name, path, tip) in [
        (
            "crossed",
            "M5 5L30 5L30 15L29 17C28.8 20 24 24.5 21 25L25.5 25.5C25 22 15 12 5 12Z",
            None,
        ),
        (
            "crossed within a step",
            "M5 5L30 5L30 15L21 15C22 18.3 19.99 21.67 20 25C20.01 21.67 18 18.3 19 15L5 15Z",
            Some(Point::new(20.0, 25.0)),
        ),
        (
            "a needle",
            "M5 5L30 5L30 15L20 15L20 25L20.02 15L5 15Z",
            Some(Point::new(20.0, 15.0)),
        ),
        (
            "a loop",
            "M5 5L30 5L30 27L32 27L32 25L5 25Z",
            Some(Point::new(30.0, 25.0)),
        ),
        (
            "a tip",
            "M5 5L30 5L30 15L21 15L20 25L19 15L5 15Z",
            Some(Point::new(20.0, 25.0)),
        ),
        ("drawn across", "M5 5L30 5L30 35L40 35L40 25L5 25Z", None),
    ] {
        let path = BezPath::from_svg(path).unwrap();
        let mut ring = Chain::from_path(&path, SMOOTH).unwrap();
        let cut = |c: &Chain| (0..c.nodes.len()).find_map(|i| trimmed(c, i, ONE_PX, usize::MAX));
        let mut cuts = 0;
        while let Some((shorter, _)) = cut(&ring) {
            (ring, cuts) = (shorter, cuts + 1);
        }
        let stays = ["a tip", "drawn across"].contains(&name);
        let svg = ring.to_path().to_svg();
        assert_eq!(cuts > 0, !stays, "{name}: {svg}");
        if let Some(tip) = tip {
            let off = ring.nodes.iter().map(|n| n.point.distance(tip));
            let off = off.fold(f64::INFINITY, f64::min);
            assert!(off < 0.5, "{name}: {off} {svg}");
        }
        let longest = ring.nodes.iter().map(|n| n.point.y).fold(0.0, f64::max);
        assert!(stays || longest < 25.4, "{name}: {longest}");
    }
}

#[test]
fn a_lobe_behind_a_narrow_neck_stays_and_loops_and_needles_that_no_pixel_holds_go() {
    let body = |end: &str| {
        let text = format!("M6.2 5.3L42.1 5.3L42.1 15.4L{end}L6.2 15.4Z");
        BezPath::from_svg(&text).unwrap()
    };
    let lobe = body("24.02 15.4C30 20 27 26 24 34C21 26 18 20 23.98 15.4");
    let loop_ = body("24.02 15.4C24.3 18 24.2 26 24 34C23.8 26 23.7 18 24.03 15.4");
    // its sides are a fifth of a pixel apart
    let needle = body("24.1 15.4L24 24L23.9 15.4");
    let bare = body("24 15.4");
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        for (name, drawn, fit) in [
            ("lobe", &lobe, &lobe),
            ("loop", &bare, &loop_),
            ("needle", &bare, &needle),
        ] {
            let got = mended(&photograph(drawn, lens), fit, blur);
            let off = apart(&got, drawn);
            assert!(off < 0.2, "{name}, lens {lens}: {off} {}", got.to_svg());
        }
    }
}

#[test]
fn outlines_that_cross_and_did_not_are_mended_without_that() {
    for lens in [0.0, 0.9] {
        let gray = photograph(&square(), lens);
        let began = [rounded(3.5)];
        let chords = polygon(&began[0], 0.01);
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let residual = Residual::new(&gray, [&*chords].into_iter(), blur);
        for (tangled, again) in [
            ("M8.2 8.4L40.3 8.4L8.2 40.1L40.3 40.1Z", true),
            ("M8.2 8.4L40.3 8.4L40.3 40.1L20.2 44.1Z", false),
        ] {
            let tangled = BezPath::from_svg(tangled).unwrap();
            let mut work = Work::new(&residual, &began);
            work.chains[0] = Chain::from_path(&tangled, SMOOTH);
            work.rings[0] = Ring::new(tangled.clone());
            work.redraw_all();
            work.untangle(&began);
            let got = work.finished().remove(0);
            let expected = if again { square() } else { tangled };
            let off = apart(&got, &expected);
            assert!(off < 0.05, "lens {lens}: {off} {}", got.to_svg());
        }
    }
}

#[test]
fn no_chain_is_put_that_crosses_where_none_may() {
    let gray = photograph(&square(), 0.0);
    let chords = polygon(&square(), 0.01);
    let residual = Residual::new(&gray, [&*chords].into_iter(), Contour::PIXEL_BLUR_PX);
    let bow = BezPath::from_svg("M8.2 8.4L40.3 8.4L8.2 40.1L40.3 40.1Z").unwrap();
    let bow = Chain::from_path(&bow, SMOOTH).unwrap();
    for (crossing, put) in [(Crossing::OnTheWay, true), (Crossing::Never, false)] {
        let mut work = Work::new(&residual, &[square()]);
        work.crossing = crossing;
        assert_eq!(work.put(0, bow.clone(), f64::INFINITY), put);
        let stays = work.finished() == [square()];
        assert_eq!(stays, !put);
    }
}

#[test]
fn outlines_that_settle_cross_only_where_they_may() {
    // a slit that is not drawn is filled from both sides, and by more than its half
    let left = "M8.2 8.4L24 8.4L24.3 40.1L8.2 40.1Z";
    let right = "M24.5 8.4L40.3 8.4L40.3 40.1L24.3 40.1Z";
    let halves = [left, right].map(|s| BezPath::from_svg(s).unwrap());
    let rings = halves.each_ref().map(|p| polygon(p, 0.01));
    for lens in [0.0, 0.9] {
        let gray = photograph(&square(), lens);
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let residual = Residual::new(&gray, rings.iter().map(Vec::as_slice), blur);
        for crossing in [Crossing::OnTheWay, Crossing::Never] {
            let mut work = Work::new(&residual, &halves);
            work.crossing = crossing;
            work.settle();
            work.crossing = Crossing::Never;
            let crosses = work.crossed(None) > 0;
            assert_eq!(crosses, crossing == Crossing::OnTheWay, "lens {lens}");
        }
    }
}

#[test]
fn what_changed_of_a_ring_is_found_wherever_it_begins() {
    let path = BezPath::from_svg("M0 0L10 -2L20 0L20 20L0 20Z").unwrap();
    let ring = Chain::from_path(&path, SMOOTH).unwrap();
    for start in 0..5 {
        let mut other = begun_at(&ring, start);
        assert_eq!(changed(&ring, &other), None);
        let low = other.nodes.iter_mut().find(|n| n.point.y < 0.0).unwrap();
        low.point.y = -5.0;
        let around = Rect::new(0.0, -5.0, 20.0, 0.0);
        assert_eq!(changed(&ring, &other), Some(around));
        other.nodes.clear();
        other.kinds.clear();
        assert_eq!(changed(&ring, &other), Some(path.bounding_box()));
    }
}

#[test]
fn sides_that_run_on_as_one_are_a_needle_also_where_they_bend() {
    // one side bends over 7 px, the other one over 60
    let bent = "M0 -20L0 21C0 23.4 1.5 26.1 3.7 27.4C-3.2 24.3 -2 -2.6 -46.9 -2.6L-46.9 -20Z";
    let tip = "M0 -20L0 21C0 23.4 0.5 26.1 1.7 28.4C-3.2 24.3 -7 -2.6 -46.9 -2.6L-46.9 -20Z";
    for (path, needle) in [(bent, true), (tip, false)] {
        let chain = Chain::from_path(&BezPath::from_svg(path).unwrap(), 0.0175).unwrap();
        assert_eq!(is_needle(&chain, 2), needle, "{path}");
    }
}

#[test]
fn the_end_of_a_corner_is_cut_off_where_it_is_drawn_blunt() {
    let wedge = |top: &str| BezPath::from_svg(&format!("M8.3 8.2L40.6 8.2L{top}Z")).unwrap();
    let (sharp, blunt) = (wedge("24.45 41.6"), wedge("24.95 40.57L23.95 40.57"));
    for lens in [0.0, 0.9] {
        for drawn in [&sharp, &blunt] {
            let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
            let got = mended(&photograph(drawn, lens), &sharp, blur);
            let off = apart(&got, drawn);
            assert!(off < 0.1, "lens {lens}: {off} {}", got.to_svg());
            assert_eq!(got.segments().count(), drawn.segments().count());
        }
    }
}

#[test]
fn a_path_that_explains_its_picture_stays_as_it_is() {
    for path in [square(), rounded(2.0), rounded(9.0), notched(15.0)] {
        for lens in [0.0, 0.9] {
            let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
            let got = mended(&photograph(&path, lens), &path, blur);
            let off = apart(&got, &path);
            assert!(off < 1e-3, "lens {lens}: {off} {}", got.to_svg());
            assert_eq!(got.segments().count(), path.segments().count());
        }
    }
}

#[test]
fn what_is_too_little_off_to_be_looked_at_settles() {
    let drawn = rounded(9.0);
    let fit = Affine::translate((0.08, 0.08)) * &drawn;
    for lens in [0.0, 0.9] {
        let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
        let got = mended(&photograph(&drawn, lens), &fit, blur);
        let off = apart(&got, &drawn);
        assert!(off < 0.02, "lens {lens}: {off} {}", got.to_svg());
    }
}

#[test]
fn a_curve_that_turns_back_before_its_corner_has_a_node_there() {
    let path = "M8.2 8.4L40.3 8.4L40.3 40C30 40.4 20 40.1 8.2 30.1Z";
    let path = BezPath::from_svg(path).unwrap();
    let got = mended(&photograph(&path, 0.0), &path, Contour::PIXEL_BLUR_PX);
    assert!(apart(&got, &path) < 1e-3);
    let inner = |s: PathSeg| inner_extrema(&s.to_cubic()).count();
    assert_eq!(path.segments().map(inner).sum::<usize>(), 1);
    assert_eq!(got.segments().map(inner).sum::<usize>(), 0);
}

#[test]
fn mending_a_picture_of_nothing_and_of_noise_ends() {
    let noise = |x: usize, y: usize| ((x * 7 + y * 13 + x * y) % 11) as f32 / 10.0;
    for gray in [
        Gray::from_fn(0, 0, |_, _| 0.0),
        Gray::from_fn(1, 1, |_, _| 1.0),
        Gray::from_fn(48, 48, |_, _| 0.0),
        Gray::from_fn(48, 48, noise),
    ] {
        for path in [square(), rounded(2.0), notched(15.0)] {
            let got = mended(&gray, &path, 0.6);
            assert!(got.is_finite());
        }
    }
}

#[test]
fn a_picture_of_noise_takes_no_more_than_there_is() {
    // blurred noise, its outlines as they are found
    let mut state: u32 = 7;
    let mut noise = vec![0.0; 48 * 48];
    for v in &mut noise {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        *v = (state >> 8) as f32 / (1 << 24) as f32;
    }
    blur(&mut noise, 48, 0.8, 0);
    let gray = Gray::from_fn(48, 48, |x, y| 0.5 + 2.5 * (noise[48 * y + x] - 0.5));
    let rings = iso::rings((48, 48), |x, y| gray.at(x, y), 0.5);
    let path = |ring: &Vec<Point>| {
        let mut path = BezPath::new();
        path.move_to(ring[0]);
        ring[1..].iter().step_by(4).for_each(|p| path.line_to(*p));
        path.close_path();
        path
    };
    let paths: Vec<BezPath> = rings.iter().filter(|r| r.len() > 12).map(path).collect();
    let blurs = paths.iter().map(|p| polygon(p, 0.01)).collect::<Vec<_>>();
    let residual = Residual::new(&gray, blurs.iter().map(Vec::as_slice), 0.9);
    let spent = |most: usize| {
        let mut work = Work::new(&residual, &paths);
        work.work = Budget::of(most);
        work.mend();
        work.work.over().map(|over| most + over)
    };
    assert_eq!(spent(0), Some(0), "nothing pays for it");
    assert!(spent(1500).is_some(), "the noise asks for more than that");
    let some = spent(500).expect("noise that asks for more");
    assert!(some < 700, "{some} segments in place of 500");
}
