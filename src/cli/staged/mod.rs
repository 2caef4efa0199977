//! Outputs that appear all at once or not at all.
//!
//! Everything is first written under temporary names beside its place. Only when all of it is written do
//! new and old change places, each pair in one step; when one of these steps fails, the earlier ones are
//! taken back. What is left under a temporary name is deleted at the end. When the system brings what was
//! written to the disk is left to it: a loss of power may undo a build, or part of it.

mod folder;
mod places;

pub(crate) use folder::{names, strays};
pub(crate) use places::{apart, place};

use super::failure::{Complaint, Failure};
use super::say::{self, is_dash};
use folder::LIST;
use khatt::types::Files;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;
use std::time::Duration;
use tempfile::{Builder, TempDir, TempPath};

/// How temporary names begin; the number of the process follows.
const PREFIX: &str = ".khatt-";

/// How much older than what is written now a temporary file must be to be one that nobody writes any more. The file
/// system dates both, so that the machines that share a folder may be of different opinions.
const ABANDONED: Duration = Duration::from_hours(24);

/// An output under a temporary name.
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

/// Writes outputs, each a file, `-` for standard output, or a folder of files, of a job that reads `inputs`.
pub(crate) fn write<'a>(
    outputs: impl IntoIterator<Item = &'a (PathBuf, Files)>,
    inputs: &[PathBuf],
) -> Result<(), Failure> {
    let outputs: Vec<_> = outputs.into_iter().collect();
    apart(outputs.iter().map(|(target, _)| target), inputs)?;
    for (target, files) in &outputs {
        match files.0.get("") {
            Some(_) => refuse_folder(target)?,
            None => folder::refuse_foreign(target, files)?,
        }
    }
    let (streams, outputs): (Vec<_>, Vec<_>) = outputs
        .into_iter()
        .partition(|(target, _)| is_dash(target) || is_stream(target));
    let items = outputs
        .iter()
        .map(|(target, files)| Item::new(target, files));
    let items = items.collect::<Result<Vec<_>, _>>()?;
    let mut done = Vec::new();
    let places = items.into_iter().try_for_each(|item| {
        let target = item.target.clone();
        let placed = item.place();
        done.push(placed.map_err(|e| Failure::at(target.display(), &e))?);
        Ok(())
    });
    let written = places.and_then(|()| {
        let mut streams = streams.iter();
        streams.try_for_each(|(target, files)| {
            if is_dash(target) {
                return files.0.values().try_for_each(|content| say::print(content));
            }
            pour(target, files).map_err(|e| Failure::at(target.display(), &e))
        })
    });
    if written.is_err() {
        done.into_iter().rev().for_each(Placed::undo);
    }
    written
}

/// Whether a device or a pipe is there, which takes what is written and is not replaced.
fn is_stream(target: &Path) -> bool {
    fs::metadata(target).is_ok_and(|there| !there.is_file() && !there.is_dir())
}

fn pour(target: &Path, files: &Files) -> io::Result<()> {
    let mut stream = OpenOptions::new().write(true).open(target)?;
    files
        .0
        .values()
        .try_for_each(|content| stream.write_all(content))
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
    fn new(name: &Path, files: &Files) -> Result<Self, Failure> {
        // a link stays one: what it leads to is replaced
        let target = place(name);
        let temporary = match files.0.get("") {
            Some(content) => file(&target, content),
            None => folder(&target, files),
        };
        let temporary = temporary.map_err(|e| Failure::at(name.display(), &e))?;
        Ok(Self { target, temporary })
    }

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
    exchange_in_steps(a, b)
}

/// The same in three steps, none of which is done where one fails.
fn exchange_in_steps(a: &Path, b: &Path) -> io::Result<()> {
    let aside = Builder::new().prefix(&own_prefix()).tempdir_in(parent(b))?;
    let old = aside.path().join("old");
    fs::rename(b, &old)?;
    let last = || fs::rename(&old, a).inspect_err(|_| fs::rename(b, a).unwrap_or_default());
    let done = fs::rename(a, b).and_then(|()| last());
    if done.is_err() && fs::rename(&old, b).is_err() {
        // it is the user's, and is not deleted
        drop(aside.keep());
    }
    done
}

fn refuse_folder(target: &Path) -> Result<(), Failure> {
    if target.is_dir() {
        let what = format!("{} is a folder", target.display());
        return Err(Failure::new(what).help("give the name of a file"));
    }
    Ok(())
}

fn file(target: &Path, content: &[u8]) -> io::Result<Temporary> {
    let mut file = builder(&own_prefix(), target, 0o666)?.tempfile_in(parent(target))?;
    file.write_all(content)?;
    sweep(parent(target), file.path())?;
    Ok(Temporary::File(file.into_temp_path()))
}

fn folder(target: &Path, files: &Files) -> io::Result<Temporary> {
    let folder = builder(&own_prefix(), target, 0o777)?.tempdir_in(parent(target))?;
    for (name, content) in &files.0 {
        let path = folder.path().join(name);
        fs::create_dir_all(parent(&path))?;
        File::create(path)?.write_all(content)?;
    }
    if let Some(list) = folder::list(files) {
        File::create(folder.path().join(LIST))?.write_all(list.as_bytes())?;
    }
    sweep(parent(target), folder.path())?;
    Ok(Temporary::Folder(folder))
}

/// Temporary names beside `target`, whose folder is made. `mode` is cut by the user's mask, as for
/// anything that a program makes.
fn builder<'a>(prefix: &'a str, target: &Path, mode: u32) -> io::Result<Builder<'a, 'static>> {
    fs::create_dir_all(parent(target))?;
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

/// Deletes what a process left that was killed while it wrote, long before `temporary` was written.
fn sweep(folder: &Path, temporary: &Path) -> io::Result<()> {
    let now = fs::metadata(temporary)?.modified()?;
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = entry.file_name();
        let owner = name
            .to_str()
            .and_then(|n| n.strip_prefix(PREFIX)?.split_once('-'));
        let ours =
            owner.is_some_and(|(n, _)| !n.is_empty() && n.bytes().all(|b| b.is_ascii_digit()));
        let written = || entry.metadata().and_then(|m| m.modified());
        if ours
            && written().is_ok_and(|then| now.duration_since(then).is_ok_and(|age| age > ABANDONED))
        {
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
        changed.extend(strays(target, |name| files.0.contains_key(name)));
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

#[cfg(test)]
#[expect(
    clippy::disallowed_methods,
    reason = "the tests play the user, who writes files"
)]
mod tests {
    use super::*;

    #[test]
    fn an_output_is_where_it_was_when_the_last_step_fails() {
        let dir = tempfile::tempdir().unwrap();
        let old = dir.path().join("old");
        fs::write(&old, "of the user").unwrap();
        // a folder's name, which no file can take
        let new = dir.path().join("new/");
        fs::create_dir(&new).unwrap();
        assert!(exchange_in_steps(&new, &old).is_err());
        assert_eq!(fs::read_to_string(&old).unwrap(), "of the user");
        assert!(new.is_dir());
        assert_eq!(fs::read_dir(dir.path()).unwrap().count(), 2);
        fs::remove_dir(&new).unwrap();
        fs::write(dir.path().join("new"), "ours").unwrap();
        exchange_in_steps(&dir.path().join("new"), &old).unwrap();
        assert_eq!(fs::read_to_string(&old).unwrap(), "ours");
    }
}
