//! Layout and glyph list → pages of filled paths.

use super::layout::{Code, Layout, Place};
use super::{TemplateError, lettering};
use crate::numeric::angles;
use crate::types::{Direction, Form, characters};
use kurbo::{Affine, BezPath, Circle, Line, Point, Rect, Shape, Size, Stroke, StrokeOpts, Vec2};
use qrcode::{EcLevel, QrCode};

/// What a path is printed with.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ink {
    /// Full black: marks, code, measuring patterns.
    Black,
    /// The light drop-out colour of guides and frames.
    Guide,
    /// The colour of captions, outside the drawing fields.
    Caption,
    /// Black screened to so many percent.
    Tint(u8),
}

impl Ink {
    /// Red, green and blue, 0…255.
    #[must_use]
    pub fn rgb(self) -> [u8; 3] {
        match self {
            Self::Black => [0, 0, 0],
            // light cyan: nearly white to a red-blind eye, 15 % grey to a grey scanner
            Self::Guide => [178, 226, 242],
            Self::Caption => [120, 130, 140],
            Self::Tint(percent) => {
                let ink = f64::from(percent.min(100)) / 100.0;
                #[expect(
                    clippy::cast_possible_truncation,
                    clippy::cast_sign_loss,
                    reason = "0 to 255"
                )]
                let v = (255.0 * (1.0 - ink)).round() as u8;
                [v; 3]
            }
        }
    }
}

/// A filled path (non-zero) of a page, mm.
#[derive(Debug, Clone, PartialEq)]
pub struct Paint {
    /// Closed paths, mm, y down.
    pub path: BezPath,
    /// What it is filled with.
    pub ink: Ink,
}

/// A page to print.
#[derive(Debug, Clone, PartialEq)]
pub struct Page {
    /// Paper size, mm.
    pub size: Size,
    /// What its code says.
    pub code: Code,
    /// Cells on it.
    pub places: Vec<Place>,
    /// What is printed, in order.
    pub paints: Vec<Paint>,
}

/// Radii of a ring mark: its black ring's outer and inner edge and its black disc. mm
pub(super) const RING: [f64; 3] = [4.0, 3.0, 1.8];
/// Width of guide lines. mm
pub(super) const GUIDE_WIDTH: f64 = 0.16;
/// Height of a caption. mm
const CAPTION_HEIGHT: f64 = 2.3;
/// Width of the captions' strokes. mm
const PEN: f64 = 0.2;
/// Length of the ticks that show the joining stroke's height, from the field's edge inwards. mm
const TICK: f64 = 2.5;
/// Chord error of circles and strokes. mm
const ACCURACY: f64 = 0.005;
/// Widths of the ladder's lines. mm
const LADDER: [f64; 8] = [0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.8, 1.0];
/// Edge of the two slanted squares and their slant: steep enough to sample an edge at every phase. mm, radians
pub(super) const SQUARE: (f64, f64) = (6.0, 5.0 * std::f64::consts::PI / 180.0);
/// Tints of the step wedge. percent
pub(super) const WEDGE: [u8; 9] = [10, 20, 30, 40, 50, 60, 70, 80, 90];

/// The pages of a printing. `captions` are what stands above the cells, one a label; `project` is the name on
/// every page.
///
/// # Errors
/// An option of the layout is out of range, or there is no glyph.
pub fn pages(
    layout: &Layout,
    direction: Direction,
    project: &str,
    labels: &[(String, String)],
) -> Result<Vec<Page>, TemplateError> {
    layout.check()?;
    let names: Vec<String> = labels.iter().map(|(l, _)| l.clone()).collect();
    let places = layout.places(&names, direction);
    let id = layout.id(project, &places);
    if places.iter().all(Vec::is_empty) {
        return Err(TemplateError::NoGlyphs);
    }
    let pages = places.len();
    let numbered = places.into_iter().zip(1..);
    numbered
        .map(|(places, page)| {
            let code = Code {
                id: id.clone(),
                page,
                pages,
            };
            let mut paints = frame(layout, project, &code)?;
            for place in &places {
                let caption = labels.get(place.index).map_or("", |(_, c)| c.as_str());
                paints.extend(cell(layout, place, caption));
            }
            Ok(Page {
                size: layout.paper_mm(),
                code,
                places,
                paints,
            })
        })
        .collect()
}

/// Marks, code, title and measuring patterns.
fn frame(layout: &Layout, project: &str, code: &Code) -> Result<Vec<Paint>, TemplateError> {
    let black = |path| Paint {
        path,
        ink: Ink::Black,
    };
    let mut out: Vec<Paint> = layout.marks().into_iter().map(|m| black(ring(m))).collect();
    out.push(black(qr(&code.to_string(), layout.code())?));
    let title = format!("{project}  {}/{}", code.page, code.pages);
    let left = layout.code().x1 + 6.0;
    let width = layout.marks()[1].x - 9.0 - left;
    let strokes = lettering::strokes(&title, Point::new(left, 8.0), 3.2, width);
    out.push(Paint {
        path: pen(&strokes, 0.3),
        ink: Ink::Caption,
    });
    out.extend(gain_strip(layout));
    Ok(out)
}

fn ring(centre: Point) -> BezPath {
    let circle = |r: f64| Circle::new(centre, r).to_path(ACCURACY);
    let mut path = circle(RING[0]);
    path.extend(circle(RING[1]).reverse_subpaths());
    path.extend(circle(RING[2]));
    path
}

fn qr(text: &str, square: Rect) -> Result<BezPath, TemplateError> {
    let code = QrCode::with_error_correction_level(text, EcLevel::Q)
        .map_err(|e| TemplateError::Drawing(e.to_string()))?;
    let n = code.width();
    let module = square.width() / n as f64;
    let mut path = BezPath::new();
    let dark = code
        .to_colors()
        .into_iter()
        .enumerate()
        .filter(|(_, c)| *c == qrcode::Color::Dark);
    for (i, _) in dark {
        let at = Vec2::new((i % n) as f64, (i / n) as f64) * module;
        path.extend(
            Rect::from_origin_size(square.origin() + at, (module, module)).path_elements(1.0),
        );
    }
    Ok(path)
}

/// Where the strip's patterns stand: two slanted squares' centres, the ladder's left edge, the wedge's.
pub(super) struct Strip {
    pub(super) squares: [Point; 2],
    ladder: Vec<Rect>,
    wedge: Vec<Rect>,
}

pub(super) fn strip(layout: &Layout) -> Strip {
    let r = layout.gain_strip();
    let y = r.center().y;
    let squares = [Point::new(r.x0 + 5.0, y), Point::new(r.x1 - 5.0, y)];
    let mut x = r.x0 + 12.0;
    let ladder = LADDER.map(|w| {
        let line = Rect::new(x, y - 3.0, x + w, y + 3.0);
        x += w + 1.8;
        line
    });
    let wedge = WEDGE.map(|_| {
        x += 4.0;
        Rect::new(x - 4.0, y - 3.0, x, y + 3.0)
    });
    Strip {
        squares,
        ladder: ladder.to_vec(),
        wedge: wedge.to_vec(),
    }
}

fn gain_strip(layout: &Layout) -> Vec<Paint> {
    let strip = strip(layout);
    let (edge, slant) = SQUARE;
    let squares = strip.squares.iter().map(|&c| {
        let square = Rect::from_center_size(Point::ORIGIN, (edge, edge)).to_path(1.0);
        (
            Affine::translate(c.to_vec2()) * angles::rotation(slant) * square,
            Ink::Black,
        )
    });
    let ladder = strip.ladder.iter().map(|r| (r.to_path(1.0), Ink::Black));
    let wedge = strip
        .wedge
        .iter()
        .zip(WEDGE)
        .map(|(r, t)| (r.to_path(1.0), Ink::Tint(t)));
    squares
        .chain(ladder)
        .chain(wedge)
        .map(|(path, ink)| Paint { path, ink })
        .collect()
}

/// The guide lines of a cell: level ones, then the field's upright sides and joining ticks.
pub(super) fn guides(layout: &Layout, place: &Place) -> Vec<Line> {
    let (f, em) = (place.field, layout.em());
    let heights = [
        layout.ascender,
        layout.cap_height,
        layout.x_height,
        0.0,
        layout.descender,
    ];
    let level = |h: f64| place.baseline - h * em;
    let across = heights
        .iter()
        .map(|&h| Line::new((f.x0, level(h)), (f.x1, level(h))));
    let joins = joining(&place.label);
    let ticks = layout.joining.iter().skip(1).flat_map(|&h| {
        let y = level(h);
        let left = joins.left.then(|| Line::new((f.x0, y), (f.x0 + TICK, y)));
        let right = joins.right.then(|| Line::new((f.x1 - TICK, y), (f.x1, y)));
        left.into_iter().chain(right)
    });
    across.chain(ticks).collect()
}

/// The sides on which a form joins.
pub(super) struct Joins {
    pub(super) left: bool,
    pub(super) right: bool,
}

/// The sides on which a joining form meets its neighbours: Arabic runs from the right.
pub(super) fn joining(label: &str) -> Joins {
    let form = characters::spelled(label).and_then(|said| said.form());
    Joins {
        left: form.is_some_and(Form::joins_after),
        right: form.is_some_and(Form::joins_before),
    }
}

fn cell(layout: &Layout, place: &Place, caption: &str) -> Vec<Paint> {
    let mut lines = BezPath::new();
    for line in guides(layout, place) {
        lines.move_to(line.p0);
        lines.line_to(line.p1);
    }
    lines.extend(place.field.path_elements(1.0));
    let guide = Paint {
        path: pen(&lines, GUIDE_WIDTH),
        ink: Ink::Guide,
    };
    let words = lettering::strokes(caption, place.caption, CAPTION_HEIGHT, place.field.width());
    vec![
        guide,
        Paint {
            path: pen(&words, PEN),
            ink: Ink::Caption,
        },
    ]
}

fn pen(path: &BezPath, width: f64) -> BezPath {
    kurbo::stroke(
        path.iter(),
        &Stroke::new(width),
        &StrokeOpts::default(),
        ACCURACY,
    )
}
