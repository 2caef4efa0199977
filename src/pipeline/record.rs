//! Pages and their letters as bytes and back, to the last bit.

use super::batch::Batch;
use super::letter::Letter;
use super::page::{Page, Traced};
use crate::scan::Cut;
use crate::template::Gain;

/// What is read of a page: its number in its table, from 1, its name, and what follows.
type Record = (usize, String, Vec<Letter>, Cut, Option<Gain>, Option<f64>);

/// Pages and their letters as bytes; nothing where they cannot be written.
pub(super) fn write(batch: &Batch<Traced>) -> Option<Vec<u8>> {
    let records = batch.made.iter().map(|(number, (letters, page))| {
        let Page {
            name,
            table: _,
            cut,
            gain,
            px_per_mm,
        } = page;
        (number, name, letters, cut, gain, px_per_mm)
    });
    postcard::to_allocvec(&records.collect::<Vec<_>>()).ok()
}

/// Pages and their letters from bytes; nothing where these are no such thing.
pub(super) fn read(bytes: &[u8]) -> Option<Batch<Traced>> {
    let records: Vec<Record> = postcard::from_bytes(bytes).ok()?;
    let page = |(number, name, letters, cut, gain, px_per_mm): Record| {
        let page = Page {
            name,
            table: 0,
            cut,
            gain,
            px_per_mm,
        };
        (number, (letters, page))
    };
    let made: Vec<(usize, Traced)> = records.into_iter().map(page).collect();
    let seen = made.iter().map(|(n, (_, page))| (*n, page.name.clone()));
    Some(Batch {
        seen: seen.collect(),
        made,
        problems: Vec::new(),
    })
}
