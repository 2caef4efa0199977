//! A picture of ink → the rings around it, and their corners inwards near a border.

use super::across::Across;
use super::example::{Example, Ground, Placed};
use super::joint::{Place, joint};
use super::parabola::Parabola;
use super::shape::{Ink, filled};
use super::{Field, SPACING};
use crate::numeric::angles::angle;
use crate::numeric::cast::index;
use crate::scan::cut::layout::touching::{Border, Meeting};
use kurbo::{Point, Vec2};

/// So much of an edge beside a corner is not looked at, in strokes and px: lens and pen round it.
const ROUND: f64 = 0.15;
const ROUNDS: (f64, f64) = (1.5, 4.0);
/// A corner is told from sides so long, in strokes, of no less than so many px.
const SIDE: f64 = 0.7;
const SHORTEST: f64 = 4.0;
/// And how an edge goes on from so much of it, in strokes.
const SEEN: f64 = 1.2;
/// A corner turns by so much at least, radians.
const TURN: f64 = 0.3;
/// And chords that reach so many points beyond what is round by so much.
const SEEMS: f64 = 0.12;
const CLOSE: usize = 2;
/// Corners lie no farther from the middle of the border than so many halves of its stretch.
const FAR: f64 = 2.0;
/// Sides of corners come out of ink no farther off than so many strokes.
const LONGEST: f64 = 3.0;
/// So many corners are looked at, the sharpest, and so many places where their sides come out.
const CORNERS: usize = 20;
const EXITS: usize = 16;

/// The rings around some ink, on their left, px, y up, and their corners inwards.
pub(super) struct Edges {
    pub(super) rings: Vec<Vec<Point>>,
    /// In order of rings and points.
    pub(super) corners: Vec<Corner>,
    /// Width of a stroke, px.
    pub(super) stroke: f64,
    /// How far behind the border each point of each ring is, halves of its stretch.
    sides: Vec<Vec<f64>>,
    pub(super) across: Across,
    /// Half of the border's stretch, px.
    half: f64,
    /// How much of a ring a corner takes on either side, points.
    round: usize,
    /// Which pixels lie within the rings, row by row from above, and how many there are.
    inside: Vec<bool>,
    size: (usize, usize),
    /// Letters drawn alike as the one before the border and the one after it, where they lie free.
    pub(super) examples: [Option<Placed>; 2],
    /// Whether each point of each ring lies along their edges, where these are known.
    told: Vec<Vec<[Option<bool>; 2]>>,
}

/// A corner inwards, a side of strokes that lie in line, or a place where the side of one comes out of the ink.
#[derive(Debug, Clone, Copy)]
pub(super) struct Corner {
    ring: usize,
    /// Index of its point.
    at: usize,
    /// By how much it turns, radians; 0 where it is no corner.
    sharp: f64,
    /// A stroke of either letter may end there, beneath one of the other.
    pub(super) is_joint: bool,
}

/// Where a stretch of an edge ends or begins.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    pub(super) at: Point,
    /// Which way its ring goes there, of length 1.
    pub(super) way: Vec2,
}

impl Edges {
    /// The edges of a picture of strokes so wide; `side` says how far behind a border a place is, in halves of its
    /// stretch of so many px. None where there is no corner.
    pub(super) fn find(
        field: &Field,
        stroke: f64,
        border: &Border<'_>,
        side: impl Fn(Point) -> f64,
    ) -> Option<Self> {
        let size = (field.width, field.height);
        let rings = field.rings(stroke);
        let across = Across::of(side);
        let sides = rings.iter().map(|r| r.iter().map(|&p| across.at(p)));
        let mut new = Self {
            corners: Vec::new(),
            stroke,
            sides: sides.map(Iterator::collect).collect(),
            across,
            half: border.half(),
            round: index((ROUND * stroke).clamp(ROUNDS.0, ROUNDS.1) / SPACING + 0.5),
            inside: filled(&rings, size),
            size,
            told: rings.iter().map(|r| vec![[None; 2]; r.len()]).collect(),
            examples: [None, None],
            rings,
        };
        let mut corners: Vec<Corner> = (0..new.rings.len()).flat_map(|r| new.inward(r)).collect();
        corners.sort_by(|a, b| b.sharp.total_cmp(&a.sharp));
        corners.truncate(CORNERS);
        corners.sort_by_key(|c| (c.ring, c.at));
        new.corners = corners;
        if border.meeting == Meeting::Strokes {
            let sides = joint(&new.rings, stroke, &new.across, border.middles());
            sides.into_iter().flatten().for_each(|p| new.join(p));
        }
        new.follow(field, border.examples);
        let exits = new.exits();
        new.corners.extend(exits);
        new.corners.sort_by_key(|c| (c.ring, c.at));
        (!new.corners.is_empty()).then_some(new)
    }

    /// The corners inwards of a ring near the border: where its sides, as each is seen beside the corner, meet at an
    /// angle.
    fn inward(&self, ring: usize) -> Vec<Corner> {
        let points = &self.rings[ring];
        let n = points.len();
        let side = index((SIDE * self.stroke).max(SHORTEST) / SPACING + 0.5);
        let (close, far) = (self.round + CLOSE, self.round + side);
        let off = |i: usize, by: usize, forth: bool| {
            let by = by % n;
            points[if forth { i + by } else { i + n - by } % n]
        };
        let turn = |i: usize| {
            // sides that end in a corner outwards bend before it: what is between them is none inwards
            let [back, on] = [false, true].map(|forth| off(i, close, forth));
            if -angle(points[i] - back, on - points[i]) < SEEMS {
                return 0.0;
            }
            let sides = [false, true].map(|forth| {
                let seen = (self.round..=far).map(|by| off(i, by, forth));
                Parabola::beginning(&seen.collect::<Vec<Point>>())
            });
            let [Some(before), Some(after)] = sides else {
                return 0.0;
            };
            let at = -(self.round as f64);
            -angle(-before.way(at), after.way(at))
        };
        let is_near = |i: usize| self.sides[ring][i].abs() <= FAR;
        let turns = (0..n).map(|i| if is_near(i) { turn(i) } else { 0.0 });
        let turns: Vec<f64> = turns.collect();
        let is_sharpest = |i: &usize| {
            let around = (1..=far.min(n / 2)).flat_map(|d| [(*i + d) % n, (*i + n - d) % n]);
            turns[*i] > TURN && around.into_iter().all(|j| (turns[j], j) <= (turns[*i], *i))
        };
        let corners = (0..n).filter(is_sharpest).map(|at| Corner {
            ring,
            at,
            sharp: turns[at],
            is_joint: false,
        });
        corners.collect()
    }

    /// Where the sides of corners near the border, straight on beneath the ink, come out of it beside no other
    /// corner: the edges of both letters may lie in line there.
    fn exits(&self) -> Vec<Corner> {
        let mut out: Vec<Corner> = Vec::new();
        let before = self.before();
        for k in (0..self.corners.len()).filter(|&k| self.doubt(k) > 0.0) {
            let (on, back) = (self.finish(before[k]), self.begin(k));
            for (from, way) in [(on.at, on.way), (back.at, -back.way)] {
                let exit = self.leaves(from, way).and_then(|p| self.nearest(p));
                let exit = exit.filter(|c| self.is_apart(c, &out));
                out.extend(exit.filter(|_| out.len() < EXITS));
            }
        }
        out
    }

    /// Lays letters drawn alike as the one before the border and the one after it onto the ink: where their edges go
    /// beneath it there is a corner.
    fn follow(&mut self, field: &Field, examples: [&[Example]; 2]) {
        if examples.iter().all(|e| e.is_empty()) {
            return;
        }
        let ground = Ground::of(&self.rings, self.ink(), (self.stroke, self.half));
        let placed = examples.map(|e| ground.place(field, e));
        for (owner, placed) in placed.iter().enumerate() {
            let Some(placed) = placed else { continue };
            self.compare(owner, placed);
            for (ring, at) in placed.gone(self.apart()) {
                let corner = Corner {
                    ring,
                    at,
                    sharp: 0.0,
                    is_joint: false,
                };
                if self.is_apart(&corner, &[]) {
                    self.corners.push(corner);
                }
            }
        }
        self.corners.sort_by_key(|c| (c.ring, c.at));
        self.examples = placed;
    }

    /// Tells which points lie along the example of one letter, and which do not though they lie beside it, from where
    /// it begins on towards the border.
    fn compare(&mut self, owner: usize, placed: &Placed) {
        let toward = [1.0, -1.0][owner];
        let behind = |p: &Point| toward * self.across.at(*p);
        let from = placed.points().map(behind).fold(f64::INFINITY, f64::min);
        for (told, ring) in self.told.iter_mut().zip(&self.rings) {
            for (told, p) in told.iter_mut().zip(ring) {
                told[owner] = (behind(p) >= from).then_some(false);
            }
        }
        for (ring, at) in placed.seen() {
            self.told[ring][at][owner] = Some(true);
        }
    }

    /// Whether a corner is none of those that are known or of some others.
    fn is_apart(&self, corner: &Corner, others: &[Corner]) -> bool {
        let is_near = |o: &Corner| {
            let d = o.at.abs_diff(corner.at);
            let n = self.rings[corner.ring].len();
            o.ring == corner.ring && d.min(n - d) <= self.apart()
        };
        !self.corners.iter().chain(others).any(is_near)
    }

    /// By how many strokes more of the stretch after a corner is not the first letter's, by the examples, than is not
    /// the second's, and the other way round.
    pub(super) fn told(&self, corner: usize) -> [f64; 2] {
        let told = &self.told[self.corners[corner].ring];
        let points = || self.stretch(corner).map(|i| told[i]);
        let is_other = |t: &[Option<bool>; 2], k: usize| {
            t[k] == Some(false) || t[k].is_none() && t[1 - k] == Some(true)
        };
        let other = |k: usize| points().filter(|t| is_other(t, k)).count() as f64;
        let [first, second] = [0, 1].map(|k| other(k) * SPACING / self.stroke);
        [(first - second).max(0.0), (second - first).max(0.0)]
    }

    /// Marks a place, or the corner that is there, as a side of strokes that lie in line.
    fn join(&mut self, (ring, at): Place) {
        let n = self.rings[ring].len();
        let off = |c: &Corner| {
            let d = c.at.abs_diff(at);
            if c.ring == ring { d.min(n - d) } else { n }
        };
        let reach = self.apart();
        match self.corners.iter_mut().min_by_key(|c| off(c)) {
            Some(corner) if off(corner) <= reach => corner.is_joint = true,
            _ => self.corners.push(Corner {
                ring,
                at,
                sharp: 0.0,
                is_joint: true,
            }),
        }
        self.corners.sort_by_key(|c| (c.ring, c.at));
    }

    /// Corners are farther apart than so many points.
    const fn apart(&self) -> usize {
        2 * self.round + CLOSE
    }

    /// Where a way through the ink leaves it.
    fn leaves(&self, from: Point, way: Vec2) -> Option<Point> {
        let steps = self.round + CLOSE..index(LONGEST * self.stroke);
        let mut places = steps.map(|i| from + i as f64 * way);
        places.find(|p| !self.is_ink(*p))
    }

    /// The point of the rings that is nearest to a place.
    fn nearest(&self, p: Point) -> Option<Corner> {
        let rings = self.rings.iter().enumerate();
        let all = rings.flat_map(|(ring, points)| (0..points.len()).map(move |at| (ring, at)));
        let off = |(ring, at): (usize, usize)| self.rings[ring][at].distance(p);
        let (ring, at) = all.min_by(|a, b| off(*a).total_cmp(&off(*b)))?;
        Some(Corner {
            ring,
            at,
            sharp: 0.0,
            is_joint: false,
        })
    }

    fn ink(&self) -> Ink<'_> {
        Ink {
            inside: &self.inside,
            size: self.size,
        }
    }

    /// Whether there is ink at a place or a pixel beside it, holes by grain included: corners inwards are rounded.
    pub(super) fn is_ink(&self, p: Point) -> bool {
        self.ink().is_near(p)
    }

    /// The corner after another on its ring, which may be the same.
    pub(super) fn next(&self, corner: usize) -> usize {
        let ring = self.corners[corner].ring;
        let follows = self.corners.get(corner + 1);
        if follows.is_some_and(|c| c.ring == ring) {
            corner + 1
        } else {
            self.corners.partition_point(|c| c.ring < ring)
        }
    }

    /// The corner before each one.
    pub(super) fn before(&self) -> Vec<usize> {
        let mut before = vec![0; self.corners.len()];
        (0..before.len()).for_each(|k| before[self.next(k)] = k);
        before
    }

    /// The points from a corner to the next one.
    fn stretch(&self, corner: usize) -> impl Iterator<Item = usize> {
        let (a, b) = (self.corners[corner], self.corners[self.next(corner)]);
        let n = self.rings[a.ring].len();
        let length = match (b.at + n - a.at) % n {
            0 => n,
            length => length,
        };
        (0..=length).map(move |i| (a.at + i) % n)
    }

    /// Where they are, without what is round where they begin or end between two letters.
    pub(super) fn cut(&self, corner: usize, ends: [bool; 2]) -> Vec<Point> {
        let ring = &self.rings[self.corners[corner].ring];
        let all: Vec<Point> = self.stretch(corner).map(|i| ring[i]).collect();
        let round = self.round.min((all.len() - 1) / 2);
        let [from, to] = ends.map(|cut| if cut { round } else { 0 });
        all[from..all.len() - to].to_vec()
    }

    /// Where the stretch from a corner to the next one begins.
    pub(super) fn begin(&self, corner: usize) -> End {
        self.end(&self.cut(corner, [true; 2]))
    }

    /// Where it ends.
    pub(super) fn finish(&self, corner: usize) -> End {
        let mut back = self.cut(corner, [true; 2]);
        back.reverse();
        let End { at, way } = self.end(&back);
        End { at, way: -way }
    }

    /// Where some points begin: on the parabola through what is seen of them.
    fn end(&self, points: &[Point]) -> End {
        let seen = index((SEEN * self.stroke).max(2.0 * SHORTEST) / SPACING);
        let seen = &points[..points.len().min(seen + 1)];
        let straight = (seen[0], seen[seen.len() - 1] - seen[0]);
        let (at, way) = Parabola::beginning(seen).map_or(straight, |p| (p.at, p.way(0.0)));
        let length = way.hypot();
        End {
            at,
            way: if length > 0.0 {
                way / length
            } else {
                Vec2::new(1.0, 0.0)
            },
        }
    }

    /// How little a corner looks like one letter's own: 1 where it is sharp and at the border, 0 far from it.
    pub(super) fn doubt(&self, corner: usize) -> f64 {
        let Corner {
            ring, at, sharp, ..
        } = self.corners[corner];
        sharp.min(1.0) * (1.0 - self.sides[ring][at].abs()).max(0.0)
    }

    /// How the stretch from a corner to the next one lies.
    pub(super) fn lie(&self, corner: usize) -> Lie {
        let sides = &self.sides[self.corners[corner].ring];
        Lie::of(self.stretch(corner).map(|i| sides[i]), SPACING / self.half)
    }

    /// The rings without a corner, and how they lie.
    pub(super) fn whole(&self) -> impl Iterator<Item = (usize, Lie)> {
        let bare = |r: &usize| self.corners.iter().all(|c| c.ring != *r);
        let lie = |r: usize| Lie::of(self.sides[r].iter().copied(), SPACING / self.half);
        (0..self.rings.len()).filter(bare).map(move |r| (r, lie(r)))
    }
}

/// How an edge lies to a border; all in halves of the border's stretch.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lie {
    /// How far it lies before the border's middle and behind it, summed along it.
    pub(super) beyond: [f64; 2],
    /// From where to where it reaches behind the middle.
    pub(super) extent: [f64; 2],
}

impl Lie {
    /// Of places along it so far apart.
    fn of(sides: impl Iterator<Item = f64>, step: f64) -> Self {
        let none = Self {
            beyond: [0.0; 2],
            extent: [f64::INFINITY, f64::NEG_INFINITY],
        };
        sides.fold(none, |all, v| Self {
            beyond: [
                all.beyond[0] + step * (-v).max(0.0),
                all.beyond[1] + step * v.max(0.0),
            ],
            extent: [all.extent[0].min(v), all.extent[1].max(v)],
        })
    }
}
