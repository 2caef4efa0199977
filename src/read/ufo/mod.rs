//! A UFO folder → Font.

mod damage;
mod info;
mod kerning;

use super::{Names, ReadError, Reading, begin_with_notdef, listed};
use crate::types::formats::{BUILT, CATEGORIES, COLOUR_KEYS, GLYPH_ORDER};
use crate::types::{Anchor, Component, Font, Glyph, Name, Outline};
use damage::damage;
use info::{info, unread};
use kerning::kerning;
use kurbo::{PathEl, Point};
use norad::{ContourPoint, PointType};
use plist::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A glyph's name in the UFO → its name in the font.
type Named<'a> = BTreeMap<&'a str, Name>;

/// The font in a UFO folder: its default layer, kerning, groups and features.
///
/// # Errors
/// The folder is no readable UFO, its glyphs make no font, or kerning or an anchor is larger than a font holds.
pub fn ufo(folder: &Path) -> Result<Reading, ReadError> {
    let source = norad::Font::load(folder).map_err(|e| damage(&e))?;
    let mut lost = Vec::new();
    let mut names = Names::default();
    let order = order(&source);
    let all: Vec<_> = order.iter().filter_map(|n| source.get_glyph(n)).collect();
    let named = all.iter().zip(0..);
    let named = named.map(|(g, i)| (g.name().as_str(), names.claim(g.name(), i)));
    let named: Named<'_> = named.collect();
    let glyphs = all.iter().map(|g| glyph(g, &named, &mut lost));
    let mut glyphs = glyphs.collect::<Result<Vec<Glyph>, _>>()?;
    begin_with_notdef(&mut glyphs);
    if glyphs.iter().all(|g| g.outline.is_empty()) {
        return Err(ReadError::Empty);
    }
    let mut font = Font::new(info(&source.font_info), glyphs)?;
    lost.extend(unread(&source.font_info, &font.info));
    font.kerning = kerning(&source, &named, &mut lost)?;
    font.features.clone_from(&source.features);
    lost.extend(beside(&source, &all));
    let layers = source.iter_layers().count();
    lost.extend((layers > 1).then(|| format!("{} layers beside the default one", layers - 1)));
    let coloured = source.lib.contains_key(COLOUR_KEYS[0]);
    lost.extend(
        coloured.then(|| "colours of layers; fontmake builds them from the UFO".to_owned()),
    );
    lost.extend(names.lost());
    Ok(Reading { font, lost })
}

/// Keys of libs that are read, or follow from what is.
const ANSWERED: [&str; 4] = [GLYPH_ORDER, COLOUR_KEYS[0], COLOUR_KEYS[1], BUILT];

/// What a UFO has beside the font, a line a kind.
fn beside(source: &norad::Font, all: &[&norad::Glyph]) -> Vec<String> {
    let ours = source.lib.contains_key(BUILT);
    // categories follow from anchors in a UFO that khatt made
    let answered = |key: &str| ANSWERED.contains(&key) || ours && key == CATEGORIES;
    let other = |key: &&String| !answered(key);
    let keys: Vec<String> = source.lib.keys().filter(other).cloned().collect();
    let files =
        |keys: &mut dyn Iterator<Item = &PathBuf>| keys.map(|p| p.display().to_string()).collect();
    let with = |has: &dyn Fn(&norad::Glyph) -> bool| -> Vec<String> {
        let found = all.iter().filter(|g| has(g));
        found.map(|g| g.name().to_string()).collect()
    };
    let kinds = [
        ("keys of the lib", keys),
        ("data files", files(&mut source.data.keys())),
        ("pictures", files(&mut source.images.keys())),
        ("pictures in glyphs", with(&|g| g.image.is_some())),
        (
            "glyphs with guidelines",
            with(&|g| !g.guidelines.is_empty()),
        ),
        ("glyphs with notes", with(&|g| g.note.is_some())),
        (
            "glyphs with libs",
            with(&|g| g.lib.keys().any(|k| other(&k))),
        ),
    ];
    kinds
        .iter()
        .filter_map(|(what, found)| listed(what, found))
        .collect()
}

/// Glyph names in the order the UFO gives, then the others by name.
fn order(source: &norad::Font) -> Vec<String> {
    let given = source.lib.get(GLYPH_ORDER);
    let given = given.and_then(Value::as_array).into_iter().flatten();
    let given = given.filter_map(|v| v.as_string().map(str::to_owned));
    let all: BTreeSet<String> = source.iter_names().map(|n| n.to_string()).collect();
    let mut seen = BTreeSet::new();
    let once = given.chain(all).filter(|name| seen.insert(name.clone()));
    once.collect()
}

fn glyph(
    source: &norad::Glyph,
    named: &Named<'_>,
    lost: &mut Vec<String>,
) -> Result<Glyph, ReadError> {
    let own = source.name();
    let name = named.get(own.as_str()).cloned();
    let mut glyph = Glyph::new(
        name.unwrap_or_else(Name::notdef),
        source.codepoints.iter().collect(),
        source.width.max(0.0),
    );
    let mut contours = Vec::new();
    for contour in &source.contours {
        let closed = contour.is_closed();
        let mut contour = contour.clone();
        let start = |p: &ContourPoint| p.typ != PointType::OffCurve;
        if let Some(first) = contour.points.iter().position(start).filter(|_| closed) {
            // the library begins at the last point on the curve, a UFO at the first
            contour.points.rotate_left(first + 1);
        }
        let mut path = contour
            .to_kurbo()
            .map_err(|e| ReadError::damaged("a UFO", format!("{own}: {e}")))?;
        if closed && path.segments().next().is_some() {
            if !matches!(path.elements().last(), Some(PathEl::ClosePath)) {
                path.close_path();
            }
            contours.push(path);
        } else {
            lost.push(format!("an open contour of {own}"));
        }
    }
    glyph.outline =
        Outline::new(contours).map_err(|e| ReadError::damaged("a UFO", format!("{own}: {e}")))?;
    for part in &source.components {
        match named.get(part.base.as_str()) {
            Some(base) => glyph.components.push(Component {
                base: base.clone(),
                place: part.transform.into(),
            }),
            None => lost.push(format!("a component of {own}: there is no {}", part.base)),
        }
    }
    for anchor in &source.anchors {
        if let Some(name) = &anchor.name {
            let what = || format!("anchor {name} of {own}");
            let at = Point::new(held(anchor.x, what)?, held(anchor.y, what)?);
            let name = name.to_string();
            glyph.anchors.push(Anchor { name, at });
        }
    }
    Ok(glyph)
}

/// A number that feature tables hold.
fn held(value: f64, what: impl FnOnce() -> String) -> Result<f64, ReadError> {
    let all = f64::from(i16::MIN)..=f64::from(i16::MAX);
    if all.contains(&value.round()) {
        return Ok(value);
    }
    let what = what();
    let message = format!("{what} is {value}; a font holds −32768 to 32767: change it in the UFO");
    Err(ReadError::damaged("a UFO", message))
}
