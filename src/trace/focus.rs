//! Pictures out of focus: where a lens, a blunt scanner or an enlargement has spread an edge over many pixels, fewer
//! pixels hold all that there is to see, and what follows looks at edges of a pixel or two.

use super::{Options, level, trace};
use crate::numeric::cast::{index, single};
use crate::types::{Contour, Gray};
use kurbo::Affine;

/// The blur that edges keep, px, its standard deviation: with half of it pixels hide where they lie, and with twice
/// as much what is beside a corner counts as part of it.
const LEAST_PX: f64 = 0.9;
/// A blur that [`trace()`] measures as so much or more, px, may be larger: the band that it looks at is too narrow.
pub const WIDE_PX: f64 = 1.55;
/// Pixels a side that a picture keeps at least.
const LEAST_SIDE: usize = 16;

/// Standard deviation of the blur of a picture's edges, px, of which [`trace()`] measures `seen_px`: where that is
/// wide, what it is in smaller pictures of the same.
#[must_use]
pub fn spread_px(gray: &Gray, seen_px: f64) -> f64 {
    let most = largest(gray);
    let (mut side, mut blur) = (1, seen_px);
    while blur >= WIDE_PX && 2 * side <= most {
        side *= 2;
        let small = enlarged(gray, side);
        let contours = trace(&level(&small), &Options::default());
        blur = contours.first().map_or(0.0, Contour::blur_px);
    }
    blur * side as f64
}

/// The picture in larger pixels, where its edges are blurred by more than they need, and how many of its pixels a
/// side make one; `None` of a picture in focus. `seen_px` is the blur that [`trace()`] measured.
///
/// Both pictures have their bottom left corner in one place.
#[must_use]
pub fn focused(gray: &Gray, seen_px: f64) -> Option<(Gray, usize)> {
    let side = index(spread_px(gray, seen_px) / LEAST_PX).min(largest(gray));
    (side > 1).then(|| (enlarged(gray, side), side))
}

/// How many pixels of a picture may make one.
fn largest(gray: &Gray) -> usize {
    gray.width().min(gray.height()) / LEAST_SIDE
}

/// The means of squares of `side` pixels, counted from the bottom left; the last ones are means of what there is.
fn enlarged(gray: &Gray, side: usize) -> Gray {
    let (w, h) = (gray.width(), gray.height());
    let (width, height) = (w.div_ceil(side), h.div_ceil(side));
    let mean = |x: usize, y: usize| {
        let columns = x * side..((x + 1) * side).min(w);
        let bottom = h - (height - 1 - y) * side;
        let rows = bottom.saturating_sub(side)..bottom;
        let count = single((rows.len() * columns.len()) as f64);
        let sum: f32 = rows.flat_map(|y| &gray.row(y)[columns.clone()]).sum();
        sum / count
    };
    let scale = Affine::scale(side as f64);
    Gray::from_fn(width, height, mean)
        .with_scatter(gray.scatter_px() / side as f64)
        .with_upright(scale.inverse() * gray.upright() * scale)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::coverage::{Coverage, blur};
    use kurbo::Point;

    /// A square, its sides aslant, under a lens of `sigma` px.
    fn blurred(sigma: f64, (width, height): (usize, usize)) -> Gray {
        let mut picture = Coverage::new(width, height);
        let at = |x, y| Point::new(x, y);
        picture.add(&[
            at(70.3, 50.1),
            at(190.2, 61.7),
            at(178.6, 181.6),
            at(58.7, 170.0),
        ]);
        let mut samples = picture.samples();
        blur(&mut samples, width, sigma, 0);
        Gray::new(width, height, samples).expect("samples of a coverage")
    }

    fn focus(gray: &Gray) -> Option<(Gray, usize)> {
        focused(gray, trace(&level(gray), &Options::default())[0].blur_px())
    }

    #[test]
    fn edges_keep_a_blur_of_about_a_pixel() {
        for sigma in [0.0, 0.9, 1.5] {
            let seen = focus(&blurred(sigma, (250, 240)));
            assert!(seen.is_none(), "a blur of {sigma} px");
        }
        for sigma in [2.1, 2.6, 3.2, 4.2, 5.3, 6.3] {
            let (_, side) = focus(&blurred(sigma, (250, 240))).expect("a picture out of focus");
            let kept = sigma / side as f64;
            assert!(
                (0.85..1.65).contains(&kept),
                "{kept} of a blur of {sigma} px"
            );
        }
    }

    #[test]
    fn what_is_drawn_stays_in_its_place() {
        // sides that no factor divides
        for size in [(250, 240), (251, 239), (253, 241)] {
            let (small, side) = focus(&blurred(4.2, size)).expect("a picture out of focus");
            assert_eq!(
                (small.width(), small.height()),
                (size.0.div_ceil(side), size.1.div_ceil(side))
            );
            let edge = &trace(&level(&small), &Options::default())[0];
            let middle = edge
                .points()
                .iter()
                .fold(Point::ZERO, |sum, p| sum + p.to_vec2());
            let middle = middle.to_vec2() * side as f64 / edge.points().len() as f64;
            let off = middle.to_point().distance(Point::new(124.45, 115.85));
            assert!(off < 0.1, "{size:?}: {off}");
        }
    }

    #[test]
    fn small_pictures_keep_their_pixels() {
        let dot = |side: usize| {
            Gray::from_fn(side, side, |x, y| {
                let middle = side as f64 / 2.0 - 0.5;
                let off = (x as f64 - middle).hypot(y as f64 - middle);
                single(libm::exp(-0.5 * (off / 4.0).powi(2)))
            })
        };
        assert!(focus(&dot(31)).is_none());
        let (small, side) = focus(&dot(40)).expect("a blot");
        assert_eq!((small.width(), side), (20, 2));
        assert!(focused(&Gray::from_fn(0, 0, |_, _| 0.0), 9.0).is_none());
    }
}
