//! `khatt proof`: every cell with its outline, as a web page.

use super::cache::CacheArgs;
use super::project::Opened;
use super::{Common, Outcome, files};
use clap::Args;
use khatt::pipeline;
use std::path::PathBuf;

/// Shows every cell with its outline over the scan, and text set in the font, as one web page
#[derive(Debug, Args)]
pub(crate) struct Proof {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// Where the page goes, or - for standard output
    #[arg(short, long, value_name = "FILE.html")]
    output: PathBuf,
    #[command(flatten)]
    cache: CacheArgs,
}

impl Proof {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let opened = Opened::new(&self.project)?;
        opened.spare(&self.output, Some("proof"))?;
        let last = files::last(&self.output);
        let (page, ..) = opened.work_with(&self.cache.open(), common, |project, world| {
            let built = pipeline::build(project, world)?;
            pipeline::proof(project, &built, last.as_deref(), world)
        })?;
        files::write(&self.output, page.as_bytes(), &opened.named())
    }
}
