//! What is said of a bare page whose letters and names do not agree: how many letters each row has, and where in doubt.

use super::reading::{Reading, Role};
use crate::scan::error::ScanError;

/// So many places are told; where more are in doubt, it is not one name that was forgotten.
const TOLD: usize = 3;

/// A page that cannot be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Unread {
    /// How many letters each row has.
    rows: Vec<usize>,
    /// Where names and letters part, in reading order.
    doubts: Vec<Doubt>,
}

/// A place where names and letters part, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Doubt {
    /// A letter without a name.
    Nameless { row: usize, letter: usize },
    /// A name without a letter, after so many letters of its row.
    Missing {
        name: usize,
        row: usize,
        letter: usize,
    },
}

impl Unread {
    /// From what a page's pieces were read as, and how many of them each row has.
    pub(super) fn new(reading: &Reading, lengths: &[usize]) -> Self {
        let (mut rows, mut doubts) = (vec![0; lengths.len()], Vec::new());
        let row_of = lengths.iter().enumerate();
        let row_of: Vec<usize> = row_of.flat_map(|(row, &n)| vec![row; n]).collect();
        let mut missing = reading.missing.iter().peekable();
        let mut last = 0;
        for i in 0..=reading.roles.len() {
            while let Some(&(name, _)) = missing.next_if(|m| m.1 <= i) {
                let letter = rows.get(last).copied().unwrap_or(0);
                doubts.push(Doubt::Missing {
                    name,
                    row: last + 1,
                    letter,
                });
            }
            let (Some(role), Some(&row)) = (reading.roles.get(i), row_of.get(i)) else {
                continue;
            };
            if matches!(role, Role::Letter(_) | Role::Nameless) {
                rows[row] += 1;
                last = row;
            }
            if *role == Role::Nameless {
                doubts.push(Doubt::Nameless {
                    row: row + 1,
                    letter: rows[row],
                });
            }
        }
        Self { rows, doubts }
    }

    /// The error of a page that has so many names; `label` says the text of one.
    pub(super) fn error<'a>(
        &self,
        source: &str,
        names: usize,
        label: impl Fn(usize) -> &'a str,
    ) -> ScanError {
        // places that only dirt makes are no rows
        let rows: Vec<usize> = self.rows.iter().copied().filter(|&n| n > 0).collect();
        let place = |row: usize| {
            let before = self.rows.iter().take(row);
            before.filter(|&&n| n > 0).count().max(1)
        };
        let told = self.doubts.iter().take(TOLD).map(|doubt| match *doubt {
            Doubt::Nameless { row, letter } => {
                format!(
                    "letter {letter} of row {} seems to have no name",
                    place(row)
                )
            }
            Doubt::Missing { name, row, letter } => format!(
                "“{}” seems to have no letter after letter {letter} of row {}",
                label(name),
                place(row)
            ),
        });
        let mut doubts: Vec<String> = told.collect();
        let more = self.doubts.len() - doubts.len();
        if more > 0 {
            doubts.push(format!("{more} more places are in doubt"));
        }
        let each: Vec<String> = rows.iter().map(usize::to_string).collect();
        ScanError::Count {
            source_name: source.to_owned(),
            found: rows.iter().sum(),
            rows: each.join(", "),
            names,
            doubts: doubts.join(", "),
        }
    }
}
