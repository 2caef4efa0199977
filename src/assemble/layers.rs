//! Glyphs of one colour that lie over each other where a letter was drawn in several inks.

use super::{Draft, Part};
use crate::types::{Glyph, Layer, Name, Outline};
use kurbo::Affine;
use std::collections::BTreeSet;

/// A glyph for every colour of every draft, and in `glyphs` the layers that they are. What is composed of drafts has
/// their colours; parts without one are in the text's.
pub(super) fn add(glyphs: &mut Vec<Glyph>, drafts: &[Draft]) {
    for (i, draft) in drafts.iter().enumerate() {
        let parts = super::parts(drafts, i);
        let plates = || parts.iter().flat_map(|part| plates(drafts, part));
        let colours: BTreeSet<Option<usize>> = plates().map(|p| p.0).collect();
        let own = glyphs.iter().position(|g| g.name == draft.id.name);
        let Some(own) = own.filter(|_| colours.iter().any(Option::is_some)) else {
            continue;
        };
        for colour in colours {
            let of_colour = plates().filter(|p| p.0 == colour);
            let contours = of_colour.flat_map(|p| p.1.contours().to_vec()).collect();
            let (Ok(name), Ok(outline)) = (name(&draft.id.name, i, colour), Outline::new(contours))
            else {
                continue;
            };
            let glyph = name.clone();
            glyphs[own].layers.push(Layer { glyph, colour });
            glyphs.push(Glyph {
                outline,
                ..Glyph::new(name, Vec::new(), draft.advance)
            });
        }
    }
}

/// The colours of a part, in its place: the text's where it has none.
fn plates(drafts: &[Draft], part: &Part) -> Vec<(Option<usize>, Outline)> {
    let shift = Affine::translate(part.shift);
    let Some(draft) = drafts.get(part.draft) else {
        return Vec::new();
    };
    if draft.plates.is_empty() {
        return vec![(None, draft.outline.transformed(shift))];
    }
    let plates = draft.plates.iter();
    let placed = plates.map(|(colour, own)| (Some(*colour), own.transformed(shift)));
    placed.collect()
}

/// The glyph's name and its colour; its number in place of a name that is too long.
fn name(of: &Name, number: usize, colour: Option<usize>) -> Result<Name, impl Sized> {
    let colour = colour.map_or_else(|| "text".to_owned(), |c| c.to_string());
    let short = || Name::new(format!("drawn{number}.color{colour}"));
    Name::new(format!("{of}.color{colour}")).or_else(|_| short())
}
