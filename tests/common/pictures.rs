//! Pictures that tests draw.

use image::{DynamicImage, GrayImage, ImageFormat, Luma};
use std::io::Cursor;

/// A picture as a file.
pub(crate) fn encoded(picture: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let written = picture.into().write_to(&mut bytes, format);
    written.expect("a picture in memory");
    bytes.into_inner()
}

/// A grey PNG of `width` × `height` px whose ink is `ink(x, y)`, 0…255.
pub(crate) fn png(width: u32, height: u32, ink: impl Fn(u32, u32) -> u8) -> Vec<u8> {
    let picture = GrayImage::from_fn(width, height, |x, y| Luma([255 - ink(x, y)]));
    encoded(picture, ImageFormat::Png)
}

/// The grey of a drawn edge at so many px outside of it.
pub(crate) fn edge(distance: f64) -> u8 {
    let ink = (0.5 - distance).clamp(0.0, 1.0) * 255.0;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0…255 by the clamp"
    )]
    let level = ink.round() as u8;
    level
}

/// The grey at (x, y) of a rectangle from (x0, y0) to (x1, y1).
pub(crate) fn bar((x, y): (f64, f64), [x0, y0, x1, y1]: [f64; 4]) -> u8 {
    edge((x0 - x).max(x - x1).max((y0 - y).max(y - y1)))
}

/// The grey at (x, y) of a ring of 18 px whose middle has a radius of 26 px.
pub(crate) fn ring((x, y): (f64, f64), centre: (f64, f64)) -> u8 {
    edge(((x - centre.0).hypot(y - centre.1) - 26.0).abs() - 9.0)
}

/// Nine cells of 200 × 200 px, three a row, all but those of `empty` with a letter: H, o and l by turns.
pub(crate) fn page(empty: &[usize]) -> Vec<u8> {
    png(600, 600, |x, y| {
        let cell = (y / 200 * 3 + x / 200) as usize;
        let at = (f64::from(x % 200) + 0.5, f64::from(y % 200) + 0.5);
        if empty.contains(&cell) {
            return 0;
        }
        match cell % 3 {
            0 => bar(at, [60.0, 50.0, 76.0, 150.0])
                .max(bar(at, [124.0, 50.0, 140.0, 150.0]))
                .max(bar(at, [70.0, 92.0, 130.0, 108.0])),
            1 => ring(at, (100.0, 116.0)),
            _ => bar(at, [92.0, 40.0, 108.0, 150.0]),
        }
    })
}

/// Names for them.
pub(crate) const LETTERS: &str = "H o l E e I N c L";
