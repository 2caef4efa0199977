//! Whether a build has nothing to do: the files that it read last time and the outputs that it wrote are still the same.

use super::cache::{Cache, digest};
use khatt::pipeline::Store;
use khatt::types::Files;
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
    pub(crate) fn new(
        inputs: &[PathBuf],
        outputs: &[(PathBuf, Files)],
        said: &str,
    ) -> Option<Self> {
        let input = |path: &PathBuf| Some((path.clone(), digest(&fs::read(path).ok()?)));
        let output = |(path, files): &(PathBuf, Files)| {
            let files = files.0.iter();
            let digests = files.map(|(name, content)| (name.clone(), digest(content)));
            (path.clone(), digests.collect())
        };
        Some(Self {
            inputs: inputs.iter().map(input).collect::<Option<_>>()?,
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
    pub(crate) fn recall(cache: &Cache, key: &str) -> Option<String> {
        let done: Self = serde_json::from_slice(&cache.get(key)?).ok()?;
        let is = |path: &Path, wanted: &str| fs::read(path).is_ok_and(|b| digest(&b) == wanted);
        let inputs = done.inputs.iter().all(|(path, wanted)| is(path, wanted));
        let output = |(path, files): &(PathBuf, Vec<(String, String)>)| {
            let at = |name: &str| match name {
                "" => path.clone(),
                name => path.join(name),
            };
            files.iter().all(|(name, wanted)| is(&at(name), wanted))
        };
        (inputs && done.outputs.iter().all(output)).then_some(done.said)
    }
}
