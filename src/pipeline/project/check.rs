//! Values that a type alone cannot hold to their range. The decoder adds where they stand.

use super::SheetTable;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::ops::RangeInclusive;
use std::path::PathBuf;

/// Units an em that the OpenType specification allows.
const UNITS_PER_EM: RangeInclusive<u16> = 16..=16384;
/// Weight classes that the OpenType specification allows.
const WEIGHT: RangeInclusive<u16> = 1..=1000;

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
    let text = String::deserialize(from)?;
    match version_numbers(&text) {
        Some(_) => Ok(text),
        None => Err(D::Error::custom(
            "must be a whole number, a dot, and one to three digits, such as \"1.002\"",
        )),
    }
}

pub(super) fn units_per_em<'de, D: Deserializer<'de>>(from: D) -> Result<u16, D::Error> {
    within(u16::deserialize(from)?, &UNITS_PER_EM)
}

pub(super) fn weight<'de, D: Deserializer<'de>>(from: D) -> Result<u16, D::Error> {
    within(u16::deserialize(from)?, &WEIGHT)
}

fn within<E: Error>(value: u16, range: &RangeInclusive<u16>) -> Result<u16, E> {
    if range.contains(&value) {
        Ok(value)
    } else {
        let (low, high) = (range.start(), range.end());
        Err(E::custom(format!("must be between {low} and {high}")))
    }
}

pub(super) fn vendor<'de, D: Deserializer<'de>>(from: D) -> Result<String, D::Error> {
    let text = String::deserialize(from)?;
    let legal = |b: u8| (0x20..0x7f).contains(&b);
    if (1..=4).contains(&text.len()) && text.bytes().all(legal) {
        Ok(text)
    } else {
        Err(D::Error::custom("must be one to four ASCII characters"))
    }
}

/// Degrees from upright, either way.
pub(super) fn slant<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    let angle = f64::deserialize(from)?;
    if angle.abs() < 90.0 {
        Ok(angle)
    } else {
        Err(D::Error::custom("must be between -90 and 90 degrees"))
    }
}

/// Largest size in px or font units: what a font file's 16 bits hold.
const LARGEST: f64 = 32767.0;
/// Smallest size: below, coordinates leave these bits by far.
const SMALLEST: f64 = 0.001;

pub(super) fn optional_size<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    let size = f64::deserialize(from)?;
    if (SMALLEST..=LARGEST).contains(&size) {
        Ok(Some(size))
    } else {
        Err(D::Error::custom(
            "must be above 0, at least 0.001, and at most 32767",
        ))
    }
}

/// Degrees of a turn.
pub(super) fn optional_angle<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    let angle = f64::deserialize(from)?;
    if angle.abs() <= 360.0 {
        Ok(Some(angle))
    } else {
        Err(D::Error::custom("must be between -360 and 360 degrees"))
    }
}

/// A contour's coverage.
pub(super) fn optional_level<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    let level = f64::deserialize(from)?;
    if (0.1..=0.9).contains(&level) {
        Ok(Some(level))
    } else {
        Err(D::Error::custom("must be between 0.1 and 0.9"))
    }
}

pub(super) fn some_sheets<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<SheetTable>, D::Error> {
    let sheets = Vec::deserialize(from)?;
    if sheets.is_empty() {
        return Err(D::Error::custom("a font needs at least one [[sheet]]"));
    }
    Ok(sheets)
}

/// Major number and thousandths of a version such as `1.002` or `1.5`.
pub(super) fn version_numbers(text: &str) -> Option<(u16, u16)> {
    let (major, minor) = text.split_once('.')?;
    let digits = |s: &str| s.bytes().all(|b| b.is_ascii_digit());
    let minor =
        (digits(major) && digits(minor) && (1..=3).contains(&minor.len())).then_some(minor)?;
    Some((major.parse().ok()?, format!("{minor:0<3}").parse().ok()?))
}
