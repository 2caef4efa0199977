//! What a user sets by hand: anchors, kerning and features win over what follows from the shapes.

use super::problem::{Problem, unless};
use super::project::{self, Project};
use super::world::World;
use crate::assemble::Note;
use crate::types::{Anchor, Font, Glyph};
use crate::write::layout;
use kurbo::Point;
use std::collections::BTreeSet;

/// Anchors that marks are composed by, whether or not a mark was drawn.
const USUAL: [&str; 6] = ["top", "bottom", "above", "below", "_top", "_bottom"];

/// Anchors by which letters join.
const JOINING: [&str; 2] = ["entry", "exit"];

/// Furthest an anchor can lie from the origin, em: beyond, it is a slip of the pen.
const FURTHEST: f64 = 4.0;

/// The font with the project's own anchors, kerning and features.
///
/// # Errors
/// They name a glyph that is not there, an anchor lies far outside, or the features do not compile by themselves.
pub(super) fn set(font: Font, project: &Project, world: World<'_>) -> Result<Font, Vec<Problem>> {
    unless(wrong(&font, project), ())?;
    let mut font = font.map_glyphs(|glyph| {
        let mut glyph = glyph.clone();
        let anchors = project.anchors.get(glyph.name.as_str());
        for (name, &(x, y)) in anchors.into_iter().flatten() {
            glyph.anchors.retain(|a| a.name != *name);
            glyph.anchors.push(Anchor {
                name: name.clone(),
                at: Point::new(x, y),
            });
        }
        glyph
    });
    for (pair, &value) in &project.kerning {
        if let Some((first, second)) = pair.split_once(' ') {
            let pair = (first.to_owned(), second.trim().to_owned());
            font.kerning.pairs.insert(pair, value);
        }
    }
    if let Some(path) = &project.font.features {
        let bytes = world.file(path)?;
        let text = String::from_utf8_lossy(&bytes);
        // a byte order mark is no statement
        let text = text.trim_start_matches('\u{feff}');
        layout::check(&font, &path.display().to_string(), text).map_err(|e| vec![e.into()])?;
        font.features = layout::with_features(&font, text);
    }
    Ok(font)
}

/// What is to be remarked of the project's anchors: those by which nothing will attach.
pub(super) fn notes(font: &Font, project: &Project) -> Vec<Note> {
    let glyphs = font.glyphs().iter();
    let all: BTreeSet<&str> = glyphs
        .flat_map(|g| &g.anchors)
        .map(|a| a.name.as_str())
        .collect();
    let mut notes = Vec::new();
    for (glyph, anchors) in &project.anchors {
        let Some(glyph) = font.glyph(glyph) else {
            continue;
        };
        for name in anchors.keys() {
            let message = in_parts(glyph, name).or_else(|| alone(name, &all));
            notes.extend(message.map(|why| Note {
                glyph: glyph.name.to_string(),
                message: format!("{name} under [anchors]: {why}"),
            }));
        }
    }
    notes
}

/// An anchor of a whole ligature whose parts have their own.
fn in_parts(glyph: &Glyph, name: &str) -> Option<String> {
    let own = glyph.anchors.iter().map(|a| a.name.as_str());
    let own: Vec<_> = own.filter(|n| of_part(n) == Some(name)).collect();
    let parts = own.join(", ");
    (!own.is_empty()).then(|| format!("marks attach to the parts of a ligature, by {parts}"))
}

/// An anchor that no other glyph has the counterpart of, but for those that are there for marks to come.
fn alone(name: &str, all: &BTreeSet<&str>) -> Option<String> {
    let known = |n: &str| USUAL.contains(&n) || JOINING.contains(&n);
    let (base, counterpart, who) = match name.strip_prefix('_') {
        Some(base) => (name, base.to_owned(), "letter"),
        None => {
            let base = of_part(name).unwrap_or(name);
            (base, format!("_{base}"), "mark")
        }
    };
    let is_met = |n: &&str| *n == counterpart || of_part(n) == Some(&counterpart);
    if known(base) || all.iter().any(is_met) {
        return None;
    }
    let is_met = |n: &&str| known(n) || n.strip_prefix('_').is_some_and(|n| all.contains(n));
    let alike = |n: &&str| n.starts_with('_') == name.starts_with('_') && *n != name;
    let others = all.iter().copied().filter(is_met).chain(USUAL);
    let others: Vec<_> = others.filter(alike).collect();
    let meant = project::nearest(name, &others).map(|n| format!("; did you mean {n}?"));
    let meant = meant.unwrap_or_default();
    Some(format!(
        "no {who} has {counterpart}, so nothing attaches by it{meant}"
    ))
}

/// `top` of `top_1`.
fn of_part(anchor: &str) -> Option<&str> {
    let (name, number) = anchor.rsplit_once('_').filter(|(n, _)| !n.is_empty())?;
    number.parse::<usize>().ok().map(|_| name)
}

fn wrong(font: &Font, project: &Project) -> Vec<Problem> {
    let mut problems = Vec::new();
    let mut say = |table: &'static str, key: &str, why: String| {
        problems.push(Problem::ByHand {
            table,
            key: key.to_owned(),
            why,
        });
    };
    let missing = |name: &str| {
        (font.glyph(name).is_none()).then(|| format!("the font has no glyph “{name}”"))
    };
    let far = FURTHEST * f64::from(font.info.units_per_em);
    let is_near = |v: &f64| v.abs() <= far; // NaN is not
    for (glyph, anchors) in &project.anchors {
        if let Some(why) = missing(glyph) {
            say("anchors", glyph, why);
        }
        for (name, (x, y)) in anchors {
            if !(is_near(x) && is_near(y)) {
                let why = format!("{name} at {x}, {y} lies outside: {far} units at most");
                say("anchors", glyph, why);
            }
        }
    }
    for (pair, value) in &project.kerning {
        let mut say = |why: String| say("kerning", pair, why);
        match pair.split_once(' ') {
            None => say("write two glyph names with a space between".to_owned()),
            Some((first, second)) => {
                let both = [first, second.trim()].into_iter();
                both.filter_map(missing).for_each(&mut say);
            }
        }
        if !is_near(value) {
            say(format!("{value} is out of range: {far} units at most"));
        }
    }
    problems
}
