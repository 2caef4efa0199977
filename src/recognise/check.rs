//! Labels against what the cells look like: wrong ones, swapped ones, rows shifted, letters left out.
//!
//! Source   own: cells and labels are aligned in reading order at the least cost, as texts are compared
//! Solves   min over alignments of Σ cost(cell, label) + GAP · (cells and labels without a partner)
//! Takes    the labels in reading order; for each drawn cell the index of its label and its [`Guess`]es
//! Gives    [`Finding`]s in reading order; none where nothing speaks against the labels
//! Cost     O(cells · labels)      Fails  never

use super::alphabet::Guess;

/// A cell and what it looks like.
#[derive(Debug, Clone, Copy)]
pub struct Reading<'a> {
    /// The index of the label that it is said to bear.
    pub label: usize,
    /// Likeliest first; none for an empty cell.
    pub guesses: &'a [Guess],
}

/// Something that does not fit. Cells and labels are named by their index in reading order.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Finding {
    /// A cell looks like another letter.
    Disagrees {
        /// index of the cell's label
        cell: usize,
        /// the letter it looks like
        like: String,
        /// how sure, 0…1
        confidence: f64,
    },
    /// Two cells look like each other's labels.
    Swapped(usize, usize),
    /// Cells one after another, each of which looks like the label `by` places after its own.
    Shifted {
        /// first cell
        first: usize,
        /// last cell
        last: usize,
        /// places, negative for labels before its own
        by: isize,
    },
    /// A label that no cell looks like, in a row of labels that fit.
    Missing(usize),
    /// A cell that looks like no label, in a row of cells that fit.
    Extra(usize),
    /// A cell without a label that looks like no letter surely enough.
    Unsure {
        /// index of the cell
        cell: usize,
        /// the letter it looks like
        like: String,
        /// how sure, 0…1
        confidence: f64,
    },
}

impl Finding {
    /// The same about cells and labels of other numbers.
    pub(crate) fn renumbered(mut self, to: impl Fn(usize) -> usize) -> Self {
        match &mut self {
            Self::Disagrees { cell: i, .. }
            | Self::Unsure { cell: i, .. }
            | Self::Missing(i)
            | Self::Extra(i) => {
                *i = to(*i);
            }
            Self::Swapped(i, j)
            | Self::Shifted {
                first: i, last: j, ..
            } => (*i, *j) = (to(*i), to(*j)),
        }
        self
    }
}

/// Cost of a cell or label without a partner: as much as one and a half wrong letters.
const GAP: f64 = 1.5;
/// Cells that a shift needs to be told as one.
const RUN: usize = 3;
/// Confidence from which a single cell is believed against its label.
const SURE: f64 = 0.9;
/// A label of at least this confidence is not contradicted.
const POSSIBLE: f64 = 0.02;

/// Letters that fonts draw alike, by their names: no sight tells them apart.
const ALIKE: [&[&str]; 9] = [
    &["l", "I", "one", "bar"],
    &["O", "o", "zero"],
    &["c", "C"],
    &["s", "S"],
    &["v", "V"],
    &["w", "W"],
    &["x", "X"],
    &["z", "Z"],
    &["uni0627", "uni0661"],
];

/// Whether two letters are one to the eye.
fn alike(a: &str, b: &str) -> bool {
    a == b || ALIKE.iter().any(|set| set.contains(&a) && set.contains(&b))
}

/// What speaks against the labels.
#[must_use]
pub fn check(labels: &[String], readings: &[Reading<'_>]) -> Vec<Finding> {
    let pairs = align(labels, readings);
    let shift = |i: usize| Some(pairs[i]?.cast_signed() - readings[i].label.cast_signed());
    let mut findings = Vec::new();
    let mut explained = vec![false; readings.len()];
    for run in runs(readings.len(), shift) {
        let (first, last) = (run.0, run.1);
        explained[first..=last].fill(true);
        findings.push((
            readings[first].label,
            Finding::Shifted {
                first: readings[first].label,
                last: readings[last].label,
                by: run.2,
            },
        ));
    }
    let gaps = readings.len() != labels.len() || !findings.is_empty();
    if gaps {
        let met = |j: &usize| !pairs.contains(&Some(*j));
        findings.extend(
            (0..labels.len())
                .filter(met)
                .map(|j| (j, Finding::Missing(j))),
        );
        for (i, r) in readings
            .iter()
            .enumerate()
            .filter(|(i, _)| pairs[*i].is_none())
        {
            explained[i] = true;
            findings.push((r.label, Finding::Extra(r.label)));
        }
    }
    findings.extend(single(labels, readings, &explained));
    findings.sort_by_key(|f| f.0);
    findings.into_iter().map(|f| f.1).collect()
}

/// How badly a label fits what a cell looks like, 0…1.
fn cost(guesses: &[Guess], label: &str) -> f64 {
    match guesses.iter().position(|g| g.label == label) {
        Some(0) => 0.0,
        Some(1 | 2) => 0.35,
        Some(3..=9) => 0.7,
        _ => 1.0,
    }
}

/// The label that each cell is aligned with.
fn align(labels: &[String], readings: &[Reading<'_>]) -> Vec<Option<usize>> {
    let (n, m) = (readings.len(), labels.len());
    let mut least = vec![vec![0.0_f64; m + 1]; n + 1];
    let fits = |i: usize, j: usize| cost(readings[i].guesses, &labels[j]);
    for i in 0..=n {
        for j in 0..=m {
            let both = (i > 0 && j > 0).then(|| least[i - 1][j - 1] + fits(i - 1, j - 1));
            let cell = (i > 0).then(|| least[i - 1][j] + GAP);
            let label = (j > 0).then(|| least[i][j - 1] + GAP);
            let ways = [both, cell, label].into_iter().flatten();
            least[i][j] = ways.reduce(f64::min).unwrap_or(0.0);
        }
    }
    let mut pairs = vec![None; n];
    let (mut i, mut j) = (n, m);
    while i > 0 && j > 0 {
        let here = least[i][j];
        if here >= least[i - 1][j - 1] + fits(i - 1, j - 1) {
            pairs[i - 1] = Some(j - 1);
            (i, j) = (i - 1, j - 1);
        } else if here >= least[i - 1][j] + GAP {
            i -= 1;
        } else {
            j -= 1;
        }
    }
    pairs
}

/// First and last of at least [`RUN`] neighbours with one shift that is not 0, and the shift.
fn runs(n: usize, shift: impl Fn(usize) -> Option<isize>) -> Vec<(usize, usize, isize)> {
    let mut out = Vec::new();
    let mut first = 0;
    for i in 1..=n {
        if i < n && shift(i) == shift(first) {
            continue;
        }
        match shift(first) {
            Some(by) if by != 0 && i - first >= RUN => out.push((first, i - 1, by)),
            _ => {}
        }
        first = i;
    }
    out
}

/// Cells that contradict their own label, two that contradict each other's as one.
fn single(
    labels: &[String],
    readings: &[Reading<'_>],
    explained: &[bool],
) -> Vec<(usize, Finding)> {
    let wrong = |(i, r): (usize, &Reading<'_>)| {
        let best = r.guesses.first().filter(|g| g.confidence >= SURE)?;
        let own = labels.get(r.label)?;
        let possible = r
            .guesses
            .iter()
            .any(|g| g.label == *own && g.confidence >= POSSIBLE);
        (!explained[i] && !alike(&best.label, own) && !possible).then(|| (r.label, best.clone()))
    };
    let wrong: Vec<(usize, Guess)> = readings.iter().enumerate().filter_map(wrong).collect();
    let partner = |(cell, guess): &(usize, Guess)| {
        let swapped =
            |o: &&(usize, Guess)| labels[o.0] == guess.label && labels[*cell] == o.1.label;
        wrong.iter().find(swapped).map(|o| o.0)
    };
    let found = wrong.iter().filter_map(|w| match partner(w) {
        Some(other) if other < w.0 => None,
        Some(other) => Some((w.0, Finding::Swapped(w.0, other))),
        None => {
            let (like, confidence) = (w.1.label.clone(), w.1.confidence);
            Some((
                w.0,
                Finding::Disagrees {
                    cell: w.0,
                    like,
                    confidence,
                },
            ))
        }
    });
    found.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Guesses of cells that are drawn as `drawn` and bear `written`, each read with `confidence`.
    fn findings(written: &str, drawn: &str, confidence: f64) -> Vec<Finding> {
        let labels: Vec<String> = written.chars().map(String::from).collect();
        let guess = |c: char| {
            vec![Guess {
                label: c.to_string(),
                distance: 0.0,
                confidence,
            }]
        };
        let guesses: Vec<Vec<Guess>> = drawn.chars().map(guess).collect();
        let readings = guesses.iter().enumerate();
        let readings: Vec<Reading<'_>> = readings
            .map(|(label, g)| Reading { label, guesses: g })
            .collect();
        check(&labels, &readings)
    }

    #[test]
    fn what_fits_is_silent() {
        assert_eq!(findings("abcdefgh", "abcdefgh", 0.99), []);
        assert_eq!(
            findings("abcdefgh", "abcxefgh", 0.5),
            [],
            "an unsure cell is not believed"
        );
        assert_eq!(findings("", "", 0.99), []);
    }

    #[test]
    fn letters_that_look_alike_are_not_doubted() {
        assert_eq!(findings("lOcx", "IoCX", 0.99), []);
    }

    #[test]
    fn one_wrong_and_two_swapped() {
        let like = |cell, like: &str| Finding::Disagrees {
            cell,
            like: like.to_owned(),
            confidence: 0.99,
        };
        assert_eq!(findings("abcdefgh", "abcxefgh", 0.99), [like(3, "x")]);
        assert_eq!(
            findings("abcdefgh", "abgdefch", 0.99),
            [Finding::Swapped(2, 6)]
        );
        assert_eq!(
            findings("abcdefgh", "bacdefgh", 0.99),
            [Finding::Swapped(0, 1)]
        );
    }

    #[test]
    fn a_row_shifted() {
        // The labels of c…h stand one place too far to the right.
        let by_one = Finding::Shifted {
            first: 3,
            last: 7,
            by: -1,
        };
        assert_eq!(
            findings("abxcdefgh", "abcdefgh", 0.5)[..],
            [
                Finding::Shifted {
                    first: 2,
                    last: 7,
                    by: 1
                },
                Finding::Missing(2)
            ][..]
        );
        let found = findings("abxcdefghi", "abycdefgzi", 0.5);
        assert_eq!(found, [], "the row fits");
        let found = findings("abcdefghij", "abxcdefgij", 0.5);
        assert_eq!(found, [Finding::Extra(2), by_one, Finding::Missing(7)]);
    }

    #[test]
    fn a_letter_left_out() {
        let found = findings("abcdefgh", "abcefgh", 0.5);
        assert_eq!(
            found,
            [
                Finding::Shifted {
                    first: 3,
                    last: 6,
                    by: 1
                },
                Finding::Missing(3)
            ]
        );
    }
}
