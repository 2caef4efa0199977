//! What the last build wrote, noted in the libs of a UFO: so the next one knows what hands have changed.

use super::files::failed;
use crate::types::formats::BUILT;
use crate::write::WriteError;
use norad::{Contour, Font, Glyph, Name};
use plist::{Dictionary, Value};
use std::collections::BTreeMap;

/// Names of things and their states as text.
pub(in crate::write) type States = BTreeMap<String, String>;

/// Notes in a font what is in it now.
pub(in crate::write) fn sign(font: &mut Font) -> Result<(), WriteError> {
    let states = font_states(font)?;
    font.lib.insert(BUILT.to_owned(), value(&states));
    font.default_layer_mut().iter_mut().for_each(sign_glyph);
    Ok(())
}

/// Notes in a glyph what is in it now.
pub(in crate::write) fn sign_glyph(glyph: &mut Glyph) {
    let states = glyph_states(glyph);
    glyph.lib.insert(BUILT.to_owned(), value(&states));
}

fn value(states: &States) -> Value {
    let states = states
        .iter()
        .map(|(k, v)| (k.clone(), Value::from(v.as_str())));
    Value::Dictionary(states.collect())
}

/// What the last build wrote; none for what no build has made.
pub(in crate::write) fn signed(lib: &Dictionary) -> Option<States> {
    let states = lib.get(BUILT)?.as_dictionary()?.iter();
    Some(
        states
            .filter_map(|(k, v)| Some((k.clone(), v.as_string()?.to_owned())))
            .collect(),
    )
}

pub(in crate::write) const OUTLINE: &str = "outline";
pub(in crate::write) const CHARACTERS: &str = "characters";
pub(in crate::write) const ANCHOR: &str = "anchor ";

pub(in crate::write) fn glyph_states(glyph: &Glyph) -> States {
    let mut outline = format!("{}", glyph.width);
    for Contour { points, .. } in &glyph.contours {
        outline.push('\n');
        for p in points {
            outline += &format!(" {:?} {} {}", p.typ, p.x, p.y);
        }
    }
    for part in &glyph.components {
        let t = part.transform;
        let numbers = [
            t.x_scale, t.xy_scale, t.yx_scale, t.y_scale, t.x_offset, t.y_offset,
        ];
        outline += &format!("\n{} {numbers:?}", part.base);
    }
    let mut states = States::from([
        (OUTLINE.to_owned(), digest(&outline)),
        (CHARACTERS.to_owned(), characters(glyph)),
    ]);
    states.extend(glyph.anchors.iter().filter_map(|a| {
        let name = a.name.as_ref()?;
        Some((format!("{ANCHOR}{name}"), format!("{} {}", a.x, a.y)))
    }));
    states
}

/// A glyph's characters, by their numbers where XML has no way to write them.
fn characters(glyph: &Glyph) -> String {
    let written = |c: char| match c {
        '\t' | '\n' | '\r' | ' '..='\u{FFFD}' | '\u{10000}'.. => c.to_string(),
        _ => format!("U+{:04X}", u32::from(c)),
    };
    glyph.codepoints.iter().map(written).collect()
}

pub(in crate::write) const FEATURES: &str = "features";
pub(in crate::write) const INFORMATION: &str = "font information ";
pub(in crate::write) const GROUP: &str = "group ";
pub(in crate::write) const KERNING: &str = "kerning ";

pub(in crate::write) fn font_states(font: &Font) -> Result<States, WriteError> {
    let mut states = States::from([(FEATURES.to_owned(), digest(&font.features))]);
    let info = information(font)?;
    states.extend(
        info.iter()
            .map(|(k, v)| (format!("{INFORMATION}{k}"), format!("{v:?}"))),
    );
    states.extend(font.groups.iter().map(|(name, members)| {
        let members: Vec<&str> = members.iter().map(Name::as_str).collect();
        (format!("{GROUP}{name}"), members.join(" "))
    }));
    states.extend(
        pairs(font)
            .into_iter()
            .map(|((a, b), v)| (format!("{KERNING}{a} {b}"), v.to_string())),
    );
    Ok(states)
}

pub(in crate::write) fn information(font: &Font) -> Result<Dictionary, WriteError> {
    let info = plist::to_value(&font.font_info).map_err(|e| failed(&e))?;
    Ok(info.into_dictionary().unwrap_or_default())
}

pub(in crate::write) fn pairs(font: &Font) -> BTreeMap<(Name, Name), f64> {
    let of = |(first, seconds): (&Name, &BTreeMap<Name, f64>)| {
        let pair = |(second, value): (&Name, &f64)| ((first.clone(), second.clone()), *value);
        seconds.iter().map(pair).collect::<Vec<_>>()
    };
    font.kerning.iter().flat_map(of).collect()
}

fn digest(text: &str) -> String {
    blake3::hash(text.as_bytes()).to_string()
}
