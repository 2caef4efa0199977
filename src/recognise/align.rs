//! Two skeletons laid over each other by the best affine map, and how far apart they stay.
//!
//! Source   [chamfer77 sec. 2]: the mean distance from each point of one picture's lines to the nearest of the other's
//! Solves   min over affine A of Σ ρ(dist(A aᵢ, b)) / n + Σ ρ(dist(bⱼ, A a)) / m + stiffness ‖A − I‖²,
//! dist² = |p − q|² + TURN |e^{2iα} − e^{2iβ}|² with α, β the lines' directions, ρ(d²) = d² REACH / (d² + REACH)
//! Takes    two sets of [`Spot`]s, each normalised to its own frame, −1…1
//! Gives    the least value found, 0 for equal sets, at most about 2 REACH
//! Departs  both ways and not one; directions count; far points cost no more than REACH, so a serif the other
//! lacks costs its length and does not pull the letter askew; the map is found by reweighted least squares
//! over nearest pairs
//! Cost     ROUNDS · 2 n m distances      Fails  never

use super::affine::{Map, STAY, Sums};

/// A point of a letter's lines.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spot {
    /// In the letter's frame, −1…1.
    pub(crate) x: f32,
    /// In the letter's frame, −1…1, down.
    pub(crate) y: f32,
    /// Cosine of twice the line's direction; both 0 where there is none.
    pub(crate) c: f32,
    /// Sine of twice the line's direction.
    pub(crate) s: f32,
}

/// Weight of directions against places: a right angle counts as 0.77 of half a letter.
const TURN: f32 = 0.15;
/// Squared distance at which a point counts half of what it would, half letters².
const REACH: f32 = 0.12;
/// How often pairs are looked for again.
const ROUNDS: usize = 4;
/// Pull towards leaving the letter as it is: of the matrix, and of the shift.
const STIFF: (f32, f32) = (0.09, 0.03);
/// Price of a unit of squared change.
const CHANGE: f32 = 0.012;

/// How unlike two letters' lines are, the best affine map between them taken off.
pub(crate) fn distance(a: &[Spot], b: &[Spot]) -> f32 {
    if a.is_empty() || b.is_empty() {
        return if a.len() == b.len() { 0.0 } else { 2.0 * REACH };
    }
    let mut map = STAY;
    let mut best = f32::MAX;
    for round in 0..=ROUNDS {
        let moved: Vec<Spot> = a.iter().map(|p| apply(&map, *p)).collect();
        let (there, back) = (nearest(&moved, b), nearest(b, &moved));
        best = best.min(mean_cost(&there) + mean_cost(&back) + CHANGE * change(&map));
        if round < ROUNDS {
            map = estimate(a, b, &there, &back);
        }
    }
    best
}

/// For each of `a` the squared distance to the nearest of `b`, and which that is.
fn nearest(a: &[Spot], b: &[Spot]) -> Vec<(f32, usize)> {
    let to = |p: &Spot| {
        let mut best = (f32::MAX, 0);
        for (j, q) in b.iter().enumerate() {
            let (dx, dy, dc, ds) = (p.x - q.x, p.y - q.y, p.c - q.c, p.s - q.s);
            let d = dx * dx + dy * dy + TURN * (dc * dc + ds * ds);
            if d < best.0 {
                best = (d, j);
            }
        }
        best
    };
    a.iter().map(to).collect()
}

fn mean_cost(pairs: &[(f32, usize)]) -> f32 {
    let sum: f32 = pairs.iter().map(|(d, _)| d * REACH / (d + REACH)).sum();
    sum / pairs.len() as f32
}

/// Squared change by a map, a shift counting half.
fn change(m: &Map) -> f32 {
    let matrix = (m[0] - 1.0).powi(2) + m[1].powi(2) + m[3].powi(2) + (m[4] - 1.0).powi(2);
    matrix + 0.5 * (m[2] * m[2] + m[5] * m[5])
}

fn apply(m: &Map, p: Spot) -> Spot {
    let straight = p.c.hypot(p.s);
    let (sin, cos) = libm::sincosf(0.5 * libm::atan2f(p.s, p.c));
    let (u, v) = (m[0] * cos + m[1] * sin, m[3] * cos + m[4] * sin);
    let scale = straight / (u * u + v * v).max(1e-9);
    Spot {
        x: m[0] * p.x + m[1] * p.y + m[2],
        y: m[3] * p.x + m[4] * p.y + m[5],
        c: scale * (u * u - v * v),
        s: scale * 2.0 * u * v,
    }
}

/// Weighted least squares over the pairs of both ways.
fn estimate(a: &[Spot], b: &[Spot], there: &[(f32, usize)], back: &[(f32, usize)]) -> Map {
    let mut sums = Sums::default();
    let mut add = |p: &Spot, q: &Spot, d: f32, n: usize| {
        let weight = (REACH / (d + REACH)).powi(2) / n as f32;
        sums.add([p.x, p.y], [q.x, q.y], weight);
    };
    for (p, &(d, j)) in a.iter().zip(there) {
        add(p, &b[j], d, a.len());
    }
    for (q, &(d, i)) in b.iter().zip(back) {
        add(&a[i], q, d, b.len());
    }
    sums.map(STIFF)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Spots along an arc of `turn` radians, mapped by `map`.
    fn arc(turn: f32, map: &Map) -> Vec<Spot> {
        let spot = |i: usize| {
            let (s, c) = libm::sincosf(turn * i as f32 / 39.0);
            let (s2, c2) = (2.0 * s * c, c * c - s * s);
            // the tangent stands at a right angle to the radius: twice the angle has the opposite sign
            apply(
                map,
                Spot {
                    x: c,
                    y: s,
                    c: -c2,
                    s: -s2,
                },
            )
        };
        (0..40).map(spot).collect()
    }

    #[test]
    fn equal_is_zero_and_affine_images_are_near() {
        let a = arc(4.0, &STAY);
        let slanted = arc(4.0, &[1.1, 0.25, 0.05, 0.0, 0.9, -0.05]);
        let other = arc(2.0, &STAY);
        assert!(distance(&a, &a) < 1e-9);
        let (near, far) = (distance(&slanted, &a), distance(&other, &a));
        assert!(near < 0.01 && 2.0 * near < far, "{near} against {far}");
    }

    #[test]
    fn nothing_is_answered() {
        let a = arc(3.0, &STAY);
        assert!(distance(&[], &[]) < 1e-9);
        assert!(distance(&a, &[]) > 0.1 && distance(&[], &a[..1]) > 0.1);
        assert!(distance(&a[..1], &a).is_finite());
    }
}
