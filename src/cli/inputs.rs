//! The files that a project names, each of them hashed once.

use khatt::pipeline::{digest, digest_of};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Digests of files as they were when they were last read.
#[derive(Debug, Default)]
pub(crate) struct Digests {
    known: Mutex<BTreeMap<PathBuf, String>>,
}

impl Digests {
    /// A file's content, or why there is none.
    pub(crate) fn read(&self, path: &Path) -> Result<Vec<u8>, String> {
        regular(path)?;
        let bytes = fs::read(path).map_err(|e| e.to_string())?;
        self.is(path, &bytes);
        Ok(bytes)
    }

    /// Remembers what a file was read as.
    pub(crate) fn is(&self, path: &Path, bytes: &[u8]) {
        self.remember(path, digest(bytes));
    }

    fn remember(&self, path: &Path, digest: String) {
        let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
        known.insert(path.to_owned(), digest);
    }

    /// The digest of a file, or why there is none.
    pub(crate) fn of(&self, path: &Path) -> Result<String, String> {
        let known = || {
            let known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
            known.get(path).cloned()
        };
        if let Some(known) = known() {
            return Ok(known);
        }
        regular(path)?;
        let file = File::open(path).map_err(|e| e.to_string())?;
        let digest = digest_of(file).map_err(|e| e.to_string())?;
        self.remember(path, digest.clone());
        Ok(digest)
    }
}

/// An error for what is no file: a pipe or a device could go on for ever.
fn regular(path: &Path) -> Result<(), String> {
    let file = fs::metadata(path).map_err(|e| e.to_string())?;
    if file.is_file() {
        Ok(())
    } else {
        Err("this is no regular file".to_owned())
    }
}
