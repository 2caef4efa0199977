//! One segment between two candidates: how well could a line or a cubic do?

use super::candidate::Candidate;
use super::samples::Samples;
use crate::numeric::angles::{self, angle};
use crate::numeric::{
    chain::Join,
    powers::{LANES, Powers},
};
use kurbo::{CubicBez, Point, Vec2};

/// Samples looked at, at most: enough to see where a cubic fails.
const LOOKS: usize = 3 * LANES;
/// Deviation of a candidate's direction, radians: that of a parabola through a dozen noisy points.
const TURN: f64 = 0.03;
/// Deviation of the direction at a given end, radians, where the parabola is one-sided.
const TURN_END: f64 = 0.3;
/// Steps of Gauss–Newton.
const ROUNDS: usize = 4;
/// A cubic whose cost is so many times what it may be, and so many nats more, once its first step is taken bends too
/// hard for one: what further steps would find there rounds a corner.
const FAR: f64 = 25.0;
/// Usual length of a handle, chords, and its spread.
const HANDLE: (f64, f64) = (0.37, 0.4);
/// Deviation of a given end from where the curve ends, sigmas: corners are found less exactly than sides.
const LOOSE: f64 = 3.0;
/// What a given end that lies astray costs at most, nats.
const ASTRAY: f64 = 6.0;
/// Distances from which the cost grows linearly only, sigmas.
const ROBUST: f64 = 4.0;

/// Power sums over the samples, so that a line's cost is found without looking at them.
#[derive(Debug)]
pub(super) struct Lines {
    sums: Vec<[f64; 6]>,
    origin: Point,
}

impl Lines {
    /// Sums of a span once around, and twice for a ring.
    pub(super) fn new(s: &Samples) -> Self {
        let turns = if s.ring { 2 } else { 1 };
        let origin = s.at[0];
        let mut sums = Vec::with_capacity(turns * s.len() + 1);
        let mut sum = [0.0; 6];
        sums.push(sum);
        for k in 0..turns * s.len() {
            let p = s.point(k) - origin;
            let w = s.weight[k % s.len()];
            for (a, b) in sum
                .iter_mut()
                .zip([p.x, p.y, p.x * p.x, p.x * p.y, p.y * p.y, 1.0])
            {
                *a += w * b;
            }
            sums.push(sum);
        }
        Self { sums, origin }
    }

    /// Sum of squared distances of samples `i..=j` to their best line, and that line's direction.
    fn best(&self, i: usize, j: usize) -> (f64, Vec2) {
        let mut d = [0.0; 6];
        for (k, d) in d.iter_mut().enumerate() {
            *d = self.sums[j + 1][k] - self.sums[i][k];
        }
        let [x, y, xx, xy, yy, m] = d;
        let (xx, xy, yy) = (xx - x * x / m, xy - x * y / m, yy - y * y / m);
        let half = (0.25 * (xx - yy) * (xx - yy) + xy * xy).sqrt();
        let turn = 0.5 * libm::atan2(2.0 * xy, xx - yy);
        ((0.5 * (xx + yy) - half).max(0.0), angles::direction(turn))
    }

    /// Centre of samples `i..=j`.
    fn middle(&self, i: usize, j: usize) -> Point {
        let [x, y, m] = [0, 1, 5].map(|k| self.sums[j + 1][k] - self.sums[i][k]);
        self.origin + Vec2::new(x, y) / m
    }

    /// Cost of a line from `a` to `b`: what the samples and the directions of both candidates say against it.
    pub(super) fn cost(&self, s: &Samples, sigma: f64, a: &Candidate, b: &Candidate) -> f64 {
        let (i, j) = (a.index, b.index);
        let chord = s.point(j) - s.point(i);
        let (squares, direction) = self.best(i, j);
        let direction = if direction.dot(chord) < 0.0 {
            -direction
        } else {
            direction
        };
        let middle = self.middle(i, j);
        let ends = [a, b].into_iter().filter(|c| c.join == Join::End);
        let astray = ends.map(|c| {
            let off = (s.point(c.index) - middle).cross(direction) / place(Join::End, sigma);
            (0.5 * off * off).min(ASTRAY)
        });
        let astray: f64 = astray.sum();
        let turn: f64 = [a, b]
            .iter()
            .map(|c| {
                if c.join == Join::End {
                    return 0.0;
                }
                let off = angle(direction, c.heading) / slack(c.join).max(0.5 * TURN);
                0.5 * off * off
            })
            .sum();
        0.5 * squares / (sigma * sigma * super::cost::CORRELATION) + astray + turn
    }
}

/// Deviation of a candidate's direction, radians.
const fn slack(join: Join) -> f64 {
    match join {
        Join::Smooth | Join::Corner => TURN,
        Join::End => TURN_END,
        _ => 0.0,
    }
}

/// A point to pass, its parameter, and what it tells.
type Look = (Point, f64, f64);

/// A cubic between two candidates whose places and directions may give way as far as they are uncertain.
struct Trial<'a> {
    ends: [&'a Candidate; 2],
    places: [Point; 2],
    /// Offset and turn of the start, of the end, then both handles.
    v: [f64; 6],
    /// Deviations of the first four.
    slacks: [f64; 4],
    chord: f64,
    looks: [Look; LOOKS],
    count: usize,
    sigma: f64,
    /// Measurements that a point stands for.
    weight: f64,
    /// Directions of the curve at its start and end, and of its places beside the samples.
    along: [Vec2; 2],
    beside: [Vec2; 2],
    /// Of each look the normal at its foot, the distance along it, and what that weighs.
    off: [(Vec2, f64, f64); LOOKS],
}

/// Gauss–Newton's sums over the six numbers of a [`Trial`].
#[derive(Default)]
struct Sums {
    h: [[f64; 6]; 6],
    g: [f64; 6],
}

impl Sums {
    /// Adds one row of the Jacobian; the lower half in pairs of columns.
    fn add(&mut self, row: &[f64; 6], weight: f64, distance: f64) {
        fn line<const N: usize>(to: &mut [f64; 6], row: &[f64; 6], by: f64) {
            for l in 0..N {
                to[l] += by * row[l];
            }
        }
        let by = row.map(|r| weight * r);
        line::<6>(&mut self.g, &by, distance);
        line::<2>(&mut self.h[0], row, by[0]);
        line::<2>(&mut self.h[1], row, by[1]);
        line::<4>(&mut self.h[2], row, by[2]);
        line::<4>(&mut self.h[3], row, by[3]);
        line::<6>(&mut self.h[4], row, by[4]);
        line::<6>(&mut self.h[5], row, by[5]);
    }
}

/// Cost of the best cubic from `a` to `b`. Both may give way as far as they are uncertain, so that no node
/// is bought to mend an estimate. Given up where `enough` is out of reach.
pub(super) fn cubic_cost(
    s: &Samples,
    sigma: f64,
    (a, b): (&Candidate, &Candidate),
    enough: f64,
) -> f64 {
    let mut trial = Trial::new(s, sigma, a, b);
    let mut best = f64::INFINITY;
    for round in 0..=ROUNDS {
        let cost = trial.look();
        let gain = best - cost;
        best = best.min(cost);
        // What is left is hardly more than the last gain.
        let hopeless = round > 1 && best - 2.0 * gain > enough;
        let far = round > 0 && best > FAR * (enough + 1.0);
        if round == ROUNDS || gain < 0.5 || hopeless || far {
            break;
        }
        let mut sums = trial.sums();
        if !solve6(&mut sums.h, &mut sums.g) {
            break;
        }
        trial.step(&sums.g);
    }
    best
}

impl<'a> Trial<'a> {
    fn new(s: &Samples, sigma: f64, a: &'a Candidate, b: &'a Candidate) -> Self {
        let (i, j) = (a.index, b.index);
        let places = [s.point(i), s.point(j)];
        let count = (j - i).clamp(1, LOOKS);
        let length = (j - i) as f64 * s.step;
        let mut looks = [(Point::ORIGIN, 0.0, 1.0); LOOKS];
        // the middle of each of `count` parts: a sample and what is left, in halves of a part
        let halves = 2 * count;
        let (mut k, mut rest) = (i + (j - i) / halves, (j - i) % halves);
        let (whole, more) = ((j - i) / count, 2 * (j - i) % halves);
        for (m, look) in looks.iter_mut().take(count).enumerate() {
            let at = s.point(k).lerp(s.point(k + 1), rest as f64 / halves as f64);
            let tells = s.weight[k % s.len()];
            *look = (at, (m as f64 + 0.5) / count as f64, tells);
            (k, rest) = (k + whole, rest + more);
            if rest >= halves {
                (k, rest) = (k + 1, rest - halves);
            }
        }
        Self {
            ends: [a, b],
            places,
            v: [0.0, 0.0, 0.0, 0.0, length / 3.0, length / 3.0],
            slacks: [
                place(a.join, sigma),
                slack(a.join),
                place(b.join, sigma),
                slack(b.join),
            ],
            chord: places[0].distance(places[1]).max(1e-9),
            looks,
            count,
            sigma,
            weight: (j - i) as f64 / (count as f64 * super::cost::CORRELATION),
            along: [a.heading, b.heading],
            beside: [a.heading.turn_90(), b.heading.turn_90()],
            off: [(Vec2::ZERO, 0.0, 0.0); LOOKS],
        }
    }

    /// Where the curve is off, and what that costs.
    fn look(&mut self) -> f64 {
        let v = self.v;
        let turned = |end: usize, by: f64| {
            let heading = self.ends[end].heading;
            heading.rotate_scale(angles::direction(by))
        };
        let (u, w) = (turned(0, v[1]), turned(1, v[3]));
        self.along = [u, w];
        let [nu, nw] = self.beside;
        let (p0, p3) = (self.places[0] + v[0] * nu, self.places[1] + v[2] * nw);
        let powers = Powers::new(&CubicBez::new(p0, p0 + v[4] * u, p3 - v[5] * w, p3));
        let (fours, _) = self.looks.as_chunks_mut::<LANES>();
        for looks in fours.iter_mut().take(self.count.div_ceil(LANES)) {
            let at = looks.map(|(point, ..)| point);
            let anywhere = (f64::INFINITY, 0.0..=1.0);
            let t = powers.feet(at, looks.map(|(_, t, _)| t), anywhere);
            looks.iter_mut().zip(t).for_each(|(l, t)| l.1 = t);
        }
        let mut cost = 0.0;
        let looks = self.looks.iter().zip(&mut self.off);
        for ((point, t, tells), off) in looks.take(self.count) {
            let (foot, along, _) = powers.at(*t);
            let offset = foot - *point;
            let n = (along / along.hypot().max(1e-12)).turn_90();
            let d = offset.dot(n);
            let r = d.abs() / self.sigma;
            let (rho, pull) = if r > ROBUST {
                (ROBUST * (r - 0.5 * ROBUST), ROBUST / r)
            } else {
                (0.5 * r * r, 1.0)
            };
            let weight = self.weight * *tells;
            cost += weight * rho;
            *off = (n, d, weight * pull / (self.sigma * self.sigma));
        }
        self.priors()
            .fold(cost, |cost, (off, tight)| cost + 0.5 * off * off * tight)
    }

    /// The sums at the last look.
    fn sums(&self) -> Sums {
        let mut sums = Sums::default();
        let (v, [u, w], [nu, nw]) = (self.v, self.along, self.beside);
        let looks = self.looks.iter().zip(&self.off);
        for ((_, t, _), (n, d, weight)) in looks.take(self.count) {
            let (t, o) = (*t, 1.0 - *t);
            let (b1, b2) = (3.0 * o * o * t, 3.0 * o * t * t);
            let (start, end) = (o * o * o + b1, t * t * t + b2);
            let row = [
                start * nu.dot(*n),
                b1 * v[4] * u.turn_90().dot(*n),
                end * nw.dot(*n),
                -b2 * v[5] * w.turn_90().dot(*n),
                b1 * u.dot(*n),
                -b2 * w.dot(*n),
            ];
            sums.add(&row, *weight, *d);
        }
        for (k, (off, tight)) in self.priors().enumerate() {
            sums.g[k] += off * tight;
            sums.h[k][k] += tight;
        }
        sums
    }

    /// How far each number is from what is usual, and one over the square of how far it may be.
    fn priors(&self) -> impl Iterator<Item = (f64, f64)> {
        let handles = [(self.chord * HANDLE.0, self.chord * HANDLE.1); 2];
        let ends = self.slacks.map(|slack| (0.0, slack));
        let priors = self.v.into_iter().zip(ends.into_iter().chain(handles));
        priors.map(|(v, (mean, spread))| (v - mean, 1.0 / (spread * spread).max(1e-8)))
    }

    fn step(&mut self, by: &[f64; 6]) {
        for (k, v) in self.v.iter_mut().enumerate() {
            *v = match self.slacks.get(k) {
                Some(slack) => (*v - by[k]).clamp(-3.0 * slack, 3.0 * slack),
                // A handle keeps its side.
                None => (*v - by[k])
                    .clamp(0.3 * *v, 2.0 * *v)
                    .max(0.02 * self.chord),
            };
        }
    }
}

/// How far a node may lie beside its sample, px.
const fn place(join: Join, sigma: f64) -> f64 {
    match join {
        Join::End | Join::Loose => LOOSE * sigma,
        Join::Clamped => 0.0,
        _ => sigma,
    }
}

/// Cholesky of a 6 × 6; the solution replaces `g`.
fn solve6(h: &mut [[f64; 6]; 6], g: &mut [f64; 6]) -> bool {
    for i in 0..6 {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| h[i][k] * h[j][k]).sum();
            let rest = h[i][j] - dot;
            if i == j {
                if rest <= 0.0 {
                    return false;
                }
                h[i][i] = rest.sqrt();
            } else {
                h[i][j] = rest / h[j][j];
            }
        }
    }
    for i in 0..6 {
        let dot: f64 = (0..i).map(|k| h[i][k] * g[k]).sum();
        g[i] = (g[i] - dot) / h[i][i];
    }
    for i in (0..6).rev() {
        let dot: f64 = (i + 1..6).map(|k| h[k][i] * g[k]).sum();
        g[i] = (g[i] - dot) / h[i][i];
    }
    true
}
