//! What no outline may look like, however well it explains a picture.

use super::tips::is_needle;
use crate::numeric::angles::angle;
use crate::numeric::chain::Chain;
use kurbo::{ParamCurve, Vec2};

/// A smooth node does not turn by more than this, radians, in such a part of both its curves.
const HIDDEN: f64 = 1.2;
const BESIDE: f64 = 0.3;
/// A curve leaves its chord by no more than this, radians; each of its handles reaches no further along it than so
/// many of the chord, and both together are no longer than so many.
const HOOK: f64 = 1.75;
const PAST: f64 = 1.1;
const LONG: f64 = 2.0;
/// No segment is shorter, px.
const SHORT_PX: f64 = 0.25;

/// Whether an outline may look like that: no curve hooks back, no corner turns back.
pub(super) fn is_fair(chain: &Chain) -> bool {
    let open = |i: usize| {
        if chain.nodes[i].join.is_smooth() {
            turn(chain, i) < HIDDEN
        } else {
            !is_needle(chain, i)
        }
    };
    (1..chain.kinds.len()).all(open) && (0..chain.kinds.len()).all(|i| runs_on(chain, i))
}

/// By how much a chain turns around a node, radians: handles may be too short to show.
fn turn(chain: &Chain, i: usize) -> f64 {
    let Some((before, after)) = chain.before(i).zip(chain.after(i)) else {
        return 0.0;
    };
    let (before, after) = (chain.cubic(before), chain.cubic(after));
    let p = chain.nodes[i].point;
    let (u, v) = (p - before.eval(1.0 - BESIDE), after.eval(BESIDE) - p);
    angle(u, v).abs()
}

/// Whether a segment goes from its start to its end without hooks.
fn runs_on(chain: &Chain, i: usize) -> bool {
    let c = chain.cubic(i);
    let chord = c.p3 - c.p0;
    let off = |v: Vec2| angle(v, chord).abs();
    let (start, end) = (c.p1 - c.p0, c.p3 - c.p2);
    let within = |v: Vec2| off(v) < HOOK && v.dot(chord) <= PAST * chord.hypot2();
    chord.hypot() >= SHORT_PX
        && within(start)
        && within(end)
        && start.hypot() + end.hypot() < LONG * chord.hypot()
}
