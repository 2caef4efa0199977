//! A page as SVG, as a page of a PDF, as a picture.

use super::TemplateError;
use super::draw::Page;
use crate::numeric::cast::single;
use crate::numeric::svg::path_data;
use crate::types::MM_PER_INCH;
use kurbo::PathEl;
use pdf_writer::{Content, Finish, Pdf, Rect, Ref};
use resvg::tiny_skia::{Color, Pixmap};
use usvg::{Options, Transform, Tree};

/// PDF units a millimetre.
const POINTS: f64 = 72.0 / MM_PER_INCH;

/// The page as an SVG file whose units are mm.
#[must_use]
pub fn svg(page: &Page) -> String {
    let (w, h) = (page.size.width, page.size.height);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}mm\" height=\"{h}mm\" viewBox=\"0 0 {w} {h}\">\n\
         <rect width=\"{w}\" height=\"{h}\" fill=\"#fff\"/>\n"
    );
    for paint in &page.paints {
        let [r, g, b] = paint.ink.rgb();
        let d = path_data(&paint.path, |v| format!("{v:.3}"));
        out += &format!("<path fill=\"#{r:02x}{g:02x}{b:02x}\" d=\"{d}\"/>\n");
    }
    out + "</svg>\n"
}

/// All pages as one PDF file.
#[must_use]
pub fn pdf(pages: &[Page]) -> Vec<u8> {
    let mut pdf = Pdf::new();
    let (catalog, tree) = (Ref::new(1), Ref::new(2));
    let number = |i: usize| i32::try_from(i).unwrap_or(i32::MAX / 4);
    let refs: Vec<(Ref, Ref)> = (0..pages.len())
        .map(|i| (Ref::new(3 + 2 * number(i)), Ref::new(4 + 2 * number(i))))
        .collect();
    pdf.catalog(catalog).pages(tree);
    pdf.pages(tree)
        .kids(refs.iter().map(|r| r.0))
        .count(number(pages.len()));
    for (page, &(id, content)) in pages.iter().zip(&refs) {
        let mut p = pdf.page(id);
        let size = (points(page.size.width), points(page.size.height));
        p.parent(tree)
            .media_box(Rect::new(0.0, 0.0, size.0, size.1))
            .contents(content);
        p.resources();
        p.finish();
        pdf.stream(content, &drawing(page));
    }
    pdf.finish()
}

fn points(mm: f64) -> f32 {
    single(mm * POINTS)
}

fn drawing(page: &Page) -> Vec<u8> {
    let mut c = Content::new();
    let y = |v: f64| points(page.size.height - v);
    let curve = |c: &mut Content, [a, b, p]: [kurbo::Point; 3]| {
        let [(ax, ay), (bx, by), (x, y)] = [a, b, p].map(|p| (points(p.x), y(p.y)));
        c.cubic_to(ax, ay, bx, by, x, y);
    };
    for paint in &page.paints {
        let [r, g, b] = paint.ink.rgb().map(|v| f32::from(v) / 255.0);
        c.set_fill_rgb(r, g, b);
        let mut last = kurbo::Point::ORIGIN;
        for el in paint.path.elements() {
            match *el {
                PathEl::MoveTo(p) => drop(c.move_to(points(p.x), y(p.y))),
                PathEl::LineTo(p) => drop(c.line_to(points(p.x), y(p.y))),
                PathEl::QuadTo(a, p) => {
                    curve(&mut c, [last.lerp(a, 2.0 / 3.0), p.lerp(a, 2.0 / 3.0), p]);
                }
                PathEl::CurveTo(a, b, p) => curve(&mut c, [a, b, p]),
                PathEl::ClosePath => drop(c.close_path()),
            }
            last = el.end_point().unwrap_or(last);
        }
        c.fill_nonzero();
    }
    c.finish().to_vec()
}

/// The page as a PNG file of `dpi` dots an inch, which says so itself: programs print it at the page's size.
///
/// # Errors
/// The picture would be empty or larger than memory allows.
pub fn png(page: &Page, dpi: f64) -> Result<Vec<u8>, TemplateError> {
    let fail = |e: String| TemplateError::Drawing(e);
    let tree = Tree::from_str(&svg(page), &Options::default()).map_err(|e| fail(e.to_string()))?;
    let scale = dpi / MM_PER_INCH;
    let (w, h) = (
        pixels(page.size.width * scale),
        pixels(page.size.height * scale),
    );
    let mut map = Pixmap::new(w, h).ok_or_else(|| fail(format!("{w} × {h} px")))?;
    map.fill(Color::WHITE);
    let fit = single(f64::from(w) / f64::from(tree.size().width()));
    resvg::render(&tree, Transform::from_scale(fit, fit), &mut map.as_mut());
    let file = map.encode_png().map_err(|e| fail(e.to_string()))?;
    Ok(with_resolution(&file, pixels(1000.0 * dpi / MM_PER_INCH)))
}

/// The PNG file with its pixels a metre, in the chunk `pHYs` (PNG 2003 sec. 11.3.5.3).
fn with_resolution(file: &[u8], per_metre: u32) -> Vec<u8> {
    /// Where the second chunk begins: after the signature and the header, whose length is given.
    const SECOND: usize = 8 + 4 + 4 + 13 + 4;
    /// The unit is the metre.
    const METRE: u8 = 1;
    let size = per_metre.to_be_bytes();
    let chunk = [b"pHYs", &size[..], &size, &[METRE]].concat();
    let (header, rest) = file.split_at(SECOND.min(file.len()));
    let length = [0, 0, 0, 9];
    let check = crc32fast::hash(&chunk).to_be_bytes();
    [header, &length, &chunk, &check, rest].concat()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the cast saturates; an impossible size is refused by the picture"
)]
fn pixels(v: f64) -> u32 {
    v.round() as u32
}
