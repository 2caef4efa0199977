//! Font units to the integers of a font file, checked.

use super::WriteError;
use crate::types::{Font, Glyph};
use kurbo::{BezPath, PathEl, Rect};
use std::collections::BTreeMap;

/// A number of font units as a signed 16-bit integer, rounded half up as FontTools does.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the range is checked first"
)]
pub(super) fn to_i16(value: f64, what: impl FnOnce() -> String) -> Result<i16, WriteError> {
    let rounded = (value + 0.5).floor();
    let fits = rounded >= f64::from(i16::MIN) && rounded <= f64::from(i16::MAX);
    let rounded = fits.then_some(rounded as i16);
    rounded.ok_or_else(|| WriteError::range(what(), value))
}

/// A number of font units as an unsigned 16-bit integer.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the range is checked first"
)]
pub(super) fn to_u16(value: f64, what: impl FnOnce() -> String) -> Result<u16, WriteError> {
    let rounded = (value + 0.5).floor();
    let fits = rounded >= 0.0 && rounded <= f64::from(u16::MAX);
    let rounded = fits.then_some(rounded as u16);
    rounded.ok_or_else(|| WriteError::range(what(), value))
}

/// Refuses coordinates so large that a difference of two would not fit the file.
pub(super) fn check(shape: &BezPath, glyph: &Glyph) -> Result<(), WriteError> {
    for el in shape.elements() {
        let points = match *el {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => [p; 3],
            PathEl::QuadTo(a, p) => [a, p, p],
            PathEl::CurveTo(a, b, p) => [a, b, p],
            PathEl::ClosePath => continue,
        };
        for v in points.iter().flat_map(|p| [p.x, p.y]) {
            to_i16(2.0 * v, || format!("a coordinate of {}", glyph.name))?;
        }
    }
    Ok(())
}

/// The glyphs' numbers by their names.
pub(super) fn ids(font: &Font) -> BTreeMap<&str, usize> {
    let names = font.glyphs().iter().map(|g| g.name.as_str());
    names.zip(0..).collect()
}

/// The box around all of some, of nothing where there is none.
pub(super) fn around(boxes: &[Option<Rect>]) -> Rect {
    let all = boxes.iter().flatten().copied().reduce(|a, b| a.union(b));
    all.unwrap_or(Rect::ZERO)
}

/// A count as a 16-bit number.
pub(super) fn count(n: usize, what: &str) -> Result<u16, WriteError> {
    u16::try_from(n).map_err(|_| WriteError::range(what, n))
}
