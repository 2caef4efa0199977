//! `khatt watch`: builds whenever something changes, and shows the proof in a browser.

use super::build::Build;
use super::cache::CacheArgs;
use super::failure::Failure;
use super::page_server::{Page, PageServer};
use super::project::Opened;
use super::{Common, Outcome};
use clap::Args;
use khatt::pipeline;
use notify::{RecommendedWatcher, RecursiveMode, Watcher};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
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
        let (changed, changes) = channel();
        let mut inputs: BTreeSet<PathBuf> = BTreeSet::from([self.project.clone()]);
        let mut last: Option<String> = None;
        loop {
            match self.build(last.as_deref(), common) {
                Ok((page, read)) => {
                    inputs = read;
                    last = Some(page.clone());
                    server.show(Page::Proof(page));
                }
                Err(failure) => {
                    eprint!("{failure}");
                    server.show(Page::Failure(failure.to_string()));
                }
            }
            let watcher = watcher(&inputs, changed.clone())?;
            wait(&changes, &inputs)?;
            drop(watcher);
            while changes.recv_timeout(SETTLED).is_ok() {}
        }
    }

    /// The outputs are made; the proof, which shows what has changed since `last`, and the files that it follows from.
    fn build(
        &self,
        last: Option<&str>,
        common: &Common,
    ) -> Result<(String, BTreeSet<PathBuf>), Failure> {
        let build = Build::of(self.project.clone()).cached(self.cache.clone());
        build.run(common)?;
        let opened = Opened::new(&self.project)?;
        let (page, ..) = opened.work_with(&self.cache.open(), common, |project, world| {
            let built = pipeline::build(project, world)?;
            pipeline::proof(project, &built, last, world)
        })?;
        Ok((page, opened.inputs().into_iter().collect()))
    }
}

/// Sends the paths that change in the folders of these files: a program may replace a file by a new one.
fn watcher(
    inputs: &BTreeSet<PathBuf>,
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
    let folders: BTreeSet<&Path> = inputs.iter().map(|p| super::staged::parent(p)).collect();
    for folder in folders {
        watcher
            .watch(folder, RecursiveMode::NonRecursive)
            .map_err(fail)?;
    }
    Ok(watcher)
}

/// Until one of these files has changed.
fn wait(changes: &Receiver<Vec<PathBuf>>, inputs: &BTreeSet<PathBuf>) -> Outcome {
    let names: BTreeSet<_> = inputs.iter().filter_map(|p| p.file_name()).collect();
    loop {
        let paths = changes
            .recv()
            .map_err(|e| Failure::new(format!("files cannot be watched: {e}")))?;
        let ours = |p: &PathBuf| p.file_name().is_some_and(|n| names.contains(n));
        if paths.iter().any(ours) {
            return Ok(());
        }
    }
}
