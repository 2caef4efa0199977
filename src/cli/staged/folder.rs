//! Folders as outputs: which of them khatt may replace.
//!
//! A folder that is replaced is lost with all that is in it, so khatt lists in it what it made. A UFO has no list,
//! which font editors would not keep: what is noted in its lib stands for it.

use crate::cli::failure::Failure;
use khatt::types::Files;
use khatt::write::handwork;
use std::collections::BTreeSet;
use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// The file that lists what khatt made in its folder.
pub(super) const LIST: &str = ".khatt";

/// What stands above the names.
const HEAD: &str =
    "# Files that khatt made here. It replaces this folder where there are no others.";

/// Kinds of a UFO's own files.
const UFO: [&str; 3] = ["plist", "glif", "fea"];

/// The list of these files, where their folder needs one.
pub(super) fn list(files: &Files) -> Option<String> {
    let names: Vec<&str> = files.0.keys().map(String::as_str).collect();
    (!is_ufo(files)).then(|| format!("{HEAD}\n{}\n", names.join("\n")))
}

/// Fails where a folder that `files` would replace holds something that khatt did not make.
pub(super) fn refuse_foreign(target: &Path, files: &Files) -> Result<(), Failure> {
    let name = target.display();
    if target.is_file() {
        return Err(Failure::new(format!("{name} is a file")).help("give the name of a folder"));
    }
    let there = match names(target) {
        Err(e) if e.kind() == ErrorKind::NotFound => BTreeSet::new(),
        there => there.map_err(|e| Failure::at(&name, &e))?,
    };
    let ours = ours(target, files, &there);
    let Some(foreign) = there.difference(&ours).next() else {
        return Ok(());
    };
    let help = remedy(foreign, files);
    let foreign = target.join(foreign);
    let what = format!(
        "{name} would be replaced, but holds {}, which khatt did not make",
        foreign.display()
    );
    Err(Failure::new(what).help(help))
}

/// What to do about a file that would be lost.
fn remedy(foreign: &str, files: &Files) -> &'static str {
    let kept = ["data/", "images/"].iter().any(|f| foreign.starts_with(f));
    if kept && is_ufo(files) {
        "move it out of the UFO, or give another folder; khatt build without --overwrite keeps data and images"
    } else {
        "give another folder, or delete this one where nothing in it is needed, as where an older khatt made it"
    }
}

/// Which of the files that are there khatt made.
fn ours(target: &Path, files: &Files, there: &BTreeSet<String>) -> BTreeSet<String> {
    let written = |name: &String| files.0.contains_key(name);
    if is_ufo(files) {
        let built = fs::read(target.join("lib.plist")).is_ok_and(|lib| handwork::is_built(&lib));
        let own = |name: &&String| {
            let kind = Path::new(name).extension().and_then(|e| e.to_str());
            built && (kind.is_some_and(|k| UFO.contains(&k)) || written(name))
        };
        return there.iter().filter(own).cloned().collect();
    }
    match fs::read_to_string(target.join(LIST)) {
        Ok(list) => list.lines().map(str::to_owned).collect(),
        // made by a khatt that wrote no lists, where it has just the names that it would have now
        Err(_) if there.iter().eq(files.0.keys()) => there.clone(),
        Err(_) => BTreeSet::new(),
    }
}

/// Files in the folder `target` that are no part of it.
pub(crate) fn strays(target: &Path, part: impl Fn(&str) -> bool) -> Vec<PathBuf> {
    let there = names(target).unwrap_or_default();
    let strays = there.iter().filter(|name| !part(name));
    strays.map(|name| target.join(name)).collect()
}

/// The names of what is in a folder and the folders below it, with `/`; not that of the list of what khatt made.
pub(crate) fn names(root: &Path) -> io::Result<BTreeSet<String>> {
    let mut out = BTreeSet::new();
    let mut open = vec![root.to_owned()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            if path.is_dir() {
                open.push(path);
            } else {
                let within = path.strip_prefix(root).unwrap_or(&path);
                let name: Vec<_> = within.iter().map(|p| p.to_string_lossy()).collect();
                out.insert(name.join("/"));
            }
        }
    }
    out.remove(LIST);
    Ok(out)
}

fn is_ufo(files: &Files) -> bool {
    files.0.contains_key("metainfo.plist")
}
