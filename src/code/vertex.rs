//! The vertex code: the bits of a step from one vertex to the next.

/// Steps that vertices may be apart.
///
/// ```text
/// turn    the sector of 45° it goes on in, against the step before: straight on 00, left 01, right 10,
///         90° left 110, 90° right 111; no others. The first step says its direction by 3 bits
/// run     max(|dx|, |dy|): its bucket, and its place in the bucket in as many bits as halve it to 1
///         to 31 px (`Eight`, `Any`): buckets 1, 2-3, 4-7, 8-15, 16-31 as 110, 111, 00, 01, 10
///         to 63 px (`Far`): buckets 1, 2-3, 4-7, 8-15, 16-31, 32-63 as 000, 001, 010, 011, 10, 11
/// place   of `Any` and `Far`: which of the run's places in the sector, by truncated binary; the middle one first
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
    /// The same, twice as far.
    Far,
}

/// The direction and length of a step, by the square ring around the last vertex: ring `run` has 8 `run` places.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Step {
    /// Counter-clockwise from east.
    place: i32,
    run: i32,
}

impl Steps {
    /// Longest run, px.
    #[must_use]
    pub const fn longest(self) -> i32 {
        match self {
            Self::Eight | Self::Any => 31,
            Self::Far => 63,
        }
    }

    /// The bits of a step; none where the code has no word for it.
    #[must_use]
    pub fn bits(self, before: Option<(i32, i32)>, step: (i32, i32)) -> Option<u64> {
        let before = match before {
            Some(b) => Some(self.step(b)?),
            None => None,
        };
        self.cost(before, self.step(step)?)
    }

    /// The step to a place; none where it is too far, or on none of eight directions.
    pub(super) fn step(self, at: (i32, i32)) -> Option<Step> {
        let step = Step::new(at)?;
        let has = step.run <= self.longest() && (self != Self::Eight || step.place % step.run == 0);
        has.then_some(step)
    }

    /// No more than a step's bits, whatever came before it.
    pub(super) fn least(self, Step { run, .. }: Step) -> u64 {
        let place = match self {
            Self::Eight => 0,
            Self::Any | Self::Far => run.ilog2(),
        };
        2 + self.length(run) + u64::from(place)
    }

    /// The bits of a step that has a word after the one before, by the step before.
    pub(super) fn cost(self, before: Option<Step>, step: Step) -> Option<u64> {
        let (sector, off) = step.after(before);
        let turn = match (before, sector) {
            (None, _) | (_, 2 | 6) => 3,
            (_, 0 | 1 | 7) => 2,
            _ => return None,
        };
        let place = match self {
            Self::Eight => 0,
            Self::Any | Self::Far => truncated(step.run, off),
        };
        Some(turn + self.length(step.run) + place)
    }

    /// The bits of a run.
    fn length(self, run: i32) -> u64 {
        let bucket = run.ilog2();
        let rare = match self {
            Self::Eight | Self::Any => bucket < 2,
            Self::Far => bucket < 4,
        };
        u64::from(bucket + if rare { 3 } else { 2 })
    }
}

/// Truncated binary code of one of n places, those with the least |off| first.
fn truncated(n: i32, off: i32) -> u64 {
    let rank = 2 * off.abs() - i32::from(off < 0);
    let bits = n.ilog2();
    let short = (2 << bits) - n;
    u64::from(bits + u32::from(rank >= short))
}

impl Step {
    fn new((dx, dy): (i32, i32)) -> Option<Self> {
        let run = dx.abs().max(dy.abs());
        let place = match (dx, dy) {
            _ if run == 0 => return None,
            _ if dy == run => 2 * run - dx,
            _ if dx == -run => 4 * run - dy,
            _ if dy == -run => 6 * run + dx,
            _ => dy.rem_euclid(8 * run),
        };
        Some(Self { place, run })
    }

    pub(super) const fn run(self) -> i32 {
        self.run
    }

    /// The step of a run that goes on in a sector, so far from its middle; on one of eight directions if that is not
    /// said.
    pub(super) fn going(before: Option<Self>, (sector, off): (i32, Option<i32>), run: i32) -> Self {
        let on = Self::on(before, run) + sector * run;
        let off = off.unwrap_or_else(|| (run / 2 - on).rem_euclid(run) - run / 2);
        let place = (on + off).rem_euclid(8 * run);
        Self { place, run }
    }

    /// dx and dy, px.
    pub(super) fn vector(self) -> (i32, i32) {
        let Self { place, run } = self;
        match place / run {
            0 => (run, place),
            1 | 2 => (2 * run - place, run),
            3 | 4 => (-run, 4 * run - place),
            5 | 6 => (place - 6 * run, -run),
            _ => (run, place - 8 * run),
        }
    }

    /// The place where a run ends that goes straight on.
    fn on(before: Option<Self>, run: i32) -> i32 {
        before.map_or(0, |b| (2 * b.place * run + b.run) / (2 * b.run))
    }

    /// The sector that it goes on in, and how far from the sector's middle, in places of its ring.
    pub(super) fn after(self, before: Option<Self>) -> (i32, i32) {
        let Self { place, run } = self;
        let around = (place - Self::on(before, run) + run / 2).rem_euclid(8 * run);
        (around / run, around % run - run / 2)
    }
}
