//! The lines of a list of names beside the rows of a page.
//!
//! Where a list breaks says nothing, unless most of its lines are as long as their rows. Then each line is a row, and
//! one with a name too many or too few has shifted all names after it.

use crate::scan::error::Fault;
use crate::scan::options::Order;

/// Checks lines of names, by how many each has, against the cells or letters of each row, or of each column where
/// those come first.
///
/// # Errors
/// Lines are rows, and one that is as long as its row does not begin with it.
pub(super) fn check(lines: &[usize], (order, rows): (Order, &[usize])) -> Result<(), Fault> {
    let both = || lines.iter().zip(rows);
    let fit = both().filter(|(names, cells)| names == cells).count();
    if lines.len() > rows.len() || 2 * fit <= lines.len() {
        return Ok(());
    }
    // what comes before a line and before its row, and the first line that parted them
    let (mut named, mut passed, mut odd) = (0, 0, None);
    for (line, (&names, &cells)) in both().enumerate() {
        if named == passed {
            odd = (names != cells).then_some((line, names, cells));
        } else if let Some((line, names, cells)) = odd.filter(|_| names == cells) {
            return Err(Fault::Line {
                order,
                line: line + 1,
                names,
                cells,
            });
        }
        (named, passed) = (named + names, passed + cells);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The line that shifts those after it, from 1, and how many names it has.
    fn slip(lines: &[usize], rows: &[usize]) -> Option<(usize, usize)> {
        match check(lines, (Order::Rows, rows)) {
            Err(Fault::Line { line, names, .. }) => Some((line, names)),
            _ => None,
        }
    }

    #[test]
    fn a_line_that_shifts_others_is_told() {
        assert_eq!(slip(&[8, 7, 8, 8], &[8; 4]), Some((2, 7)));
        assert_eq!(slip(&[8, 8, 9, 8], &[8; 5]), Some((3, 9)));
        // rows of a page of boxes need not be equally long
        assert_eq!(slip(&[4, 6, 4, 6], &[5, 6, 4, 6]), Some((1, 4)));
    }

    #[test]
    fn names_that_stand_in_their_cells_are_not() {
        assert_eq!(slip(&[8, 8, 8, 5], &[8; 4]), None);
        assert_eq!(slip(&[8, 8], &[8; 4]), None);
        // what one line lacks the next one has
        assert_eq!(slip(&[8, 7, 9, 8, 8], &[8; 5]), None);
    }

    #[test]
    fn lines_that_are_no_rows_say_nothing() {
        assert_eq!(slip(&[20, 8, 20, 8], &[14; 4]), None);
        assert_eq!(slip(&[7, 8, 7], &[8; 4]), None);
        assert_eq!(slip(&[8, 7, 8, 8, 8], &[8; 4]), None);
        assert_eq!(slip(&[40], &[8; 5]), None);
        assert_eq!(slip(&[], &[]), None);
    }
}
