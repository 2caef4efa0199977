//! Rings of points around the ink, and what remains of them once cut at corners.
//!
//! Signs, once for the whole program (x right, y up):
//!
//! ```text
//!      y                 ink lies to the left of the way along a contour:
//!      │   ┌──◄──┐       an outer ring runs counter-clockwise and has positive area,
//!      │   ▼ ink ▲       a hole runs clockwise and has negative area.
//!      │   └──►──┘       A turn to the left is positive, and so is the curvature there.
//!      └─────────► x
//! ```

use kurbo::{Point, Rect};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use thiserror::Error;

/// Why points are no contour.
#[derive(Debug, Clone, PartialEq, Error)]
#[non_exhaustive]
pub enum ContourError {
    /// Fewer than three different points.
    #[error("a contour needs 3 different points, not {0}")]
    Short(usize),
    /// A coordinate is NaN or infinite.
    #[error("point {0} of the contour is not finite")]
    NotFinite(usize),
}

/// A closed ring of at least three finite points, px, y up; neighbours differ and the first point is
/// not repeated at the end.
///
/// As bytes it is its blur and its points.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(into = "(f64, Vec<Point>)", try_from = "(f64, Vec<Point>)")]
pub struct Contour {
    points: Vec<Point>,
    blur_px: f64,
    ragged_px: f64,
    scatter_px: f64,
}

impl Contour {
    /// What a pixel alone blurs an edge: the standard deviation of a box of 1 px.
    pub const PIXEL_BLUR_PX: f64 = 0.288_675_134_594_812_9;

    /// A ring through `points` in order. Neighbours that coincide, and a repeated first point, count once.
    ///
    /// # Errors
    /// A point is not finite, or fewer than three remain.
    pub fn new(mut points: Vec<Point>) -> Result<Self, ContourError> {
        if let Some(i) = points.iter().position(|p| !p.is_finite()) {
            return Err(ContourError::NotFinite(i));
        }
        points.dedup();
        while points.len() > 1 && points.first() == points.last() {
            points.pop();
        }
        if points.len() < 3 {
            Err(ContourError::Short(points.len()))
        } else {
            Ok(Self {
                points,
                blur_px: Self::PIXEL_BLUR_PX,
                ragged_px: 0.0,
                scatter_px: 0.0,
            })
        }
    }

    /// The points in order.
    #[must_use]
    pub fn points(&self) -> &[Point] {
        &self.points
    }

    /// A ring through other points, of the same picture.
    ///
    /// # Errors
    /// As [`Contour::new`].
    pub fn through(&self, points: Vec<Point>) -> Result<Self, ContourError> {
        let ring = Self::new(points)?;
        Ok(Self {
            points: ring.points,
            ..*self
        })
    }

    /// The same ring, from a picture whose edges are blurred by a Gaussian of standard deviation
    /// `blur_px`, the pixel's own box included; never less than [`Contour::PIXEL_BLUR_PX`].
    #[must_use]
    pub fn with_blur(mut self, blur_px: f64) -> Self {
        self.blur_px = blur_px.max(Self::PIXEL_BLUR_PX);
        self
    }

    /// How far the picture's edges are blurred, px: corners are rounded within about twice this.
    #[must_use]
    pub const fn blur_px(&self) -> f64 {
        self.blur_px
    }

    /// The same ring, of ink whose raggedness hides what is drawn within such a length, px.
    #[must_use]
    pub const fn with_ragged(mut self, ragged_px: f64) -> Self {
        self.ragged_px = ragged_px;
        self
    }

    /// Length along the edge, px, below which raggedness hides what is drawn; 0 for smooth edges.
    #[must_use]
    pub const fn ragged_px(&self) -> f64 {
        self.ragged_px
    }

    /// The same ring, of a picture whose edges are off by a standard deviation of `scatter_px`.
    #[must_use]
    pub const fn with_scatter(mut self, scatter_px: f64) -> Self {
        self.scatter_px = scatter_px;
        self
    }

    /// How far off its points are beyond what they show themselves, a standard deviation, px: those of the picture
    /// ([`Gray::scatter_px`]), and the wavering of ragged ink.
    ///
    /// [`Gray::scatter_px`]: super::Gray::scatter_px
    #[must_use]
    pub const fn scatter_px(&self) -> f64 {
        self.scatter_px
    }

    /// Length once around, px.
    #[must_use]
    pub fn length(&self) -> f64 {
        let ends = self.points.iter().zip(self.points.iter().cycle().skip(1));
        ends.map(|(a, b)| a.distance(*b)).sum()
    }

    /// Signed area, px²: positive for an outer ring, negative for a hole.
    #[must_use]
    pub fn area(&self) -> f64 {
        let last = self.points[self.points.len() - 1];
        let ends = self
            .points
            .iter()
            .scan(last, |a, &b| Some((std::mem::replace(a, b), b)));
        ends.map(|(a, b)| a.to_vec2().cross(b.to_vec2()))
            .sum::<f64>()
            / 2.0
    }

    /// The smallest upright rectangle around it, px.
    #[must_use]
    pub fn bounds(&self) -> Rect {
        let first = self.points[0];
        let start = Rect::from_points(first, first);
        self.points.iter().fold(start, |r, &p| r.union_pt(p))
    }

    /// Cuts the ring at strictly increasing indices; with none, the whole ring is one span.
    /// Indices out of range or out of order are passed over.
    #[must_use]
    pub fn cut(&self, corners: &[usize]) -> Spans {
        let n = self.points.len();
        let mut cuts: Vec<usize> = Vec::with_capacity(corners.len());
        for &i in corners {
            if i < n && cuts.last().is_none_or(|&c| c < i) {
                cuts.push(i);
            }
        }
        let Some(&start) = cuts.first() else {
            return Spans {
                points: self.points.clone(),
                ranges: Vec::new(),
                scatter_px: self.scatter_px,
            };
        };
        let mut points = Vec::with_capacity(n + 1);
        points.extend_from_slice(&self.points[start..]);
        points.extend_from_slice(&self.points[..=start]);
        let ends = cuts[1..].iter().map(|c| c - start).chain([n]);
        let ranges = ends
            .scan(0, |a, b| {
                let r = *a..b + 1;
                *a = b;
                Some(r)
            })
            .collect();
        Spans {
            points,
            ranges,
            scatter_px: self.scatter_px,
        }
    }
}

impl From<Contour> for (f64, Vec<Point>) {
    fn from(ring: Contour) -> Self {
        (ring.blur_px, ring.points)
    }
}

impl TryFrom<(f64, Vec<Point>)> for Contour {
    type Error = ContourError;

    fn try_from((blur_px, points): (f64, Vec<Point>)) -> Result<Self, ContourError> {
        Ok(Self::new(points)?.with_blur(blur_px))
    }
}

/// A contour cut at its corners. Stored closed and rotated, so that every span is a plain slice.
#[derive(Debug, Clone, PartialEq)]
pub struct Spans {
    points: Vec<Point>,
    ranges: Vec<Range<usize>>,
    scatter_px: f64,
}

impl Spans {
    /// How far off their points are beyond what they show themselves ([`Contour::scatter_px`]).
    #[must_use]
    pub const fn scatter_px(&self) -> f64 {
        self.scatter_px
    }

    /// The spans in order around the ring; each open one starts with the last point of the one before.
    pub fn iter(&self) -> impl Iterator<Item = Span<'_>> {
        let ring = self.ranges.is_empty().then_some(Span::Ring(&self.points));
        ring.into_iter().chain(
            self.ranges
                .iter()
                .map(|r| Span::Open(&self.points[r.clone()])),
        )
    }
}

/// A piece of contour without a corner inside, px, y up.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Span<'a> {
    /// From corner to corner, both included: at least two points.
    Open(&'a [Point]),
    /// A whole ring without corners; the first point is not repeated: at least three points.
    Ring(&'a [Point]),
}

impl<'a> Span<'a> {
    /// Its points in order.
    #[must_use]
    pub const fn points(self) -> &'a [Point] {
        match self {
            Self::Open(p) | Self::Ring(p) => p,
        }
    }

    /// Whether it closes on itself.
    #[must_use]
    pub const fn is_ring(self) -> bool {
        matches!(self, Self::Ring(_))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> Contour {
        let p = [
            (0.0, 0.0),
            (1.0, 0.0),
            (1.0, 0.0),
            (1.0, 1.0),
            (0.0, 1.0),
            (0.0, 0.0),
        ];
        Contour::new(p.iter().map(|&p| p.into()).collect()).unwrap()
    }

    #[test]
    fn coincident_points_count_once() {
        assert_eq!(square().points().len(), 4);
        assert!((square().area() - 1.0).abs() < 1e-12);
        assert_eq!(square().bounds(), Rect::new(0.0, 0.0, 1.0, 1.0));
        let p = Point::ORIGIN;
        assert_eq!(
            Contour::new(vec![p, p, (1.0, 0.0).into(), p]),
            Err(ContourError::Short(2))
        );
        let bad = vec![p, (f64::NAN, 0.0).into(), p];
        assert_eq!(Contour::new(bad), Err(ContourError::NotFinite(1)));
    }

    #[test]
    fn spans_go_around_once() {
        let c = square();
        assert_eq!(
            c.cut(&[]).iter().collect::<Vec<_>>(),
            [Span::Ring(c.points())]
        );
        for corners in [vec![2], vec![1, 3], vec![0, 1, 2, 3]] {
            let spans = c.cut(&corners);
            let lens: usize = spans.iter().map(|s| s.points().len() - 1).sum();
            assert_eq!(lens, 4, "each edge belongs to one span");
            assert_eq!(spans.iter().count(), corners.len());
            let all: Vec<_> = spans.iter().collect();
            for (i, s) in all.iter().enumerate() {
                assert_eq!(
                    s.points()[0],
                    c.points()[corners[i]],
                    "spans start at the corners"
                );
                let next = all[(i + 1) % all.len()].points()[0];
                assert_eq!(
                    s.points().last(),
                    Some(&next),
                    "and end where the next starts"
                );
            }
        }
        assert_eq!(
            c.cut(&[9, 3, 1]).iter().count(),
            1,
            "wrong indices are passed over"
        );
    }
}
