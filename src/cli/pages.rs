//! `khatt page`, `khatt merge`: the pages of a project on many machines, and their results in one font.
//!
//! A result is a file: what the pages of one `[[sheet]]` became, under the digest of all that it follows from. A
//! merge is a build that finds every page done.

use super::build::Build;
use super::failure::{Complaint, Failure};
use super::project::Opened;
use super::staged::Staged;
use super::{Common, Outcome, files};
use clap::Args;
use khatt::pipeline::{self, Store};
use khatt::types::Files;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Does the work of one page, for khatt merge to join with that of the others
#[derive(Debug, Args)]
pub(crate) struct Page {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// Which [[sheet]] of the project, from 1
    #[arg(long, value_name = "N")]
    sheet: usize,
    /// Where the result goes
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

/// Bytes of the key and of the checksum at the head of a result.
const HEAD: (usize, usize) = (64, 4);

impl Page {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let opened = Opened::new(&self.project)?;
        let results = Results::default();
        opened.work_with(&results, common, |project, world| {
            pipeline::sheet_letters(project, self.sheet, world)
        })?;
        let kept = results.kept.into_inner();
        let mut staged = Staged::default();
        for (key, content) in kept.unwrap_or_else(PoisonError::into_inner) {
            let check = crc32fast::hash(&content).to_le_bytes();
            let bytes = [key.as_bytes(), &check, &content].concat();
            staged.add(&self.output, &Files::single(bytes))?;
        }
        staged.commit()
    }
}

impl Merge {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let results = Results::default();
        for path in &self.results {
            let (key, content) = read(path)?;
            results.put(&key, &content);
        }
        let opened = Opened::new(&self.project)?;
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
            format!("{project}: none of the results is that of sheet {number} as it is now"),
            Some(format!(
                "khatt page {project} --sheet {number} -o FILE makes it"
            )),
        )
    }
}

/// A result's key and content.
fn read(path: &Path) -> Result<(String, Vec<u8>), Failure> {
    let bytes = files::read(path)?;
    let wrong = || {
        Failure::new(format!("{}: is no result of khatt page", path.display()))
            .help("make it again with khatt page")
    };
    let (key, rest) = bytes.split_at_checked(HEAD.0).ok_or_else(wrong)?;
    let (check, content) = rest.split_at_checked(HEAD.1).ok_or_else(wrong)?;
    let key = std::str::from_utf8(key).map_err(|_| wrong())?;
    if crc32fast::hash(content).to_le_bytes().as_slice() != check {
        return Err(wrong());
    }
    Ok((key.to_owned(), content.to_owned()))
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
