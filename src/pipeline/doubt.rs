//! What speaks against a page's labels, in words.

use crate::recognise::Finding;
use std::fmt;

/// What does not fit the labels of one page.
#[derive(Debug, Clone)]
pub struct Doubt {
    /// The page, as messages name it.
    pub sheet: String,
    /// What does not fit, cells and labels by their index.
    pub finding: Finding,
    /// The labels of the page.
    pub(super) labels: Vec<String>,
}

impl fmt::Display for Doubt {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let label = |i: &usize| self.labels.get(*i).map_or("?", String::as_str);
        write!(f, "{}: ", self.sheet)?;
        match &self.finding {
            Finding::Disagrees {
                cell,
                like,
                confidence,
            } => {
                let percent = 100.0 * confidence;
                write!(
                    f,
                    "cell {} is labelled {} but looks like {like} ({percent:.0} %)",
                    cell + 1,
                    label(cell)
                )
            }
            Finding::Swapped(a, b) => {
                write!(
                    f,
                    "cells {} and {} look as if their labels {} and {} were swapped",
                    a + 1,
                    b + 1,
                    label(a),
                    label(b)
                )
            }
            Finding::Shifted { first, last, by } => {
                let side = if *by > 0 { "after" } else { "before" };
                let (first, last) = (first + 1, last + 1);
                let places = by.unsigned_abs();
                write!(
                    f,
                    "cells {first} to {last} are shifted: each looks like the label {places} {side} its own"
                )
            }
            Finding::Unsure {
                cell,
                like,
                confidence,
            } => {
                let percent = 100.0 * confidence;
                write!(
                    f,
                    "cell {} is left out: perhaps {like} ({percent:.0} %)",
                    cell + 1
                )
            }
            Finding::Missing(j) => write!(f, "no cell looks like label {} ({})", j + 1, label(j)),
            Finding::Extra(i) => write!(
                f,
                "cell {} ({}) looks like no label near it",
                i + 1,
                label(i)
            ),
        }
    }
}
