//! `khatt completions`, `khatt man`, `khatt schema`: what other programs read, from the same sources.

use super::failure::Failure;
use super::{Khatt, Outcome, files, staged};
use clap::{Args, Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use khatt::pipeline::Report;
use khatt::types::Files;
use std::iter;
use std::path::{Path, PathBuf};

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

/// Prints the manual page of khatt, or writes it and those of all commands
#[derive(Debug, Args)]
pub(crate) struct Manual {
    /// Write the pages into this folder, khatt.1 and one for each command; what else is in it stays
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
}

impl Manual {
    pub(crate) fn run(&self) -> Outcome {
        if self.output.as_deref().is_some_and(files::is_dash) {
            let what = "- is standard output, and the pages are files";
            return Err(Failure::of_use(what).help("name a folder: -o DIR"));
        }
        let mut khatt = Khatt::command().disable_help_subcommand(true);
        khatt.build();
        let commands: Vec<Command> = khatt.get_subcommands().cloned().collect();
        let source = format!("khatt {}", env!("CARGO_PKG_VERSION"));
        let own = Man::new(khatt);
        let Some(folder) = &self.output else {
            return files::write(Path::new("-"), &rendered(&own), &[]);
        };
        let all = iter::once(own).chain(commands.into_iter().map(Man::new));
        let page = |man: Man| {
            let place = folder.join(man.get_filename());
            let text = rendered(&man.source(&source));
            (place, Files::single(text))
        };
        staged::write(&all.map(page).collect::<Vec<_>>(), &[])
    }
}

fn rendered(man: &Man) -> Vec<u8> {
    let mut text = Vec::new();
    let rendered = man.render(&mut text);
    debug_assert!(rendered.is_ok(), "memory takes everything");
    text
}

/// Prints the JSON schema of the report
pub(crate) fn schema() -> Outcome {
    let schema = schemars::schema_for!(Report);
    let text = format!("{:#}\n", schema.as_value());
    files::write(Path::new("-"), text.as_bytes(), &[])
}
