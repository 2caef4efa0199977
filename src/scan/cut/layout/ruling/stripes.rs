//! Where a lattice's lines lie: the stripes of the upright page that it covers for most of its length.

use crate::numeric::cast::index;
use crate::numeric::median::median;
use crate::numeric::surface::Surface;
use crate::scan::components::Component;
use kurbo::Point;
use std::iter;
use std::ops::Range;

/// Share of the lattice's length that a line of it covers at least.
const LONG: f64 = 0.5;
/// So many times as thick as the lattice's other lines is a row of letters that touch.
pub(super) const THICK: f64 = 1.6;
/// Share of what the lattice's lines usually cover; a stripe that covers less, and whose ink is as thick, is such a
/// row, too: letters at different heights have little ink in common.
const FULL: f64 = 0.85;
/// Places along a line at which the ink's thickness is measured.
const PLACES: u32 = 500;
/// How far a line's blurred and ragged edge reaches beyond where it covers so much, px.
const EDGE: f64 = 1.5;

/// The stripes down the page and across it in which a lattice, or a single line, has ink for most of its length.
pub(super) fn lines_of(lattice: &Component, upright: &Surface) -> [Vec<Range<f64>>; 2] {
    let b = lattice.upright;
    let at = |x: usize, y: usize| upright.at(Point::new(x as f64 + 0.5, y as f64 + 0.5));
    let mut profiles = [b.width(), b.height()].map(|length| vec![0.0; index(length) + 2]);
    for (x, y) in lattice.pixels() {
        let p = at(x, y) - b.origin();
        for (profile, v) in profiles.iter_mut().zip([p.x, p.y]) {
            if let Some(ink) = profile.get_mut(index(v)) {
                *ink += 1.0;
            }
        }
    }
    let ink = inked(lattice, upright);
    let found = [
        stripes(&profiles[0], b.x0, b.y0..b.y1, |y, x| ink(x, y)),
        stripes(&profiles[1], b.y0, b.x0..b.x1, &ink),
    ];
    let usual = |of: fn(&Covered) -> f64| median(found.iter().flatten().map(of)).unwrap_or(0.0);
    let (share, thick) = (usual(|s| s.share), usual(|s| s.thick));
    let is_line = |s: &Covered| s.share >= FULL * share || s.thick <= THICK * thick;
    found.map(|all| all.into_iter().filter(is_line).map(|s| s.line).collect())
}

/// Whether there is ink of a lattice at a place of the upright page.
pub(super) fn inked(lattice: &Component, upright: &Surface) -> impl Fn(f64, f64) -> bool {
    let back = upright.inverse();
    move |x, y| {
        let p = back.at(Point::new(x, y));
        lattice.covers(index(p.x.max(0.0)), index(p.y.max(0.0)))
    }
}

/// A stripe that a lattice covers for most of its length.
struct Covered {
    line: Range<f64>,
    /// The share of its length that is ink where most is.
    share: f64,
    /// How thick the ink is there, px: half of it is thicker.
    thick: f64,
}

/// Where a profile that begins at `start` is that of a line between these ends; `ink` takes places along it and
/// across.
fn stripes(
    profile: &[f64],
    start: f64,
    ends: Range<f64>,
    ink: impl Fn(f64, f64) -> bool,
) -> Vec<Covered> {
    let length = ends.end - ends.start;
    let mut out = Vec::new();
    let mut at = start;
    for bins in profile.chunk_by(|a, b| (*a < LONG * length) == (*b < LONG * length)) {
        let line = at..at + bins.len() as f64;
        at = line.end;
        let most = bins.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
        let Some((deep, most)) = most.filter(|_| bins.iter().all(|bin| *bin >= LONG * length))
        else {
            continue;
        };
        let middle = line.start + deep as f64 + 0.5;
        out.push(Covered {
            share: most / length,
            thick: thickness(&ends, (&line, middle), &ink),
            line: line.start - EDGE..line.end + EDGE,
        });
    }
    out
}

/// The median thickness of the ink between these ends that lies across a line's middle, px.
fn thickness(
    ends: &Range<f64>,
    (line, middle): (&Range<f64>, f64),
    ink: impl Fn(f64, f64) -> bool,
) -> f64 {
    // beyond lies what crosses the line
    let most = 4.0 * (line.end - line.start + EDGE);
    let places = (0..PLACES).map(|i| (f64::from(i) + 0.5) / f64::from(PLACES));
    let along = places.map(|share| ends.start + share * (ends.end - ends.start));
    let reach = |v: f64, step: f64| {
        let steps = iter::successors(Some(step), |off| Some(off + step));
        let within = steps.take_while(|off| off.abs() < most && ink(v, middle + off));
        within.count() as f64
    };
    let here = along.filter(|&v| ink(v, middle));
    median(here.map(|v| reach(v, -1.0) + 1.0 + reach(v, 1.0))).unwrap_or(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::components::components;
    use crate::types::Gray;
    use kurbo::Affine;

    /// Letters of a row that touch, and cover more than half of it at some height, but not as much as a line does.
    #[test]
    fn a_row_of_letters_that_touch_is_no_line() {
        // a lattice of 500 × 240 px, its lines 3 px thick, and strokes 7 px thick across two thirds of its second row
        let line = |v: usize, pitch: usize| v % pitch < 3;
        let stroke = |x: usize, y: usize| {
            let off = [0, 2, 1, 3][(x / 40) % 4];
            (90..430).contains(&x) && (118 + off..125 + off).contains(&y)
        };
        let gray = Gray::from_fn(503, 243, |x, y| {
            let ink = line(x, 100) || line(y, 80) || stroke(x, y);
            if ink { 1.0 } else { 0.0 }
        });
        let all = components(&gray, 0.25, 0.5);
        assert_eq!(all.len(), 1);
        let [columns, rows] = lines_of(&all[0], &Affine::IDENTITY.into());
        let middles = |lines: Vec<Range<f64>>| -> Vec<f64> {
            lines.iter().map(|l| (l.start + l.end) / 2.0).collect()
        };
        assert_eq!(middles(columns), [1.5, 101.5, 201.5, 301.5, 401.5, 501.5]);
        assert_eq!(middles(rows), [1.5, 81.5, 161.5, 241.5]);
    }
}
