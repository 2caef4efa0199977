//! What is said of a bare page whose letters and names do not agree: how many letters each row has, and where in
//! doubt.

use super::reading::{Reading, Role};
use crate::scan::cut::layout::listed;
use crate::scan::cut::layout::touching::Touch;
use crate::scan::error::Fault;
use crate::scan::options::Order;

/// So many places are told; where more are in doubt, it is not one name that was forgotten.
const TOLD: usize = 3;

/// A page that cannot be read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Unread {
    /// How many letters each row has.
    rows: Vec<usize>,
    /// Where names and letters part, in reading order.
    doubts: Vec<Doubt>,
    /// Letters that touch each other: the page can be read when they are parted.
    pub(super) touching: Vec<Touch>,
    /// How many pieces of ink it has, where these are too many to be read.
    crowd: Option<usize>,
}

/// A place where names and letters part, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Doubt {
    /// A letter without a name, one of those from one to another, each its row and its place there.
    Nameless {
        first: (usize, usize),
        last: (usize, usize),
    },
    /// A name without a letter, one of those from one to another; after so many letters of a row.
    Missing {
        first: usize,
        last: usize,
        row: usize,
        letter: usize,
    },
    /// Letters of so many names that touch.
    Touching { name: usize, letters: usize },
    /// All of the page.
    Unlike,
}

impl Unread {
    /// From what a page's pieces were read as, how many of them each row has, and which are letters that touch.
    pub(super) fn new(reading: &Reading, lengths: &[usize], touching: Vec<Touch>) -> Self {
        let unlike = reading.is_unlike().then_some(Doubt::Unlike);
        let (mut rows, mut doubts) = (vec![0; lengths.len()], Vec::from_iter(unlike));
        let row_of = lengths.iter().enumerate();
        let row_of: Vec<usize> = row_of.flat_map(|(row, &n)| vec![row; n]).collect();
        let mut missing = reading.missing.iter().peekable();
        let (mut last, mut places) = (0, Vec::new());
        for i in 0..=reading.roles.len() {
            while let Some(&(name, _)) = missing.next_if(|m| m.1 <= i) {
                let letter = rows.get(last).copied().unwrap_or(0);
                let among = reading.letterless().unwrap_or(name..=name);
                doubts.push(Doubt::Missing {
                    first: *among.start(),
                    last: *among.end(),
                    row: last + 1,
                    letter,
                });
            }
            let (Some(role), Some(&row)) = (reading.roles.get(i), row_of.get(i)) else {
                continue;
            };
            let letters = match role {
                Role::Letter(_) | Role::Nameless => 1,
                Role::Touching(_, letters) => *letters,
                Role::Part | Role::Dirt => 0,
            };
            if letters > 0 {
                rows[row] += letters;
                last = row;
            }
            if let Role::Touching(name, letters) = *role {
                doubts.push(Doubt::Touching { name, letters });
            }
            let here = (row + 1, rows[row]);
            places.push(here);
            if *role == Role::Nameless {
                doubts.push(Doubt::Nameless {
                    first: here,
                    last: here,
                });
            }
        }
        if let Some(among) = reading.nameless() {
            let place = |i: usize| places.get(i).copied().unwrap_or((1, 1));
            let (first, last) = (place(*among.start()), place(*among.end()));
            doubts.retain(|d| !matches!(d, Doubt::Nameless { .. }));
            doubts.push(Doubt::Nameless { first, last });
        }
        Self {
            rows,
            doubts,
            touching,
            crowd: None,
        }
    }

    /// Of a page whose letters are not like their names, so many in each row.
    pub(super) fn unlike(rows: Vec<usize>) -> Self {
        Self {
            rows,
            doubts: vec![Doubt::Unlike],
            touching: Vec::new(),
            crowd: None,
        }
    }

    /// How many letters each row has that has any: places that only dirt makes are no rows.
    fn lettered(&self) -> Vec<usize> {
        self.rows.iter().copied().filter(|&n| n > 0).collect()
    }

    /// Whether its rows have as many letters as names stand in lines, but for one of them.
    pub(super) fn is_nearly(&self, lines: &[usize]) -> bool {
        let rows = self.lettered();
        let odd = rows.iter().zip(lines).filter(|(a, b)| a != b).count();
        rows.len() == lines.len() && odd < 2
    }

    /// Of a page of so many pieces of ink, too many for its names.
    pub(super) fn crowded(pieces: usize) -> Self {
        Self {
            rows: Vec::new(),
            doubts: Vec::new(),
            touching: Vec::new(),
            crowd: Some(pieces),
        }
    }

    /// The error of a page that has so many names, in lines of so many each where those are known; `label` says the
    /// text of one, and its number on the page.
    pub(super) fn error<'a>(
        &self,
        (names, lines): (usize, &[usize]),
        label: impl Fn(usize) -> (&'a str, usize),
    ) -> Fault {
        if let Some(pieces) = self.crowd {
            return Fault::ManyPieces { pieces, names };
        }
        let rows = self.lettered();
        if rows.is_empty() {
            return Fault::NoLetters(names);
        }
        let place = |row: usize| {
            let before = self.rows.iter().take(row);
            before.filter(|&&n| n > 0).count().max(1)
        };
        let told = self.doubts.iter().take(TOLD).map(|doubt| match *doubt {
            Doubt::Nameless { first, last } => {
                let (from, to) = (place(first.0), place(last.0));
                let among = match (first, last) {
                    (a, b) if a == b => format!("letter {} of row {from}", a.1),
                    (a, b) if a.0 == b.0 => {
                        format!("one of letters {} to {} of row {from}", a.1, b.1)
                    }
                    (a, b) => format!(
                        "one of those from letter {} of row {from} to letter {} of row {to}",
                        a.1, b.1
                    ),
                };
                format!("{among} seems to have no name")
            }
            Doubt::Missing {
                first,
                last,
                row,
                letter,
            } if first == last => format!(
                "“{}” seems to have no letter after letter {letter} of row {}",
                label(first).0,
                place(row)
            ),
            Doubt::Missing { first, last, .. } => {
                let [(a, from), (b, to)] = [first, last].map(&label);
                format!("one of those from “{a}” (number {from}) to “{b}” (number {to}) seems to have no letter")
            }
            Doubt::Touching { name, letters } => format!(
                "“{}” and “{}” seem to touch",
                label(name).0,
                label(name + letters - 1).0
            ),
            Doubt::Unlike => {
                "few letters look like their names, as where each is drawn in many pieces; layout = { grid = [rows, columns] } goes by \
                 places alone"
                    .to_owned()
            }
        });
        let odd = match listed::check(lines, (Order::Rows, &rows)) {
            Err(Fault::Line {
                line, names, cells, ..
            }) => Some(format!(
                "line {line} of `glyphs` has {names} names and row {line} {cells} letters"
            )),
            _ => None,
        };
        let more = self.doubts.len().saturating_sub(TOLD);
        let more = (more > 0).then(|| format!("{more} more places are in doubt"));
        let doubts: Vec<String> = odd.into_iter().chain(told).chain(more).collect();
        let each: Vec<String> = rows.iter().map(usize::to_string).collect();
        Fault::Count {
            found: rows.iter().sum(),
            rows: each.join(", "),
            names,
            doubts: doubts.join(", "),
        }
    }
}
