//! The vertex code: vertices to bits and back.

use super::band::near;
use kurbo::Point;

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

/// A number and the bits that it is written in.
type Word = (i32, u32);

/// Sectors of 45°, counter-clockwise from straight on, and their words.
const TURNS: [(i32, Word); 5] = [
    (0, (0b00, 2)),
    (1, (0b01, 2)),
    (7, (0b10, 2)),
    (2, (0b110, 3)),
    (6, (0b111, 3)),
];

/// Words of the runs 1, 2-3, 4-7, 8-15, 16-31.
const NEAR: [Word; 5] = [(0b110, 3), (0b111, 3), (0b00, 2), (0b01, 2), (0b10, 2)];

/// Words of the same and 32-63.
const FAR: [Word; 6] = [
    (0b000, 3),
    (0b001, 3),
    (0b010, 3),
    (0b011, 3),
    (0b10, 2),
    (0b11, 2),
];

impl Steps {
    /// Longest run, px.
    #[must_use]
    pub const fn longest(self) -> i32 {
        match self {
            Self::Eight | Self::Any => 31,
            Self::Far => 63,
        }
    }

    /// The bits of vertices, the first left out; none where one of them has no word.
    #[must_use]
    pub fn write(self, vertices: &[Point]) -> Option<Vec<bool>> {
        let (mut out, mut before) = (Vec::new(), None);
        for w in vertices.windows(2) {
            let step = self.step((near(w[1].x) - near(w[0].x), near(w[1].y) - near(w[0].y)))?;
            for (value, bits) in self.words(before, step)? {
                out.extend((0..bits).rev().map(|b| value >> b & 1 == 1));
            }
            before = Some(step);
        }
        Some(out)
    }

    /// The vertices of a closed curve from its first one and its bits: they end where it comes back to the first.
    /// None where the bits end sooner or make no word.
    #[must_use]
    pub fn read(self, first: Point, bits: &[bool]) -> Option<Vec<Point>> {
        let mut bits = bits.iter().map(|&b| i32::from(b));
        let (mut out, mut at, mut before) = (vec![first], first, None);
        while out.len() < 2 || at != first {
            let step = self.next(before, &mut bits)?;
            let (dx, dy) = step.vector();
            at += (f64::from(dx), f64::from(dy));
            out.push(at);
            before = Some(step);
        }
        Some(out)
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
        let [bucket, rest] = self.run(run);
        u64::from(2 + bucket.1 + rest.1 + place)
    }

    /// The bits of a step that has a word after the one before.
    pub(super) fn cost(self, before: Option<Step>, step: Step) -> Option<u64> {
        let words = self.words(before, step)?;
        Some(words.iter().map(|w| u64::from(w.1)).sum())
    }

    /// The bucket of a run that is not too long, and its place there.
    fn run(self, run: i32) -> [Word; 2] {
        let bucket = run.ilog2();
        [
            self.buckets()[bucket as usize],
            (run - (1 << bucket), bucket),
        ]
    }

    /// Turn, bucket, place in the bucket and place in the ring.
    pub(super) fn words(self, before: Option<Step>, step: Step) -> Option<[Word; 4]> {
        let (sector, off) = step.after(before);
        let turn = match before {
            None => (sector, 3),
            Some(_) => TURNS.iter().find(|t| t.0 == sector)?.1,
        };
        let place = match self {
            Self::Eight => (0, 0),
            Self::Any | Self::Far => truncated(step.run, off),
        };
        let [bucket, rest] = self.run(step.run);
        Some([turn, bucket, rest, place])
    }

    /// The step that the next bits are.
    pub(super) fn next(
        self,
        before: Option<Step>,
        bits: &mut impl Iterator<Item = i32>,
    ) -> Option<Step> {
        let sector = match before {
            None => number(bits, 3)?,
            Some(_) => TURNS[prefix(bits, TURNS.iter().map(|t| t.1))?].0,
        };
        let buckets = self.buckets();
        let bucket = u32::try_from(prefix(bits, buckets.iter().copied())?).ok()?;
        let run = (1 << bucket) + number(bits, bucket)?;
        let off = match self {
            // on the one place of the sector that lies on one of eight directions
            Self::Eight => None,
            Self::Any | Self::Far => Some(placed(run, bits)?),
        };
        Some(Step::going(before, (sector, off), run))
    }

    const fn buckets(self) -> &'static [Word] {
        match self {
            Self::Eight | Self::Any => &NEAR,
            Self::Far => &FAR,
        }
    }
}

/// Truncated binary code of one of n places: the shorter words are of those with the least |off|.
fn truncated(n: i32, off: i32) -> Word {
    let rank = 2 * off.abs() - i32::from(off < 0);
    let bits = n.ilog2();
    let short = (2 << bits) - n;
    if rank < short {
        (rank, bits)
    } else {
        (rank + short, bits + 1)
    }
}

/// The place of the next bits.
fn placed(n: i32, bits: &mut impl Iterator<Item = i32>) -> Option<i32> {
    let count = n.ilog2();
    let short = (2 << count) - n;
    let rank = match number(bits, count)? {
        rank if rank < short => rank,
        most => 2 * most + bits.next()? - short,
    };
    Some((rank + 1) / 2 * (1 - 2 * (rank % 2)))
}

fn number(bits: &mut impl Iterator<Item = i32>, count: u32) -> Option<i32> {
    (0..count).try_fold(0, |n, _| Some(2 * n + bits.next()?))
}

/// Which of some words the next bits are.
fn prefix(
    bits: &mut impl Iterator<Item = i32>,
    words: impl Iterator<Item = Word> + Clone,
) -> Option<usize> {
    let (mut value, mut count) = (0, 0);
    loop {
        if let Some(i) = words.clone().position(|w| w == (value, count)) {
            return Some(i);
        }
        (value, count) = (2 * value + bits.next()?, count + 1);
        if count > 3 {
            return None;
        }
    }
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

    /// The step of a run that goes on in a sector, so far from its middle; on one of eight directions if that is not
    /// said.
    fn going(before: Option<Self>, (sector, off): (i32, Option<i32>), run: i32) -> Self {
        let on = Self::on(before, run) + sector * run;
        let off = off.unwrap_or_else(|| (run / 2 - on).rem_euclid(run) - run / 2);
        let place = (on + off).rem_euclid(8 * run);
        Self { place, run }
    }

    /// dx and dy, px.
    fn vector(self) -> (i32, i32) {
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
    fn after(self, before: Option<Self>) -> (i32, i32) {
        let Self { place, run } = self;
        let around = (place - Self::on(before, run) + run / 2).rem_euclid(8 * run);
        (around / run, around % run - run / 2)
    }
}
