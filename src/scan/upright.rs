//! A letter on the scanner's pixels as it stands upright, for people and for comparisons.

use crate::numeric::lanczos::Lanczos;
use crate::types::Gray;
use kurbo::{Affine, Point};
use std::borrow::Cow;

/// The picture with its drawing upright, interpolated where the drawing lies askew on its pixels ([`Gray::upright`]).
#[must_use]
pub fn upright(gray: &Gray) -> Cow<'_, Gray> {
    let to_picture = gray.to_pixels();
    if gray.upright() == Affine::IDENTITY {
        return Cow::Borrowed(gray);
    }
    let (w, h, kernel) = (gray.width(), gray.height(), Lanczos::default());
    let height = h as f64;
    let at = |x: usize, y: usize| {
        let p = to_picture * Point::new(x as f64 + 0.5, height - y as f64 - 0.5);
        kernel.sample(gray.samples(), w, (p.x - 0.5, height - p.y - 0.5))
    };
    Cow::Owned(Gray::from_fn(w, h, at).with_scatter(gray.scatter_px()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::angles;
    use crate::numeric::cast::single;

    #[test]
    fn what_lies_askew_comes_out_upright() {
        // a bell, wider than high, above the middle
        let bell =
            |p: Point| libm::exp(-((p.x - 28.0) / 6.0).powi(2) - ((p.y - 22.0) / 3.0).powi(2));
        let (w, h) = (50, 40);
        for turn in [0.0_f64, 1.0, -20.0, 90.0] {
            let turn = angles::rotation_about(turn.to_radians(), (25.0, 20.0));
            let place = |x: usize, y: usize| Point::new(x as f64 + 0.5, 39.5 - y as f64);
            let askew = Gray::from_fn(w, h, |x, y| single(bell(turn * place(x, y))));
            let askew = askew.with_upright(turn);
            let found = upright(&askew);
            for (y, x) in (8..32).flat_map(|y| (8..42).map(move |x| (y, x))) {
                let off = f64::from(found.at(x, y)) - bell(place(x, y));
                assert!(off.abs() < 0.005, "{off} at {x}, {y}");
            }
        }
    }
}
