//! Where things lie on a page, in mm, y down, origin at the paper's top left corner.

#[cfg(test)]
mod tests;

use super::TemplateError;
use crate::numeric::cast::index;
use crate::types::Direction;
use kurbo::{Point, Rect, Size};
use serde::{Deserialize, Serialize};
use std::fmt;

/// Paper to print on.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Paper {
    /// 210 × 297 mm.
    #[default]
    #[serde(alias = "A4")]
    A4,
    /// 215.9 × 279.4 mm.
    #[serde(alias = "Letter")]
    Letter,
    /// Width and height, mm.
    Size(f64, f64),
}

/// How a page is divided; everything a user may set.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Layout {
    /// Paper to print on.
    pub paper: Paper,
    /// Cells in a row, 1…40; left out, 8 or as many as `cell_mm` allows.
    pub columns: Option<usize>,
    /// Rows of cells, 1…40; left out, 9 or as many as `cell_mm` allows.
    pub rows: Option<usize>,
    /// Least width and height of a cell with its caption, mm, where `columns` or `rows` is left out.
    pub cell_mm: Option<[f64; 2]>,
    /// Fields in places of their own instead of rows and columns, in the order of the glyphs; every page has them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub cells: Vec<Field>,
    /// Size of the em on paper, mm; left out, the largest that fits the cell.
    pub em_mm: Option<f64>,
    /// Guide above the baseline, em.
    pub ascender: f64,
    /// Guide of the capitals, em.
    pub cap_height: f64,
    /// Guide of x, em.
    pub x_height: f64,
    /// Guide below the baseline, em, at most 0.
    pub descender: f64,
    /// Lower and upper edge of the joining stroke of Arabic letters, em.
    pub joining: [f64; 2],
}

/// A field to draw in.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Field {
    /// Left, top, right and bottom from the paper's top left corner, mm; the caption stands above it.
    pub field: [f64; 4],
    /// The baseline's distance from the paper's upper edge, mm; left out, where the em stands in the field's middle.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub baseline: Option<f64>,
}

impl Field {
    const fn rect(&self) -> Rect {
        let [x0, y0, x1, y1] = self.field;
        Rect { x0, y0, x1, y1 }
    }
}

impl Default for Layout {
    fn default() -> Self {
        Self {
            paper: Paper::A4,
            columns: None,
            rows: None,
            cell_mm: None,
            cells: Vec::new(),
            em_mm: None,
            ascender: 0.80,
            cap_height: 0.70,
            x_height: 0.50,
            descender: -0.35,
            joining: [0.0, 0.07],
        }
    }
}

/// Centre of a ring mark from the paper's edges: outside every printer's blind border. mm
const MARK_INSET: f64 = 11.0;
/// Above the cells: marks, code and title. mm
const HEAD: f64 = 25.0;
/// Below the cells: marks and the gain strip. mm
const FOOT: f64 = 21.0;
/// Beside the cells: inside the marks' clear zone. mm
const SIDE: f64 = 10.0;
/// Height of the caption above a cell's drawing field. mm
const CAPTION: f64 = 3.6;
/// Between two drawing fields. mm
const GAP: f64 = 0.8;
/// Least distance of ascender and descender, em.
const LEAST_LINE: f64 = 0.1;
/// Left free above the ascender and below the descender, share of the field's height.
const AIR: f64 = 0.06;
/// Edge of the QR code, quiet zone not counted. mm
const CODE_SIZE: f64 = 15.0;

/// One cell's place on its page.
#[derive(Debug, Clone, PartialEq)]
pub struct Place {
    /// What is to be drawn in it.
    pub label: String,
    /// Where it stands in the glyph list, from 0.
    pub index: usize,
    /// The field to draw in.
    pub field: Rect,
    /// Top left corner of the caption.
    pub caption: Point,
    /// The baseline's height on the page.
    pub baseline: f64,
}

/// What a page's QR code says: which printing it belongs to and its number.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Code {
    /// Eight hexadecimal digits from the project's name, the layout and the glyph list.
    pub id: String,
    /// Page number, from 1.
    pub page: usize,
    /// Pages of the printing.
    pub pages: usize,
}

impl Code {
    /// Reads what [`fmt::Display`] writes.
    #[must_use]
    pub fn parse(text: &str) -> Option<Self> {
        let mut words = text.strip_prefix("KHATT1 ")?.split(' ');
        let id = words.next().filter(|w| w.len() == 8)?.to_owned();
        let (page, pages) = words.next()?.split_once('/')?;
        let (page, pages) = (page.parse().ok()?, pages.parse().ok()?);
        let fine = words.next().is_none() && (1..=pages).contains(&page);
        fine.then_some(Self { id, page, pages })
    }
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "KHATT1 {} {}/{}", self.id, self.page, self.pages)
    }
}

impl Layout {
    /// Checks every option.
    ///
    /// # Errors
    /// The first one that is out of range, or an em that does not fit the cell.
    pub fn check(&self) -> Result<(), TemplateError> {
        let bad = |option, value: String, range| {
            Err(TemplateError::Option {
                option,
                value,
                range,
            })
        };
        let size = self.paper_mm();
        if !(120.0..=1200.0).contains(&size.width) || !(120.0..=1700.0).contains(&size.height) {
            return bad(
                "paper",
                format!("{size}"),
                "it must be 120 × 120 mm to 1200 × 1700 mm",
            );
        }
        if let Some(cell) = self.cell_mm.filter(|c| !c.iter().all(|v| *v >= 3.0)) {
            let range = "a cell must be at least 3 × 3 mm";
            return bad("cell_mm", format!("{cell:?}"), range);
        }
        self.check_cells()?;
        for (option, n) in [("columns", self.columns()), ("rows", self.rows())] {
            if !(1..=MOST).contains(&n) {
                let range = "it must be 1 to 40, and a page must hold a cell of cell_mm";
                return bad(option, n.to_string(), range);
            }
        }
        let heights = [
            self.descender,
            0.0,
            self.x_height,
            self.cap_height,
            self.ascender,
        ];
        let names = ["descender", "x_height", "cap_height", "ascender"];
        for (pair, option) in heights.windows(2).zip(names) {
            if !(pair[1] >= pair[0] && pair.iter().all(|h| h.abs() <= 2.0)) {
                let range = "the guides must rise from descender (at most 0) over x_height and cap_height to ascender, within 2 em";
                return bad(option, format!("{}", self.height(option)), range);
            }
        }
        if self.ascender - self.descender < LEAST_LINE {
            let range = "ascender and descender must be at least 0.1 em apart";
            return bad("ascender", format!("{}", self.ascender), range);
        }
        if !(self.joining[0] < self.joining[1] && self.joining.iter().all(|h| h.abs() <= 2.0)) {
            return bad(
                "joining",
                format!("{:?}", self.joining),
                "the lower edge must come first",
            );
        }
        let largest = self.largest_em();
        if self.em().is_nan() || !(2.0..=largest + 1e-9).contains(&self.em()) {
            let range = "it must be 2 mm to what a cell holds; use fewer rows or columns, or a smaller em_mm";
            return bad("em_mm", format!("{:.1}", self.em()), range);
        }
        Ok(())
    }

    /// Checks the fields that stand in places of their own.
    fn check_cells(&self) -> Result<(), TemplateError> {
        let room = self.body_mm();
        let taken = |c: &Field| {
            let r = c.rect();
            Rect::new(r.x0, r.y0 - CAPTION, r.x1, r.y1)
        };
        let bad = |(i, c): &(usize, &Field)| {
            let (r, line) = (c.rect(), c.baseline.unwrap_or(c.field[3]));
            let apart = |o: &Field| taken(o).intersect(taken(c)).area() <= 0.0;
            let fine = r.width() >= LEAST
                && r.height() >= LEAST
                && room.contains_rect(taken(c))
                && (r.y0..=r.y1).contains(&line)
                && self.cells[..*i].iter().all(apart);
            !fine
        };
        let first = self.cells.iter().enumerate().find(bad);
        first.map_or(Ok(()), |(_, c)| {
            Err(TemplateError::Option {
                option: "cells",
                value: format!("{:?}", c.field),
                range: "a field is left, top, right, bottom in mm, at least 3 × 3 mm, its baseline inside, 3.6 mm free above \
                        it for the caption, 10 mm from the paper's sides, 25 mm from its top, 21 mm from its foot, and \
                        meets no other",
            })
        })
    }

    fn height(&self, option: &str) -> f64 {
        match option {
            "descender" => self.descender,
            "x_height" => self.x_height,
            "cap_height" => self.cap_height,
            _ => self.ascender,
        }
    }

    /// Size of the paper.
    pub(crate) const fn paper_mm(&self) -> Size {
        match self.paper {
            Paper::A4 => Size::new(210.0, 297.0),
            Paper::Letter => Size::new(215.9, 279.4),
            Paper::Size(w, h) => Size::new(w, h),
        }
    }

    /// The part of the page that is divided into cells.
    pub(crate) fn body_mm(&self) -> Rect {
        let paper = self.paper_mm();
        Rect::new(SIDE, HEAD, paper.width - SIDE, paper.height - FOOT)
    }

    fn body(&self) -> Size {
        self.body_mm().size()
    }

    /// Cells in a row.
    #[must_use]
    pub fn columns(&self) -> usize {
        let fit = self.cell_mm.map(|c| fit(self.body().width, c[0]));
        self.columns.or(fit).unwrap_or(8)
    }

    /// Rows of cells.
    #[must_use]
    pub fn rows(&self) -> usize {
        let fit = self.cell_mm.map(|c| fit(self.body().height, c[1]));
        self.rows.or(fit).unwrap_or(9)
    }

    fn pitch(&self) -> Size {
        let (columns, rows) = (self.columns() as f64, self.rows() as f64);
        Size::new(self.body().width / columns, self.body().height / rows)
    }

    fn field(&self) -> Size {
        let pitch = self.pitch();
        Size::new(pitch.width - GAP, pitch.height - CAPTION - GAP)
    }

    fn largest_em(&self) -> f64 {
        let own = self.cells.iter().map(|c| c.rect().height());
        let height = own.reduce(f64::min).unwrap_or(self.field().height);
        height * (1.0 - 2.0 * AIR) / (self.ascender - self.descender)
    }

    /// Size of the em on paper, mm.
    #[must_use]
    pub fn em(&self) -> f64 {
        self.em_mm.unwrap_or_else(|| self.largest_em())
    }

    /// Cells a page.
    #[must_use]
    pub fn per_page(&self) -> usize {
        if self.cells.is_empty() {
            self.columns() * self.rows()
        } else {
            self.cells.len()
        }
    }

    /// Centres of the four ring marks: top left, top right, bottom right, bottom left.
    #[must_use]
    pub fn marks(&self) -> [Point; 4] {
        let s = self.paper_mm();
        let (x, y) = (s.width - MARK_INSET, s.height - MARK_INSET);
        [
            (MARK_INSET, MARK_INSET),
            (x, MARK_INSET),
            (x, y),
            (MARK_INSET, y),
        ]
        .map(Point::from)
    }

    /// The QR code's square, beside the top left mark.
    #[must_use]
    pub fn code(&self) -> Rect {
        let top_left = Point::new(MARK_INSET + 9.0, 5.0);
        Rect::from_origin_size(top_left, (CODE_SIZE, CODE_SIZE))
    }

    /// The strip at the foot that holds the patterns from which ink gain is measured.
    pub(crate) fn gain_strip(&self) -> Rect {
        let s = self.paper_mm();
        Rect::new(
            MARK_INSET + 9.0,
            s.height - 16.0,
            s.width - MARK_INSET - 9.0,
            s.height - 7.0,
        )
    }

    /// The cells of every page, in reading order; `"_"` leaves a cell out.
    #[must_use]
    pub fn places(&self, labels: &[String], direction: Direction) -> Vec<Vec<Place>> {
        let chunks = labels.chunks(self.per_page().max(1)).enumerate();
        chunks
            .map(|(page, chunk)| {
                let cells = chunk.iter().enumerate().filter(|(_, l)| l.as_str() != "_");
                cells
                    .map(|(i, label)| self.place(page, i, label, direction))
                    .collect()
            })
            .collect()
    }

    fn place(&self, page: usize, i: usize, label: &str, direction: Direction) -> Place {
        let cell = self.cells.get(i);
        let (field, caption) = match cell.map(Field::rect) {
            Some(r) => (r, Point::new(r.x0, r.y0 - CAPTION + 0.2)),
            None => self.lattice(i, direction),
        };
        let baseline = cell.and_then(|c| c.baseline);
        Place {
            label: label.to_owned(),
            index: page * self.per_page() + i,
            field,
            caption,
            baseline: baseline.unwrap_or_else(|| self.line(field)),
        }
    }

    /// A field of rows and columns, and its caption's corner.
    fn lattice(&self, i: usize, direction: Direction) -> (Rect, Point) {
        let columns = self.columns();
        let (row, column) = (i / columns, i % columns);
        let column = match direction {
            Direction::Ltr => column,
            Direction::Rtl => columns - 1 - column,
        };
        let (pitch, size) = (self.pitch(), self.field());
        let corner = Point::new(
            SIDE + column as f64 * pitch.width,
            HEAD + row as f64 * pitch.height,
        );
        let field = Rect::from_origin_size(corner + (GAP / 2.0, CAPTION + GAP / 2.0), size);
        (field, corner + (GAP / 2.0, 0.6))
    }

    /// The baseline of a field: what the em leaves of it lies half above and half below.
    fn line(&self, field: Rect) -> f64 {
        let spare = field.height() - (self.ascender - self.descender) * self.em();
        field.y0 + spare / 2.0 + self.ascender * self.em()
    }

    /// The identity that every page of a printing carries: from its name and from what stands where, so that
    /// pages printed once are known as long as these stay the same.
    #[must_use]
    pub fn id(&self, project: &str, places: &[Vec<Place>]) -> String {
        let paper = self.paper_mm();
        let mut text = format!("{project}\n{:.2} {:.2}\n", paper.width, paper.height);
        text += &format!("{:.2}\n", self.em());
        let pages = places.iter().zip(1_usize..);
        for (place, page) in pages.flat_map(|(places, n)| places.iter().map(move |p| (p, n))) {
            let f = place.field;
            let field = [f.x0, f.y0, f.x1, f.y1, place.baseline].map(|v| format!("{v:.2}"));
            text += &format!("{page} {} {}\n", place.label, field.join(" "));
        }
        let hash = blake3::hash(text.as_bytes());
        let digits = hash.as_bytes().iter().take(4);
        digits.map(|b| format!("{b:02X}")).collect()
    }
}

/// Cells a page may have in a row or column.
const MOST: usize = 40;
/// Sides of a field at least. mm
const LEAST: f64 = 3.0;

/// How many cells of at least `cell` mm fit a length.
fn fit(length: f64, cell: f64) -> usize {
    index(length / cell + 1e-9).min(MOST)
}
