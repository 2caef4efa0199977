//! What a user types: arguments in, files and messages out.
//!
//! Exit status: 0 done, 1 the job failed, 2 the command line is wrong.

#[macro_use]
mod say;

mod build;
mod cache;
mod convert;
mod cut;
mod designspace;
mod done;
mod failure;
mod features;
mod files;
mod init;
mod inputs;
mod keep;
mod match_letters;
mod methods;
mod page_server;
mod pages;
mod progress;
mod project;
mod proof;
mod sarif;
mod sheet;
mod shell;
mod staged;
mod trace;
mod watch;

use clap::{Args, Parser, Subcommand};
use failure::Failure;
use std::process::ExitCode;

/// What every command's work gives back.
type Outcome = Result<(), Failure>;

/// khatt turns scanned sheets of drawn Arabic and Latin letters into fonts.
#[derive(Debug, Parser)]
#[command(name = "khatt", version, max_term_width = 100)]
#[command(after_help = "Exit status: 0 done, 1 the job failed, 2 the command line is wrong.")]
struct Khatt {
    #[command(subcommand)]
    command: Command,
    #[command(flatten)]
    common: Common,
}

/// Options of every command.
#[derive(Debug, Args)]
struct Common {
    /// Say nothing but errors
    #[arg(short, long, global = true, display_order = 100)]
    quiet: bool,
    /// Threads to work with [default: one a processor]
    #[arg(short, long, value_name = "N", global = true, display_order = 101, value_parser = jobs)]
    jobs: Option<usize>,
}

#[derive(Debug, Subcommand)]
enum Command {
    Build(build::Build),
    Watch(watch::Watch),
    Page(pages::Page),
    Merge(pages::Merge),
    Sheet(sheet::Sheet),
    Cut(cut::Cut),
    Proof(proof::Proof),
    Trace(trace::Trace),
    Features(features::Features),
    Convert(convert::Convert),
    Designspace(designspace::Designspace),
    Match(match_letters::Match),
    Methods(methods::Methods),
    Init(init::Init),
    Completions(shell::Completions),
    Man(shell::Manual),
    /// Prints the JSON schema of the report
    Schema,
}

/// Threads that a job may have: no machine has processors for more, and of tens of thousands none comes to its work.
const MOST_JOBS: usize = 1024;

fn jobs(text: &str) -> Result<usize, String> {
    let number = text.parse().ok();
    let wrong = || format!("must be a whole number from 1 to {MOST_JOBS}");
    number
        .filter(|n| (1..=MOST_JOBS).contains(n))
        .ok_or_else(wrong)
}

/// Reads the arguments, does the work, says how it ended.
pub(crate) fn main() -> ExitCode {
    let args = Khatt::parse();
    let threads = args.common.jobs.unwrap_or(0);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    let outcome = match pool {
        Ok(pool) => pool.install(|| run(&args)),
        Err(e) => Err(Failure::new(format!("no threads to work with: {e}"))),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            eprint!("{failure}");
            ExitCode::from(failure.status())
        }
    }
}

fn run(args: &Khatt) -> Outcome {
    match &args.command {
        Command::Build(build) => build.run(&args.common),
        Command::Watch(watch) => watch.run(&args.common),
        Command::Page(page) => page.run(&args.common),
        Command::Merge(merge) => merge.run(&args.common),
        Command::Sheet(sheet) => sheet.run(&args.common),
        Command::Cut(cut) => cut.run(&args.common),
        Command::Proof(proof) => proof.run(&args.common),
        Command::Trace(trace) => trace.run(&args.common),
        Command::Features(features) => features.run(),
        Command::Convert(convert) => convert.run(&args.common),
        Command::Designspace(family) => family.run(&args.common),
        Command::Match(letters) => letters.run(&args.common),
        Command::Methods(methods) => methods.run(),
        Command::Init(init) => init.run(),
        Command::Completions(completions) => completions.run(),
        Command::Man(manual) => manual.run(),
        Command::Schema => shell::schema(),
    }
}
