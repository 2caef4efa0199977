//! Whether a build has nothing to do: the files that it read last time and the outputs that it wrote are still the
//! same, whatever their dates.

use super::cache::Cache;
use super::project::Opened;
use super::staged::strays;
use khatt::pipeline::{Store, digest};
use khatt::types::Files;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fs::{self, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What a build read, wrote and said.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct Done {
    /// Files and their digests.
    inputs: Vec<(PathBuf, String)>,
    /// Outputs, the names of their files within, and their digests.
    outputs: Vec<(PathBuf, Vec<(String, String)>)>,
    /// What it said to the user.
    said: String,
}

impl Done {
    /// What is remembered of a finished build; nothing where an input is gone already.
    pub(crate) fn new(opened: &Opened, outputs: &[(PathBuf, Files)], said: &str) -> Option<Self> {
        let input = |path: PathBuf| {
            let digest = opened.digest_of(&path)?;
            Some((path, digest))
        };
        let output = |(path, files): &(PathBuf, Files)| {
            let files = files.0.iter();
            let digests = files.map(|(name, content)| (name.clone(), digest(content)));
            (path.clone(), digests.collect())
        };
        Some(Self {
            inputs: (opened.inputs().into_iter().map(input)).collect::<Option<_>>()?,
            outputs: outputs.iter().map(output).collect(),
            said: said.to_owned(),
        })
    }

    pub(crate) fn keep(&self, cache: &Cache, key: &str) {
        if let Ok(bytes) = serde_json::to_vec(self) {
            cache.put(key, &bytes);
        }
    }

    /// The build of this key, where all that it read and wrote is as it was.
    pub(crate) fn recall(cache: &Cache, key: &str, opened: &Opened) -> Option<Self> {
        let done: Self = serde_json::from_slice(&cache.get(key)?).ok()?;
        // a pipe holds nothing, and reading it would never end
        let is = |path: &Path, wanted: &str| {
            let read = path.is_file().then(|| fs::read(path));
            read.is_some_and(|bytes| bytes.is_ok_and(|b| digest(&b) == wanted))
        };
        let same =
            |(path, wanted): &(PathBuf, String)| opened.digest_of(path).as_ref() == Some(wanted);
        let inputs: Vec<bool> = done.inputs.par_iter().map(same).collect();
        let output = |(path, files): &(PathBuf, Vec<(String, String)>)| {
            let part = |name: &str| files.iter().any(|(n, _)| n == name);
            let whole = files
                .iter()
                .all(|(name, wanted)| is(&within(path, name), wanted));
            whole && strays(path, part).is_empty()
        };
        (inputs.iter().all(|same| *same) && done.outputs.iter().all(output)).then_some(done)
    }

    /// What it said to the user.
    pub(crate) fn said(&self) -> &str {
        &self.said
    }

    /// Dates the outputs anew where one is older than an input, for Make, which goes by dates alone and else would
    /// never rest.
    pub(crate) fn date(&self) {
        let dated = |path: &Path| fs::metadata(path).and_then(|m| m.modified()).ok();
        let newest = self.inputs.iter().filter_map(|(path, _)| dated(path)).max();
        let old = |(path, _): &(PathBuf, _)| dated(path) < newest;
        if !self.outputs.iter().any(old) {
            return;
        }
        for (path, files) in &self.outputs {
            let files = files.iter().map(|(name, _)| within(path, name));
            for at in files.chain([path.clone()]) {
                // a file that cannot be dated costs time in the next run, nothing else
                touch(&at).unwrap_or_default();
            }
        }
    }
}

/// Where a file of an output lies; the output itself has no name.
fn within(output: &Path, name: &str) -> PathBuf {
    match name {
        "" => output.to_owned(),
        name => output.join(name),
    }
}

/// Dates a file or a folder now.
fn touch(path: &Path) -> io::Result<()> {
    let mut how = OpenOptions::new();
    // folders cannot be opened otherwise
    let how = if path.is_dir() {
        how.read(true)
    } else {
        how.write(true)
    };
    #[expect(
        clippy::disallowed_methods,
        reason = "the date is that of the file, and in no file"
    )]
    let now = SystemTime::now();
    how.open(path)?.set_modified(now)
}
