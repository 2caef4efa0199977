//! `khatt page`, `khatt merge`: the pages of a project on many machines, and their results in one font.
//!
//! A result is a file: what the pages of one `[[sheet]]` became, under the digest of all that it follows from. A
//! merge is a build that finds every page done.

use super::build::Build;
use super::failure::{Complaint, Failure};
use super::project::Opened;
use super::{Common, Outcome, files, staged};
use clap::Args;
use khatt::pipeline::{self, Store};
use std::collections::BTreeMap;
use std::num::ParseIntError;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Does the work of one page, for khatt merge to join with that of the others
#[derive(Debug, Args)]
pub(crate) struct Page {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// Which [[sheet]] of the project, from 1
    #[arg(long, value_name = "N", value_parser = number)]
    sheet: usize,
    /// Where the result goes, or - for standard output
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Builds what the project's [output] names from the results of khatt page, as khatt build does from the pages
#[derive(Debug, Args)]
pub(crate) struct Merge {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// The results of all its sheets
    #[arg(value_name = "FILE", required = true)]
    results: Vec<PathBuf>,
}

/// Counts from 1.
fn number(text: &str) -> Result<usize, String> {
    let number = text.parse().map_err(|e: ParseIntError| e.to_string())?;
    if number == 0 {
        return Err("sheets count from 1".to_owned());
    }
    Ok(number)
}

/// A key and what is kept under it.
type Entry = (String, Vec<u8>);

/// Bytes of a key.
const KEY: usize = 64;

impl Page {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let opened = Opened::new(&self.project)?;
        opened.spare(&self.output, None)?;
        let results = Results::default();
        opened.work_with(&results, common, |project, world| {
            pipeline::sheet_letters(project, self.sheet, world)
        })?;
        let kept = results.kept.into_inner();
        let mut bytes = Vec::new();
        for (key, content) in kept.unwrap_or_else(PoisonError::into_inner) {
            bytes.extend(key.as_bytes());
            bytes.extend((content.len() as u64).to_le_bytes());
            bytes.extend(crc32fast::hash(&content).to_le_bytes());
            bytes.extend(content);
        }
        files::write(&self.output, &bytes, &opened.named())
    }
}

impl Merge {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let results = Results::default();
        for path in &self.results {
            for (key, content) in read(path)? {
                results.put(&key, &content);
            }
        }
        let opened = Opened::new(&self.project)?;
        staged::apart(&opened.outputs(), &self.results)?;
        let missing = opened.work_with(&results, common, |project, world| {
            pipeline::sheets_without_result(project, world)
        })?;
        if !missing.0.is_empty() {
            return Err(missing.0.iter().map(|&n| self.complaint(n)).collect());
        }
        Build::of(self.project.clone()).run_with(&results, &opened, common)
    }

    fn complaint(&self, number: usize) -> Complaint {
        let project = self.project.display();
        Complaint::new(
            format!(
                "{project}: none of the results is that of sheet {number} as it is now, made by a khatt of the same \
                 sources"
            ),
            Some(format!(
                "khatt page {project} --sheet {number} -o FILE makes it"
            )),
        )
    }
}

/// The keys and contents of a result: one for each picture file of the sheet.
fn read(path: &Path) -> Result<Vec<Entry>, Failure> {
    let bytes = files::read(path)?;
    let (mut rest, mut entries) = (bytes.as_slice(), Vec::new());
    while !rest.is_empty() {
        let (entry, after) = entry(rest).ok_or_else(|| {
            Failure::new(format!(
                "{}: not what khatt page writes, or cut short",
                path.display()
            ))
            .help("make it again with khatt page")
        })?;
        entries.push(entry);
        rest = after;
    }
    Ok(entries)
}

/// The first key and content, and what follows; nothing where these bytes are no entry.
fn entry(bytes: &[u8]) -> Option<(Entry, &[u8])> {
    let (key, rest) = bytes.split_at_checked(KEY)?;
    let (length, rest) = rest.split_first_chunk()?;
    let (check, rest) = rest.split_first_chunk()?;
    let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
    let (content, after) = rest.split_at_checked(length)?;
    let whole = crc32fast::hash(content) == u32::from_le_bytes(*check);
    let key = std::str::from_utf8(key).ok().filter(|_| whole)?;
    Some(((key.to_owned(), content.to_owned()), after))
}

/// Results in memory.
#[derive(Debug, Default)]
struct Results {
    kept: Mutex<BTreeMap<String, Vec<u8>>>,
}

impl Store for Results {
    fn get(&self, key: &str) -> Option<Vec<u8>> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.get(key).cloned()
    }

    fn put(&self, key: &str, content: &[u8]) {
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        kept.insert(key.to_owned(), content.to_owned());
    }
}
