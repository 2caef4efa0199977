//! `khatt build`: a project becomes fonts.

use super::progress::Times;
use super::project::Opened;
use super::staged::{self, Staged};
use super::{Common, Outcome, keep};
use clap::Args;
use khatt::pipeline::{self, Built, Outputs};
use khatt::types::Files;
use serde_json::json;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Builds what the project's [output] names, all of it or nothing
#[derive(Debug, Args)]
pub(crate) struct Build {
    /// Project file
    #[arg(value_name = "PROJECT.toml")]
    project: PathBuf,
    /// Also write every stage's result into this folder
    #[arg(long, value_name = "DIR")]
    keep: Option<PathBuf>,
    /// Also write a rule for Make or Ninja: outputs, colon, inputs
    #[arg(long, value_name = "FILE.d")]
    depfile: Option<PathBuf>,
    /// Write nothing; fail where an output is not what would be written
    #[arg(long)]
    locked: bool,
}

impl Build {
    pub(crate) fn run(&self, common: &Common) -> Outcome {
        let opened = Opened::new(&self.project)?;
        let ((built, outputs), total, times) = opened.work(common, |project, world| {
            let built = pipeline::build(project, world)?;
            let outputs = pipeline::outputs(project, &built, world)?;
            Ok((built, outputs))
        })?;
        let files = outputs.files.iter();
        let mut files: Vec<(PathBuf, Files)> = files
            .map(|(path, files)| (opened.path(path), files.clone()))
            .collect();
        if self.locked {
            return staged::same(&files);
        }
        if let Some(path) = opened.report() {
            files.push((path, report(&outputs, total, &times)));
        }
        if let Some(path) = &self.depfile {
            let rule = rule(
                files.iter().map(|(path, _)| path.as_path()),
                &opened.inputs(),
            );
            files.push((path.clone(), Files::single(rule.into_bytes())));
        }
        if let Some(folder) = &self.keep {
            files.push((folder.clone(), keep::files(&built)));
        }
        let mut staged = Staged::default();
        for (path, files) in &files {
            staged.add(path, files)?;
        }
        staged.commit()?;
        if !common.quiet {
            say(&built, total, &times);
            files
                .iter()
                .for_each(|(path, _)| eprintln!("  {}", path.display()));
        }
        Ok(())
    }
}

/// The report with the time of each stage.
fn report(outputs: &Outputs, total: Duration, times: &Times) -> Files {
    let stages = times.iter();
    let stages: serde_json::Map<_, _> = stages
        .map(|(stage, time)| (stage.to_string(), json!(time.as_secs_f64())))
        .collect();
    let mut report = json!(outputs.report);
    if let Some(table) = report.as_object_mut() {
        table.insert("seconds".to_owned(), json!(total.as_secs_f64()));
        table.insert("stage_seconds".to_owned(), stages.into());
    }
    Files::single(format!("{report:#}\n").into_bytes())
}

/// A rule for Make: its words have their spaces, `#` and `$` escaped.
fn rule<'a>(outputs: impl Iterator<Item = &'a Path>, inputs: &[PathBuf]) -> String {
    let word = |path: &Path| {
        let text = path.display().to_string();
        let text = text.replace(' ', "\\ ").replace('#', "\\#");
        text.replace('$', "$$")
    };
    let mut rule = outputs.map(word).collect::<Vec<_>>().join(" ");
    rule.push(':');
    inputs.iter().for_each(|path| {
        rule.push(' ');
        rule.push_str(&word(path));
    });
    rule.push('\n');
    // inputs that are gone are no reason to stop
    for path in inputs {
        let written = writeln!(rule, "{}:", word(path));
        debug_assert!(written.is_ok(), "a String takes everything");
    }
    rule
}

/// What was done, on standard error.
fn say(built: &Built, total: Duration, times: &Times) {
    for note in &built.notes {
        eprintln!("note: {}: {}", note.glyph, note.message);
    }
    for page in &built.pages {
        for warning in &page.cut.warnings {
            eprintln!("warning: {}, {warning}", page.name);
        }
    }
    for doubt in &built.doubts {
        eprintln!("warning: {doubt}");
    }
    let stages: Vec<String> = (times.iter())
        .map(|(stage, time)| format!("{stage} {:.2}", time.as_secs_f64()))
        .collect();
    let (glyphs, seconds) = (built.letters.len(), total.as_secs_f64());
    eprintln!("{glyphs} glyphs in {seconds:.2} s ({})", stages.join(", "));
}
