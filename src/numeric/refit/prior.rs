//! What a chain costs by itself: places, handles and overshoots that no sample decides.

use super::Block;
use crate::numeric::chain::{Chain, Join, Kind};
use kurbo::{Point, Vec2};

/// Handles of drawn curves are about this part of the chord; a quarter of a circle has 0.39.
const HANDLE: f64 = 0.37;
/// How far handles stray from [`HANDLE`], in chords. Wide: it only decides what the samples leave open.
const HANDLE_SPREAD: f64 = 0.4;

/// A handle longer than this, in chords, makes the curve run past its end where no sample holds it.
const LONGEST: f64 = 1.0;
/// How soon that is felt, in chords.
const LONGEST_SPREAD: f64 = 0.05;
/// A handle shorter than this, in chords, leaves its direction to the other one: the join is no longer smooth.
const SHORTEST: f64 = 0.06;
/// How soon that is felt, in chords.
const SHORTEST_SPREAD: f64 = 0.02;
/// A handle passes the level of the extremum that its curve ends in by this part of a sample's deviation.
const OVERSHOOT: f64 = 0.25;

/// Cost of a node's way from where it was.
pub(super) fn anchor(at: Point, (anchor, tight): (Point, f64), block: &mut Block) -> f64 {
    let d = at - anchor;
    block.gradient[0] += d.x * tight;
    block.gradient[1] += d.y * tight;
    block.hessian[0][0] += tight;
    block.hessian[1][1] += tight;
    0.5 * tight * d.hypot2()
}

/// Cost of a cubic's handles by themselves, and its rows.
pub(super) fn handles(chain: &Chain, segment: usize, block: &mut Block) -> f64 {
    if chain.kinds[segment] == Kind::Line {
        return 0.0;
    }
    let (a, b) = chain.ends(segment);
    let (a, b) = (&chain.nodes[a], &chain.nodes[b]);
    let chord = a.point.distance(b.point).max(1e-9);
    let mut cost = 0.0;
    for (k, handle) in [(3, a.ahead), (4, b.back)] {
        let off = (handle / chord - HANDLE) / HANDLE_SPREAD;
        let slope = 1.0 / (chord * HANDLE_SPREAD);
        cost += 0.5 * off * off;
        block.gradient[k] += off * slope;
        block.hessian[k][k] += slope * slope;
        for (over, spread) in [
            ((handle / chord - LONGEST).max(0.0), LONGEST_SPREAD),
            ((handle / chord - SHORTEST).min(0.0), SHORTEST_SPREAD),
        ] {
            if over.abs() > 0.0 {
                let (over, slope) = (over / spread, 1.0 / (chord * spread));
                cost += 0.5 * over * over;
                block.gradient[k] += over * slope;
                block.hessian[k][k] += slope * slope;
            }
        }
    }
    cost
}

/// Cost of handles that pass the level of the extremum at the other end of their cubic: the curve would turn
/// back twice.
pub(super) fn levels(chain: &Chain, segment: usize, sigma: f64, block: &mut Block) -> f64 {
    if chain.kinds[segment] == Kind::Line {
        return 0.0;
    }
    let (a, b) = chain.ends(segment);
    let (a, b) = (&chain.nodes[a], &chain.nodes[b]);
    let mut cost = 0.0;
    // the axis across the extremum, and where the numbers along it stand in a block's rows
    for (join, axis, place) in [
        (Join::Horizontal, Vec2::new(0.0, 1.0), 1),
        (Join::Vertical, Vec2::new(1.0, 0.0), 0),
    ] {
        let side = (b.point - a.point).dot(axis).signum();
        let turned = |d: Vec2| d.turn_90().dot(axis);
        let mut row = [0.0; 8];
        if b.join == join && a.join != join {
            // side · (b − (a + ahead · leave)) ≥ 0
            let off = side * (b.point - a.point - a.ahead * a.leave).dot(axis);
            row[place] = -side;
            row[2] = -side * a.ahead * turned(a.leave);
            row[3] = -side * a.leave.dot(axis);
            row[6 + place] = side;
            cost += short(off, row, OVERSHOOT * sigma, block);
        }
        if a.join == join && b.join != join {
            // side · ((b − back · arrive) − a) ≥ 0
            let off = side * (b.point - a.point - b.back * b.arrive).dot(axis);
            row = [0.0; 8];
            row[place] = -side;
            row[4] = -side * b.arrive.dot(axis);
            row[5] = -side * b.back * turned(b.arrive);
            row[6 + place] = side;
            cost += short(off, row, OVERSHOOT * sigma, block);
        }
    }
    cost
}

/// Cost of a number that should not be below 0, with its row.
fn short(off: f64, row: [f64; 8], spread: f64, block: &mut Block) -> f64 {
    if off >= 0.0 {
        return 0.0;
    }
    let weight = 1.0 / (spread * spread);
    for (k, rk) in row.iter().enumerate() {
        block.gradient[k] += weight * rk * off;
        for (h, rl) in block.hessian[k].iter_mut().zip(&row[..=k]) {
            *h += weight * rk * rl;
        }
    }
    0.5 * weight * off * off
}
