//! What is kept between runs, in a folder that may be deleted at any time.
//!
//! Every entry is a file of its own, named by the digest of what it follows from, written beside its place and then
//! renamed: builds at the same time do not see halves. A wrong entry counts as none. Nothing here fails a build.

use clap::Args;
use khatt::pipeline::{Store, digest};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::SystemTime;
use std::{env, fs};
use tempfile::NamedTempFile;

/// Bytes from which the oldest entries are deleted, until half is left.
const FULL: u64 = 4 << 30;

/// Bytes of the checksum at the head of an entry.
const CHECK: usize = 4;

#[derive(Debug, Clone, Default, Args)]
pub(crate) struct CacheArgs {
    /// Keep what pages became in this folder [default: khatt in the user's cache folder]
    #[arg(long, value_name = "DIR", conflicts_with = "no_cache")]
    cache_dir: Option<PathBuf>,
    /// Do everything again, and keep nothing
    #[arg(long)]
    no_cache: bool,
}

impl CacheArgs {
    pub(crate) fn open(&self) -> Cache {
        let chosen = self.cache_dir.clone().or_else(default_folder);
        let folder = chosen.filter(|_| !self.no_cache);
        Cache {
            folder: folder.zip(program()).map(|(folder, id)| folder.join(id)),
        }
    }
}

/// A folder of entries made by this program, or none.
#[derive(Debug)]
pub(crate) struct Cache {
    folder: Option<PathBuf>,
}

impl Cache {
    /// Deletes the oldest entries of all programs where there are too many.
    pub(crate) fn trim(&self) {
        self.trim_to(FULL);
    }

    /// The same where they have more than so many bytes, until half of that is left. What else lies in the folder
    /// that the user named is not touched.
    fn trim_to(&self, full: u64) {
        let Some(all) = self.folder.as_deref().and_then(Path::parent) else {
            return;
        };
        let folders = entries(all).filter(|e| is_digest(e) && e.is_dir());
        let mut files: Vec<(SystemTime, u64, PathBuf)> = folders
            .flat_map(|folder| entries(&folder))
            .filter(|path| is_digest(path))
            .filter_map(|path| {
                let data = fs::metadata(&path).ok()?;
                Some((data.modified().ok()?, data.len(), path))
            })
            .collect();
        let mut size: u64 = files.iter().map(|(_, len, _)| len).sum();
        if size <= full {
            return;
        }
        files.sort();
        for (_, len, path) in files {
            if size <= full / 2 {
                break;
            }
            // another build may have deleted it
            fs::remove_file(path).unwrap_or_default();
            size -= len;
        }
    }
}

impl Store for Cache {
    fn get(&self, key: &str) -> Option<Vec<u8>> {
        let mut bytes = fs::read(self.folder.as_ref()?.join(key)).ok()?;
        let check = bytes.get(..CHECK)?.to_owned();
        bytes.drain(..CHECK);
        (crc32fast::hash(&bytes).to_le_bytes().as_slice() == check).then_some(bytes)
    }

    fn put(&self, key: &str, content: &[u8]) {
        let Some(folder) = &self.folder else { return };
        let write = || -> std::io::Result<()> {
            fs::create_dir_all(folder)?;
            let mut file = NamedTempFile::new_in(folder)?;
            file.write_all(&crc32fast::hash(content).to_le_bytes())?;
            file.write_all(content)?;
            file.persist(folder.join(key))?;
            Ok(())
        };
        // a full disk or a read-only folder costs time in the next run, nothing else
        write().unwrap_or_default();
    }
}

fn entries(folder: &Path) -> impl Iterator<Item = PathBuf> + use<> {
    let entries = fs::read_dir(folder).into_iter().flatten();
    entries.filter_map(|e| Some(e.ok()?.path()))
}

/// Whether a file's or folder's name is a digest, as those of entries and of programs are.
fn is_digest(path: &Path) -> bool {
    let name = path.file_name().and_then(|n| n.to_str());
    let is_hex = |n: &str| n.bytes().all(|b| b.is_ascii_hexdigit());
    name.is_some_and(|n| n.len() == digest(b"").len() && is_hex(n))
}

/// The user's folder for what can be made again.
#[expect(
    clippy::disallowed_methods,
    reason = "the program alone reads the environment"
)]
fn default_folder() -> Option<PathBuf> {
    let named = |name: &str| env::var_os(name).map(PathBuf::from);
    let caches = named("XDG_CACHE_HOME").or_else(|| Some(named("HOME")?.join(".cache")));
    let caches = caches.or_else(|| named("LOCALAPPDATA"));
    caches.filter(|c| c.is_absolute()).map(|c| c.join("khatt"))
}

/// What tells this program from one that was built otherwise: two builds of one version differ in it.
fn program() -> Option<String> {
    let file = fs::metadata(env::current_exe().ok()?).ok()?;
    let built = file.modified().ok()?.duration_since(SystemTime::UNIX_EPOCH);
    let built = built.ok()?.as_nanos();
    let version = env!("CARGO_PKG_VERSION");
    Some(digest(
        format!("{version} {} {built}", file.len()).as_bytes(),
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_entries_go_and_nothing_else() {
        let folder = tempfile::tempdir().expect("a folder");
        let foreign = ["notes/thesis.txt", "notes/0123456789", "letter.txt"];
        for name in foreign {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().expect("a folder")).expect("made");
            let file = fs::File::create(path).and_then(|mut f| f.write_all(&[0; 100]));
            file.expect("written");
        }
        let cache = Cache {
            folder: Some(folder.path().join(digest(b"program"))),
        };
        let keys: Vec<String> = (0..4_u8).map(|i| digest(&[i])).collect();
        let kept = || keys.iter().filter(|k| cache.get(k).is_some()).count();
        for key in &keys {
            cache.put(key, &[7; 96]);
        }
        cache.trim_to(400);
        assert_eq!(kept(), 4, "as many as may be");
        cache.trim_to(399);
        assert_eq!(kept(), 1, "until less than half is left");
        for name in foreign {
            assert!(folder.path().join(name).exists(), "{name}");
        }
    }
}
