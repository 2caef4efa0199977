//! A UFO that the library refuses: which of its files, why, and what to do.

use super::ReadError;
use norad::error::{FontLoadError, LayerLoadError};
use std::error::Error;
use std::io;
use std::iter::successors;
use std::path::Path;

/// What the error says, with the file within the UFO where it is one's.
pub(super) fn damage(error: &FontLoadError) -> ReadError {
    let file = file(error);
    let mut why = String::new();
    for cause in successors(reason(error), |&e| e.source()) {
        let cause = said(cause);
        // some libraries say their cause themselves
        if !why.contains(&cause) {
            why += if why.is_empty() { "" } else { ": " };
            why += &cause;
        }
    }
    ReadError::Ufo { file, why }
}

/// The error alone; a missing file's names the file once more where the reason should stand.
fn said(error: &(dyn Error + 'static)) -> String {
    match error.downcast_ref::<io::Error>() {
        Some(e) if e.kind() == io::ErrorKind::NotFound => "there is no such file".to_owned(),
        _ => error.to_string().trim_end_matches('.').to_owned(),
    }
}

/// The outermost error that says more than which file it is.
fn reason(error: &FontLoadError) -> Option<&(dyn Error + 'static)> {
    let outer = match error {
        FontLoadError::Layer { source, .. } => match &**source {
            LayerLoadError::Glyph { source, .. } => return Some(source),
            LayerLoadError::ParsePlist { source, .. } => return Some(source),
            other => return Some(other),
        },
        FontLoadError::ParsePlist { source, .. } => return Some(source),
        other => other,
    };
    match outer {
        FontLoadError::AccessUfoDir(_)
        | FontLoadError::DataStore(_)
        | FontLoadError::FeatureFile(_)
        | FontLoadError::FontInfo(_)
        | FontLoadError::ImagesStore(_)
        | FontLoadError::InvalidGroups(_)
        | FontLoadError::GroupsUpconversionFailure(_) => outer.source(),
        _ => Some(outer),
    }
}

/// The file, its path within the UFO.
fn file(error: &FontLoadError) -> String {
    let shown = |p: &Path| p.display().to_string();
    match error {
        FontLoadError::Layer { path, source, .. } => match &**source {
            LayerLoadError::Glyph { path, .. } => shown(path),
            LayerLoadError::ParsePlist { name, .. } => shown(&path.join(name)),
            LayerLoadError::MissingContentsFile => shown(&path.join("contents.plist")),
            _ => shown(path),
        },
        FontLoadError::ParsePlist { name, .. } => (*name).to_owned(),
        FontLoadError::FontInfo(_) => "fontinfo.plist".to_owned(),
        FontLoadError::InvalidGroups(_) | FontLoadError::GroupsUpconversionFailure(_) => {
            "groups.plist".to_owned()
        }
        FontLoadError::FeatureFile(_) => "features.fea".to_owned(),
        FontLoadError::LibFileMustBeDictionary | FontLoadError::FontInfoV1Upconversion(_) => {
            "lib.plist".to_owned()
        }
        FontLoadError::MissingLayerContentsFile | FontLoadError::MissingDefaultLayer => {
            "layercontents.plist".to_owned()
        }
        FontLoadError::MissingMetaInfoFile => "metainfo.plist".to_owned(),
        FontLoadError::DataStore(_) => "data".to_owned(),
        FontLoadError::ImagesStore(_) => "images".to_owned(),
        _ => "one of its files".to_owned(),
    }
}
