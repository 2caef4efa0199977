//! Letters and pages as bytes and back, to the last bit.

use super::batch::Batch;
use super::letter::Letter;
use super::page::{Page, Traced};
use crate::scan::{Colour, Cut, Reason, Rejected, Warning};
use crate::template::Gain;
use crate::types::{Contour, Guides, Label, Png};
use kurbo::{Affine, BezPath, PathEl, Point, Rect};
use serde::{Deserialize, Serialize};

/// A page and its letters.
#[derive(Serialize, Deserialize)]
struct PageRecord {
    /// In its table, from 1.
    number: usize,
    name: String,
    letters: Vec<LetterRecord>,
    /// Rectangle, area and reason.
    rejected: Vec<([f64; 4], usize, Reason)>,
    /// Index, label and message.
    warnings: Vec<(Option<usize>, Option<String>, String)>,
    skew_deg: f64,
    upright: [f64; 6],
    specks: usize,
    /// Ink, red, green and blue, and area.
    colours: Vec<(String, [u8; 3], usize)>,
    gain: Option<Gain>,
    px_per_mm: Option<f64>,
}

#[derive(Serialize, Deserialize)]
struct LetterRecord {
    sheet: String,
    label: String,
    index: usize,
    width: usize,
    height: usize,
    picture: Vec<u8>,
    in_sheet: [f64; 4],
    baseline_px: f64,
    px_per_em: f64,
    row: Option<usize>,
    /// Blur and points of each contour.
    edge: Vec<(f64, Vec<(f64, f64)>)>,
    paths: Vec<Vec<Step>>,
    /// Of each ink.
    plates: Vec<(String, Vec<Vec<Step>>)>,
    filled: bool,
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
pub(super) fn write(batch: &Batch<Traced>) -> Option<Vec<u8>> {
    let records: Vec<PageRecord> = batch.made.iter().map(PageRecord::of).collect();
    postcard::to_allocvec(&records).ok()
}

/// Pages and their letters from bytes; nothing where these are no such thing.
pub(super) fn read(bytes: &[u8]) -> Option<Batch<Traced>> {
    let records: Vec<PageRecord> = postcard::from_bytes(bytes).ok()?;
    let made = records.into_iter().map(PageRecord::page);
    let made: Vec<(usize, Traced)> = made.collect::<Option<_>>()?;
    let seen = made.iter().map(|(n, (_, page))| (*n, page.name.clone()));
    Some(Batch {
        seen: seen.collect(),
        made,
        problems: Vec::new(),
    })
}

impl PageRecord {
    fn of((number, (letters, page)): &(usize, Traced)) -> Self {
        let cut = &page.cut;
        let rejected = cut.rejected.iter();
        let warnings = cut.warnings.iter();
        let colour = |c: &Colour| (c.ink.clone(), c.rgb, c.area_px);
        let label = |w: &Warning| w.label.as_ref().map(|l| l.0.clone());
        Self {
            number: *number,
            name: page.name.clone(),
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
            colours: cut.colours.iter().map(colour).collect(),
            gain: page.gain.clone(),
            px_per_mm: page.px_per_mm,
        }
    }

    fn page(self) -> Option<(usize, Traced)> {
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
        let colours = self.colours.into_iter();
        let colours = colours.map(|(ink, rgb, area_px)| Colour { ink, rgb, area_px });
        let page = Page {
            name: self.name,
            table: 0,
            cut: Cut {
                cells: Vec::new(),
                rejected: rejected.collect(),
                warnings: warnings.collect(),
                skew_deg: self.skew_deg,
                upright: Affine::new(self.upright),
                specks: self.specks,
                colours: colours.collect(),
                // it has said what it had to when the page was cut
                misfit: None,
            },
            gain: self.gain,
            px_per_mm: self.px_per_mm,
        };
        Some((self.number, (letters.collect::<Option<_>>()?, page)))
    }
}

impl LetterRecord {
    fn of(letter: &Letter) -> Self {
        let plate = |(ink, paths): &(String, Vec<BezPath>)| {
            let paths = paths.iter().map(steps).collect();
            (ink.clone(), paths)
        };
        let ring = |c: &Contour| (c.blur_px(), c.points().iter().map(pair).collect());
        Self {
            sheet: letter.sheet.clone(),
            label: letter.label.0.clone(),
            index: letter.index,
            width: letter.picture.width(),
            height: letter.picture.height(),
            picture: letter.picture.bytes().to_vec(),
            in_sheet: corners(letter.in_sheet),
            baseline_px: letter.guides.baseline_px,
            px_per_em: letter.guides.px_per_em,
            row: letter.guides.row,
            edge: letter.edge.iter().map(ring).collect(),
            paths: letter.paths.iter().map(steps).collect(),
            plates: letter.plates.iter().map(plate).collect(),
            filled: letter.filled,
        }
    }

    fn letter(self) -> Option<Letter> {
        let drawn = |(ink, paths): (String, Vec<Vec<Step>>)| {
            let paths = paths.iter().map(|p| path(p)).collect();
            (ink, paths)
        };
        let ring = |(blur, points): (f64, Vec<(f64, f64)>)| {
            let points = points.into_iter().map(Point::from).collect();
            Some(Contour::new(points).ok()?.with_blur(blur))
        };
        Some(Letter {
            sheet: self.sheet,
            label: Label(self.label),
            index: self.index,
            picture: Png::new(self.width, self.height, self.picture),
            in_sheet: rect(self.in_sheet),
            guides: Guides {
                baseline_px: self.baseline_px,
                px_per_em: self.px_per_em,
                row: self.row,
            },
            edge: self.edge.into_iter().map(ring).collect::<Option<_>>()?,
            paths: self.paths.iter().map(|p| path(p)).collect(),
            plates: self.plates.into_iter().map(drawn).collect(),
            filled: self.filled,
        })
    }
}

fn pair(p: &Point) -> (f64, f64) {
    (*p).into()
}

/// Left, top, right and bottom.
pub(super) const fn corners(r: Rect) -> [f64; 4] {
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
