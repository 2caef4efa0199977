//! Whether ink is as grainy as a pencil's.

use super::Warning;
use crate::numeric::median::range;
use crate::scan::clean::Page;
use crate::scan::grain::InkGrain;
use crate::types::Gray;

/// Levels of ink and those below what is surely ink, coverage.
const INK: f32 = 0.25;
const GREY: f32 = 0.75;
/// No paper lies within two pixels where nothing is lighter.
const PAPER: f32 = 0.12;
/// A pixel and its eight neighbours differ at least so much where ink has grain.
const ROUGH: f32 = 0.25;
/// Part of the ink that may be grey and rough far from any edge: of 127 pages of even ink none has more than 0.04,
/// those of a ballpoint that is pale in places 0.08 to 0.1, those of pencil 0.2 and more.
const MOST: f32 = 0.12;

impl Warning {
    /// What is to be said of a page whose ink was averaged over so many px.
    pub(crate) fn of_averaged(px: f64) -> Self {
        Self::of_page(format!(
            "the ink is grain, as of a pencil or a dry brush: it was averaged over {px:.1} px; grain = \"keep\" \
             under [[sheet]] has it followed instead, which takes long"
        ))
    }
}

/// A remark on a page whose ink is grain that is finer than its strokes: that it was averaged, or is followed.
pub(super) fn warning(page: &Page) -> Option<Warning> {
    if page.averaged_px > 0.0 {
        return Some(Warning::of_averaged(page.averaged_px));
    }
    let counts = |x, y| page.paper().is_none_or(|p| p.holds(x, y));
    followed(&page.sheet.gray, counts, page.texture.grain).map(Warning::of_page)
}

/// What is said of a page, paper 0 and ink 1, much of whose ink is grain that outlines follow: that of the pixels that
/// count, not a table's.
fn followed(gray: &Gray, counts: impl Fn(usize, usize) -> bool, grain: InkGrain) -> Option<String> {
    let share = share(gray, counts);
    let ours = match grain {
        InkGrain::Soften => "",
        InkGrain::Keep => "write grain = \"soften\" under [[sheet]]; where that finds no grain, ",
    };
    (share > MOST).then(|| {
        format!(
            "{:.0} % of the ink is grey grain, as of a pencil or a dry brush, and outlines follow it, which takes \
             long: {ours}soften the picture by some pixels in an image editor, or go over the letters in ink",
            100.0 * share
        )
    })
}

/// The part of the ink that is grey and rough, and no edge, of the pixels that count.
fn share(gray: &Gray, counts: impl Fn(usize, usize) -> bool) -> f32 {
    let (mut inked, mut grainy) = (0_usize, 0_usize);
    for y in 2..gray.height().saturating_sub(2) {
        let rows = [y - 2, y - 1, y, y + 1, y + 2].map(|y| gray.row(y));
        for x in 2..rows[2].len().saturating_sub(2) {
            let v = rows[2][x];
            if v >= INK && counts(x, y) {
                inked += 1;
                grainy += usize::from(v < GREY && is_grain(rows, x));
            }
        }
    }
    grainy as f32 / inked.max(1) as f32
}

/// Whether the pixel in the middle of the rows has no paper near, and differs from its neighbours.
fn is_grain(rows: [&[f32]; 5], x: usize) -> bool {
    let mut near = rows.iter().flat_map(|row| &row[x - 2..=x + 2]);
    let beside = rows[1..4].iter().flat_map(|row| &row[x - 1..=x + 1]);
    let (least, most) = range(beside);
    most - least > ROUGH && near.all(|v| *v > PAPER)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::coverage::blur;

    /// A page of bars, 12 px thick, whose ink has levels as said, under a lens.
    fn bars(mut level: impl FnMut() -> f32) -> Gray {
        let mut samples = vec![0.0; 400 * 300];
        for (i, v) in samples.iter_mut().enumerate() {
            if (i / 400) % 40 < 12 {
                *v = level();
            }
        }
        blur(&mut samples, 400, 0.6, 0);
        Gray::new(400, 300, samples).unwrap()
    }

    #[test]
    fn pencil_is_told_and_ink_is_not() {
        let mut seed = 1_u32;
        let mut noise = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 16) as f32 / 65_536.0
        };
        let pencil = bars(|| if noise() < 0.4 { 0.2 } else { 1.0 });
        for (grain, names_it) in [(InkGrain::Soften, false), (InkGrain::Keep, true)] {
            let told = followed(&pencil, |_, _| true, grain).expect("grain");
            assert!(told.contains("grey grain"), "{told}");
            assert_eq!(told.contains("grain = \"soften\""), names_it, "{told}");
        }
        let followed = |gray: &Gray| followed(gray, |_, _| true, InkGrain::Keep);
        assert!(
            followed(&bars(|| 0.85 + 0.3 * noise())).is_none(),
            "the grain of paper"
        );
        for level in [1.0, 0.6] {
            assert!(followed(&bars(|| level)).is_none(), "{level}");
        }
        assert!(followed(&Gray::new(0, 0, Vec::new()).unwrap()).is_none());
    }
}
