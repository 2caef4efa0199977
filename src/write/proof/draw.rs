//! A glyph over its cell as SVG, user space in font units with y down.

use super::Entry;
use crate::numeric::svg;
use crate::types::{Info, Png};
use crate::write::picture::to_picture;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use kurbo::{Affine, BezPath, PathEl, Point};

/// What an SVG of one glyph is made of.
#[derive(Debug)]
pub(super) struct Drawn {
    pub(super) view_box: String,
    /// From the picture's px (y down) to user space.
    pub(super) picture: String,
    pub(super) path: String,
    pub(super) guides: String,
    pub(super) handles: String,
    pub(super) on_curve: String,
    pub(super) off_curve: String,
    pub(super) count: usize,
    pub(super) advance: String,
}

impl Drawn {
    pub(super) fn new(entry: &Entry, info: &Info) -> Self {
        let glyph = &entry.glyph;
        let path = Affine::FLIP_Y * glyph.outline.to_path();
        let (mut handles, mut on_curve, mut off_curve) =
            (String::new(), String::new(), String::new());
        let mut count = 0;
        let mut at = Point::ORIGIN;
        for el in path.elements() {
            let controls: &[Point] = match el {
                PathEl::QuadTo(a, _) => &[*a],
                PathEl::CurveTo(a, b, _) => &[*a, *b],
                _ => &[],
            };
            controls.iter().for_each(|&p| dot(&mut off_curve, p));
            let Some(end) = el.end_point() else { continue };
            if let (Some(&first), Some(&last)) = (controls.first(), controls.last()) {
                stroke(&mut handles, at, first);
                stroke(&mut handles, end, last);
            }
            if !matches!(el, PathEl::MoveTo(_)) {
                dot(&mut on_curve, end);
                count += 1;
            }
            at = end;
        }
        Self {
            view_box: view_box(entry, info),
            picture: matrix(picture_to_user(entry)),
            path: path_data(&path),
            guides: guides(glyph.advance, info),
            handles,
            on_curve,
            off_curve,
            count,
            advance: format!("{:.0}", glyph.advance),
        }
    }
}

/// From the cell picture's px (y down) to font units with y down.
fn picture_to_user(entry: &Entry) -> Affine {
    let up = to_picture(entry.picture.height).inverse();
    Affine::FLIP_Y * entry.frame.to_units() * up
}

/// The em box and what sticks out of it.
fn view_box(entry: &Entry, info: &Info) -> String {
    /// Paper around it, of the em.
    const MARGIN: f64 = 0.05;
    let m = &info.metrics;
    let em = kurbo::Rect::new(0.0, -m.ascender, entry.glyph.advance, -m.descender);
    let ink = (entry.glyph.outline.bounds()).map(|b| Affine::FLIP_Y.transform_rect_bbox(b));
    let all = ink.map_or(em, |ink| em.union(ink));
    let margin = MARGIN * f64::from(info.units_per_em);
    let all = all.inflate(margin, margin);
    format!(
        "{:.0} {:.0} {:.0} {:.0}",
        all.x0,
        all.y0,
        all.width(),
        all.height()
    )
}

fn matrix(map: Affine) -> String {
    let c = map.as_coeffs();
    format!(
        "matrix({:.5} {:.5} {:.5} {:.5} {:.2} {:.2})",
        c[0], c[1], c[2], c[3], c[4], c[5]
    )
}

/// Baseline across the picture, the advance's two ends from ascender to descender.
fn guides(advance: f64, info: &Info) -> String {
    let (top, bottom) = (-info.metrics.ascender, -info.metrics.descender);
    let em = f64::from(info.units_per_em);
    format!(
        "M{:.0} 0H{:.0}M0 {top:.0}V{bottom:.0}M{advance:.0} {top:.0}V{bottom:.0}",
        -em,
        advance + em
    )
}

/// A point that a round line cap makes visible.
pub(super) fn dot(out: &mut String, p: Point) {
    *out += &format!("M{:.1} {:.1}h0", p.x, p.y);
}

pub(super) fn stroke(out: &mut String, a: Point, b: Point) {
    *out += &format!("M{:.1} {:.1}L{:.1} {:.1}", a.x, a.y, b.x, b.y);
}

/// Path data to a tenth of a unit: below what a screen shows.
pub(super) fn path_data(path: &BezPath) -> String {
    svg::path_data(path, |v| format!("{v:.1}"))
}

/// The cell's picture in a data URI.
pub(super) fn picture(png: &Png) -> String {
    let data = STANDARD.encode(&png.bytes);
    format!("data:image/png;base64,{data}")
}
