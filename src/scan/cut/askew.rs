//! Pixels of a picture around what lies askew on them.

use crate::numeric::surface::Surface;
use kurbo::{Affine, Point, Rect};
use std::f64::consts::SQRT_2;

/// Nothing by which a plane is turned or moved is as little, px a px and px.
const NOTHING: (f64, f64) = (1e-12, 1e-6);
/// A plane in perspective is taken for flat where that moves nothing by more, px.
const FLAT_PX: f64 = 0.02;
/// Lengths may differ from those of pixels by this part.
const STRETCH: f64 = 0.05;

/// Whole pixels of a picture, and how what is drawn on them stands upright.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Askew {
    /// The pixels, px of the picture, y down; they can reach beyond it.
    pub(super) pixels: Rect,
    /// From px of these to px of the upright drawing, both y up, the origin at the bottom left of each.
    pub(super) upright: Affine,
    /// From px of the upright drawing to those of the picture, both y down.
    pub(super) to_picture: Affine,
    /// Where the drawing's upper left corner is on the plane; it is as wide and as high as the pixels.
    pub(super) origin: Point,
}

impl Askew {
    /// Those around a rectangle of a plane, px, y down, that `view` takes to the picture. Nothing where perspective,
    /// or another scale than that of the pixels, would have to be undone.
    pub(super) fn around(window: Rect, view: &Surface) -> Option<Self> {
        let flat = view.near(window.center());
        let Rect { x0, y0, x1, y1 } = window;
        let corners = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)].map(Point::from);
        let straight = |p: &Point| view.at(*p).distance(flat * *p) <= FLAT_PX;
        let [a, b, c, d, ..] = flat.as_coeffs();
        let diagonal = (a + c).hypot(b + d) / SQRT_2;
        let mut lengths = [a.hypot(b), c.hypot(d), diagonal].into_iter();
        if !(lengths.all(|l| (l - 1.0).abs() <= STRETCH) && corners.iter().all(straight)) {
            return None;
        }
        let pixels = flat.transform_rect_bbox(window).inset(-NOTHING.1).expand();
        let half = pixels.size().to_vec2() / 2.0;
        let back = flat.inverse();
        // both have the same middle
        let origin = back * pixels.center() - half;
        let [a, b, c, d, ..] = back.as_coeffs();
        let off = [a - 1.0, b, c, d - 1.0];
        let upright = if off.iter().all(|v| v.abs() < NOTHING.0) {
            Affine::IDENTITY
        } else {
            let turn = Affine::new([a, -b, -c, d, 0.0, 0.0]);
            Affine::translate(half) * turn * Affine::translate(-half)
        };
        Some(Self {
            pixels,
            upright,
            to_picture: flat * Affine::translate(origin.to_vec2()),
            origin,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::angles;
    use crate::numeric::view::View;

    #[test]
    fn pixels_stand_where_the_plane_has_them() {
        let window = Rect::new(30.0, 40.0, 90.0, 70.0);
        let planes = [
            Affine::translate((7.0, -3.0)),
            Affine::translate((7.3, -3.6)),
            angles::rotation_about(0.02, (500.0, 900.0)),
            angles::rotation_about(-2.4, (50.0, 10.0)),
            Affine::new([1.02, 0.01, -0.02, 0.99, 5.5, 3.0]),
        ];
        for plane in planes {
            let askew = Askew::around(window, &Surface::from(plane)).expect("a flat plane");
            let (pixels, height) = (askew.pixels, askew.pixels.height());
            assert_eq!(pixels, pixels.round());
            let seen = plane.transform_rect_bbox(window);
            assert!(
                pixels.inflate(1e-6, 1e-6).contains_rect(seen),
                "{pixels:?} {seen:?}"
            );
            for (x, y) in [(0.5, 0.5), (17.5, 4.5), (33.5, 21.5)] {
                // a pixel's centre, in its drawing, on the plane and back in the picture
                let drawn = askew.upright * Point::new(x, height - y);
                let drawn = Point::new(drawn.x, height - drawn.y);
                let there = plane * (drawn + askew.origin.to_vec2());
                let off = there - (pixels.origin() + Point::new(x, y).to_vec2());
                assert!(off.hypot() < 1e-9, "{plane:?}: {off:?}");
                assert!((askew.to_picture * drawn).distance(there) < 1e-9);
            }
        }
        let whole = Askew::around(window, &Surface::from(planes[0])).map(|a| (a.upright, a.origin));
        assert_eq!(whole, Some((Affine::IDENTITY, window.origin())));
    }

    #[test]
    fn perspective_and_scale_are_not_hidden() {
        let window = Rect::new(0.0, 0.0, 100.0, 100.0);
        let tilted = |g: f64| Surface::from(View::of_pencils([1.0, 0.0, 0.0, 1.0, g, 0.0]));
        assert!(Askew::around(window, &tilted(1e-6)).is_some());
        assert!(Askew::around(window, &tilted(1e-4)).is_none());
        assert!(Askew::around(window, &Surface::from(Affine::scale(1.2))).is_none());
        let lean = Affine::new([1.0, 0.0, 0.2, 1.0, 0.0, 0.0]);
        assert!(Askew::around(window, &Surface::from(lean)).is_none());
        assert!(Askew::around(window, &tilted(f64::NAN)).is_none());
    }
}
