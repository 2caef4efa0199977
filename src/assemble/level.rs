//! Letters of a joining script that were drawn too high or too low as a whole.
//!
//! All joining strokes end at one height. So what the ends of a whole row have in common is how far the row's
//! baseline was missed: the side of nothing on which all of them lie, and the least of them. What is left of the two
//! ends of a medial form has in common how far that letter strays, and differs by how far strokes stray by
//! themselves. Let `a` and `b` be what is left of the heights of a form's ends above the usual one. With the letters'
//! variance `v` and the strokes' own `w`, taken from all medial forms by the medians of `|a + b|` and `|a - b|`, the
//! likeliest stray is
//!
//! ```text
//! two ends   v / (v + w/2) · (a + b)/2         one end   v / (v + w) · a
//! ```
//!
//! Where letters stand well and a hand's strokes vary, `v` is nothing, and so is every letter's stray.
//!
//! A letter that strays by more than its strokes are thick may have its body where the others' strokes would meet it,
//! so that none of its own is told. Of all its ends that are as thick (`Height::may_be`) those are taken then that
//! differ least from each other and from the usual height, in deviations of the other letters.

use super::joining::{self, Height, Method, Options};
use super::{AssembleError, Drawn};
use crate::numeric::median::{NORMAL, median};
use kurbo::Affine;
use std::collections::BTreeMap;

/// Letters with joining strokes from which a row's baseline is told.
const ROW: usize = 3;

/// Medial forms from which variances are taken.
const FEWEST: usize = 8;

/// What lies farther off than so many standard deviations was meant so, or is no stroke. Slips are not quite normal,
/// and a median of some dozen forms can be far less than it should be: hence twice the usual three.
const MOST: f64 = 6.0;

/// Rounds in which ends and deviations settle.
const ROUNDS: u32 = 3;

/// Least deviation of strokes, em: they are not measured better than that.
const MEASURED: f64 = 0.001;

/// How far each letter lies above where its joining strokes and those of its row say that it belongs, font units; 0
/// where they do not tell. Letters of the same number in `rows` were given one baseline.
///
/// # Errors
/// A label names no glyph, or two shapes have one name.
pub fn strays(
    drawn: &[Drawn],
    rows: &[usize],
    em: f64,
    options: &Options,
) -> Result<Vec<f64>, AssembleError> {
    let mut drafts = super::drafts(drawn.to_vec(), &[])?;
    if options.method == Method::Cursive {
        return Ok(vec![0.0; drafts.len()]);
    }
    let mut heights = joining::heights(&drafts, em, options);
    let rows = shared(&heights, rows);
    for (sides, row) in heights.iter_mut().zip(&rows) {
        for height in sides {
            let ends = height.told.iter_mut().chain(&mut height.may_be);
            ends.for_each(|end| *end -= row);
        }
    }
    let (hand, ends) = Hand::of(&heights, em);
    let stray = |(ends, row): (&Ends, f64)| row + hand.map_or(0.0, |hand| hand.stray(*ends));
    let mut strays: Vec<f64> = ends.iter().zip(rows).map(stray).collect();
    for (draft, stray) in drafts.iter_mut().zip(&strays) {
        draft.outline = draft.outline.transformed(Affine::translate((0.0, -stray)));
    }
    // where strokes do not meet even so, they were not meant to
    if joining::settled(&drafts, em, options).0 == Method::Cursive {
        strays.fill(0.0);
    }
    Ok(strays)
}

/// How far a letter's joining strokes lie above the usual height, left and right, font units.
type Ends = (Option<f64>, Option<f64>);

/// What the ends of each letter's row have in common.
fn shared(heights: &[[Height; 2]], rows: &[usize]) -> Vec<f64> {
    let mut ends: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (height, row) in heights.iter().zip(rows) {
        // both ends of a letter are one witness
        let end = height.iter().filter_map(|height| height.told);
        ends.entry(*row)
            .or_default()
            .extend(end.reduce(|a, b| if a.abs() < b.abs() { a } else { b }));
    }
    let common = |row: &usize| {
        let ends = ends.get(row).filter(|ends| ends.len() >= ROW)?;
        let least = ends
            .iter()
            .copied()
            .min_by(|a, b| a.abs().total_cmp(&b.abs()))?;
        ends.iter().all(|end| end * least > 0.0).then_some(least)
    };
    rows.iter().map(|row| common(row).unwrap_or(0.0)).collect()
}

/// How steadily letters were drawn, font units.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Hand {
    /// Standard deviation of what both ends have in common: `v + w/2` is its square.
    common: f64,
    /// Standard deviation of half of what they differ by: `w/2` is its square.
    own: f64,
    /// Standard deviation of the strokes' height, of all letters.
    all: f64,
}

impl Hand {
    /// The hand, where enough is told, and each letter's ends as they are told or likely by it.
    fn of(heights: &[[Height; 2]], em: f64) -> (Option<Self>, Vec<Ends>) {
        let told = |[left, right]: &[Height; 2]| (left.told, right.told);
        let mut ends: Vec<Ends> = heights.iter().map(told).collect();
        let mut hand = Self::drawn(&ends, em);
        for _ in 0..ROUNDS {
            let Some(so_far) = hand else { break };
            ends = heights.iter().map(|height| so_far.likely(height)).collect();
            hand = Self::drawn(&ends, em);
        }
        (hand, ends)
    }

    fn drawn(ends: &[Ends], em: f64) -> Option<Self> {
        let both: Vec<(f64, f64)> = ends.iter().filter_map(|ends| ends.0.zip(ends.1)).collect();
        if both.len() < FEWEST {
            return None;
        }
        let deviation = |of: fn(&(f64, f64)) -> f64| Some(NORMAL * median(both.iter().map(of))?);
        let told = ends.iter().filter(|ends| **ends != (None, None));
        Some(Self {
            common: deviation(|(a, b)| 0.5 * (a + b).abs())?,
            own: deviation(|(a, b)| 0.5 * (a - b).abs())?.max(MEASURED * em),
            all: NORMAL * median(told.map(|ends| parts(*ends).0.abs()))?,
        })
    }

    /// A letter's ends: those that are told, or else the likeliest of what may be ends of one that strays as others do.
    fn likely(self, [left, right]: &[Height; 2]) -> Ends {
        let told = (left.told, right.told);
        if told != (None, None) {
            return told;
        }
        let each = |height: &Height| {
            let ends = height.may_be.iter().copied().map(Some);
            ends.chain([None]).collect::<Vec<_>>()
        };
        let (lefts, rights) = (each(left), each(right));
        let pairs = lefts
            .iter()
            .flat_map(|a| rights.iter().map(move |b| (*a, *b)));
        // two ends tell more than one
        let missing = |ends: &Ends| u8::from(ends.0.is_none()) + u8::from(ends.1.is_none());
        let likely = pairs.filter(|ends| self.is_likely(*ends));
        let likely = likely.min_by(|a, b| {
            let nearer = self.against(*a).total_cmp(&self.against(*b));
            missing(a).cmp(&missing(b)).then(nearer)
        });
        likely.unwrap_or_default()
    }

    /// In squares of standard deviations, what speaks against a letter's having its strokes there.
    fn against(self, ends: Ends) -> f64 {
        let (middle, apart) = parts(ends);
        (middle / self.all).powi(2) + (apart / self.own).powi(2)
    }

    fn is_likely(self, ends: Ends) -> bool {
        let (middle, apart) = parts(ends);
        middle.abs() < MOST * self.all && apart.abs() < MOST * self.own
    }

    /// How far a letter strays whose ends lie so far above the usual height.
    fn stray(self, ends: Ends) -> f64 {
        let own = self.own.powi(2);
        let baseline = (self.common.powi(2) - own).max(0.0);
        let share = match ends {
            (Some(_), Some(_)) => baseline / (baseline + own),
            _ => baseline / (baseline + 2.0 * own),
        };
        let slip = Some(parts(ends).0).filter(|_| self.is_likely(ends));
        share * slip.unwrap_or(0.0)
    }
}

/// The middle of a letter's ends, and half of what they differ by.
fn parts(ends: Ends) -> (f64, f64) {
    match ends {
        (Some(a), Some(b)) => (0.5 * (a + b), 0.5 * (a - b)),
        (one, other) => (one.or(other).unwrap_or(0.0), 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assemble::drafts;
    use crate::types::{Label, Outline};
    use kurbo::{BezPath, PathEl};

    /// Letters that join on both sides.
    const LETTERS: [&str; 10] = [
        "0628", "062A", "062B", "0633", "0635", "0637", "0639", "0641", "0643", "0644",
    ];

    /// A stem whose strokes leave it so far above the baseline, to the left and to the right.
    fn drawn(label: &str, left: f64, right: f64) -> Drawn {
        let svg = format!(
            "M0 {left}L200 {left}L200 -100L300 -100L300 {right}L500 {right}L500 {}L300 {}L300 500L200 500L200 {}L0 {}Z",
            right + 60.0,
            right + 60.0,
            left + 60.0,
            left + 60.0,
        );
        Drawn {
            label: Label(label.to_owned()),
            outline: Outline::new(vec![BezPath::from_svg(&svg).unwrap()]).unwrap(),
            plates: Vec::new(),
            advance: None,
        }
    }

    fn medials(ends: impl Fn(f64) -> (f64, f64)) -> Vec<Drawn> {
        let medial = |(i, letter): (u32, &&str)| {
            let (left, right) = ends(f64::from(i) - 4.5);
            drawn(&format!("uni{letter}.medi"), left, right)
        };
        (0..).zip(&LETTERS).map(medial).collect()
    }

    /// Every letter in a row of its own.
    fn alone(drawn: &[Drawn]) -> Vec<f64> {
        let rows: Vec<usize> = (0..drawn.len()).collect();
        strays(drawn, &rows, 1000.0, &Options::default()).unwrap()
    }

    #[test]
    fn what_both_ends_of_a_letter_have_in_common_is_its_stray() {
        let mut page = medials(|i| (5.0 * i, 5.0 * i));
        page.push(drawn("uni0628.fina", 200.0, 12.0));
        page.push(drawn("uni0628", 200.0, 30.0));
        let found = alone(&page);
        let usual = 3.0; // the upper one of the two in the middle, rounded
        for (i, stray) in (0..10).zip(&found) {
            let wanted = 5.0 * (f64::from(i) - 4.5) - usual;
            assert!((stray - wanted).abs() < 0.5, "{i}: {stray} {wanted}");
        }
        assert!((found[10] - (12.0 - usual)).abs() < 1.0, "{found:?}");
        assert!(found[11].abs() < 1e-9, "nothing says where it belongs");
    }

    #[test]
    fn letters_that_stray_by_more_than_their_strokes_thickness_are_told_by_the_others() {
        // the lowest one's lie below those of all others, whose would meet its stem
        let page = medials(|i| (12.0 * i, 12.0 * i));
        let drafts = drafts(page.clone(), &[]).unwrap();
        let heights = joining::heights(&drafts, 1000.0, &Options::default());
        let untold = heights.iter().filter(|[left, _]| left.told.is_none());
        assert_eq!(untold.count(), 1);
        for (i, stray) in (0..10).zip(alone(&page)) {
            let wanted = 12.0 * (f64::from(i) - 4.5) - 6.0;
            assert!((stray - wanted).abs() < 1.0, "{i}: {stray} {wanted}");
        }
    }

    #[test]
    fn round_ends_are_joining_strokes_wherever_their_outermost_point_lies() {
        let mut page = medials(|_| (0.0, 0.0));
        for (k, letter) in LETTERS.iter().enumerate() {
            let (low, high) = (20.0 - 0.3 * k as f64, 40.0 - 0.2 * k as f64);
            let svg = format!("M0 0H300V500H200V60H0C-45 {high} -35 {low} 0 0Z");
            let mut round = drawn(&format!("uni{letter}.init"), 0.0, 0.0);
            round.outline = Outline::new(vec![BezPath::from_svg(&svg).unwrap()]).unwrap();
            page.push(round);
        }
        let drafts = drafts(page, &[]).unwrap();
        let heights = joining::heights(&drafts, 1000.0, &Options::default());
        assert!(
            heights.iter().all(|[left, _]| left.told.is_some()),
            "{heights:?}"
        );
    }

    #[test]
    fn strokes_that_vary_by_themselves_move_no_letter() {
        let mut page = medials(|i| (5.0 * i, -5.0 * i));
        page.push(drawn("uni0628.fina", 200.0, 12.0));
        assert_eq!(alone(&page), vec![0.0; page.len()]);
    }

    #[test]
    fn few_letters_tell_nothing() {
        let page = &medials(|i| (5.0 * i, 5.0 * i))[..FEWEST - 1];
        assert_eq!(alone(page), vec![0.0; page.len()]);
    }

    #[test]
    fn a_row_is_moved_by_what_its_letters_share() {
        let page: Vec<Drawn> = medials(|i| if i > 2.0 { (9.0, 10.0) } else { (0.0, 0.0) })
            .into_iter()
            .chain([drawn("uni0627", 200.0, 0.0), drawn("uni062F", 200.0, 0.0)])
            .collect();
        let rows = [0, 0, 0, 0, 0, 1, 1, 2, 2, 2, 2, 1];
        let found = strays(&page, &rows, 1000.0, &Options::default()).unwrap();
        let wanted = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 9.0, 9.0, 9.0, 9.0, 0.0];
        for (stray, wanted) in found.iter().zip(wanted) {
            assert!((stray - wanted).abs() < 1.0, "{found:?}");
        }
    }

    #[test]
    fn cursive_letters_stay() {
        let page = medials(|i| (5.0 * i, 5.0 * i));
        let options = Options {
            method: Method::Cursive,
            ..Options::default()
        };
        let rows: Vec<usize> = (0..page.len()).collect();
        assert_eq!(
            strays(&page, &rows, 1000.0, &options).unwrap(),
            vec![0.0; page.len()]
        );
    }

    #[test]
    fn strokes_at_many_heights_are_joined_where_they_lie() {
        let method = |page: &[Drawn]| {
            let drafts = drafts(page.to_vec(), &[]).unwrap();
            joining::settled(&drafts, 1000.0, &Options::default()).0
        };
        let slanted = medials(|i| (40.0 * i, -40.0 * i));
        assert_eq!(method(&slanted), Method::Cursive);
        assert_eq!(alone(&slanted), vec![0.0; slanted.len()]);
        // a hand that strays, whose letters are moved first
        let strayed = medials(|i| (10.0 * i, 10.0 * i));
        assert!(alone(&strayed).iter().any(|stray| stray.abs() > 40.0));
        assert_eq!(method(&medials(|i| (2.0 * i, -2.0 * i))), Method::Contract);
    }

    /// Below a body that no stroke leaves, and its outermost ink.
    #[test]
    fn a_dot_is_no_joining_stroke() {
        let mut page = medials(|_| (0.0, 0.0));
        let mut bow = drawn("uni0628.fina", 200.0, 0.0);
        let svg = "M0 100L300 100L300 500L0 500Z M250 -300L400 -300L400 -200L250 -200Z";
        let contours = BezPath::from_svg(svg).unwrap();
        let contours = contours
            .elements()
            .split_inclusive(|e| *e == PathEl::ClosePath);
        bow.outline =
            Outline::new(contours.map(|c| c.iter().copied().collect()).collect()).unwrap();
        page.push(bow);
        let drafts = drafts(page, &[]).unwrap();
        let heights = joining::heights(&drafts, 1000.0, &Options::default());
        assert_eq!(heights.last(), Some(&<[Height; 2]>::default()));
    }
}
