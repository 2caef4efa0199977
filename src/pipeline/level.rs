//! Letters that were drawn off the baseline as a whole: moved back, which joining strokes tell.

use super::corrections::Corrections;
use super::letter::{Letter, placed};
use super::problem::Problem;
use super::project::Project;
use crate::assemble::{Note, level};
use std::collections::BTreeMap;

/// Moves of more than this are reported, em: two thirds of what a joining stroke is moved at most.
const FAR: f64 = 0.02;

/// Moves the baselines of letters to where their joining strokes say that they are, but those that a user has moved.
///
/// # Errors
/// A letter is no outline, its label names no glyph, or two have one name.
pub(super) fn set(
    letters: &mut [Letter],
    project: &Project,
    corrections: &Corrections,
) -> Result<Vec<Note>, Vec<Problem>> {
    let drawn = placed(letters, project.font.units_per_em)?;
    let em = f64::from(project.font.units_per_em);
    let rows = rows(letters);
    let strays = level::strays(&drawn, &rows, em, &project.spacing.joining);
    let mut notes = Vec::new();
    for (letter, stray) in letters.iter_mut().zip(strays.map_err(|e| vec![e.into()])?) {
        if corrections.moves(&letter.label) {
            continue;
        }
        letter.guides.baseline_px -= stray / em * letter.guides.px_per_em;
        if stray.abs() > FAR * em {
            let (far, way, back) = if stray > 0.0 {
                (stray, "high", "down")
            } else {
                (-stray, "low", "up")
            };
            notes.push(Note {
                glyph: letter.label.0.clone(),
                message: format!(
                    "its joining strokes say that it was drawn {far:.0} units too {way}, and it was moved {back}; `baseline_shift` of its [cells] table says better"
                ),
            });
        }
    }
    Ok(notes)
}

/// The same number for the letters of one row of one page, each its own where no row gave the baseline.
fn rows(letters: &[Letter]) -> Vec<usize> {
    let mut first = BTreeMap::new();
    let own = letters.iter().enumerate().map(|(i, letter)| {
        let row = letter
            .guides
            .row
            .map(|row| (letter.table, &letter.sheet, row));
        row.map_or(i, |row| *first.entry(row).or_insert(i))
    });
    own.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::{Gray, Guides, Label, Png};
    use kurbo::Rect;

    #[test]
    fn rows_of_two_tables_of_one_page_are_two() {
        let letter = |table: usize| Letter {
            sheet: "page.png".to_owned(),
            table,
            label: Label("l".to_owned()),
            index: 0,
            picture: Png::of(&Gray::from_fn(1, 1, |_, _| 1.0)),
            in_sheet: Rect::ZERO,
            guides: Guides {
                baseline_px: 1.0,
                px_per_em: 1.0,
                row: Some(0),
            },
            edge: Vec::new(),
            paths: Vec::new(),
            plates: Vec::new(),
            filled: false,
        };
        assert_eq!(rows(&[0, 0, 1, 1].map(letter)), [0, 0, 2, 2]);
    }
}
