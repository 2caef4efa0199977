//! The glyphs that every font has: `.notdef`, space and no-break space.

use super::{Draft, Options};
use crate::types::{Glyph, Info, Name, Outline};
use kurbo::{Rect, Shape};

/// Part of the mean small letter's advance that a space takes where such were drawn, and of the em where
/// none were, as in an Arabic font: what text fonts have.
const SPACE_OF_LETTER: f64 = 0.5;
const SPACE_OF_EM: f64 = 0.25;

/// Advance of `.notdef`, thickness of its frame, height without capitals: parts of the em.
const NOTDEF: (f64, f64, f64) = (0.5, 0.05, 0.7);

/// Names of the three.
const NAMES: [&str; 3] = [".notdef", "space", "uni00A0"];

/// Whether a drawn shape is one of those that are made here: the drawn one is taken over.
pub(super) fn is_basic(draft: &Draft) -> bool {
    NAMES.contains(&draft.id.name.as_str()) || matches!(draft.codepoints[..], [' ' | '\u{a0}'])
}

/// The three, in this order; a drawn `.notdef` and a space whose advance is known are kept.
pub(super) fn glyphs(drafts: &[Draft], info: &Info, options: &Options) -> Vec<Glyph> {
    let em = f64::from(info.units_per_em);
    let drawn = |name: &str| drafts.iter().find(|d| d.id.name.as_str() == name);
    let space = drawn("space")
        .filter(|d| d.given.is_some())
        .map(|d| d.advance)
        .or(options.space.map(|s| s * em))
        .unwrap_or_else(|| space(drafts, em))
        .round();
    let glyph = |name: &str, chars: Vec<char>, advance: f64| {
        Name::new(name).ok().map(|n| Glyph::new(n, chars, advance))
    };
    let (outline, advance) = match drawn(".notdef") {
        Some(d) => (d.outline.clone(), d.advance),
        None => (frame(em, info.metrics.cap_height), (NOTDEF.0 * em).round()),
    };
    let notdef = Glyph {
        outline,
        ..Glyph::new(Name::notdef(), Vec::new(), advance)
    };
    let spaces = [
        glyph("space", vec![' '], space),
        glyph("uni00A0", vec!['\u{a0}'], space),
    ];
    [Some(notdef)].into_iter().chain(spaces).flatten().collect()
}

fn space(drafts: &[Draft], em: f64) -> f64 {
    let is_small = |d: &&Draft| d.codepoints.first().is_some_and(|c| c.is_lowercase());
    let small: Vec<f64> = drafts.iter().filter(is_small).map(|d| d.advance).collect();
    if small.is_empty() {
        SPACE_OF_EM * em
    } else {
        SPACE_OF_LETTER * small.iter().sum::<f64>() / small.len() as f64
    }
}

/// An empty box: the sign of a missing glyph.
fn frame(em: f64, cap_height: f64) -> Outline {
    let (width, stroke, tall) = NOTDEF;
    let height = if cap_height > 0.0 {
        cap_height
    } else {
        tall * em
    };
    let (x0, x1) = ((stroke * em).round(), ((width - stroke) * em).round());
    let outer = Rect::new(x0, 0.0, x1, height.round());
    let inner = outer.inset(-(stroke * em).round());
    let contours = vec![outer.to_path(0.1), inner.to_path(0.1).reverse_subpaths()];
    Outline::new(contours).unwrap_or_default()
}
