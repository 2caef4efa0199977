//! Tones of blurred edges.

/// The coverage of a blurred edge once the edge is moved to where its coverage was `level`: there it is a half, and
/// paper and ink stay what they are. The odds are multiplied, which moves an edge with a logistic profile without
/// changing its shape.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "pictures have 24 bit")]
pub fn at_half(coverage: f32, level: f64) -> f32 {
    if !(0.0..1.0).contains(&coverage) {
        return coverage;
    }
    let (v, odds) = (f64::from(coverage), (1.0 - level) / level);
    (v * odds / (v * odds + 1.0 - v)) as f32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_level_becomes_a_half_and_ends_stay() {
        for level in [0.2, 0.5, 0.7_f32] {
            assert!((at_half(level, f64::from(level)) - 0.5).abs() < 1e-6);
            for (v, w) in [(0.0, 0.0), (1.0, 1.0), (-0.2, -0.2), (1.3, 1.3)] {
                assert!((at_half(v, f64::from(level)) - w).abs() < 1e-6);
            }
        }
        assert!((at_half(0.3, 0.5) - 0.3).abs() < 1e-6);
    }

    #[test]
    fn a_logistic_edge_keeps_its_shape() {
        let edge = |x: f64| 1.0 / (1.0 + libm::exp(x));
        let level = edge(0.8);
        for i in -20..20 {
            let x = f64::from(i) / 5.0;
            #[expect(clippy::cast_possible_truncation, reason = "a test's edge")]
            let moved = at_half(edge(x + 0.8) as f32, level);
            assert!((f64::from(moved) - edge(x)).abs() < 1e-5);
        }
    }
}
