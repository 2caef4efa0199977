//! The words of the vertex code: vertices to bits and back.

use super::Steps;
use super::band::near;
use super::vertex::Step;
use kurbo::Point;

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

    /// Turn, bucket, place in the bucket and place in the ring.
    pub(super) fn words(self, before: Option<Step>, step: Step) -> Option<[Word; 4]> {
        let (sector, off) = step.after(before);
        let turn = match before {
            None => (sector, 3),
            Some(_) => TURNS.iter().find(|t| t.0 == sector)?.1,
        };
        let run = step.run();
        let bucket = run.ilog2();
        let place = match self {
            Self::Eight => (0, 0),
            Self::Any | Self::Far => truncated(run, off),
        };
        let words = *self.buckets().get(usize::try_from(bucket).ok()?)?;
        Some([turn, words, (run - (1 << bucket), bucket), place])
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
