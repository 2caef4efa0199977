//! Bare pages whose names stand in lines like the page's rows.

use super::*;

const NAMES: &str = "_ _ _ _ _ n l n n period l n n l n";

/// Where their letters begin from the left.
const PLACES: [f64; 10] = [
    60.0, 155.0, 250.0, 345.0, 375.0, 60.0, 155.0, 250.0, 345.0, 440.0,
];

/// Letters in rows, with a dot beside the third one of the first row.
fn dotted(rows: [&str; 3]) -> Paper {
    let mut paper = Paper::new(640, 420, 0.0);
    for (row, letters) in rows.iter().enumerate() {
        for (i, c) in letters.chars().enumerate() {
            paper.letter(c, 60.0 + 95.0 * i as f64, 90.0 + 100.0 * row as f64);
        }
    }
    paper.bar(264.0, 32.0, 9.0, 9.0);
    paper
}

/// The last one of the second row is a period that lies nearer to the letter before it than the dot does to its own.
fn period() -> Paper {
    let mut paper = dotted(["nnlnn", "nlnn", "lnnln"]);
    paper.bar(375.0, 177.0, 9.0, 9.0);
    paper
}

/// Where each letter begins from the left, if names stand in lines of so many.
fn places(paper: &Paper, names: &str, lines: &[usize]) -> Result<Vec<f64>, String> {
    let options = Options {
        lines: lines.to_vec(),
        ..options(Layout::Free)
    };
    let cut = cut_page(paper, names, &options).map_err(|e| e.to_string())?;
    Ok(cut.cells.iter().map(|c| c.in_sheet.x0.round()).collect())
}

#[test]
fn lines_of_names_say_what_is_a_letter() {
    assert_eq!(places(&period(), NAMES, &[5; 3]).unwrap(), PLACES);
    // written in one line, or wrapped anywhere
    for lines in [&[][..], &[15], &[6, 9]] {
        let places = places(&period(), NAMES, lines);
        assert_ne!(places.unwrap(), PLACES, "{lines:?}");
    }
}

#[test]
fn lines_of_names_say_in_which_row_one_is_missing() {
    let mut paper = period();
    paper.letter('n', 535.0, 290.0);
    let told = places(&paper, NAMES, &[5; 3]).unwrap_err();
    let of_row = "one of letters 1 to 6 of row 3 seems to have no name";
    assert!(told.contains(of_row), "{told}");
}

#[test]
fn lines_of_names_say_that_letters_of_two_rows_touch() {
    let mut paper = dotted(["nnlnn", "nlnnl", "lnnln"]);
    paper.bar(256.0, 185.0, 6.0, 80.0);
    let found = places(&paper, "_ _ _ _ _ n l n n l l n n l n", &[5; 3]);
    let five = [60.0, 155.0, 250.0, 345.0, 440.0];
    assert_eq!(found.unwrap(), five.repeat(2));
}
