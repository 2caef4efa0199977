//! Pieces in reading order + names → which pieces are letters, and of which name: one choice for the whole page.
//!
//! Every piece is a letter, a part of one beside it, dirt, or a letter without a name; every name has one letter, in order, or none.
//! What a name says about its letter's size and dots makes some of these likely, and the least sum of costs is taken: the
//! shortest path through pieces and names, as sequences are aligned. A cost of 1 is strong doubt.

use crate::scan::letters::{Foot, Pieces, Shape};
use std::ops::RangeInclusive;

/// Cost of a piece as small as a dot for the name of a letter or a figure, and for any other name: commas are small.
const SIZE: (f64, f64) = (1.2, 0.5);
/// Cost of a speck, or of a dot without signs beside a letter, for the name of what is larger: more than that of a
/// name without a letter and of a part together.
const SLIGHT: f64 = 3.5;
/// Cost of a letter without the dots that its name has, and of one with signs where its name has none.
const SIGNS: (f64, f64) = (0.6, 0.3);
/// Cost of a part that lies by a usual letter's size away from its body.
const OFF: f64 = 0.5;
/// Cost of a piece as large as a letter that is a part of one.
const PART: f64 = 0.5;
/// Cost of a piece of dirt: more than that of a part of a letter.
const DIRT: f64 = 0.8;
/// Cost of a letter without a name, and of a name without a letter: more than that of any one letter that looks odd, so that pages whose
/// names agree are never refused for one, and less than that of a row whose letters all have their neighbours' names.
const UNMATCHED: f64 = 2.5;
/// Cost of a piece as wide as several letters for one name. It is less than that of a part as large as a letter: letters are not joined
/// for being wide.
const WIDE: f64 = 0.4;
/// Cost of a letter within the bounds of another one.
const WITHIN: f64 = 1.0;

/// Names are in doubt where another reading costs less than this more.
const DOUBT: f64 = 0.2;
/// A page's letters look like their names where each costs less than this in the mean: on 150 pages that are rightly read at most 0.31, where
/// each letter is drawn in a dozen pieces 1.0.
const UNLIKE: f64 = 0.6;

/// A name is in doubt, and one too many, where a page of a name fewer would be likelier by more than this: of 174 pages that are rightly read two
/// are by 0.9 and 1.0, and the next one by 0.6.
const SPARE: (f64, f64) = (0.7, 1.1);

/// What is seen of a piece.
#[derive(Debug, Clone, Copy)]
#[expect(
    clippy::struct_excessive_bools,
    reason = "observations, each by itself"
)]
pub(super) struct Seen {
    /// How much of a full letter it is by its size, 0 to 1.
    pub(super) full: f64,
    /// Whether it is less than a dot, or as small as one and beside a letter.
    pub(super) slight: bool,
    /// Whether smaller pieces lie over it.
    pub(super) above: bool,
    /// Whether smaller pieces lie below it.
    pub(super) below: bool,
    /// Whether smaller pieces lie within its bounds: dots of bowls do, whose letters have them on either side.
    pub(super) inside: bool,
    /// The larger piece that it may be a part of.
    pub(super) body: Option<Body>,
    /// Whether it lies within the bounds of its body.
    pub(super) within: bool,
    /// Whether it may be dirt.
    pub(super) dirt: bool,
    /// How many letters that touch each other it may be at most.
    pub(super) letters: usize,
}

/// A larger piece beside one.
#[derive(Debug, Clone, Copy)]
pub(super) struct Body {
    /// How far it is, in usual sizes.
    pub(super) off: f64,
    /// Whether it is read before its part.
    pub(super) before: bool,
    /// Whether its part lies over its middle.
    pub(super) above: bool,
}

/// What a piece is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Role {
    /// The letter of a name.
    Letter(usize),
    /// Letters that touch: the first one's name, and how many they are.
    Touching(usize, usize),
    /// A part of a letter beside it.
    Part,
    /// No ink of a letter's.
    Dirt,
    /// A letter without a name.
    Nameless,
}

/// A page as it is read.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    /// What each piece is.
    pub(super) roles: Vec<Role>,
    /// Names without a letter, in order, each with the number of pieces read before it.
    pub(super) missing: Vec<(usize, usize)>,
    /// The sum of all costs.
    pub(super) cost: f64,
    /// How much likelier this reading is than the best one in which a piece is something else, of each piece.
    pub(super) margins: Vec<f64>,
    /// The names without one of which it would be likeliest, and by how much likelier.
    spare: Option<(RangeInclusive<usize>, f64)>,
    /// The letters without one of which it would be likeliest: the first and the last piece.
    extra: Option<RangeInclusive<usize>>,
}

impl Reading {
    /// Whether all letters have names and all names letters, and most look like that.
    pub(super) fn agrees(&self) -> bool {
        let nameless = self.roles.contains(&Role::Nameless);
        self.missing.is_empty() && !nameless && !self.is_unlike()
    }

    /// The pieces from one to another of which one letter has no name, where that is all that does not agree.
    pub(super) fn nameless(&self) -> Option<RangeInclusive<usize>> {
        let nameless = self.roles.iter().filter(|r| **r == Role::Nameless).count();
        let only = nameless == 1 && self.missing.is_empty();
        self.extra.clone().filter(|_| only)
    }

    /// The names from one to another of which one has no letter, where that is all that does not agree.
    pub(super) fn letterless(&self) -> Option<RangeInclusive<usize>> {
        let only = self.missing.len() == 1 && !self.roles.contains(&Role::Nameless);
        self.spare.as_ref().filter(|_| only).map(|s| s.0.clone())
    }

    /// Whether its letters hardly look like their names.
    pub(super) fn is_unlike(&self) -> bool {
        let named = |r: &&Role| matches!(r, Role::Letter(_) | Role::Touching(..));
        let letters = self.roles.iter().filter(named).count();
        self.cost > UNLIKE * letters as f64
    }

    /// Names of which one seems to be too many, though a piece was found for each.
    pub(super) fn spare(&self) -> Option<RangeInclusive<usize>> {
        let spare = self.spare.as_ref().filter(|s| s.1 > SPARE.1);
        spare.map(|s| s.0.clone())
    }

    /// The names of which it is not much likelier that each is a letter's than that this is something else, or that there is none.
    pub(super) fn doubtful(&self) -> Vec<usize> {
        let doubtful = self.roles.iter().zip(&self.margins);
        let doubtful = doubtful.filter_map(|(role, margin)| match role {
            Role::Letter(k) if *margin < DOUBT => Some(*k),
            _ => None,
        });
        let spare = self.spare.as_ref().filter(|s| s.1 > SPARE.0);
        let spare = spare.map(|s| *s.0.start());
        doubtful.chain(spare).collect()
    }
}

/// A step of the path: a piece that is taken for something, or a name that is passed over.
#[derive(Debug, Clone, Copy)]
enum Step {
    Take(Role),
    Pass,
}

/// Costs of all beginnings: of so many pieces and so many names, and the last step of each.
struct Table {
    width: usize,
    cost: Vec<f64>,
    by: Vec<Step>,
}

impl Table {
    fn new(pieces: usize, names: usize) -> Self {
        let width = names + 1;
        let size = (pieces + 1) * width;
        let mut cost = vec![f64::INFINITY; size];
        cost[0] = 0.0;
        Self {
            width,
            cost,
            by: vec![Step::Pass; size],
        }
    }

    fn step(&mut self, (i, j): (usize, usize), step: Step, cost: f64) {
        let at = i * self.width + j;
        if cost < self.cost[at] {
            (self.cost[at], self.by[at]) = (cost, step);
        }
    }

    /// All steps to the last beginning, which is the whole.
    fn reading(&self, pieces: usize, names: usize) -> Reading {
        let (mut i, mut j) = (pieces, names);
        let (mut roles, mut missing) = (Vec::new(), Vec::new());
        while i > 0 || j > 0 {
            match self.by[i * self.width + j] {
                Step::Pass => {
                    j -= 1;
                    missing.push((j, i));
                }
                Step::Take(role) => {
                    i -= 1;
                    if let Role::Letter(k) | Role::Touching(k, _) = role {
                        j = k;
                    }
                    roles.push(role);
                }
            }
        }
        roles.reverse();
        missing.reverse();
        Reading {
            roles,
            missing,
            cost: self.cost.last().copied().unwrap_or(0.0),
            margins: Vec::new(),
            spare: None,
            extra: None,
        }
    }
}

/// Reads pieces and names together. A name is `None` where nothing at all is known of its letter.
pub(super) fn align(pieces: &[Seen], names: &[Option<Shape>]) -> Reading {
    let mut table = Table::new(pieces.len(), names.len());
    for i in 0..=pieces.len() {
        for j in 0..=names.len() {
            let here = table.cost[i * table.width + j];
            for (step, to, cost) in steps(pieces, names, (i, j)) {
                table.step(to, step, here + cost);
            }
        }
    }
    let mut reading = table.reading(pieces.len(), names.len());
    let rest = rest(pieces, names);
    reading.margins = margins((pieces, names), &table, &rest, &reading);
    let free = |at: usize, behind: usize| reading.cost - table.cost[at] - rest[behind];
    let width = table.width;
    let without_name = |j: usize| {
        let all = (0..=pieces.len()).map(|i| free(i * width + j, i * width + j + 1));
        (j, all.fold(f64::NEG_INFINITY, f64::max))
    };
    let without_letter = |i: usize| {
        let all = (0..width).map(|j| free(i * width + j, (i + 1) * width + j));
        (i, all.fold(f64::NEG_INFINITY, f64::max))
    };
    let is_letter = |i: &usize| !matches!(reading.roles[*i], Role::Part | Role::Dirt);
    let spare = likeliest((0..names.len()).map(without_name));
    let extra = likeliest((0..pieces.len()).filter(is_letter).map(without_letter));
    (reading.spare, reading.extra) = (spare, extra.map(|e| e.0));
    reading
}

/// The run of what gains about as much as the best, from the first one on, and that gain.
fn likeliest(gains: impl Iterator<Item = (usize, f64)>) -> Option<(RangeInclusive<usize>, f64)> {
    let gains: Vec<(usize, f64)> = gains.collect();
    let best = gains.iter().map(|g| g.1).reduce(f64::max)?;
    let is_best = |g: &&(usize, f64)| g.1 > best - DOUBT;
    let run = gains.iter().skip_while(|g| !is_best(g)).take_while(is_best);
    let (first, last) = (run.clone().next()?.0, run.last()?.0);
    Some((first..=last, best))
}

/// Costs of all ends, behind so many pieces and so many names.
fn rest(pieces: &[Seen], names: &[Option<Shape>]) -> Vec<f64> {
    let width = names.len() + 1;
    let mut rest = vec![f64::INFINITY; (pieces.len() + 1) * width];
    if let Some(last) = rest.last_mut() {
        *last = 0.0;
    }
    for i in (0..=pieces.len()).rev() {
        for j in (0..=names.len()).rev() {
            let behind =
                |(_, to, cost): (Step, (usize, usize), f64)| cost + rest[to.0 * width + to.1];
            let least = steps(pieces, names, (i, j)).map(behind).reduce(f64::min);
            let at = i * width + j;
            rest[at] = least.map_or(rest[at], |least| least.min(rest[at]));
        }
    }
    rest
}

/// By how much each piece's role makes the reading likelier than the best one in which it is something else.
fn margins(
    (pieces, names): (&[Seen], &[Option<Shape>]),
    table: &Table,
    rest: &[f64],
    reading: &Reading,
) -> Vec<f64> {
    let width = table.width;
    let mut margins = vec![f64::INFINITY; pieces.len()];
    for (i, margin) in margins.iter_mut().enumerate() {
        for j in 0..=names.len() {
            let others = steps(pieces, names, (i, j));
            let others =
                others.filter(|s| matches!(s.0, Step::Take(role) if role != reading.roles[i]));
            let more = others.map(|(_, to, cost)| {
                table.cost[i * width + j] + cost + rest[to.0 * width + to.1] - reading.cost
            });
            *margin = more.fold(*margin, f64::min);
        }
    }
    margins
}

/// The steps from a beginning of so many pieces and names, where each leads, and what it costs.
fn steps<'a>(
    pieces: &'a [Seen],
    names: &'a [Option<Shape>],
    (i, j): (usize, usize),
) -> impl Iterator<Item = (Step, (usize, usize), f64)> + 'a {
    let pass = (j < names.len()).then_some((Step::Pass, (i, j + 1), UNMATCHED));
    let take = pieces.get(i).into_iter().flat_map(move |piece| {
        let letter = names.get(j).map(|name| {
            let cost = name.map_or(0.0, |shape| misfit(piece, &shape));
            (Role::Letter(j), 1, cost + odd(piece))
        });
        let touching = 2..=piece.letters.min(names.len() - j);
        let touching = touching.map(move |n| (Role::Touching(j, n), n, 0.0));
        let others = nameless(piece, names, j).map(|(role, cost)| (role, 0, cost));
        letter.into_iter().chain(touching).chain(others)
    });
    let take = take.map(move |(role, n, cost)| (Step::Take(role), (i + 1, j + n), cost));
    pass.into_iter().chain(take)
}

/// What a piece can be but the letter of a name, where `j` names are read, with the costs.
fn nameless(piece: &Seen, names: &[Option<Shape>], j: usize) -> impl Iterator<Item = (Role, f64)> {
    let part = piece.body.map(|body| {
        let name = if body.before {
            j.checked_sub(1)
        } else {
            Some(j)
        };
        let name = name.and_then(|k| names.get(k)).and_then(Option::as_ref);
        let wish = name.map_or(0.0, |shape| unwanted(shape, body.above));
        let sign = (1.0 - piece.full) * wish;
        let large = if piece.within { 0.0 } else { piece.full };
        (Role::Part, OFF * body.off + PART * large + sign)
    });
    let dirt = piece.dirt.then_some((Role::Dirt, DIRT));
    let extra = (Role::Nameless, UNMATCHED);
    part.into_iter().chain(dirt).chain([extra])
}

/// How unlikely a piece is one letter, whatever its name.
fn odd(piece: &Seen) -> f64 {
    let wide = if piece.letters > 1 { WIDE } else { 0.0 };
    let within = if piece.within { WITHIN } else { 0.0 };
    wide + within
}

/// Whether a name's letter is larger than a dot: all letters and figures, what has a dot itself, and ampersands.
fn is_large(shape: &Shape) -> bool {
    let dotted = matches!(
        shape.pieces,
        Pieces::DotAbove | Pieces::DotBelow | Pieces::Marked
    );
    shape.full || dotted || shape.foot != Foot::None
}

/// How badly a piece stands for a name.
fn misfit(piece: &Seen, shape: &Shape) -> f64 {
    let bare = !piece.above && !piece.below && !piece.inside;
    let size = if piece.slight && bare && is_large(shape) {
        SLIGHT
    } else if shape.full {
        SIZE.0
    } else {
        SIZE.1
    };
    let sign = |seen: bool, wanted: bool| match (seen, wanted) {
        (false, true) => SIGNS.0,
        (true, false) => SIGNS.1,
        _ => 0.0,
    };
    let signs = match shape.pieces {
        Pieces::One => sign(piece.above || piece.inside, false) + sign(piece.below, false),
        Pieces::DotAbove => sign(piece.above || piece.inside, true) + sign(piece.below, false),
        Pieces::DotBelow => sign(piece.above, false) + sign(piece.below || piece.inside, true),
        Pieces::Marked => sign(!bare, true),
        Pieces::Within | Pieces::Bare | Pieces::Unknown => 0.0,
    };
    size * (1.0 - piece.full) + signs
}

/// Cost of one more sign over or under a letter: less where its name has one there.
#[expect(
    clippy::fn_params_excessive_bools,
    reason = "the side of a sign, as seen"
)]
pub(super) fn unwanted(shape: &Shape, above: bool) -> f64 {
    match shape.pieces {
        Pieces::One | Pieces::Bare => SIGNS.1,
        Pieces::DotAbove if !above => SIGNS.1,
        Pieces::DotBelow if above => SIGNS.1,
        _ => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::Label;
    use glyphs_reader::glyphdata::GlyphData;

    fn shapes(names: &str) -> Vec<Option<Shape>> {
        let data = GlyphData::default();
        let shape = |n: &str| (n != "_").then(|| Shape::of(&Label(n.to_owned()), &data));
        names.split(' ').map(shape).collect()
    }

    fn letter() -> Seen {
        Seen {
            full: 1.0,
            slight: false,
            above: false,
            below: false,
            inside: false,
            body: None,
            within: false,
            dirt: false,
            letters: 1,
        }
    }

    /// A sign over the letter that is read before it, or after it.
    #[expect(clippy::fn_params_excessive_bools, reason = "as in `Body`")]
    fn sign(full: f64, before: bool) -> Seen {
        let body = Body {
            off: 0.2,
            before,
            above: true,
        };
        Seen {
            full,
            body: Some(body),
            ..letter()
        }
    }

    fn under_signs() -> Seen {
        Seen {
            above: true,
            ..letter()
        }
    }

    #[test]
    fn a_sign_is_a_part_and_a_small_letter_a_letter() {
        // alef with hamza, hamza, theh with three dots, one of them read first
        let pieces = [
            under_signs(),
            sign(0.4, true),
            Seen {
                full: 0.4,
                ..letter()
            },
            sign(0.0, false),
            under_signs(),
            sign(0.0, true),
            sign(0.0, true),
        ];
        let reading = align(&pieces, &shapes("uni0623 uni0621 uni062B"));
        let part = Role::Part;
        let want = [
            Role::Letter(0),
            part,
            Role::Letter(1),
            part,
            Role::Letter(2),
            part,
            part,
        ];
        assert_eq!(reading.roles, want);
        assert!(reading.agrees());
    }

    #[test]
    fn dirt_takes_no_name() {
        let mote = Seen {
            full: 0.0,
            dirt: true,
            ..letter()
        };
        let pieces = [mote, letter(), mote, letter(), mote];
        let reading = align(&pieces, &shapes("uni062F uni0631"));
        let want = [
            Role::Dirt,
            Role::Letter(0),
            Role::Dirt,
            Role::Letter(1),
            Role::Dirt,
        ];
        assert_eq!(reading.roles, want);
    }

    #[test]
    fn dots_say_where_a_name_was_forgotten() {
        // dal, noon, dal, noon, dal; the names lack the second dal
        let noon = under_signs();
        let pieces = [
            letter(),
            noon,
            sign(0.0, true),
            letter(),
            noon,
            sign(0.0, true),
            letter(),
        ];
        let reading = align(&pieces, &shapes("uni062F uni0646 uni0646 uni062F"));
        assert_eq!(reading.roles[3], Role::Nameless);
        assert!(reading.missing.is_empty() && !reading.agrees());
    }

    #[test]
    fn a_name_too_many_has_no_letter() {
        let reading = align(&[letter(); 3], &shapes("uni062F uni0631 uni062F uni0631"));
        assert_eq!(reading.missing.len(), 1);
        assert!(!reading.agrees());
    }

    #[test]
    fn a_sign_within_its_letter_takes_no_name() {
        // kaf with its sign, as large as a letter, and qaf; the names have a letter more
        let within = Seen {
            within: true,
            ..sign(1.0, true)
        };
        let pieces = [letter(), within, letter()];
        let reading = align(&pieces, &shapes("uni0643 uni0642"));
        assert_eq!(reading.roles[1], Role::Part);
        let reading = align(&pieces, &shapes("uni0643 uni062F uni062F"));
        assert!(reading.cost >= WITHIN);
    }

    #[test]
    fn a_wide_piece_has_the_names_of_letters_that_touch() {
        let wide = Seen {
            letters: 2,
            ..letter()
        };
        let pieces = [letter(), wide, letter()];
        let roles = |names: &str| align(&pieces, &shapes(names)).roles;
        let touching = [Role::Letter(0), Role::Touching(1, 2), Role::Letter(3)];
        assert_eq!(roles("uni062F uni0631 uni062F uni0631"), touching);
        let single = [Role::Letter(0), Role::Letter(1), Role::Letter(2)];
        assert_eq!(roles("uni062F uni0631 uni062F"), single);
    }

    #[test]
    fn names_that_fit_two_letters_alike_are_in_doubt() {
        // one of the last two is a part of the other, and nothing tells which
        let part = |before| Seen {
            above: true,
            ..sign(1.0, before)
        };
        let pieces = [letter(), part(false), part(true)];
        let reading = align(&pieces, &shapes("uni062F uni0646"));
        assert!(reading.agrees());
        assert_eq!(reading.doubtful(), [1]);
        assert!(
            align(&[letter(); 2], &shapes("uni062F uni0631"))
                .doubtful()
                .is_empty()
        );
    }

    #[test]
    fn letters_that_look_like_none_of_their_names_do_not_agree() {
        let pieces = [Seen {
            full: 0.3,
            ..letter()
        }; 4];
        let reading = align(&pieces, &shapes("uni0646 uni062E uni0634 uni0646"));
        assert!(reading.missing.is_empty() && !reading.agrees());
        assert!(align(&[letter(); 4], &shapes("uni0646 uni062E uni0634 uni0646")).agrees());
    }

    #[test]
    fn a_dot_beside_a_letter_has_no_letters_name() {
        // noon and its dot, dal; the names have a letter more
        let dot = Seen {
            slight: true,
            ..sign(0.0, true)
        };
        let pieces = [under_signs(), dot, letter()];
        let reading = align(&pieces, &shapes("uni0646 uni0645 uni062F"));
        assert_eq!(reading.roles[1], Role::Part);
        assert_eq!(reading.missing.len(), 1);
        // a comma is as small
        let comma = align(&[letter(), dot], &shapes("uni062F uni060C"));
        assert_eq!(comma.roles[1], Role::Letter(1));
    }

    #[test]
    fn a_name_without_which_the_page_is_likelier_is_spare() {
        // theh, a dot of its three that lies below another one, dal
        let dot = Seen {
            above: true,
            body: Some(Body {
                off: 0.0,
                before: true,
                above: true,
            }),
            ..sign(0.0, true)
        };
        let pieces = [under_signs(), dot, letter()];
        let reading = align(&pieces, &shapes("uni062B uni0645 uni062F"));
        assert!(reading.agrees());
        // the last letter may be a meem as well
        assert_eq!(reading.spare(), Some(1..=2));
        assert_eq!(align(&pieces, &shapes("uni062B uni062F")).spare(), None);
        // a letter of its own is as likely as none
        let reading = align(&[letter(); 3], &shapes("uni062F uni0631 uni062F"));
        assert_eq!(reading.spare(), None);
    }

    #[test]
    fn a_dot_within_its_letter_is_on_either_side() {
        let within = Seen {
            inside: true,
            ..letter()
        };
        let cost = |name: &str| misfit(&within, &shapes(name)[0].unwrap());
        assert!(cost("uni062C") + cost("uni062E") < 1e-9);
        assert!(cost("uni062D") > 0.0);
    }

    #[test]
    fn nothing_is_read_as_nothing() {
        assert_eq!(align(&[], &[]).roles, []);
        assert_eq!(align(&[], &shapes("a b")).missing, [(0, 0), (1, 0)]);
        assert_eq!(align(&[letter()], &[]).roles, [Role::Nameless]);
    }
}
