//! The letters of a page on which none is drawn twice.

use super::alphabet::Guess;
use crate::numeric::assignment::assign;
use std::collections::{BTreeMap, BTreeSet};

/// Cost of a letter that a cell was not thought to hold.
const NEVER: f64 = 100.0;
/// Cost of no letter.
const NONE: f64 = 40.0;

/// For each cell the letter that it is given where no letter is given twice and the product of all confidences is
/// largest; `None` where all that it may hold is others'. The confidence becomes that among the letters which no
/// other cell is given.
///
/// `guesses` holds for each cell what [`Alphabet::rank`](super::Alphabet::rank) says.
#[must_use]
pub fn once(guesses: &[Vec<Guess>]) -> Vec<Option<Guess>> {
    let labels = guesses.iter().flatten().map(|g| g.label.as_str());
    let labels: BTreeSet<&str> = labels.collect();
    let columns: BTreeMap<&str, usize> = labels.into_iter().zip(0..).collect();
    let row = |guesses: &Vec<Guess>| {
        let mut row = vec![NEVER; columns.len()];
        for guess in guesses {
            if let Some(&column) = columns.get(guess.label.as_str()) {
                row[column] = -libm::log(guess.confidence.max(1e-15));
            }
        }
        row
    };
    // behind the letters come as many columns for none as there are cells
    let none = vec![NONE; guesses.len()];
    let costs: Vec<Vec<f64>> = guesses
        .iter()
        .map(|g| [row(g), none.clone()].concat())
        .collect();
    let given = assign(&costs);
    let taken = |g: &&Guess| {
        columns
            .get(g.label.as_str())
            .is_some_and(|c| given.contains(c))
    };
    let cells = guesses.iter().zip(&given);
    let own = |(guesses, column): (&Vec<Guess>, &usize)| {
        let own = guesses
            .iter()
            .find(|g| columns.get(g.label.as_str()) == Some(column))?;
        let others = guesses.iter().filter(|g| !taken(g));
        let free: f64 = others.map(|g| g.confidence).sum();
        Some(Guess {
            confidence: own.confidence / (own.confidence + free),
            ..own.clone()
        })
    };
    cells.map(own).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn guess(label: &str, confidence: f64) -> Guess {
        Guess {
            label: label.to_owned(),
            distance: 1.0 - confidence,
            confidence,
        }
    }

    fn read(guesses: &[Vec<Guess>]) -> Vec<Option<(String, f64)>> {
        let given = once(guesses).into_iter();
        given.map(|g| g.map(|g| (g.label, g.confidence))).collect()
    }

    #[test]
    fn the_surer_cell_keeps_a_letter() {
        let cells = [
            vec![guess("P", 0.6), guess("p", 0.3), guess("q", 0.1)],
            vec![guess("P", 0.9), guess("p", 0.1)],
        ];
        let [first, second] = &read(&cells)[..] else {
            panic!("two cells")
        };
        assert_eq!(first.as_ref().map(|g| g.0.as_str()), Some("p"));
        assert!(first.as_ref().is_some_and(|g| (g.1 - 0.75).abs() < 1e-9));
        assert_eq!(*second, Some(("P".to_owned(), 1.0)));
    }

    #[test]
    fn a_cell_may_be_left_without() {
        let cells = [vec![guess("b", 1.0)], vec![guess("b", 1.0)], Vec::new()];
        let given = read(&cells);
        assert_eq!(given.iter().flatten().count(), 1);
        assert_eq!(given[2], None);
        assert_eq!(once(&[]), Vec::new());
    }
}
