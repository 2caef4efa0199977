//! A UFO in memory → its files and back.

use crate::types::Files;
use crate::write::WriteError;
use norad::{DataRequest, Font, WriteOptions};
use std::error::Error;
use std::io;
use std::iter;
use std::path::Path;
use std::sync::Mutex;

/// The files of a UFO in memory.
pub(in crate::write) fn bytes(ufo: &Font) -> Result<Files, WriteError> {
    let files = Mutex::new(Files::default());
    let sink = |path: &Path, data: &[u8]| {
        let name = path
            .iter()
            .map(|p| p.to_string_lossy())
            .collect::<Vec<_>>()
            .join("/");
        let mut files = files.lock().map_err(|e| io::Error::other(e.to_string()))?;
        files.0.insert(name, data.to_vec());
        Ok(())
    };
    ufo.save_to_sink(&sink, &WriteOptions::default())
        .map_err(|e| failed(&e))?;
    files.into_inner().map_err(|e| failed(&e))
}

pub(in crate::write) fn failed(error: &dyn Error) -> WriteError {
    WriteError::table("UFO", error)
}

/// The UFO of such files.
pub(in crate::write) fn load(files: &Files) -> Result<Font, WriteError> {
    let source = |path: &Path| {
        let name: Vec<_> = path.iter().map(|p| p.to_string_lossy()).collect();
        files
            .0
            .get(&name.join("/"))
            .map(|content| Ok::<_, io::Error>(content.clone()))
    };
    let font = Font::load_from_source(&DataRequest::all(), &source);
    font.map_err(|e| WriteError::Unread(causes(&e)))
}

/// An error and its causes, which name the file and the reason.
fn causes(error: &dyn Error) -> String {
    let all = iter::successors(Some(error), |e| (*e).source());
    let all: Vec<String> = all.map(ToString::to_string).collect();
    all.join(": ")
}
