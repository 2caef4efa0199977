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

/// Lines that are tried at most: a picture of noise, or of a hundred thousand squares, has more.
const LINES: usize = 10_000;

impl Work<'_> {
    /// Puts lines on the axis that they are next to, if the picture allows that for most of their length.
    pub(super) fn put_on_axes(&mut self) {
        let more = MORE.0 + MORE.1 * self.wrong.grain;
        let chains = self.chains.iter().enumerate();
        let chains = chains.filter_map(|(k, chain)| Some((k, chain.as_ref()?)));
        let next_to = |(k, c): (usize, &Chain)| {
            let lines = (0..c.kinds.len()).filter_map(|i| Some((i, next_to_axis(c, i)?)));
            lines
                .map(|(i, (axis, length))| (k, i, axis, length))
                .collect::<Vec<_>>()
        };
        let lines: Vec<_> = chains.flat_map(next_to).collect();
        if lines.len() > LINES {
            return;
        }
        let before = (self.chains.clone(), self.rings.clone());
        let (mut moved, mut aslant) = (0.0, 0.0);
        for (k, i, axis, length) in lines {
            let other = self.chains[k].as_ref().map(|c| on_axis(c, i, axis));
            if other.is_some_and(|chain| self.put(k, chain, more)) {
                moved += length;
            } else {
                aslant += length;
            }
        }
        if aslant > moved {
            (self.chains, self.rings) = before;
            self.redraw_all();
        }
    }
}

/// The axis that segment `i` is next to, if it is a line, and its length, px; none where it is on it already.
fn next_to_axis(chain: &Chain, i: usize) -> Option<(Join, f64)> {
    let (a, b) = chain.ends(i);
    let way = chain.nodes[b].point - chain.nodes[a].point;
    let (axis, off, length) = if way.x.abs() < way.y.abs() {
        (Join::Vertical, way.x.abs(), way.y.abs())
    } else {
        (Join::Horizontal, way.y.abs(), way.x.abs())
    };
    let aslant = off > 0.0 && off <= SLOPE * length;
    (chain.kinds[i] == Kind::Line && aslant).then_some((axis, length))
}

/// The chain with line `i` on an axis, around its own middle.
fn on_axis(chain: &Chain, i: usize, axis: Join) -> Chain {
    let mut chain = chain.clone();
    let (a, b) = chain.ends(i);
    let middle = chain.nodes[a].point.midpoint(chain.nodes[b].point);
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
    chain
}
