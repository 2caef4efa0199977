//! Every citation names a paper of the bibliography, and every paper of it is cited.

use crate::layers::sources;
use std::collections::BTreeSet;

fn keys() -> BTreeSet<String> {
    include_str!("../src/papers.md")
        .lines()
        .filter_map(|l| l.strip_prefix("| `")?.split('`').next().map(str::to_owned))
        .collect()
}

/// `key` of every `[key place]` in the text; a key is lower case letters and digits.
fn cited(text: &str) -> impl Iterator<Item = &str> {
    text.split('[').skip(1).filter_map(|t| {
        let (key, place) = t.split_once(' ')?;
        let word = !key.is_empty()
            && key
                .chars()
                .all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
            && key.starts_with(|c: char| c.is_ascii_lowercase());
        let placed = [
            "sec.", "eq.", "alg.", "fig.", "table", "ch.", "p.", "lemma", "phase",
        ];
        (word && placed.iter().any(|p| place.starts_with(p))).then_some(key)
    })
}

#[test]
fn every_citation_is_in_the_bibliography() {
    let keys = keys();
    assert!(keys.len() >= 5, "the bibliography lost papers");
    for (path, text) in sources() {
        for key in cited(&text) {
            assert!(
                keys.contains(key),
                "{path} cites [{key} …], which papers.md does not list"
            );
        }
    }
}

#[test]
fn a_citation_is_recognised() {
    let found: Vec<_> = cited("x [sohel sec. 2, eq. 9] y[0] [a b] [lumilios93 eq. 11]").collect();
    assert_eq!(found, ["sohel", "lumilios93"]);
}
