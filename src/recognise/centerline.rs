//! The way that the pen went: ink → curves along the middle of its lines, with the lines' width.
//!
//! Source   own over [guohall89 sec. 3]; curves as [bsplinematch sec. 3] with the number of [schwarz78 eq. 1]
//! Solves   the middle between both borders of the grey ink across the thinned line, then the cubic B-spline with
//! the fewest bits through these middles
//! Takes    ink coverage, px, y down
//! Gives    open and closed paths of cubics, px, y down, curvature continuous between corners, ending where
//! the pen's centre ended or at junctions; widths; dots
//! Departs  a thinned line is up to a pixel beside the middle and runs into corners of the ink at its ends and
//! junctions. Borders are read from the grey, ends lie half a width behind the tip, and a junction is the
//! place nearest to the lines that arrive there
//! Cost     O(ink · pen width)      Fails  never; no ink gives no paths

use super::skeleton::{Pruning, Skeleton, Stroke};
use super::spline::{Data, Knots, Spline};
use crate::numeric::angles::angle;
use crate::numeric::cast::index;
use crate::types::{Bitmap, Centerline, Gray, PenLine, Span};
use kurbo::{BezPath, CubicBez, Point, Vec2};

/// Variance of a middle read from the grey, px².
const NOISE: f64 = 0.004;
/// Control points of a piece without corners at most.
const MOST: usize = 40;
/// Within this many half widths of a junction the other lines' ink hides the border.
const HIDDEN: f64 = 1.6;
/// Widths from a corner at which its arms are looked at: nearer, the inks of both run together.
const ARM: f64 = 0.75;
/// A turn sharper than this, radians, between the chords to both arms is a corner.
const CORNER: f64 = 0.9;

/// A point of a line's middle and the ink's width there.
type Middle = (Point, f64);

/// The middle of the ink's lines.
#[must_use]
pub fn centerline(gray: &Gray) -> Centerline {
    let skeleton = Skeleton::new(&Bitmap::threshold(gray, 0.5), Pruning::default());
    let mut ways: Vec<Way> = skeleton.strokes.iter().map(|s| Way::new(gray, s)).collect();
    let junctions: Vec<Point> = (0..skeleton.junctions.len())
        .map(|j| meeting(skeleton.junctions[j], &ways, j))
        .collect();
    for way in &mut ways {
        way.end_at(gray, &junctions);
    }
    let lines = ways.iter().filter_map(Way::line).collect();
    Centerline {
        lines,
        dots: skeleton.dots,
    }
}

/// A line on its way from pixels to curves.
struct Way {
    middles: Vec<Middle>,
    closed: bool,
    joins: [Option<usize>; 2],
}

impl Way {
    fn new(gray: &Gray, stroke: &Stroke) -> Self {
        let widths = stroke.half_widths.iter().map(|w| 2.0 * w);
        let rough: Vec<Middle> = stroke.points.iter().copied().zip(widths).collect();
        let (closed, joins) = (stroke.closed, stroke.joins);
        let mut way = Self {
            middles: rough.clone(),
            closed,
            joins,
        };
        let hidden = |p: Point, w: f64| {
            let ends = [rough.first(), rough.last()].into_iter().zip(joins);
            let near = |e: &Middle| e.0.distance(p) < HIDDEN * e.1.max(w) / 2.0;
            ends.filter(|(_, join)| join.is_some())
                .any(|(end, _)| end.is_some_and(near))
        };
        // Twice: the normals of the first round come from the pixels' steps.
        let mut kept = Vec::new();
        for _ in 0..2 {
            let read: Vec<Option<Middle>> = (0..rough.len()).map(|i| way.read(gray, i)).collect();
            let seen = read
                .iter()
                .zip(&rough)
                .filter(|(_, (p, w))| !hidden(*p, *w));
            kept = seen.filter_map(|(r, _)| *r).collect();
            way.middles
                .iter_mut()
                .zip(&read)
                .for_each(|(m, r)| *m = r.unwrap_or(*m));
        }
        way.middles = if kept.len() >= 2 { kept } else { rough };
        way
    }

    /// The middle between both borders across the line at point `i`, and their distance; `None` where a border
    /// is farther than the line is thick, as beside a junction.
    fn read(&self, gray: &Gray, i: usize) -> Option<Middle> {
        let n = self.middles.len();
        let (at, width) = self.middles[i];
        let reach = index(width / 2.0).clamp(2, 12);
        let (a, b) = if self.closed {
            ((i + n - reach % n) % n, (i + reach) % n)
        } else {
            (i.saturating_sub(reach), (i + reach).min(n - 1))
        };
        let way = self.middles[b].0 - self.middles[a].0;
        if way.hypot() < 1.0 {
            return None;
        }
        let normal = way.normalize().turn_90();
        let longest = 0.9 * width + 2.0;
        let (left, right) = (
            border(gray, at, normal, longest)?,
            border(gray, at, -normal, longest)?,
        );
        Some((at + normal * ((left - right) / 2.0), left + right))
    }

    /// The line's end, and the direction in which it arrives there; `side` 0 is its start.
    fn end(&self, side: usize) -> Option<(Point, Vec2, f64)> {
        let n = self.middles.len();
        let at = |k: usize| {
            if side == 0 {
                self.middles.get(k)
            } else {
                self.middles.get(n.checked_sub(k + 1)?)
            }
        };
        let (tip, width) = *at(0)?;
        let back = (1..n)
            .filter_map(at)
            .find(|b| b.0.distance(tip) >= width.max(2.0))
            .or_else(|| at(n - 1))?;
        let way = tip - back.0;
        (way.hypot() > 0.0).then(|| (tip, way.normalize(), width))
    }

    /// The direction in which the line arrives at its end, its bend carried on: the chords over half a width and
    /// over a whole one turn by as much as the end does from the first.
    fn heading(&self, side: usize, otherwise: Vec2) -> Vec2 {
        let tip = self.back(side, 0.0);
        let width = if side == 0 {
            self.middles.first()
        } else {
            self.middles.last()
        };
        let width = width.map_or(0.0, |m| m.1);
        let chord = |length: f64| tip - self.back(side, length);
        let (near, far) = (chord(width / 2.0), chord(width));
        if near.hypot() <= 0.0 || far.hypot() <= 0.0 {
            return otherwise;
        }
        let (near, far) = (near.normalize(), far.normalize());
        let (sin, cos) = (far.cross(near), far.dot(near));
        Vec2::new(near.x * cos - near.y * sin, near.x * sin + near.y * cos)
    }

    /// The point `length` along the line from its end on that side.
    fn back(&self, side: usize, length: f64) -> Point {
        let mut points: Vec<Point> = self.middles.iter().map(|m| m.0).collect();
        if side == 1 {
            points.reverse();
        }
        let mut left = length;
        for pair in points.windows(2) {
            let step = pair[0].distance(pair[1]);
            if step >= left {
                return pair[0].lerp(pair[1], left / step.max(f64::MIN_POSITIVE));
            }
            left -= step;
        }
        points.last().copied().unwrap_or_default()
    }

    /// Takes its ends to the junctions, or to half a width behind the ink's tip.
    fn end_at(&mut self, gray: &Gray, junctions: &[Point]) {
        if self.closed {
            return;
        }
        for side in [0, 1] {
            let Some((tip, way, width)) = self.end(side) else {
                continue;
            };
            let junction = self.joins[side].and_then(|j| junctions.get(j));
            let end = junction.copied().unwrap_or_else(|| {
                let reach = border(gray, tip, way, 1.5 * width + 2.0).unwrap_or(width / 2.0);
                let beyond = reach - width / 2.0;
                if beyond < 0.0 {
                    self.back(side, -beyond)
                } else {
                    tip + self.heading(side, way) * beyond
                }
            });
            // What lies beyond the end was thinned into a corner of the ink.
            let beyond = |m: &Middle| (m.0 - end).dot(way) > -0.5 && m.0.distance(end) < width;
            let inner: Vec<Middle> = self
                .middles
                .iter()
                .copied()
                .filter(|m| !beyond(m))
                .collect();
            if !inner.is_empty() {
                self.middles = inner;
            }
            let at = if side == 0 { 0 } else { self.middles.len() };
            self.middles.insert(at, (end, width));
        }
    }

    /// The cubics through the middles, split at corners.
    fn line(&self) -> Option<PenLine> {
        let mut cuts = if self.closed { Vec::new() } else { vec![0] };
        cuts.extend(self.corners());
        let n = self.middles.len();
        if n < 2 {
            return None;
        }
        let cubics: Vec<CubicBez> = if self.closed && cuts.is_empty() {
            let points: Vec<Point> = self.middles.iter().map(|m| m.0).collect();
            curve(Span::Ring(&points))
        } else {
            // From corner to corner; of a ring the first is the last.
            let first = if self.closed { cuts[0] } else { 0 };
            cuts.push(if self.closed { first + n } else { n - 1 });
            cuts.dedup();
            let piece = |w: &[usize]| curve(Span::Open(&self.piece(w[0], w[1])));
            cuts.windows(2).flat_map(piece).collect()
        };
        let mut path = BezPath::new();
        path.move_to(cubics.first()?.p0);
        cubics.iter().for_each(|c| path.curve_to(c.p1, c.p2, c.p3));
        let ends = cubics.iter().map(|c| c.p3);
        let nodes = if self.closed {
            ends.collect()
        } else {
            std::iter::once(cubics[0].p0)
                .chain(ends)
                .collect::<Vec<_>>()
        };
        if self.closed {
            path.close_path();
        }
        Some(PenLine {
            path,
            widths: nodes.iter().map(|p| self.width_at(*p)).collect(),
        })
    }

    /// The points from one cut to the next, indices modulo the ring's length; near corners, where the ink of both
    /// arms runs together, only the corner itself.
    fn piece(&self, from: usize, to: usize) -> Vec<Point> {
        let n = self.middles.len();
        let is_corner = |i: usize| self.closed || (i > 0 && i + 1 < n);
        let end = |i: usize| {
            let (at, width) = self.middles[i % n];
            let sharp = is_corner(i).then(|| self.sharp(i % n)).flatten();
            sharp.map_or((at, at, 0.0), |p| (p, at, ARM * width.max(2.0)))
        };
        let (start, stop) = (end(from), end(to));
        let clear = |p: &Point| p.distance(start.1) >= start.2 && p.distance(stop.1) >= stop.2;
        let inner = (from + 1..to).map(|i| self.middles[i % n].0).filter(clear);
        std::iter::once(start.0)
            .chain(inner)
            .chain([stop.0])
            .collect()
    }

    /// Where the arms of the corner at point `i` meet; `None` for a bend, whose middle lies farther from there
    /// than that of a corner.
    fn sharp(&self, i: usize) -> Option<Point> {
        let (at, width) = self.middles[i];
        let reach = ARM * width.max(2.0);
        let arm = |step| {
            let near = self.walk(i, reach, step)?;
            Some((near, (near - self.walk(i, 2.0 * reach, step)?).normalize()))
        };
        let ((a, u), (b, v)) = (arm(Step::Back)?, arm(Step::On)?);
        let met = a + u * ((b - a).cross(v) / u.cross(v));
        // The middle of a corner is as far from the pen's round outside as from the inner corner.
        let sine_of_half = (0.5 * (1.0 - u.dot(v))).sqrt();
        let off = 0.25 * width * (1.0 / sine_of_half - 1.0);
        (met.distance(at) <= 1.5 * off + 0.5).then_some(met)
    }

    fn width_at(&self, p: Point) -> f64 {
        let nearest = self
            .middles
            .iter()
            .min_by(|a, b| a.0.distance_squared(p).total_cmp(&b.0.distance_squared(p)));
        nearest.map_or(0.0, |m| m.1)
    }

    /// Where the line turns sharply: indices in order, ends not among them.
    fn corners(&self) -> Vec<usize> {
        let n = self.middles.len();
        let turn = |i: usize| -> f64 {
            let reach = ARM * self.middles[i].1.max(2.0);
            let (Some(a), Some(b)) = (
                self.walk(i, reach, Step::Back),
                self.walk(i, reach, Step::On),
            ) else {
                return 0.0;
            };
            let (v, w) = (self.middles[i].0 - a, b - self.middles[i].0);
            angle(v, w).abs()
        };
        let turns: Vec<f64> = (0..n).map(turn).collect();
        let highest = |&i: &usize| {
            let reach = ARM * self.middles[i].1.max(2.0);
            let near = |j: &usize| self.middles[*j].0.distance(self.middles[i].0) <= reach;
            let higher = |j: usize| turns[j] > turns[i] || (j < i && turns[j] >= turns[i]);
            turns[i] > CORNER && !(0..n).filter(near).any(higher)
        };
        (0..n).filter(highest).collect()
    }

    /// The first point at least `reach` away along the line.
    fn walk(&self, i: usize, reach: f64, step: Step) -> Option<Point> {
        let n = self.middles.len();
        let from = self.middles[i].0;
        let far = |p: &Point| p.distance(from) >= reach;
        let index = |k: usize| match (step, self.closed) {
            (Step::On, true) => Some((i + k) % n),
            (Step::Back, true) => Some((i + n - k) % n),
            (Step::On, false) => (i + k < n).then_some(i + k),
            (Step::Back, false) => i.checked_sub(k),
        };
        (1..n).map_while(index).map(|j| self.middles[j].0).find(far)
    }
}

#[derive(Clone, Copy)]
enum Step {
    On,
    Back,
}

/// Cubics through points: a spline, or the chord where there are too few.
fn curve(span: Span<'_>) -> Vec<CubicBez> {
    let (points, closed) = match span {
        Span::Open(points) => (points, false),
        Span::Ring(points) => (points, true),
    };
    let (Some(&first), Some(&last)) = (points.first(), points.last()) else {
        return Vec::new();
    };
    let ends = (!closed).then_some((first, last));
    let data = Data {
        points,
        closed,
        knots: Knots::Uniform,
        noise: NOISE,
        most: MOST,
    };
    let spline = Spline::choose(data)
        .map(|s| s.cubics(ends))
        .filter(|c| !c.is_empty());
    spline.unwrap_or_else(|| {
        let third = |t: f64| first.lerp(last, t);
        vec![CubicBez::new(
            first,
            third(1.0 / 3.0),
            third(2.0 / 3.0),
            last,
        )]
    })
}

/// How far the ink's border lies from `from` in direction `way`, px; `None` beyond `longest`.
fn border(gray: &Gray, from: Point, way: Vec2, longest: f64) -> Option<f64> {
    const STEP: f64 = 0.5;
    let ink = |d: f64| sample(gray, from + way * d) - 0.5;
    let (mut d, mut before) = (0.0, ink(0.0));
    if before <= 0.0 {
        return None;
    }
    while d < longest {
        let here = ink(d + STEP);
        if here <= 0.0 {
            return Some(d + STEP * before / (before - here));
        }
        (d, before) = (d + STEP, here);
    }
    None
}

/// Coverage between the pixels' centres.
fn sample(gray: &Gray, p: Point) -> f64 {
    let (x, y) = (p.x - 0.5, p.y - 0.5);
    if x < -1.0 || y < -1.0 {
        return 0.0;
    }
    // One pixel of paper to the left and above.
    let (i, j) = (index(x + 1.0), index(y + 1.0));
    let (u, v) = (x + 1.0 - i as f64, y + 1.0 - j as f64);
    let at = |i: usize, j: usize| match (i.checked_sub(1), j.checked_sub(1)) {
        (Some(i), Some(j)) => f64::from(gray.at(i, j)),
        _ => 0.0,
    };
    let row = |j: usize| (1.0 - u) * at(i, j) + u * at(i + 1, j);
    (1.0 - v) * row(j) + v * row(j + 1)
}

/// The place nearest to the lines that arrive at junction `j`, held near where thinning saw it.
fn meeting(seen: Point, ways: &[Way], j: usize) -> Point {
    const HOLD: f64 = 0.05;
    let (mut xx, mut xy, mut yy) = (HOLD, 0.0, HOLD);
    let mut right = Vec2::ZERO;
    for way in ways {
        for side in (0..2).filter(|&s| way.joins[s] == Some(j)) {
            let Some((tip, along, width)) = way.end(side) else {
                continue;
            };
            if tip.distance(seen) > 3.0 * width {
                continue;
            }
            let normal = along.turn_90();
            let off = normal.dot(tip - seen);
            (xx, xy, yy) = (
                xx + normal.x * normal.x,
                xy + normal.x * normal.y,
                yy + normal.y * normal.y,
            );
            right += normal * off;
        }
    }
    let determinant = xx * yy - xy * xy;
    seen + Vec2::new(yy * right.x - xy * right.y, xx * right.y - xy * right.x) / determinant
}
