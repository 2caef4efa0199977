//! How a failed job is told: where, what, and what to do.

use std::error::Error;
use std::{fmt, iter};

/// One or more errors, each with its remedy where there is one.
#[derive(Debug)]
pub(crate) struct Failure {
    complaints: Vec<Complaint>,
    fault: Fault,
}

/// What must be changed before the command can be done.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fault {
    /// Something that it reads, or where it writes.
    Job,
    /// The command line, whatever lies on the disk.
    CommandLine,
}

/// One error.
#[derive(Debug)]
pub(crate) enum Complaint {
    /// What is wrong and what to do.
    Said { what: String, help: Option<String> },
    /// A message that shows the place itself.
    Drawn(String),
}

impl Complaint {
    pub(crate) fn new(what: impl Into<String>, help: Option<String>) -> Self {
        let what = what.into();
        Self::Said { what, help }
    }

    fn remedy(&self) -> Option<&str> {
        match self {
            Self::Said { help, .. } => help.as_deref(),
            Self::Drawn(_) => None,
        }
    }
}

impl Failure {
    pub(crate) fn new(what: impl Into<String>) -> Self {
        iter::once(Complaint::new(what, None)).collect()
    }

    /// The command line itself is wrong, as one that is not understood.
    pub(crate) fn of_use(what: impl Into<String>) -> Self {
        Self {
            fault: Fault::CommandLine,
            ..Self::new(what)
        }
    }

    /// Exit status.
    pub(crate) fn status(&self) -> u8 {
        match self.fault {
            Fault::Job => 1,
            Fault::CommandLine => 2,
        }
    }

    /// A message that shows the place itself.
    pub(crate) fn drawn(text: String) -> Self {
        iter::once(Complaint::Drawn(text)).collect()
    }

    /// With a remedy.
    pub(crate) fn help(mut self, remedy: impl Into<String>) -> Self {
        if let Some(Complaint::Said { help, .. }) = self.complaints.last_mut() {
            *help = Some(remedy.into());
        }
        self
    }

    /// What each error says, with its remedy.
    pub(crate) fn texts(&self) -> impl Iterator<Item = String> {
        self.complaints.iter().map(|complaint| match complaint {
            Complaint::Said { what, help } => match help {
                Some(help) => format!("{what}\n{help}"),
                None => what.clone(),
            },
            Complaint::Drawn(text) => text.trim().to_owned(),
        })
    }

    /// `place` and the error with all its causes.
    pub(crate) fn at(place: impl fmt::Display, error: &dyn Error) -> Self {
        Self::new(format!("{place}: {}", chain(error)))
    }
}

impl FromIterator<Complaint> for Failure {
    fn from_iter<I: IntoIterator<Item = Complaint>>(complaints: I) -> Self {
        Self {
            complaints: complaints.into_iter().collect(),
            fault: Fault::Job,
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut complaints = self.complaints.iter().peekable();
        while let Some(complaint) = complaints.next() {
            match complaint {
                Complaint::Said { what, help } => {
                    writeln!(f, "error: {what}")?;
                    // errors with one remedy share it
                    let next = complaints.peek().and_then(|next| next.remedy());
                    if let Some(help) = help.as_deref().filter(|help| next != Some(help)) {
                        writeln!(f, "  help: {help}")?;
                    }
                }
                Complaint::Drawn(text) => writeln!(f, "error:{}", text.trim_end())?,
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
