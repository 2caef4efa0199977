//! Letters composed of others: dotless skeletons and dots, letters and accents.
//!
//! What is drawn whole is taken as it is. Of what is left, a letter is composed in each form that its body was
//! drawn in: an Arabic letter of its skeleton (rasm) and dots, others by their canonical decompositions. Bodies
//! are spaced and joined already; a composed letter has its body's advance and joins, more only where a sign
//! would stand out. Dots keep a gap from their body (`place`); marks attach as they do in text, by anchors. i and j
//! lose their dot under a mark: ı is taken if it is drawn, and else i without the piece above it.

mod place;
mod recipes;

use super::marks::{self, Place};
use super::names;
use super::profile::Profile;
use super::{Anchors, Draft, Note, Part};
use crate::types::{Anchor, Form, Label, Outline};
use kurbo::{Affine, Point, Rect, Vec2};
use recipes::{Dots, Recipe};
use serde::{Deserialize, Serialize};
use std::cmp::Reverse;
use std::collections::BTreeMap;
use unicode_normalization::char::{canonical_combining_class, decompose_compatible};

/// What is composed, and how. Lengths are parts of the em.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Alphabets and single letters; none of them, nothing is composed.
    pub letters: Vec<Letters>,
    /// White between a letter's body and its dots, 0…1.
    #[serde(deserialize_with = "super::ranges::share")]
    pub gap: f64,
    /// White between the dots of a group made of single ones, part of a dot's width, 0…1.
    #[serde(deserialize_with = "super::ranges::share")]
    pub between: f64,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            letters: Vec::new(),
            gap: 0.05,
            between: 0.2,
        }
    }
}

/// An alphabet (`arabic`, `persian`, `urdu`, `latin`), or one letter that others compose.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(try_from = "String", into = "String")]
pub struct Letters {
    word: String,
    letters: Vec<char>,
}

impl TryFrom<String> for Letters {
    type Error = String;

    fn try_from(word: String) -> Result<Self, String> {
        let single = || {
            let id = names::identify(&Label(word.clone())).ok()?;
            let [letter] = id.chars[..] else { return None };
            let forms = recipes::forms(letter).iter();
            let made = forms
                .map(|f| recipes::recipe(letter, *f))
                .any(|r| r.is_some());
            made.then(|| vec![letter])
        };
        match recipes::alphabet(&word).or_else(single) {
            Some(letters) => Ok(Self { word, letters }),
            None => Err(format!(
                "“{word}” is neither an alphabet (arabic, persian, urdu, latin) nor a letter that others compose"
            )),
        }
    }
}

impl From<Letters> for String {
    fn from(letters: Letters) -> Self {
        letters.word
    }
}

/// How much of a letter's top a sign beside it looks at, where the letter ends below it, em.
const TIP: f64 = 0.05;

/// Overlap of a mark that grows from its letter, em.
const ROOT: f64 = 0.01;

/// Adds the letters that the options ask for and nobody drew.
pub(super) fn add(
    drafts: &mut Vec<Draft>,
    em: f64,
    options: &Options,
    by_hand: &Anchors,
) -> Vec<Note> {
    let mut notes = Vec::new();
    let mut work = Work {
        drafts,
        em,
        options,
        by_hand,
    };
    for set in &options.letters {
        let mut left = Vec::new();
        for &letter in &set.letters {
            let missing = work.letter(letter);
            if !work.drafts.iter().any(|d| d.id.chars == [letter]) {
                left.push((letter, missing));
            }
        }
        if set.word == recipes::LATIN {
            notes.extend(summary(&set.word, &left));
        } else {
            notes.extend(
                left.into_iter()
                    .map(|(letter, missing)| note(letter, missing)),
            );
        }
    }
    work.ligatures();
    notes
}

/// What a large set lacks: the parts that are missing, or letters that have none, those of most letters first. Most
/// fonts lack many of its letters on purpose.
fn summary(set: &str, left: &[(char, Option<Lack>)]) -> Option<Note> {
    /// Parts that are named.
    const TOLD: usize = 12;
    let mut parts: BTreeMap<Lack, usize> = BTreeMap::new();
    for &(letter, part) in left {
        *parts.entry(part.unwrap_or(Lack::Part(letter))).or_default() += 1;
    }
    let mut parts: Vec<(Lack, usize)> = parts.into_iter().collect();
    parts.sort_by_key(|&(_, letters)| Reverse(letters));
    let part = |&(lack, letters): &(Lack, usize)| match lack {
        Lack::Part(part) => format!("{} for {letters}", code(part)),
        Lack::Place(part) => format!("a place for {} in {letters}", code(part)),
    };
    let mut told: Vec<String> = parts.iter().take(TOLD).map(part).collect();
    if parts.len() > TOLD {
        told.push(format!("{} more", parts.len() - TOLD));
    }
    let message = format!(
        "{} letters are neither drawn nor composed for lack of {}",
        left.len(),
        told.join(", ")
    );
    (!told.is_empty()).then(|| Note {
        glyph: set.to_owned(),
        message,
    })
}

/// A character's glyph and code.
fn code(c: char) -> String {
    format!("{} (U+{:04X})", names::name_of(&[c]), u32::from(c))
}

/// What a letter's body is in that form where it is composed, likeliest first.
pub(super) fn bodies(letter: char, form: Form) -> Vec<char> {
    recipes::recipe(letter, form).map_or_else(Vec::new, |r| r.bodies)
}

fn note(letter: char, missing: Option<Lack>) -> Note {
    let message = match missing {
        Some(Lack::Place(part)) => format!(
            "neither drawn nor composed: no rule says where its part {} stands; draw the whole letter",
            code(part)
        ),
        Some(Lack::Part(part)) => format!(
            "neither drawn nor composed: its part {} is missing; draw it, or the whole letter",
            code(part)
        ),
        None => "not drawn, and made of no other letter; draw it".to_owned(),
    };
    Note {
        glyph: names::name_of(&[letter]),
        message,
    }
}

/// What a letter cannot be composed for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Lack {
    /// A part that nobody drew.
    Part(char),
    /// Where a mark stands that was drawn.
    Place(char),
}

/// Drafts in the making.
struct Work<'a> {
    drafts: &'a mut Vec<Draft>,
    em: f64,
    options: &'a Options,
    by_hand: &'a Anchors,
}

/// A sign over or under a body: the pieces it consists of, and where all of it lies.
struct Sign {
    parts: Vec<Part>,
    ink: Rect,
    side: Place,
}

impl Work<'_> {
    /// Composes a letter in every form that is missing and can be had; what is lacked first.
    fn letter(&mut self, letter: char) -> Option<Lack> {
        let mut missing = None;
        for &form in recipes::forms(letter) {
            if self.find(letter, form).is_some() {
                continue;
            }
            let Some(recipe) = recipes::recipe(letter, form) else {
                continue;
            };
            match self.compose(&[letter], form, &recipe) {
                Ok(draft) => self.drafts.extend(draft),
                Err(lack) => missing = missing.or(Some(lack)),
            }
        }
        missing
    }

    /// Ligatures that end in a letter of which marks make others: لا gives لأ. Of letters that join alone: accents
    /// have no place on fi, whose dot would stay.
    fn ligatures(&mut self) {
        let wanted = self.options.letters.iter().flat_map(|l| l.letters.clone());
        let wanted: Vec<char> = wanted.filter(|&c| recipes::forms(c).len() > 1).collect();
        for i in 0..self.drafts.len() {
            let Some(ligature) = self.drafts.get(i).map(|d| d.id.clone()) else {
                continue;
            };
            let ([first, last], None) = (&ligature.chars[..], ligature.alternates().next()) else {
                continue;
            };
            let form = ligature.form().unwrap_or(Form::Isol);
            for &letter in &wanted {
                let Some(recipe) = recipes::recipe(letter, Form::Isol) else {
                    continue;
                };
                let chars = [*first, letter];
                let has = self
                    .drafts
                    .iter()
                    .any(|d| d.id.chars == chars && d.id.form().unwrap_or(Form::Isol) == form);
                if recipe.bodies == [*last] && !has {
                    let draft = self.signed(i, &chars, form, &recipe.signs);
                    self.drafts.extend(draft.ok().flatten());
                }
            }
        }
    }

    /// The drawn or composed form of a letter.
    fn find(&self, letter: char, form: Form) -> Option<usize> {
        super::find(self.drafts, &[letter], form)
    }

    /// A letter of its parts, or what it lacks.
    fn compose(
        &mut self,
        chars: &[char],
        form: Form,
        recipe: &Recipe,
    ) -> Result<Option<Draft>, Lack> {
        let loses_dot = recipe.signs.first().and_then(|&m| marks::place(m)) == Some(Place::Top);
        let body = recipe.bodies.iter().find_map(|&b| match b {
            'i' if loses_dot => self.dotless('i', 'ı'),
            'j' if loses_dot => self.dotless('j', 'ȷ'),
            _ => self.find(b, form),
        });
        let body =
            body.ok_or_else(|| Lack::Part(recipe.bodies.first().copied().unwrap_or_default()))?;
        self.signed(body, chars, form, &recipe.signs)
    }

    /// A body with its signs; nothing where a name or place cannot be given.
    fn signed(
        &self,
        body: usize,
        chars: &[char],
        form: Form,
        signs: &[char],
    ) -> Result<Option<Draft>, Lack> {
        let label = Label(names::name_in(chars, form));
        let (Ok(id), Some(base)) = (names::identify(&label), self.drafts.get(body)) else {
            return Ok(None);
        };
        let mut above: Vec<Sign> = Vec::new();
        for &sign in signs {
            let placed = match recipes::dots(sign) {
                Some(dots) => self.dots(base, dots),
                None => self.mark(base, sign, &above),
            };
            let is_drawn = || recipes::dots(sign).is_none() && self.find_mark(sign).is_some();
            let lack = || {
                if is_drawn() {
                    Lack::Place(sign)
                } else {
                    Lack::Part(sign)
                }
            };
            above.push(placed.ok_or_else(lack)?);
        }
        let mut parts = super::parts(self.drafts, body);
        parts.extend(above.iter().flat_map(|s| s.parts.iter().copied()));
        // a sign keeps inside the advance where nothing joins
        let out = |joined: Option<f64>, by: f64| joined.map_or(by.max(0.0).ceil(), |_| 0.0);
        let ink = above.iter().map(|s| s.ink).reduce(|a, b| a.union(b));
        let (left, right) = ink.map_or((0.0, 0.0), |ink| {
            (
                out(base.joint.0, -ink.x0),
                out(base.joint.1, ink.x1 - base.advance),
            )
        });
        parts.iter_mut().for_each(|p| p.shift.x += left);
        Ok(Some(Draft {
            id,
            outline: self.outline(&parts),
            plates: Vec::new(),
            advance: base.advance + left + right,
            parts,
            ..base.clone()
        }))
    }

    fn outline(&self, parts: &[Part]) -> Outline {
        let contours = parts.iter().flat_map(|part| {
            let own = self.drafts.get(part.draft).map(|d| d.outline.contours());
            own.into_iter()
                .flatten()
                .map(|c| Affine::translate(part.shift) * c)
        });
        Outline::new(contours.collect()).unwrap_or_default()
    }

    /// An anchor set by hand.
    fn by_hand(&self, draft: &Draft, anchor: &str) -> Option<Point> {
        let &(x, y) = self.by_hand.get(draft.id.name.as_str())?.get(anchor)?;
        Some(Point::new(x, y))
    }

    /// The dots of a body where they belong.
    fn dots(&self, base: &Draft, dots: Dots) -> Option<Sign> {
        let parts = self.group(dots)?;
        let ink = self.outline(&parts).bounds()?;
        let (name, edge) = match dots.side {
            Place::Top => ("above", ink.y0),
            Place::Bottom => ("below", ink.y1),
        };
        let at = self.by_hand(base, name).or_else(|| {
            let body = place::Body {
                letter: base.id.chars.first().copied().unwrap_or_default(),
                is_end: base.id.form().is_none_or(|f| !f.joins_after()),
                outline: &base.outline,
                tooth: self.tooth(),
                gap: self.options.gap * self.em,
                em: self.em,
            };
            body.place(ink.size(), dots.side)
        })?;
        let sign = Sign {
            parts,
            ink,
            side: dots.side,
        };
        Some(sign.moved(at - Point::new(ink.center().x, edge)))
    }

    /// A group of dots as it was drawn, or of single ones.
    fn group(&self, dots: Dots) -> Option<Vec<Part>> {
        let find = |chars: &[char]| chars.iter().find_map(|&c| self.find(c, Form::Isol));
        if let Some(drawn) = find(dots.drawn) {
            return Some(super::parts(self.drafts, drawn));
        }
        let single = find(&recipes::SINGLE).filter(|_| !dots.places.is_empty())?;
        let size = self.drafts.get(single)?.outline.bounds()?.size() * (1.0 + self.options.between);
        let part = |&(x, y): &(f64, f64)| Part {
            draft: single,
            shift: Vec2::new(x * size.width, y * size.height),
        };
        Some(dots.places.iter().map(part).collect())
    }

    /// Height of a tooth: the line that dots above keep clear of, over bowls too.
    fn tooth(&self) -> Option<f64> {
        let forms = [Form::Medi, Form::Init, Form::Isol, Form::Fina].into_iter();
        let found = forms
            .flat_map(|f| ['ٮ', 'ں'].map(|c| self.find(c, f)))
            .flatten()
            .next()?;
        Some(self.drafts.get(found)?.outline.bounds()?.y1)
    }

    /// A mark on a body, or on the last mark of its side.
    fn mark(&self, base: &Draft, mark: char, before: &[Sign]) -> Option<Sign> {
        let place = marks::place(mark)?;
        let (name, own) = match place {
            Place::Top => ("top", "_top"),
            Place::Bottom => ("bottom", "_bottom"),
        };
        let drawn = self.find_mark(mark)?;
        let draft = self.drafts.get(drawn)?;
        let ink = draft.outline.bounds()?;
        let sign = Sign {
            parts: super::parts(self.drafts, drawn),
            ink,
            side: place,
        };
        if mark == recipes::BESIDE {
            let corner = self.beside(base, ink)?;
            return Some(sign.moved(corner - Point::new(ink.x0, ink.y1)));
        }
        let automatic = marks::of_mark(place, ink, self.em);
        let near = self.by_hand(draft, own).or_else(|| at(&automatic, own))?;
        let last = before.iter().rfind(|s| s.side == place);
        let last = last.map(|s| marks::of_mark(place, s.ink, self.em));
        let foot = match last {
            Some(anchors) => at(&anchors, name)?,
            None => self.foot(base, name, canonical_combining_class(mark))?,
        };
        Some(sign.moved(foot - near))
    }

    /// Where the top left corner of a sign stands at the right of a tall letter: as high as ascenders, clear of the
    /// stem.
    fn beside(&self, base: &Draft, sign: Rect) -> Option<Point> {
        let own = base.outline.bounds()?;
        let tall = ['d', 'l', 'h', 'b', 'k'].into_iter();
        let tall =
            tall.filter_map(|c| self.drafts.get(self.find(c, Form::Isol)?)?.outline.bounds());
        let top = match base.id.chars[..] {
            ['t'] => tall.map(|ink| ink.y1).reduce(f64::max).unwrap_or(own.y1),
            _ => own.y1,
        };
        // t may end below the sign
        let foot = (top - sign.height()).min(own.y1 - TIP * self.em);
        let profile = Profile::of(&base.outline, self.em, 0.0, 0.0)?;
        let white = profile.right((foot, top)).into_iter().flatten();
        let right = profile.extremes.1 - white.reduce(f64::min)?;
        Some(Point::new(right + self.options.gap * self.em, top))
    }

    /// Where a letter carries its first mark; the last part of a ligature is the one that has it.
    fn foot(&self, base: &Draft, name: &str, class: u8) -> Option<Point> {
        /// Marks that grow from the letter: cedilla, ogonek.
        const ATTACHED_BELOW: u8 = 202;
        let part = match base.id.chars.len() {
            1 => name.to_owned(),
            n => format!("{name}_{n}"),
        };
        if let Some(at) = self.by_hand(base, &part) {
            return Some(at);
        }
        let found = at(&marks::of_draft(base, self.em), &part)?;
        let ink = base.outline.bounds()?;
        Some(if class == ATTACHED_BELOW {
            Point::new(found.x, ink.y0 + ROOT * self.em)
        } else {
            found
        })
    }

    /// A combining mark, or the sign of its own that shows it over a space.
    fn find_mark(&self, mark: char) -> Option<usize> {
        let shows = |d: &Draft| match d.id.chars[..] {
            [c] if c != mark => {
                let mut parts = Vec::new();
                decompose_compatible(c, |p| parts.push(p));
                parts == [' ', mark] && d.id.suffixes.is_empty()
            }
            _ => false,
        };
        let signs = recipes::SHOWN.iter().filter(|s| s.0 == mark);
        self.find(mark, Form::Isol)
            .or_else(|| signs.into_iter().find_map(|s| self.find(s.1, Form::Isol)))
            .or_else(|| self.drafts.iter().position(shows))
    }

    /// The letter without its dot: drawn, or what is left of the dotted one when the pieces above it go.
    fn dotless(&mut self, dotted: char, dotless: char) -> Option<usize> {
        if let Some(found) = self.find(dotless, Form::Isol) {
            return Some(found);
        }
        let whole = self.drafts.get(self.find(dotted, Form::Isol)?)?;
        let bounds = |c: &kurbo::BezPath| kurbo::Shape::bounding_box(c);
        let contours = whole.outline.contours();
        let stem = contours
            .iter()
            .map(bounds)
            .min_by(|a, b| a.y0.total_cmp(&b.y0))?;
        let without = |outline: &Outline| {
            let contours = outline.contours().iter();
            let kept = contours.filter(|c| bounds(c).y0 < stem.y1).cloned();
            Outline::new(kept.collect()).ok()
        };
        let outline = without(&whole.outline)?;
        if outline.contours().len() == contours.len() {
            return None;
        }
        let plates = whole.plates.iter();
        let plates = plates.filter_map(|(ink, own)| Some((*ink, without(own)?)));
        let draft = Draft {
            id: names::identify(&Label(dotless.to_string())).ok()?,
            outline,
            plates: plates.filter(|p| !p.1.is_empty()).collect(),
            ..whole.clone()
        };
        self.drafts.push(draft);
        Some(self.drafts.len() - 1)
    }
}

impl Sign {
    /// Moved by whole units: components stand on the grid.
    fn moved(self, by: Vec2) -> Self {
        let by = by.round();
        let moved = self.parts.into_iter().map(|p| Part {
            shift: (p.shift + by).round(),
            ..p
        });
        Self {
            parts: moved.collect(),
            ink: self.ink + by,
            side: self.side,
        }
    }
}

fn at(anchors: &[Anchor], name: &str) -> Option<Point> {
    anchors.iter().find(|a| a.name == name).map(|a| a.at)
}

#[cfg(test)]
mod tests;
