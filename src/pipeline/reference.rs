//! Letters of a reference font as pictures: shaped, drawn, labelled as a project labels its cells.

use crate::assemble::names::{self, Identity};
use crate::numeric::cast::single;
use crate::read::Pen;
use crate::recognise::Sample;
use crate::types::{Form, Gray, Guides, Label};
use harfrust::{ShapeOptions, Shaper, ShaperData, UnicodeBuffer};
use kurbo::{Affine, BezPath, PathEl, Point, Rect, Shape, Vec2};
use resvg::tiny_skia::{Color, FillRule, Paint, PathBuilder, Pixmap, Transform};
use skrifa::outline::DrawSettings;
use skrifa::prelude::{LocationRef, Size};
use skrifa::{FontRef, GlyphId, MetadataProvider};
use std::collections::BTreeSet;
use thiserror::Error;

/// Pixels an em: the matching makes letters smaller than this.
const PX_PER_EM: f64 = 150.0;
/// Paper around the ink, px.
const MARGIN: f64 = 2.0;
/// What joins a letter without being a letter: nothing to be seen, and the stroke that draws a join out as
/// hands do.
const JOINERS: [char; 2] = ['\u{200D}', '\u{640}'];

/// Why a font is no reference.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum ReferenceError {
    /// The bytes are no font.
    #[error("the reference is no TTF or OTF font: {0}")]
    Font(String),
    /// It has none of the letters asked for.
    #[error("the reference font has none of the letters")]
    Empty,
}

/// Letters that joining scripts draw in four forms, and those that join to one side only.
const DUAL: &str = "بتثجحخسشصضطظعغفقكلمنهيئپچڤگ";
const RIGHT: &str = "اأإآدذرزوؤةىژ";
/// What lam and these make together.
const LAM_ALEF: &str = "اأإآ";
const ALONE: &str = "ء٠١٢٣٤٥٦٧٨٩";

/// Writing systems that the reference's letters are taken from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Script {
    /// A–Z, a–z, 0–9.
    Latin,
    /// Arabic letters in their forms, lam-alef, Arabic digits.
    Arabic,
}

impl Script {
    /// The letters that a sheet of this script may hold.
    #[must_use]
    pub fn letters(self) -> Vec<String> {
        match self {
            Self::Latin => ('0'..='9')
                .chain('A'..='Z')
                .chain('a'..='z')
                .map(String::from)
                .collect(),
            Self::Arabic => arabic(),
        }
    }

    /// The script of a character that letters of one script are told by.
    #[must_use]
    pub fn of(c: char) -> Option<Self> {
        match c {
            'A'..='Z' | 'a'..='z' | '0'..='9' => Some(Self::Latin),
            '\u{600}'..='\u{6FF}' => Some(Self::Arabic),
            _ => None,
        }
    }
}

fn arabic() -> Vec<String> {
    const ENDS: [Form; 2] = [Form::Isol, Form::Fina];
    let name = names::name_in;
    let dual = DUAL.chars().flat_map(|c| Form::ALL.map(|f| name(&[c], f)));
    let right = RIGHT.chars().flat_map(|c| ENDS.map(|f| name(&[c], f)));
    let pairs = LAM_ALEF.chars();
    let pairs = pairs.flat_map(|c| ENDS.map(|f| name(&['ل', c], f)));
    let alone = ALONE.chars().map(|c| names::name_of(&[c]));
    dual.chain(right).chain(pairs).chain(alone).collect()
}

/// The one spelling of a label by which letters are compared: characters' name and joining form, alternates left
/// out. A label that names no glyph stays as it is.
#[must_use]
pub fn spelling(label: &Label) -> String {
    let Ok(id) = names::identify(label) else {
        return label.0.clone();
    };
    names::name_in(&id.chars, id.form().unwrap_or(Form::Isol))
}

/// Pictures of the letters that the font has, in order: one of each label, and a second with the joins drawn out
/// of those that join.
///
/// # Errors
/// The bytes are no font, or it has none of these letters.
pub fn samples(
    font: &[u8],
    labels: impl IntoIterator<Item = String>,
) -> Result<Vec<Sample>, ReferenceError> {
    let face = FontRef::new(font).map_err(|e| ReferenceError::Font(e.to_string()))?;
    let data = ShaperData::new(&face);
    let shaper = data.shaper(&face).build();
    let metrics = face.metrics(Size::unscaled(), LocationRef::default());
    let units_per_em = f64::from(metrics.units_per_em);
    let mut seen = BTreeSet::new();
    let mut samples = Vec::new();
    for label in labels {
        let label = spelling(&Label(label));
        let Ok(id) = names::identify(&Label(label.clone())) else {
            continue;
        };
        if !seen.insert(label.clone()) {
            continue;
        }
        for text in texts(&id) {
            let drawn = set(&face, &shaper, &text).and_then(|path| draw(&path, units_per_em));
            samples.extend(drawn.map(|(gray, guides)| Sample {
                label: label.clone(),
                gray,
                guides: Some(guides),
            }));
        }
    }
    if samples.is_empty() {
        Err(ReferenceError::Empty)
    } else {
        Ok(samples)
    }
}

/// The texts that a shaper sets as this glyph, one for each of [`JOINERS`] where it joins.
fn texts(id: &Identity) -> Vec<String> {
    let form = id.form();
    let (before, after) = (
        form.is_some_and(Form::joins_before),
        form.is_some_and(Form::joins_after),
    );
    let ways = if before || after { JOINERS.len() } else { 1 };
    let text = |joiner: &char| -> String {
        let letters = id.chars.iter().copied();
        let start = before.then_some(*joiner).into_iter();
        start
            .chain(letters)
            .chain(after.then_some(*joiner))
            .collect()
    };
    JOINERS.iter().take(ways).map(text).collect()
}

/// The outlines of a text, font units; `None` where the font lacks one of its letters.
fn set(face: &FontRef<'_>, shaper: &Shaper<'_>, text: &str) -> Option<BezPath> {
    let mut buffer = UnicodeBuffer::new();
    buffer.push_str(text);
    buffer.guess_segment_properties();
    let shaped = shaper.shape(buffer, ShapeOptions::default());
    let mut path = BezPath::new();
    let mut pen = Vec2::ZERO;
    for (info, place) in shaped.glyph_infos().iter().zip(shaped.glyph_positions()) {
        if info.glyph_id == 0 {
            return None;
        }
        let offset = Vec2::new(f64::from(place.x_offset), f64::from(place.y_offset));
        path.extend(Affine::translate(pen + offset) * outline(face, info.glyph_id));
        pen += Vec2::new(f64::from(place.x_advance), f64::from(place.y_advance));
    }
    Some(path)
}

/// A glyph's outline, font units; empty where it has none.
fn outline(face: &FontRef<'_>, glyph: u32) -> BezPath {
    let mut pen = Pen::default();
    let settings = DrawSettings::unhinted(Size::unscaled(), LocationRef::default());
    let glyphs = face.outline_glyphs();
    let drawn = glyphs
        .get(GlyphId::new(glyph))
        .map(|g| g.draw(settings, &mut pen));
    match drawn {
        Some(Ok(_)) => pen.path(),
        _ => BezPath::new(),
    }
}

/// Ink of a path in font units, and where its baseline is; `None` without ink.
fn draw(path: &BezPath, units_per_em: f64) -> Option<(Gray, Guides)> {
    let scale = PX_PER_EM / units_per_em;
    let flipped = Affine::scale_non_uniform(scale, -scale) * path.clone();
    let bounds: Rect = flipped.bounding_box();
    let (width, height) = (pixels(bounds.width())?, pixels(bounds.height())?);
    let shift = (MARGIN - bounds.x0, MARGIN - bounds.y0);
    let mut builder = PathBuilder::new();
    for el in (Affine::translate(shift) * flipped).elements() {
        push(&mut builder, *el);
    }
    let mut picture = Pixmap::new(width, height)?;
    let mut paint = Paint::default();
    paint.set_color(Color::BLACK);
    paint.anti_alias = true;
    picture.fill_path(
        &builder.finish()?,
        &paint,
        FillRule::Winding,
        Transform::identity(),
        None,
    );
    let coverage = picture
        .pixels()
        .iter()
        .map(|p| f32::from(p.alpha()) / 255.0)
        .collect();
    let gray = Gray::new(width as usize, height as usize, coverage).ok()?;
    let guides = Guides {
        baseline_px: shift.1,
        px_per_em: PX_PER_EM,
        row: None,
    };
    Some((gray, guides))
}

/// Pixels that a side with its margins takes; `None` for what is no letter.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "checked before"
)]
fn pixels(side: f64) -> Option<u32> {
    /// Letters are a few em large at most.
    const MOST: f64 = 20.0 * PX_PER_EM;
    (side.is_finite() && side <= MOST).then(|| (side + 2.0 * MARGIN).ceil() as u32)
}

fn push(builder: &mut PathBuilder, el: PathEl) {
    let at = |p: Point| (single(p.x), single(p.y));
    match el {
        PathEl::MoveTo(p) => builder.move_to(at(p).0, at(p).1),
        PathEl::LineTo(p) => builder.line_to(at(p).0, at(p).1),
        PathEl::QuadTo(c, p) => {
            let [(cx, cy), (x, y)] = [c, p].map(at);
            builder.quad_to(cx, cy, x, y);
        }
        PathEl::CurveTo(a, b, p) => {
            let [(ax, ay), (bx, by), (x, y)] = [a, b, p].map(at);
            builder.cubic_to(ax, ay, bx, by, x, y);
        }
        PathEl::ClosePath => builder.close(),
    }
}
