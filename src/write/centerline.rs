//! Lines that a pen drew, as SVG strokes or as the open contours of a UFO.

use super::WriteError;
use super::picture::{pixels, to_picture};
use super::ufo::files::bytes;
use super::ufo::node;
use super::ufo::states::sign;
use crate::numeric::median::middle;
use crate::numeric::svg::path_data;
use crate::types::{Centerline, Files, PenDot, PenLine};
use kurbo::{Affine, BezPath, PathEl, Point};
use norad::{Codepoints, Contour, PointType};
use plist::Value;

/// Where a UFO's glyph keeps the ink's width: a list a contour, a number an on-curve point, in units.
const WIDTHS: &str = "khatt.strokeWidths";

/// A stroked path of each line, as wide as the line is in the middle; the width at each of its nodes in
/// `data-widths`. Dots are circles. User space is the picture's px, y down.
#[must_use]
pub fn svg((w, h): (usize, usize), drawn: &Centerline) -> String {
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\">\n\
         <g fill=\"none\" stroke=\"black\" stroke-linecap=\"round\" stroke-linejoin=\"round\">\n"
    );
    for line in &drawn.lines {
        let d = path_data(&line.path, pixels);
        let middle = middle(line.widths.iter().copied(), f64::total_cmp).unwrap_or_default();
        let widths: Vec<String> = line.widths.iter().map(|w| format!("{w:.2}")).collect();
        let widths = widths.join(" ");
        out +=
            &format!("<path stroke-width=\"{middle:.2}\" data-widths=\"{widths}\" d=\"{d}\"/>\n");
    }
    out += "</g>\n";
    for dot in &drawn.dots {
        let (x, y, r) = (dot.centre.x, dot.centre.y, dot.radius);
        out += &format!("<circle cx=\"{x:.2}\" cy=\"{y:.2}\" r=\"{r:.2}\"/>\n");
    }
    out + "</svg>\n"
}

/// A UFO of one glyph: a unit is a px, y up from the picture's lower edge. Dots are lines of no length, as wide as
/// the dot.
///
/// # Errors
/// The UFO cannot be written.
pub fn ufo(
    (width, height): (usize, usize),
    drawn: &Centerline,
    (name, character): (&str, Option<char>),
) -> Result<Files, WriteError> {
    let mut glyph = norad::Glyph::new(name);
    glyph.codepoints = Codepoints::new(character);
    glyph.width = width as f64;
    let up = to_picture(height).inverse();
    glyph.contours = drawn
        .lines
        .iter()
        .map(|l| contour(&(up * &l.path)))
        .collect();
    glyph.contours.extend(drawn.dots.iter().map(|d| dot(d, up)));
    let reals = |widths: &[f64]| Value::Array(widths.iter().map(|w| Value::Real(*w)).collect());
    let lines = drawn.lines.iter().map(|l: &PenLine| reals(&l.widths));
    let dots = drawn.dots.iter().map(|d| reals(&[2.0 * d.radius; 2]));
    let widths = Value::Array(lines.chain(dots).collect());
    glyph.lib.insert(WIDTHS.to_owned(), widths);
    let mut font = norad::Font::new();
    font.default_layer_mut().insert_glyph(glyph);
    sign(&mut font)?;
    bytes(&font)
}

/// A line as the field writes it: an open contour begins with a point of type `move`.
fn contour(path: &BezPath) -> Contour {
    let mut points = Vec::new();
    let mut add = |p: Point, kind| points.push(node(p, kind));
    let closed = path.elements().last() == Some(&PathEl::ClosePath);
    for el in path.elements() {
        match *el {
            PathEl::MoveTo(p) if !closed => add(p, PointType::Move),
            PathEl::LineTo(p) => add(p, PointType::Line),
            PathEl::CurveTo(a, b, p) => {
                add(a, PointType::OffCurve);
                add(b, PointType::OffCurve);
                add(p, PointType::Curve);
            }
            PathEl::MoveTo(_) | PathEl::QuadTo(..) | PathEl::ClosePath => {}
        }
    }
    Contour::new(points, None)
}

fn dot(dot: &PenDot, up: Affine) -> Contour {
    let at = up * dot.centre;
    let ends = [PointType::Move, PointType::Line];
    Contour::new(ends.map(|kind| node(at, kind)).to_vec(), None)
}
