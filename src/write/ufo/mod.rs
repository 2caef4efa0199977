//! UFO 3: the font as a designer's editor opens it, and as fontmake and fontc build it.
//!
//! Features stand in `features.fea`; kerning and marks do not: compilers derive them from
//! `kerning.plist` and the anchors, as our own writers do, so that a change to either counts.
//! What was built stands in the libs, so that the next build knows hand work ([`super::handwork`]).

pub(super) mod files;
pub(super) mod states;

use super::WriteError;
use super::colour::FOREGROUND;
use super::sfnt::{line_heights, underline};
use super::{layout, os2};
use crate::numeric::angles::angle;
use crate::types::formats::{
    CATEGORIES, COLOUR_KEYS, GLYPH_ORDER, KERNING_GROUPS, UFO_DATE, USE_TYPO_METRICS,
};
use crate::types::{Files, Font, Glyph, Layer};
use chrono::DateTime;
use files::{bytes, failed};
use kurbo::{BezPath, PathEl, Point, Vec2};
use norad::fontinfo::{NonNegativeIntegerOrFloat, StyleMapStyle};
use norad::{AffineTransform, Contour, ContourPoint, FontInfo, PointType};
use plist::{Dictionary, Value};
use write_fonts::tables::os2::{Os2, SelectionFlags};

/// Tangents that turn less than this at a point, radians, make it a smooth one: a quarter of a degree.
const SMOOTH: f64 = 0.0044;

/// The files of a UFO.
pub(super) fn files(font: &Font) -> Result<Files, WriteError> {
    let mut ufo = convert(font)?;
    states::sign(&mut ufo)?;
    bytes(&ufo)
}

fn name(text: &str) -> Result<norad::Name, WriteError> {
    norad::Name::new(text).map_err(|e| failed(&e))
}

fn convert(font: &Font) -> Result<norad::Font, WriteError> {
    let mut ufo = norad::Font::new();
    ufo.font_info = info(font);
    ufo.features = font.features.clone();
    for glyph in font.glyphs() {
        let glyph = convert_glyph(glyph)?;
        ufo.default_layer_mut().insert_glyph(glyph);
    }
    let order = font
        .glyphs()
        .iter()
        .map(|g| Value::from(g.name.as_str()))
        .collect();
    ufo.lib.insert(GLYPH_ORDER.to_owned(), Value::Array(order));
    ufo.lib.extend(colours(font));
    let categories = font
        .glyphs()
        .iter()
        .filter_map(category)
        .collect::<Dictionary>();
    if !categories.is_empty() {
        let categories = Value::Dictionary(categories);
        ufo.lib.insert(CATEGORIES.to_owned(), categories);
    }
    for (prefix, groups) in [
        (KERNING_GROUPS[0], &font.kerning.first),
        (KERNING_GROUPS[1], &font.kerning.second),
    ] {
        for (group, members) in groups {
            let members = members
                .iter()
                .map(|m| name(m.as_str()))
                .collect::<Result<_, _>>()?;
            ufo.groups
                .insert(name(&format!("{prefix}{group}"))?, members);
        }
    }
    let side = |side: &str, prefix: &str| match side.strip_prefix('@') {
        Some(group) => name(&format!("{prefix}{group}")),
        None => name(side),
    };
    for ((first, second), &value) in &font.kerning.pairs {
        let first = side(first, KERNING_GROUPS[0])?;
        let second = side(second, KERNING_GROUPS[1])?;
        ufo.kerning.entry(first).or_default().insert(second, value);
    }
    Ok(ufo)
}

/// Layers and palette where ufo2ft looks for them: layers are glyphs of their own, colours have parts of 1.
fn colours(font: &Font) -> Dictionary {
    let mut lib = Dictionary::new();
    let layered = font.glyphs().iter().filter(|g| !g.layers.is_empty());
    let layer = |layer: &Layer| {
        let colour = layer.colour.map_or(FOREGROUND.into(), |c| c as u64);
        Value::Array(vec![layer.glyph.as_str().into(), colour.into()])
    };
    let layers = layered.map(|g| {
        let layers = g.layers.iter().map(layer).collect();
        (g.name.to_string(), Value::Array(layers))
    });
    let layers: Dictionary = layers.collect();
    if layers.is_empty() {
        return lib;
    }
    let colour = |rgb: &[u8; 3]| {
        let parts = rgb.iter().map(|&v| Value::from(f64::from(v) / 255.0));
        Value::Array(parts.chain([1.0.into()]).collect())
    };
    let palette = Value::Array(font.palette.iter().map(colour).collect());
    lib.insert(COLOUR_KEYS[0].to_owned(), Value::Dictionary(layers));
    lib.insert(COLOUR_KEYS[1].to_owned(), Value::Array(vec![palette]));
    lib
}

/// Whether the layers that a UFO names are there.
pub(super) fn has_layers(ufo: &norad::Font) -> bool {
    let layers = ufo.lib.get(COLOUR_KEYS[0]).and_then(Value::as_dictionary);
    let layers = layers.into_iter().flat_map(Dictionary::values);
    let pairs = layers.filter_map(Value::as_array).flatten();
    let names = pairs.filter_map(|pair| pair.as_array()?.first()?.as_string());
    names.into_iter().all(|name| ufo.get_glyph(name).is_some())
}

/// A glyph's name and what GDEF says of it.
fn category(glyph: &Glyph) -> Option<(String, Value)> {
    let class = layout::class(glyph)?;
    Some((glyph.name.to_string(), Value::from(class.word())))
}

fn info(font: &Font) -> FontInfo {
    let info = &font.info;
    let m = info.metrics;
    // compilers that are told nothing restrict embedding, and have lines of their own
    let os2 = os2::carried(font);
    let embedding = os2.as_ref().map_or(0, |own| own.fs_type);
    let embedding = (0..16_u8).filter(|bit| embedding >> bit & 1 == 1).collect();
    let whole = |v: f64| super::numbers::to_i16(v, String::new).ok().map(i32::from);
    let usual = [m.ascender, m.descender, m.line_gap].map(whole);
    let hhea = line_heights(font).map_or(usual, |own| own.map(|v| Some(v.into())));
    let typo = os2.as_ref().map_or(usual, |own| {
        let own = [
            own.s_typo_ascender,
            own.s_typo_descender,
            own.s_typo_line_gap,
        ];
        own.map(|v| Some(v.into()))
    });
    let is_typo = |own: &Os2| own.fs_selection.contains(SelectionFlags::USE_TYPO_METRICS);
    let selection = os2.as_ref().is_none_or(is_typo).then_some(USE_TYPO_METRICS);
    let strikeout = os2.map(|own| (own.y_strikeout_position.into(), own.y_strikeout_size.into()));
    let strikeout = strikeout.unwrap_or_else(|| info.strikeout());
    let underline = underline(font);
    let style = info.linked_style();
    FontInfo {
        family_name: Some(info.family.clone()),
        style_name: Some(info.style.clone()),
        style_map_family_name: Some(style.family.clone()),
        style_map_style_name: Some(match (style.is_bold, style.is_italic) {
            (false, false) => StyleMapStyle::Regular,
            (false, true) => StyleMapStyle::Italic,
            (true, false) => StyleMapStyle::Bold,
            (true, true) => StyleMapStyle::BoldItalic,
        }),
        postscript_font_name: Some(info.postscript_name()),
        version_major: Some(i32::from(info.version.0)),
        version_minor: Some(u32::from(info.version.1)),
        units_per_em: NonNegativeIntegerOrFloat::new(f64::from(info.units_per_em)),
        ascender: Some(m.ascender),
        descender: Some(m.descender),
        x_height: Some(m.x_height),
        cap_height: Some(m.cap_height),
        italic_angle: Some(info.italic_angle),
        open_type_hhea_ascender: hhea[0],
        open_type_hhea_descender: hhea[1],
        open_type_hhea_line_gap: hhea[2],
        open_type_os2_typo_ascender: typo[0],
        open_type_os2_typo_descender: typo[1],
        open_type_os2_typo_line_gap: typo[2],
        open_type_os2_weight_class: Some(u32::from(info.weight)),
        open_type_os2_selection: Some(selection.into_iter().collect()),
        open_type_os2_type: Some(embedding),
        open_type_os2_strikeout_position: whole(strikeout.0),
        open_type_os2_strikeout_size: whole(strikeout.1),
        postscript_underline_position: Some(underline.0),
        postscript_underline_thickness: Some(underline.1),
        open_type_os2_vendor_id: Some(String::from_utf8_lossy(&info.vendor_id).into_owned()),
        open_type_head_created: Some(date(info.created)),
        copyright: info.copyright.clone(),
        open_type_name_designer: info.designer.clone(),
        open_type_name_manufacturer: info.manufacturer.clone(),
        open_type_name_manufacturer_url: info.vendor_url.clone(),
        open_type_name_license: info.license.clone(),
        open_type_name_license_url: info.license_url.clone(),
        ..FontInfo::default()
    }
}

/// Seconds since 1970 as a UFO writes them, UTC; the first one where a date cannot be told.
fn date(seconds: i64) -> String {
    let date = DateTime::from_timestamp(seconds, 0).unwrap_or_default();
    date.format(UFO_DATE).to_string()
}

fn convert_glyph(glyph: &Glyph) -> Result<norad::Glyph, WriteError> {
    // the name is checked first: norad's constructor takes what it is given
    let mut out = norad::Glyph::new(&name(glyph.name.as_str())?);
    out.width = glyph.advance;
    out.codepoints = norad::Codepoints::new(glyph.codepoints.iter().copied());
    out.contours = glyph.outline.contours().iter().map(contour).collect();
    for part in &glyph.components {
        let [xx, xy, yx, yy, dx, dy] = part.place.as_coeffs();
        let place = AffineTransform {
            x_scale: xx,
            xy_scale: xy,
            yx_scale: yx,
            y_scale: yy,
            x_offset: dx,
            y_offset: dy,
        };
        let base = name(part.base.as_str())?;
        let part = norad::Component::new(base, place, None);
        out.components.push(part);
    }
    for anchor in &glyph.anchors {
        let (at, label) = (anchor.at, Some(name(&anchor.name)?));
        let anchor = norad::Anchor::new(at.x, at.y, label, None, None);
        out.anchors.push(anchor);
    }
    Ok(out)
}

/// A closed contour as UFO points: the start is the last on-curve point reached.
fn contour(path: &BezPath) -> Contour {
    let mut points: Vec<ContourPoint> = Vec::new();
    let mut start = None;
    let mut add = |p: Point, kind| points.push(node(p, kind));
    for el in path.elements() {
        match *el {
            PathEl::MoveTo(p) => start = Some(p),
            PathEl::LineTo(p) => add(p, PointType::Line),
            PathEl::QuadTo(a, p) => {
                add(a, PointType::OffCurve);
                add(p, PointType::QCurve);
            }
            PathEl::CurveTo(a, b, p) => {
                add(a, PointType::OffCurve);
                add(b, PointType::OffCurve);
                add(p, PointType::Curve);
            }
            PathEl::ClosePath => {}
        }
    }
    let at = |p: &ContourPoint| Point::new(p.x, p.y);
    if let Some(start) = start.filter(|s| points.last().is_none_or(|p| at(p) != *s)) {
        points.push(node(start, PointType::Line));
    }
    // editors show the first point of the file as the start: let it be the path's own
    if !points.is_empty() {
        points.rotate_right(1);
    }
    mark_smooth(&mut points);
    Contour::new(points, None)
}

/// A point without a name of its own.
pub(super) fn node(p: Point, kind: PointType) -> ContourPoint {
    ContourPoint::new(p.x, p.y, kind, false, None, None)
}

/// Marks the points through which the curve runs without a corner, where a curve is on either side.
fn mark_smooth(points: &mut [ContourPoint]) {
    let n = points.len();
    let at = |i: usize| {
        points
            .get(i % n)
            .map(|p| (Vec2::new(p.x, p.y), p.typ == PointType::OffCurve))
    };
    let smooth: Vec<bool> = (0..n)
        .map(|i| {
            let (Some((before, b)), Some((here, off)), Some((after, a))) =
                (at(i + n - 1), at(i), at(i + 1))
            else {
                return false;
            };
            let (into, out) = (here - before, after - here);
            let turn = angle(into, out).abs();
            !off && (a || b) && into.hypot() > 0.0 && out.hypot() > 0.0 && turn < SMOOTH
        })
        .collect();
    for (point, smooth) in points.iter_mut().zip(smooth) {
        point.smooth = smooth;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::{Info, Name};
    use write_fonts::dump_table;
    use write_fonts::tables::os2::Os2;

    #[test]
    fn compilers_are_told_of_embedding_and_of_lines() {
        let notdef = Glyph::new(Name::notdef(), Vec::new(), 500.0);
        let mut font = Font::new(Info::default(), vec![notdef]).unwrap();
        let told = |font: &Font| {
            let info = info(font);
            let strikeout = (
                info.open_type_os2_strikeout_position,
                info.open_type_os2_strikeout_size,
            );
            let underline = (
                info.postscript_underline_position,
                info.postscript_underline_thickness,
            );
            (info.open_type_os2_type, strikeout, underline)
        };
        let lines = ((Some(260), Some(50)), (Some(-100.0), Some(50.0)));
        assert_eq!(told(&font), (Some(Vec::new()), lines.0, lines.1));
        let own = Os2 {
            fs_type: 0b1_0000_0100,
            y_strikeout_position: 310,
            y_strikeout_size: 20,
            ..Os2::default()
        };
        font.carried.insert(*b"OS/2", dump_table(&own).unwrap());
        assert_eq!(
            told(&font),
            (Some(vec![2, 8]), (Some(310), Some(20)), lines.1)
        );
    }

    #[test]
    fn dates() {
        for (seconds, text) in [
            (0, "1970/01/01 00:00:00"),
            (951_782_399, "2000/02/28 23:59:59"),
            (951_782_400, "2000/02/29 00:00:00"),
            (4_107_542_400, "2100/03/01 00:00:00"),
            (-1, "1969/12/31 23:59:59"),
        ] {
            assert_eq!(date(seconds), text);
        }
    }

    #[test]
    fn a_contour_goes_there_and_back() {
        for svg in [
            "M0 0L10 0L10 10Z",
            "M0 0C0 5 5 10 10 10C15 10 20 5 20 0Z",
            "M0 0L20 0C20 5 15 10 10 10C5 10 0 5 0 0Z",
        ] {
            let path = BezPath::from_svg(svg).unwrap();
            let ours = contour(&path);
            let back = ours.to_kurbo().unwrap();
            assert!(
                (kurbo::Shape::area(&back) - kurbo::Shape::area(&path)).abs() < 1e-9,
                "{svg}"
            );
            assert!(ours.is_closed(), "{svg}");
            assert_eq!((ours.points[0].x, ours.points[0].y), (0.0, 0.0), "{svg}");
        }
        let round = contour(&BezPath::from_svg("M0 0C0 5 5 10 10 10C15 10 20 5 20 0Z").unwrap());
        assert_eq!(
            round.points.iter().map(|p| p.smooth).collect::<Vec<_>>(),
            [false, false, false, true, false, false, false]
        );
    }
}
