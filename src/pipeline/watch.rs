//! What a caller may want to see of a run while it goes on; nothing of it reaches a result.

use std::any::Any;
use std::fmt;

/// A stage of the way from page to font.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Stage {
    /// Picture file to page.
    Load,
    /// Even light, no dust.
    Clean,
    /// Upright page and its cells.
    Cut,
    /// A cell to curves.
    Trace,
    /// Names, metrics, spacing, joining.
    Assemble,
    /// TrueType's curves.
    Quadratic,
    /// The outline that is compiled against the scan.
    Measure,
    /// Bytes.
    Write,
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Load => "load",
            Self::Clean => "clean",
            Self::Cut => "cut",
            Self::Trace => "trace",
            Self::Assemble => "assemble",
            Self::Quadratic => "quadratic",
            Self::Measure => "measure",
            Self::Write => "write",
        })
    }
}

/// Is told what a run does, or does not listen. It is called from many threads at once.
pub trait Watch: Sync {
    /// A stage begins on this thread; it ends when the answer is dropped.
    fn enter(&self, _: Stage) -> Box<dyn Any> {
        Box::new(())
    }

    /// So many more cells are to be done.
    fn expect(&self, _: usize) {}

    /// A cell is done.
    fn done(&self) {}
}
