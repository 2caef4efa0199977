//! The name table: what a font calls itself.

use super::WriteError;
use crate::types::Info;
use write_fonts::tables::name::{Name, NameRecord};
use write_fonts::types::NameId;

/// Windows, Unicode BMP, US English: what every program reads.
const PLATFORM: (u16, u16, u16) = (3, 1, 0x409);

/// How a style is split between the old family menu and the typographic one.
pub(super) struct Style {
    pub(super) family: String,
    pub(super) linked: &'static str,
    pub(super) is_bold: bool,
    pub(super) is_italic: bool,
}

/// The style as menus of four show it, Regular, Italic, Bold and Bold Italic: others become families of their own, each with
/// its italic.
pub(super) fn style(info: &Info) -> Style {
    let words: Vec<&str> = info.style.split_whitespace().collect();
    let is = |word: &str, names: &[&str]| names.iter().any(|n| n.eq_ignore_ascii_case(word));
    let (is_italic, upright) = match words.split_last() {
        Some((last, rest)) if is(last, &["Italic", "Oblique"]) => (true, rest),
        _ => (false, words.as_slice()),
    };
    let is_bold = matches!(upright, [word] if is(word, &["Bold"]));
    let is_plain = match upright {
        [] => true,
        [word] => is(word, &["Regular", "Bold"]),
        _ => false,
    };
    Style {
        family: if is_plain {
            info.family.clone()
        } else {
            format!("{} {}", info.family, upright.join(" "))
        },
        linked: match (is_bold, is_italic) {
            (false, false) => "Regular",
            (false, true) => "Italic",
            (true, false) => "Bold",
            (true, true) => "Bold Italic",
        },
        is_bold,
        is_italic,
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
    let is_other = !info.style.is_empty() && !style.linked.eq_ignore_ascii_case(&info.style);
    let is_split = style.family != info.family || is_other;
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
    }

    #[test]
    fn every_family_of_four_styles_has_its_italic() {
        for (name, family, linked) in [
            ("Medium", "A Medium", "Regular"),
            ("SemiBold Italic", "A SemiBold", "Italic"),
            ("bold italic", "A", "Bold Italic"),
            ("Oblique", "A", "Italic"),
            ("Bold Condensed", "A Bold Condensed", "Regular"),
            ("", "A", "Regular"),
        ] {
            let info = Info {
                family: "A".to_owned(),
                style: name.to_owned(),
                ..Info::default()
            };
            let style = style(&info);
            assert_eq!(
                (style.family.as_str(), style.linked),
                (family, linked),
                "{name}"
            );
            assert_eq!(style.is_italic, linked.contains("Italic"), "{name}");
        }
    }
}
