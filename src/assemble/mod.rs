//! Outlines → Font: names, metrics, spacing, joining, features.
//!
//! [`font`] takes drawn shapes with their labels and gives a [`Font`] that sets text: glyphs named and
//! encoded, placed between sidebearings, joined where the script joins, with `.notdef`, space and
//! no-break space.

mod basics;
pub mod compose;
mod features;
pub mod joining;
pub mod kerning;
mod layers;
pub mod level;
mod marks;
pub mod metrics;
pub mod names;
mod nearest;
mod profile;
mod ranges;
pub mod spacing;
mod stroke;
mod tails;
pub mod words;

pub use stroke::Side;

use crate::types::{Anchor, Component, Font, FontError, Form, Glyph, Info, Label, Name, Outline};
use kurbo::{Affine, Vec2};
use names::{Identity, LabelError};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use thiserror::Error;
use unicode_joining_type::{JoiningType, get_joining_type};
use unicode_normalization::char::is_combining_mark;

/// Why drawn shapes make no font.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum AssembleError {
    /// A label names no glyph.
    #[error("glyph {}: {source}", index + 1)]
    Label {
        /// position among the drawn shapes, from 0
        index: usize,
        /// why
        source: LabelError,
    },
    /// Two shapes have one name.
    #[error("glyphs {} and {} are both {name}; rename one or skip its cell with “_”", first + 1, second + 1)]
    Twice {
        /// the name
        name: String,
        /// position of the first, from 0
        first: usize,
        /// position of the second
        second: usize,
    },
    /// The glyphs do not fit together.
    #[error(transparent)]
    Font(#[from] FontError),
}

/// A shape that someone drew, in font units.
#[derive(Debug, Clone)]
pub struct Drawn {
    /// What it is said to be.
    pub label: Label,
    /// Its contours, y measured from the baseline.
    pub outline: Outline,
    /// The part of each ink, by the ink, the lowest first; empty where inks make no layers.
    pub plates: Vec<(String, Outline)>,
    /// Left and right end of its advance where they are known, in the outline's own x.
    pub advance: Option<(f64, f64)>,
}

/// How shapes become a font. Lengths are parts of the em.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Room beside letters.
    pub letters: spacing::Room,
    /// How pairs of letters are drawn together.
    pub kerning: kerning::Options,
    /// How the strokes of joined letters meet.
    pub joining: joining::Options,
    /// Advance of the space; without it, from the letters.
    #[serde(deserialize_with = "ranges::optional_up")]
    pub space: Option<f64>,
    /// Vertical measures; those left out are measured.
    pub heights: metrics::Heights,
    /// Letters composed of others: `[compose]` of a project.
    #[serde(skip)]
    pub compose: compose::Options,
    /// Anchors by hand: `[anchors]` of a project.
    #[serde(skip)]
    pub anchors: Anchors,
    /// Written words, whose gaps say how much room letters have.
    #[serde(skip)]
    pub words: Vec<words::Word>,
    /// The inks that are layers and how they look, red, green and blue: they become the palette.
    #[serde(skip)]
    pub inks: Vec<(String, [u8; 3])>,
}

/// Anchors set by hand, font units: by glyph name and their own.
pub type Anchors = BTreeMap<String, BTreeMap<String, (f64, f64)>>;

/// Something that a user should know about a font that was built all the same.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Note {
    /// The glyph it is about.
    pub glyph: String,
    /// What could not be done, and what to do about it.
    pub message: String,
}

/// A font and what could not be met.
#[derive(Debug, Clone)]
pub struct Assembled {
    /// The font.
    pub font: Font,
    /// Remarks, a stage after the other, each in glyph order.
    pub notes: Vec<Note>,
    /// How the strokes of joined letters were brought together.
    pub joining: joining::Report,
    /// The gaps of written words beside those of the font.
    pub gaps: Vec<words::Gap>,
}

/// A drawn shape whose label is understood.
#[derive(Debug, Clone)]
struct Draft {
    id: Identity,
    codepoints: Vec<char>,
    outline: Outline,
    /// Its colours, each with its place in the palette, the lowest first.
    plates: Vec<(usize, Outline)>,
    given: Option<(f64, f64)>,
    /// Left and right end of the advance where a stroke joins.
    joint: (Option<f64>, Option<f64>),
    /// Height of the cursive anchor at the left and right end of the advance.
    cursive: (Option<f64>, Option<f64>),
    advance: f64,
    /// What it is composed of; empty for what was drawn.
    parts: Vec<Part>,
}

/// A draft that is part of another.
#[derive(Debug, Clone, Copy)]
struct Part {
    /// Its position among the drafts.
    draft: usize,
    /// From its place to the one in the whole, font units.
    shift: Vec2,
}

impl Draft {
    /// Moves what was drawn to the right.
    fn shift(&mut self, by: f64) {
        let shift = Affine::translate((by, 0.0));
        let plates = self.plates.iter_mut().map(|p| &mut p.1);
        for outline in plates.chain([&mut self.outline]) {
            *outline = outline.transformed(shift);
        }
    }

    /// A drawn shape of which nothing is known but what it is.
    fn new(id: Identity, outline: Outline) -> Self {
        Self {
            id,
            codepoints: Vec::new(),
            outline,
            plates: Vec::new(),
            given: None,
            joint: (None, None),
            cursive: (None, None),
            advance: 0.0,
            parts: Vec::new(),
        }
    }

    /// Whether it is an Arabic letter, or a ligature that begins with one.
    fn is_arabic_letter(&self) -> bool {
        let is_letter = |c: &char| features::is_arabic(*c) && c.is_alphabetic();
        !self.is_mark() && self.id.chars.first().is_some_and(is_letter)
    }

    /// Whether its last letter never joins the next.
    fn never_joins(&self) -> bool {
        let last = self.id.chars.last();
        last.is_some_and(|c| get_joining_type(*c) == JoiningType::RightJoining)
    }

    /// Whether it is a sign that stands above or below letters.
    fn is_mark(&self) -> bool {
        matches!(self.id.chars[..], [c] if is_combining_mark(c))
    }
}

/// Builds the font of these shapes, in their order.
///
/// # Errors
/// A label names no glyph, or two shapes have one name or character.
pub fn font(
    drawn: Vec<Drawn>,
    mut info: Info,
    options: &Options,
) -> Result<Assembled, AssembleError> {
    let mut drafts = drafts(drawn, &options.inks)?;
    encode(&mut drafts);
    let em = f64::from(info.units_per_em);
    info.metrics = metrics::measure(&drafts, em, &options.heights);
    let (joining, mut notes) = joining::set(&mut drafts, em, &options.joining);
    let stroke = joining.contract.map(|c| c.edges.1 - c.edges.0);
    let (gaps, unread) = spacing::set(&mut drafts, &info, stroke, options);
    notes.extend(unread);
    notes.extend(compose::add(
        &mut drafts,
        em,
        &options.compose,
        &options.anchors,
    ));
    encode(&mut drafts);
    info.metrics = metrics::enclosing(info.metrics, &drafts, em, &options.heights);
    let rhythm = spacing::Rhythm::of(&drafts, &info);
    let kerning = kerning::pairs(&drafts, rhythm, em, &options.kerning);
    let mut glyphs = basics::glyphs(&drafts, &info, options);
    let (features, missing) = features::text(&drafts);
    notes.extend(missing);
    let anchors = marks::anchors(&drafts, em);
    let names: Vec<Name> = drafts.iter().map(|d| d.id.name.clone()).collect();
    let letters = drafts
        .iter()
        .zip(anchors)
        .filter(|(d, _)| !basics::is_basic(d));
    glyphs.extend(letters.map(|(draft, anchors)| glyph(draft, anchors, &names)));
    layers::add(&mut glyphs, &drafts);
    let mut font = Font::new(info, glyphs)?;
    font.palette = options.inks.iter().map(|ink| ink.1).collect();
    font.features = features;
    font.kerning = kerning;
    Ok(Assembled {
        font,
        notes,
        joining,
        gaps,
    })
}

fn glyph(draft: &Draft, anchors: Vec<Anchor>, names: &[Name]) -> Glyph {
    let component = |part: &Part| {
        Some(Component {
            base: names.get(part.draft)?.clone(),
            place: Affine::translate(part.shift),
        })
    };
    let components: Vec<Component> = draft.parts.iter().filter_map(component).collect();
    let own = components.is_empty().then(|| draft.outline.clone());
    Glyph {
        outline: own.unwrap_or_default(),
        components,
        anchors,
        ..Glyph::new(
            draft.id.name.clone(),
            draft.codepoints.clone(),
            draft.advance,
        )
    }
}

/// Reads the labels.
fn drafts(drawn: Vec<Drawn>, inks: &[(String, [u8; 3])]) -> Result<Vec<Draft>, AssembleError> {
    let mut seen: BTreeMap<String, usize> = BTreeMap::new();
    let mut out = Vec::with_capacity(drawn.len());
    for (index, shape) in drawn.into_iter().enumerate() {
        let id = names::identify(&shape.label)
            .map_err(|source| AssembleError::Label { index, source })?;
        if let Some(first) = seen.insert(id.name.to_string(), index) {
            let (name, second) = (id.name.to_string(), index);
            return Err(AssembleError::Twice {
                name,
                first,
                second,
            });
        }
        let plates = shape.plates.into_iter().filter_map(|(ink, outline)| {
            let colour = inks.iter().position(|i| i.0 == ink)?;
            Some((colour, outline))
        });
        out.push(Draft {
            plates: plates.collect(),
            given: shape.advance,
            ..Draft::new(id, shape.outline)
        });
    }
    Ok(out)
}

/// A draft as parts of another: itself, or what it is composed of.
fn parts(drafts: &[Draft], draft: usize) -> Vec<Part> {
    match drafts.get(draft) {
        Some(d) if !d.parts.is_empty() => d.parts.clone(),
        _ => vec![Part {
            draft,
            shift: Vec2::ZERO,
        }],
    }
}

/// The plain drawing of these characters in a form.
fn find(drafts: &[Draft], chars: &[char], form: Form) -> Option<usize> {
    drafts.iter().position(|d| {
        d.id.chars == chars
            && d.id.alternates().next().is_none()
            && d.id.form().unwrap_or(Form::Isol) == form
    })
}

/// Gives each character to the glyph without suffix, or else to the form that stands in for it. An
/// alternate alone does not stand for its character: the plain letter was not drawn.
fn encode(drafts: &mut [Draft]) {
    let mut owners: BTreeMap<char, (usize, usize)> = BTreeMap::new();
    for (i, draft) in drafts.iter_mut().enumerate() {
        draft.codepoints.clear();
        let [c] = draft.id.chars[..] else { continue };
        if draft.id.suffixes.is_empty() {
            draft.codepoints = vec![c];
            owners.insert(c, (0, i));
        } else if let (Some(form), None) = (draft.id.form(), draft.id.alternates().next()) {
            let rank = Form::ALL
                .iter()
                .position(|f| *f == form)
                .map_or(0, |p| p + 1);
            let owner = owners.entry(c).or_insert((rank, i));
            *owner = (rank, i).min(*owner);
        }
    }
    for (c, (_, i)) in owners {
        if let Some(d) = drafts.get_mut(i) {
            d.codepoints = vec![c];
        }
    }
}

#[cfg(test)]
mod tests;
