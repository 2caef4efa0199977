//! Coordinates to whole font units: the one place where that happens. Nodes go to the nearest grid point, handles
//! to where smooth joins stay smooth.

use super::joins;
use crate::types::{Font, Glyph, Outline};
use kurbo::{BezPath, PathEl, Point};

/// The font with every point, anchor and component offset on the grid. A contour that collapses to a
/// single point is dropped.
#[must_use]
pub fn font(font: &Font) -> Font {
    font.map_glyphs(|glyph| Glyph {
        outline: outline(&glyph.outline),
        anchors: glyph
            .anchors
            .iter()
            .map(|a| {
                let mut a = a.clone();
                a.at = a.at.round();
                a
            })
            .collect(),
        components: glyph
            .components
            .iter()
            .map(|c| {
                let mut c = c.clone();
                let [xx, xy, yx, yy, dx, dy] = c.place.as_coeffs();
                c.place = kurbo::Affine::new([xx, xy, yx, yy, dx.round(), dy.round()]);
                c
            })
            .collect(),
        ..glyph.clone()
    })
}

/// An outline with every point on the grid.
#[must_use]
pub fn outline(outline: &Outline) -> Outline {
    let rounded = outline.contours().iter().map(contour);
    let kept = rounded.filter(|c| {
        c.segments()
            .any(|s| kurbo::ParamCurve::start(&s) != kurbo::ParamCurve::end(&s))
    });
    // closed and finite like what came in
    Outline::new(kept.collect()).unwrap_or_default()
}

pub(super) fn contour(path: &BezPath) -> BezPath {
    let p = Point::round;
    let map = |el: &PathEl| match *el {
        PathEl::MoveTo(a) => PathEl::MoveTo(p(a)),
        PathEl::LineTo(a) => PathEl::LineTo(p(a)),
        PathEl::QuadTo(a, b) => PathEl::QuadTo(p(a), p(b)),
        PathEl::CurveTo(a, b, c) => PathEl::CurveTo(p(a), p(b), p(c)),
        PathEl::ClosePath => PathEl::ClosePath,
    };
    let mut rounded: Vec<PathEl> = path.elements().iter().map(map).collect();
    joins::keep(path.elements(), &mut rounded);
    BezPath::from_vec(rounded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn on_the_grid_and_nothing_lost() {
        let svg = ["M0.4 0.6L10.5 0L10.2 9.7Z", "M3.1 3.1L3.2 3.2L3.1 3.2Z"];
        let paths = svg.map(|s| BezPath::from_svg(s).unwrap()).to_vec();
        let out = outline(&Outline::new(paths).unwrap());
        assert_eq!(out.contours().len(), 1);
        assert_eq!(out.to_path().to_svg(), "M0,1 L11,0 L10,10 Z");
        assert_eq!(outline(&out), out);
    }
}
