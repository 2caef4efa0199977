//! Where the joining strokes of Arabic letters end.

use crate::numeric::surface::Surface;
use crate::scan::components::Component;
use kurbo::Point;

/// The outermost ink that counts as a stroke's end, in widths of the letter's stroke.
const END: f64 = 0.5;
/// Height of a joining stroke's end at most, in the same: what reaches higher is a stem, and leans over the stroke
/// where letters slant.
const THICK: f64 = 1.6;

/// Heights of the ends of a letter's strokes on its left and on its right where these are `joined` to others, upright
/// px.
pub(super) fn joins(letter: &Component, joined: [bool; 2], upright: &Surface) -> Vec<f64> {
    let sides = [1.0, -1.0].into_iter().zip(joined);
    let sides = sides.filter_map(|(side, joined)| joined.then_some(side));
    sides.filter_map(|s| end(letter, s, upright)).collect()
}

/// The middle height of the outermost ink; `side` times x grows inwards.
fn end(letter: &Component, side: f64, upright: &Surface) -> Option<f64> {
    let at = |x: usize, y: usize| upright.at(Point::new(x as f64 + 0.5, y as f64 + 0.5));
    let inward = |x: usize, y: usize| side * at(x, y).x;
    let outer = letter.runs.iter().map(|r| {
        let (a, b) = (inward(r.start, r.y), inward(r.end - 1, r.y));
        a.min(b)
    });
    let stroke = letter.stroke();
    let limit = outer.clone().reduce(f64::min)? + END * stroke;
    let near = letter.runs.iter().zip(outer).filter(|r| r.1 < limit);
    let pixels = near.flat_map(|(r, _)| r.pixels());
    let heights = pixels.filter(|&(x, y)| inward(x, y) < limit);
    let heights: Vec<f64> = heights.map(|(x, y)| at(x, y).y).collect();
    let top = heights.iter().copied().reduce(f64::min)?;
    let foot = heights.iter().copied().reduce(f64::max)?;
    let is_end = foot - top + 1.0 <= THICK * stroke;
    is_end.then(|| heights.iter().sum::<f64>() / heights.len() as f64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::components::components;
    use crate::types::Gray;
    use kurbo::Affine;

    #[test]
    fn strokes_end_at_their_own_heights_on_both_sides() {
        // a stem, with a stroke 6 px thick to the left at 30 to 36 px and one to the right at 40 to 46
        let ink = |x: usize, y: usize| match x {
            10..30 => (30..36).contains(&y),
            30..36 => (10..60).contains(&y),
            36..56 => (40..46).contains(&y),
            _ => false,
        };
        let pixels = (0..70 * 70).map(|i| f32::from(u8::from(ink(i % 70, i / 70))));
        let gray = Gray::new(70, 70, pixels.collect()).unwrap();
        let letter = &components(&gray, 0.33, 0.5)[0];
        let view = Surface::from(Affine::IDENTITY);
        let at = |joined| joins(letter, joined, &view);
        assert_eq!(at([true, true]), [33.0, 43.0]);
        assert_eq!(at([false, true]), [43.0]);
        assert!(at([false, false]).is_empty());
        let lower = Surface::from(Affine::translate((0.0, 100.0)));
        assert_eq!(joins(letter, [true, false], &lower), [133.0]);
    }

    #[test]
    fn a_stem_that_leans_over_its_stroke_is_no_end() {
        // a stem that leans to the right by a fifth, and a stroke to the right that it hides
        let ink = |x: usize, y: usize| {
            let lean = (70 - y) / 5;
            (20 + lean..27 + lean).contains(&x) && y > 8 || (20..34).contains(&x) && y > 62
        };
        let pixels = (0..70 * 70).map(|i| f32::from(u8::from(ink(i % 70, i / 70))));
        let gray = Gray::new(70, 70, pixels.collect()).unwrap();
        let letter = &components(&gray, 0.33, 0.5)[0];
        let view = Surface::from(Affine::IDENTITY);
        assert!(joins(letter, [false, true], &view).is_empty());
    }
}
