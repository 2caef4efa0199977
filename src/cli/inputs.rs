//! The files that a project names, each of them hashed once.

use khatt::pipeline::{digest, digest_of};
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Digests of files as they were when they were first asked for.
#[derive(Debug, Default)]
pub(crate) struct Digests {
    known: Mutex<BTreeMap<PathBuf, Known>>,
}

#[derive(Debug, Clone)]
struct Known {
    /// The first digest; none of what could not be read.
    first: Option<String>,
    /// Whether it was another one later.
    changed: bool,
}

impl Digests {
    /// A file's content, or why there is none.
    pub(crate) fn read(&self, path: &Path) -> Result<Vec<u8>, String> {
        let bytes = regular(path).and_then(|()| fs::read(path).map_err(|e| e.to_string()));
        self.remember(path, bytes.as_ref().ok().map(|bytes| digest(bytes)));
        bytes
    }

    /// Remembers what a file was read as.
    pub(crate) fn is(&self, path: &Path, bytes: &[u8]) {
        self.remember(path, Some(digest(bytes)));
    }

    /// The files that were asked for.
    pub(crate) fn files(&self) -> Vec<PathBuf> {
        self.known().keys().cloned().collect()
    }

    /// Whether any of them is not what it was any more.
    pub(crate) fn changed(&self) -> bool {
        let known = self.known().clone();
        let now = Self::default();
        known
            .iter()
            .any(|(path, was)| now.of(path).ok() != was.first)
    }

    fn known(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Known>> {
        self.known.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A file that is read twice may have changed in between: what came of it is that of its first state, or of none.
    fn remember(&self, path: &Path, digest: Option<String>) {
        let mut all = self.known();
        let known = all.entry(path.to_owned()).or_insert_with(|| Known {
            first: digest.clone(),
            changed: false,
        });
        known.changed |= known.first != digest;
    }

    /// The digest of a file, or why there is none.
    pub(crate) fn of(&self, path: &Path) -> Result<String, String> {
        let known = self.known().get(path).and_then(|k| k.first.clone());
        if let Some(known) = known {
            return Ok(known);
        }
        let digest = regular(path).and_then(|()| {
            let digest = File::open(path).and_then(digest_of);
            digest.map_err(|e| e.to_string())
        });
        self.remember(path, digest.as_ref().ok().cloned());
        digest
    }

    /// The digest of a file that has been the same whenever it was read, or why there is none.
    pub(crate) fn steady(&self, path: &Path) -> Result<String, String> {
        let digest = self.of(path)?;
        match self.known().get(path) {
            Some(known) if known.changed => Err("it has changed meanwhile".to_owned()),
            _ => Ok(digest),
        }
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

#[cfg(test)]
#[expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who writes files"
)]
mod tests {
    use super::*;

    #[test]
    fn what_was_read_twice_is_what_it_was_first() {
        let dir = tempfile::tempdir().unwrap();
        let (page, missing) = (dir.path().join("page"), dir.path().join("missing"));
        fs::write(&page, "one").unwrap();
        let digests = Digests::default();
        assert_eq!(digests.read(&page).unwrap(), b"one");
        assert!(digests.of(&missing).is_err());
        assert!(!digests.changed());
        fs::write(&page, "two").unwrap();
        assert_eq!(digests.read(&page).unwrap(), b"two");
        assert!(digests.changed());
        fs::write(&page, "one").unwrap();
        assert!(!digests.changed());
        fs::write(&missing, "here").unwrap();
        assert!(digests.of(&missing).is_ok());
        assert!(digests.changed());
    }
}
