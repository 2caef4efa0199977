//! A letter drawn alike that lies free → where an edge of one beneath other ink runs.
//!
//! Arabic letters that differ by their dots alone are drawn alike, and so are the sides of one letter's forms that
//! have a joining stroke there, or have none. Such a side, laid onto the ink so that most of it lies along edges and
//! nothing of it on paper, says how the edges go on that the other letter hides.

use super::Field;
use super::shape::{Ink, pixel};
use crate::numeric::cast::index;
use crate::numeric::pieces::around;
use crate::numeric::surface::Surface;
use crate::scan::components::Component;
use crate::types::Gray;
use kurbo::{Point, Vec2};
use nalgebra::{Matrix2, Vector2};
use std::iter;

/// An example lies no farther from where the cells say than so many halves of the border's stretch, along the row
/// and across it.
const ALONG: f64 = 1.5;
const ACROSS: f64 = 0.4;
/// It is laid at places so many strokes apart at first, of no less than so many px and halves of the border's stretch,
/// by so many of its points.
const STEP: f64 = 0.08;
const LEAST_STEP: (f64, f64) = (2.0, 0.016);
const POINTS: usize = 120;
/// In the end edges are no farther apart than so many px.
const NEAR: f64 = 1.5;
/// An edge runs along another one by the cosine of their angle.
const PARALLEL: f64 = 0.9;
/// A point on paper counts as so many that lie along an edge.
const PAPER: f64 = 4.0;
/// So many of its points lie along edges, and so many on paper at most.
const SEEN: f64 = 0.4;
const ASTRAY: f64 = 0.03;
/// And so many more of them than where it would lie best a stroke or more away.
const SURE: f64 = 0.05;
/// No point is near.
const NONE: u32 = u32::MAX;
/// Steps of the search for the last parts of a px.
const STEPS: usize = 8;
/// So much of its edge runs across each way, in squares of sines: else it could be moved along it.
const HELD: f64 = 0.03;
/// A path along it begins and ends no farther from its edge, px.
const BLUR: f64 = 2.5;

/// The edge of a letter's side, as lines.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::scan::cut::layout) struct Example {
    /// px of the sheet, where its letter would lie if it lay in its cell as the example does; ink on the left if y
    /// runs up.
    lines: Vec<Vec<Point>>,
}

/// The left or the right side of a letter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::scan::cut::layout) enum Side {
    Left,
    Right,
}

impl Example {
    /// One half of a letter, moved by so many px of the sheet.
    pub(in crate::scan::cut::layout) fn of(
        (letter, side): (&Component, Side),
        (page, upright): (&Gray, &Surface),
        by: Vec2,
    ) -> Self {
        let field = Field::new(letter, page);
        let middle = letter.upright.center().x;
        let is_there = |p: &Point| {
            let x = upright.at(field.in_sheet(*p)).x;
            match side {
                Side::Left => x <= middle,
                Side::Right => x >= middle,
            }
        };
        let rings = field.rings(letter.stroke().max(1.0));
        let lines = rings.iter().flat_map(|r| runs(r, is_there));
        let moved = |line: Vec<Point>| line.iter().map(|&p| field.in_sheet(p) + by).collect();
        Self {
            lines: lines.map(moved).collect(),
        }
    }
}

/// The stretches of a ring that are somewhere.
fn runs(ring: &[Point], is_there: impl Fn(&Point) -> bool) -> Vec<Vec<Point>> {
    let Some(first) = ring.iter().position(|p| !is_there(p)) else {
        return vec![ring.iter().chain(ring.first()).copied().collect()];
    };
    let turned: Vec<Point> = ring[first..]
        .iter()
        .chain(&ring[..first])
        .copied()
        .collect();
    let runs = turned.split(|p| !is_there(p));
    runs.filter(|r| r.len() > 1)
        .map(<[Point]>::to_vec)
        .collect()
}

/// Which way a line goes at each of its points, of length 1.
fn ways(line: &[Point]) -> impl Iterator<Item = Vec2> {
    let last = line.len().saturating_sub(1);
    (0..line.len()).map(move |i| {
        let way = line[(i + 2).min(last)] - line[i.saturating_sub(2)];
        way / way.hypot().max(f64::MIN_POSITIVE)
    })
}

/// An example laid onto ink.
#[derive(Debug, Clone)]
pub(super) struct Placed {
    lines: Vec<Vec<Point>>,
    /// How each of their points lies.
    lies: Vec<Vec<Lies>>,
}

/// How a point of an example lies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Lies {
    /// Along an edge: a ring and its point.
    Along(usize, usize),
    /// Beneath ink.
    Beneath,
    /// On paper.
    Beyond,
}

impl Lies {
    fn along(self) -> Option<(usize, usize)> {
        match self {
            Self::Along(ring, at) => Some((ring, at)),
            Self::Beneath | Self::Beyond => None,
        }
    }
}

/// How an example lies as a whole: shares of its points.
#[derive(Debug, Clone, Copy)]
struct Fit {
    along: f64,
    beyond: f64,
}

impl Fit {
    fn score(self) -> f64 {
        self.along - PAPER * self.beyond
    }
}

/// The ink that examples are laid onto.
pub(super) struct Ground<'a> {
    rings: &'a [Vec<Point>],
    ink: Ink<'a>,
    /// Width of a stroke and half of the border's stretch, px.
    stroke: f64,
    half: f64,
    /// Which way each ring goes at each of its points.
    ways: Vec<Vec<Vec2>>,
    /// All points: which ring, and which of its points.
    places: Vec<(usize, usize)>,
    /// The one of them that is nearest to each pixel, within a step, or [`NONE`].
    nearest: Vec<u32>,
    step: f64,
}

impl<'a> Ground<'a> {
    /// Rings around ink of strokes so wide, and half of the border's stretch.
    pub(super) fn of(rings: &'a [Vec<Point>], ink: Ink<'a>, (stroke, half): (f64, f64)) -> Self {
        let least = LEAST_STEP.0.max(LEAST_STEP.1 * half);
        let step = (STEP * stroke).max(least);
        let size = ink.size;
        let places = (0..rings.len()).flat_map(|r| (0..rings[r].len()).map(move |k| (r, k)));
        let places: Vec<(usize, usize)> = places.collect();
        let mut nearest = vec![NONE; size.0 * size.1];
        let reach = index(step.ceil());
        for (n, &(r, k)) in (0..NONE).zip(&places) {
            let p = rings[r][k];
            for i in around(pixel(p, size.1), reach, size) {
                let middle = (i % size.0, size.1 - 1 - i / size.0);
                let middle = Point::new(middle.0 as f64 + 0.5, middle.1 as f64 + 0.5);
                let other = places.get(nearest[i] as usize);
                let far = other.map_or(f64::INFINITY, |&(r, k)| middle.distance(rings[r][k]));
                if middle.distance(p) < far {
                    nearest[i] = n;
                }
            }
        }
        let closed = |ring: &Vec<Point>| {
            let n = ring.len();
            let way = |i: usize| ring[(i + 2) % n] - ring[(i + n - 2 % n) % n];
            let ways = (0..n).map(way);
            ways.map(|w| w / w.hypot().max(f64::MIN_POSITIVE)).collect()
        };
        Self {
            rings,
            ink,
            stroke,
            half,
            ways: rings.iter().map(closed).collect(),
            places,
            nearest,
            step,
        }
    }

    /// How a point lies through which an edge goes that way.
    fn lies(&self, (p, way): (Point, Vec2), near: f64) -> Lies {
        let size = self.ink.size;
        let (x, y) = pixel(p, size.1);
        if p.x < 0.0 || p.y < 0.0 || x >= size.0 || y >= size.1 {
            return Lies::Beyond;
        }
        let nearest = self.places.get(self.nearest[y * size.0 + x] as usize);
        let along = nearest.filter(|&&(r, k)| {
            self.ways[r][k].dot(way) > PARALLEL && self.rings[r][k].distance(p) <= near
        });
        match along {
            Some(&(r, k)) => Lies::Along(r, k),
            None if self.ink.is_near(p) => Lies::Beneath,
            None => Lies::Beyond,
        }
    }

    /// The best place of the examples; none where none fits.
    pub(super) fn place(&self, field: &Field, examples: &[Example]) -> Option<Placed> {
        let placed = examples.iter().filter_map(|e| self.lay(field, e));
        placed.max_by(|a, b| a.0.total_cmp(&b.0)).map(|p| p.1)
    }

    /// Where an example fits the ink, and how well.
    fn lay(&self, field: &Field, example: &Example) -> Option<(f64, Placed)> {
        let lines = example.lines.iter();
        let lines = lines.map(|l| l.iter().map(|&p| field.of_sheet(p)).collect());
        let lines: Vec<Vec<Point>> = lines.collect();
        let points = lines.iter().flat_map(|l| l.iter().copied().zip(ways(l)));
        let points: Vec<(Point, Vec2)> = points.collect();
        let few = points.iter().step_by(points.len() / POINTS + 1).copied();
        let few: Vec<(Point, Vec2)> = few.collect();
        let tried: Vec<(Vec2, f64)> = self
            .tries()
            .map(|by| (by, self.fit(&few, by, self.step).score()))
            .collect();
        let best = tried.iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let other = tried
            .iter()
            .filter(|t| (t.0 - best.0).hypot() > self.stroke);
        let other = other.map(|t| t.1).fold(0.0, f64::max);
        let by = self.settle(&points, best.0)?;
        let fit = self.fit(&points, by, NEAR);
        let is_sure = fit.along >= SEEN && fit.beyond <= ASTRAY && best.1 >= other + SURE;
        let moved = |l: Vec<Point>| l.into_iter().map(|p| p + by).collect();
        is_sure.then(|| {
            let lines: Vec<Vec<Point>> = lines.into_iter().map(moved).collect();
            let lies = |l: &Vec<Point>| {
                let points = l.iter().copied().zip(ways(l));
                points.map(|p| self.lies(p, NEAR)).collect()
            };
            let lies = lines.iter().map(lies).collect();
            (fit.score(), Placed { lines, lies })
        })
    }

    /// All ways to move an example, a step apart.
    fn tries(&self) -> impl Iterator<Item = Vec2> {
        let [x, y] = [ALONG, ACROSS].map(|reach| index(reach * self.half / self.step));
        let steps = |n: usize| (0..=2 * n).map(move |i| i as f64 - n as f64);
        let step = self.step;
        steps(y).flat_map(move |v| steps(x).map(move |u| step * Vec2::new(u, v)))
    }

    /// How some points of edges lie that are moved.
    fn fit(&self, points: &[(Point, Vec2)], by: Vec2, near: f64) -> Fit {
        let lies = points
            .iter()
            .map(|&(p, way)| self.lies((p + by, way), near));
        let (along, beyond) = lies.fold((0, 0), |(along, beyond), l| match l {
            Lies::Along(..) => (along + 1, beyond),
            Lies::Beneath => (along, beyond),
            Lies::Beyond => (along, beyond + 1),
        });
        let all = points.len().max(1) as f64;
        Fit {
            along: f64::from(along) / all,
            beyond: f64::from(beyond) / all,
        }
    }

    /// Least squares of the distances from edges, from a place on; none where nothing holds it.
    fn settle(&self, points: &[(Point, Vec2)], from: Vec2) -> Option<Vec2> {
        let mut by = from;
        for step in 0..STEPS {
            let near = if 2 * step < STEPS { self.step } else { NEAR };
            let (mut normals, mut offs) = (Matrix2::zeros(), Vector2::zeros());
            for &(p, way) in points {
                if let Lies::Along(r, k) = self.lies((p + by, way), near) {
                    let way = self.ways[r][k];
                    let normal = Vector2::new(-way.y, way.x);
                    let off = self.rings[r][k] - (p + by);
                    normals += normal * normal.transpose();
                    offs += normal * normal.dot(&Vector2::new(off.x, off.y));
                }
            }
            // each point adds 1 to the sum of both
            let least = normals.symmetric_eigenvalues().min();
            let held = least > HELD * normals.trace();
            let on = held.then(|| normals.try_inverse())?? * offs;
            by += Vec2::new(on.x, on.y);
        }
        Some(by)
    }
}

impl Placed {
    pub(super) fn points(&self) -> impl Iterator<Item = &Point> {
        self.lines.iter().flatten()
    }

    /// The points of rings that lie along it: which ring, and which of its points.
    pub(super) fn seen(&self) -> impl Iterator<Item = (usize, usize)> {
        self.lies.iter().flatten().filter_map(|l| l.along())
    }

    /// Those beside which its edge goes beneath ink, or comes out of it, for more than so many points.
    pub(super) fn gone(&self, points: usize) -> Vec<(usize, usize)> {
        let gone = |lies: &Vec<Lies>| {
            let seen = lies.iter().enumerate();
            let seen = seen.filter_map(|(i, l)| Some((i, l.along()?)));
            let seen: Vec<(usize, (usize, usize))> = seen.collect();
            let gone = seen.windows(2).filter(|w| w[1].0 - w[0].0 > points);
            gone.flatten().map(|p| p.1).collect::<Vec<_>>()
        };
        self.lies.iter().flat_map(gone).collect()
    }

    /// The way along it from one end of a seen edge to another one.
    pub(super) fn between(&self, from: Point, to: Point) -> Option<Vec<Point>> {
        let nearest = |line: &[Point], end: Point| {
            let off = |p: &Point| p.distance(end);
            let all = line.iter().enumerate().map(|(i, p)| (i, off(p)));
            let best = all.min_by(|a, b| a.1.total_cmp(&b.1));
            best.filter(|b| b.1 <= BLUR).map(|b| b.0)
        };
        self.lines.iter().find_map(|line| {
            let (a, b) = (nearest(line, from)?, nearest(line, to)?);
            let is_closed = line.first() == line.last();
            let around: &[Point] = if is_closed { line } else { &[] };
            let path: Vec<Point> = if a < b {
                line[a..=b].to_vec()
            } else {
                line[a..]
                    .iter()
                    .chain(around.get(1..=b)?)
                    .copied()
                    .collect()
            };
            let within = path.iter().skip(1).take(path.len().saturating_sub(2));
            let on = iter::once(from).chain(within.copied());
            Some(on.chain([to]).collect())
        })
    }
}
