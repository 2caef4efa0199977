//! `khatt build`: a project becomes fonts.

use super::project::Opened;
use super::staged::Staged;
use super::{Common, Outcome};
use clap::Args;
use khatt::pipeline;
use std::path::PathBuf;

/// Builds what the project's [output] names, all of it or nothing
#[derive(Debug, Args)]
pub(crate) struct Build {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
}

impl Build {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let opened = Opened::new(&self.project)?;
        let ((built, outputs), total, times) = opened.work(common, |project, world| {
            let built = pipeline::build(project, world)?;
            let outputs = pipeline::outputs(project, &built, world)?;
            Ok((built, outputs))
        })?;
        let mut staged = Staged::default();
        for (path, files) in &outputs {
            staged.add(&opened.path(path), files)?;
        }
        staged.commit()?;
        if !common.quiet {
            built
                .notes
                .iter()
                .for_each(|n| eprintln!("note: {}: {}", n.glyph, n.message));
            let glyphs = built.letters.len();
            let stages: Vec<String> = (times.iter())
                .map(|(stage, time)| format!("{stage} {:.2}", time.as_secs_f64()))
                .collect();
            let seconds = total.as_secs_f64();
            eprintln!("{glyphs} glyphs in {seconds:.2} s ({})", stages.join(", "));
            let made = outputs.iter().map(|(path, _)| opened.path(path));
            made.for_each(|path| eprintln!("  {}", path.display()));
        }
        Ok(())
    }
}
