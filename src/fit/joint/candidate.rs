//! Where a node may lie: extrema, changes of bend, ends of straight runs, and an even fill.

use super::samples::Samples;
use crate::numeric::chain::Join;
use kurbo::Vec2;

/// A place for a node.
#[derive(Debug, Clone, Copy)]
pub(super) struct Candidate {
    /// Index of the sample; in a ring it may exceed the number of samples.
    pub(super) index: usize,
    /// What the node would hold.
    pub(super) join: Join,
    /// Direction there.
    pub(super) heading: Vec2,
}

/// Longest stretch without a candidate, steps, where the curve turns little.
const FILL: f64 = 24.0;
/// Largest turn without a candidate, radians.
const FILL_TURN: f64 = 0.35;
/// Two candidates lie at least so far apart, steps.
const APART: usize = 3;

/// Candidates in order. Of an open span both ends are the first and last; of a ring the last is the
/// first again, one turn later.
pub(super) fn candidates(s: &Samples) -> Vec<Candidate> {
    let n = s.len();
    let mut marks = extrema(s);
    let jumps = jumps(s);
    let apart = APART;
    let near = |marks: &[Candidate], k: usize| {
        marks.iter().any(|m| {
            let d = m.index.abs_diff(k);
            d < apart || (s.ring && n - d < apart)
        })
    };
    let smooth = |k: usize| Candidate {
        index: k,
        join: Join::Smooth,
        heading: s.heading[k],
    };
    for k in jumps {
        if !near(&marks, k) {
            marks.push(smooth(k));
        }
    }
    if !s.ring {
        let told = |i: usize| s.weight.get(i).is_some_and(|w| *w >= 1.0);
        marks.retain(|m| m.index >= apart && m.index + apart < n && told(m.index));
        for k in [0, n - 1] {
            let join = Join::End;
            marks.push(Candidate { join, ..smooth(k) });
        }
    }
    if marks.is_empty() {
        marks.extend((0..4).map(|i| smooth(i * n / 4)));
    }
    marks.sort_by_key(|m| m.index);
    if s.ring {
        let start = start_of_ring(s, &marks);
        let Some(start) = start else {
            return marks;
        };
        marks.rotate_left(start);
        let first = marks[0].index;
        for m in &mut marks {
            if m.index < first {
                m.index += n;
            }
        }
        let again = Candidate {
            index: first + n,
            ..marks[0]
        };
        marks.push(again);
    }
    fill(s, &marks)
}

/// The extremum that bends most: surely a node.
fn start_of_ring(s: &Samples, marks: &[Candidate]) -> Option<usize> {
    let bend = |i: &usize| s.bend[marks[*i].index].abs();
    let of = |join: fn(Join) -> bool| {
        (0..marks.len())
            .filter(|&i| join(marks[i].join))
            .max_by(|a, b| bend(a).total_cmp(&bend(b)))
    };
    of(|j| j != Join::Smooth).or_else(|| of(|_| true))
}

/// Places where the direction crosses an axis. Crossings to and fro within the reach of the noise count once if
/// they are odd in number, and not at all if even.
fn extrema(s: &Samples) -> Vec<Candidate> {
    let n = s.len();
    let last = if s.ring { n } else { n.saturating_sub(1) };
    let mut out: Vec<Candidate> = Vec::new();
    for (join, part) in [
        (Join::Vertical, (|v: Vec2| v.x) as fn(Vec2) -> f64),
        (Join::Horizontal, |v: Vec2| v.y),
    ] {
        let crossings: Vec<usize> = (0..last)
            .filter(|&k| {
                let (a, b) = (part(s.heading[k]), part(s.heading[(k + 1) % n]));
                (a < 0.0) != (b < 0.0)
            })
            .collect();
        for group in crossings.chunk_by(|a, b| b - a <= 2 * s.reach) {
            if group.len() % 2 == 1 {
                let k = group[group.len() / 2];
                let (a, b) = (part(s.heading[k]).abs(), part(s.heading[(k + 1) % n]).abs());
                let index = if b < a { (k + 1) % n } else { k };
                let h = s.heading[index];
                let heading = match join {
                    Join::Vertical => Vec2::new(0.0, 1f64.copysign(h.y)),
                    _ => Vec2::new(1f64.copysign(h.x), 0.0),
                };
                out.push(Candidate {
                    index,
                    join,
                    heading,
                });
            }
        }
    }
    out
}

/// Places where the parabolas on either side bend most differently.
fn jumps(s: &Samples) -> Vec<usize> {
    let n = s.len();
    let reach = s.reach + 2;
    let bend = |v: [Vec2; 3]| {
        let speed = v[1].hypot().max(1e-12);
        v[1].cross(v[2]) / (speed * speed * speed)
    };
    let inside = |k: usize| s.ring || (k >= 3 && k + 3 < n);
    let jump: Vec<f64> = (0..n)
        .map(|k| {
            if inside(k) {
                (bend(s.parabola(k, 0, reach)) - bend(s.parabola(k, reach, 0))).abs()
            } else {
                0.0
            }
        })
        .collect();
    // The bend of a parabola through m samples has the deviation 27 σ / m^2.5.
    let floor =
        27.0 * s.sigma.max(0.01 * s.step) / (libm::pow(reach as f64, 2.5) * s.step * s.step);
    let near = s.reach;
    let mut out: Vec<usize> = (0..n)
        .filter(|&k| {
            jump[k] > floor
                && (1..=near).all(|d| {
                    let behind = if s.ring {
                        jump[(k + n - d % n) % n]
                    } else {
                        k.checked_sub(d).map_or(0.0, |j| jump[j])
                    };
                    let ahead = if s.ring {
                        jump[(k + d) % n]
                    } else {
                        jump.get(k + d).copied().unwrap_or(0.0)
                    };
                    behind < jump[k] && ahead <= jump[k]
                })
        })
        .collect();
    out.sort_by(|&a, &b| jump[b].total_cmp(&jump[a]));
    out
}

/// Puts evenly spaced candidates between those that lie far apart.
fn fill(s: &Samples, marks: &[Candidate]) -> Vec<Candidate> {
    let n = s.len();
    let mut out = Vec::with_capacity(marks.len() * 3);
    for pair in marks.windows(2) {
        let (a, b) = (pair[0].index, pair[1].index);
        out.push(pair[0]);
        let turn: f64 = (a..b).map(|k| s.bend[k % n].abs() * s.step).sum();
        let length = (b - a) as f64;
        let want = (length / FILL)
            .max(turn / FILL_TURN)
            .min(length / ((2 * APART) as f64));
        let parts = (1..64).find(|&p| p as f64 + 0.5 >= want).unwrap_or(64);
        for p in 1..parts {
            let index = a + (b - a) * p / parts;
            out.push(Candidate {
                index,
                join: Join::Smooth,
                heading: s.heading[index % n],
            });
        }
    }
    out.extend(marks.last());
    out
}
