//! `khatt completions`, `khatt man`, `khatt schema`: what other programs read, from the same sources.

use super::{Khatt, Outcome, files};
use clap::{Args, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use khatt::pipeline::Report;
use std::path::Path;

/// Prints completions for a shell
#[derive(Debug, Args)]
pub(crate) struct Completions {
    /// The shell
    #[arg(value_name = "SHELL")]
    shell: Shell,
}

impl Completions {
    pub(crate) fn run(&self) -> Outcome {
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Khatt::command(), "khatt", &mut text);
        files::write(Path::new("-"), &text, &[])
    }
}

/// Prints the manual page
pub(crate) fn man() -> Outcome {
    let mut text = Vec::new();
    let rendered = Man::new(Khatt::command()).render(&mut text);
    debug_assert!(rendered.is_ok(), "memory takes everything");
    files::write(Path::new("-"), &text, &[])
}

/// Prints the JSON schema of the report
pub(crate) fn schema() -> Outcome {
    let schema = schemars::schema_for!(Report);
    let text = format!("{:#}\n", schema.as_value());
    files::write(Path::new("-"), text.as_bytes(), &[])
}
