//! Ranges of the numbers that a project gives, parts of the em where they are lengths. The decoder adds where they
//! stand.

use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::ops::RangeInclusive;

/// Heights above the baseline and advances; depths below it; room that may be taken away, too.
const UP: RangeInclusive<f64> = 0.0..=4.0;
const DOWN: RangeInclusive<f64> = -4.0..=0.0;
const ROOM: RangeInclusive<f64> = -1.0..=4.0;
const SHARE: RangeInclusive<f64> = 0.0..=1.0;

fn within<E: Error>(value: f64, range: &RangeInclusive<f64>) -> Result<f64, E> {
    if range.contains(&value) {
        Ok(value)
    } else {
        let (low, high) = (range.start(), range.end());
        Err(E::custom(format!(
            "must be between {low} and {high}; lengths are parts of the em"
        )))
    }
}

fn optional<'de, D: Deserializer<'de>>(
    from: D,
    range: &RangeInclusive<f64>,
) -> Result<Option<f64>, D::Error> {
    let value = Option::<f64>::deserialize(from)?;
    value.map(|v| within(v, range)).transpose()
}

/// A share of something, or a length that no font exceeds.
pub(super) fn share<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(f64::deserialize(from)?, &SHARE)
}

/// A factor or a length upwards.
pub(super) fn up<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(f64::deserialize(from)?, &UP)
}

/// A height or an advance, where one is given.
pub(super) fn optional_up<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    optional(from, &UP)
}

/// A depth, where one is given.
pub(super) fn optional_down<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    optional(from, &DOWN)
}

/// Room beside a letter.
pub(super) fn room<'de, D: Deserializer<'de>>(from: D) -> Result<f64, D::Error> {
    within(f64::deserialize(from)?, &ROOM)
}

/// The same, where it is given.
pub(super) fn optional_room<'de, D: Deserializer<'de>>(from: D) -> Result<Option<f64>, D::Error> {
    optional(from, &ROOM)
}

/// Lower and upper edge of a stroke.
pub(super) fn edges<'de, D: Deserializer<'de>>(from: D) -> Result<Option<(f64, f64)>, D::Error> {
    let Some((low, high)) = Option::<(f64, f64)>::deserialize(from)? else {
        return Ok(None);
    };
    let range = *DOWN.start()..=*UP.end();
    if within::<D::Error>(low, &range)? < within::<D::Error>(high, &range)? {
        Ok(Some((low, high)))
    } else {
        Err(D::Error::custom(
            "must be the lower edge and then the upper one",
        ))
    }
}
