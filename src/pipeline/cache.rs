//! What became of a table's pages, kept under a digest of all that it follows from.
//!
//! Load, clean, cut and trace are nearly all of a build's work, and what they make of a page follows
//! from its bytes, its labels, the options of these stages and the program. So a page that has not changed
//! is not read again, and a change of what comes later, spacing or outputs, redoes no page.

use super::build::World;
use super::letter::Letter;
use super::page::Page;
use super::problem::Problem;
use super::project::{Project, SheetTable};
use super::record;
use crate::types::Label;
use serde_json::json;
use sha2::{Digest, Sha256};

/// Where results are kept between runs.
pub trait Store: Sync {
    /// What was put under that key, exactly; anything else, or nothing, where there is no such thing.
    fn get(&self, key: &str) -> Option<Vec<u8>>;

    /// Keeps `content` under a key, or not.
    fn put(&self, key: &str, content: &[u8]);
}

/// Keeps nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Nothing;

impl Store for Nothing {
    fn get(&self, _: &str) -> Option<Vec<u8>> {
        None
    }

    fn put(&self, _: &str, _: &[u8]) {}
}

/// The letters and pages of a table: those that are kept, or what `make` gives, which is then kept.
///
/// # Errors
/// A picture cannot be read, or `make` says so.
pub(super) fn recalled(
    (table, labels): (&SheetTable, &[Label]),
    project: &Project,
    world: World<'_>,
    make: impl FnOnce() -> Result<Vec<(Vec<Letter>, Page)>, Vec<Problem>>,
) -> Result<Vec<(Vec<Letter>, Page)>, Vec<Problem>> {
    let key = key(table, labels, project, world).map_err(|p| vec![p])?;
    if let Some(kept) = world.store.get(&key).and_then(|b| record::read(&b)) {
        return Ok(kept);
    }
    let made = make()?;
    if let Some(bytes) = record::write(&made) {
        world.store.put(&key, &bytes);
    }
    Ok(made)
}

/// Whether the letters and pages of a table are kept.
pub(super) fn has(
    (table, labels): (&SheetTable, &[Label]),
    project: &Project,
    world: World<'_>,
) -> Result<bool, Problem> {
    Ok(world
        .store
        .get(&key(table, labels, project, world)?)
        .is_some())
}

/// A digest of the pictures and of every setting but those that only later stages look at.
fn key(
    table: &SheetTable,
    labels: &[Label],
    project: &Project,
    world: World<'_>,
) -> Result<String, Problem> {
    let mut earlier = project.clone();
    earlier.sheets = vec![table.clone()];
    earlier.spacing = <_>::default();
    earlier.anchors = <_>::default();
    earlier.kerning = <_>::default();
    earlier.font.features = None;
    earlier.quadratic = <_>::default();
    earlier.gate = <_>::default();
    earlier.matching = <_>::default();
    earlier.output = <_>::default();
    let labels: Vec<&str> = labels.iter().map(|l| l.0.as_str()).collect();
    let mut digest = Sha256::new();
    let mut add = |bytes: &[u8]| {
        digest.update(bytes.len().to_le_bytes());
        digest.update(bytes);
    };
    add(json!([env!("CARGO_PKG_VERSION"), earlier, labels])
        .to_string()
        .as_bytes());
    for image in &table.image {
        add(&world.file(image)?);
    }
    let hex = digest.finalize();
    Ok(hex.iter().map(|b| format!("{b:02x}")).collect())
}
