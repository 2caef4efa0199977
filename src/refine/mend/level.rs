//! Lines that are upright or level but for the noise of their ends.
//!
//! Grain turns a line by a part of a pixel from end to end, and drawings have lines on an axis far more often than next
//! to one. Where the pixels allow it such a line is on its axis; where they do not for most of a picture's lines, it
//! was drawn or lay aslant, and so stay the short ones, which would tell too little.

use super::Work;
use crate::numeric::chain::{Chain, Join, Kind};

/// A line turned by more is not meant to be on an axis, as a slope.
const SLOPE: f64 = 0.03;
/// By how much squares may grow for one, and in the picture's grain: that of neighbouring pixels is alike.
const MORE: (f64, f64) = (0.001, 40.0);

impl Work<'_> {
    /// Puts lines on the axis that they are next to, if the picture allows that for most of their length.
    pub(super) fn level(&mut self) {
        let more = MORE.0 + MORE.1 * self.wrong.grain;
        let before = (self.chains.clone(), self.rings.clone());
        let (mut on_axis, mut aslant) = (0.0, 0.0);
        for k in 0..self.chains.len() {
            let count = self.chains[k].as_ref().map_or(0, |c| c.kinds.len());
            for i in 0..count {
                let levelled = self.chains[k].as_ref().and_then(|c| levelled(c, i));
                let Some((chain, length)) = levelled else {
                    continue;
                };
                if self.put(k, chain, more) {
                    on_axis += length;
                } else {
                    aslant += length;
                }
            }
        }
        if aslant > on_axis {
            (self.chains, self.rings) = before;
            self.redraw_all();
        }
    }
}

/// The chain with line `i` on the axis that it is next to, around its own middle, and how long that is, px; none where
/// it is on it already, or next to none.
fn levelled(chain: &Chain, i: usize) -> Option<(Chain, f64)> {
    let (a, b) = chain.ends(i);
    let (p, q) = (chain.nodes[a].point, chain.nodes[b].point);
    let (way, middle) = (q - p, p.midpoint(q));
    let (axis, off, length) = if way.x.abs() < way.y.abs() {
        (Join::Vertical, way.x.abs(), way.y.abs())
    } else {
        (Join::Horizontal, way.y.abs(), way.x.abs())
    };
    if chain.kinds[i] != Kind::Line || off <= 0.0 || off > SLOPE * length {
        return None;
    }
    let mut chain = chain.clone();
    for n in [a, b] {
        let node = &mut chain.nodes[n];
        match axis {
            Join::Vertical => node.point.x = middle.x,
            _ => node.point.y = middle.y,
        }
        if node.join.is_smooth() {
            node.join = axis;
        }
    }
    chain.align();
    Some((chain, length))
}
