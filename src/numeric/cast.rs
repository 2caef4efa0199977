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

/// The least whole number of steps that is not less; 0 for what is negative or no number.
#[must_use]
pub const fn ceiling(at: f64) -> usize {
    // without a call of the mathematical library, which `ceil` is for the oldest processors
    let below = index(at);
    if (below as f64) < at {
        below.saturating_add(1)
    } else {
        below
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ceilings_are_the_librarys() {
        for step in -40..400 {
            let at = f64::from(step) / 8.0;
            assert_eq!(ceiling(at), index(at.ceil()), "{at}");
        }
        assert_eq!(ceiling(f64::NAN), 0);
        assert_eq!(ceiling(f64::INFINITY), usize::MAX);
    }
}
