//! Values that a type alone cannot hold to their range. The decoder adds where they stand.

use super::SheetTable;
use crate::quadratic;
use crate::types::style;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::path::PathBuf;

/// A value that must be `fine`; the error says what it must be.
pub(super) fn checked<'de, D: Deserializer<'de>, T: Deserialize<'de>>(
    from: D,
    fine: impl Fn(&T) -> bool,
    must: &str,
) -> Result<T, D::Error> {
    let value = Some(T::deserialize(from)?).filter(fine);
    value.ok_or_else(|| D::Error::custom(must))
}

pub(super) fn named<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let text = String::deserialize(from)?;
    match () {
        () if text.trim().is_empty() => {
            Err(D::Error::custom("must be a name of at least one letter"))
        }
        () if text.chars().any(char::is_control) => Err(D::Error::custom(
            "must be a name in one line, without control characters",
        )),
        () => Ok(text),
    }
}

/// One path, or a list of them.
pub(super) fn paths<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<PathBuf>, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "must be a path or a list of paths")]
    enum Paths {
        One(PathBuf),
        Many(Vec<PathBuf>),
    }
    Ok(match Paths::deserialize(from)? {
        Paths::One(path) => vec![path],
        Paths::Many(paths) => paths,
    })
}

pub(super) fn version<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let must = "must be a whole number, a dot, and one to three digits, such as \"1.002\"";
    checked(from, |text: &String| version_numbers(text).is_some(), must)
}

/// A way to quadratics whose options are in their ranges.
pub(super) fn conversion<'de, D: Deserializer<'de>>(
    from: D,
) -> Result<quadratic::Method, D::Error> {
    let method = quadratic::Method::deserialize(from)?;
    method.check().map(|()| method).map_err(D::Error::custom)
}

/// Units an em that the OpenType specification allows.
pub(super) fn units_per_em<'de, D: Deserializer<'de>>(from: D) -> Result<u16, D::Error> {
    let must = "must be between 16 and 16384";
    checked(from, |units| (16..=16384).contains(units), must)
}

/// Weight classes that the OpenType specification allows.
pub(super) fn weight<'de, D: Deserializer<'de>>(from: D) -> Result<Option<u16>, D::Error> {
    let must = "must be between 1 and 1000";
    checked(from, |weight| (1..=1000).contains(weight), must).map(Some)
}

pub(super) fn postscript<'de, D: Deserializer<'de>>(from: D) -> Result<Option<String>, D::Error> {
    let must = "must be a PostScript name, such as \"Khatt-Bold\": 1 to 63 ASCII characters, no space and none of \
                [](){}<>/%";
    checked(from, |name: &String| style::is_postscript(name), must).map(Some)
}

pub(super) fn vendor<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let legal = |text: &String| {
        (1..=4).contains(&text.len()) && text.bytes().all(|b| (0x20..0x7f).contains(&b))
    };
    checked(from, legal, "must be one to four ASCII characters")
}

/// Degrees from upright, either way.
pub(super) fn slant<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    let must = "must be between -90 and 90 degrees";
    checked(from, |angle: &f64| angle.abs() < 90.0, must)
}

/// A size in px or font units, of what a font file's 16 bits hold.
pub(super) fn optional_size<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    let must = "must be above 0, at least 0.001, and at most 32767";
    checked(from, |size| (0.001..=32767.0).contains(size), must).map(Some)
}

/// Degrees of a turn.
pub(super) fn optional_angle<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    let must = "must be between -360 and 360 degrees";
    checked(from, |angle: &f64| angle.abs() <= 360.0, must).map(Some)
}

/// A contour's coverage.
pub(super) fn optional_level<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    let must = "must be between 0.1 and 0.9";
    checked(from, |level| (0.1..=0.9).contains(level), must).map(Some)
}

pub(super) fn some_sheets<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<SheetTable>, D::Error> {
    let must = "a font needs at least one [[sheet]]";
    checked(from, |sheets: &Vec<_>| !sheets.is_empty(), must)
}

/// Major number and thousandths of a version such as `1.002` or `1.5`.
pub(super) fn version_numbers(text: &str) -> Option<(u16, u16)> {
    let (major, minor) = text.split_once('.')?;
    let digits = |s: &str| s.bytes().all(|b| b.is_ascii_digit());
    let minor =
        (digits(major) && digits(minor) && (1..=3).contains(&minor.len())).then_some(minor)?;
    Some((major.parse().ok()?, format!("{minor:0<3}").parse().ok()?))
}
