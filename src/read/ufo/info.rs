//! What a UFO says about itself.

use crate::read::whole;
use crate::types::formats::{UFO_DATE, USE_TYPO_METRICS};
use crate::types::{Info, Metrics};
use chrono::NaiveDateTime;
use plist::Value;

/// Keys of the information that a font has as they are.
const READ: [&str; 14] = [
    "versionMajor",
    "versionMinor",
    "unitsPerEm",
    "openTypeOS2WeightClass",
    "italicAngle",
    "openTypeHeadCreated",
    "copyright",
    "openTypeNameDesigner",
    "openTypeNameManufacturer",
    "openTypeNameManufacturerURL",
    "openTypeNameLicense",
    "openTypeNameLicenseURL",
    "xHeight",
    "capHeight",
];

/// Heights of OpenType are whole: another that differs by less is the same.
const WHOLE: f64 = 1.0;

/// The information of a font: what is said for OpenType counts before what is said for all.
pub(super) fn info(source: &norad::FontInfo) -> Info {
    let default = Info::default();
    let em = source.units_per_em.as_ref().map_or(1000.0, |v| **v);
    let number = |v: Option<f64>| v.unwrap_or(0.0);
    let either = |first: &Option<String>, second: &Option<String>| first.clone().or(second.clone());
    let hhea = source.open_type_hhea_ascender;
    let ascender = hhea.or(source.open_type_os2_typo_ascender);
    let ascender = height(source.ascender, ascender);
    let hhea = source.open_type_hhea_descender;
    let descender = hhea.or(source.open_type_os2_typo_descender);
    let descender = height(source.descender, descender);
    let hhea = source.open_type_hhea_line_gap;
    let line_gap = hhea.or(source.open_type_os2_typo_line_gap).map(f64::from);
    Info {
        family: either(
            &source.open_type_name_preferred_family_name,
            &source.family_name,
        )
        .unwrap_or(default.family),
        style: either(
            &source.open_type_name_preferred_subfamily_name,
            &source.style_name,
        )
        .unwrap_or(default.style),
        postscript: None,
        version: (
            small(source.version_major.map(f64::from), 1),
            small(source.version_minor.map(f64::from), 0),
        ),
        units_per_em: small(Some(em), 1000).clamp(16, 16384),
        weight: small(source.open_type_os2_weight_class.map(f64::from), 400).clamp(1, 1000),
        italic_angle: number(source.italic_angle),
        created: source
            .open_type_head_created
            .as_deref()
            .and_then(seconds)
            .unwrap_or(default.created),
        copyright: source.copyright.clone(),
        designer: source.open_type_name_designer.clone(),
        manufacturer: source.open_type_name_manufacturer.clone(),
        license: source.open_type_name_license.clone(),
        license_url: source.open_type_name_license_url.clone(),
        vendor_url: source.open_type_name_manufacturer_url.clone(),
        vendor_id: source
            .open_type_os2_vendor_id
            .as_deref()
            .and_then(vendor)
            .unwrap_or(default.vendor_id),
        metrics: Metrics {
            ascender: ascender.unwrap_or(0.8 * em),
            descender: descender.unwrap_or(-0.2 * em).min(0.0),
            line_gap: number(line_gap),
            x_height: number(source.x_height),
            cap_height: number(source.cap_height),
        },
    }
    .with_postscript(source.postscript_font_name.clone())
}

/// A height, and that which is said for OpenType. Those are whole, so that a fraction beside it says more.
fn height(own: Option<f64>, opentype: Option<i32>) -> Option<f64> {
    let whole = opentype.map(f64::from);
    let own = own.filter(|v| whole.is_none_or(|w| (w - v).abs() < WHOLE));
    own.or(whole)
}

/// The four letters of a vendor, filled up with spaces.
fn vendor(text: &str) -> Option<[u8; 4]> {
    format!("{text:4}").into_bytes().try_into().ok()
}

/// Seconds since 1970 of a UFO's date, UTC.
fn seconds(date: &str) -> Option<i64> {
    let date = NaiveDateTime::parse_from_str(date, UFO_DATE).ok()?;
    Some(date.and_utc().timestamp())
}

/// The keys of the information whose values the font does not have.
pub(super) fn unread(source: &norad::FontInfo, info: &Info) -> Option<String> {
    let (m, style) = (info.metrics, info.linked_style());
    let near = |v: &Value, held: f64| {
        let whole = v.as_signed_integer().and_then(|v| i32::try_from(v).ok());
        let v = v.as_real().or(whole.map(f64::from));
        v.is_some_and(|v| (v - held).abs() < WHOLE)
    };
    let is = |v: &Value, held: &str| {
        v.as_string()
            .is_some_and(|v| v.trim_end() == held.trim_end())
    };
    let kept = |(key, v): &(String, Value)| match key.as_str() {
        "ascender" | "openTypeHheaAscender" | "openTypeOS2TypoAscender" => near(v, m.ascender),
        "descender" | "openTypeHheaDescender" | "openTypeOS2TypoDescender" => near(v, m.descender),
        "openTypeHheaLineGap" | "openTypeOS2TypoLineGap" => near(v, m.line_gap),
        "familyName" | "openTypeNamePreferredFamilyName" => is(v, &info.family),
        "styleName" | "openTypeNamePreferredSubfamilyName" => is(v, &info.style),
        "styleMapFamilyName" => is(v, &style.family),
        "styleMapStyleName" => is(v, &style.linked.to_lowercase()),
        "postscriptFontName" => is(v, &info.postscript_name()),
        "openTypeOS2VendorID" => is(v, &String::from_utf8_lossy(&info.vendor_id)),
        "postscriptUnderlinePosition" => near(v, info.underline().0),
        "postscriptUnderlineThickness" => near(v, info.underline().1),
        "openTypeOS2StrikeoutPosition" => near(v, info.strikeout().0),
        "openTypeOS2StrikeoutSize" => near(v, info.strikeout().1),
        "openTypeOS2Type" => v.as_array().is_some_and(Vec::is_empty),
        "openTypeOS2Selection" => *v == Value::Array(vec![USE_TYPO_METRICS.into()]),
        key => READ.contains(&key),
    };
    let all = plist::to_value(source)
        .ok()
        .and_then(Value::into_dictionary);
    let all = all.into_iter().flatten().filter(|entry| !kept(entry));
    let mut keys: Vec<String> = all.map(|(key, _)| key).collect();
    keys.sort();
    (!keys.is_empty()).then(|| format!("font information ({})", keys.join(", ")))
}

/// A whole number of 16 bits, or what stands for a missing one.
fn small(v: Option<f64>, missing: u16) -> u16 {
    v.map_or(missing, whole)
}
