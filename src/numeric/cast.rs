//! The few conversions that could lose something, and why they do not.

/// A whole number of steps: the integer part, 0 for what is negative or no number.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "`as` saturates: negative and NaN give 0, what is too large the largest"
)]
pub const fn index(at: f64) -> usize {
    at as usize
}

/// The nearest `f32`.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    reason = "rounding is what is asked for"
)]
pub const fn single(value: f64) -> f32 {
    value as f32
}
