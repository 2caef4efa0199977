//! Letters in rows on a bare page.
//!
//! Ink that is surely one makes a piece (`pieces`), pieces are read in rows, and one choice for the whole page says
//! which of them are letters, parts of letters or dirt, so that letters and names agree (`reading`).

mod doubts;
mod lines;
mod nearest;
mod order;
mod pieces;
mod reading;

use super::rows::{lies_over, nearest, rows};
use super::ruling;
use super::touching::Touch;
use super::{Task, listed};
use crate::numeric::median::{median, weighted};
use crate::scan::components::Component;
use crate::scan::cut::sieve::{LATTICE_COVER, stroke_width};
use crate::scan::cut::{self, Layer, Levels, Reason, Slot};
use crate::scan::error::Fault;
use crate::scan::letters::{Pieces, Shape};
use crate::scan::options::Order;
use crate::types::{Direction, Label};
use doubts::Unread;
use kurbo::Rect;
use lines::Lines;
use nearest::{Gathered, gather};
use order::{Close, across, in_rows};
use pieces::{Joined, Piece, Tie, Usual, pieces, ties};
use reading::Names;
use std::ops::RangeInclusive;

/// Thickness of a ruled line or a piece of it at most, as a share of its length.
const LINE_SHAPE: f64 = 0.06;
/// A letter's box holds the centres of so many pieces at most: its own and those of its dots.
const FEW: usize = 5;
/// Length of a piece of a ruled line at least, in usual letters' heights: a dash is shorter.
const LINE_LENGTH: f64 = 1.5;
/// Thickness of a faint line's scraps at most, in the page's stroke widths, and their length at least, in
/// usual letters' heights.
const SCRAP: (f64, f64) = (0.2, 0.3);
/// Strokes of a label or a guide at most, in the page's stroke widths, where they are told from letters.
const THIN: f64 = 0.4;
/// Pieces of such thin ink at least, for each name: labels stand beside every letter.
const MANY: f64 = 0.5;
/// Where pieces had to be joined, labels are so many that without them the joined ones are fewer by this factor.
const FEWER: usize = 2;
/// Letters in pieces are not rightly read where more than this share of the ink is in none of them: 0.01 at most on
/// pages that are, 0.09 on one of stripes that is not. Lines of more letters' sizes than the second are rules, not
/// stripes of a letter.
const LEFT_OUT: f64 = 0.03;
const LONG: f64 = 2.0;
/// Pieces of less ink than this share of a usual letter's may be dirt, and what is gathered of so little.
const DIRT: f64 = 0.06;

/// Letters of a piece of ink at most, in the mean, and products of pieces and names: reading takes time and 40 bytes
/// for every piece and every name.
const HELD: usize = 8;
const MOST: usize = 8_000_000;

/// Gathers the ink of a bare page into letters and names them. Letters that touch are cut apart in `all`, and those
/// that touch a printed lattice are cut free of it.
pub(super) fn place(
    all: &mut Vec<Component>,
    labels: &[Label],
    task: &Task<'_>,
) -> Result<Layer, Fault> {
    let claims = task.claims;
    let unclaimed = |index: &usize| claims.iter().all(|(c, _)| c != index);
    let names: Vec<usize> = (0..labels.len()).filter(unclaimed).collect();
    if names.len() > HELD * all.len() {
        return Err(Fault::FewPieces {
            pieces: all.len(),
            names: names.len(),
        });
    }
    let freed = lattices(all).into_iter();
    let freed = freed.flat_map(|i| ruling::freed(&all[i], task.upright));
    let freed: Vec<Component> = freed.collect();
    all.extend(freed);
    let known = |l: &&Label| l.0 != "_";
    let shape = |&i: &usize| Some(&labels[i]).filter(known).map(Shape::of);
    let shapes: Vec<Option<Shape>> = names.iter().map(shape).collect();
    let label = |k: usize| {
        let index = names.get(k).copied().unwrap_or_default();
        (labels.get(index).map_or("", |l| l.0.as_str()), index + 1)
    };
    let given = (names.len(), listed(task));
    let (read, parted) = read(all, &shapes, task).map_err(|unread| unread.error(given, label))?;
    let spare = read.spare.map(|s| [*s.start(), *s.end()].map(|k| names[k]));
    let doubtful = read.doubtful.iter().map(|&k| names[k]).collect();
    let mut names = names.into_iter();
    let rows = read.rows.into_iter();
    // a row's end takes no name of the next one
    let row = |row: Vec<Vec<usize>>| names.by_ref().take(row.len()).zip(row).collect();
    let mut rows: Vec<Row> = rows.map(row).collect();
    claims.iter().for_each(|c| seat(all, &mut rows, c));
    rows.sort_by_key(|row| row.iter().map(|l| l.0).min());
    let counts: Vec<usize> = rows.iter().map(Vec::len).collect();
    listed::check(&task.options.lines, (Order::Rows, &counts))?;
    // lines that are the page's rows say how many letters there are
    if let Some(among) = spare.filter(|_| task.options.lines != counts) {
        return Err(spare_name(labels, among));
    }
    let mut layer = layer(rows, labels);
    layer.rejected.extend(read.out);
    layer.parted = parted;
    layer.doubtful = doubtful;
    Ok(layer)
}

/// How many names stand in each line, where lines may be rows: one that lacks letters whose places are given says
/// nothing of its row.
fn listed<'a>(task: &Task<'a>) -> &'a [usize] {
    let lines = Some(task.options.lines.as_slice());
    lines.filter(|_| task.claims.is_empty()).unwrap_or_default()
}

fn spare_name(labels: &[Label], among: [usize; 2]) -> Fault {
    let name = |i: usize| format!("“{}” (number {})", labels[i].0, i + 1);
    let [first, last] = among;
    let among = if first == last {
        name(first)
    } else {
        format!("one of those from {} to {}", name(first), name(last))
    };
    Fault::SpareName {
        names: labels.len(),
        among,
    }
}

/// A page that was read, and which of its ink was cut off letters that it touched.
type Parted = (Read, Vec<usize>);

/// Reads a page as it is, or with letters of two rows that seem to touch cut apart, whichever is likelier.
fn read(
    all: &mut Vec<Component>,
    names: &[Option<Shape>],
    task: &Task<'_>,
) -> Result<Parted, Unread> {
    let across = Bare::new(all, &[], task).across(names);
    if across.is_empty() {
        return read_beside(all, Vec::new(), names, task);
    }
    let mut other = all.clone();
    let cut = across
        .iter()
        .flat_map(|t| t.part(&mut other, (task.gray(), task.upright)).pieces);
    let cut: Vec<usize> = cut.collect();
    let whole = read_beside(all, Vec::new(), names, task);
    match (whole, read_beside(&mut other, cut, names, task)) {
        (Ok(whole), Ok(parted)) if whole.0.rank() <= parted.0.rank() => Ok(whole),
        (_, Ok(parted)) => {
            *all = other;
            Ok(parted)
        }
        (whole, Err(_)) => whole,
    }
}

/// Reads a page, and again as long as there are letters of one row that touch and can be cut apart. `parted` is what
/// was cut apart before.
fn read_beside(
    all: &mut Vec<Component>,
    mut parted: Vec<usize>,
    names: &[Option<Shape>],
    task: &Task<'_>,
) -> Result<Parted, Unread> {
    loop {
        let unread = match Bare::new(all, &parted, task).letters(names) {
            Ok(read) => return Ok((read, parted)),
            Err(unread) => unread,
        };
        let before = parted.len();
        for touch in &unread.touching {
            parted.extend(touch.part(all, (task.gray(), task.upright)).pieces);
        }
        if parted.len() == before {
            return Err(unread);
        }
    }
}

/// The letters of a row, each the number of its name and its ink.
type Row = Vec<(usize, Vec<usize>)>;

/// Puts a letter whose place a user says into a row: that of the names before and after it, or the nearest in height,
/// or its own.
fn seat(all: &[Component], rows: &mut Vec<Row>, letter: &(usize, Vec<usize>)) {
    let holds = |row: &Row| {
        let beyond = |of: fn(&usize, &usize) -> bool| row.iter().any(|l| of(&l.0, &letter.0));
        beyond(usize::lt) && beyond(usize::gt)
    };
    let boxes = |row: &Row| row.iter().map(|l| bounds(all, &l.1)).collect();
    let among = rows.iter().position(holds).or_else(|| {
        let rows: Vec<Vec<Rect>> = rows.iter().map(boxes).collect();
        nearest(&rows, bounds(all, &letter.1))
    });
    match among {
        Some(row) => rows[row].push(letter.clone()),
        None => rows.push(vec![letter.clone()]),
    }
}

/// The slots of rows from the top.
fn layer(rows: Vec<Row>, labels: &[Label]) -> Layer {
    let count = rows.len();
    let (mut slots, mut rejected) = (Vec::new(), Vec::new());
    for (row, letters) in rows.into_iter().enumerate() {
        for (index, parts) in letters {
            match labels.get(index) {
                Some(label) if label.0 != "_" => slots.push(Slot {
                    label: label.clone(),
                    shape: Shape::of(label),
                    index,
                    row,
                    level: 0.0,
                    parts,
                }),
                _ => rejected.extend(parts.into_iter().map(|i| (i, Reason::Skipped))),
            }
        }
    }
    slots.sort_by_key(|s| s.index);
    Layer {
        slots,
        rows: count,
        levels: Levels::Loose,
        rejected,
        parted: Vec::new(),
        doubtful: Vec::new(),
    }
}

/// A page as its letters are looked for.
struct Bare<'a> {
    all: &'a [Component],
    /// What may be letters.
    ink: Vec<usize>,
    /// What is printed lines.
    lines: Vec<usize>,
    /// What was cut off letters that it touched.
    parted: &'a [usize],
    /// How many names stand in each line, where lines may be rows.
    listed: &'a [usize],
    /// Of a usual letter, px.
    height: f64,
    /// Of a usual stroke, px.
    stroke: f64,
    rtl: bool,
}

/// The ink of each name's letter in rows from the top, what is left out, and how unlikely all of it is.
struct Read {
    rows: Vec<Vec<Vec<usize>>>,
    out: Vec<(usize, Reason)>,
    /// Names that may be other letters'.
    doubtful: Vec<usize>,
    /// Names of which one may be too many.
    spare: Option<RangeInclusive<usize>>,
    cost: f64,
    /// Whether rows have other numbers of letters than lines have names.
    astray: bool,
    /// How many pieces were joined that are not surely one.
    scattered: usize,
}

impl Read {
    /// How many letters each row has.
    fn lengths(&self) -> Vec<usize> {
        self.rows.iter().map(Vec::len).collect()
    }

    /// What is less of the likelier reading.
    fn rank(&self) -> (bool, f64) {
        (self.astray, self.cost)
    }

    /// Whether it is likelier than another one, or of far fewer pieces: labels that were joined to letters look like
    /// letters in pieces.
    fn is_better(&self, other: &Self) -> bool {
        self.rank() < other.rank()
            || other.scattered > 0 && other.scattered >= FEWER * self.scattered
    }
}

/// What a page's ink is made of.
struct Found {
    pieces: Vec<Piece>,
    ties: Vec<Vec<Tie>>,
    /// Whether each piece may be dirt.
    dirt: Vec<bool>,
    usual: Usual,
    /// How many pieces were joined that are not surely one.
    scattered: usize,
}

impl<'a> Bare<'a> {
    fn new(all: &'a [Component], parted: &'a [usize], task: &Task<'a>) -> Self {
        let lattices = lattices(all);
        let (height, stroke) = (usual_height(all, &lattices), stroke_width(all));
        let claimed = |i: &usize| task.claims.iter().any(|(_, parts)| parts.contains(i));
        let free = (0..all.len()).filter(|i| !claimed(i));
        let (lines, ink) =
            free.partition(|&i| lattices.contains(&i) || is_line(&all[i], height, stroke));
        Self {
            all,
            ink,
            lines,
            parted,
            listed: listed(task),
            height,
            stroke,
            rtl: task.options.direction == Direction::Rtl,
        }
    }

    /// Gathers by count alone where most names say nothing of their letters, and reads where that fails or names
    /// tell.
    fn letters(&self, names: &[Option<Shape>]) -> Result<Read, Unread> {
        let known = names.iter().flatten();
        let silent = known.filter(|s| s.pieces == Pieces::Unknown && !s.full);
        let named = names.iter().flatten().count();
        let counted = if 2 * silent.count() > named {
            self.choose(names, |ink| self.count(ink, names.len()).ok_or(()))
        } else {
            Err(())
        };
        let mut read = counted.or_else(|()| self.choose(names, |ink| self.read(ink, names)))?;
        if read.scattered > 0 && self.left_out(&read) > LEFT_OUT {
            return Err(Unread::unlike(read.lengths()));
        }
        let lines = self.lines.iter().map(|&i| (i, Reason::Line));
        read.out.extend(lines);
        Ok(read)
    }

    /// The share of a page's ink that is in no letter, without long lines, labels and guides.
    fn left_out(&self, read: &Read) -> f64 {
        let side = |r: Rect| r.size().max_side();
        let letters = read.rows.iter().flatten();
        let usual = median(letters.map(|l| side(bounds(self.all, l)))).unwrap_or(0.0);
        let is_short = |&i: &usize| side(self.all[i].upright) < LONG * usual;
        let area = |i: usize| self.all[i].area;
        let short: usize = self.lines.iter().copied().filter(is_short).map(area).sum();
        let out = read.out.iter().filter(|o| o.1 != Reason::Thin);
        let out: usize = out.map(|&(i, _)| area(i)).sum();
        let ink: usize = self.ink.iter().copied().map(area).sum();
        (out + short) as f64 / (ink + short).max(1) as f64
    }

    /// Takes all ink, or leaves out what is drawn with a far thinner pen where that is so much that it must be labels
    /// and guides, and the letters come out likelier or in far fewer pieces.
    fn choose<E>(
        &self,
        names: &[Option<Shape>],
        take: impl Fn(&[usize]) -> Result<Read, E>,
    ) -> Result<Read, E> {
        let whole = take(&self.ink);
        let (thin, thick): (Vec<usize>, Vec<usize>) = self
            .ink
            .iter()
            .partition(|&&i| self.all[i].stroke() < THIN * self.stroke);
        if (thin.len() as f64) < MANY * names.len() as f64 || thick.len() < names.len() {
            return whole;
        }
        match (whole, take(&thick)) {
            (Ok(whole), Ok(part)) if !part.is_better(&whole) => Ok(whole),
            (_, Ok(mut part)) => {
                part.out.extend(thin.into_iter().map(|i| (i, Reason::Thin)));
                Ok(part)
            }
            (whole, Err(_)) => whole,
        }
    }

    /// Joins what lies nearest until there are so many letters.
    fn count(&self, ink: &[usize], letters: usize) -> Option<Read> {
        let Gathered {
            groups,
            out,
            dearest,
        } = gather(self.all, ink, (self.height, self.stroke), letters);
        if groups.len() != letters {
            return None;
        }
        let boxes: Vec<Rect> = groups.iter().map(|g| bounds(self.all, g)).collect();
        let mut order = rows(&boxes);
        if self.rtl {
            order.iter_mut().for_each(|r| r.reverse());
        }
        let letter = |&g: &usize| groups[g].clone();
        let row = |row: &Vec<usize>| row.iter().map(letter).collect();
        let letters: Vec<Vec<Vec<usize>>> = order.iter().map(row).collect();
        Some(Read {
            astray: self.is_astray(&letters),
            rows: letters,
            out,
            doubtful: Vec::new(),
            spare: None,
            cost: dearest,
            scattered: 0,
        })
    }

    /// Letters of two rows that seem to touch.
    fn across(&self, names: &[Option<Shape>]) -> Vec<Touch> {
        let found = self.found(&self.ink, names);
        let across = across(&found.pieces, found.usual).into_iter();
        let touch = |(i, rows): (usize, _)| Touch::below(found.pieces[i].parts.clone(), rows);
        across.map(touch).collect()
    }

    /// What some ink is made of.
    fn found(&self, ink: &[usize], names: &[Option<Shape>]) -> Found {
        let letters = names.len();
        let parts = names.iter().map(|n| n.map_or(1, |shape| shape.parts()));
        let Joined {
            pieces,
            usual,
            scattered,
        } = pieces(
            self.all,
            (ink, self.parted),
            self.stroke,
            (letters, parts.sum()),
        );
        let least = DIRT * usual_area(&pieces, letters);
        let is_dirt = |p: &Piece| p.is_mote(usual) || (p.area as f64) < least;
        let ties = ties(&pieces, self.all, usual);
        Found {
            dirt: pieces.iter().map(is_dirt).collect(),
            pieces,
            ties,
            usual,
            scattered,
        }
    }

    /// The pieces in rows as they are read.
    fn rows(&self, found: &Found, close: Close) -> Vec<Vec<usize>> {
        let usual = (found.usual, close);
        let mut rows = in_rows(&found.pieces, &found.ties, usual, |i| found.dirt[i]);
        if self.rtl {
            rows.iter_mut().for_each(|r| r.reverse());
        }
        rows
    }

    /// Reads some ink: pieces, rows, and what each piece is. Where letters do not stand in rows as names do in lines,
    /// they are read once more as if they did.
    fn read(&self, ink: &[usize], shapes: &[Option<Shape>]) -> Result<Read, Unread> {
        let found = self.found(ink, shapes);
        let rows = [Close::Part, Close::Letter].map(|close| self.rows(&found, close));
        let read = |lines| self.read_either((ink, &found), &rows, Names { shapes, lines });
        let free = read(&[]);
        if self.listed.len() < 2 || free.as_ref().is_ok_and(|r| !r.astray) {
            return free;
        }
        let shifts = |r: &Read| listed::check(self.listed, (Order::Rows, &r.lengths())).is_err();
        // a line that shifts those after it is told as that
        let told = free.as_ref().is_ok_and(shifts);
        match (free, read(self.listed)) {
            (_, Ok(held)) if !held.astray => Ok(held),
            (_, Err(held)) if !told && held.is_nearly(self.listed) => Err(held),
            (free, _) => free,
        }
    }

    /// Reads what was found. Where both ways to find rows can be read, the one in which rows are as lines, or fewer
    /// letters of a row lie over each other, is right, or the likelier one.
    fn read_either(
        &self,
        found: (&[usize], &Found),
        [parts, letters]: &[Vec<Vec<usize>>; 2],
        names: Names<'_>,
    ) -> Result<Read, Unread> {
        let one = self.read_rows(found, parts, names);
        if letters == parts {
            return one;
        }
        match (one, self.read_rows(found, letters, names)) {
            (Ok(one), Ok(other)) => {
                let rank = |r: &Read| (r.astray, self.stacked(r), r.cost);
                Ok(if rank(&one) <= rank(&other) {
                    one
                } else {
                    other
                })
            }
            (Err(_), Ok(other)) => Ok(other),
            (one, Err(_)) => one,
        }
    }

    /// Whether rows have other numbers of letters than lines have names.
    fn is_astray(&self, rows: &[Vec<Vec<usize>>]) -> bool {
        !rows.iter().map(Vec::len).eq(self.listed.iter().copied())
    }

    /// How many letters lie over or under the next one of their row.
    fn stacked(&self, read: &Read) -> usize {
        let boxes = |row: &Vec<Vec<usize>>| row.iter().map(|l| bounds(self.all, l)).collect();
        let rows = read.rows.iter().map(boxes);
        let over = |row: Vec<Rect>| row.windows(2).filter(|w| lies_over(&w[0], &w[1])).count();
        rows.map(over).sum()
    }

    /// Reads what was found as rows have it.
    fn read_rows(
        &self,
        (ink, found): (&[usize], &Found),
        rows: &[Vec<usize>],
        names: Names<'_>,
    ) -> Result<Read, Unread> {
        let pieces = rows.iter().map(Vec::len).sum();
        if names.shapes.len().saturating_mul(pieces) > MOST {
            return Err(Unread::crowded(pieces));
        }
        let lines = Lines::new(&found.pieces, &found.ties, rows, found.usual);
        let dirt = rows.iter().flatten().map(|&i| found.dirt[i]);
        let (reading, owners) = lines.read(names, &dirt.collect::<Vec<_>>());
        let touching = lines.touching(&reading);
        if !reading.agrees() || !touching.is_empty() {
            let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
            return Err(Unread::new(&reading, &lengths, touching));
        }
        let letters = lines.letters(&reading, &owners);
        let mut used = vec![false; self.all.len()];
        let taken = letters.iter().flatten().flatten();
        taken.for_each(|&i| used[i] = true);
        let out = ink.iter().filter(|&&i| !used[i]);
        Ok(Read {
            out: out.map(|&i| (i, Reason::Dirt)).collect(),
            astray: self.is_astray(&letters),
            rows: letters,
            doubtful: reading.doubtful(),
            spare: reading.spare(),
            cost: reading.cost,
            scattered: found.scattered,
        })
    }
}

fn is_line(c: &Component, height: f64, stroke: f64) -> bool {
    let size = c.upright.size();
    let (long, thin) = (size.max_side(), size.min_side());
    let line = long > LINE_LENGTH * height && thin < LINE_SHAPE * long;
    line || (long > SCRAP.1 * height && thin < SCRAP.0 * stroke)
}

/// The median area of the letters among a page's pieces, px², where it has so many of them.
fn usual_area(pieces: &[Piece], letters: usize) -> f64 {
    let mut areas: Vec<usize> = pieces.iter().map(|p| p.area).collect();
    areas.sort_unstable_by(|a, b| b.cmp(a));
    areas.get(letters / 2).copied().unwrap_or(0) as f64
}

fn bounds(all: &[Component], group: &[usize]) -> Rect {
    cut::bounds(all, group).unwrap_or(Rect::ZERO)
}

/// Printed lines that cross: hollow pieces in whose box most of the others lie.
fn lattices(all: &[Component]) -> Vec<usize> {
    let is_lattice = |c: &Component| {
        let holds = |other: &&Component| c.upright.contains(other.centre);
        (c.area as f64) < LATTICE_COVER * c.upright.area()
            && all.iter().filter(holds).count() > FEW.max(all.len() / 2)
    };
    let pieces = all.iter().enumerate();
    let lattices = pieces.filter(|(_, c)| is_lattice(c));
    lattices.map(|(i, _)| i).collect()
}

/// Height of a usual letter, px: the median over the ink without `lattices`, each piece by its area.
fn usual_height(all: &[Component], lattices: &[usize]) -> f64 {
    let letters = all.iter().enumerate();
    let letters = letters.filter(|(i, _)| !lattices.contains(i));
    let height = weighted(letters.map(|(_, c)| (c.upright.height(), c.area)));
    height.map_or(1.0, |h| h.max(1.0))
}
