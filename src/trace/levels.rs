//! Local ink and paper levels: the grey of a scan becomes coverage, so that half is half everywhere.

use super::{ink, thin};
use crate::{
    numeric::{
        cast::single,
        levels::{dilated, normalised},
    },
    types::Gray,
};

/// A pixel is sure when all within this distance are of its kind, px: a lens' blur ends there.
const MARGIN: usize = 2;

/// Ink and paper that differ by less are not looked at for thin lines.
const CONTRAST: f32 = 0.2;
/// A pixel's kind; near both it is neither's.
const INK: u8 = 1;
const PAPER: u8 = 2;
/// What tells neither level.
const UNTOLD: f32 = 0.5;

/// The picture's coverage: at each pixel, where its grey lies between the paper's and the ink's around it.
///
/// A level is the Gaussian mean of the pixels that are surely ink or paper; strokes too thin to have any
/// take the level of the whole picture, and where all are too thin the one that their shape tells.
#[must_use]
pub fn level(gray: &Gray) -> Gray {
    let w = gray.width();
    let kind = |v: &f32| if *v >= 0.5 { INK } else { PAPER };
    let kinds: Vec<u8> = gray.samples().iter().map(kind).collect();
    // what is neither surely ink nor surely paper tells nothing
    let model = |near: u8| match near {
        INK => 1.0,
        PAPER => 0.0,
        _ => UNTOLD,
    };
    let near = dilated(&kinds, w, MARGIN).into_iter();
    let mut model: Vec<f32> = near.map(model).collect();
    // thin lines on sure paper would pass for paper, and slits for ink
    let paper = mean(gray, &model, |m| m < UNTOLD);
    let ink = mean(gray, &model, |m| m > UNTOLD);
    if let (Some(paper), Some(ink)) = (paper, ink)
        && ink - paper >= CONTRAST
        && let Some(thin) = thin::beside(gray, [paper, ink])
    {
        let beside = model.iter_mut().zip(thin).filter(|(_, thin)| *thin);
        beside.for_each(|(model, _)| *model = UNTOLD);
    }
    let coverage = gray.with_samples(normalised(gray.samples(), w, &model));
    let untold = paper.is_some() && ink.is_none();
    let Some(ink) = untold.then(|| ink::level(&coverage)).flatten() else {
        return coverage;
    };
    let darker = coverage.samples().iter().map(|v| v / single(ink));
    coverage.with_samples(darker.collect())
}

/// The mean of the samples whose model is `sure`.
fn mean(gray: &Gray, model: &[f32], sure: impl Fn(f32) -> bool) -> Option<f32> {
    let pairs = gray.samples().iter().zip(model);
    let own = pairs.filter(|(_, m)| sure(**m)).map(|(v, _)| f64::from(*v));
    let (sum, count) = own.fold((0.0, 0.0), |(sum, n), v| (sum + v, n + 1.0));
    (count > 0.0).then(|| single(sum / count))
}
