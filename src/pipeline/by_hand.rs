//! What a user sets by hand: anchors, kerning and features win over what follows from the shapes.

use super::problem::{Problem, unless};
use super::project::Project;
use super::world::World;
use crate::types::{Anchor, Font};
use crate::write::layout;
use kurbo::Point;

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
