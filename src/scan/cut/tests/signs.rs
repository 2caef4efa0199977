//! Letters whose signs are not as many as their names have.

use super::*;

/// Letters on a grid of one row, each with signs so wide over its body, and the cells that are warned of for their
/// signs.
fn warned(letters: &[(&str, &[f64])]) -> Vec<usize> {
    let n = letters.len();
    let mut paper = Paper::new(120 * n + 60, 260, 0.0);
    for (i, (_, signs)) in letters.iter().enumerate() {
        let x = 70.0 + 120.0 * i as f64;
        paper.letter('n', x, 160.0);
        let mut at = x - 4.0;
        for wide in *signs {
            paper.bar(at, 112.0, *wide, 9.0);
            at += wide + 5.0;
        }
    }
    let names: Vec<&str> = letters.iter().map(|l| l.0).collect();
    let cut = cut_page(&paper, &names.join(" "), &options(Layout::Grid(1, n))).unwrap();
    let of_signs = |w: &&Warning| w.message.contains("beside its body");
    let warned = cut.warnings.iter().filter(of_signs);
    warned.filter_map(|w| w.index).collect()
}

#[test]
fn a_letter_with_fewer_or_more_signs_than_its_like_is_warned_of() {
    const DOT: &[f64] = &[9.0];
    const TWO: &[f64] = &[9.0, 9.0];
    const THREE: &[f64] = &[9.0, 9.0, 9.0];
    const TORN: &[f64] = &[9.0, 9.0, 24.0];
    const DASH: &[f64] = &[20.0];
    type Page = &'static [(&'static str, &'static [f64])];
    let pages: [(Page, &[usize], &str); 8] = [
        (
            &[("ت", TWO), ("ت", TWO), ("ق", TWO), ("ي", TWO), ("ح", &[])],
            &[],
            "all as named",
        ),
        (
            &[("ت", TWO), ("ت", TWO), ("ق", TWO), ("ق", TWO), ("ي", DOT)],
            &[4],
            "one of two",
        ),
        (
            &[("ت", TWO), ("ت", THREE), ("ت", TWO), ("ق", TWO), ("ق", TWO)],
            &[1],
            "three of two",
        ),
        (
            &[
                ("ت", DASH),
                ("ت", DASH),
                ("ق", DASH),
                ("ق", DASH),
                ("ق", &[]),
            ],
            &[4],
            "none of one dash",
        ),
        (
            &[("ت", TWO), ("ت", TWO), ("ق", TWO), ("ق", TWO), ("ي", DASH)],
            &[],
            "a dash is two dots",
        ),
        (
            &[("أ", DOT), ("أ", DOT), ("ئ", DOT), ("ؤ", DOT), ("ؤ", &[])],
            &[4],
            "a hamza that is gone",
        ),
        (
            &[("ت", TWO), ("ت", TORN), ("ق", TWO), ("ق", TWO), ("ق", TWO)],
            &[],
            "a piece of the body is no dot",
        ),
        (
            &[("ت", TWO), ("ت", TWO), ("ق", TWO), ("ق", DOT), ("ي", &[])],
            &[],
            "a hand that has no rule",
        ),
    ];
    for (letters, wanted, why) in pages {
        assert_eq!(warned(letters), wanted, "{why}");
    }
}
