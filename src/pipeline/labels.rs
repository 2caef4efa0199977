//! The text of a project's `glyphs` → a label for each cell, checked before any page is read.

use super::problem::{Place, Problem, all, unless};
use super::project::{Content, Labels, Layout, Project, SheetTable};
use super::repeats::Repeated;
use super::world::World;
use crate::assemble::names;
use crate::types::{Label, Name};
use std::collections::BTreeMap;
use unicode_normalization::char::is_combining_mark;

/// The word that skips a cell.
pub(super) const SKIP: &str = "_";

/// The labels of a page in reading order.
fn labels(text: &str) -> Vec<Label> {
    let words = text.split_whitespace();
    words.map(|word| Label(word.to_owned())).collect()
}

/// Whether the label's cell is skipped.
pub(super) fn skips(label: &Label) -> bool {
    label.0 == SKIP
}

/// Whether the label's glyph is a space: nobody draws it.
pub(super) fn is_space(label: &Label) -> bool {
    names::identify(label).is_ok_and(|id| matches!(id.chars[..], [' ' | '\u{a0}']))
}

/// The labels of every page of a project, all of them known and none of them twice.
pub(super) fn of(project: &Project, world: World<'_>) -> Result<Vec<Vec<Label>>, Vec<Problem>> {
    let sheets = &project.sheets;
    let pages = all(sheets.iter().map(|s| of_sheet(s, world)).collect())?;
    let names: Vec<String> = sheets.iter().map(SheetTable::name).collect();
    let named = names.iter().map(String::as_str);
    let labels = named.zip(pages.iter().map(Vec::as_slice)).zip(sheets);
    let (words, letters): (Vec<_>, Vec<_>) =
        labels.partition(|(_, sheet)| sheet.content == Content::Words);
    let mut problems = check(letters.into_iter().map(|l| l.0));
    for ((name, words), sheet) in words {
        problems.extend(check_words(name, words));
        problems.extend(unscaled(sheet));
    }
    if project.repeated != Repeated::Error {
        problems.retain(|p| !matches!(p, Problem::Twice { .. }));
    }
    unless(problems, pages)
}

/// The labels as written.
pub(super) fn of_sheet(sheet: &SheetTable, world: World<'_>) -> Result<Vec<Label>, Problem> {
    Ok(labels(&text(sheet, world)?))
}

/// How many of them stand in each line that has any.
pub(super) fn lines(sheet: &SheetTable, world: World<'_>) -> Result<Vec<usize>, Problem> {
    let text = text(sheet, world)?;
    let lines = text.lines().map(|line| labels(line).len());
    Ok(lines.filter(|&n| n > 0).collect())
}

fn text(sheet: &SheetTable, world: World<'_>) -> Result<String, Problem> {
    match &sheet.glyphs {
        Labels::Text(text) => Ok(text.clone()),
        Labels::File { file } => {
            let bytes = world.file(file)?;
            let text = String::from_utf8_lossy(&bytes);
            // some editors put a byte order mark first
            Ok(text.trim_start_matches('\u{feff}').to_owned())
        }
    }
}

/// What is wrong with the labels of all pages: names that no list has, names that stand twice.
pub(super) fn check<'a>(sheets: impl Iterator<Item = (&'a str, &'a [Label])>) -> Vec<Problem> {
    let mut seen: BTreeMap<Name, Place> = BTreeMap::new();
    let mut problems = Vec::new();
    for (sheet, labels) in sheets {
        for (index, label) in labels.iter().enumerate() {
            if skips(label) {
                continue;
            }
            let place = Place::new(sheet, index, label);
            match names::identify(label) {
                Err(source) => problems.push(Problem::Label {
                    place,
                    source: Box::new(source),
                }),
                Ok(id) => match seen.get(&id.name) {
                    Some(first) => problems.push(Problem::Twice {
                        first: Box::new(first.clone()),
                        second: place,
                    }),
                    None => {
                        seen.insert(id.name, place);
                    }
                },
            }
        }
    }
    problems
}

/// A page of words without a scale: no height in them tells it.
fn unscaled(sheet: &SheetTable) -> Option<Problem> {
    let told =
        sheet.layout == Layout::Template || sheet.pixels_per_em.is_some() || sheet.em_mm.is_some();
    let why = "words do not tell how large the em is: write pixels_per_em or em_mm";
    (!told).then(|| Problem::sheet(sheet, why))
}

/// What is wrong with the words of a page.
fn check_words<'a>(sheet: &'a str, words: &'a [Label]) -> impl Iterator<Item = Problem> + 'a {
    let is_word = |word: &Label| {
        let letters = word.0.chars().filter(|c| c.is_alphabetic()).count();
        letters > 1 && (word.0.chars()).all(|c| c.is_alphabetic() || is_combining_mark(c))
    };
    let wrong = words.iter().enumerate();
    let wrong = wrong.filter(move |(_, word)| !skips(word) && !is_word(word));
    wrong.map(move |(i, word)| Problem::Sheet {
        sheet: sheet.to_owned(),
        why: format!(
            "word {} “{}” is none: content = \"words\" takes words of two letters or more, as they are read",
            i + 1,
            word.0
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_labels_and_a_lone_underscore_skips() {
        let read = labels(" A _\n beh-ar.init underscore\t_ ");
        let names: Vec<_> = read.iter().map(|l| (l.0.as_str(), skips(l))).collect();
        let want = [
            ("A", false),
            ("_", true),
            ("beh-ar.init", false),
            ("underscore", false),
            ("_", true),
        ];
        assert_eq!(names, want);
    }

    #[test]
    fn every_wrong_name_is_told_with_its_cell() {
        let (a, b) = (labels("A qqqqqqqq B"), labels("C A"));
        let problems = check([("a.png", a.as_slice()), ("b.png", b.as_slice())].into_iter());
        let text: Vec<String> = problems.iter().map(ToString::to_string).collect();
        assert_eq!(
            text,
            [
                "a.png, cell 2 “qqqqqqqq”: “qqqqqqqq” is no known glyph name",
                "b.png, cell 2 “A”: the name stands already for a.png, cell 1 “A”",
            ]
        );
    }
}
