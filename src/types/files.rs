//! What a writer made, before anything touches the disk.

use std::collections::BTreeMap;

/// Relative path with `/` → content. A single file stands under the empty path.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Files(pub BTreeMap<String, Vec<u8>>);

impl Files {
    /// One file that takes the name of the whole output.
    #[must_use]
    pub fn single(content: Vec<u8>) -> Self {
        Self(BTreeMap::from([(String::new(), content)]))
    }
}
