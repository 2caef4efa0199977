//! The tilt at which a page was seen: its rows and columns meet far away.
//!
//! Rows of letters stand on common lines of one pencil, y − t x = Y (1 + g x) from the picture's middle; of all
//! pencils the true one piles the ink's edges up highest, as the true angle does where g is 0. Columns are x − s y =
//! X (1 + k y): in a grid letters stand in them, printed boxes pile up their sides, and on a bare page the edges of
//! the paper are two of them. Both pencils together are the view.

use super::components::Component;
use super::deskew::{Edges, energy_of};
use super::options::Layout;
use super::paper::Paper;
use crate::numeric::angles;
use crate::numeric::cast::index;
use crate::numeric::view::View;
use kurbo::{Affine, Point, Rect, Vec2};
use nalgebra::{SMatrix, SVector};
use rayon::prelude::*;
use std::cmp::Reverse;
use std::f64::consts::TAU;

/// Convergence that is looked for: how much nearer the picture's side is than its middle.
const REACH: f64 = 0.16;
/// Distance of the first ones looked at.
const STEP: f64 = 0.016;
/// How far the direction of the middle line may be off the page's skew, and the distance of those looked at.
const SLOPES: (f64, f64) = (0.03, 0.01);
/// Rounds after the first, each twice as close.
const ROUNDS: i32 = 6;
/// Edge points that say enough about the pencils first looked at, and about the last.
const POINTS: (usize, usize) = (3_000, 20_000);
/// Rows that converge by less lie level, for a cutter and for the eye.
const LEVEL: f64 = 0.008;
/// Rows that converge so little are straightened in grids and boxes only: rows of a free hand may fan out by
/// themselves.
const DRIFT: f64 = 0.02;
/// Columns that converge by less stand upright: letters are seldom set down more exactly.
const PLUMB: f64 = 0.02;
/// How much higher than level rows the pencil must pile up the edges, as a ratio.
const CLEAR: f64 = 1.1;
/// Standard errors by which columns must be seen to meet.
const SURE: f64 = 4.0;
/// Rows that slope each in its own way tell a page's turn anew where it is as much more, degrees.
const LEAST_TURN_DEG: f64 = 0.25;
/// Pieces of ink smaller than this share of the usual one are dots.
const BODY: f64 = 0.3;
/// Pitches tried for columns, and how far their direction may be off in steps of what they tell.
const PITCHES: usize = 60;
const LEANS: i32 = 6;
/// Times that pieces are given to the columns found.
const SETTLING: usize = 4;
/// Pieces of ink that tell columns, the largest.
const PIECES: usize = 300;

/// Lines through one point far away: slope of the one in the middle, and how the slope changes with the distance from
/// it, a px.
#[derive(Debug, Clone, Copy, Default)]
struct Pencil {
    slope: f64,
    turn: f64,
}

impl Pencil {
    /// A view's level lines in the picture.
    fn of(view: &View, middle: Point) -> Self {
        let slope = |y: f64| {
            let [x, y, ..] = view.near(Point::new(middle.x, y)).inverse().as_coeffs();
            y / x
        };
        Self {
            slope: slope(middle.y),
            turn: (slope(2.0 * middle.y) - slope(0.0)) / (2.0 * middle.y),
        }
    }
}

/// How a page's rows lie.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Rows {
    /// As lines of one pencil, so that they tell how the page was seen.
    Together,
    /// Each in its own way.
    Apart,
}

/// What rows that slope each in its own way tell of how a page lies, better than all ink together.
#[derive(Clone, Copy)]
pub(super) struct Told {
    /// Clockwise.
    pub(super) skew_deg: f64,
    pub(super) rows: Rows,
}

impl Told {
    /// By rows that a view shows at such levels and with such slopes, px and px down for one to the right; nothing
    /// where it shows the page as they do.
    ///
    /// The perspective that it found in them is theirs where they meet far faster than such slopes do by chance.
    pub(super) fn by(rows: &[(f64, f64)], view: &View, middle: Point) -> Option<Self> {
        let seen = Pencil::of(view, middle);
        let count = rows.len() as f64;
        let mean = |of: &dyn Fn(&(f64, f64)) -> f64| rows.iter().map(of).sum::<f64>() / count;
        let (level, slope) = (mean(&|r| r.0), mean(&|r| r.1));
        let lever = mean(&|r| (r.0 - level).powi(2));
        let trend = mean(&|r| (r.0 - level) * (r.1 - slope)) / lever;
        let off = mean(&|r| (r.1 - slope - trend * (r.0 - level)).powi(2));
        let doubt = (off / (count - 2.0) / lever).sqrt();
        let sure = (seen.turn + trend).abs() >= SURE * doubt;
        let by_chance = view.affine().is_none() && !sure;
        // all rows in the mean as they lie in the picture, or the one in its middle
        let below = level - view.at(middle).y;
        let (rows, turn) = if by_chance {
            (Rows::Apart, seen.turn)
        } else {
            (Rows::Together, 0.0)
        };
        let more = slope + turn * below;
        let news = rows == Rows::Apart || libm::atan(more).to_degrees().abs() >= LEAST_TURN_DEG;
        news.then(|| Self {
            skew_deg: libm::atan(seen.slope + more).to_degrees(),
            rows,
        })
    }
}

/// What tells how a page was seen.
pub(super) struct Scene<'a> {
    pub(super) ink: &'a [&'a Component],
    pub(super) edges: &'a Edges,
    /// The picture's middle, px, which is also half its size.
    pub(super) middle: Point,
    pub(super) skew_deg: f64,
    pub(super) rows: Rows,
    pub(super) layout: Layout,
    pub(super) paper: Option<&'a Paper>,
}

impl Scene<'_> {
    /// From the picture to the upright page; turned only, where it was seen from straight above.
    pub(super) fn view(&self) -> View {
        let slope = libm::tan(self.skew_deg.to_radians());
        let rows = match self.rows {
            Rows::Together => self.pencil(&self.edges.about(self.middle), slope),
            Rows::Apart => None,
        };
        let least = if self.layout == Layout::Free {
            DRIFT
        } else {
            LEVEL
        };
        let rows = rows.filter(|p| p.turn.abs() * self.middle.x > least);
        let level = rows.unwrap_or(Pencil { slope, turn: 0.0 });
        let columns = match self.layout {
            Layout::Grid(_, count) => self.columns(count, level),
            Layout::Boxes => self.pencil(&flanks(self.ink, self.middle), -slope),
            Layout::Free => self.paper.and_then(|p| self.sides(p)),
        };
        let columns = columns.filter(|p| p.turn.abs() * self.middle.y > PLUMB);
        if rows.is_none() && columns.is_none() {
            let turn = angles::rotation_about(-self.skew_deg.to_radians(), self.middle);
            return turn.into();
        }
        let plumb = columns.unwrap_or(Pencil {
            slope: -level.slope,
            turn: 0.0,
        });
        through(level, plumb, self.middle)
    }

    /// The pencil that piles up edges highest, lines along x; `None` where level lines do as well.
    fn pencil(&self, edges: &[Vec<Vec2>; 2], slope: f64) -> Option<Pencil> {
        let thinned = |most: usize| -> Vec<Vec<Vec2>> {
            let step = |all: &Vec<Vec2>| all.len().div_ceil(most).max(1);
            let thin = |all: &Vec<Vec2>| all.iter().copied().step_by(step(all)).collect();
            edges.iter().map(thin).collect()
        };
        let (few, many) = (thinned(POINTS.0), thinned(POINTS.1));
        let half = self.middle.x.max(self.middle.y);
        let score = |sets: &[Vec<Vec2>], p: Pencil, bin: f64| -> f64 {
            let down = |q: &Vec2| (q.y - p.slope * q.x) / (1.0 + p.turn * q.x);
            sets.iter()
                .map(|set| energy_of(set.iter().map(|q| down(q) / bin)) / bin)
                .sum()
        };
        let turns = index(2.0 * REACH / STEP);
        let slopes = index(2.0 * SLOPES.0 / SLOPES.1 + 0.5);
        let start = |i: usize| Pencil {
            slope: slope - SLOPES.0 + SLOPES.1 * (i % (slopes + 1)) as f64,
            turn: (STEP * (i / (slopes + 1)) as f64 - REACH) / half,
        };
        let tries = (0..(slopes + 1) * (turns + 1)).into_par_iter().map(start);
        let coarse = (STEP * half / 2.0).max(1.0);
        let scored = tries.map(|p| (score(&few, p, coarse), p));
        let (_, mut best) = scored
            .collect::<Vec<_>>()
            .into_iter()
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        if best.turn.abs() * half < STEP / 2.0 {
            return None;
        }
        let (mut step, mut bin) = ((SLOPES.1 / 2.0, STEP / 2.0 / half), coarse);
        for _ in 0..ROUNDS {
            bin = (bin / 2.0).max(1.0);
            best = nearest(|p| score(&many, p, bin), best, step);
            step = (step.0 / 2.0, step.1 / 2.0);
        }
        let level = |p: Pencil| score(&many, p, bin);
        let flat = (-8..=8).map(|i| slope + 0.002 * f64::from(i));
        let flat = flat.map(|slope| level(Pencil { slope, turn: 0.0 }));
        let flat = flat.fold(0.0, f64::max);
        (level(best) > CLEAR * flat).then_some(best)
    }

    /// The columns of a grid, from the pieces of ink that stand in them; `None` where they stand too irregularly to
    /// say that columns meet.
    fn columns(&self, count: usize, rows: Pencil) -> Option<Pencil> {
        let mut ink: Vec<&Component> = self.ink.to_vec();
        ink.sort_by_key(|c| Reverse(c.area));
        ink.truncate(PIECES);
        let usual = ink.get(ink.len() / 2)?.area;
        ink.retain(|c| c.area as f64 > BODY * usual as f64);
        let edges: [fn(&Rect) -> f64; 3] = [|r| r.center().x, |r| r.x0, |r| r.x1];
        let fits = edges.iter().filter_map(|edge| {
            let at = |c: &&Component| {
                Vec2::new(edge(&c.bounds), c.bounds.center().y) - self.middle.to_vec2()
            };
            lattice(&ink.iter().map(at).collect::<Vec<_>>(), count, -rows.slope)
        });
        let best = fits.min_by(|a, b| a.scatter.total_cmp(&b.scatter))?;
        (best.pencil.turn.abs() > SURE * best.doubt).then_some(best.pencil)
    }

    /// The paper's left and right edges as columns.
    fn sides(&self, paper: &Paper) -> Option<Pencil> {
        let [left, right] = paper.sides()?;
        let about =
            |(place, slope): (f64, f64)| (place + slope * self.middle.y - self.middle.x, slope);
        let ((x0, b0), (x1, b1)) = (about(left), about(right));
        // x = X + (s + k X) y
        let turn = (b1 - b0) / (x1 - x0);
        (x1 > x0).then_some(Pencil {
            slope: b0 - turn * x0,
            turn,
        })
    }
}

/// Columns as they fit pieces of ink.
struct Lattice {
    pencil: Pencil,
    /// Standard error of the pencil's turn.
    doubt: f64,
    /// Root mean square distance of the pieces from their columns, px.
    scatter: f64,
}

/// Columns x = X + (s + k X) y with X = x₀ + P c, fitted to points by least squares of 1, c, y and c y; the columns c
/// come from the pitch and lean with the strongest wave, and then from each fit.
fn lattice(points: &[Vec2], count: usize, lean: f64) -> Option<Lattice> {
    if count < 3 || points.len() < 12 {
        return None;
    }
    let (pitch, lean, phase) = wave(points, count, lean);
    let mut column: Vec<f64> = points
        .iter()
        .map(|p| ((p.x - lean * p.y - phase) / pitch).round())
        .collect();
    let mut fit = None;
    for _ in 0..SETTLING {
        let mut a = SMatrix::<f64, 4, 4>::zeros();
        let mut b = SVector::<f64, 4>::zeros();
        let row = |p: &Vec2, c: f64| SVector::<f64, 4>::new(1.0, c, p.y, c * p.y);
        for (p, &c) in points.iter().zip(&column) {
            let r = row(p, c);
            a += r * r.transpose();
            b += r * p.x;
        }
        let back = a.try_inverse()?;
        let v = back * b;
        let off = points
            .iter()
            .zip(&column)
            .map(|(p, &c)| p.x - row(p, c).dot(&v));
        let squares: f64 = off.map(|d| d * d).sum();
        let variance = squares / (points.len() as f64 - 4.0);
        let turn = v[3] / v[1];
        fit = Some(Lattice {
            pencil: Pencil {
                slope: v[2] - turn * v[0],
                turn,
            },
            doubt: (variance * back[(3, 3)]).sqrt() / v[1].abs(),
            scatter: variance.sqrt(),
        });
        column = points
            .iter()
            .map(|p| ((p.x - v[0] - v[2] * p.y) / (v[1] + v[3] * p.y)).round())
            .collect();
    }
    fit
}

/// Pitch, lean and phase of the columns with the strongest wave.
fn wave(points: &[Vec2], count: usize, lean: f64) -> (f64, f64, f64) {
    let n = count as f64;
    let tries = (-LEANS..=LEANS).flat_map(|i| {
        let lean = lean + SLOPES.1 * f64::from(i);
        let across: Vec<f64> = points.iter().map(|p| p.x - lean * p.y).collect();
        let low = across.iter().copied().fold(f64::INFINITY, f64::min);
        let high = across.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let (least, most) = ((high - low) / (n + 0.2), (high - low) / (n - 1.6));
        (0..PITCHES).map(move |k| {
            let pitch = least + (most - least) * k as f64 / (PITCHES - 1) as f64;
            let sum = across.iter().fold(Vec2::ZERO, |sum, x| {
                sum + angles::direction(TAU * x / pitch)
            });
            (
                sum.hypot(),
                (pitch, lean, angles::heading(sum) / TAU * pitch),
            )
        })
    });
    let best = tries.max_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or((1.0, lean, 0.0), |b| b.1)
}

/// Points on the ink's left and right edges, from the middle; the axes changed.
fn flanks(ink: &[&Component], middle: Point) -> [Vec<Vec2>; 2] {
    let runs = || ink.iter().flat_map(|c| &c.runs);
    let at = |x: usize, y: usize| Vec2::new(y as f64 + 0.5 - middle.y, x as f64 - middle.x);
    [
        runs().map(|r| at(r.start, r.y)).collect(),
        runs().map(|r| at(r.end, r.y)).collect(),
    ]
}

/// The best of a pencil and its neighbours.
fn nearest(score: impl Fn(Pencil) -> f64 + Sync, at: Pencil, step: (f64, f64)) -> Pencil {
    let near = |i: i32| Pencil {
        slope: at.slope + step.0 * f64::from(i % 3 - 1),
        turn: at.turn + step.1 * f64::from(i / 3 - 1),
    };
    let scored: Vec<(f64, Pencil)> = (0..9)
        .into_par_iter()
        .map(near)
        .map(|p| (score(p), p))
        .collect();
    let best = scored.into_iter().max_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(at, |b| b.1)
}

/// The view whose level lines are the rows and whose upright ones are the columns; about `middle` nothing grows.
fn through(rows: Pencil, columns: Pencil, middle: Point) -> View {
    let (t, s) = (rows.slope, columns.slope);
    // seen through a divisor 1 + g x + k y, rows turn by g + t k and columns by k + s g
    let both = 1.0 - t * s;
    let g = (rows.turn - t * columns.turn) / both;
    let k = (columns.turn - s * rows.turn) / both;
    let size = both.max(0.1).sqrt();
    let straight = View::of_pencils([1.0 / size, -s / size, -t / size, 1.0 / size, g, k]);
    let (there, back) = (
        Affine::translate(middle.to_vec2()),
        Affine::translate(-middle.to_vec2()),
    );
    View::from(there) * straight * View::from(back)
}
