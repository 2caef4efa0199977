//! Joining: the strokes of all joined letters meet at one height, in one thickness.
//!
//! Every form that joins is measured where its stroke ends: lower and upper edge a little inside the
//! tip, where the end's roundness is over. The font's *contract* is the median of both edges over all
//! of them, and the stroke is shifted smoothly onto it, near its end only. The measured line is the end of
//! the advance. The drawn tip reaches across it into the next letter's stroke; where it is shorter than
//! half the overlap, it is replaced by a square tab of that length. So at every join two strokes lie over
//! each other with the same edges: no gap, and no step beyond what an end was too far away to be moved.
//!
//! Many styles draw no stroke where a letter's body itself can be met: a stem, a bow, a tooth. Such a body stays as
//! it was drawn; the advance ends at its edge, and the next letter's stroke runs into it.
//!
//! Slanted and Nastaliq styles join at many heights, which the drawings tell. There strokes stay as they were drawn,
//! and the middle of each end becomes a cursive anchor (`entry`, `exit`): text programs shift letters until the ends
//! of two meet.

use super::stroke::{self, Edges, End, OPENING, Side, Tab, Warp};
use super::{Draft, Note};
use crate::numeric::median::middle;
use crate::types::Outline;
use kurbo::{BezPath, Shape};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the strokes of two letters come together.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// As strokes were drawn: cursive where too many miss the contract.
    #[default]
    Auto,
    /// Strokes are moved onto one contract.
    Contract,
    /// Strokes stay, letters carry cursive anchors (`curs`).
    Cursive,
}

/// How joins are made. Lengths are parts of the em.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Options {
    /// Whether strokes are moved or letters.
    pub method: Method,
    /// How far the strokes of two joined letters overlap.
    #[serde(deserialize_with = "super::ranges::share")]
    pub overlap: f64,
    /// How far an edge may be moved to meet the others.
    #[serde(deserialize_with = "super::ranges::share")]
    pub limit: f64,
    /// How far into the letter a moved end is felt.
    #[serde(deserialize_with = "super::ranges::share")]
    pub reach: f64,
    /// Lower and upper edge of every joining stroke; without it, the median of what was drawn.
    #[serde(deserialize_with = "super::ranges::edges")]
    pub edges: Option<(f64, f64)>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            method: Method::default(),
            overlap: 0.02,
            limit: 0.03,
            reach: 0.15,
            edges: None,
        }
    }
}

/// Least depth inside the tip at which a stroke is measured and cut, em: beyond the roundness that ink
/// and blur give a square end.
const DEPTH: f64 = 0.012;

/// Thinnest and thickest stroke that can be a joining one, em.
const THICKNESS: (f64, f64) = (0.008, 0.3);

/// The most that an edge's slope is changed: a sixth of a right angle. A stroke that runs on more
/// steeply than that is no end but a bend.
const MOST_SHEAR: f64 = 0.27;

/// How far an ink's end may lie from the whole letter's and still be the same, em.
const SAME: f64 = 0.01;

/// How many times as thick as the others, or as thin, a joining stroke is at most, and the least part of it that lies
/// at their height. What is unlike them and has ink at all of their height is a body.
const THICKER: f64 = 1.75;
const COMMON: f64 = 1.0 / 3.0;

/// A style joins at many heights where more than the first share of its joins cannot be brought to one, and more than
/// the second have their letter's outermost ink elsewhere. Of 150 pages those of six nastaliq, ruqaa and slanted
/// styles have either at least 0.22 and 0.2 or 0.06 and 0.47; all others have at most 0.17, or 0.01 where the second
/// share is more than 0.3. Of 123 pages more two of letters woven into their neighbours pass for such styles.
const MANY: [(f64, f64); 2] = [(0.2, 0.0), (0.03, 0.3)];
/// Joins that tell it, at least.
const FEWEST: usize = 12;

/// How far before a tip its own ink may lie, part of the depth: a tip is the outermost of samples.
const SAME_TIP: f64 = 0.1;

/// Rounds in which the choice of ends and their median settle: they did in two on every font seen.
const ROUNDS: u32 = 4;

/// One join of one glyph, font units.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Join {
    /// The glyph.
    pub glyph: String,
    /// The side that joins.
    pub side: Side,
    /// Where the advance ends: x in the drawn shape.
    pub x: f64,
    /// Lower and upper edge as drawn.
    pub drawn: (f64, f64),
    /// How far the two edges were moved.
    pub moved: (f64, f64),
}

/// How all joining strokes meet.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Contract {
    /// Lower and upper edge at the join, font units.
    pub edges: (f64, f64),
    /// How the two edges run through it, dy/dx.
    pub slopes: (f64, f64),
}

/// What joining did.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Report {
    /// What the ends were brought to; none where nothing joins.
    pub contract: Option<Contract>,
    /// Every join, in glyph order.
    pub joins: Vec<Join>,
}

/// A side of a draft that joins, with the ends it could be.
struct Joint {
    draft: usize,
    side: Side,
    ends: Vec<End>,
    /// Of each contour, how large its box is. All but the largest are dots and signs, or parts of a letter in pieces.
    sizes: Vec<f64>,
    chosen: Option<usize>,
}

impl Joint {
    fn end(&self) -> Option<&End> {
        self.ends.get(self.chosen?)
    }

    /// Takes the end nearest to these edges; one that lies further in counts as further away, and one of a contour
    /// that is not the body is none beside them.
    fn choose(&mut self, (low, high): (f64, f64)) {
        let outermost = self
            .ends
            .iter()
            .map(|e| e.tip)
            .fold(f64::INFINITY, f64::min);
        let distance = |e: &End| {
            (e.edges.0 - low).abs() + (e.edges.1 - high).abs() + 0.5 * (e.tip - outermost)
        };
        let largest = self.sizes.iter().copied().fold(0.0, f64::max);
        let is_stroke =
            |e: &End| self.sizes[e.contour] >= largest || (e.edges.0 < high && e.edges.1 > low);
        let strokes = (0..).zip(&self.ends).filter(|(_, e)| is_stroke(e));
        let best = strokes.min_by(|a, b| distance(a.1).total_cmp(&distance(b.1)));
        self.chosen = best.map(|(i, _)| i);
    }

    /// How far it lies above these edges.
    fn height(&self, draft: &Draft, edges: Edges) -> Height {
        let middle = |(low, high): Edges| f64::midpoint(low, high);
        let above = |end: &End| middle(end.edges) - middle(edges);
        let told = self.end().filter(|_| met(draft, self, edges).is_none());
        let largest = self.sizes.iter().copied().fold(0.0, f64::max);
        let is_stroke =
            |e: &&End| self.sizes[e.contour] >= largest && thicker(e.edges, edges) < THICKER;
        let may_be = self.ends.iter().filter(is_stroke).map(above);
        Height {
            told: told.map(above),
            may_be: may_be.filter(|_| told.is_none()).collect(),
        }
    }

    /// Takes the outermost end of the body, or of the largest contour that has one.
    fn choose_outermost(&mut self) {
        let largest = self.ends.iter().map(|e| self.sizes[e.contour]);
        let largest = largest.fold(0.0, f64::max);
        let is_body = |e: &End| self.sizes[e.contour] >= largest;
        self.chosen = self.ends.iter().position(is_body);
    }
}

/// Joins the drafts: their outlines and, on joined sides, the ends of their advances.
pub(super) fn set(drafts: &mut [Draft], em: f64, options: &Options) -> (Report, Vec<Note>) {
    let (method, mut notes) = settled(drafts, em, options);
    let options = &Options {
        method,
        ..options.clone()
    };
    let mut joints = joints(drafts, em, options.method);
    let contract = contract(&mut joints, em, options);
    let cursive = options.method == Method::Cursive;
    if cursive {
        joints.iter_mut().for_each(Joint::choose_outermost);
    }
    let from_beside = coming(&joints);
    joints.retain(|joint| {
        let Some(draft) = drafts.get_mut(joint.draft) else {
            return false;
        };
        let edges = if cursive {
            from_beside(joint.side).filter(|_| joint.end().is_none())
        } else {
            contract.map(|c| c.edges)
        };
        let x = edges.and_then(|edges| met(draft, joint, edges));
        let height = edges.filter(|_| cursive && x.is_some());
        let height = height.map(|(low, high)| f64::midpoint(low, high));
        match joint.side {
            Side::Left => (draft.joint.0, draft.cursive.0) = (x, height),
            Side::Right => (draft.joint.1, draft.cursive.1) = (x, height),
        }
        if x.is_none() && joint.end().is_none() {
            notes.push(no_stroke(draft, joint.side));
        }
        x.is_none() && joint.end().is_some()
    });
    let Some(contract) = contract else {
        return (Report::default(), notes);
    };
    let mut report = Report {
        contract: Some(contract),
        joins: Vec::new(),
    };
    for joint in &joints {
        let (Some(draft), Some(end)) = (drafts.get_mut(joint.draft), joint.end()) else {
            continue;
        };
        // the other side of this draft may have been cut already: measure again where it now is
        let now = stroke::ends(draft.outline.contours(), joint.side, DEPTH * em);
        let same = |e: &&End| {
            (e.tip - end.tip).abs() < 1e-3 && (e.edges.0 - end.edges.0).abs() < 0.01 * em
        };
        let Some(end) = now.iter().find(same) else {
            continue;
        };
        let (join, note) = join(
            draft,
            joint.side,
            end,
            Terms {
                contract,
                em,
                options,
            },
        );
        notes.extend(note);
        report.joins.push(join);
    }
    (report, notes)
}

/// The method that the options say, or the drawings where these leave it to them.
pub(super) fn settled(drafts: &[Draft], em: f64, options: &Options) -> (Method, Vec<Note>) {
    if options.method != Method::Auto {
        return (options.method, Vec::new());
    }
    let mut joints = joints(drafts, em, Method::Contract);
    let edges = contract(&mut joints, em, options).map(|c| c.edges);
    let Some((low, high)) = edges.filter(|_| options.edges.is_none() && joints.len() >= FEWEST)
    else {
        return (Method::Contract, Vec::new());
    };
    let limit = options.limit * em;
    let is_missed = |joint: &&Joint| {
        let far = |end: &End| (end.edges.0 - low).abs().max((end.edges.1 - high).abs()) > limit;
        let draft = drafts.get(joint.draft);
        let met = draft.and_then(|draft| met(draft, joint, (low, high)));
        met.is_none() && joint.end().is_none_or(far)
    };
    let missed: Vec<&Joint> = joints.iter().filter(is_missed).collect();
    let mut outermost = self::joints(drafts, em, Method::Cursive);
    outermost.iter_mut().for_each(Joint::choose_outermost);
    let is_off = |joint: &&Joint| {
        let end = joint.end();
        end.is_none_or(|end| end.edges.0 > high || end.edges.1 < low)
    };
    let off = outermost.iter().filter(is_off).count();
    let share = |count: usize| count as f64 / joints.len() as f64;
    let (missing, off) = (share(missed.len()), share(off));
    if MANY
        .iter()
        .all(|(most, elsewhere)| missing <= *most || off <= *elsewhere)
    {
        return (Method::Contract, Vec::new());
    }
    let first = missed.first().and_then(|joint| drafts.get(joint.draft));
    let note = first.map(|draft| Note {
        glyph: draft.id.name.to_string(),
        message: format!(
            "with it {} of {} joins cannot be brought to one height, so all letters are joined by cursive anchors, as slanted styles are; \
                `[spacing.joining] method` says which way",
            missed.len(),
            joints.len()
        ),
    });
    (Method::Cursive, note.into_iter().collect())
}

/// How far the middle of a draft's joining stroke lies above the contract's on one side, font units.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Height {
    /// The stroke's; none where no stroke leaves it, or where its body can be met by the next letter's.
    pub(super) told: Option<f64>,
    /// Where nothing is told: of all ends of the body that are as thick as a stroke.
    pub(super) may_be: Vec<f64>,
}

/// The heights of every draft's joining strokes, left and right.
pub(super) fn heights(drafts: &[Draft], em: f64, options: &Options) -> Vec<[Height; 2]> {
    let mut joints = joints(drafts, em, options.method);
    let mut heights = vec![<[Height; 2]>::default(); drafts.len()];
    let Some(contract) = contract(&mut joints, em, options) else {
        return heights;
    };
    for joint in &joints {
        let drawn = drafts.get(joint.draft).zip(heights.get_mut(joint.draft));
        let Some((draft, [left, right])) = drawn else {
            continue;
        };
        let height = match joint.side {
            Side::Left => left,
            Side::Right => right,
        };
        *height = joint.height(draft, contract.edges);
    }
    heights
}

fn joints(drafts: &[Draft], em: f64, method: Method) -> Vec<Joint> {
    let mut out = Vec::new();
    for (draft, d) in drafts.iter().enumerate() {
        let Some(form) = d.id.form() else { continue };
        let contours = d.outline.contours();
        let size = |contour: &BezPath| contour.bounding_box().area();
        let sizes: Vec<f64> = contours.iter().map(size).collect();
        for (side, joined) in [
            (Side::Left, form.joins_after()),
            (Side::Right, form.joins_before()),
        ] {
            if !joined {
                continue;
            }
            // slanted styles run steeply and cross their own bodies' heights
            let leaves = |e: &End| method == Method::Cursive || leaves(e, contours, side);
            let is_stroke = |e: &End| {
                (THICKNESS.0 * em..THICKNESS.1 * em).contains(&(e.edges.1 - e.edges.0)) && leaves(e)
            };
            let mut ends = stroke::ends(contours, side, DEPTH * em);
            ends.retain(is_stroke);
            ends.sort_by(|a, b| a.tip.total_cmp(&b.tip));
            out.push(Joint {
                draft,
                side,
                ends,
                sizes: sizes.clone(),
                chosen: Some(0),
            });
        }
    }
    out
}

/// Whether a stroke leaves a letter there: it does not open like a bow, and no ink of its contour lies before it, so
/// that the next letter's stroke can reach it.
fn leaves(end: &End, contours: &[BezPath], side: Side) -> bool {
    let opening = side.inward(end.slopes.1 - end.slopes.0);
    let own = contours.get(end.contour..=end.contour).unwrap_or(&[]);
    let first = stroke::face(own, side, end.edges);
    opening < OPENING
        && first.is_some_and(|(first, _)| first > end.tip - SAME_TIP * (end.cut - end.tip))
}

/// Where the advance ends of a letter whose body the strokes of this height meet; none where a stroke leaves it, or
/// where it has no ink at that height.
fn met(draft: &Draft, joint: &Joint, (low, high): Edges) -> Option<f64> {
    let thick = high - low;
    let (first, last) = stroke::face(draft.outline.contours(), joint.side, (low, high))?;
    let is_body = joint.end().is_none_or(|end| {
        let (from, to) = end.edges;
        let common = to.min(high) - from.max(low);
        let alike =
            thicker(end.edges, (low, high)) < THICKER && common > COMMON * (to - from).min(thick);
        !alike && last - first < thick
    });
    // what stands out before the last of its ink lies within the next letter's stroke
    is_body.then(|| joint.side.inward(last.min(first + thick)))
}

/// How many times as thick the thicker of two strokes is.
fn thicker(one: Edges, other: Edges) -> f64 {
    let (one, other) = (one.1 - one.0, other.1 - other.0);
    one.max(other) / one.min(other)
}

fn no_stroke(draft: &Draft, side: Side) -> Note {
    Note {
        glyph: draft.id.name.to_string(),
        message: format!(
            "no stroke leaves it on the {} side, where it joins; draw the stroke out to the edge",
            match side {
                Side::Left => "left",
                Side::Right => "right",
            }
        ),
    }
}

/// The edges that all are to meet, and with them each joint's end. The outermost ends say first what
/// is usual; then each joint takes the end that is most like it.
fn contract(joints: &mut [Joint], em: f64, options: &Options) -> Option<Contract> {
    let given = options.edges.map(|(low, high)| (low * em, high * em));
    let edges = |joints: &[Joint]| {
        given.or_else(|| median(&joints.iter().collect::<Vec<_>>(), |e| e.edges))
    };
    let mut usual = edges(joints)?;
    for _ in 0..ROUNDS {
        for joint in joints.iter_mut() {
            joint.choose(usual);
        }
        usual = edges(joints)?;
    }
    // what is left of the ends' roundness leans the other way on the other side
    let slopes = [Side::Left, Side::Right].map(|side| {
        let of_side: Vec<&Joint> = joints.iter().filter(|j| j.side == side).collect();
        median(&of_side, |e| e.slopes).unwrap_or_default()
    });
    let slopes = (
        0.5 * (slopes[0].0 + slopes[1].0),
        0.5 * (slopes[0].1 + slopes[1].1),
    );
    Some(Contract {
        edges: (usual.0.round(), usual.1.round()),
        slopes,
    })
}

fn median(joints: &[&Joint], of: impl Fn(&End) -> Edges) -> Option<Edges> {
    let ends = || joints.iter().filter_map(|j| j.end()).map(&of);
    Some((
        middle(ends().map(|e| e.0), f64::total_cmp)?,
        middle(ends().map(|e| e.1), f64::total_cmp)?,
    ))
}

/// The edges of the strokes that come to a side of letters from beside, where each ends at its own height: the median
/// of the ends on other letters' opposite sides.
fn coming(joints: &[Joint]) -> impl Fn(Side) -> Option<Edges> + use<> {
    let opposite = |side: Side| {
        let others: Vec<&Joint> = joints.iter().filter(|j| j.side != side).collect();
        median(&others, |e| e.edges)
    };
    let (left, right) = (opposite(Side::Left), opposite(Side::Right));
    move |side| match side {
        Side::Left => left,
        Side::Right => right,
    }
}

/// What every end is brought to.
#[derive(Clone, Copy)]
struct Terms<'a> {
    contract: Contract,
    em: f64,
    options: &'a Options,
}

/// Whether an end of one ink is that end of the whole letter.
fn is_one(plate: &End, whole: &End, em: f64) -> bool {
    let near = |a: f64, b: f64| (a - b).abs() < SAME * em;
    near(plate.tip, whole.tip)
        && near(plate.edges.0, whole.edges.0)
        && near(plate.edges.1, whole.edges.1)
}

/// Cuts and moves one end; says so where the contract is out of reach.
fn join(draft: &mut Draft, side: Side, end: &End, terms: Terms<'_>) -> (Join, Option<Note>) {
    let (em, options) = (terms.em, terms.options);
    let limit = options.limit * em;
    let Contract { edges, slopes } = match options.method {
        Method::Auto | Method::Contract => terms.contract,
        Method::Cursive => Contract {
            edges: end.edges,
            slopes: end.slopes,
        },
    };
    let wanted = (edges.0 - end.edges.0, edges.1 - end.edges.1);
    let shifts = (wanted.0.clamp(-limit, limit), wanted.1.clamp(-limit, limit));
    let shear = |want: f64, have: f64| (want - have).clamp(-MOST_SHEAR, MOST_SHEAR);
    let shears = (shear(slopes.0, end.slopes.0), shear(slopes.1, end.slopes.1));
    let reach = options.reach * em;
    let warp = Warp {
        side,
        cut: end.cut,
        reach,
        edges: end.edges,
        shifts,
        shears,
    };
    let tab = Tab {
        length: 0.5 * options.overlap * em,
        slopes,
    };
    let moved = |outline: &Outline, end: Option<&End>| {
        let contours = outline.contours().iter().enumerate();
        let contours = contours.map(|(i, path)| {
            let end = end.filter(|end| i == end.contour && end.cut - end.tip < tab.length);
            let cut = end.and_then(|end| stroke::square(path, end, side, tab));
            warp.contour(cut.as_ref().unwrap_or(path))
        });
        Outline::new(contours.collect())
    };
    for (_, plate) in &mut draft.plates {
        let ends = stroke::ends(plate.contours(), side, DEPTH * em);
        let own = ends.iter().find(|e| is_one(e, end, em));
        if let Ok(outline) = moved(plate, own) {
            *plate = outline;
        }
    }
    if let Ok(outline) = moved(&draft.outline, Some(end)) {
        draft.outline = outline;
    }
    let x = side.inward(end.cut);
    let height = (options.method == Method::Cursive).then_some(0.5 * (edges.0 + edges.1));
    match side {
        Side::Left => (draft.joint.0, draft.cursive.0) = (Some(x), height),
        Side::Right => (draft.joint.1, draft.cursive.1) = (Some(x), height),
    }
    let missed = (wanted.0 - shifts.0).abs().max((wanted.1 - shifts.1).abs());
    let note = (missed > 1.0).then(|| Note {
        glyph: draft.id.name.to_string(),
        message: format!(
            "its joining stroke runs from {:.0} to {:.0}, the others from {:.0} to {:.0}: a step of {missed:.0} units stays; redraw it or raise the limit",
            end.edges.0, end.edges.1, edges.0, edges.1
        ),
    });
    let glyph = draft.id.name.to_string();
    (
        Join {
            glyph,
            side,
            x,
            drawn: end.edges,
            moved: shifts,
        },
        note,
    )
}
