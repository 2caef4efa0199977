//! A few nodes against the pixels around them, by least squares of the pixels themselves.
//!
//! Solves   min Σ (seen − blurred fill)² over the window's pixels + Σ (way of the curves from their edges beyond it)²,  over the
//! numbers of the nodes inside. Gauss–Newton with Levenberg's damping ([`normal`]).
//!
//! Where an outline turns within the lens' reach no point of its contour tells where it is by itself: the picture of
//! the whole place does.

mod normal;
mod numbers;

use crate::{
    numeric::{
        cast::{index, single},
        chain::{Chain, Kind},
        coverage::{Coverage, blur},
        joins::past_levels,
    },
    refine::{curves::polygon_px, residual::Residual},
    types::Contour,
};
use kurbo::{Affine, CubicBez, ParamCurve, ParamCurveDeriv, Point, Rect, Vec2};
use normal::{Normal, Shared};
use numbers::{nudge, numbers, shorten};
use std::{cell::OnceCell, f64::consts::PI, ops::Range};

/// Chords leave a curve by no more than this, px.
const CHORD_PX: f64 = 0.02;
/// And are no more: a step may throw a handle far out.
const MOST_CHORDS: usize = 1000;
/// Way along a curve beyond the window for one anchor, px, and how many there are on a curve at most.
const STEP_PX: f64 = 2.0;
const MOST_ANCHORS: f64 = 32.0;
/// A place of the picture tells of an edge no further away, px.
const SHIFT_PX: f64 = 1.0;
/// Steps of the least squares.
const STEPS: usize = 20;
/// A step that lowers what is left beyond grain by less than this part, or the squares by less than this, is the
/// last.
const PROGRESS: f64 = 0.005;
const LITTLE: f64 = 3e-4;
/// Steps as good as the last that a fit is trusted to take still.
const HOPE: f64 = 4.0;
/// Handles of drawn curves are about this part of the chord, and stray from it by so much.
const HANDLE: (f64, f64) = (0.37, 0.4);
/// Which is as heavy as so many pixels' grain.
const PRIOR_GRAIN: f64 = 4.0;
/// What a px of a handle past the level of an extremum weighs.
const PAST: f64 = 2.0;

/// A rectangle of the picture and what is known of the paths in it.
#[derive(Debug)]
pub(super) struct Window {
    columns: Range<usize>,
    /// from the top
    rows: Range<usize>,
    /// from px of the outlines to its own, y up
    to_own: Affine,
    /// pixels at each side that only lend their light
    margin: usize,
    lens: f64,
    /// picture minus the blurred fill of all that does not move, in the pixels that count
    still: Vec<f32>,
    /// mean square of the differences that mean nothing
    grain: f64,
    anchors: Vec<Anchor>,
    shared: OnceCell<Shared>,
}

/// Where the edge of a curve that moves is beyond the window, and which way out of the ink.
#[derive(Debug)]
struct Anchor {
    at: Point,
    outward: Vec2,
    weight: f64,
}

/// A chain in a window, and what is left of the picture.
#[derive(Debug)]
pub(super) struct Drawn {
    chords: Vec<Vec<Point>>,
    /// segment and parameter nearest to each anchor
    feet: Vec<(usize, f64)>,
    /// differences left in the pixels that count, row by row from the top, of the anchors, and of the handles, four a
    /// segment
    left: Vec<f32>,
    /// squares of all these
    sum: f64,
    /// and without the handles
    pub(super) squares: f64,
}

impl Window {
    /// The window that reaches `reach` px from `p` to each side. `moving` is an open part of a path, the `lines` of
    /// all else need not close; `grain` is the mean square of differences that mean nothing.
    pub(super) fn new<'r>(
        residual: &Residual<'_>,
        (p, reach): (Point, f64),
        lines: impl Iterator<Item = &'r [Point]>,
        moving: &Chain,
        grain: f64,
    ) -> Self {
        let seen = residual.seen();
        let lens = residual.lens_px();
        let (margin, whole) = margins(lens, reach);
        let around = |c: f64, n: usize| {
            let c = index(c.max(0.0)).min(n.saturating_sub(1));
            c.saturating_sub(whole)..(c + whole + 1).min(n)
        };
        let (height, p) = (seen.height(), residual.to_picture() * p);
        let columns = around(p.x, seen.width());
        let rows = around(height as f64 - p.y, height);
        let corner = Vec2::new(columns.start as f64, (height - rows.end) as f64);
        let mut window = Self {
            to_own: Affine::translate(-corner) * residual.to_picture(),
            columns,
            rows,
            margin,
            lens,
            still: Vec::new(),
            grain,
            anchors: Vec::new(),
            shared: OnceCell::new(),
        };
        let fill = Coverage::new(window.columns.len(), window.rows.len());
        let mut fill = fill.mapped(window.to_own);
        lines.for_each(|line| fill.line(line));
        window.still = window.blurred(&fill);
        let (columns, rows) = window.inner();
        let pixels = rows.flat_map(|y| &seen.row(y)[columns.clone()]);
        let pairs = window.still.iter_mut().zip(pixels);
        pairs.for_each(|(still, seen)| *still = seen - *still);
        window.drop_anchors(residual, moving);
        window
    }

    /// What the window of a place can see; of a ring that does not overlap this, nothing.
    pub(super) fn bounds(residual: &Residual<'_>, (p, reach): (Point, f64)) -> Rect {
        let (_, whole) = margins(residual.lens_px(), reach);
        let side = 2.0 * (whole as f64 + 1.0);
        let seen = Rect::from_center_size(residual.to_picture() * p, (side, side));
        residual.to_picture().inverse().transform_rect_bbox(seen)
    }

    /// Pixels that count.
    pub(super) fn pixels(&self) -> f64 {
        let (columns, rows) = self.inner();
        (columns.len() * rows.len()) as f64
    }

    /// The chain as it is.
    pub(super) fn drawn(&self, chain: &Chain) -> Drawn {
        let chords: Vec<Vec<Point>> = (0..chain.kinds.len())
            .map(|i| self.chords(chain, i))
            .collect();
        let around = |chords: &Vec<Point>| {
            let first = Rect::from_points(chords[0], chords[0]);
            chords.iter().fold(first, |r, p| r.union_pt(*p))
        };
        let bounds: Vec<Rect> = chords.iter().map(around).collect();
        let mut last = 0;
        let feet = self.anchors.iter().map(|a| {
            let foot = foot(self.to_own * a.at, (&chords, &bounds), last);
            last = foot.0;
            foot
        });
        let feet = feet.collect();
        self.with(chain, chords, feet)
    }

    /// Moves what is free of the chain to the least squares. Given up as soon as `enough` is out of reach.
    pub(super) fn fit(&self, chain: &mut Chain, enough: f64) -> Drawn {
        chain.settle();
        let numbers = numbers(chain);
        let mut now = self.drawn(chain);
        let mut lambda = 1e-3;
        let mut normal = None;
        let noise = self.grain * self.pixels();
        for _ in 0..STEPS {
            let equations = normal.get_or_insert_with(|| Normal::new(self, chain, &numbers, &now));
            let Some(mut step) = equations.step(lambda) else {
                break;
            };
            shorten(chain, &numbers, &mut step);
            let mut trial = chain.clone();
            for (number, by) in numbers.iter().zip(&step) {
                nudge(&mut trial, *number, *by);
            }
            trial.settle();
            let chords = (0..trial.kinds.len()).map(|i| self.chords(&trial, i));
            let new = self.with(&trial, chords.collect(), self.slid(&trial, &now.feet));
            let gain = now.sum - new.sum;
            if gain > 0.0 {
                (*chain, now, normal) = (trial, new, None);
                lambda = (lambda * 0.2_f64).max(1e-6);
                if gain < (PROGRESS * (now.sum - noise)).max(LITTLE)
                    || now.squares - HOPE * gain > enough
                {
                    break;
                }
            } else {
                lambda *= 10.0;
                if lambda > 1e4 {
                    break;
                }
            }
        }
        now
    }

    fn with(&self, chain: &Chain, chords: Vec<Vec<Point>>, feet: Vec<(usize, f64)>) -> Drawn {
        let mut fill = Coverage::new(self.columns.len(), self.rows.len());
        chords.iter().for_each(|c| fill.line(c));
        let mut left = self.blurred(&fill);
        let pairs = left.iter_mut().zip(&self.still);
        pairs.for_each(|(left, still)| *left = still - *left);
        let past = self.anchors.iter().zip(&feet);
        left.extend(past.map(|(a, f)| single(a.passed(&chain.cubic(f.0), f.1))));
        let squares = dot(&left, &left);
        for i in 0..chain.kinds.len() {
            left.extend(self.handles(chain, i).map(single));
        }
        let sum = dot(&left, &left);
        Drawn {
            chords,
            feet,
            left,
            sum,
            squares,
        }
    }

    /// Columns and rows of the pixels that count.
    fn inner(&self) -> (Range<usize>, Range<usize>) {
        let m = self.margin;
        let inner =
            |all: &Range<usize>| all.start + m..all.end.saturating_sub(m).max(all.start + m);
        (inner(&self.columns), inner(&self.rows))
    }

    /// How unlike drawn ones the handles of a segment are.
    fn handles(&self, chain: &Chain, segment: usize) -> [f64; 4] {
        if chain.kinds[segment] == Kind::Line {
            return [0.0; 4];
        }
        let (a, b) = chain.ends(segment);
        let (a, b) = (&chain.nodes[a], &chain.nodes[b]);
        let chord = a.point.distance(b.point).max(0.1);
        let (usual, spread) = HANDLE;
        let prior = (PRIOR_GRAIN * self.grain).sqrt();
        let [ahead, back] =
            [a.ahead, b.back].map(|handle| prior * (handle / chord - usual) / spread);
        let [first, last] = past_levels(chain, segment);
        [ahead, back, first * a.ahead * PAST, last * b.back * PAST]
    }

    /// A segment as chords, evenly in its parameter, in the window's own space.
    fn chords(&self, chain: &Chain, segment: usize) -> Vec<Point> {
        let c = chain.cubic(segment);
        let bend = (c.p0 - c.p1 + (c.p2 - c.p1)).hypot2();
        let bend = bend.max((c.p1 - c.p2 + (c.p3 - c.p2)).hypot2()).sqrt();
        // 6 bend is the largest second derivative, and chords of step h leave a curve by an eighth of h² of it
        let count = match chain.kinds[segment] {
            Kind::Line => 1,
            Kind::Cubic => {
                index((6.0 * bend / (8.0 * CHORD_PX)).sqrt().ceil()).clamp(1, MOST_CHORDS)
            }
        };
        let at = |k: usize| self.to_own * c.eval(k as f64 / count as f64);
        (0..=count).map(at).collect()
    }

    /// The feet of the anchors after a step.
    fn slid(&self, chain: &Chain, feet: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let slid = |(a, &(i, t)): (&Anchor, &(usize, f64))| {
            let c = chain.cubic(i);
            let (off, d) = (c.eval(t) - a.at, c.deriv().eval(t).to_vec2());
            let t = t - off.dot(d) / d.hypot2().max(1e-12);
            (i, t.clamp(0.0, 1.0))
        };
        self.anchors.iter().zip(feet).map(slid).collect()
    }

    /// Of the pixels that count.
    fn blurred(&self, fill: &Coverage) -> Vec<f32> {
        let mut model = fill.samples();
        blur(&mut model, fill.width(), self.lens, self.margin);
        model
    }

    /// Whether a place counts with its pixels.
    fn holds(&self, p: Point) -> bool {
        let q = self.to_own * p;
        let m = self.margin as f64;
        (m..=self.columns.len() as f64 - m).contains(&q.x)
            && (m..=self.rows.len() as f64 - m).contains(&q.y)
    }

    /// Holds a chain beyond the window where the picture has the edge; near an end or another edge, where the picture
    /// tells of more than that, where it runs.
    fn drop_anchors(&mut self, residual: &Residual<'_>, chain: &Chain) {
        let blur = self.lens.hypot(Contour::PIXEL_BLUR_PX);
        for i in 0..chain.kinds.len() {
            let c = chain.cubic(i);
            let length = polygon_px(&c);
            let count = index((length / STEP_PX.max(length / MOST_ANCHORS)).ceil());
            // an edge that moves by d changes the squares of each px along it by d² of this
            let weight = (length / (count as f64) / (2.0 * PI.sqrt() * blur)).sqrt();
            for k in 0..count {
                let t = (k as f64 + 0.5) / count as f64;
                let (at, along) = (c.eval(t), c.deriv().eval(t).to_vec2());
                if self.holds(at) || along.hypot() <= 1e-9 {
                    continue;
                }
                let outward = Vec2::new(along.y, -along.x) / along.hypot();
                let room = at.distance(c.p0).min(at.distance(c.p3));
                let alone = room > residual.reach_px() && residual.is_alone(at, outward);
                let shift = if alone {
                    residual.shift(at).clamp(-SHIFT_PX, SHIFT_PX)
                } else {
                    0.0
                };
                self.anchors.push(Anchor {
                    at: at + shift * outward,
                    outward,
                    weight,
                });
            }
        }
    }
}

/// Pixels at each side of a window that only lend their light, and all from its middle to its side.
fn margins(lens: f64, reach: f64) -> (usize, usize) {
    let margin = index((3.5 * lens).ceil());
    (margin, index(reach.ceil()) + margin)
}

impl Anchor {
    /// How far beyond it a curve runs, weighed.
    fn passed(&self, c: &CubicBez, t: f64) -> f64 {
        self.weight * (c.eval(t) - self.at).dot(self.outward)
    }
}

/// Segment and parameter of the place on chords that is nearest to a point; each segment's chords lie within their
/// bounds, and the one that is looked at `first` is likely to hold it.
fn foot(at: Point, (chords, bounds): (&[Vec<Point>], &[Rect]), first: usize) -> (usize, f64) {
    let mut nearest = (f64::INFINITY, (first, 0.0));
    for i in (first..chords.len()).chain(0..first) {
        let (chords, around) = (&chords[i], bounds[i]);
        let inside = Point::new(
            at.x.max(around.x0).min(around.x1),
            at.y.max(around.y0).min(around.y1),
        );
        if inside.distance_squared(at) > nearest.0 {
            continue;
        }
        let count = (chords.len() - 1) as f64;
        for (k, (a, b)) in chords.iter().zip(chords.iter().skip(1)).enumerate() {
            let (d, to) = (*b - *a, at - *a);
            let t = (to.dot(d) / d.hypot2().max(1e-12)).clamp(0.0, 1.0);
            let off = (t * d - to).hypot2();
            if off < nearest.0 {
                nearest = (off, (i, (k as f64 + t) / count));
            }
        }
    }
    nearest.1
}

/// Sum of products, in lanes that add up side by side.
fn dot(a: &[f32], b: &[f32]) -> f64 {
    const LANES: usize = 16;
    let (mut sums, (a, b)) = (
        [0.0_f32; LANES],
        (a.chunks_exact(LANES), b.chunks_exact(LANES)),
    );
    let rest = a.remainder().iter().zip(b.remainder());
    let rest: f64 = rest.map(|(x, y)| f64::from(x * y)).sum();
    for (a, b) in a.zip(b) {
        let pairs = a.iter().zip(b);
        sums.iter_mut()
            .zip(pairs)
            .for_each(|(s, (x, y))| *s += x * y);
    }
    rest + sums.iter().map(|s| f64::from(*s)).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{
        refine::{curves::polygon, mend::part::open_part},
        types::Gray,
    };
    use kurbo::BezPath;
    use std::iter::once;

    #[test]
    fn what_lies_beyond_a_window_is_held_where_the_picture_has_it() {
        // a long edge that swells by a third of a pixel, of which the window shows the middle
        let slab = |y: f64| {
            let text =
                format!("M110 40.2C93 40.2 77 {y} 60 {y}C43 {y} 27 40.2 10 40.2L10 10.2L110 10.2Z");
            BezPath::from_svg(&text).unwrap()
        };
        let (drawn, path) = (slab(40.2), slab(40.5));
        let at = Point::new(60.0, 40.2);
        for lens in [0.0, 0.9] {
            let mut fill = Coverage::new(120, 50);
            fill.add(&polygon(&drawn, 0.001));
            let mut samples = fill.samples();
            blur(&mut samples, 120, lens, 0);
            let gray = Gray::new(120, 50, samples).unwrap();
            let ring = polygon(&path, 0.001);
            let blur = Contour::PIXEL_BLUR_PX.hypot(lens);
            let residual = Residual::new(&gray, once(ring.as_slice()), blur);
            let chain = Chain::from_path(&path, 0.0175).unwrap();
            let mut part = open_part(&chain, 2);
            let rest = polygon(&chain.part(2..chain.kinds.len()).to_path(), 0.001);
            let window = Window::new(&residual, (at, 8.0), once(rest.as_slice()), &part, 1e-4);
            window.fit(&mut part, f64::INFINITY);
            let bulge = polygon(&part.to_path(), 0.001);
            let bulge = bulge.iter().map(|p| (p.y - 40.2).abs()).fold(0.0, f64::max);
            assert!(bulge < 0.05, "lens {lens}: {bulge}");
        }
    }
}
