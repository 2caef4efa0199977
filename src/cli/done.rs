//! Whether a build has nothing to do: the files that it read last time and the outputs that it wrote are still the
//! same.

use super::cache::Cache;
use super::project::Opened;
use super::staged::strays;
use khatt::pipeline::{Store, digest};
use khatt::types::Files;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use std::fs;
use std::path::{Path, PathBuf};

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

    /// What the build of this key said, where all that it read and wrote is as it was.
    pub(crate) fn recall(cache: &Cache, key: &str, opened: &Opened) -> Option<String> {
        let done: Self = serde_json::from_slice(&cache.get(key)?).ok()?;
        let is = |path: &Path, wanted: &str| fs::read(path).is_ok_and(|b| digest(&b) == wanted);
        let same =
            |(path, wanted): &(PathBuf, String)| opened.digest_of(path).as_ref() == Some(wanted);
        let inputs: Vec<bool> = done.inputs.par_iter().map(same).collect();
        let output = |(path, files): &(PathBuf, Vec<(String, String)>)| {
            let at = |name: &str| match name {
                "" => path.clone(),
                name => path.join(name),
            };
            let part = |name: &str| files.iter().any(|(n, _)| n == name);
            let whole = files.iter().all(|(name, wanted)| is(&at(name), wanted));
            whole && strays(path, part).is_empty()
        };
        (inputs.iter().all(|same| *same) && done.outputs.iter().all(output)).then_some(done.said)
    }
}
