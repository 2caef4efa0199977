//! A UFO folder → Font.

use super::{Names, ReadError, Reading, notdef};
use crate::types::{Anchor, Component, Font, Glyph, Info, Kerning, Metrics, Name, Outline};
use kurbo::{PathEl, Point};
use std::path::Path;

/// Key of the lib that says which glyphs are layers of which colour.
const COLOURS: &str = "com.github.googlei18n.ufo2ft.colorLayers";

/// The font in a UFO folder: its default layer, kerning, groups and features.
///
/// # Errors
/// The folder is no readable UFO, or its glyphs make no font.
pub fn ufo(folder: &Path) -> Result<Reading, ReadError> {
    let source = norad::Font::load(folder).map_err(|e| ReadError::damaged("a UFO", e))?;
    let mut lost = Vec::new();
    let mut names = Names::default();
    let mut glyphs: Vec<Glyph> = Vec::new();
    for wanted in order(&source) {
        if let Some(g) = source.get_glyph(&wanted) {
            glyphs.push(glyph(g, names.claim(&wanted, glyphs.len()), &mut lost)?);
        }
    }
    match glyphs.iter().position(|g| g.name == Name::notdef()) {
        Some(i) => glyphs[..=i].rotate_right(1),
        None => glyphs.insert(0, notdef()),
    }
    if glyphs.iter().all(|g| g.outline.is_empty()) {
        return Err(ReadError::Empty);
    }
    let mut font = Font::new(info(&source.font_info), glyphs)?;
    font.kerning = kerning(&source);
    font.features.clone_from(&source.features);
    let layers = source.iter_layers().count();
    lost.extend((layers > 1).then(|| format!("{} layers beside the default one", layers - 1)));
    let coloured = source.lib.contains_key(COLOURS);
    lost.extend(
        coloured.then(|| "colours of layers; fontmake builds them from the UFO".to_owned()),
    );
    lost.extend(names.lost());
    Ok(Reading { font, lost })
}

/// Glyph names in the order the UFO gives, then the others by name.
fn order(source: &norad::Font) -> Vec<String> {
    let given = source
        .lib
        .get("public.glyphOrder")
        .and_then(|v| v.as_array());
    let given = given
        .into_iter()
        .flatten()
        .filter_map(|v| v.as_string().map(str::to_owned));
    let mut out: Vec<String> = given.collect();
    let mut all: Vec<String> = source.iter_names().map(|n| n.to_string()).collect();
    all.sort();
    for name in all {
        if !out.contains(&name) {
            out.push(name);
        }
    }
    out
}

fn glyph(source: &norad::Glyph, name: Name, lost: &mut Vec<String>) -> Result<Glyph, ReadError> {
    let mut glyph = Glyph::new(
        name,
        source.codepoints.iter().collect(),
        source.width.max(0.0),
    );
    let mut contours = Vec::new();
    for contour in &source.contours {
        let mut path = contour
            .to_kurbo()
            .map_err(|e| ReadError::damaged("a UFO", format!("{}: {e}", source.name())))?;
        let closed = contour.is_closed();
        if closed && path.segments().next().is_some() {
            if !matches!(path.elements().last(), Some(PathEl::ClosePath)) {
                path.close_path();
            }
            contours.push(path);
        } else {
            lost.push(format!("an open contour of {}", source.name()));
        }
    }
    glyph.outline = Outline::new(contours)
        .map_err(|e| ReadError::damaged("a UFO", format!("{}: {e}", source.name())))?;
    for part in &source.components {
        let base = Name::new(part.base.to_string()).map_err(|e| ReadError::damaged("a UFO", e))?;
        glyph.components.push(Component {
            base,
            place: part.transform.into(),
        });
    }
    let anchors = source
        .anchors
        .iter()
        .filter_map(|a| Some((a.name.as_ref()?.to_string(), Point::new(a.x, a.y))));
    glyph.anchors = anchors.map(|(name, at)| Anchor { name, at }).collect();
    Ok(glyph)
}

/// Groups and pairs; the prefixes of kerning groups become an `@` on their side of a pair.
fn kerning(source: &norad::Font) -> Kerning {
    const SIDES: [&str; 2] = ["public.kern1.", "public.kern2."];
    let mut out = Kerning::default();
    for (name, members) in &source.groups {
        let legal = || {
            members
                .iter()
                .filter_map(|m| Name::new(m.to_string()).ok())
                .collect()
        };
        if let Some(group) = name.strip_prefix(SIDES[0]) {
            out.first.insert(group.to_owned(), legal());
        } else if let Some(group) = name.strip_prefix(SIDES[1]) {
            out.second.insert(group.to_owned(), legal());
        }
    }
    let side = |name: &str, prefix: &str| {
        name.strip_prefix(prefix)
            .map_or_else(|| name.to_owned(), |g| format!("@{g}"))
    };
    for (first, seconds) in &source.kerning {
        for (second, value) in seconds {
            out.pairs
                .insert((side(first, SIDES[0]), side(second, SIDES[1])), *value);
        }
    }
    out
}

fn info(source: &norad::FontInfo) -> Info {
    let default = Info::default();
    let em = source.units_per_em.as_ref().map_or(1000.0, |v| **v);
    let number = |v: Option<f64>| v.unwrap_or(0.0);
    Info {
        family: source.family_name.clone().unwrap_or(default.family),
        style: source.style_name.clone().unwrap_or(default.style),
        version: (
            small(source.version_major.map(f64::from), 1),
            small(source.version_minor.map(f64::from), 0),
        ),
        units_per_em: small(Some(em), 1000).clamp(16, 16384),
        weight: small(source.open_type_os2_weight_class.map(f64::from), 400).clamp(1, 1000),
        italic_angle: number(source.italic_angle),
        copyright: source.copyright.clone(),
        designer: source.open_type_name_designer.clone(),
        manufacturer: source.open_type_name_manufacturer.clone(),
        license: source.open_type_name_license.clone(),
        license_url: source.open_type_name_license_url.clone(),
        vendor_url: source.open_type_name_manufacturer_url.clone(),
        metrics: Metrics {
            ascender: source.ascender.unwrap_or(0.8 * em),
            descender: source.descender.unwrap_or(-0.2 * em).min(0.0),
            line_gap: number(source.open_type_hhea_line_gap.map(f64::from)),
            x_height: number(source.x_height),
            cap_height: number(source.cap_height),
        },
        ..default
    }
}

/// A whole number of 16 bits, or what stands for a missing one.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to 16 bits before"
)]
fn small(v: Option<f64>, missing: u16) -> u16 {
    v.map_or(missing, |v| v.round().clamp(0.0, 65535.0) as u16)
}
