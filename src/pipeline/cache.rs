//! What became of a picture's pages, kept under a digest of all that it follows from.
//!
//! Load, clean, cut and trace are nearly all of a build's work, and what they make of a page follows
//! from its bytes, its labels, the options of these stages and the program's sources. So a page that has not
//! changed is not read again, and a change of what comes later, spacing or outputs, redoes no page.

use super::batch::Batch;
use super::labels;
use super::page::Traced;
use super::project::Project;
use super::record;
use super::source::Source;
use super::world::{World, digest};
use serde_json::json;
use std::path::Path;

/// What became of a picture file's pages, where that is kept.
pub(super) fn recall(
    source: &Source<'_>,
    image: &Path,
    project: &Project,
    world: World<'_>,
) -> Option<Batch<Traced>> {
    let key = key(source, image, project, world).ok()?;
    let mut batch = world.store.get(&key).and_then(|b| record::read(&b))?;
    // the table may have stood in another place
    let pages = batch.made.iter_mut();
    for (_, (letters, page)) in pages {
        page.table = source.number;
        letters.iter_mut().for_each(|l| l.table = source.number);
    }
    Some(batch)
}

/// Keeps what became of a picture file's pages, unless something is wrong with them.
pub(super) fn keep(
    batch: &Batch<Traced>,
    (source, image): (&Source<'_>, &Path),
    project: &Project,
    world: World<'_>,
) {
    // a picture that has changed since it was looked for has no key
    let key = key(source, image, project, world).ok();
    let content = batch.problems.is_empty().then(|| record::write(batch));
    if let Some((key, content)) = key.zip(content.flatten()) {
        world.store.put(&key, &content);
    }
}

/// A digest of a picture file and of every setting but those that only later stages look at.
fn key(
    source: &Source<'_>,
    image: &Path,
    project: &Project,
    world: World<'_>,
) -> Result<String, String> {
    let mut earlier = project.clone();
    let mut table = source.table.clone();
    table.image = vec![image.to_owned()];
    earlier.sheets = vec![table];
    earlier.repeated = <_>::default();
    earlier.cells = source.corrected(project);
    earlier.compose = <_>::default();
    earlier.spacing = <_>::default();
    earlier.anchors = <_>::default();
    earlier.kerning = <_>::default();
    earlier.font = project.font.of_pages();
    earlier.quadratic = <_>::default();
    earlier.gate = <_>::default();
    earlier.matching = <_>::default();
    earlier.output = <_>::default();
    let labels: Vec<&str> = source.labels.iter().map(|l| l.0.as_str()).collect();
    let lines = labels::lines(source.table, world).map_err(|p| p.to_string())?;
    let picture = world.inputs.digest(image)?;
    let all = json!([env!("KHATT_SOURCES"), earlier, labels, lines, picture]);
    Ok(digest(all.to_string().as_bytes()))
}
