//! `khatt watch`: builds whenever something changes, and shows the proof in a browser.

use super::build::Build;
use super::cache::CacheArgs;
use super::failure::Failure;
use super::inputs::Digests;
use super::page_server::{Page, PageServer};
use super::project::Opened;
use super::{Common, Outcome};
use clap::Args;
use notify::{RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Sender, channel};
use std::time::Duration;

/// Builds again whenever a file of the project changes, and shows its proof in a browser
#[derive(Debug, Args)]
pub(crate) struct Watch {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// Port of the proof's address on this machine; 0 takes a free one
    #[arg(long, value_name = "PORT", default_value_t = 8000)]
    port: u16,
    #[command(flatten)]
    cache: CacheArgs,
}

/// Programs save a file in several steps: what follows so soon belongs to the same change.
const SETTLED: Duration = Duration::from_millis(150);

impl Watch {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let server = PageServer::start(self.port)?;
        eprintln!("the proof is at {} (Ctrl-C ends)", server.address());
        let mut last: Option<String> = None;
        loop {
            let read = Arc::new(Digests::default());
            match self.build(&read, last.as_deref(), common) {
                Ok(page) => {
                    last = Some(page.clone());
                    server.show(Page::Proof(page));
                }
                Err(failure) => {
                    eprint!("{failure}");
                    server.show(Page::Failure(failure.to_string()));
                }
            }
            wait(&read)?;
        }
    }

    /// The outputs are made; the proof, which shows what has changed since the build before, and where the project
    /// names none since `last`. What both follow from is noted in `read`.
    fn build(
        &self,
        read: &Arc<Digests>,
        last: Option<&str>,
        common: &Common,
    ) -> Result<String, Failure> {
        // a project file that is missing is waited for
        read.of(&self.project).unwrap_or_default();
        let opened = Opened::noted(&self.project, Arc::clone(read))?;
        let build = Build::of(self.project.clone()).cached(self.cache.clone());
        build.proof(&opened, last, common)
    }
}

/// Until one of these files is not what was read, or was written again.
fn wait(read: &Digests) -> Outcome {
    let files = read.files();
    let names: BTreeSet<_> = files.iter().filter_map(|p| p.file_name()).collect();
    let (changed, changes) = channel();
    loop {
        // each time anew: a folder that was missing may be there by now
        let _watcher = watcher(&files, changed.clone())?;
        let mut again = read.changed();
        if !again {
            let paths = changes
                .recv()
                .map_err(|e| Failure::new(format!("files cannot be watched: {e}")))?;
            let ours = |p: &PathBuf| p.file_name().is_some_and(|n| names.contains(n));
            again = paths.iter().any(ours);
        }
        while changes.recv_timeout(SETTLED).is_ok() {}
        if again {
            return Ok(());
        }
    }
}

/// Sends the paths that change in the folders of these files, as far as there are such folders: a program may replace
/// a file by a new one.
fn watcher(
    files: &[PathBuf],
    changed: Sender<Vec<PathBuf>>,
) -> Result<RecommendedWatcher, Failure> {
    let tell = move |event: notify::Result<notify::Event>| {
        if let Ok(event) = event
            && !event.kind.is_access()
        {
            // nobody listens any more when the program ends
            changed.send(event.paths).unwrap_or_default();
        }
    };
    let fail = |e: notify::Error| {
        Failure::new(format!("files cannot be watched: {e}"))
            .help("run khatt build after each change")
    };
    let mut watcher = notify::recommended_watcher(tell).map_err(fail)?;
    let folder = |file: &PathBuf| {
        let whole = std::path::absolute(file).ok()?;
        let mut above = whole.ancestors().skip(1);
        above.find(|folder| folder.is_dir()).map(Path::to_owned)
    };
    for folder in files.iter().filter_map(folder).collect::<BTreeSet<_>>() {
        watcher
            .watch(&folder, RecursiveMode::NonRecursive)
            .map_err(fail)?;
    }
    Ok(watcher)
}
