//! Where outputs go: no two to one place, and none to where something lies that the job reads.

use crate::cli::failure::Failure;
use std::path::{Component, Path, PathBuf};

/// Fails where an output would take the place of an input or of another output, or of a folder that holds one.
pub(crate) fn apart<'a>(
    outputs: impl IntoIterator<Item = &'a PathBuf>,
    inputs: &[PathBuf],
) -> Result<(), Failure> {
    let inputs: Vec<_> = inputs.iter().map(|input| (input, place(input))).collect();
    let mut taken: Vec<(&PathBuf, PathBuf)> = Vec::new();
    for output in outputs {
        let at = place(output);
        let name = output.display();
        if let Some((input, _)) = inputs.iter().find(|(_, input)| input.starts_with(&at)) {
            let what = format!("{name} would be replaced, but {} is read", input.display());
            return Err(Failure::new(what).help("give the output another name"));
        }
        let meets = |other: &Path| other.starts_with(&at) || at.starts_with(other);
        if let Some((other, _)) = taken.iter().find(|(_, other)| meets(other)) {
            let what = format!("two outputs have one place: {}, {name}", other.display());
            return Err(Failure::new(what).help("give each a name of its own"));
        }
        taken.push((output, at));
    }
    Ok(())
}

/// Where a path leads, the same however it is written, also where nothing lies there yet.
pub(crate) fn place(path: &Path) -> PathBuf {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut at = PathBuf::new();
    for part in whole.components() {
        if part == Component::ParentDir {
            at.pop();
        } else {
            at.push(part);
        }
        // a link is followed before what comes after it
        if let Ok(real) = at.canonicalize() {
            at = real;
        }
    }
    at
}
