//! Bytes in and out: files, or `-` for standard input and output.

use super::failure::Failure;
use super::staged::Staged;
use super::{Outcome, say};
use khatt::types::Files;
use std::fs;
use std::io::{self, Read};
use std::path::Path;

/// Whether the user means standard input or output.
pub(crate) fn is_dash(path: &Path) -> bool {
    path.as_os_str() == "-"
}

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
    Err(Failure::new(what).help(format!("end it in .{}", kinds.join(" or ."))))
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

/// Writes a file in one step, or to standard output: a reader sees the old file or the new one.
pub(crate) fn write(path: &Path, content: &[u8]) -> Result<(), Failure> {
    if is_dash(path) {
        return say::print(content);
    }
    let mut staged = Staged::default();
    staged.add(path, &Files::single(content.to_vec()))?;
    staged.commit()
}

/// Everything in a folder and the folders below it.
pub(crate) fn folder(root: &Path) -> Result<Files, Failure> {
    let fail = |e: &io::Error| Failure::at(root.display(), e);
    let mut out = Files::default();
    let mut open = vec![root.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder).map_err(|e| fail(&e))? {
            let path = entry.map_err(|e| fail(&e))?.path();
            if path.is_dir() {
                open.push(path);
            } else {
                let within = path.strip_prefix(root).unwrap_or(&path);
                let name: Vec<_> = within.iter().map(|p| p.to_string_lossy()).collect();
                out.0.insert(name.join("/"), read(&path)?);
            }
        }
    }
    Ok(out)
}
