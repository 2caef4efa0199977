//! Local ink and paper levels: the grey of a scan becomes coverage, so that half is half everywhere.

use crate::{
    numeric::levels::{dilated, normalised},
    types::Gray,
};

/// A pixel is sure when all within this distance are of its kind, px: a lens' blur ends there.
const MARGIN: usize = 2;

/// The picture's coverage: at each pixel, where its grey lies between the paper's and the ink's around it.
///
/// A level is the Gaussian mean of the pixels that are surely ink or paper; strokes too thin to have any
/// take the level of the whole picture.
#[must_use]
pub fn level(gray: &Gray) -> Gray {
    let w = gray.width();
    let ink: Vec<bool> = gray.samples().iter().map(|&v| v >= 0.5).collect();
    let paper: Vec<bool> = ink.iter().map(|b| !b).collect();
    let (near_ink, near_paper) = (dilated(&ink, w, MARGIN), dilated(&paper, w, MARGIN));
    // what is neither surely ink nor surely paper tells nothing
    let model = |(ink, paper): (&bool, &bool)| match (ink, paper) {
        (true, true) => 0.5,
        (true, false) => 1.0,
        _ => 0.0,
    };
    let model: Vec<f32> = near_ink.iter().zip(&near_paper).map(model).collect();
    gray.with_samples(normalised(gray.samples(), w, &model))
}
