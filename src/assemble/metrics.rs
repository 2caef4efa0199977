//! Vertical measures from the drawn letters.
//!
//! Rule (Google Fonts' vertical metrics): the line is as tall as the ink, at least 1.2 em, without a
//! line gap, and the same in hhea and OS/2; what is missing to 1.2 em goes above and below in
//! proportion. x-height and cap height are the median tops of the flat letters, or of those with a bow above where
//! no other is drawn.

use super::Draft;
use crate::numeric::median::middle;
use crate::types::Metrics;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Ascender to descender at least, em.
const LEAST_LINE: f64 = 1.2;
/// Line heights are rounded outward to this part of the em.
const ROUND_TO: f64 = 0.01;
/// Lower-case letters whose top is flat at the x-height.
const FLAT_LOWER: &str = "xzvwyurnmı";
/// Capitals whose top is flat at the cap height.
const FLAT_UPPER: &str = "HEFIKLMNTXZ";

/// Letters that have a bow there.
const BOW_LOWER: &str = "aceos";
const BOW_UPPER: &str = "COSGQ";
/// How far bows reach past flat edges, part of the letter's height.
const OVERSHOOT: f64 = 0.015;

/// Vertical measures that a project sets by hand, parts of the em.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Heights {
    /// Above the baseline.
    #[serde(deserialize_with = "super::ranges::optional_up")]
    pub ascender: Option<f64>,
    /// Below the baseline, negative.
    #[serde(deserialize_with = "super::ranges::optional_down")]
    pub descender: Option<f64>,
    /// Between lines.
    #[serde(deserialize_with = "super::ranges::optional_up")]
    pub line_gap: Option<f64>,
    /// Height of x.
    #[serde(deserialize_with = "super::ranges::optional_up")]
    pub x_height: Option<f64>,
    /// Height of H.
    #[serde(deserialize_with = "super::ranges::optional_up")]
    pub cap_height: Option<f64>,
}

/// The measures of the drawn letters, font units.
pub(super) fn measure(drafts: &[Draft], em: f64, given: &Heights) -> Metrics {
    let or = |given: Option<f64>, measured: f64| given.map_or(measured, |v| v * em).round();
    let line = Metrics {
        line_gap: or(given.line_gap, 0.0),
        x_height: or(given.x_height, top(drafts, FLAT_LOWER, BOW_LOWER)),
        cap_height: or(given.cap_height, top(drafts, FLAT_UPPER, BOW_UPPER)),
        ..Metrics::default()
    };
    enclosing(line, drafts, em, given)
}

/// The same measures with a line as tall as the ink of these letters.
pub(super) fn enclosing(metrics: Metrics, drafts: &[Draft], em: f64, given: &Heights) -> Metrics {
    let boxes = drafts.iter().filter_map(|d| d.outline.bounds());
    let ink = boxes.reduce(|a, b| a.union(b));
    let (top, bottom) = ink.map_or((0.8 * em, -0.2 * em), |r| (r.y1.max(0.0), r.y0.min(0.0)));
    let step = ROUND_TO * em;
    let missing = (LEAST_LINE * em - (top - bottom)).max(0.0);
    let share = if top > bottom {
        top / (top - bottom)
    } else {
        0.8
    };
    let share = share.clamp(0.7, 0.85);
    let up = |v: f64| (v / step).ceil() * step;
    let or = |given: Option<f64>, measured: f64| given.map_or(measured, |v| v * em).round();
    Metrics {
        ascender: or(given.ascender, up(top + missing * share)),
        descender: or(given.descender, -up(-bottom + missing * (1.0 - share))),
        ..metrics
    }
}

/// The height that letters with a flat top share, or those with bows where none is drawn; 0 without any.
fn top(drafts: &[Draft], flat: &str, bows: &str) -> f64 {
    let of = |letters: &str| {
        let is_one = |d: &&Draft| d.codepoints.first().is_some_and(|c| letters.contains(*c));
        let drawn = drafts.iter().filter(is_one);
        let tops = drawn.filter_map(|d| Some(d.outline.bounds()?.y1));
        middle(tops, f64::total_cmp)
    };
    let bow = || Some(of(bows)? / (1.0 + OVERSHOOT));
    of(flat).or_else(bow).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kurbo::{Rect, Shape};

    #[test]
    fn few_letters_tell_the_heights() {
        let draft = |(label, top): (&str, f64)| {
            let stem = Rect::new(0.0, 0.0, 100.0, top.min(400.0)).to_path(0.1);
            let dot = Rect::new(0.0, top - 80.0, 100.0, top).to_path(0.1);
            Draft::drawn(label, vec![stem, dot])
        };
        for (letters, x, cap) in [
            (
                &[("a", 406.0), ("e", 406.0), ("i", 605.0), ("o", 406.0)][..],
                400.0,
                0.0,
            ),
            (&[("x", 400.0), ("o", 410.0), ("O", 711.0)], 400.0, 700.0),
            (&[("i", 605.0)], 0.0, 0.0),
        ] {
            let mut drafts: Vec<Draft> = letters.iter().copied().map(draft).collect();
            super::super::encode(&mut drafts);
            let found = measure(&drafts, 1000.0, &Heights::default());
            assert!((found.x_height - x).abs() < 1.5, "{letters:?}: {found:?}");
            assert!(
                (found.cap_height - cap).abs() < 1.5,
                "{letters:?}: {found:?}"
            );
        }
    }
}
