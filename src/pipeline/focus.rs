//! Whether a page's letters are out of focus.

use super::letter::Letter;
use crate::numeric::median::median;
use crate::scan::Warning;
use crate::trace::{WIDE_PX, spread_px};
use crate::types::Contour;

/// A blur that a camera or scanner in focus does not make, px.
const SHARP_PX: f64 = 2.0;
/// The blur from which on serifs, small rounds and narrow gaps run into what is beside them, parts of the em.
const MUCH: f64 = 0.008;

/// What is to be said of a page most of whose letters are out of focus; nothing of one whose resolution alone is low.
pub(super) fn remark(letters: &[Letter]) -> Option<Warning> {
    let seen = |l: &Letter| l.edge.first().map(Contour::blur_px);
    if median(letters.iter().filter_map(seen))? < WIDE_PX {
        return None;
    }
    let blurs = letters.iter().filter_map(|l| {
        let px = spread_px(&l.picture.gray(), seen(l)?);
        Some((px, px / l.guides.px_per_em))
    });
    let (px, em): (Vec<f64>, Vec<f64>) = blurs.unzip();
    let (px, em) = (median(px)?, median(em)?);
    (px >= SHARP_PX && em >= MUCH).then(|| {
        Warning::of_page(format!(
            "the letters are out of focus: their edges are blurred by {px:.1} px, {:.0} thousandths of the em, and what is \
             smaller comes out round or is lost; take the picture again in focus, or scan the page",
            1000.0 * em
        ))
    })
}
