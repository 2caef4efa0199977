//! The texts by which a font file names a font.

use super::Info;

impl Info {
    /// The version as fonts write it, `1.000`.
    pub(crate) fn version_text(&self) -> String {
        let (major, minor) = self.version;
        format!("{major}.{minor:03}")
    }

    /// The texts of the name table by their ids, as far as there are any.
    pub(crate) fn names(&self) -> Vec<(u16, String)> {
        let style = self.linked_style();
        let is_other = !self.style.is_empty() && !style.linked.eq_ignore_ascii_case(&self.style);
        let is_split = style.family != self.family || is_other;
        let full = if is_split || style.linked != "Regular" {
            format!("{} {}", self.family, self.style)
        } else {
            format!("{} Regular", self.family)
        };
        let postscript = self.postscript_name();
        let vendor = String::from_utf8_lossy(&self.vendor_id).into_owned();
        let unique = format!("{};{};{postscript}", self.version_text(), vendor.trim());
        let typographic = |text: &String| is_split.then(|| text.clone());
        let texts = [
            (0, self.copyright.clone()),
            (1, Some(style.family.clone())),
            (2, Some(style.linked.to_owned())),
            (3, Some(unique)),
            (4, Some(full)),
            (5, Some(format!("Version {}", self.version_text()))),
            (6, Some(postscript)),
            (8, self.manufacturer.clone()),
            (9, self.designer.clone()),
            (11, self.vendor_url.clone()),
            (13, self.license.clone()),
            (14, self.license_url.clone()),
            (16, typographic(&self.family)),
            (17, typographic(&self.style)),
        ];
        let given = texts.into_iter();
        let given = given.filter_map(|(id, text)| Some((id, text.filter(|t| !t.is_empty())?)));
        given.collect()
    }
}
