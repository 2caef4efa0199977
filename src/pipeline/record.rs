//! Letters and pages as bytes and back, to the last bit.

use super::letter::Letter;
use super::page::Page;
use crate::scan::{Cut, Reason, Rejected, Warning};
use crate::template::Gain;
use crate::types::{Cell, Contour, Gray, Guides, Label};
use kurbo::{Affine, BezPath, PathEl, Point, Rect};
use serde::{Deserialize, Serialize};

/// A page and its letters.
#[derive(Serialize, Deserialize)]
struct PageRecord {
    name: String,
    table: usize,
    letters: Vec<LetterRecord>,
    /// Rectangle, area and reason.
    rejected: Vec<([f64; 4], usize, Reason)>,
    /// Index, label and message.
    warnings: Vec<(Option<usize>, Option<String>, String)>,
    skew_deg: f64,
    upright: [f64; 6],
    specks: usize,
    gain: Option<Gain>,
}

#[derive(Serialize, Deserialize)]
struct LetterRecord {
    sheet: String,
    label: String,
    index: usize,
    width: usize,
    height: usize,
    levels: Vec<u8>,
    in_sheet: [f64; 4],
    to_sheet: [f64; 6],
    baseline_px: f64,
    px_per_em: f64,
    advance_px: Option<(f64, f64)>,
    /// Blur and points of each contour.
    edge: Vec<(f64, Vec<(f64, f64)>)>,
    paths: Vec<Vec<Step>>,
}

/// An element of a path.
#[derive(Clone, Copy, Serialize, Deserialize)]
enum Step {
    Move((f64, f64)),
    Line((f64, f64)),
    Quad((f64, f64), (f64, f64)),
    Curve((f64, f64), (f64, f64), (f64, f64)),
    Close,
}

/// Pages and their letters as bytes; nothing where they cannot be written.
pub(super) fn write(pages: &[(Vec<Letter>, Page)]) -> Option<Vec<u8>> {
    let records: Vec<PageRecord> = pages.iter().map(PageRecord::of).collect();
    postcard::to_allocvec(&records).ok()
}

/// Pages and their letters from bytes; nothing where these are no such thing.
pub(super) fn read(bytes: &[u8]) -> Option<Vec<(Vec<Letter>, Page)>> {
    let records: Vec<PageRecord> = postcard::from_bytes(bytes).ok()?;
    records.into_iter().map(PageRecord::page).collect()
}

impl PageRecord {
    fn of((letters, page): &(Vec<Letter>, Page)) -> Self {
        let cut = &page.cut;
        let rejected = cut.rejected.iter();
        let warnings = cut.warnings.iter();
        let label = |w: &Warning| w.label.as_ref().map(|l| l.0.clone());
        Self {
            name: page.name.clone(),
            table: page.table,
            letters: letters.iter().map(LetterRecord::of).collect(),
            rejected: rejected
                .map(|r| (corners(r.in_sheet), r.area_px, r.reason))
                .collect(),
            warnings: warnings
                .map(|w| (w.index, label(w), w.message.clone()))
                .collect(),
            skew_deg: cut.skew_deg,
            upright: cut.upright.as_coeffs(),
            specks: cut.specks,
            gain: page.gain.clone(),
        }
    }

    fn page(self) -> Option<(Vec<Letter>, Page)> {
        let letters = self.letters.into_iter().map(LetterRecord::letter);
        let rejected = self.rejected.into_iter();
        let rejected = rejected.map(|(r, area_px, reason)| Rejected {
            in_sheet: rect(r),
            area_px,
            reason,
        });
        let warnings = self.warnings.into_iter();
        let warnings = warnings.map(|(index, label, message)| Warning {
            index,
            label: label.map(Label),
            message,
        });
        let page = Page {
            name: self.name,
            table: self.table,
            cut: Cut {
                cells: Vec::new(),
                rejected: rejected.collect(),
                warnings: warnings.collect(),
                skew_deg: self.skew_deg,
                upright: Affine::new(self.upright),
                specks: self.specks,
            },
            gain: self.gain,
        };
        Some((letters.collect::<Option<_>>()?, page))
    }
}

impl LetterRecord {
    fn of(letter: &Letter) -> Self {
        let cell = &letter.cell;
        let ring = |c: &Contour| (c.blur_px(), c.points().iter().map(pair).collect());
        Self {
            sheet: letter.sheet.clone(),
            label: cell.label.0.clone(),
            index: cell.index,
            width: cell.gray.width(),
            height: cell.gray.height(),
            levels: cell.gray.levels(),
            in_sheet: corners(cell.in_sheet),
            to_sheet: cell.to_sheet.as_coeffs(),
            baseline_px: cell.guides.baseline_px,
            px_per_em: cell.guides.px_per_em,
            advance_px: cell.guides.advance_px,
            edge: letter.edge.iter().map(ring).collect(),
            paths: letter.paths.iter().map(steps).collect(),
        }
    }

    fn letter(self) -> Option<Letter> {
        let ring = |(blur, points): (f64, Vec<(f64, f64)>)| {
            let points = points.into_iter().map(Point::from).collect();
            Some(Contour::new(points).ok()?.with_blur(blur))
        };
        Some(Letter {
            sheet: self.sheet,
            cell: Cell {
                label: Label(self.label),
                index: self.index,
                gray: Gray::from_levels(self.width, self.height, &self.levels).ok()?,
                in_sheet: rect(self.in_sheet),
                to_sheet: Affine::new(self.to_sheet),
                guides: Guides {
                    baseline_px: self.baseline_px,
                    px_per_em: self.px_per_em,
                    advance_px: self.advance_px,
                },
            },
            edge: self.edge.into_iter().map(ring).collect::<Option<_>>()?,
            paths: self.paths.iter().map(|p| path(p)).collect(),
        })
    }
}

fn pair(p: &Point) -> (f64, f64) {
    (*p).into()
}

/// Left, top, right and bottom.
const fn corners(r: Rect) -> [f64; 4] {
    [r.x0, r.y0, r.x1, r.y1]
}

fn rect([x0, y0, x1, y1]: [f64; 4]) -> Rect {
    Rect { x0, y0, x1, y1 }
}

fn steps(path: &BezPath) -> Vec<Step> {
    let step = |el: &PathEl| match el {
        PathEl::MoveTo(p) => Step::Move(pair(p)),
        PathEl::LineTo(p) => Step::Line(pair(p)),
        PathEl::QuadTo(a, p) => Step::Quad(pair(a), pair(p)),
        PathEl::CurveTo(a, b, p) => Step::Curve(pair(a), pair(b), pair(p)),
        PathEl::ClosePath => Step::Close,
    };
    path.elements().iter().map(step).collect()
}

fn path(steps: &[Step]) -> BezPath {
    let el = |step: &Step| match *step {
        Step::Move(p) => PathEl::MoveTo(p.into()),
        Step::Line(p) => PathEl::LineTo(p.into()),
        Step::Quad(a, p) => PathEl::QuadTo(a.into(), p.into()),
        Step::Curve(a, b, p) => PathEl::CurveTo(a.into(), b.into(), p.into()),
        Step::Close => PathEl::ClosePath,
    };
    steps.iter().map(el).collect()
}
