//! The name table: what a font calls itself.

use super::WriteError;
use crate::types::Info;
use write_fonts::tables::name::{Name, NameRecord};
use write_fonts::types::NameId;

/// Windows, Unicode BMP, US English: what every program reads.
const PLATFORM: (u16, u16, u16) = (3, 1, 0x409);

/// The four styles that one family menu can hold.
const LINKED_STYLES: [&str; 4] = ["Regular", "Italic", "Bold", "Bold Italic"];

/// How a style is split between the old family menu and the typographic one.
pub(super) struct Style {
    pub(super) family: String,
    pub(super) linked: &'static str,
    pub(super) is_bold: bool,
    pub(super) is_italic: bool,
}

/// The style as four-style menus show it: others become families of their own.
pub(super) fn style(info: &Info) -> Style {
    let linked = LINKED_STYLES
        .into_iter()
        .find(|s| s.eq_ignore_ascii_case(&info.style));
    let family = match linked {
        Some(_) => info.family.clone(),
        None => format!("{} {}", info.family, info.style),
    };
    let linked = linked.unwrap_or("Regular");
    Style {
        family,
        linked,
        is_bold: linked.contains("Bold"),
        is_italic: linked.contains("Italic"),
    }
}

/// The PostScript name: printable ASCII without brackets, slashes, percent and space, 63 at most.
pub(super) fn postscript(info: &Info) -> String {
    let keep = |text: &str| -> String {
        text.chars()
            .filter(|c| c.is_ascii_graphic() && !"[](){}<>/%-".contains(*c))
            .collect()
    };
    let family = Some(keep(&info.family)).filter(|f| !f.is_empty());
    let style = Some(keep(&info.style)).filter(|s| !s.is_empty());
    let whole = format!(
        "{}-{}",
        family.as_deref().unwrap_or("Font"),
        style.as_deref().unwrap_or("Regular")
    );
    whole.chars().take(63).collect()
}

/// `1.000`, as fonts write versions.
pub(super) fn version(info: &Info) -> String {
    let (major, minor) = info.version;
    format!("{major}.{minor:03}")
}

/// The table.
pub(super) fn table(info: &Info) -> Result<Name, WriteError> {
    let style = style(info);
    let is_split = style.family != info.family;
    let full = if is_split || style.linked != "Regular" {
        format!("{} {}", info.family, info.style)
    } else {
        format!("{} Regular", info.family)
    };
    let postscript = postscript(info);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn postscript_names_are_legal() {
        let info = |family: &str, style: &str| Info {
            family: family.to_owned(),
            style: style.to_owned(),
            ..Info::default()
        };
        assert_eq!(
            postscript(&info("Khatt Latin", "Bold Italic")),
            "KhattLatin-BoldItalic"
        );
        assert_eq!(postscript(&info("خط", "")), "Font-Regular");
        assert_eq!(postscript(&info(&"x".repeat(90), "R")).len(), 63);
        assert_eq!(style(&info("A", "Medium")).family, "A Medium");
    }
}
