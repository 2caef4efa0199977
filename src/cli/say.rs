//! What the program says: results on standard output, messages on standard error.
//!
//! A reader may have had enough, as after `khatt match font.toml | head -1`: then the rest goes nowhere, and that is
//! no error.

use super::Outcome;
use super::failure::Failure;
use std::fmt;
use std::io::{self, ErrorKind, Write};
use std::path::Path;

/// Whether the user means standard input or output.
pub(crate) fn is_dash(path: &Path) -> bool {
    path.as_os_str() == "-"
}

/// Prints a result.
pub(crate) fn print(content: &[u8]) -> Outcome {
    let mut out = io::stdout().lock();
    match out.write_all(content).and_then(|()| out.flush()) {
        Err(e) if e.kind() == ErrorKind::BrokenPipe => Ok(()),
        done => done.map_err(|e| Failure::at("standard output", &e)),
    }
}

/// Prints a message; where nobody can hear it there is nobody to be told of that.
pub(crate) fn message(words: fmt::Arguments<'_>) {
    io::stderr().write_fmt(words).unwrap_or_default();
}

/// As the standard library's, which panics where nobody listens.
macro_rules! eprint {
    ($($words:tt)*) => {
        $crate::cli::say::message(format_args!($($words)*))
    };
}

/// The same, with the line's end.
macro_rules! eprintln {
    ($($words:tt)*) => {
        eprint!("{}\n", format_args!($($words)*))
    };
}
