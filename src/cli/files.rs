//! Bytes in and out: files, or `-` for standard input and output.

pub(crate) use super::say::is_dash;

use super::failure::Failure;
use super::{Outcome, staged};
use khatt::types::Files;
use std::fs;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// What messages call it.
pub(crate) fn name(path: &Path) -> String {
    if is_dash(path) {
        "standard input".to_owned()
    } else {
        path.display().to_string()
    }
}

/// Whether a file's name ends as its kind should, or has no ending at all.
pub(crate) fn ends_in(path: &Path, kinds: &[&str]) -> Outcome {
    let ending = path.extension().map(|e| e.to_ascii_lowercase());
    if ending.is_none_or(|e| kinds.iter().any(|kind| e == *kind)) {
        return Ok(());
    }
    let what = format!("{} is no name for what is written there", path.display());
    Err(Failure::of_use(what).help(format!("end it in .{}", kinds.join(" or ."))))
}

/// The whole content of a file or of standard input.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>, Failure> {
    if is_dash(path) {
        let mut bytes = Vec::new();
        return match io::stdin().lock().read_to_end(&mut bytes) {
            Ok(_) => Ok(bytes),
            Err(e) => Err(Failure::at(name(path), &e)),
        };
    }
    fs::read(path).map_err(|e| Failure::at(name(path), &e))
}

/// What an earlier run left in a file, where it is text.
pub(crate) fn last(path: &Path) -> Option<String> {
    let file = fs::metadata(path).ok().filter(fs::Metadata::is_file);
    file.and_then(|_| fs::read_to_string(path).ok())
}

/// Writes a file in one step, or to standard output, in a job that reads `inputs`: a reader sees the old file or the
/// new one.
pub(crate) fn write(path: &Path, content: &[u8], inputs: &[PathBuf]) -> Result<(), Failure> {
    let files = Files::single(content.to_vec());
    staged::write(&[(path.to_owned(), files)], inputs)
}

/// Everything in a folder and the folders below it.
pub(crate) fn folder(root: &Path) -> Result<Files, Failure> {
    let names = staged::names(root).map_err(|e| Failure::at(root.display(), &e))?;
    let file = |name: String| {
        let content = read(&root.join(&name))?;
        Ok((name, content))
    };
    names
        .into_iter()
        .map(file)
        .collect::<Result<_, _>>()
        .map(Files)
}
