//! What it costs to take a piece for something: how badly a letter stands for its name.

use super::{Names, Role, Seen, Side};
use crate::scan::letters::{Foot, Pieces, Shape};

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
/// Cost of a letter without a name, and of a name without a letter: more than that of any one letter that looks odd,
/// so that pages whose names agree are never refused for one, and less than that of a row whose letters all have
/// their neighbours' names.
const UNMATCHED: f64 = 2.5;
/// Cost of a row whose first letter does not have the first name of a line, where lines are taken for rows: as much as
/// that of the letter or the name by which they would agree.
const ASTRAY: f64 = UNMATCHED;
/// Cost of a piece as wide as several letters for one name. It is less than that of a part as large as a letter:
/// letters are not joined for being wide.
const WIDE: f64 = 0.4;
/// Cost of a letter within the bounds of another one.
pub(super) const WITHIN: f64 = 1.0;

/// A step of the path: a piece that is taken for something, or a name that is passed over.
#[derive(Debug, Clone, Copy)]
pub(super) enum Step {
    Take(Role),
    Pass,
}

/// The steps from a beginning of so many pieces and names, where each leads, and what it costs.
pub(super) fn steps<'a>(
    pieces: &'a [Seen],
    names: Names<'a>,
    (i, j): (usize, usize),
) -> impl Iterator<Item = (Step, (usize, usize), f64)> + 'a {
    let shapes = names.shapes;
    let pass = (j < shapes.len()).then_some((Step::Pass, (i, j + 1), UNMATCHED));
    let take = pieces.get(i).into_iter().flat_map(move |piece| {
        let astray = if piece.first && !names.begins(j) {
            ASTRAY
        } else {
            0.0
        };
        let letter = shapes.get(j).map(|name| {
            let cost = name.map_or(0.0, |shape| misfit(piece, &shape));
            (Role::Letter(j), 1, cost + odd(piece))
        });
        let touching = 2..=piece.letters.min(shapes.len() - j);
        let touching = touching.map(move |n| (Role::Touching(j, n), n, 0.0));
        let others = nameless(piece, shapes, j).map(|(role, cost)| (role, 0, cost));
        let all = letter.into_iter().chain(touching).chain(others);
        all.map(move |(role, n, cost)| (role, n, cost + astray))
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
        let wish = name.map_or(0.0, |shape| unwanted(shape, body.sign));
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
pub(super) fn misfit(piece: &Seen, shape: &Shape) -> f64 {
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
pub(in crate::scan::cut::layout) fn unwanted(shape: &Shape, sign: Side) -> f64 {
    match (shape.pieces, sign) {
        (Pieces::One | Pieces::Bare, _) => SIGNS.1,
        (Pieces::DotAbove, Side::Under) | (Pieces::DotBelow, Side::Over) => SIGNS.1,
        _ => 0.0,
    }
}
