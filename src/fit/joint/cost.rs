//! What a structure costs, in nats: the prior of one who draws letters.

use crate::numeric::{
    chain::{Chain, Join, Kind},
    joins::inner_extrema,
};

/// Steps of contour that count as one measurement: neighbouring points share pixels.
pub(super) const CORRELATION: f64 = 5.0;
/// An extremum with an upright or level direction: where drawings have nodes anyway.
const EXTREMUM: f64 = 3.0;
/// A join of a line and a curve.
const BESIDE_LINE: f64 = 6.0;
/// A node in the middle of a curve: place, direction and two handles, and unusual.
const SMOOTH: f64 = 14.0;
/// A change of direction that is no corner of the contour.
const CORNER: f64 = 18.0;
/// A cubic's two handles.
const CUBIC: f64 = 4.0;

/// Cost of a node of the given join between two kinds.
pub(super) fn node(join: Join, before: Option<Kind>, after: Option<Kind>) -> f64 {
    let line = before == Some(Kind::Line) || after == Some(Kind::Line);
    match join {
        Join::End | Join::Loose | Join::Clamped => 0.0,
        Join::Horizontal | Join::Vertical => EXTREMUM,
        Join::Smooth if line => BESIDE_LINE,
        Join::Smooth => SMOOTH,
        Join::Corner => CORNER,
    }
}

/// Cost of a segment's kind.
pub(super) const fn kind(kind: Kind) -> f64 {
    match kind {
        Kind::Line => 0.0,
        Kind::Cubic => CUBIC,
    }
}

/// A cubic that runs over an extremum: drawings put a node there.
pub(super) const OVER_EXTREMUM: f64 = 12.0;

/// Cost of all nodes and kinds of a chain; `before` and `after` are the kinds beyond its ends.
pub(super) fn structure(chain: &Chain, before: Option<Kind>, after: Option<Kind>) -> f64 {
    let last = chain.nodes.len() - 1;
    let mut sum = 0.0;
    for (i, n) in chain.nodes.iter().enumerate() {
        let arrives = chain
            .kind(chain.before(i))
            .or(if i == 0 { before } else { None });
        let leaves = chain
            .kind(chain.after(i))
            .or(if i == last { after } else { None });
        sum += match n.join {
            Join::Smooth | Join::Clamped
                if arrives == Some(Kind::Line) && leaves == Some(Kind::Line) =>
            {
                CORNER
            }
            // Its own join is hidden; only the kinds beside it can differ.
            Join::Clamped => node(Join::Smooth, arrives, leaves),
            join => node(join, arrives, leaves),
        };
    }
    for (i, &k) in chain.kinds.iter().enumerate() {
        sum += kind(k);
        if k == Kind::Cubic {
            sum += OVER_EXTREMUM * inner_extrema(&chain.cubic(i)).count() as f64;
        }
    }
    sum
}
