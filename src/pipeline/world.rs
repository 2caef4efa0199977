//! What a build needs of the world outside: the files that a project names, somebody to tell, a date, and a place
//! where results are kept.

use super::problem::Problem;
use super::watch::Watch;
use blake3::Hasher;
use std::fmt;
use std::io::{self, Read};
use std::path::Path;

/// The files that a project names.
pub trait Inputs: Sync {
    /// A file's content.
    ///
    /// # Errors
    /// Why there is none.
    fn read(&self, path: &Path) -> Result<Vec<u8>, String>;

    /// A digest of the content, under which is kept what came of it.
    ///
    /// # Errors
    /// Why there is none. A file that changes between readings must have none, since nobody can tell of which of its
    /// states something came.
    fn digest(&self, path: &Path) -> Result<String, String> {
        self.read(path).map(|bytes| digest(&bytes))
    }
}

impl<F: Fn(&Path) -> Result<Vec<u8>, String> + Sync> Inputs for F {
    fn read(&self, path: &Path) -> Result<Vec<u8>, String> {
        self(path)
    }
}

/// Where results are kept between runs.
pub trait Store: Sync {
    /// What was put under that key, exactly; anything else, or nothing, where there is no such thing.
    fn get(&self, key: &str) -> Option<Vec<u8>>;

    /// Keeps `content` under a key, or not.
    fn put(&self, key: &str, content: &[u8]);
}

/// Keeps nothing, and watches nothing.
#[derive(Debug, Clone, Copy, Default)]
pub struct Nothing;

impl Watch for Nothing {}

impl Store for Nothing {
    fn get(&self, _: &str) -> Option<Vec<u8>> {
        None
    }

    fn put(&self, _: &str, _: &[u8]) {}
}

/// What a run needs of the world outside.
#[derive(Clone, Copy)]
pub struct World<'a> {
    /// The files that the project names.
    pub inputs: &'a dyn Inputs,
    /// Is told what is done.
    pub watch: &'a dyn Watch,
    /// Seconds since 1970 that the font gives as its date.
    pub created: i64,
    /// Where what pages became is kept between runs.
    pub store: &'a dyn Store,
}

impl<'a> World<'a> {
    /// These files alone: nobody is told, nothing is kept, and the date is the epoch's.
    #[must_use]
    pub const fn of(inputs: &'a dyn Inputs) -> Self {
        Self {
            inputs,
            watch: &Nothing,
            created: 0,
            store: &Nothing,
        }
    }

    /// The content of a file that the project names.
    pub(super) fn file(&self, path: &Path) -> Result<Vec<u8>, Problem> {
        self.inputs.read(path).map_err(|why| Problem::File {
            file: path.display().to_string(),
            why,
        })
    }
}

impl fmt::Debug for World<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("World")
            .field("created", &self.created)
            .finish_non_exhaustive()
    }
}

/// [`digest`] of all that can be read, which need not fit into memory.
///
/// # Errors
/// It cannot be read.
pub fn digest_of(from: impl Read) -> io::Result<String> {
    Ok(Hasher::new().update_reader(from)?.finalize().to_string())
}

/// BLAKE3, hexadecimal.
#[must_use]
pub fn digest(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_string()
}
