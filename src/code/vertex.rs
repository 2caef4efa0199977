//! The vertex code: the bits of a step from one vertex to the next.

/// Longest run, px.
pub const RUN: i32 = 31;

/// Steps that vertices may be apart.
///
/// ```text
/// turn    the sector of 45° it goes on in, against the step before: straight on 00, left 01, right 10,
///         90° left 110, 90° right 111; no others. The first step says its direction by 3 bits
/// run     max(|dx|, |dy|), 1 to 31 px: its bucket 1, 2-3, 4-7, 8-15, 16-31 as 110, 111, 00, 01, 10, and its place
///         in the bucket in 0 to 4 bits
/// place   of `Any` alone: which of the run's places in the sector, by truncated binary; the middle one first
/// ```
///
/// Complete prefix codes, so that no other code of these symbols is shorter for all. The first vertex is common to
/// all curves and not counted. A run along one of 8 directions is the usual code [sohel sec. III.C]; a sector with a
/// long and a short component is due to [lai14 p. 1], the bits are not.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Steps {
    /// A run along one of 8 directions.
    Eight,
    /// To any whole place.
    Any,
}

/// The direction and length of a step, by the square ring around the last vertex: ring `run` has 8 `run` places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Step {
    /// Counter-clockwise from east.
    place: i32,
    run: i32,
}

impl Steps {
    /// The bits of a step; none where the code has no word for it.
    #[must_use]
    pub fn bits(self, before: Option<(i32, i32)>, step: (i32, i32)) -> Option<u64> {
        let before = match before {
            Some(b) => Some(Step::new(b)?),
            None => None,
        };
        self.cost(before, Step::new(step)?)
    }

    /// All steps that have a word.
    pub(super) fn words(self) -> Vec<((i32, i32), Step)> {
        let places = (-RUN..=RUN).flat_map(|dy| (-RUN..=RUN).map(move |dx| (dx, dy)));
        let steps = places.filter_map(|at| Some((at, Step::new(at)?)));
        steps.filter(|s| self.cost(None, s.1).is_some()).collect()
    }

    /// No more than a step's bits, whatever came before it.
    pub(super) fn least(self, Step { run, .. }: Step) -> u64 {
        let place = match self {
            Self::Eight => 0,
            Self::Any => run.ilog2(),
        };
        2 + length(run) + u64::from(place)
    }

    pub(super) fn cost(self, before: Option<Step>, Step { place, run }: Step) -> Option<u64> {
        // where the run would end straight on, and the first of the places of its sector
        let on = before.map_or(0, |b| (2 * b.place * run + b.run) / (2 * b.run));
        let around = (place - on + run / 2).rem_euclid(8 * run);
        let (sector, off) = (around / run, around % run - run / 2);
        let turn = match (before, sector) {
            (None, _) | (_, 2 | 6) => 3,
            (_, 0 | 1 | 7) => 2,
            _ => return None,
        };
        match self {
            Self::Eight => (place % run == 0).then_some(turn + length(run)),
            Self::Any => Some(turn + length(run) + truncated(run, off)),
        }
    }
}

/// The bits of a run.
fn length(run: i32) -> u64 {
    let bucket = run.ilog2();
    u64::from(bucket + if bucket < 2 { 3 } else { 2 })
}

/// Truncated binary code of one of n places, those with the least |off| first.
fn truncated(n: i32, off: i32) -> u64 {
    let rank = 2 * off.abs() - i32::from(off < 0);
    let bits = n.ilog2();
    let short = (2 << bits) - n;
    u64::from(bits + u32::from(rank >= short))
}

impl Step {
    pub(super) fn new((dx, dy): (i32, i32)) -> Option<Self> {
        let run = dx.abs().max(dy.abs());
        let place = match (dx, dy) {
            _ if !(1..=RUN).contains(&run) => return None,
            _ if dy == run => 2 * run - dx,
            _ if dx == -run => 4 * run - dy,
            _ if dy == -run => 6 * run + dx,
            _ => dy.rem_euclid(8 * run),
        };
        Some(Self { place, run })
    }
}
