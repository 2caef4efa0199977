//! Pens of known width on known paths.

use super::*;
use crate::numeric::distance::Polyline;
use crate::types::{Bitmap, Centerline, Gray, Guides};
use kurbo::Point;

#[expect(clippy::cast_possible_truncation, reason = "coverage")]
/// Ink of a round pen of half width `r` px along polylines; a line of one point is a dot.
pub(super) fn pen(size: usize, r: f64, lines: &[&[(f64, f64)]]) -> Gray {
    let near = |p: Point, a: Point, b: Point| {
        let (d, n) = (b - a, (b - a).hypot2());
        let t = if n > 0.0 {
            ((p - a).dot(d) / n).clamp(0.0, 1.0)
        } else {
            0.0
        };
        p.distance(a + d * t)
    };
    Gray::from_fn(size, size, |x, y| {
        let p = Point::new(x as f64 + 0.5, y as f64 + 0.5);
        let mut least = f64::INFINITY;
        for line in lines {
            for i in 0..line.len() {
                let (a, b) = (line[i], line[(i + 1).min(line.len() - 1)]);
                least = least.min(near(p, a.into(), b.into()));
            }
        }
        (r - least + 0.5).clamp(0.0, 1.0) as f32
    })
}

fn circle(cx: f64, cy: f64, r: f64) -> Vec<(f64, f64)> {
    let at = |i: usize| libm::sincos(i as f64 / 40.0 * std::f64::consts::TAU);
    (0..=40)
        .map(at)
        .map(|(s, c)| (cx + r * c, cy + r * s))
        .collect()
}

fn skeleton(gray: &Gray) -> Skeleton {
    Skeleton::new(&Bitmap::threshold(gray, 0.5), Pruning::default())
}

#[test]
fn thinning_keeps_parts_and_holes_and_is_done_when_done() {
    let ring = circle(60.0, 60.0, 30.0);
    let cross: [&[(f64, f64)]; 4] = [
        &ring,
        &[(20.0, 60.0), (100.0, 62.0)],
        &[(10.0, 10.0)],
        &[(100.0, 110.0), (104.0, 110.0)],
    ];
    for r in [1.0, 2.5, 6.0] {
        let ink = Bitmap::threshold(&pen(120, r, &cross), 0.5);
        let thinned = thin(&ink);
        assert_eq!(
            skeleton::parts(&ink).1,
            skeleton::parts(&thinned).1,
            "parts at {r}"
        );
        assert_eq!(marks::holes(&ink), marks::holes(&thinned), "holes at {r}");
        assert_eq!(thin(&thinned), thinned, "thinned again at {r}");
        assert!(
            thinned.bits().iter().zip(ink.bits()).all(|(t, i)| !t || *i),
            "ink was made at {r}"
        );
        let squares = (1..120).flat_map(|y| (1..120).map(move |x| (x, y)));
        let thick = squares.filter(|&(x, y)| {
            [(0, 0), (1, 0), (0, 1), (1, 1)]
                .iter()
                .all(|(i, j)| thinned.at(x - i, y - j))
        });
        assert!(thick.count() <= 2, "lines two pixels wide at {r}");
    }
}

#[test]
fn strokes_junctions_and_dots() {
    let ring = circle(40.0, 60.0, 25.0);
    let o = skeleton(&pen(120, 5.0, &[&ring]));
    assert!(
        o.strokes.len() == 1 && o.strokes[0].closed && o.junctions.is_empty() && o.dots.is_empty()
    );
    let widths = &o.strokes[0].half_widths;
    assert!(widths.iter().all(|w| (w - 5.0).abs() < 1.2), "{widths:?}");

    let t = skeleton(&pen(
        120,
        6.0,
        &[
            &[(20.0, 20.0), (100.0, 20.0)],
            &[(60.0, 20.0), (60.0, 100.0)],
        ],
    ));
    assert_eq!((t.strokes.len(), t.junctions.len()), (3, 1));
    assert!(t.junctions[0].distance(Point::new(60.0, 20.0)) < 4.0);

    let i = skeleton(&pen(
        120,
        6.0,
        &[&[(60.0, 40.0), (60.0, 100.0)], &[(60.0, 20.0)]],
    ));
    assert_eq!((i.strokes.len(), i.dots.len()), (1, 1));
    assert!(i.dots[0].centre.distance(Point::new(60.0, 20.0)) < 0.3);
    assert!((i.dots[0].radius - 6.0).abs() < 0.3);

    let theta = skeleton(&pen(120, 5.0, &[&ring, &[(15.0, 60.0), (65.0, 60.0)]]));
    assert_eq!((theta.strokes.len(), theta.junctions.len()), (3, 2));
}

#[test]
fn rough_borders_sprout_no_strokes() {
    // A thick stroke whose border is eaten by a fixed pattern: a wave's worth of spurs without pruning.
    let smooth = pen(160, 14.0, &[&[(30.0, 30.0), (130.0, 120.0)]]);
    let rough = Gray::from_fn(160, 160, |x, y| {
        let bite = (x * 7 + y * 13) % 5 == 0 && smooth.at(x, y) > 0.0 && smooth.at(x + 1, y) < 0.5;
        if bite { 0.0 } else { smooth.at(x, y) }
    });
    assert_eq!(skeleton(&rough).strokes.len(), 1);
}

/// A, T, O, i and their like, shifted and with a pen of another width.
fn letters(shift: f64, r: f64) -> Vec<Sample> {
    let at = |lines: &[&[(f64, f64)]]| -> Gray {
        let moved: Vec<Vec<(f64, f64)>> = lines
            .iter()
            .map(|l| l.iter().map(|p| (p.0 + shift, p.1 + shift / 2.0)).collect())
            .collect();
        let lines: Vec<&[(f64, f64)]> = moved.iter().map(Vec::as_slice).collect();
        pen(140, r, &lines)
    };
    let (big, small) = (circle(60.0, 65.0, 35.0), circle(60.0, 82.0, 18.0));
    let drawn: [(&str, Gray); 7] = [
        (
            "A",
            at(&[
                &[(30.0, 100.0), (60.0, 30.0), (90.0, 100.0)],
                &[(42.0, 75.0), (78.0, 75.0)],
            ]),
        ),
        (
            "T",
            at(&[
                &[(30.0, 30.0), (90.0, 30.0)],
                &[(60.0, 30.0), (60.0, 100.0)],
            ]),
        ),
        ("O", at(&[&big])),
        ("o", at(&[&small])),
        ("l", at(&[&[(60.0, 30.0), (60.0, 100.0)]])),
        ("i", at(&[&[(60.0, 55.0), (60.0, 100.0)], &[(60.0, 35.0)]])),
        ("L", at(&[&[(30.0, 30.0), (30.0, 100.0), (80.0, 100.0)]])),
    ];
    let guides = Guides {
        baseline_px: 100.0 + shift / 2.0,
        px_per_em: 100.0,
        row: None,
    };
    drawn
        .into_iter()
        .map(|(l, gray)| Sample {
            label: l.to_owned(),
            gray,
            guides: Some(guides),
        })
        .collect()
}

#[test]
fn every_method_finds_a_letter_drawn_again() {
    for method in Method::all() {
        let alphabet = Alphabet::new(&letters(0.0, 4.0), method);
        let mut looks: Vec<Look> = letters(8.0, 6.5)
            .iter()
            .map(|s| Look::new(&s.gray, s.guides, method))
            .collect();
        alphabet.settle_page(&mut looks);
        for (sample, look) in letters(8.0, 6.5).iter().zip(&looks) {
            let guesses = alphabet.rank(look);
            let best = guesses.first().expect("a guess");
            let same = best.label.eq_ignore_ascii_case(&sample.label);
            assert!(
                same,
                "{}: {} for {}",
                method.key(),
                best.label,
                sample.label
            );
            assert!(best.distance >= 0.0 && (0.0..=1.0).contains(&best.confidence));
            let sum: f64 = guesses.iter().map(|g| g.confidence).sum();
            assert!((sum - 1.0).abs() < 1e-9, "confidences add up to {sum}");
        }
    }
}

#[test]
fn every_picture_is_answered() {
    let blank = |w, h, ink: f32| Gray::from_fn(w, h, |_, _| ink);
    let noise = Gray::from_fn(90, 70, |x, y| ((x * 31 + y * 17 + x * y) % 7) as f32 / 6.0);
    for method in Method::all() {
        let alphabet = Alphabet::new(&letters(0.0, 4.0), method);
        let none = Alphabet::new(&[], method);
        for (gray, inked) in [
            (blank(0, 0, 0.0), false),
            (blank(40, 40, 0.0), false),
            (blank(40, 40, 1.0), true),
            (blank(1, 1, 1.0), true),
            (blank(1, 500, 1.0), true),
            (blank(2000, 1500, 1.0), true),
            (noise.clone(), true),
        ] {
            let look = Look::new(&gray, None, method);
            assert_eq!(look.is_empty(), !inked);
            let guesses = alphabet.rank(&look);
            assert_eq!(guesses.is_empty(), !inked);
            assert!(
                guesses
                    .iter()
                    .all(|g| g.distance.is_finite() && g.confidence.is_finite())
            );
            assert!(none.rank(&look).is_empty());
        }
    }
}

/// Points along a smooth path with bends both ways.
fn wave(width: f64) -> Vec<(f64, f64)> {
    let at = |i: usize| {
        let t = i as f64 / 200.0;
        (
            30.0 + 130.0 * t,
            90.0 + 3.0 * width * libm::sin(6.0 * t) + 20.0 * t,
        )
    };
    (0..=200).map(at).collect()
}

/// The largest distance from points along the centreline to the polylines, px.
fn off_path(line: &Centerline, truth: &[&[(f64, f64)]], away: impl Fn(Point) -> bool) -> f64 {
    use kurbo::{ParamCurve, PathSeg};
    let near = |p: Point| {
        let lines = truth
            .iter()
            .filter_map(|l| Polyline::new(l.iter().map(|p| Point::from(*p)).collect()));
        lines
            .map(|l| l.nearest(p).distance)
            .fold(f64::INFINITY, f64::min)
    };
    let segments = line
        .lines
        .iter()
        .flat_map(|l| l.path.segments().collect::<Vec<PathSeg>>());
    let points = segments.flat_map(|s| (0..=20).map(move |i| s.eval(f64::from(i) / 20.0)));
    points.filter(|p| away(*p)).map(near).fold(0.0, f64::max)
}

#[test]
fn the_centreline_is_where_the_pen_went() {
    for width in [4.0, 8.0, 14.0, 20.0] {
        let path = wave(width);
        let line = centerline(&pen(200, width / 2.0, &[&path, &[(180.0, 30.0)]]));
        assert_eq!((line.lines.len(), line.dots.len()), (1, 1), "at {width}");
        let off = off_path(&line, &[&path], |_| true);
        assert!(
            off <= 0.03 * width,
            "{off} px from the path of a pen {width} px wide"
        );
        let widths = &line.lines[0].widths;
        assert!(
            widths.iter().all(|w| (w - width).abs() < 0.06 * width),
            "{widths:?} for {width}"
        );
        let ends = [path[0], path[200]].map(Point::from);
        let elements = line.lines[0].path.segments();
        let (first, last) = (
            elements.clone().next().expect("a start"),
            elements.last().expect("an end"),
        );
        let found = [
            kurbo::ParamCurve::start(&first),
            kurbo::ParamCurve::end(&last),
        ];
        for end in ends {
            let nearest = found
                .iter()
                .map(|f| f.distance(end))
                .fold(f64::INFINITY, f64::min);
            assert!(
                nearest < 0.06 * width,
                "an end is {nearest} px off at {width}"
            );
        }
    }
}

#[test]
fn centrelines_of_rings_corners_and_crossings() {
    let ring = circle(70.0, 70.0, 40.0);
    let o = centerline(&pen(140, 6.0, &[&ring]));
    let off = off_path(&o, &[&ring], |_| true);
    assert!(
        o.lines.len() == 1 && off < 0.36,
        "{} lines, {off} px off",
        o.lines.len()
    );

    let l: &[(f64, f64)] = &[(30.0, 20.0), (30.0, 110.0), (110.0, 110.0)];
    let line = centerline(&pen(140, 6.0, &[l]));
    let off = off_path(&line, &[l], |p| p.distance(Point::new(30.0, 110.0)) > 12.0);
    assert!(
        line.lines.len() == 1 && off < 0.36,
        "{} lines, {off} px off",
        line.lines.len()
    );

    let t: [&[(f64, f64)]; 2] = [
        &[(20.0, 30.0), (120.0, 34.0)],
        &[(70.0, 32.0), (75.0, 120.0)],
    ];
    let line = centerline(&pen(140, 6.0, &t));
    let off = off_path(&line, &t, |p| p.distance(Point::new(70.0, 32.0)) > 12.0);
    assert!(
        line.lines.len() == 3 && off < 0.36,
        "{} lines, {off} px off",
        line.lines.len()
    );
    let nothing = centerline(&Gray::from_fn(0, 0, |_, _| 0.0));
    assert!(nothing.lines.is_empty() && nothing.dots.is_empty());
}
