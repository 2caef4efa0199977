//! Local ink and paper levels: the grey of a scan becomes coverage, so that half is half everywhere.

use crate::{numeric::levels::normalised, types::Gray};

/// A pixel is sure when all within this distance are of its kind, px: a lens' blur ends there.
const MARGIN: usize = 2;

/// The picture's coverage: at each pixel, where its grey lies between the paper's and the ink's around it.
///
/// A level is the Gaussian mean of the pixels that are surely ink or paper; strokes too thin to have any
/// take the level of the whole picture.
#[must_use]
pub fn level(gray: &Gray) -> Gray {
    let (w, h) = (gray.width(), gray.height());
    let ink: Vec<bool> = gray.samples().iter().map(|&v| v >= 0.5).collect();
    let paper: Vec<bool> = ink.iter().map(|b| !b).collect();
    let (ink, paper) = (eroded(&ink, w, h), eroded(&paper, w, h));
    let values = normalised(gray.samples(), w, |i| {
        let v = gray.samples()[i];
        let one = |sure: bool| if sure { [v, 1.0] } else { [0.0, 0.0] };
        let ([a, b], [c, d]) = (one(ink[i]), one(paper[i]));
        [a, b, c, d]
    });
    Gray::from_fn(w, h, |x, y| values[y * w + x])
}

/// Pixels whose whole square of 2·[`MARGIN`] + 1 px, as far as it lies in the picture, is set.
fn eroded(bits: &[bool], w: usize, h: usize) -> Vec<bool> {
    let mut across = bits.to_vec();
    for (to, from) in across
        .chunks_exact_mut(w.max(1))
        .zip(bits.chunks_exact(w.max(1)))
    {
        for d in 1..=MARGIN.min(w) {
            to[d..].iter_mut().zip(from).for_each(|(t, f)| *t &= f);
            to.iter_mut().zip(&from[d..]).for_each(|(t, f)| *t &= f);
        }
    }
    let mut out = across.clone();
    for d in 1..=MARGIN.min(h) {
        out[d * w..]
            .iter_mut()
            .zip(&across)
            .for_each(|(t, f)| *t &= f);
        out.iter_mut()
            .zip(&across[d * w..])
            .for_each(|(t, f)| *t &= f);
    }
    out
}
