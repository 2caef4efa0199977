//! Outputs that appear all at once or not at all.
//!
//! Everything is first written under temporary names beside its place. Only when all of it lies on the
//! disk do new and old change places, each pair in one step; when one of these steps fails, the earlier
//! ones are taken back. What is left under a temporary name is deleted at the end.

use super::failure::{Complaint, Failure};
use khatt::types::Files;
use std::collections::BTreeSet;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use tempfile::{Builder, TempDir, TempPath};

/// How temporary names begin; the number of the process follows.
const PREFIX: &str = ".khatt-";

/// Outputs on the disk under temporary names.
#[derive(Debug, Default)]
pub(crate) struct Staged {
    items: Vec<Item>,
}

#[derive(Debug)]
struct Item {
    target: PathBuf,
    temporary: Temporary,
}

/// Deletes what it names when it is dropped.
#[derive(Debug)]
enum Temporary {
    File(TempPath),
    Folder(TempDir),
}

/// How an output took its place.
#[derive(Debug)]
enum Placed {
    /// Nothing was there before.
    New(PathBuf),
    /// What was there before has the temporary name now.
    Exchanged(Item),
}

impl Staged {
    /// Writes an output beside `target`: one file, or a folder of files.
    pub(crate) fn add(&mut self, target: &Path, files: &Files) -> Result<(), Failure> {
        let fail = |e: io::Error| Failure::at(target.display(), &e);
        let temporary = match files.0.get("") {
            Some(content) => file(target, content),
            None => folder(target, files),
        };
        self.items.push(Item {
            target: target.to_owned(),
            temporary: temporary.map_err(fail)?,
        });
        Ok(())
    }

    /// Gives everything its name.
    pub(crate) fn commit(self) -> Result<(), Failure> {
        let mut done = Vec::new();
        for item in self.items {
            let target = item.target.clone();
            match item.place() {
                Ok(placed) => done.push(placed),
                Err(e) => {
                    done.into_iter().rev().for_each(Placed::undo);
                    return Err(Failure::at(target.display(), &e));
                }
            }
        }
        Ok(())
    }
}

impl Temporary {
    fn path(&self) -> &Path {
        match self {
            Self::File(path) => path,
            Self::Folder(folder) => folder.path(),
        }
    }
}

impl Item {
    fn place(self) -> io::Result<Placed> {
        if self.target.exists() {
            exchange(self.temporary.path(), &self.target)?;
            return Ok(Placed::Exchanged(self));
        }
        match self.temporary {
            Temporary::File(path) => path.persist(&self.target).map_err(|e| e.error)?,
            Temporary::Folder(folder) => fs::rename(folder.keep(), &self.target)?,
        }
        Ok(Placed::New(self.target))
    }
}

impl Placed {
    /// Puts back what was there; an output that cannot be taken back stays, whole.
    fn undo(self) {
        let undone = match self {
            Self::Exchanged(item) => exchange(item.temporary.path(), &item.target),
            Self::New(target) if target.is_dir() => fs::remove_dir_all(target),
            Self::New(target) => fs::remove_file(target),
        };
        undone.unwrap_or_default();
    }
}

/// Both names change places in one step where the system can do that.
fn exchange(a: &Path, b: &Path) -> io::Result<()> {
    #[cfg(target_os = "linux")]
    {
        use rustix::fs::{CWD, RenameFlags, renameat_with};
        use rustix::io::Errno;
        match renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE) {
            Err(Errno::INVAL | Errno::NOSYS) => {}
            done => return Ok(done?),
        }
    }
    let aside = Builder::new().prefix(&own_prefix()).tempdir_in(parent(b))?;
    let old = aside.path().join("old");
    fs::rename(b, &old)?;
    fs::rename(a, b).inspect_err(|_| fs::rename(&old, b).unwrap_or_default())?;
    fs::rename(&old, a)
}

fn file(target: &Path, content: &[u8]) -> io::Result<Temporary> {
    if target.is_dir() {
        return Err(io::Error::other("is a folder; give the name of a file"));
    }
    let mut file = builder(&own_prefix(), target, 0o666)?.tempfile_in(parent(target))?;
    file.write_all(content)?;
    Ok(Temporary::File(file.into_temp_path()))
}

fn folder(target: &Path, files: &Files) -> io::Result<Temporary> {
    refuse_foreign(target, files)?;
    let folder = builder(&own_prefix(), target, 0o777)?.tempdir_in(parent(target))?;
    for (name, content) in &files.0 {
        let path = folder.path().join(name);
        fs::create_dir_all(parent(&path))?;
        File::create(path)?.write_all(content)?;
    }
    Ok(Temporary::Folder(folder))
}

/// Temporary names beside `target`, whose folder is made. `mode` is cut by the user's mask, as for
/// anything that a program makes.
fn builder<'a>(prefix: &'a str, target: &Path, mode: u32) -> io::Result<Builder<'a, 'static>> {
    fs::create_dir_all(parent(target))?;
    sweep(parent(target))?;
    let mut builder = Builder::new();
    builder.prefix(prefix);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(mode));
    }
    #[cfg(not(unix))]
    let _ = mode;
    Ok(builder)
}

/// How this process' temporary names begin.
fn own_prefix() -> String {
    format!("{PREFIX}{}-", process::id())
}

/// Deletes what a process left that was killed while it wrote. Only Linux tells which processes live.
fn sweep(folder: &Path) -> io::Result<()> {
    if !Path::new("/proc/self").exists() {
        return Ok(());
    }
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let owner = name
            .to_str()
            .and_then(|n| n.strip_prefix(PREFIX)?.split('-').next());
        let owner = owner.filter(|o| !o.is_empty() && o.bytes().all(|b| b.is_ascii_digit()));
        if owner.is_some_and(|pid| !Path::new("/proc").join(pid).exists()) {
            let path = entry.path();
            // somebody else may have deleted it in the meantime
            let gone = if path.is_dir() {
                fs::remove_dir_all(path)
            } else {
                fs::remove_file(path)
            };
            gone.unwrap_or_default();
        }
    }
    Ok(())
}

/// A folder is replaced only when nothing in it is of another kind than what replaces it.
fn refuse_foreign(target: &Path, files: &Files) -> io::Result<()> {
    let ours: BTreeSet<&OsStr> = files
        .0
        .keys()
        .filter_map(|name| Path::new(name).extension())
        .collect();
    let mut folders = vec![target.to_owned()];
    while let Some(folder) = folders.pop() {
        if !folder.exists() {
            continue;
        }
        for entry in fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if !path.extension().is_some_and(|e| ours.contains(e)) {
                let why = format!(
                    "would be replaced, but holds {}, which khatt did not make; give another folder",
                    path.display()
                );
                return Err(io::Error::other(why));
            }
        }
    }
    Ok(())
}

/// Fails where what lies on the disk is not what would be written.
pub(crate) fn same(outputs: &[(PathBuf, Files)]) -> Result<(), Failure> {
    let mut changed = Vec::new();
    for (target, files) in outputs {
        for (name, content) in &files.0 {
            let path = if name.is_empty() {
                target.clone()
            } else {
                target.join(name)
            };
            if fs::read(&path).ok().as_ref() != Some(content) {
                changed.push(path);
            }
        }
    }
    let complaint = |path: &PathBuf| {
        let what = format!("{} is not what this project builds", path.display());
        Complaint::new(
            what,
            Some("build without --locked and keep the result".to_owned()),
        )
    };
    if changed.is_empty() {
        Ok(())
    } else {
        Err(changed.iter().map(complaint).collect())
    }
}

pub(crate) fn parent(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}
