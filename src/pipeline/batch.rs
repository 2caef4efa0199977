//! What was made of the pages of one picture file.

use super::problem::Problem;
use crate::template::TemplateError;
use std::collections::BTreeMap;

/// What was made of the pages that one picture file shows.
#[derive(Debug, Clone)]
pub(super) struct Batch<T> {
    /// Every page's number in its table, from 1, and what messages call it, whatever became of it.
    pub(super) seen: Vec<(usize, String)>,
    /// What was made of pages, by their numbers.
    pub(super) made: Vec<(usize, T)>,
    /// What is wrong.
    pub(super) problems: Vec<Problem>,
}

impl<T> Batch<T> {
    /// Nothing but what is wrong.
    pub(super) const fn failed(problems: Vec<Problem>) -> Self {
        Self {
            seen: Vec::new(),
            made: Vec::new(),
            problems,
        }
    }

    /// What `work` makes of each page and its number.
    pub(super) fn map<U>(self, work: impl Fn(usize, T) -> Result<U, Vec<Problem>>) -> Batch<U> {
        let (mut made, mut problems) = (Vec::new(), self.problems);
        for (number, value) in self.made {
            match work(number, value) {
                Ok(value) => made.push((number, value)),
                Err(more) => problems.extend(more),
            }
        }
        Batch {
            seen: self.seen,
            made,
            problems,
        }
    }
}

/// The pages of all files by their numbers, those seen, and all problems; a page that two files show is one.
pub(super) fn join<T>(
    batches: Vec<Batch<T>>,
) -> (BTreeMap<usize, T>, BTreeMap<usize, String>, Vec<Problem>) {
    let mut seen: BTreeMap<usize, String> = BTreeMap::new();
    let (mut made, mut problems) = (BTreeMap::new(), Vec::new());
    for batch in batches {
        for (page, second) in batch.seen {
            if let Some(first) = seen.get(&page).cloned() {
                problems.push(Problem::from(TemplateError::Twice {
                    page,
                    first,
                    second,
                }));
            } else {
                seen.insert(page, second);
            }
        }
        made.extend(batch.made);
        problems.extend(batch.problems);
    }
    (made, seen, problems)
}
