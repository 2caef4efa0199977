//! TTF, OTF, WOFF2 → Font, with every table that is not an outline carried along.

use super::{Names, ReadError, Reading, cff::Charstrings, instance::Place, pen::Pen};
use super::{collection, names, tables, whole};
use crate::types::characters::name_of;
use crate::types::formats::EPOCH_1904;
use crate::types::{Component, Font, Glyph, Info, Metrics, Outline};
use kurbo::{Affine, BezPath};
use skrifa::instance::{Location, Size};
use skrifa::metrics::GlyphMetrics;
use skrifa::outline::{DrawSettings, OutlineGlyphFormat};
use skrifa::raw::TableProvider;
use skrifa::raw::tables::glyf::{
    Anchor, Component as StoredComponent, CompositeGlyphFlags, Glyph as Stored,
};
use skrifa::raw::types::F2Dot14;
use skrifa::string::StringId;
use skrifa::{FontRef, GlyphId, MetadataProvider, OutlineGlyphCollection};
use std::borrow::Cow;
use std::collections::BTreeMap;

/// Outlines and what is rebuilt with them.
const REBUILT: [&[u8; 4]; 7] = [
    b"glyf", b"loca", b"CFF ", b"CFF2", b"maxp", b"hmtx", b"gasp",
];

/// What is lost, by what it was for.
const LOST: [(&str, &[&[u8; 4]]); 4] = [
    (
        "hinting",
        &[
            b"fpgm", b"prep", b"cvt ", b"cvar", b"hdmx", b"LTSH", b"VDMX", b"PCLT",
        ],
    ),
    (
        "variation axes",
        &[
            b"fvar", b"gvar", b"avar", b"HVAR", b"VVAR", b"MVAR", b"STAT",
        ],
    ),
    // bearings from outlines that change, by which programs place them
    ("vertical metrics", &[b"vhea", b"vmtx", b"VORG"]),
    ("the signature", &[b"DSIG"]),
];

/// A font from the bytes of a TrueType, OpenType or WOFF2 file; of a collection the one of that number, from 1, or
/// name; a variable one at the given places on its axes (tag, value), else at its default; there composites stay,
/// elsewhere they are resolved.
///
/// # Errors
/// The bytes are no font with outlines, it has no such axis, or it is not told which font of a collection.
pub fn font(
    bytes: &[u8],
    face: Option<&str>,
    location: &[(String, f64)],
) -> Result<Reading, ReadError> {
    if bytes.starts_with(b"wOFF") {
        return Err(ReadError::Woff);
    }
    let plain: Cow<'_, [u8]> = if bytes.starts_with(b"wOF2") {
        let unpacked = wuff::decompress_woff2(bytes);
        Cow::Owned(unpacked.map_err(|e| ReadError::damaged("WOFF2", format!("{e:?}")))?)
    } else {
        Cow::Borrowed(bytes)
    };
    let source = collection::face(&plain, face)?;
    tables::check(&source)?;
    let place = Place::of(&source, location)?;
    let mut names = Names::default();
    let glyphs = glyphs(&source, &place.location, &mut names)?;
    if glyphs.iter().all(|g| g.outline.is_empty()) {
        return Err(ReadError::Empty);
    }
    let (mut info, mut carried) = (info(&source, &place.location), carried(&source));
    let mut lost = lost(&source);
    if place.moved() {
        place.describe(&source, &mut info);
        info.postscript = None;
        place.rewrite(&source, &info, &glyphs, &mut carried);
    }
    lost.extend(place.lay_out(&source, &mut carried));
    let mut font = Font::new(info, glyphs)?;
    font.carried = carried;
    lost.extend(names.lost());
    Ok(Reading { font, lost })
}

fn glyphs(font: &FontRef<'_>, at: &Location, names: &mut Names) -> Result<Vec<Glyph>, ReadError> {
    let count = font
        .maxp()
        .map_err(|e| ReadError::damaged("a font", e))?
        .num_glyphs();
    let mut chars: BTreeMap<GlyphId, Vec<char>> = BTreeMap::new();
    for (code, id) in font.charmap().mappings() {
        chars.entry(id).or_default().extend(char::from_u32(code));
    }
    let (outlines, metrics) = (
        font.outline_glyphs(),
        font.glyph_metrics(Size::unscaled(), at),
    );
    // asking for one name walks through all before it; in order they are walked through once, but a damaged one ends
    // the walk
    let given = font.glyph_names();
    let mut in_order = given.iter();
    let charstrings = match outlines.format() {
        Some(OutlineGlyphFormat::Cff | OutlineGlyphFormat::Cff2) => Some(Charstrings::of(font)?),
        _ => None,
    };
    let stored = font.loca(None).ok().zip(font.glyf().ok());
    let glyph = |n: u16| {
        let id = GlyphId::from(n);
        let next = in_order.next().filter(|(at, _)| *at == id);
        let next = next.map(|(_, name)| name).filter(|n| !n.is_synthesized());
        let given = next.or_else(|| given.get(id).filter(|n| !n.is_synthesized()));
        let own = chars.remove(&id).unwrap_or_default();
        let wanted = match given.as_ref().map(|s| s.as_str()) {
            _ if n == 0 => ".notdef".to_owned(),
            None | Some(".notdef") => own.first().map_or_else(String::new, |&c| name_of(&[c])),
            Some(name) => name.to_owned(),
        };
        let name = names.claim(&wanted, usize::from(n));
        let mut glyph = Glyph::new(name, own, advance(&metrics, id));
        let drawn = match (&charstrings, &stored) {
            (Some(all), _) => all.draw(id, at.coords()),
            (None, Some((loca, glyf))) => {
                tables::whole(loca, glyf, id).and_then(|()| outline(&outlines, id, at))
            }
            (None, None) => outline(&outlines, id, at),
        };
        let wrong = |why| ReadError::outline((&glyph.name, id), why);
        glyph.outline = drawn.and_then(closed).map_err(wrong)?;
        Ok(glyph)
    };
    let mut glyphs = (0..count)
        .map(glyph)
        .collect::<Result<Vec<_>, ReadError>>()?;
    if at.coords().iter().all(|c| c.to_bits() == 0) {
        compose(font, &mut glyphs);
    }
    Ok(glyphs)
}

/// Makes components again of what a `glyf` table stores as such, where they are plain: placed by
/// offsets, of glyphs with contours of their own.
fn compose(font: &FontRef<'_>, glyphs: &mut [Glyph]) {
    let (Ok(loca), Ok(glyf)) = (font.loca(None), font.glyf()) else {
        return;
    };
    let stored = |i: usize| {
        loca.get_glyf(GlyphId::new(u32::try_from(i).ok()?), &glyf)
            .ok()?
    };
    for i in 0..glyphs.len() {
        let Some(Stored::Composite(composite)) = stored(i) else {
            continue;
        };
        let part = |c: StoredComponent| {
            let base = usize::try_from(c.glyph.to_u32()).ok()?;
            let Anchor::Offset { x, y } = c.anchor else {
                return None;
            };
            let simple = matches!(stored(base), Some(Stored::Simple(_)));
            let t = c.transform;
            let f = |v: F2Dot14| f64::from(v.to_f32());
            let [xx, yx, xy, yy] = [t.xx, t.yx, t.xy, t.yy].map(f);
            let place = Affine::new([xx, yx, xy, yy, x.into(), y.into()]);
            let scaled = CompositeGlyphFlags::SCALED_COMPONENT_OFFSET;
            let base = glyphs
                .get(base)
                .filter(|_| simple && !c.flags.contains(scaled))?;
            let base = base.name.clone();
            Some(Component { base, place })
        };
        let parts: Option<Vec<Component>> = composite.components().map(part).collect();
        if let Some(parts) = parts {
            glyphs[i].outline = Outline::EMPTY;
            glyphs[i].components = parts;
        }
    }
}

fn advance(metrics: &GlyphMetrics<'_>, id: GlyphId) -> f64 {
    metrics.advance_width(id).map_or(0.0, f64::from).max(0.0)
}

/// A glyph's contours, the outer ones counter-clockwise, or why they cannot be drawn.
fn outline(
    all: &OutlineGlyphCollection<'_>,
    id: GlyphId,
    at: &Location,
) -> Result<Vec<BezPath>, String> {
    let Some(glyph) = all.get(id) else {
        return match all.format() {
            Some(OutlineGlyphFormat::Glyf) => Err("a part of it cannot be drawn".to_owned()),
            _ => Ok(Vec::new()),
        };
    };
    let mut pen = Pen::default();
    let drawn = glyph.draw(DrawSettings::unhinted(Size::unscaled(), at), &mut pen);
    drawn.map_err(|e| e.to_string())?;
    Ok(pen.paths.iter().map(BezPath::reverse_subpaths).collect())
}

/// The contours that draw something.
fn closed(contours: Vec<BezPath>) -> Result<Outline, String> {
    let contours = contours.into_iter();
    let contours = contours.filter(|p| p.segments().next().is_some());
    Outline::new(contours.collect()).map_err(|e| e.to_string())
}

fn info(font: &FontRef<'_>, at: &Location) -> Info {
    let text = |id: StringId| names::text(font, id);
    let default = Info::default();
    let m = font.metrics(Size::unscaled(), at);
    let (head, os2) = (font.head().ok(), font.os2().ok());
    let units = |v: Option<f32>| v.map_or(0.0, f64::from);
    let revision = head.as_ref().map_or(1.0, |h| h.font_revision().to_f64());
    Info {
        family: text(StringId::TYPOGRAPHIC_FAMILY_NAME)
            .or_else(|| text(StringId::FAMILY_NAME))
            .unwrap_or(default.family),
        style: text(StringId::TYPOGRAPHIC_SUBFAMILY_NAME)
            .or_else(|| text(StringId::SUBFAMILY_NAME))
            .unwrap_or(default.style),
        postscript: None,
        version: version(revision),
        units_per_em: m.units_per_em.clamp(16, 16384),
        weight: os2
            .as_ref()
            .map_or(400, |t| t.us_weight_class().clamp(1, 1000)),
        italic_angle: f64::from(m.italic_angle),
        created: head.map_or(0, |h| h.created().as_secs().saturating_sub(EPOCH_1904)),
        copyright: text(StringId::COPYRIGHT_NOTICE),
        designer: text(StringId::DESIGNER),
        manufacturer: text(StringId::MANUFACTURER),
        license: text(StringId::LICENSE_DESCRIPTION),
        license_url: text(StringId::LICENSE_URL),
        vendor_url: text(StringId::VENDOR_URL),
        vendor_id: os2.map_or(default.vendor_id, |t| t.ach_vend_id().to_be_bytes()),
        metrics: Metrics {
            ascender: f64::from(m.ascent),
            descender: f64::from(m.descent).min(0.0),
            line_gap: f64::from(m.leading),
            x_height: units(m.x_height),
            cap_height: units(m.cap_height),
        },
    }
    .with_postscript(text(StringId::POSTSCRIPT_NAME))
}

/// Major version and thousandths.
fn version(revision: f64) -> (u16, u16) {
    let r = revision.clamp(0.0, 32767.0);
    (whole(r.trunc()), whole(r.fract() * 1000.0).min(999))
}

fn carried(font: &FontRef<'_>) -> BTreeMap<[u8; 4], Vec<u8>> {
    let gone =
        |tag: &[u8; 4]| REBUILT.contains(&tag) || LOST.iter().any(|(_, tags)| tags.contains(&tag));
    let records = font.table_directory().table_records().iter();
    let tags = records.map(|r| r.tag()).filter(|t| !gone(&t.to_be_bytes()));
    let mut all: BTreeMap<[u8; 4], Vec<u8>> = tags
        .filter_map(|t| Some((t.to_be_bytes(), font.table_data(t)?.as_bytes().to_vec())))
        .collect();
    if let Some([0, 1, 0, minor @ 3, ..]) = all.get_mut(b"GDEF").map(Vec::as_mut_slice) {
        // 1.2 has no offset of a variation store, which means nothing without axes.
        *minor = 2;
    }
    all
}

fn lost(font: &FontRef<'_>) -> Vec<String> {
    let has = |tag: &&[u8; 4]| font.table_data(skrifa::Tag::new(tag)).is_some();
    let line = |(what, tags): &(&str, &[&[u8; 4]])| {
        let there: Vec<_> = tags
            .iter()
            .filter(|t| has(t))
            .map(|t| String::from_utf8_lossy(*t).trim().to_owned())
            .collect();
        (!there.is_empty()).then(|| format!("{what} ({})", there.join(", ")))
    };
    LOST.iter().filter_map(line).collect()
}
