//! Ink of letters that touch and a stretch of it → the border between them.
//!
//! The shortest path through lanes of pixels, from the first lane to the last, where a pixel of ink is far and one of
//! paper near: letters that lie over each other are parted along the paper between them, and ink is cut only where
//! they touch. Two letters meet in corners that the paper between them fills, and a stroke has straight edges: a path
//! into ink or out of it is the longer, the less ink lies around.

use crate::numeric::cast::index;
use crate::numeric::surface::Surface;
use crate::scan::components::Component;
use kurbo::Point;
use std::ops::Range;

/// A pixel of ink is as far as so many of paper.
const INK: f64 = 16.0;
/// A way through an edge is as far as so many strokes for each share of ink that is missing around it.
const EDGE: f64 = 4.0;
/// And as none from this share of ink on.
const FULL: f64 = 0.8;
/// Ink at the stretch's ends is by so much farther than at its middle.
const ASIDE: f64 = 2.0;

/// How letters that touch follow each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::scan::cut::layout) enum Along {
    /// Beside each other: lanes are rows of pixels.
    Row,
    /// Below each other: lanes are columns.
    Column,
}

impl Along {
    /// Lane and place of a pixel, or the pixel at a place of a lane.
    const fn turned(self, (x, y): (usize, usize)) -> (usize, usize) {
        match self {
            Self::Row => (y, x),
            Self::Column => (x, y),
        }
    }

    /// How far a pixel is along it, upright px.
    pub(in crate::scan::cut::layout) fn at(self, (x, y): (usize, usize), upright: &Surface) -> f64 {
        let at = upright.at(Point::new(x as f64 + 0.5, y as f64 + 0.5));
        match self {
            Self::Row => at.x,
            Self::Column => at.y,
        }
    }
}

/// The border between two letters.
#[derive(Debug)]
pub(super) struct Seam {
    along: Along,
    /// The first lane.
    start: usize,
    /// Where the second letter begins in each lane.
    at: Vec<usize>,
}

impl Seam {
    /// The border within a stretch of upright px, of such ones that are as good the nearest to its middle; `None`
    /// where there is no ink.
    pub(super) fn within(
        stretch: &Range<f64>,
        (along, ink): (Along, &[Component]),
        upright: &Surface,
    ) -> Option<Self> {
        let bounds = ink.iter().map(|c| c.bounds).reduce(|a, b| a.union(b))?;
        let stroke = ink.iter().max_by_key(|c| c.area)?.stroke().max(1.0);
        let (start, left) = along.turned((index(bounds.x0), index(bounds.y0)));
        let (end, right) = along.turned((index(bounds.x1), index(bounds.y1)));
        let at = |lane: usize, place: usize| along.at(along.turned((lane, place)), upright);
        let nearest = |lane: usize, to: f64| {
            let off = |place: &usize| (at(lane, *place) - to).abs();
            (left..right).min_by(|a, b| off(a).total_cmp(&off(b)))
        };
        let ends =
            [start, end - 1].map(|lane| [stretch.start, stretch.end].map(|to| nearest(lane, to)));
        let ends = || ends.iter().flatten().flatten().copied();
        let reach = index(stroke);
        let first = ends().min()?.saturating_sub(reach).max(left);
        let last = (ends().max()? + 1 + reach).min(right);
        let half = ((stretch.end - stretch.start) / 2.0).max(1.0);
        let middle = stretch.start + half;
        let mut field = Field::new(last - first, end - start, half);
        for lane in start..end {
            let own = nearest(lane, middle)?.clamp(first, last - 1);
            let inside = |place: usize| place == own || stretch.contains(&at(lane, place));
            field.open.extend((first..last).map(inside));
            field.middles.push(own - first);
        }
        for (lane, place) in ink.iter().flat_map(|c| c.pixels()).map(|p| along.turned(p)) {
            if (first..last).contains(&place) {
                field.ink[(lane - start) * field.width + place - first] = true;
            }
        }
        field.weigh(stroke);
        let path = field.shortest()?;
        let at = path.into_iter().map(|place| first + place).collect();
        Some(Self { along, start, at })
    }

    /// Whether a pixel is the first letter's.
    pub(super) fn is_before(&self, x: usize, y: usize) -> bool {
        let (lane, place) = self.along.turned((x, y));
        let at = lane.checked_sub(self.start).and_then(|k| self.at.get(k));
        at.is_some_and(|&at| place < at)
    }
}

/// Pixels by lanes.
struct Field {
    width: usize,
    ink: Vec<bool>,
    /// Where a border may run.
    open: Vec<bool>,
    /// How far the edge of a pixel of ink is.
    edges: Vec<f64>,
    /// Where the border runs in each lane if nothing says otherwise.
    middles: Vec<usize>,
    /// From there to the ends, px.
    half: f64,
}

impl Field {
    fn new(width: usize, lanes: usize, half: f64) -> Self {
        Self {
            width,
            ink: vec![false; width * lanes],
            open: Vec::with_capacity(width * lanes),
            edges: Vec::new(),
            middles: Vec::with_capacity(lanes),
            half,
        }
    }

    /// Measures the edges of strokes so many px wide.
    fn weigh(&mut self, stroke: f64) {
        let (width, lanes, reach) = (self.width, self.middles.len(), index(stroke));
        // sums of the ink before each lane and place
        let mut sums = vec![0_usize; (width + 1) * (lanes + 1)];
        for lane in 0..lanes {
            let mut sum = 0;
            for place in 0..width {
                sum += usize::from(self.ink[lane * width + place]);
                sums[(lane + 1) * (width + 1) + place + 1] =
                    sums[lane * (width + 1) + place + 1] + sum;
            }
        }
        let side = (2 * reach + 1) as f64;
        let share = |lane: usize, place: usize| {
            let (up, down) = (lane.saturating_sub(reach), (lane + reach + 1).min(lanes));
            let (left, right) = (place.saturating_sub(reach), (place + reach + 1).min(width));
            let sum = |lane: usize, place: usize| sums[lane * (width + 1) + place];
            let ink = sum(down, right) + sum(up, left) - sum(up, right) - sum(down, left);
            ink as f64 / (side * side)
        };
        let far = |(lane, place)| {
            let lacks = (FULL - share(lane, place)).max(0.0);
            INK * self.aside(lane * width + place) * EDGE * stroke * lacks
        };
        let pixels = (0..lanes).flat_map(|lane| (0..width).map(move |place| (lane, place)));
        self.edges = pixels.map(far).collect();
    }

    /// How far it is from one pixel to the next; the paper around the field is no pixel.
    fn step(&self, from: Option<usize>, to: usize) -> f64 {
        if !self.open[to] {
            return f64::INFINITY;
        }
        let was_ink = from.is_some_and(|from| self.ink[from]);
        match (was_ink, self.ink[to], from) {
            (true, true, _) => INK * self.aside(to),
            (false, true, _) => INK * self.aside(to) + self.edges[to],
            (true, false, Some(from)) => 1.0 + self.edges[from],
            _ => 1.0,
        }
    }

    /// How much farther ink is at a pixel than at the middle.
    fn aside(&self, pixel: usize) -> f64 {
        let (lane, place) = (pixel / self.width, pixel % self.width);
        1.0 + ASIDE * place.abs_diff(self.middles[lane]) as f64 / self.half
    }

    /// Where the shortest path leaves each lane; it begins and ends at the middles of the first and the last one.
    fn shortest(&self) -> Option<Vec<usize>> {
        let width = self.width;
        let (first, last) = (*self.middles.first()?, *self.middles.last()?);
        let apart = |place: usize, middle: usize| place.abs_diff(middle) as f64;
        let mut lengths: Vec<f64> = (0..width).map(|p| apart(p, first)).collect();
        let mut ways: Vec<Vec<usize>> = Vec::with_capacity(self.middles.len());
        for start in (0..self.ink.len()).step_by(width) {
            // straight on, or along the lane from either side
            let mut way: Vec<usize> = (0..width).collect();
            for (place, length) in lengths.iter_mut().enumerate() {
                *length += self.step((start + place).checked_sub(width), start + place);
            }
            let mut step = |from: usize, to: usize| {
                let length = lengths[from] + self.step(Some(start + from), start + to);
                if length < lengths[to] {
                    (lengths[to], way[to]) = (length, way[from]);
                }
            };
            (1..width).for_each(|p| step(p - 1, p));
            (1..width).rev().for_each(|p| step(p, p - 1));
            ways.push(way);
        }
        let end = ways.len().saturating_sub(1) * width;
        let leave = |place: usize| {
            let edge = if self.ink[end + place] {
                self.edges[end + place]
            } else {
                0.0
            };
            lengths[place] + edge + apart(place, last)
        };
        let mut at = (0..width).min_by(|&a, &b| leave(a).total_cmp(&leave(b)))?;
        let mut path = vec![0; ways.len()];
        for (place, way) in path.iter_mut().zip(&ways).rev() {
            *place = at;
            at = way[at];
        }
        Some(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan::components::components;
    use crate::types::Gray;
    use kurbo::{Affine, Rect};

    /// The borders by rows, and by columns of the same ink turned over.
    fn borders(bars: &[Rect], stretch: Range<f64>) -> [Vec<usize>; 2] {
        [Along::Row, Along::Column].map(|along| {
            let gray = Gray::from_fn(120, 120, |x, y| {
                let (y, x) = along.turned((x, y));
                let here = |b: &Rect| b.contains(Point::new(x as f64 + 0.5, y as f64 + 0.5));
                f32::from(u8::from(bars.iter().any(here)))
            });
            let ink = components(&gray, 0.5, 0.5);
            let upright = Surface::from(Affine::IDENTITY);
            Seam::within(&stretch, (along, &ink), &upright).unwrap().at
        })
    }

    #[test]
    fn letters_that_lie_over_each_other_are_parted_where_they_touch() {
        // two hooks: the first one's tail runs under the second one and touches its stem's end
        let bars = [
            Rect::new(10.0, 10.0, 18.0, 90.0),
            Rect::new(10.0, 82.0, 84.0, 90.0),
            Rect::new(60.0, 10.0, 68.0, 82.0),
            Rect::new(68.0, 40.0, 110.0, 48.0),
        ];
        for border in borders(&bars, 41.0..91.0) {
            // lanes begin at the ink's top
            assert!(
                border[..68].iter().all(|&x| (19..=60).contains(&x)),
                "{border:?}"
            );
            assert!(border[73..].iter().all(|&x| x >= 84), "{border:?}");
        }
    }

    #[test]
    fn a_bar_is_cut_in_the_middle() {
        for border in borders(&[Rect::new(0.0, 50.0, 120.0, 60.0)], 40.0..80.0) {
            assert!(border.iter().all(|&x| x.abs_diff(60) <= 1), "{border:?}");
        }
    }

    #[test]
    fn a_touch_is_cut_and_not_the_thinner_stroke_beside_it() {
        // two thick letters that touch for 14 px, and a stroke of 8 px in the first one
        let bars = [
            Rect::new(5.0, 10.0, 20.0, 60.0),
            Rect::new(20.0, 31.0, 40.0, 39.0),
            Rect::new(40.0, 10.0, 60.0, 60.0),
            Rect::new(60.0, 46.0, 100.0, 110.0),
        ];
        for border in borders(&bars, 25.0..95.0) {
            assert!(
                border[36..50].iter().all(|&x| x.abs_diff(60) <= 1),
                "{border:?}"
            );
        }
    }
}
