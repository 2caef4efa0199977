//! How a failed job is told: where, what, and what to do.

use std::error::Error;
use std::fmt;

/// One or more errors, each with its remedy where there is one.
#[derive(Debug)]
pub(crate) struct Failure(Vec<Complaint>);

/// One error.
#[derive(Debug)]
pub(crate) struct Complaint {
    what: String,
    help: Option<String>,
}

impl Complaint {
    pub(crate) fn new(what: impl Into<String>, help: Option<String>) -> Self {
        Self {
            what: what.into(),
            help,
        }
    }
}

impl Failure {
    pub(crate) fn new(what: impl Into<String>) -> Self {
        Self(vec![Complaint::new(what, None)])
    }

    /// `place` and the error with all its causes.
    pub(crate) fn at(place: impl fmt::Display, error: &dyn Error) -> Self {
        Self::new(format!("{place}: {}", chain(error)))
    }
}

impl FromIterator<Complaint> for Failure {
    fn from_iter<I: IntoIterator<Item = Complaint>>(complaints: I) -> Self {
        Self(complaints.into_iter().collect())
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for complaint in &self.0 {
            writeln!(f, "error: {}", complaint.what)?;
            if let Some(help) = &complaint.help {
                writeln!(f, "  help: {help}")?;
            }
        }
        Ok(())
    }
}

/// An error and its causes, each said once.
pub(crate) fn chain(error: &dyn Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(e) = cause {
        let more = e.to_string();
        if !text.contains(&more) {
            text = format!("{text}: {more}");
        }
        cause = e.source();
    }
    text
}
