//! Room between letters: where each outline stands in its advance.

use super::names::Form;
use super::{Draft, Options};
use kurbo::Affine;

/// Places every draft and sets its advance.
pub(super) fn set(drafts: &mut [Draft], em: f64, options: &Options) {
    for draft in drafts {
        let (left, right) = ends(draft, em, options);
        let left = left.round();
        draft.outline = draft.outline.transformed(Affine::translate((-left, 0.0)));
        draft.advance = (right - left).max(0.0).round();
    }
}

/// Left and right end of the advance in the outline's own x.
fn ends(draft: &Draft, em: f64, options: &Options) -> (f64, f64) {
    let form = draft.id.form();
    if let (Some(given), None) = (draft.given, form) {
        return given;
    }
    let Some(ink) = draft.outline.bounds() else {
        return draft.given.unwrap_or((0.0, 0.0));
    };
    let (free, joined) = (options.sidebearing * em, -0.5 * options.overlap * em);
    let joins = |yes: Option<bool>| if yes == Some(true) { joined } else { free };
    (
        ink.x0 - joins(form.map(Form::joins_after)),
        ink.x1 + joins(form.map(Form::joins_before)),
    )
}
