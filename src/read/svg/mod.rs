//! SVG drawings → Font, a glyph each.

mod clip;
mod unread;

use super::{Names, ReadError, Reading, begin_with_notdef, listed};
use crate::types::{Font, Glyph, Info, Metrics, Outline, characters};
use clip::within;
use kurbo::{Affine, BezPath, PathEl, Point, Rect, Shape};
use std::collections::BTreeSet;
use std::path::Path as FilePath;
use unread::unread;
use usvg::roxmltree::Document;
use usvg::tiny_skia_path::{Path, PathSegment, Point as PathPoint};
use usvg::{FillRule, Node, Options, Transform, Tree};

/// The largest coordinate that the tables of a font hold, font units.
const FARTHEST: f64 = 32_767.0;
/// Units an em of the font that drawings make.
const EM: f64 = 1000.0;

/// A font of drawings, one glyph each, named and encoded by the file's name: `A_.svg` (a `_` after a
/// capital is not part of it) is A, `eacute.svg` é, `uni0628.svg` beh, `beh-ar.init.svg` an alternate.
///
/// Where the view box begins above zero, the user space is the em itself, baseline at y = 0, one
/// font unit a user unit; else the box stands on the baseline and its height is the em. The advance is the box's
/// width, or what `data-advance` says; then the glyph begins at x = 0. Fills and expanded strokes count, whatever
/// their colour, and clip paths.
///
/// # Errors
/// A file is no SVG, nothing of what it has can be read, or nothing is drawn in any of them.
pub fn svg(files: &[(String, Vec<u8>)]) -> Result<Reading, ReadError> {
    let (mut names, mut lost) = (Names::default(), Vec::new());
    let mut glyphs = Vec::new();
    let (mut encoded, mut mute) = (BTreeSet::new(), Vec::new());
    let mut reach = (0.0_f64, 0.0_f64);
    for (path, bytes) in files {
        let stem = FilePath::new(path)
            .file_stem()
            .map_or_else(String::new, |s| s.to_string_lossy().into_owned());
        let wanted = glyph_name(&stem);
        let drawing = drawing(bytes, path, &mut lost)?;
        reach = (
            reach.0.max(drawing.top),
            reach.1.min(drawing.top - drawing.height),
        );
        let chars = match stands_for(&wanted).as_deref() {
            Some([c]) if encoded.insert(*c) => vec![*c],
            Some([_]) | None => {
                mute.push(wanted.clone());
                Vec::new()
            }
            // ligatures and alternates have none of their own
            Some(_) => Vec::new(),
        };
        let mut glyph = Glyph::new(names.claim(&wanted, glyphs.len() + 1), chars, drawing.width);
        glyph.outline = drawing.outline;
        glyphs.push(glyph);
    }
    if glyphs.iter().all(|g| g.outline.is_empty()) {
        return Err(ReadError::Empty);
    }
    begin_with_notdef(&mut glyphs);
    let metrics = Metrics {
        ascender: reach.0,
        descender: reach.1,
        ..Metrics::default()
    };
    let info = Info {
        metrics,
        ..Info::default()
    };
    let font = Font::new(info, glyphs)?;
    lost.extend(listed(
        "characters that names do not tell, or that another drawing has",
        &mute,
    ));
    lost.extend(names.lost());
    Ok(Reading { font, lost })
}

/// The largest coordinate, either way.
fn farthest(bounds: Rect) -> f64 {
    let sides = [bounds.x0, bounds.y0, bounds.x1, bounds.y1];
    sides.iter().fold(0.0, |far, v| v.abs().max(far))
}

struct Drawing {
    outline: Outline,
    width: f64,
    top: f64,
    height: f64,
}

/// What stands in one file, in font units, y up.
fn drawing(bytes: &[u8], file: &str, lost: &mut Vec<String>) -> Result<Drawing, ReadError> {
    let bad = |e: &dyn ToString| ReadError::damaged("an SVG", format!("{file}: {}", e.to_string()));
    let tree = Tree::from_data(bytes, &Options::default()).map_err(|e| bad(&e))?;
    let document = Document::parse(std::str::from_utf8(bytes).unwrap_or_default()).ok();
    let size = tree.size();
    let (w, h) = (f64::from(size.width()), f64::from(size.height()));
    let Frame {
        view,
        user,
        advance,
    } = frame(document.as_ref(), [w, h]);
    let [x, y, bw, bh] = view;
    // From the picture's pixels, y down, to the user space, and from there to the em.
    let (scale, base) = if y < 0.0 {
        (1.0, 0.0)
    } else {
        (EM / bh, y + bh)
    };
    let (left, width) = advance.map_or((x, bw), |advance| (0.0, advance));
    let place = Affine::scale(scale) * Affine::translate((-left, base)) * Affine::FLIP_Y * user;
    let mut missing = document.as_ref().map_or_else(Vec::new, unread);
    let contours = collect(tree.root(), place, &mut missing);
    let missing = (!missing.is_empty()).then(|| missing.join(", "));
    match missing {
        Some(what) if contours.is_empty() => {
            return Err(ReadError::Undrawn {
                file: file.to_owned(),
                what,
            });
        }
        some => lost.extend(some.map(|what| format!("{file}: {what}"))),
    }
    let outline = Outline::new(contours).map_err(|e| bad(&e))?;
    if let Some(far) = outline.bounds().map(farthest).filter(|far| *far > FARTHEST) {
        return Err(bad(&format!(
            "a coordinate is {far:.0} font units; no font holds more than {FARTHEST}"
        )));
    }
    Ok(Drawing {
        outline,
        width: width * scale,
        top: scale * (base - y),
        height: bh * scale,
    })
}

/// What the root says of where the drawing stands.
struct Frame {
    /// The part of the user space that is shown: left, top, width, height.
    view: [f64; 4],
    /// From the picture's pixels to the user space.
    user: Affine,
    /// The advance, user units, where it is not the view's width.
    advance: Option<f64>,
}

/// The frame of a picture of that size, px.
fn frame(document: Option<&Document<'_>>, size: [f64; 2]) -> Frame {
    let said = |name| document?.root_element().attribute(name);
    let advance = said("data-advance").and_then(|v| v.parse().ok());
    let advance = advance.filter(|v: &f64| v.is_finite() && *v >= 0.0);
    let Some(view) = said("viewBox").and_then(view_box) else {
        let view = [0.0, 0.0, size[0], size[1]];
        return Frame {
            view,
            user: Affine::IDENTITY,
            advance,
        };
    };
    let aspect = said("preserveAspectRatio").unwrap_or_default();
    Frame {
        view,
        user: unfitted(view, size, aspect),
        advance,
    }
}

/// A view box, if it is a good one.
fn view_box(given: &str) -> Option<[f64; 4]> {
    let numbers: Vec<f64> = given
        .split([' ', ',', '\n', '\t'])
        .filter(|s| !s.is_empty())
        .map_while(|s| s.parse().ok())
        .collect();
    let four: [f64; 4] = numbers.try_into().ok()?;
    (four.iter().all(|v| v.is_finite()) && four[2] > 0.0 && four[3] > 0.0).then_some(four)
}

/// The way back from a picture into which a view box was fitted, as `preserveAspectRatio` says: whole and in its
/// middle where it says nothing.
fn unfitted([x, y, bw, bh]: [f64; 4], [w, h]: [f64; 2], aspect: &str) -> Affine {
    let has = |word: &str| aspect.contains(word);
    let (sx, sy) = (w / bw, h / bh);
    let (sx, sy) = if has("none") {
        (sx, sy)
    } else if has("slice") {
        (sx.max(sy), sx.max(sy))
    } else {
        (sx.min(sy), sx.min(sy))
    };
    let shift = |room: f64, [least, most]: [&str; 2]| match (has(least), has(most)) {
        (true, _) => 0.0,
        (_, true) => room,
        _ => room / 2.0,
    };
    let dx = shift(w - bw * sx, ["xMin", "xMax"]);
    let dy = shift(h - bh * sy, ["YMin", "YMax"]);
    Affine::translate((x, y))
        * Affine::scale_non_uniform(1.0 / sx, 1.0 / sy)
        * Affine::translate((-dx, -dy))
}

/// The contours of a group and of all in it, cut at its clip path.
fn collect(group: &usvg::Group, place: Affine, lost: &mut Vec<String>) -> Vec<BezPath> {
    let place = place * affine(group.transform());
    let mut out = Vec::new();
    for node in group.children() {
        match node {
            Node::Group(g) => out.extend(collect(g, place, lost)),
            Node::Path(p) if p.is_visible() => {
                if let Some(fill) = p.fill() {
                    out.extend(contours(p.data(), place, fill.rule()));
                }
                let stroked = p
                    .stroke()
                    .and_then(|s| p.data().stroke(&s.to_tiny_skia(), 1.0));
                if let Some(path) = stroked {
                    out.extend(contours(&path, place, FillRule::NonZero));
                }
            }
            // those that are no paths are listed by their elements
            Node::Path(_) | Node::Image(_) | Node::Text(_) => {}
        }
    }
    let mut clip = group.clip_path();
    while let Some(one) = clip {
        let area = collect(one.root(), place * affine(one.transform()), lost);
        match within(&out, &area) {
            Some(cut) => out = cut,
            None => lost.push(format!("clip path {}", one.id())),
        }
        clip = one.clip_path();
    }
    lost.extend(group.mask().map(|m| format!("mask {}", m.id())));
    out
}

fn affine(t: Transform) -> Affine {
    Affine::new([t.sx, t.ky, t.kx, t.sy, t.tx, t.ty].map(f64::from))
}

/// A path's contours, closed, run so that what its rule fills is filled by winding, outside counter-clockwise.
fn contours(path: &Path, place: Affine, rule: FillRule) -> Vec<BezPath> {
    let mut out: Vec<BezPath> = Vec::new();
    let p = |q: PathPoint| place * Point::new(f64::from(q.x), f64::from(q.y));
    for segment in path.segments() {
        if let PathSegment::MoveTo(a) = segment {
            let mut begun = BezPath::new();
            begun.move_to(p(a));
            out.push(begun);
            continue;
        }
        let Some(open) = out.last_mut() else { continue };
        match segment {
            PathSegment::LineTo(a) => open.line_to(p(a)),
            PathSegment::QuadTo(a, b) => open.quad_to(p(a), p(b)),
            PathSegment::CubicTo(a, b, c) => open.curve_to(p(a), p(b), p(c)),
            PathSegment::MoveTo(_) | PathSegment::Close => {}
        }
    }
    out.retain(|c| c.segments().next().is_some() && c.is_finite());
    out.iter_mut().for_each(BezPath::close_path);
    let reversed = match rule {
        FillRule::NonZero => {
            let all = out.iter().map(Shape::area).sum::<f64>() < 0.0;
            vec![all; out.len()]
        }
        FillRule::EvenOdd => (0..out.len())
            .map(|i| {
                let start = out[i].elements().first().and_then(PathEl::end_point);
                let start = start.unwrap_or_default();
                let others = out.iter().enumerate().filter(|(j, _)| *j != i);
                let around = others.filter(|(_, c)| c.winding(start) != 0);
                (out[i].area() < 0.0) != (around.count() % 2 == 1)
            })
            .collect(),
    };
    out.into_iter()
        .zip(reversed)
        .map(|(c, r)| if r { c.reverse_subpaths() } else { c })
        .collect()
}

/// The glyph that a file's stem names: no `_` behind capitals, a leading one is a dot.
fn glyph_name(stem: &str) -> String {
    let mut out = String::new();
    let mut before = ' ';
    for (i, c) in stem.chars().enumerate() {
        match c {
            '_' if i == 0 => out.push('.'),
            '_' if before.is_ascii_uppercase() => {}
            c => out.push(c),
        }
        before = c;
    }
    out
}

/// The characters that a name stands for: itself where it is one, else what the lists of names say; none by
/// itself where it has a suffix. `None` for a name that is in no list.
fn stands_for(name: &str) -> Option<Vec<char>> {
    if name.contains('.') {
        return Some(Vec::new());
    }
    let itself: Vec<char> = name.chars().collect();
    if itself.len() == 1 {
        return Some(itself);
    }
    characters::of(name)
}
