//! Dark ink and light ink on papers of many levels.

use super::*;
use crate::numeric::cast::index;
use image::{Rgb, RgbImage};

/// How the light falls: its share at a place of a picture of side 1.
type Light = fn(f64, f64) -> f64;

const LIGHTS: [Light; 5] = [
    |_, _| 1.0,
    |x, _| 1.0 - 0.6 * x,
    |x, y| 1.0 - 0.7 * x * y,
    |x, y| 1.0 - 1.2 * ((x - 0.5).powi(2) + (y - 0.5).powi(2)),
    |x, y| if x + 0.3 * y > 0.8 { 0.5 } else { 1.0 },
];

/// Letters of strokes of 6 px in rows, each with a counter: 1 where there is ink on a page of 400 × 320 px.
fn drawn(x: f64, y: f64) -> bool {
    let (column, row) = ((x - 30.0).rem_euclid(60.0), (y - 30.0).rem_euclid(52.0));
    let on_page = (30.0..370.0).contains(&x) && (30.0..290.0).contains(&y);
    let inside =
        |side: f64| column > side && column < 34.0 - side && row > side && row < 32.0 - side;
    on_page && inside(0.0) && !inside(6.0)
}

/// A page of 400 × 320 px whose paper and ink send back these shares of red, green and blue light; where a table is
/// given, in the middle of one, turned, so that it covers the share of the picture.
fn picture([paper, ink]: [[f64; 3]; 2], light: Light, table: Option<(f64, f64)>) -> RgbImage {
    let (w, h) = (400.0, 320.0);
    let wider = table.map_or(1.0, |(_, share)| share.sqrt().recip());
    let (s, c) = if table.is_some() {
        libm::sincos(4f64.to_radians())
    } else {
        (0.0, 1.0)
    };
    let level = |v: f64| u8::try_from(index(255.0 * v.clamp(0.0, 1.0) + 0.5)).unwrap();
    let side = |v: f64| u32::try_from(index(v * wider)).unwrap();
    RgbImage::from_fn(side(w), side(h), |x, y| {
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let (u, v) = (x - w * wider / 2.0, y - h * wider / 2.0);
        let (u, v) = (u * c + v * s + w / 2.0, v * c - u * s + h / 2.0);
        let on_page = (0.0..w).contains(&u) && (0.0..h).contains(&v);
        let sent = match table {
            Some((sent, _)) if !on_page => [sent * (1.0 + 0.15 * libm::sin(x / 9.0)); 3],
            _ if drawn(u, v) => ink,
            _ => paper,
        };
        let light = light(x / (w * wider), y / (h * wider));
        // each pixel its own noise
        let noise = (libm::sin(12.9898 * x + 78.233 * y) * 43_758.5).fract() * 0.01;
        Rgb(sent.map(|v| level(v * light + noise)))
    })
}

/// The sheet of a picture.
fn read(picture: RgbImage, polarity: Polarity) -> Sheet {
    sheet(
        Decoded {
            image: DynamicImage::ImageRgb8(picture),
            light: Tones::Linear.light().unwrap(),
            dpi: None,
        },
        "page".to_owned(),
        Reading {
            polarity,
            ..Reading::default()
        },
    )
    .unwrap()
}

/// Whether ink was told from paper: that of a page that fills its picture.
fn ink_is_ink(sheet: &Sheet) -> bool {
    sheet.gray.at(33, 33) > sheet.gray.at(25, 25) + 0.05
}

fn grey(level: f64) -> [f64; 3] {
    [level; 3]
}

#[test]
fn ink_is_told_from_paper_of_any_level() {
    let pairs = [
        (1.0, 0.0),
        (0.9, 0.1),
        (0.9, 0.6),
        (0.6, 0.1),
        (0.6, 0.3),
        (0.4, 0.05),
        (0.4, 0.15),
        (0.3, 0.05),
        (0.24, 0.04),
        (0.0, 1.0),
        (0.1, 0.9),
        (0.3, 0.9),
        (0.2, 0.5),
        (0.45, 0.8),
        (0.45, 0.95),
        (0.55, 1.0),
        (0.6, 0.98),
        (0.7, 1.0),
    ];
    for (paper, ink) in pairs {
        for (i, light) in LIGHTS.into_iter().enumerate() {
            let sheet = read(
                picture([grey(paper), grey(ink)], light, None),
                Polarity::Auto,
            );
            assert!(ink_is_ink(&sheet), "ink {ink} on paper {paper}, light {i}");
        }
    }
}

#[test]
fn ink_is_told_from_coloured_paper() {
    let (red, orange, kraft, blue, lime) = (
        [0.86, 0.12, 0.12],
        [1.0, 0.55, 0.0],
        [0.55, 0.38, 0.2],
        [0.12, 0.24, 0.8],
        [0.47, 0.86, 0.24],
    );
    let pairs = [
        (red, grey(0.05)),
        (kraft, grey(0.05)),
        (blue, grey(0.0)),
        (orange, grey(0.0)),
        (red, grey(1.0)),
        (orange, grey(1.0)),
        (lime, grey(1.0)),
        (blue, [1.0, 0.9, 0.0]),
    ];
    for (paper, ink) in pairs {
        for (i, light) in LIGHTS.into_iter().enumerate() {
            let sheet = read(picture([paper, ink], light, None), Polarity::Auto);
            assert!(
                ink_is_ink(&sheet),
                "ink {ink:?} on paper {paper:?}, light {i}"
            );
        }
    }
}

#[test]
fn a_light_page_on_a_dark_table_has_dark_ink() {
    for table in [0.02, 0.1, 0.2, 0.3, 0.45, 0.6] {
        for share in [0.2, 0.35, 0.5, 0.65, 0.8] {
            for (i, light) in LIGHTS.into_iter().enumerate() {
                for (paper, ink) in [(0.95, 0.1), (0.8, 0.3)] {
                    let picture = picture([grey(paper), grey(ink)], light, Some((table, share)));
                    let told = read(picture.clone(), Polarity::DarkInk);
                    let sheet = read(picture, Polarity::Auto);
                    let what = format!(
                        "ink {ink} on paper {paper}, table {table} around {share}, light {i}"
                    );
                    assert!(sheet.gray == told.gray, "{what}");
                }
            }
        }
    }
}

#[test]
fn a_light_drawing_on_black_is_ink() {
    // a ring, a frame with a cross in it, and a bar
    let shapes: [fn(f64, f64) -> bool; 3] = [
        |x, y| (60.0..110.0).contains(&x.hypot(y)),
        |x, y| {
            let in_square = |side: f64| x.abs() < side && y.abs() < side;
            in_square(120.0) && !in_square(90.0)
                || in_square(120.0) && (x.abs() < 15.0 || y.abs() < 15.0)
        },
        |x, y| x.abs() < 40.0 && y.abs() < 120.0,
    ];
    for (i, shape) in shapes.into_iter().enumerate() {
        let picture = RgbImage::from_fn(300, 300, |x, y| {
            let light = shape(f64::from(x) - 150.0, f64::from(y) - 150.0);
            Rgb(if light { [250; 3] } else { [10; 3] })
        });
        let sheet = read(picture, Polarity::Auto);
        assert!(sheet.gray.at(2, 2) < 0.1, "shape {i}");
    }
}

#[test]
fn doubt_about_the_ink_is_told() {
    let guessed = |picture: RgbImage| read(picture, Polarity::Auto).guessed;
    let flat = LIGHTS[0];
    assert_eq!(guessed(picture([grey(0.9), grey(0.1)], flat, None)), None);
    let light = picture([grey(0.1), grey(0.9)], flat, None);
    assert_eq!(
        read(light.clone(), Polarity::LightInk).guessed,
        None,
        "told"
    );
    assert_eq!(guessed(light), Some(Shade::Light));
    let table = picture([grey(0.9), grey(0.1)], flat, Some((0.1, 0.4)));
    assert_eq!(guessed(table), Some(Shade::Dark));
}
