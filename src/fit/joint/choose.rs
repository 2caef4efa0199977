//! One global choice of nodes and kinds: the cheapest way through the candidates.

use super::candidate::Candidate;
use super::cost;
use super::piece::{Lines, cubic_cost};
use super::samples::Samples;
use crate::numeric::chain::{Chain, Join, Kind, Node};
use crate::numeric::refit::Foot;

/// Segments that cost so much more than their structure are not lengthened further.
const HOPELESS: f64 = 36.0;
/// Consecutive hopeless lengthenings before giving up: noise may pass.
const PATIENCE: usize = 2;
#[derive(Debug, Clone, Copy)]
struct State {
    cost: f64,
    from: usize,
    kind: Kind,
}

const NOWHERE: State = State {
    cost: f64::INFINITY,
    from: 0,
    kind: Kind::Line,
};

/// Nodes and kinds of least description length among the candidates, and each sample's foot.
pub(super) fn choose(s: &Samples, marks: &[Candidate], sigma: f64) -> (Chain, Vec<Foot>) {
    let lines = Lines::new(s);
    // The best way to each candidate whose last segment is a line, and a cubic.
    let mut best = vec![[NOWHERE; 2]; marks.len()];
    let start = [Kind::Line, Kind::Cubic];
    for i in 0..marks.len() {
        let mut hopeless = 0;
        let mut over = 0.0;
        for j in i + 1..marks.len() {
            if s.ring && i == 0 && j + 1 == marks.len() {
                break;
            }
            let (a, b) = (&marks[i], &marks[j]);
            let line = lines.cost(s, sigma, a, b);
            let mut known = false;
            // No cubic is worth its handles where a line does.
            let cubic = if line < cost::kind(Kind::Cubic) {
                line
            } else {
                let reached = start.map(|before| arrive(&best, marks, (i, before), Kind::Cubic));
                let before = reached[0].min(reached[1]) + cost::kind(Kind::Cubic) + over;
                match best[j][1].cost - before {
                    room if room > 0.0 => cubic_cost(s, sigma, (a, b), room.min(HOPELESS)) + over,
                    // however well it fits, another way to `j` is cheaper already
                    _ => {
                        known = true;
                        f64::INFINITY
                    }
                }
            };
            for (kind, fit) in [(Kind::Line, line), (Kind::Cubic, cubic)] {
                let fit = fit + cost::kind(kind);
                for before in start {
                    let reached = arrive(&best, marks, (i, before), kind);
                    let slot = &mut best[j][usize::from(kind == Kind::Cubic)];
                    if reached + fit < slot.cost {
                        *slot = State {
                            cost: reached + fit,
                            from: i,
                            kind: before,
                        };
                    }
                }
            }
            if matches!(b.join, Join::Horizontal | Join::Vertical) {
                over += cost::OVER_EXTREMUM;
            }
            hopeless = if !known && line.min(cubic) > HOPELESS {
                hopeless + 1
            } else {
                0
            };
            if hopeless >= PATIENCE {
                break;
            }
        }
    }
    walk_back(s, marks, &best)
}

/// Cost of standing at candidate `i` after a segment `before`, about to leave by `kind`.
fn arrive(best: &[[State; 2]], marks: &[Candidate], (i, before): (usize, Kind), kind: Kind) -> f64 {
    let join = marks[i].join;
    if i == 0 {
        // A ring's first node is paid for at its end.
        return 0.0;
    }
    if before == Kind::Line && kind == Kind::Line {
        return f64::INFINITY;
    }
    best[i][usize::from(before == Kind::Cubic)].cost + cost::node(join, Some(before), Some(kind))
}

fn walk_back(s: &Samples, marks: &[Candidate], best: &[[State; 2]]) -> (Chain, Vec<Foot>) {
    let last = marks.len() - 1;
    let mut chain = Chain::default();
    let mut feet = vec![Foot { segment: 0, t: 0.0 }; s.len()];
    let node = |i: usize| Node {
        point: s.point(marks[i].index),
        join: marks[i].join,
        arrive: marks[i].heading,
        leave: marks[i].heading,
        back: 0.0,
        ahead: 0.0,
    };
    let [line, cubic] = best[last];
    let mut kind = if line.cost < cubic.cost {
        Kind::Line
    } else {
        Kind::Cubic
    };
    let mut at = last;
    if !s.ring {
        chain.nodes.push(node(last));
    }
    while at > 0 {
        let state = best[at][usize::from(kind == Kind::Cubic)];
        if !state.cost.is_finite() {
            break;
        }
        let length = (marks[at].index - marks[state.from].index) as f64 * s.step / 3.0;
        if let Some(n) = chain.nodes.last_mut() {
            n.back = length;
        }
        let mut n = node(state.from);
        n.ahead = length;
        let (i, j) = (marks[state.from].index, marks[at].index);
        for k in i..j {
            // Counted from the end until all segments are known.
            feet[k % s.len()] = Foot {
                segment: chain.kinds.len(),
                t: (k - i) as f64 / (j - i) as f64,
            };
        }
        chain.nodes.push(n);
        chain.kinds.push(kind);
        kind = state.kind;
        at = state.from;
    }
    chain.nodes.reverse();
    chain.kinds.reverse();
    let last = chain.kinds.len().saturating_sub(1);
    for foot in &mut feet {
        foot.segment = last - foot.segment.min(last);
    }
    if let (false, Some(foot)) = (s.ring, feet.last_mut()) {
        *foot = Foot {
            segment: last,
            t: 1.0,
        };
    }
    if s.ring {
        let n = chain.nodes.len();
        if let (Some(length), true) = (chain.nodes.last().map(|n| n.ahead), n > 0) {
            chain.nodes[0].back = length;
        }
    }
    (chain, feet)
}
