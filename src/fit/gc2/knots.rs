//! Which points of a contour become knots: the six random insertions.
//!
//! Every round offers each piece between two knots one to three of its points by chance; a point whose
//! distance to the curve at the same place along the piece exceeds ε becomes a knot. Rounds go on until
//! one inserts nothing [rasheed05 alg. 4.1-4.6].

use super::Task;
use crate::numeric::turns::Ends;
use kurbo::{CubicBez, ParamCurve, Point};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// The six algorithms of the thesis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Insertion {
    /// Algorithm 4.1: one point.
    Single,
    /// Algorithm 4.2: one point, unless a knot is near by distance.
    SingleDistant,
    /// Algorithm 4.3: one point, unless a knot is near by position.
    SinglePositioned,
    /// Algorithm 4.4: three points.
    Three,
    /// Algorithm 4.5: a point in each third.
    ThreeSegmented,
    /// Algorithm 4.6: of three points the fuzzy best.
    Fuzzy,
}

impl Insertion {
    /// All six, in the order of the thesis.
    pub const ALL: [Self; 6] = [
        Self::Single,
        Self::SingleDistant,
        Self::SinglePositioned,
        Self::Three,
        Self::ThreeSegmented,
        Self::Fuzzy,
    ];
}

/// When insertion ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Stop {
    /// After the first round without a knot, as in the thesis: the error may exceed ε where chance did not look.
    Chance,
    /// When every point lies within ε; the worst points help where chance does not find any.
    Tolerance,
}

/// How knots are inserted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::fit) struct Rule {
    pub insertion: Insertion,
    pub stop: Stop,
    pub seed: u64,
    /// ε, px.
    pub epsilon: f64,
}

/// Knots and the curve through them.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::fit) struct Inserted {
    /// Indices of contour points, increasing.
    pub knots: Vec<usize>,
    pub cubics: Vec<CubicBez>,
}

/// τ of algorithm 4.2, in ε: the thesis leaves it to the user.
const NEAR: f64 = 3.0;
/// τ of algorithm 4.3, part of the piece.
const NEAR_PART: f64 = 0.1;
/// Weights of the two memberships of algorithm 4.6, w > v (eq. 4.21). Since they are multiplied, plain
/// factors would cancel; they are exponents here.
const FUZZY: (f64, f64) = (2.0, 1.0);
/// Rounds without a knot after which the worst points are taken, when the tolerance is what ends it.
const DRY: usize = 3;
/// Knots that a ring starts with.
const RING: usize = 4;

/// Inserts knots by `rule` into a span until it stops; `curve` draws a cubic an interval through the points of these
/// indices. `None` when it cannot.
pub(in crate::fit) fn insert(
    task: &Task<'_>,
    rule: Rule,
    curve: impl Fn(&[usize]) -> Option<Vec<CubicBez>>,
) -> Option<Inserted> {
    let knots = start(task);
    let cubics = curve(&knots)?;
    let inserted = Inserted { knots, cubics };
    let mut row = Row {
        task,
        rule,
        inserted,
    };
    let mut dice = Dice(rule.seed);
    let mut dry = 0;
    loop {
        let mut new: Vec<usize> = row.round(&mut dice);
        if new.is_empty() {
            dry += 1;
            if rule.stop == Stop::Chance || !row.pieces().any(|p| row.worst(&p).is_some()) {
                return Some(row.inserted);
            }
            if dry < DRY {
                continue;
            }
            new = row.pieces().filter_map(|p| row.worst(&p)).collect();
        }
        dry = 0;
        let knots = &mut row.inserted.knots;
        knots.extend(new.iter().map(|k| k % task.points.len()));
        knots.sort_unstable();
        knots.dedup();
        row.inserted.cubics = curve(knots)?;
    }
}

/// The outer points of an open row; of a ring, points at equal distances from the first on.
fn start(task: &Task<'_>) -> Vec<usize> {
    let (walk, last) = (&task.walk, task.points.len() - 1);
    if task.ends == Ends::Open {
        return vec![0, last];
    }
    let part = walk.total() / RING as f64;
    // a little less than the part, or rounding would choose where a point lies on it
    let place = |k: usize| k as f64 * part - 1e-6 * walk.total();
    let at = |k: usize| walk.lengths().partition_point(|&s| s < place(k)).min(last);
    let mut knots: Vec<usize> = (0..RING).map(at).collect();
    knots.dedup();
    knots
}

struct Row<'a> {
    task: &'a Task<'a>,
    rule: Rule,
    inserted: Inserted,
}

/// A piece: its place in the row and its points' indices from knot to knot, past the end on a ring.
struct Piece {
    place: usize,
    span: Range<usize>,
}

impl Row<'_> {
    fn pieces(&self) -> impl Iterator<Item = Piece> {
        let knots = &self.inserted.knots;
        let n = self.task.points.len();
        let around = (self.task.ends == Ends::Closed)
            .then(|| knots.first().map(|k| k + n))
            .flatten();
        let nexts = knots.iter().skip(1).copied().chain(around);
        let pairs = knots.iter().zip(nexts).enumerate();
        pairs.map(|(place, (&a, b))| Piece { place, span: a..b })
    }

    fn along(&self, k: usize) -> f64 {
        let n = self.task.points.len();
        self.task.walk.lengths()[k % n] + (k / n) as f64 * self.task.walk.total()
    }

    /// The contour point and the curve's point at the same place along the piece (eq. 4.11).
    fn pair(&self, piece: &Piece, k: usize) -> Option<(Point, Point)> {
        let (a, b) = (self.along(piece.span.start), self.along(piece.span.end));
        let theta = (self.along(k) - a) / (b - a);
        let curve = self.inserted.cubics.get(piece.place)?;
        Some((
            self.task.points[k % self.task.points.len()],
            curve.eval(theta),
        ))
    }

    fn distance(&self, piece: &Piece, k: usize) -> f64 {
        self.pair(piece, k).map_or(0.0, |(p, c)| p.distance(c))
    }

    /// The inner point farthest from the curve, if farther than ε.
    fn worst(&self, piece: &Piece) -> Option<usize> {
        let inner = piece.span.start + 1..piece.span.end;
        let far = inner
            .map(|k| (k, self.distance(piece, k)))
            .filter(|d| d.1 > self.rule.epsilon);
        far.max_by(|a, b| a.1.total_cmp(&b.1)).map(|d| d.0)
    }

    /// One draw for every piece.
    fn round(&self, dice: &mut Dice) -> Vec<usize> {
        let mut new = Vec::new();
        for piece in self.pieces() {
            let span = piece.span.clone();
            if span.len() < 2 {
                continue;
            }
            match self.rule.insertion {
                Insertion::Single => new.extend(self.far(&piece, dice.pick(span))),
                Insertion::SingleDistant => {
                    let k = self.far(&piece, dice.pick(span));
                    new.extend(k.filter(|&k| self.is_distant(&piece, k)));
                }
                Insertion::SinglePositioned => {
                    let k = self.far(&piece, dice.pick(span.clone()));
                    let margin = NEAR_PART * span.len() as f64; // eq. 4.16
                    new.extend(k.filter(|&k| to_ends(&span, k) > margin));
                }
                Insertion::Three => {
                    let three = [(); 3].map(|()| dice.pick(span.clone()));
                    new.extend(three.into_iter().filter_map(|k| self.far(&piece, k)));
                }
                Insertion::ThreeSegmented => {
                    let cut = |j: usize| span.start + span.len() * j / 3;
                    let three = [0, 1, 2].map(|j| dice.pick(cut(j)..cut(j + 1)));
                    new.extend(three.into_iter().filter_map(|k| self.far(&piece, k)));
                }
                Insertion::Fuzzy => new.extend(self.fuzzy(&piece, dice)),
            }
        }
        new
    }

    /// Eq. 4.12: the point, if it is an inner one and farther than ε from the curve.
    fn far(&self, piece: &Piece, k: usize) -> Option<usize> {
        let inner = k > piece.span.start && k < piece.span.end;
        (inner && self.distance(piece, k) > self.rule.epsilon).then_some(k)
    }

    /// Eq. 4.13-4.15: whether the curve's point is away from both knots.
    fn is_distant(&self, piece: &Piece, k: usize) -> bool {
        let knot = |i: usize| self.task.points[i % self.task.points.len()];
        self.pair(piece, k).is_some_and(|(_, c)| {
            let near = NEAR * self.rule.epsilon;
            c.distance(knot(piece.span.start)) > near && c.distance(knot(piece.span.end)) > near
        })
    }

    /// Algorithm 4.6: the point with the best product of memberships (eq. 4.17-4.20).
    fn fuzzy(&self, piece: &Piece, dice: &mut Dice) -> Option<usize> {
        let three = [(); 3].map(|()| dice.pick(piece.span.clone()));
        let distances = three.map(|k| self.distance(piece, k));
        let sum: f64 = distances.iter().sum();
        let half = piece.span.len() as f64 / 2.0;
        let membership = |i: usize| {
            let position = to_ends(&piece.span, three[i]) / half;
            libm::pow(distances[i] / sum, FUZZY.0) * libm::pow(position, FUZZY.1)
        };
        let best = (0..3).max_by(|&a, &b| membership(a).total_cmp(&membership(b)))?;
        self.far(piece, three[best])
    }
}

/// Positions to the nearer end of a piece.
fn to_ends(span: &Range<usize>, k: usize) -> f64 {
    k.saturating_sub(span.start).min(span.end.saturating_sub(k)) as f64
}

/// Repeatable chance: `SplitMix64`.
struct Dice(u64);

impl Dice {
    /// Uniform in 0…1, 1 left out.
    fn roll(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Eq. 4.10: a point after the first of the piece; the last one stands for none.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "0 ≤ roll < 1, so the result lies in 0 … len"
    )]
    fn pick(&mut self, span: Range<usize>) -> usize {
        span.start + (self.roll() * span.len() as f64).ceil() as usize
    }
}
