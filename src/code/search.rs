//! Algorithm 1: the cheapest vertices by shortest path over pairs of them.

use super::band::{Band, near};
use super::{Bounds, CodeError, Coded, Kind, RUN, bits, distortion};
use crate::numeric::shortest::{Id, Labels};
use kurbo::Point;

/// The vertex before and the vertex itself.
#[derive(Debug, Clone, Copy)]
struct Pair {
    before: (i32, i32),
    at: (i32, i32),
    /// The step that led here; none at the start.
    step: Option<(i32, i32)>,
}

/// Points on each piece of curve that the search measures.
const LOOK: u32 = 8;

/// Boundary points before a stage among which the piece that leaves it lies: its curve begins half a run back.
const BACK: usize = 4 * RUN as usize;

/// Boundary points that a step may pass: a longer way round lies farther from it than any bound.
const AHEAD: usize = 8 * RUN as usize;

/// Points on each piece of the answer: dense enough that their distances are the curve's.
const DENSE: u32 = 64;

/// The eight directions.
const AROUND: [(i32, i32); 8] = [
    (1, 0),
    (1, 1),
    (0, 1),
    (-1, 1),
    (-1, 0),
    (-1, -1),
    (0, -1),
    (1, -1),
];

struct Coder<'a> {
    boundary: &'a [Point],
    band: Band,
    kind: Kind,
}

/// The vertices of least bits whose curve stays within the bounds of a closed boundary (whole px, the
/// first point not repeated). The curve begins and ends on the first point, as Algorithm 1's does.
///
/// # Errors
/// The boundary is too short, the bounds are out of order, or no vertices meet them.
pub fn encode(boundary: &[Point], kind: Kind, bounds: Bounds) -> Result<Coded, CodeError> {
    /// Fewer points enclose nothing worth a curve.
    const FEW: usize = 8;
    if boundary.len() < FEW {
        return Err(CodeError::Short(boundary.len()));
    }
    if !(bounds.t_min > 0.0 && bounds.t_min <= bounds.t_max && bounds.t_max.is_finite()) {
        return Err(CodeError::Bounds(bounds.t_max, bounds.t_min));
    }
    let coder = Coder {
        boundary,
        band: Band::new(boundary, bounds, kind),
        kind,
    };
    let start = (near(boundary[0].x), near(boundary[0].y));
    let n = boundary.len();
    // Stage n is the first point again, after one turn around.
    let mut labels: Labels<Pair> = Labels::new(n + 1);
    labels.offer(
        (0, 0),
        0,
        None,
        Pair {
            before: start,
            at: start,
            step: None,
        },
    );
    for stage in 0..n {
        for id in labels.at(stage) {
            coder.expand(&mut labels, stage, id, start);
        }
    }
    let end = labels.cheapest(n).ok_or(CodeError::Unreachable)?;
    let vertices: Vec<Point> = labels.path(end).iter().map(|p| point(p.at)).collect();
    let curve = coder.curve(&vertices);
    let (d_max, d_ms) = distortion(boundary, &curve);
    Ok(Coded {
        vertices,
        bits: labels.cost(end),
        curve,
        d_max,
        d_ms,
    })
}

impl Coder<'_> {
    fn expand(&self, labels: &mut Labels<Pair>, stage: usize, id: Id, start: (i32, i32)) {
        let pair = *labels.item(id);
        let n = self.boundary.len();
        for (dx, dy) in AROUND {
            for run in 1..=RUN {
                let step = (dx * run, dy * run);
                let at = (pair.at.0 + step.0, pair.at.1 + step.1);
                let Some(&i) = self.band.index.get(&at) else {
                    continue;
                };
                // The first point closes the turn; other vertices near it belong to its end there.
                let to = if at == start {
                    n
                } else if i == 0 || i + n / 2 < stage {
                    continue;
                } else {
                    i
                };
                if to <= stage || to > stage + (4 * n / 10).min(AHEAD) {
                    continue;
                }
                let Some(rate) = bits(pair.step, step) else {
                    continue;
                };
                let cost = labels.cost(id) + rate;
                let place = (to, key(step));
                // The key says the vertex before: with the place it is the pair that Algorithm 1 keeps.
                let place = (place.0, place.1 | pack(at, self.boundary[i]) << 9);
                if labels.wants(place, cost) && self.fits(pair, at, (stage, to)) {
                    labels.offer(
                        place,
                        cost,
                        Some(id),
                        Pair {
                            before: pair.at,
                            at,
                            step: Some(step),
                        },
                    );
                }
            }
        }
    }

    /// Whether the piece that ends with `at` stays within T of the boundary it passes, both ways.
    fn fits(&self, pair: Pair, at: (i32, i32), (from, to): (usize, usize)) -> bool {
        let n = self.boundary.len();
        let (p, q, r) = (point(pair.before), point(pair.at), point(at));
        let pieces: Vec<Point> = match self.kind {
            Kind::Polygon => (0..=LOOK)
                .map(|k| q.lerp(r, f64::from(k) / f64::from(LOOK)))
                .collect(),
            Kind::Spline(_) if to == n => {
                [self.dots([p, q, r], LOOK), self.dots([q, r, r], LOOK)].concat()
            }
            Kind::Spline(_) => self.dots([p, q, r], LOOK),
        };
        // Up to the stage the piece before has been looked at: what it left is looked at here.
        let start = pieces.first().copied().unwrap_or(q);
        let back = from.saturating_sub((n / 4).min(BACK));
        let first = self.nearest(start, back, from);
        let last = self.nearest(pieces.last().copied().unwrap_or(r), from, to);
        let within = |d: f64, i: usize| d <= self.band.admissible[i % n] + 1e-9;
        let forth = pieces.iter().all(|c| {
            let i = self.nearest(*c, back, to);
            within(self.boundary[i % n].distance(*c), i)
        });
        forth && (first..=last).all(|i| within(to_polyline(self.boundary[i % n], &pieces), i))
    }

    /// Dense points of the piece of three vertices, which runs from mid-edge to mid-edge.
    fn dots(&self, [p, q, r]: [Point; 3], parts: u32) -> Vec<Point> {
        let Kind::Spline(pull) = self.kind else {
            return vec![q, r];
        };
        let (a, c) = (p.midpoint(q), q.midpoint(r));
        let dot = |k: u32| {
            let [x, y, z] = pull.quadratic(f64::from(k) / f64::from(parts));
            (a.to_vec2() * x + q.to_vec2() * y + c.to_vec2() * z).to_point()
        };
        (0..=parts).map(dot).collect()
    }

    fn nearest(&self, p: Point, from: usize, to: usize) -> usize {
        let n = self.boundary.len();
        let d = |i: &usize| self.boundary[i % n].distance_squared(p);
        (from..=to)
            .min_by(|a, b| d(a).total_cmp(&d(b)))
            .unwrap_or(from)
    }

    /// The whole curve, first and last vertex doubled.
    fn curve(&self, vertices: &[Point]) -> Vec<Point> {
        if self.kind == Kind::Polygon {
            let edge = |w: &[Point]| {
                (0..DENSE)
                    .map(|k| w[0].lerp(w[1], f64::from(k) / f64::from(DENSE)))
                    .collect::<Vec<_>>()
            };
            return vertices.windows(2).flat_map(edge).collect();
        }
        let (first, last) = (vertices.first().copied(), vertices.last().copied());
        let all: Vec<Point> = first
            .into_iter()
            .chain(vertices.iter().copied())
            .chain(last)
            .collect();
        all.windows(3)
            .flat_map(|w| self.dots([w[0], w[1], w[2]], DENSE))
            .collect()
    }
}

fn to_polyline(p: Point, line: &[Point]) -> f64 {
    let edges = line.windows(2).map(|w| {
        let v = w[1] - w[0];
        let u = ((p - w[0]).dot(v) / v.hypot2().max(1e-12)).clamp(0.0, 1.0);
        (w[0] + v * u).distance_squared(p)
    });
    edges.fold(f64::INFINITY, f64::min).sqrt()
}

fn point((x, y): (i32, i32)) -> Point {
    Point::new(f64::from(x), f64::from(y))
}

/// A step as a number below 512.
fn key((dx, dy): (i32, i32)) -> u64 {
    let shift = |v: i32| u64::try_from(v + RUN).unwrap_or(0);
    // Of a step along one of 8 directions, direction and run say all.
    let number = AROUND
        .iter()
        .position(|&(x, y)| (x, y) == (dx.signum(), dy.signum()))
        .unwrap_or(0);
    number as u64 * 31 + shift(dx.abs().max(dy.abs()))
}

/// A vertex as a number, beside the boundary point it belongs to.
fn pack((x, y): (i32, i32), b: Point) -> u64 {
    let side = |v: i32, o: f64| u64::try_from(v - near(o) + 64).unwrap_or(0) & 127;
    side(x, b.x) << 7 | side(y, b.y)
}
