//! Font units to the integers of a font file, checked.

use super::WriteError;

/// A number of font units as a signed 16-bit integer, rounded half up as FontTools does.
#[expect(
    clippy::cast_possible_truncation,
    reason = "the range is checked first"
)]
pub(super) fn to_i16(value: f64, what: impl FnOnce() -> String) -> Result<i16, WriteError> {
    let rounded = (value + 0.5).floor();
    if rounded >= f64::from(i16::MIN) && rounded <= f64::from(i16::MAX) {
        Ok(rounded as i16)
    } else {
        Err(WriteError::Range {
            what: what(),
            value: format!("{value}"),
        })
    }
}

/// A number of font units as an unsigned 16-bit integer.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the range is checked first"
)]
pub(super) fn to_u16(value: f64, what: impl FnOnce() -> String) -> Result<u16, WriteError> {
    let rounded = (value + 0.5).floor();
    if rounded >= 0.0 && rounded <= f64::from(u16::MAX) {
        Ok(rounded as u16)
    } else {
        Err(WriteError::Range {
            what: what(),
            value: format!("{value}"),
        })
    }
}

/// A count as a 16-bit number.
pub(super) fn count(n: usize, what: &str) -> Result<u16, WriteError> {
    u16::try_from(n).map_err(|_| WriteError::Range {
        what: what.to_owned(),
        value: n.to_string(),
    })
}
