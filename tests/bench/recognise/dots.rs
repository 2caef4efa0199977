//! Letters that nothing but dots tells apart, over fonts and resolutions.

#[path = "../../common/dots.rs"]
mod dotted;

use super::{Outcome, letters, stem};

/// Px an em.
const SIZES: [f64; 3] = [40.0, 75.0, 150.0];

/// Prints the pairs that are taken for each other.
pub(super) fn run(font: &str) -> Outcome {
    let wanted = dotted::GROUPS
        .iter()
        .flat_map(|g| g.chars().map(String::from));
    let drawn = letters(font, wanted)?;
    for size in SIZES {
        let told = dotted::compare(&drawn, size);
        println!(
            "{} at {size} px an em: {} pairs, alike in their skeletons: {}; misread: {}",
            stem(font),
            told.pairs,
            told.alike.join(" "),
            told.misread.join(" ")
        );
    }
    Ok(())
}
