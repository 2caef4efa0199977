use super::*;
use crate::numeric::{cast::single, coverage::blur};
use kurbo::{Point, Vec2};
use proptest::prelude::*;

/// A picture of what `inside` says, 16 × 16 samples a pixel.
fn picture(w: usize, h: usize, inside: impl Fn(f64, f64) -> bool) -> Gray {
    Gray::from_fn(w, h, |x, y| {
        let at = |p: usize, i: usize| p as f64 + (i as f64 + 0.5) / 16.0;
        let hits = (0..256).filter(|i| inside(at(x, i % 16), at(y, i / 16)));
        hits.count() as f32 / 256.0
    })
}

fn traced(gray: &Gray) -> Vec<Contour> {
    trace(gray, &Options::default())
}

#[test]
fn nothing_in_nothing() {
    assert!(traced(&Gray::from_fn(0, 0, |_, _| 1.0)).is_empty());
    assert!(traced(&Gray::from_fn(9, 7, |_, _| 0.0)).is_empty());
    assert!(traced(&Gray::from_fn(1, 1, |_, _| 1.0)).is_empty(), "dust");
}

#[test]
fn a_picture_full_of_ink_is_its_frame() {
    let c = &traced(&Gray::from_fn(9, 7, |_, _| 1.0))[0];
    assert_eq!(c.bounds(), kurbo::Rect::new(0.0, 0.0, 9.0, 7.0));
    assert!(c.area() > 62.0, "{}", c.area());
}

#[test]
fn a_ring_is_an_outer_contour_and_a_hole() {
    let ring = picture(40, 30, |x, y| {
        (4.0..10.0).contains(&(x - 17.3).hypot(y - 14.6))
    });
    let c = traced(&ring);
    assert_eq!(c.len(), 2);
    assert!(
        (c[0].area() - 100.0 * std::f64::consts::PI).abs() < 2.0,
        "{}",
        c[0].area()
    );
    assert!(
        (c[1].area() + 16.0 * std::f64::consts::PI).abs() < 2.0,
        "{}",
        c[1].area()
    );
    let centre = Point::new(17.3, 30.0 - 14.6);
    for p in c[0].points() {
        assert!((p.distance(centre) - 10.0).abs() < 0.1, "{p:?}");
    }
}

#[test]
fn saddles_follow_the_surface() {
    let pair = |centre: f32| {
        Gray::from_fn(8, 8, |x, y| match (x < 4, y < 4) {
            (true, true) | (false, false) => 1.0,
            _ => centre,
        })
    };
    assert_eq!(traced(&pair(0.1)).len(), 1, "ink meets at 0.55");
    assert_eq!(traced(&pair(-0.1)).len(), 2, "ink parts at 0.45");
}

#[test]
fn contours_that_almost_touch_stay_apart() {
    let two = picture(40, 30, |x, y| {
        (x - 10.0).hypot(y - 15.0) < 8.0 || (x - 27.2).hypot(y - 15.0) < 8.0
    });
    assert_eq!(traced(&two).len(), 2);
}

#[test]
fn blur_is_measured() {
    for sigma in [0.5f64, 0.9, 1.4] {
        let total = sigma.hypot(Contour::PIXEL_BLUR_PX);
        let disk = Gray::from_fn(64, 64, |x, y| {
            let d = 22.0 - (x as f64 - 31.3).hypot(y as f64 - 31.7);
            single(1.0 / (1.0 + libm::exp(-1.702 * d / total)))
        });
        let seen = traced(&disk)[0].blur_px();
        assert!((seen / total - 1.0).abs() < 0.06, "{sigma}: {seen}");
    }
    let sharp = picture(64, 64, |x, y| (x - 31.3).hypot(y - 31.7) < 22.0);
    assert!(traced(&sharp)[0].blur_px() < 0.31);
}

#[test]
fn uneven_grey_becomes_coverage() {
    let (ink, paper) = (
        |x: usize| 0.75 + 0.002 * x as f32,
        |y: usize| 0.2 - 0.002 * y as f32,
    );
    let gray = Gray::from_fn(60, 60, |x, y| {
        let c = if x < 30 {
            1.0
        } else if x == 30 {
            0.3
        } else {
            0.0
        };
        c * ink(x) + (1.0 - c) * paper(y)
    });
    let flat = level(&gray);
    for y in 10..50 {
        assert!((flat.at(30, y) - 0.3).abs() < 0.02, "{}", flat.at(30, y));
        assert!((flat.at(10, y) - 1.0).abs() < 0.02 && flat.at(50, y).abs() < 0.02);
    }
    let blank = Gray::from_fn(5, 5, |_, _| 0.3);
    assert!(
        level(&blank).samples().iter().all(|v| v.abs() < 1e-5),
        "paper is paper"
    );
    assert_eq!(level(&Gray::from_fn(0, 3, |_, _| 0.0)).height(), 3);
}

/// A disk of 40 px around this place.
const DISK: Point = Point::new(45.0, 45.0);

/// The disk, and a bar of `size` px around `at` turned by `degrees`: of ink beside it, or a slit in it. As a lens of
/// 0.9 px sees it under a scan's grain.
fn thin(at: Point, (length, width): (f64, f64), degrees: f64) -> Gray {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let inside = |x: f64, y: f64| {
        let d = Point::new(x, y) - at;
        let local = Vec2::new(d.x * cos + d.y * sin, d.y * cos - d.x * sin);
        let on = local.x.abs() < length / 2.0 && local.y.abs() < width / 2.0;
        on != (DISK.distance(Point::new(x, y)) < 40.0)
    };
    scanned(&picture(180, 130, inside), 1)
}

/// A picture as a lens of 0.9 px sees it under a scan's grain, which begins with `dice`.
fn scanned(sharp: &Gray, mut dice: u64) -> Gray {
    let mut samples = sharp.samples().to_vec();
    blur(&mut samples, sharp.width(), 0.9, 0);
    for v in &mut samples {
        let mut sum = -6.0;
        for _ in 0..12 {
            dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            sum += (dice >> 40) as f32 / (1_u64 << 24) as f32;
        }
        *v = 0.15 + 0.7 * *v + 0.02 * sum;
    }
    sharp.with_samples(samples)
}

#[test]
fn lines_and_slits_that_no_pixel_shows_half_of_have_whole_contours() {
    // beside the disk and in it
    for (at, long) in [(Point::new(131.3, 62.7), 80.0), (DISK, 60.0)] {
        for (width, degrees) in [0.7, 1.0, 1.3].into_iter().zip([0.0, 33.0, 78.0]) {
            for degrees in [degrees, degrees + 45.0, degrees + 90.0] {
                let c = traced(&level(&thin(at, (long, width), degrees)));
                let what = format!("{width} px at {degrees}°, around {at}");
                assert_eq!(c.len(), 2, "{what}");
                let area = |c: &&Contour| c.area().abs();
                let bar = c.iter().min_by(|a, b| area(a).total_cmp(&area(b)));
                let bar = bar.expect("two contours");
                assert_eq!(bar.area() < 0.0, at == DISK, "{what}");
                let size = bar.bounds().width().hypot(bar.bounds().height());
                assert!((size - long).abs() < 6.0, "{what}: {size} px long");
            }
        }
    }
}

#[test]
fn short_lines_that_no_pixel_shows_half_of_join_what_they_join() {
    for (k, degrees) in [0.0, 14.0, 31.0, 45.0, 68.0]
        .into_iter()
        .cycle()
        .take(20)
        .enumerate()
    {
        let neck = turned(degrees, |x, y| {
            let thick = (3.0..16.0).contains(&x.abs()) && y.abs() < 8.0;
            thick || x.abs() < 3.0 && y.abs() < 0.65
        });
        for gray in [level(&scanned(&neck, k as u64)), neck] {
            assert_eq!(traced(&gray).len(), 1, "at {degrees}°");
        }
    }
}

#[test]
fn ink_that_ends_near_other_ink_stays_apart() {
    let diamond = |x: f64, y: f64, at: f64| (x.abs() - at).abs() + y.abs() < 4.5;
    for (k, gap) in [2.0, 2.6, 3.4].into_iter().enumerate() {
        for (i, degrees) in [0.0, 14.0, 31.0, 45.0, 68.0].into_iter().enumerate() {
            let ends = |x: f64, y: f64| (gap / 2.0..20.0).contains(&x.abs()) && y.abs() < 1.5;
            let disks = |x: f64, y: f64| (x.abs() - 4.0 - gap / 2.0).hypot(y) < 4.0;
            let tips = |x: f64, y: f64| diamond(x, y, 4.5 + gap / 2.0);
            let shapes: [&dyn Fn(f64, f64) -> bool; 3] = [&ends, &disks, &tips];
            for (what, shape) in shapes.into_iter().enumerate() {
                let sharp = turned(degrees, shape);
                let scan = level(&scanned(&sharp, (7 * k + i) as u64));
                for gray in [scan, sharp] {
                    assert_eq!(traced(&gray).len(), 2, "{what}, {gap} px apart, {degrees}°");
                }
            }
        }
    }
}

/// A picture of what `inside` says around its middle, turned by so many degrees.
fn turned(degrees: f64, inside: impl Fn(f64, f64) -> bool) -> Gray {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    picture(60, 60, |x, y| {
        let (x, y) = (x - 30.2, y - 29.7);
        inside(x * cos + y * sin, y * cos - x * sin)
    })
}

#[test]
fn the_pale_middle_of_a_stroke_is_no_slit() {
    let across = [0.4, 0.9, 0.95, 0.6, 0.95, 0.9, 0.4];
    let stroke = Gray::from_fn(90, 40, |x, y| {
        let on = (10..80).contains(&x) && (17..24).contains(&y);
        if on { across[y - 17] } else { 0.0 }
    });
    assert!(thin::lifted(&stroke, 0.5, 0.9).is_none());
    assert_eq!(traced(&level(&stroke)).len(), 1);
}

#[test]
fn what_is_thick_is_not_lifted() {
    // a wedge of 6°, eight lines of 2.4 px, seven slits as wide
    let wedge = |x: f64, y: f64| (y - 30.2).abs() < (x - 8.0) * 0.0524 && x < 110.0;
    let within = |x: f64, y: f64| {
        (5.0..55.0).contains(&y) && (18.0..18.0 + 8.0 * 9.0).contains(&(x + 0.3 * y))
    };
    let lines = |x: f64, y: f64| within(x, y) && (x + 0.3 * y).rem_euclid(9.0) < 2.5;
    let slits = |x: f64, y: f64| within(x, y) && (x + 0.3 * y).rem_euclid(9.0) < 6.5;
    let all: [&dyn Fn(f64, f64) -> bool; 3] = [&wedge, &lines, &slits];
    for (i, inside) in all.into_iter().enumerate() {
        let sharp = picture(120, 60, inside);
        for lens in [0.0, 0.9] {
            let mut samples = sharp.samples().to_vec();
            blur(&mut samples, sharp.width(), lens, 0);
            let gray = sharp.with_samples(samples);
            let blur_px = lens.hypot(Contour::PIXEL_BLUR_PX);
            let lifted = thin::lifted(&gray, 0.5, blur_px).is_some();
            assert!(!lifted, "{i}, lens {lens}");
            let beside = thin::beside(&gray, [0.0, 1.0]).is_some();
            assert!(!beside, "{i}, lens {lens}");
        }
    }
    assert_eq!(
        thin::lifted(&Gray::from_fn(0, 0, |_, _| 0.0), 0.5, 1.0),
        None
    );
}

proptest! {
    #[test]
    fn noise_gives_contours_that_alternate_around_all_ink(
        seed in prop::collection::vec(-0.5f32..1.5, 12 * 9)
    ) {
        let gray = Gray::new(12, 9, seed).unwrap();
        let all = |gray: &Gray| -> Vec<Contour> {
            rings_at(gray, 0.5).into_iter().filter_map(|r| Contour::new(r).ok()).collect()
        };
        let c = all(&gray);
        for y in 0..9usize {
            for x in 0..12usize {
                let p = Point::new(x as f64 + 0.5, 8.5 - y as f64);
                let around: i32 = c.iter().map(|c| winding(c, p)).sum();
                let v = gray.at(x, y);
                prop_assert!((v - 0.5).abs() < 1e-5 || around == i32::from(v >= 0.5), "({x}, {y}): {around}");
            }
        }
        // the same picture, the same contours; a quarter turn turns them
        prop_assert_eq!(&c, &all(&gray));
        let turned = Gray::from_fn(9, 12, |x, y| gray.at(11 - y, x));
        let area = |c: &[Contour]| c.iter().map(Contour::area).sum::<f64>();
        prop_assert!((area(&c) - area(&all(&turned))).abs() < 1e-9);
    }

    #[test]
    fn a_shift_of_a_disk_shifts_its_contour(dx in 0.0..1.0f64, dy in 0.0..1.0f64, r in 3.0..9.0f64) {
        let disk = picture(24, 24, |x: f64, y: f64| (x - 11.0 - dx).hypot(y - 11.0 - dy) < r);
        let c = traced(&disk);
        prop_assert_eq!(c.len(), 1);
        let centre = Point::new(11.0 + dx, 13.0 - dy);
        for p in c[0].points() {
            prop_assert!((p.distance(centre) - r).abs() < 0.15, "{:?}", p);
        }
    }

    #[test]
    fn contours_move_continuously_with_the_level(r in 3.0..9.0f64, level in 0.1..0.9f64) {
        let disk = picture(24, 24, |x: f64, y: f64| (x - 12.0).hypot(y - 12.0) < r);
        let at = |level| Contour::new(rings_at(&disk, level).remove(0)).unwrap().area();
        let (a, b) = (at(level), at(level + 0.001));
        prop_assert!(b <= a && a - b < 0.01 * 2.0 * std::f64::consts::PI * (r + 1.0), "{} {}", a, b);
    }
}

/// How often `c` goes around `p`.
fn winding(c: &Contour, p: Point) -> i32 {
    let points = c.points();
    let ends = points.iter().zip(points.iter().cycle().skip(1));
    ends.map(|(a, b)| {
        let side = (*b - *a).cross(p - *a);
        match (a.y <= p.y, b.y <= p.y) {
            (true, false) if side > 0.0 => 1,
            (false, true) if side < 0.0 => -1,
            _ => 0,
        }
    })
    .sum()
}
