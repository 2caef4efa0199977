//! `khatt init`: a project to start from.

use super::failure::Failure;
use super::{Outcome, files, say};
use clap::Args;
use std::path::PathBuf;

/// The project that a new folder starts with.
const PROJECT: &str = include_str!("init.toml");

/// Starts a project: a folder with a project file that explains itself
#[derive(Debug, Args)]
pub(crate) struct Init {
    /// Folder to start in; it is made where it does not exist
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

impl Init {
    pub(crate) fn run(&self) -> Outcome {
        let path = self.folder.join("font.toml");
        if path.exists() {
            let what = format!("{} exists already and stays as it is", path.display());
            return Err(Failure::new(what).help("give another folder, or delete the file first"));
        }
        files::write(&path, PROJECT.as_bytes(), &[])?;
        let (project, folder) = (path.display(), self.folder.display());
        let steps = format!(
            "{project} is ready. Print pages to draw on:\n    khatt sheet {project} -o pages.pdf\n\
             Scan or photograph what was drawn as {folder}/page.png (or name the pictures in the file), and run\n    \
             khatt build {project}\n"
        );
        say::print(steps.as_bytes())
    }
}
