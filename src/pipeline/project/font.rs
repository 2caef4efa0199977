//! `[font]`: what the font says about itself.

use super::check;
use crate::types::{Info, style};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;

/// What the font says about itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FontTable {
    /// Family name.
    #[serde(deserialize_with = "check::named")]
    pub family: String,
    /// Style name.
    #[serde(default = "style", deserialize_with = "check::named")]
    pub style: String,
    /// Version, such as `"1.002"`.
    #[serde(default = "version", deserialize_with = "check::version")]
    pub version: String,
    /// Units an em, 16…16384.
    #[serde(default = "units_per_em", deserialize_with = "check::units_per_em")]
    pub units_per_em: u16,
    /// PostScript name, instead of one that follows from family and style.
    #[serde(default, deserialize_with = "check::postscript")]
    pub postscript_name: Option<String>,
    /// Weight class, 1…1000, instead of the one that the style's name says.
    #[serde(default, deserialize_with = "check::weight")]
    pub weight: Option<u16>,
    /// Angle of the stems, degrees counter-clockwise from upright: negative for an italic.
    #[serde(default, deserialize_with = "check::slant")]
    pub italic_angle: f64,
    /// A feature file of the user's own, relative to the project file.
    pub features: Option<PathBuf>,
    /// Copyright notice.
    pub copyright: Option<String>,
    /// Designer.
    pub designer: Option<String>,
    /// Manufacturer.
    pub manufacturer: Option<String>,
    /// Licence text.
    #[serde(alias = "license")]
    pub licence: Option<String>,
    /// Where the licence stands in full.
    #[serde(alias = "license_url")]
    pub licence_url: Option<String>,
    /// Web address of the vendor.
    pub vendor_url: Option<String>,
    /// Four letters registered for the vendor.
    #[serde(default = "vendor", deserialize_with = "check::vendor")]
    pub vendor: String,
}

fn style() -> String {
    Info::default().style
}

fn version() -> String {
    let (major, minor) = Info::default().version;
    format!("{major}.{minor:03}")
}

fn units_per_em() -> u16 {
    Info::default().units_per_em
}

fn vendor() -> String {
    String::from_utf8_lossy(&Info::default().vendor_id).into_owned()
}

impl FontTable {
    /// What of it pages depend on: the units in which letters are placed, and the family, which printed pages name.
    /// All else is fixed.
    pub(crate) fn of_pages(&self) -> Self {
        Self {
            family: self.family.clone(),
            style: style(),
            version: version(),
            units_per_em: self.units_per_em,
            postscript_name: None,
            weight: None,
            italic_angle: 0.0,
            features: None,
            copyright: None,
            designer: None,
            manufacturer: None,
            licence: None,
            licence_url: None,
            vendor_url: None,
            vendor: vendor(),
        }
    }

    /// What the font says about itself; `created` is seconds since 1970. Heights are still to be measured,
    /// except those that the file gives.
    #[must_use]
    pub fn info(&self, created: i64) -> Info {
        let mut vendor_id = *b"    ";
        vendor_id
            .iter_mut()
            .zip(self.vendor.bytes())
            .for_each(|(to, b)| *to = b);
        let default = Info::default();
        Info {
            family: self.family.clone(),
            style: self.style.clone(),
            version: check::version_numbers(&self.version).unwrap_or(default.version),
            units_per_em: self.units_per_em,
            weight: self
                .weight
                .or_else(|| style::weight(&self.style))
                .unwrap_or(default.weight),
            italic_angle: self.italic_angle,
            created,
            copyright: self.copyright.clone(),
            designer: self.designer.clone(),
            manufacturer: self.manufacturer.clone(),
            license: self.licence.clone(),
            license_url: self.licence_url.clone(),
            vendor_url: self.vendor_url.clone(),
            vendor_id,
            metrics: default.metrics,
            postscript: self.postscript_name.clone(),
        }
    }
}
