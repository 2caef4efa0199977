//! `[output]`: what is made, and where it goes.

use super::check::checked;
use crate::write::{FORMATS, Format};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize};
use std::path::{Path, PathBuf};

/// The outputs to make, relative to the project file; those left out are not made.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct OutputTable {
    /// Font with TrueType outlines.
    #[serde(deserialize_with = "ttf")]
    pub ttf: Option<PathBuf>,
    /// Font with cubic (CFF) outlines.
    #[serde(deserialize_with = "otf")]
    pub otf: Option<PathBuf>,
    /// The TrueType font compressed for the web.
    #[serde(deserialize_with = "woff2")]
    pub woff2: Option<PathBuf>,
    /// Source for font editors: a folder.
    #[serde(deserialize_with = "ufo")]
    pub ufo: Option<PathBuf>,
    /// One SVG a glyph: a folder.
    #[serde(deserialize_with = "svg")]
    pub svg: Option<PathBuf>,
    /// Web page that shows every cell with its outline.
    #[serde(deserialize_with = "proof")]
    pub proof: Option<PathBuf>,
    /// What was done and how well, JSON.
    #[serde(deserialize_with = "report")]
    pub report: Option<PathBuf>,
}

impl OutputTable {
    /// The fonts to make: each format that is named, and where it goes.
    #[must_use]
    pub fn fonts(&self) -> Vec<(&'static Format, &PathBuf)> {
        let path = |name: &str| self.named().find(|(key, _)| *key == name);
        let named = FORMATS.iter();
        let named = named.filter_map(|f| Some((f, path(f.name)?.1)));
        named.collect()
    }

    /// Where all that is made goes, each with its key.
    pub fn named(&self) -> impl Iterator<Item = (&'static str, &PathBuf)> {
        let all = [
            ("ttf", &self.ttf),
            ("otf", &self.otf),
            ("woff2", &self.woff2),
            ("ufo", &self.ufo),
            ("svg", &self.svg),
            ("proof", &self.proof),
            ("report", &self.report),
        ];
        let all = all.into_iter();
        all.filter_map(|(key, path)| Some((key, path.as_ref()?)))
    }
}

/// Endings that say what a file is.
const KINDS: [&str; 9] = [
    "ttf", "otf", "woff2", "woff", "ufo", "svg", "html", "htm", "json",
];

/// Where an output goes, if it is made.
type Place = Option<PathBuf>;

/// The path of a file whose name does not say that it is another kind than `own`.
fn file<'de, D: Deserializer<'de>>(from: D, own: &[&str]) -> Result<Place, D::Error> {
    let path = PathBuf::deserialize(from)?;
    let is_dash = path.as_os_str() == "-";
    match ending(&path).filter(|e| !own.contains(&e.as_str())) {
        None if is_dash => Err(format!(
            "must be the name of a file, which ends in .{}",
            own[0]
        )),
        Some(other) if KINDS.contains(&other.as_str()) => Err(format!(
            "must end in .{}: .{other} says that it is something else",
            own[0]
        )),
        _ => Ok(Some(path)),
    }
    .map_err(D::Error::custom)
}

fn ending(path: &Path) -> Option<String> {
    let ending = path.extension()?.to_str()?;
    Some(ending.to_ascii_lowercase())
}

fn ttf<'de, D: Deserializer<'de>>(from: D) -> Result<Place, D::Error> {
    file(from, &["ttf"])
}

fn otf<'de, D: Deserializer<'de>>(from: D) -> Result<Place, D::Error> {
    file(from, &["otf"])
}

fn woff2<'de, D: Deserializer<'de>>(from: D) -> Result<Place, D::Error> {
    file(from, &["woff2"])
}

fn proof<'de, D: Deserializer<'de>>(from: D) -> Result<Place, D::Error> {
    file(from, &["html", "htm"])
}

fn report<'de, D: Deserializer<'de>>(from: D) -> Result<Place, D::Error> {
    file(from, &["json"])
}

/// Font editors know a UFO by its name.
fn ufo<'de, D: Deserializer<'de>>(from: D) -> Result<Place, D::Error> {
    let must = "must end in .ufo, by which programs know that the folder is one";
    checked(
        from,
        |path: &PathBuf| ending(path).is_some_and(|e| e == "ufo"),
        must,
    )
    .map(Some)
}

fn svg<'de, D: Deserializer<'de>>(from: D) -> Result<Place, D::Error> {
    let must = "must be the name of a folder, without the ending of a file";
    let is_kind = |path: &PathBuf| ending(path).is_some_and(|e| KINDS.contains(&e.as_str()));
    let fine = |path: &PathBuf| !is_kind(path) && path.as_os_str() != "-";
    checked(from, fine, must).map(Some)
}
