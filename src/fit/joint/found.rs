//! From the chosen structure of one span, or of several that were welded, to the refined one.

use super::candidate::Candidate;
use super::samples::Samples;
use super::{choose, cost, improve};
use crate::numeric::chain::{Chain, Join, Kind};
use crate::numeric::refit::{Foot, Refit, Sample, Scale, Stop};
use kurbo::{ParamCurve, Point};

/// Distance, in sigmas, from which a point counts as an outlier.
const ROBUST: f64 = 4.0;
/// How far a node may go from where it was, in shorter sides.
const FREEDOM: f64 = 0.5;
/// A line so near to an axis is meant to be parallel to it, radians.
const UPRIGHT: f64 = 0.006;
/// One whose ends are further off an axis than this is not, px.
const ASLANT_PX: f64 = 0.1;

/// A structure before its refinement.
#[derive(Debug, Clone, Default)]
pub(super) struct Draft {
    pub(super) chain: Chain,
    /// Few points that tell nearly as much as all, and their feet.
    pub(super) few: Vec<Sample>,
    pub(super) feet: Vec<Foot>,
    pub(super) all: Vec<Sample>,
    /// Which of the few is beside each of all.
    pub(super) near: Vec<usize>,
    /// How many of all each span has.
    pub(super) spans: Vec<usize>,
}

/// What a search ends with.
#[derive(Debug)]
pub(super) struct Found {
    /// Refined, the ends of an open one free.
    pub(super) chain: Chain,
    /// As the dynamic programme chose it.
    pub(super) chosen: Chain,
    /// The points that it follows, and their feet on it.
    pub(super) samples: Vec<Sample>,
    pub(super) feet: Vec<Foot>,
    /// How many of them each span has.
    pub(super) spans: Vec<usize>,
    /// Least deviation of the points, px.
    pub(super) sigma: f64,
    pub(super) refit: Refit,
}

impl Draft {
    /// The structure of least description length of a span whose points deviate by `sigma` px.
    pub(super) fn choose(s: &Samples, marks: &[Candidate], sigma: f64) -> Option<Self> {
        let (mut chain, feet) = choose::choose(s, marks, sigma);
        if chain.nodes.len() < 2 {
            return None;
        }
        upright(&mut chain);
        loosen(&mut chain);
        let weighed = |at, steps| Sample {
            at,
            weight: steps / cost::CORRELATION,
            sigma,
        };
        let (indices, points) = s.thinned();
        let all = s.at.iter().zip(&s.weight);
        // Each sample's foot is near that of its neighbour among the few.
        let near = |k: usize| indices.partition_point(|&i| i < k).min(indices.len() - 1);
        Some(Self {
            chain,
            few: points.into_iter().map(|(at, n)| weighed(at, n)).collect(),
            feet: indices.iter().map(|&k| feet[k]).collect(),
            all: all.map(|(&at, &w)| weighed(at, w)).collect(),
            near: (0..s.len()).map(near).collect(),
            spans: vec![s.len()],
        })
    }

    /// Refined, smaller where the description gets shorter.
    pub(super) fn refine(self, sigma: f64) -> Found {
        let chosen = self.chain.clone();
        let mut work = improve::Work {
            chain: self.chain,
            feet: self.feet,
            samples: &self.few,
            scale: Scale {
                sigma,
                robust: ROBUST,
                freedom: FREEDOM,
            },
            refit: Refit::default(),
            held: Vec::new(),
            stale: Vec::new(),
        };
        work.settle(8, 0.1);
        work.improve();
        let mut found = Found {
            chain: work.chain,
            chosen,
            feet: self.near.iter().map(|&k| work.feet[k]).collect(),
            samples: self.all,
            spans: self.spans,
            sigma,
            refit: work.refit,
        };
        found.settle(20, 1e-3);
        found
    }
}

impl Found {
    /// Refines everything at once.
    pub(super) fn settle(&mut self, rounds: usize, gain: f64) {
        let scale = Scale {
            sigma: self.sigma,
            robust: ROBUST,
            freedom: FREEDOM,
        };
        let stop = Stop {
            rounds,
            gain,
            enough: f64::INFINITY,
        };
        let data = (&self.samples[..], &mut self.feet);
        self.refit.run(&mut self.chain, data, scale, stop);
    }

    /// The largest distance of a measured point of each span, px.
    pub(super) fn worst(&self) -> Vec<f64> {
        let most = self.samples.iter().map(|s| s.weight).fold(0.0, f64::max);
        let mut pairs = self.samples.iter().zip(&self.feet);
        let off = |(s, f): (&Sample, &Foot)| {
            let told = s.weight > 0.5 * most;
            told.then(|| s.at.distance(self.chain.cubic(f.segment).eval(f.t)))
        };
        let of = |n: &usize| pairs.by_ref().take(*n).filter_map(off).fold(0.0, f64::max);
        self.spans.iter().map(of).collect()
    }
}

/// Lets the ends of an open chain give way: where they were put may be wrong by more than the noise of the points,
/// and no structure should pay for it.
fn loosen(chain: &mut Chain) {
    for node in &mut chain.nodes {
        if node.join == Join::End {
            node.join = Join::Loose;
        }
    }
}

/// Puts free ends to where they are given.
pub(super) fn pin(chain: &mut Chain, [start, end]: [Point; 2]) {
    let last = chain.nodes.len() - 1;
    for (i, at) in [(0, start), (last, end)] {
        let node = &mut chain.nodes[i];
        if node.join.is_end() {
            node.join = Join::End;
            node.point = at;
        }
    }
}

/// Lines that are all but upright or level become so, where their ends are free.
fn upright(chain: &mut Chain) {
    for i in 0..chain.kinds.len() {
        let (a, b) = chain.ends(i);
        let d = chain.direction(i);
        let axis = if d.y.abs() < UPRIGHT {
            Join::Horizontal
        } else {
            Join::Vertical
        };
        if chain.kinds[i] == Kind::Line && d.x.abs().min(d.y.abs()) < UPRIGHT {
            for n in [a, b] {
                if chain.nodes[n].join == Join::Smooth {
                    chain.nodes[n].join = axis;
                }
            }
        }
    }
}

/// Extrema at lines that lie aslant become smooth: held upright, such a line would turn what is beyond its other end.
pub(super) fn turn(chain: &mut Chain) {
    for i in 0..chain.kinds.len() {
        let (a, b) = chain.ends(i);
        let span = chain.nodes[b].point - chain.nodes[a].point;
        for (n, other) in [(a, b), (b, a)] {
            let off = match chain.nodes[n].join {
                Join::Vertical => span.x,
                Join::Horizontal => span.y,
                _ => 0.0,
            };
            let aslant = chain.kinds[i] == Kind::Line && off.abs() > ASLANT_PX;
            if aslant && chain.nodes[other].join == Join::Smooth {
                chain.nodes[n].join = Join::Smooth;
            }
        }
    }
}
