//! Letters compared by their strokes' B-splines.
//!
//! Source   [bsplinematch sec. 4, eq. 4-1, 4-2]; assignment of strokes by [kuhn55 sec. 3]
//! Solves   `E = Σ |r_i − r'_i|² / n`, `r'_i` the point of the other curve at the same share of its arc length
//! Takes    letters as strokes and dots, px
//! Gives    E in squared letters (root mean square radius 1) over all strokes, weighted by length
//! Symbols  `s_i / S` -> `Curve::shares`, `r'_i` -> `Curve::at`
//! Departs  the print of eq. 4-2 lost its sum; size is taken off, or sizes would be compared; `r_i` is where its
//! control point pulls most on the curve, so that equal curves have E = 0. Closed curves start on the
//! positive x axis from the centre, as printed. A letter of several strokes is beyond the paper:
//! strokes are assigned at the least cost and one without a partner pays for its length.
//! [`Way::Affine`] is what its conclusion asks for: order, number and knots as the stroke wants, the best
//! affine map taken off, strokes read from either end and closed ones from any point
//! Cost     O(strokes² · control points) a pair      Fails  never

use super::affine::{Map, STAY, Sums};
use super::skeleton::{Skeleton, Stroke};
use super::spline::{Data, FEW, Knots, PIXEL_STEPS, Spline};
use crate::numeric::assignment::assign;
use crate::numeric::cast::{index, single};
use crate::numeric::turns::{Ends, Walk};
use kurbo::{Point, Vec2};

/// How faithful to the paper.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Way {
    /// Uniform cubic B-splines, as they lie.
    Paper,
    /// Free knots and order, the best affine map between the letters taken off.
    Affine,
}

/// Strokes of a letter that are looked at, longest first.
const STROKES: usize = 12;
/// Points of a curve's table of arc length.
const TABLE: usize = 48;
/// Squared distance that a stroke without a partner pays along its length: the letter's radius is 1.
const ALONE: f64 = 1.0;
/// Rounds of assignment and affine estimate.
const ROUNDS: usize = 3;
/// Pull of the affine map towards none, and of its shift.
const STIFF: (f32, f32) = (0.15, 0.05);
/// Starts tried on a closed curve.
const STARTS: usize = 12;

/// A letter as curves about its centre, root mean square radius 1.
#[derive(Debug, Clone)]
pub(crate) struct Curves(Vec<Curve>);

/// A stroke or a dot.
#[derive(Debug, Clone)]
struct Curve {
    /// Evenly spaced in arc length, the last being the first again when closed.
    table: Vec<Point>,
    /// Arc length shares of the control points.
    shares: Vec<f64>,
    closed: bool,
    length: f64,
}

impl Curves {
    /// The curves of a letter's strokes.
    pub(crate) fn new(skeleton: &Skeleton, way: Way) -> Self {
        let mut curves: Vec<Curve> = skeleton
            .strokes
            .iter()
            .map(|s| Curve::new(s, way))
            .collect();
        curves.extend(skeleton.dots.iter().map(|d| Curve::dot(d.centre, d.radius)));
        curves.sort_by(|a, b| b.length.total_cmp(&a.length));
        curves.truncate(STROKES);
        let total: f64 = curves.iter().map(|c| c.length).sum();
        let mean = |f: &dyn Fn(Point) -> f64| {
            let sum = |c: &Curve| {
                c.length * c.table.iter().map(|p| f(*p)).sum::<f64>() / c.table.len() as f64
            };
            curves.iter().map(sum).sum::<f64>() / total.max(f64::MIN_POSITIVE)
        };
        let centre = Point::new(mean(&|p| p.x), mean(&|p| p.y));
        let size = mean(&|p| p.distance_squared(centre)).sqrt().max(1e-3);
        for c in &mut curves {
            c.table
                .iter_mut()
                .for_each(|p| *p = ((*p - centre) / size).to_point());
            c.length /= total.max(f64::MIN_POSITIVE);
            c.start();
        }
        Self(curves)
    }

    /// E between two letters, strokes assigned at the least cost.
    pub(crate) fn distance(&self, other: &Self, way: Way) -> f64 {
        let (few, many) = if self.0.len() <= other.0.len() {
            (self, other)
        } else {
            (other, self)
        };
        let mut map = STAY;
        let mut best = f64::INFINITY;
        for _ in 0..if way == Way::Affine { ROUNDS } else { 1 } {
            let (e, pairs) = few.compare(many, &map, way);
            best = best.min(e);
            let mut sums = Sums::default();
            for (a, b, w) in &pairs {
                sums.add(a.map(single), b.map(single), single(*w));
            }
            map = sums.map(STIFF);
        }
        best
    }

    /// E under a map of `self`, and the pairs of points it is made of with their weights.
    fn compare(&self, other: &Self, map: &Map, way: Way) -> (f64, Vec<Pair>) {
        let moved: Vec<Curve> = self.0.iter().map(|c| c.moved(map)).collect();
        let cost = |a: &Curve, b: &Curve| {
            let (e, order) = a.dissimilar(b, way);
            let price = (a.length + b.length) / 2.0 * e - ALONE * b.length / 2.0;
            (price, order)
        };
        let matches: Vec<Vec<_>> = moved
            .iter()
            .map(|a| other.0.iter().map(|b| cost(a, b)).collect())
            .collect();
        let costs: Vec<Vec<f64>> = matches
            .iter()
            .map(|r| r.iter().map(|c| c.0).collect())
            .collect();
        let given = assign(&costs);
        // Each of the other's strokes pays half its length alone; the costs above give that back.
        let mut e: f64 = other.0.iter().map(|b| ALONE * b.length / 2.0).sum();
        let mut pairs = Vec::new();
        for (i, &j) in given.iter().enumerate() {
            e += costs[i][j];
            let (a, b, order) = (&self.0[i], &other.0[j], matches[i][j].1);
            for &s in &a.shares {
                let (p, q) = (a.at(s), b.at(order.share(s)));
                pairs.push(([p.x, p.y], [q.x, q.y], a.length / a.shares.len() as f64));
            }
        }
        (e, pairs)
    }
}

/// From, to, weight.
type Pair = ([f64; 2], [f64; 2], f64);

/// Where and which way a curve is read.
#[derive(Debug, Clone, Copy)]
struct Order {
    start: f64,
    back: bool,
}

impl Order {
    /// The share of the way read from this start.
    fn share(self, s: f64) -> f64 {
        let s = if self.back { 1.0 - s } else { s } + self.start;
        if s > 1.0 { s - 1.0 } else { s }
    }
}

impl Curve {
    fn new(stroke: &Stroke, way: Way) -> Self {
        let knots = if way == Way::Paper {
            Knots::Uniform
        } else {
            Knots::Bends
        };
        let spline = Spline::choose(Data {
            points: &stroke.points,
            closed: stroke.closed,
            knots,
            noise: PIXEL_STEPS,
            most: FEW,
        });
        let fine = spline
            .as_ref()
            .map_or_else(|| stroke.points.clone(), |s| s.points(4 * TABLE));
        let walk = Walk::new(&fine, Ends::Open);
        let length = walk.total();
        let share = |u: f64| {
            let i = u * (fine.len() - 1) as f64;
            lerp(walk.lengths(), i) / length.max(f64::MIN_POSITIVE)
        };
        let even = |i: usize| walk.at(length * i as f64 / (TABLE - 1) as f64);
        let shares = spline.map_or_else(
            || vec![0.0, 0.5, 1.0],
            |s| s.pulls().into_iter().map(share).collect(),
        );
        Self {
            table: (0..TABLE).map(even).collect(),
            shares,
            closed: stroke.closed,
            length: length.max(1.0),
        }
    }

    fn dot(centre: Point, radius: f64) -> Self {
        Self {
            table: vec![centre; 2],
            shares: vec![0.5],
            closed: false,
            length: 2.0 * radius,
        }
    }

    /// Open: from the left, or from the top where it stands; closed: counter-clockwise from the positive x axis.
    fn start(&mut self) {
        let (first, last) = (self.at(0.0), self.at(1.0));
        let backwards = if self.closed {
            // y runs down: an area below 0 is counter-clockwise to the eye
            let pairs = self.table.windows(2);
            pairs
                .map(|w| w[0].to_vec2().cross(w[1].to_vec2()))
                .sum::<f64>()
                > 0.0
        } else {
            let way: Vec2 = last - first;
            if way.x.abs() > way.y.abs() {
                way.x < 0.0
            } else {
                way.y < 0.0
            }
        };
        if backwards {
            self.table.reverse();
            self.shares.iter_mut().for_each(|s| *s = 1.0 - *s);
        }
        if self.closed {
            self.table.pop();
            let axis = |p: &Point| libm::atan2(p.y, p.x).abs();
            let on_axis = (0..self.table.len())
                .min_by(|&i, &j| axis(&self.table[i]).total_cmp(&axis(&self.table[j])));
            let start = on_axis.unwrap_or_default();
            let part = start as f64 / self.table.len() as f64;
            self.table.rotate_left(start);
            self.table.push(self.table[0]);
            self.shares
                .iter_mut()
                .for_each(|s| *s = (*s - part).rem_euclid(1.0));
        }
    }

    /// The point at a share of the length.
    fn at(&self, share: f64) -> Point {
        let x = share.clamp(0.0, 1.0) * (self.table.len() - 1) as f64;
        let (i, t) = split(x, self.table.len());
        self.table[i].lerp(self.table[i + 1], t)
    }

    fn moved(&self, m: &Map) -> Self {
        let m = m.map(f64::from);
        let go = |p: &Point| {
            Point::new(
                m[0] * p.x + m[1] * p.y + m[2],
                m[3] * p.x + m[4] * p.y + m[5],
            )
        };
        Self {
            table: self.table.iter().map(go).collect(),
            ..self.clone()
        }
    }

    /// E between two strokes [bsplinematch eq. 4-2] and how the other is read for it.
    fn dissimilar(&self, other: &Self, way: Way) -> (f64, Order) {
        let plain = Order {
            start: 0.0,
            back: false,
        };
        let orders = match way {
            Way::Paper => vec![plain],
            Way::Affine if !other.closed => vec![
                plain,
                Order {
                    back: true,
                    ..plain
                },
            ],
            Way::Affine => (0..STARTS)
                .map(|i| Order {
                    start: i as f64 / STARTS as f64,
                    back: false,
                })
                .collect(),
        };
        let points: Vec<(f64, Point)> = self.shares.iter().map(|&s| (s, self.at(s))).collect();
        let e = |o: &Order| {
            let sum: f64 = points
                .iter()
                .map(|(s, p)| p.distance_squared(other.at(o.share(*s))))
                .sum();
            sum / points.len() as f64
        };
        let tried = orders.into_iter().map(|o| (e(&o), o));
        tried
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((0.0, plain))
    }
}

/// The interval of `n` ≥ 2 table entries that `x` lies in, and where in it.
fn split(x: f64, n: usize) -> (usize, f64) {
    let i = index(x).min(n - 2);
    (i, x - i as f64)
}

fn lerp(table: &[f64], x: f64) -> f64 {
    if table.len() < 2 {
        return 0.0;
    }
    let (i, t) = split(x, table.len());
    table[i] + t * (table[i + 1] - table[i])
}
