//! Room between letters: where each outline stands in its advance.

use super::{Draft, Options};
use kurbo::Affine;

/// Places every draft and sets its advance.
pub(super) fn set(drafts: &mut [Draft], em: f64, options: &Options) {
    for draft in drafts {
        let (left, right) = ends(draft, em, options);
        draft.outline = draft.outline.transformed(Affine::translate((-left, 0.0)));
        draft.advance = (right - left).max(0.0).round();
    }
}

/// Left and right end of the advance in the outline's own x: at the joint where a side joins, else
/// where the page says, else a sidebearing away from the ink.
fn ends(draft: &Draft, em: f64, options: &Options) -> (f64, f64) {
    let free = options.sidebearing * em;
    let ink = draft
        .outline
        .bounds()
        .map_or((0.0, 0.0), |r| (r.x0 - free, r.x1 + free));
    let (left, right) = draft.given.unwrap_or(ink);
    (
        draft.joint.0.unwrap_or(left),
        draft.joint.1.unwrap_or(right),
    )
}
