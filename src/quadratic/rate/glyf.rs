//! The bytes of a simple glyph, as the `glyf` table stores them.
//!
//! A point costs its flag (a run of three or more equal flags costs two bytes) and, for x and y
//! each, nothing where the coordinate stays, one byte up to a step of 255 units, two beyond. The
//! header is 10 bytes, a contour 2, the instruction length 2. Padding is the file's, not the glyph's.

use crate::types::Outline;
use kurbo::{BezPath, PathEl, Point};

/// A stored point: x, y in whole units; whether the curve passes through it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Stored {
    pub(super) x: i32,
    pub(super) y: i32,
    pub(super) on: bool,
}

impl Stored {
    /// An on-curve point at the nearest whole units, halves upwards as the font compilers round.
    #[expect(
        clippy::cast_possible_truncation,
        reason = "`as` saturates, and the writer refuses what exceeds 16 bits"
    )]
    pub(super) fn on(p: Point) -> Self {
        // `f64::floor` is a call here: truncated, and one less where that went up.
        let near = |v: f64| {
            let cut = (v + 0.5) as i32;
            cut.saturating_sub(i32::from(f64::from(cut) > v + 0.5))
        };
        Self {
            x: near(p.x),
            y: near(p.y),
            on: true,
        }
    }

    /// A control point, rounded likewise.
    pub(super) fn off(p: Point) -> Self {
        Self {
            on: false,
            ..Self::on(p)
        }
    }

    pub(super) fn point(self) -> Point {
        Point::new(f64::from(self.x), f64::from(self.y))
    }
}

/// Where the writing stands: the last point, its flag, and how often the flag has been repeated.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Pen {
    x: i32,
    y: i32,
    flag: Option<u8>,
    run: u8,
}

impl Pen {
    /// After a point whose flag is not known.
    pub(super) const fn after(p: Stored) -> Self {
        Self {
            x: p.x,
            y: p.y,
            flag: None,
            run: 0,
        }
    }

    /// Stores a point; answers the bytes it adds.
    pub(super) fn store(&mut self, p: Stored) -> u32 {
        let (dx, dy) = (p.x - self.x, p.y - self.y);
        let (fx, bx) = delta(dx);
        let (fy, by) = delta(dy);
        let flag = u8::from(p.on) | fx << 1 | fy << 2;
        if self.flag == Some(flag) && self.run < u8::MAX {
            self.run += 1;
        } else {
            self.run = 0;
        }
        (self.x, self.y, self.flag) = (p.x, p.y, Some(flag));
        // A first repeat costs the byte it saves; from the second on repeats are free.
        u32::from(self.run < 2) + bx + by
    }
}

/// The flag bits of a step (short: bit 0, same or positive: bit 3) and its bytes.
fn delta(d: i32) -> (u8, u32) {
    match d {
        0 => (8, 0),
        1..=255 => (9, 1),
        -255..=-1 => (1, 1),
        _ => (0, 2),
    }
}

/// A contour's stored points: implied on-curve points left out, the first point as the path begins.
pub(super) fn points(path: &BezPath) -> Vec<Stored> {
    let mut all: Vec<(Point, bool)> = Vec::new();
    for el in path.elements() {
        match *el {
            PathEl::MoveTo(p) | PathEl::LineTo(p) => all.push((p, true)),
            PathEl::QuadTo(c, p) => all.extend([(c, false), (p, true)]),
            PathEl::CurveTo(a, b, p) => all.extend([(a, false), (b, false), (p, true)]),
            PathEl::ClosePath => {}
        }
    }
    if all.len() > 1 && all.first() == all.last() {
        all.pop();
    }
    let n = all.len();
    let implied = |i: usize| {
        let ((p, on), (a, before), (b, after)) = (all[i], all[(i + n - 1) % n], all[(i + 1) % n]);
        if !on || before || after {
            return false;
        }
        let (r, s, t) = (Stored::on(p), Stored::on(a), Stored::on(b));
        a.midpoint(b).distance(p) < 1e-9 || (s.x + t.x == 2 * r.x && s.y + t.y == 2 * r.y)
    };
    let kept = (0..n).filter(|&i| !implied(i));
    kept.map(|i| Stored {
        on: all[i].1,
        ..Stored::on(all[i].0)
    })
    .collect()
}

/// What an outline of lines and quadratics takes in the `glyf` table, bytes without padding; contours run clockwise
/// outside as TrueType stores them, coordinates are rounded, on-curve points half way between off-curve neighbours
/// dropped.
#[must_use]
pub fn glyf_bytes(outline: &Outline) -> u32 {
    let turned = outline.contours().iter().map(BezPath::reverse_subpaths);
    let contours: Vec<Vec<Stored>> = turned.map(|p| points(&p)).collect();
    stored_bytes(&contours)
}

/// The points that an outline of lines and quadratics stores, implied ones left out.
#[must_use]
pub fn glyf_points(outline: &Outline) -> usize {
    outline.contours().iter().map(|p| points(p).len()).sum()
}

pub(super) fn stored_bytes(contours: &[Vec<Stored>]) -> u32 {
    let mut pen = Pen::after(Stored {
        x: 0,
        y: 0,
        on: false,
    });
    let points: u32 = contours.iter().flatten().map(|&p| pen.store(p)).sum();
    let ends = contours.iter().map(|_| 2).sum::<u32>();
    if contours.is_empty() {
        0
    } else {
        12 + ends + points
    }
}
