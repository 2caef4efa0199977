//! Lines that the level parts and that go on: short ones between what is thick, and wider ones by grain or where two
//! pixels touch at their corners alone.
//!
//! Along such a place what is seen across the line hardly changes. Where ink ends and begins anew it does: through a
//! gap between two edges that shows half of the ink in its middle, a pixel on it shows a third more.

use super::{Crest, Field, GRAIN, RELIEF, SIDES};
use crate::numeric::{cast::index, iso::saddle};
use kurbo::{Point, Vec2};

/// Pixels along a crest that are looked at on both sides of one.
const REACH: usize = 16;
/// Steps between the ends of a torn place at most, and how far the crest may leave the straight way between them, px.
const TORN: usize = 12;
const ASTRAY_PX: f64 = 1.5;
/// Ink so far around the ends joins them, px.
const AROUND: isize = 3;
/// Ink across it at least, px.
const HELD_PX: f64 = 0.5;
/// A pixel on to both sides there is so many times as much, at most.
const ALIKE: f64 = 1.35;
/// Turns of the way along it that are looked at there.
const TURNS: [f64; 7] = [0.0, 0.25, -0.25, 0.5, -0.5, 0.75, -0.75];
/// Steps along and across, px, and how many there are across to each side of the middle.
const STEP_PX: f64 = 0.5;
const ASIDE: usize = 7;
/// What is higher by so much than what is nearer to a crest is another line's.
const OTHER: f64 = 0.1;

/// Column and row.
type Pixel = (isize, isize);

/// What is seen across a line.
#[derive(Clone, Copy)]
struct Across {
    /// in all, px
    held: f64,
    /// by how much its middle stands out
    relief: f64,
}

impl Field<'_> {
    /// The pixels of crests where the level parts a line that goes on.
    pub(super) fn torn(&self) -> Vec<Crest> {
        let w = self.gray.width();
        let some = self.standing_out(RELIEF).into_iter();
        let ways = some.flat_map(|(i, _)| [(1, 0), (0, 1)].map(|along| (i, along)));
        let found = ways.filter_map(|(i, along)| {
            self.torn_at(((i % w).cast_signed(), (i / w).cast_signed()), along)
        });
        let found: Vec<(Vec<Crest>, f64)> = found.collect();
        if found.is_empty() {
            return Vec::new();
        }
        let least = f64::from(GRAIN * self.deviation());
        let lines = found.into_iter().filter(|(_, relief)| *relief >= least);
        let mut crests: Vec<Crest> = lines.flat_map(|(line, _)| line).collect();
        crests.sort_unstable_by_key(|c| c.0);
        crests.dedup_by_key(|c| c.0);
        crests
    }

    /// The pixels of the line that is torn at this one, where it runs `along` rows or columns, and by how much it
    /// stands out where it holds least; nothing where there is no such line.
    fn torn_at(&self, at: Pixel, along: Pixel) -> Option<(Vec<Crest>, f64)> {
        let mut line = self.followed(at, (-along.0, -along.1));
        line.reverse();
        let here = line.len();
        line.push(at);
        line.extend(self.followed(at, along));
        let whole: Vec<bool> = line.windows(2).map(|l| self.is_whole(l[0], l[1])).collect();
        if whole[here - 1] && whole[here] {
            return None;
        }
        // two links in a row that are whole end it
        let ends = |k: &usize| whole[*k] && whole[*k + 1];
        let first = (0..here - 1).rev().find(ends)? + 2;
        let last = (here..whole.len() - 1).find(ends)?;
        let (a, b) = (middle(line[first]), middle(line[last]));
        let way = (b - a).normalize();
        let astray = |p: &Pixel| way.cross(middle(*p) - a).abs() > ASTRAY_PX;
        if last - first > TORN
            || line[first..=last].iter().any(astray)
            || self.is_joined(line[first], line[last])
        {
            return None;
        }
        let steps = index((a.distance(b) / STEP_PX).round());
        let places = (0..=steps).map(|k| a + k as f64 * STEP_PX * way);
        let narrow = places.map(|at| (at, self.across(at, way)));
        let least = |a: &f64, b: &f64| a.total_cmp(b);
        let (at, _) = narrow.min_by(|(_, a), (_, b)| least(&a.held, &b.held))?;
        // the crest was followed from pixel to pixel: a line is narrowest square to it
        let ways = TURNS.map(|turn| {
            let (sin, cos) = libm::sincos(turn);
            let way = Vec2::new(way.x * cos - way.y * sin, way.x * sin + way.y * cos);
            (way, self.across(at, way))
        });
        let by_held = |(_, a): &(Vec2, Across), (_, b): &(Vec2, Across)| least(&a.held, &b.held);
        let (way, Across { held, relief }) = ways.into_iter().min_by(by_held)?;
        let beside = [way, -way].map(|way| self.across(at + way, way).held);
        let goes_on = held >= HELD_PX
            && beside.iter().sum::<f64>() <= 2.0 * ALIKE * held
            && relief >= f64::from(RELIEF);
        goes_on.then(|| (self.low(&line[first - 1..=last + 1]), relief))
    }

    /// The pixels along a crest from one on, each the highest of the three ahead.
    fn followed(&self, at: Pixel, (dx, dy): Pixel) -> Vec<Pixel> {
        let ahead = |&(x, y): &Pixel| {
            let ahead = [0, 1, -1].map(|n| (x + dx + n * dy, y + dy + n * dx));
            let higher = |a: Pixel, b: Pixel| {
                if self.height(b) > self.height(a) {
                    b
                } else {
                    a
                }
            };
            ahead.into_iter().reduce(higher)
        };
        std::iter::successors(Some(at), ahead)
            .skip(1)
            .take(REACH)
            .collect()
    }

    /// Those of pixels whose crest may be lifted.
    fn low(&self, line: &[Pixel]) -> Vec<Crest> {
        let w = self.gray.width();
        let crest = |&(x, y): &Pixel| {
            let height = self.height((x, y));
            let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
            let low =
                height > 0.0 && height < self.level / SIDES && x < w && y < self.gray.height();
            low.then_some((y * w + x, height))
        };
        line.iter().filter_map(crest).collect()
    }

    /// Whether the level does not part two pixels that touch.
    fn is_whole(&self, a: Pixel, b: Pixel) -> bool {
        let (p, q) = (self.height(a), self.height(b));
        if p.min(q) < self.level {
            return false;
        }
        let (r, s) = (self.height((a.0, b.1)), self.height((b.0, a.1)));
        let corner = || saddle([p, q].map(f64::from), [r, s].map(f64::from));
        r.max(s) >= self.level || corner() >= f64::from(self.level)
    }

    /// Whether ink joins two pixels near by.
    fn is_joined(&self, a: Pixel, b: Pixel) -> bool {
        let near = |p: isize, q: isize| p.min(q) - AROUND..=p.max(q) + AROUND;
        let (columns, rows) = (near(a.0, b.0), near(a.1, b.1));
        let width = columns.end().abs_diff(*columns.start()) + 1;
        let place =
            |(x, y): Pixel| y.abs_diff(*rows.start()) * width + x.abs_diff(*columns.start());
        let mut seen = vec![false; place((*columns.end(), *rows.end())) + 1];
        let mut open = vec![a];
        while let Some((x, y)) = open.pop() {
            let beside = (x - 1..=x + 1).flat_map(|x| (y - 1..=y + 1).map(move |y| (x, y)));
            for p in beside.filter(|(x, y)| columns.contains(x) && rows.contains(y)) {
                if !seen[place(p)] && self.is_whole((x, y), p) {
                    seen[place(p)] = true;
                    open.push(p);
                }
            }
        }
        seen[place(b)]
    }

    /// What is seen across a line at a place that it passes `along` this way.
    fn across(&self, at: Point, along: Vec2) -> Across {
        let across = Vec2::new(-along.y, along.x);
        let seen = |t: f64| self.between(at + t * across);
        let middles = [0.0, STEP_PX, -STEP_PX, 1.0, -1.0];
        let higher = |a: f64, b: f64| if seen(b) > seen(a) { b } else { a };
        let middle = middles.into_iter().fold(0.0, higher);
        let here = seen(middle);
        let (mut sum, mut foot) = (here, f64::NEG_INFINITY);
        for step in [STEP_PX, -STEP_PX] {
            let mut least = here;
            for n in 1..=ASIDE {
                let v = seen(middle + step * n as f64);
                if v > least + OTHER {
                    break;
                }
                sum += v.max(0.0);
                least = least.min(v);
            }
            foot = foot.max(least);
        }
        Across {
            held: sum * STEP_PX,
            relief: here - foot,
        }
    }

    /// The height between pixels, bilinear.
    fn between(&self, p: Point) -> f64 {
        let (x, y) = (p.x.floor(), p.y.floor());
        let (u, v) = (p.x - x, p.y - y);
        let at = |dx: f64, dy: f64| {
            let place = |v: f64| if v < 0.0 { -1 } else { index(v).cast_signed() };
            f64::from(self.height((place(x + dx), place(y + dy))))
        };
        let row = |dy: f64| at(0.0, dy) + u * (at(1.0, dy) - at(0.0, dy));
        row(0.0) + v * (row(1.0) - row(0.0))
    }

    /// The height of a pixel; paper lies around the picture.
    fn height(&self, (x, y): Pixel) -> f32 {
        self.beside((0, 0), (x, y))
    }
}

/// A pixel's middle.
fn middle((x, y): Pixel) -> Point {
    Point::new(x as f64, y as f64)
}
