//! The name table: what a font calls itself.

use super::WriteError;
use crate::types::Info;
use write_fonts::tables::name::{Name, NameRecord};
use write_fonts::types::NameId;

/// Windows, Unicode BMP, US English: what every program reads.
const PLATFORM: (u16, u16, u16) = (3, 1, 0x409);

/// `1.000`, as fonts write versions.
pub(super) fn version(info: &Info) -> String {
    let (major, minor) = info.version;
    format!("{major}.{minor:03}")
}

/// The table.
pub(super) fn table(info: &Info) -> Result<Name, WriteError> {
    let style = info.linked_style();
    let is_other = !info.style.is_empty() && !style.linked.eq_ignore_ascii_case(&info.style);
    let is_split = style.family != info.family || is_other;
    let full = if is_split || style.linked != "Regular" {
        format!("{} {}", info.family, info.style)
    } else {
        format!("{} Regular", info.family)
    };
    let postscript = info.postscript_name();
    let vendor = String::from_utf8_lossy(&info.vendor_id).into_owned();
    let unique = format!("{};{};{postscript}", version(info), vendor.trim());
    let typographic = |text: &String| is_split.then(|| text.clone());
    let texts = [
        (0, info.copyright.clone()),
        (1, Some(style.family.clone())),
        (2, Some(style.linked.to_owned())),
        (3, Some(unique)),
        (4, Some(full)),
        (5, Some(format!("Version {}", version(info)))),
        (6, Some(postscript)),
        (8, info.manufacturer.clone()),
        (9, info.designer.clone()),
        (11, info.vendor_url.clone()),
        (13, info.license.clone()),
        (14, info.license_url.clone()),
        (16, typographic(&info.family)),
        (17, typographic(&info.style)),
    ];
    let size: usize = texts.iter().flat_map(|(_, t)| t).map(|t| 2 * t.len()).sum();
    if size > usize::from(u16::MAX) {
        return Err(WriteError::table(
            "name",
            "its texts exceed 64 KiB; shorten the licence",
        ));
    }
    let (platform, encoding, language) = PLATFORM;
    let record = |(id, text): (u16, Option<String>)| {
        text.filter(|t| !t.is_empty())
            .map(|t| NameRecord::new(platform, encoding, language, NameId::new(id), t.into()))
    };
    Ok(Name::new(texts.into_iter().filter_map(record).collect()))
}
