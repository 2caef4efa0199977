//! Between pixel counts and measures.

/// The whole number below a measure; 0 for what is negative or no number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates, and NaN becomes 0"
)]
pub(super) const fn floor(v: f64) -> usize {
    v as usize
}

/// A count as a measure.
pub(super) const fn ratio(v: usize) -> f32 {
    v as f32
}

/// A measure in the precision of pictures.
#[expect(clippy::cast_possible_truncation, reason = "pictures have 24 bit")]
pub(super) const fn narrow(v: f64) -> f32 {
    v as f32
}
