//! Letters in rows on a bare page.
//!
//! Ink that is surely one makes a piece (`pieces`), pieces are read in rows, and one choice for the whole page says which of them
//! are letters, parts of letters or dirt, so that letters and names agree (`reading`).

use super::doubts::Unread;
use super::lines::Lines;
use super::nearest::{Gathered, gather};
use super::order::in_rows;
use super::pieces::{Piece, Usual, pieces, ties, usual_size};
use super::rows::{nearest, rows};
use super::{Layer, Reason, Slot, stroke_width};
use crate::scan::components::Component;
use crate::scan::error::ScanError;
use crate::scan::letters::{Pieces, Shape};
use crate::scan::options::{Direction, Options};
use crate::types::Label;
use glyphs_reader::glyphdata::GlyphData;
use kurbo::Rect;

/// Thickness of a ruled line or a piece of it at most, as a share of its length.
const LINE_SHAPE: f64 = 0.06;
/// Length of a piece of a ruled line at least, in usual letters' heights: a dash is shorter.
const LINE_LENGTH: f64 = 1.5;
/// Thickness of a faint line's scraps at most, in the page's stroke widths, and their length at least, in
/// usual letters' heights.
const SCRAP: (f64, f64) = (0.2, 0.3);
/// Strokes of a label or a guide at most, in the page's stroke widths, where they are told from letters.
const THIN: f64 = 0.4;
/// Pieces of such thin ink at least, for each name: labels stand beside every letter.
const MANY: f64 = 0.5;
/// Pieces of less ink than this share of a usual letter's may be dirt.
const DIRT: f64 = 0.06;

/// Gathers the ink of a bare page into letters and names them.
pub(super) fn place(
    all: &[Component],
    labels: &[Label],
    claims: &[(usize, Vec<usize>)],
    options: &Options,
    source: &str,
) -> Result<Layer, ScanError> {
    let page = Bare {
        all,
        height: usual_height(all),
        stroke: stroke_width(all),
        rtl: options.direction == Direction::Rtl,
    };
    let claimed = |i: &usize| claims.iter().any(|(_, parts)| parts.contains(i));
    let free = (0..all.len()).filter(|i| !claimed(i));
    let (lines, ink): (Vec<usize>, Vec<usize>) = free.partition(|&i| page.is_line(&all[i]));
    let unclaimed = |index: &usize| claims.iter().all(|(c, _)| c != index);
    let names: Vec<usize> = (0..labels.len()).filter(unclaimed).collect();
    let data = GlyphData::default();
    let known = |l: &&Label| l.0 != "_";
    let shape = |&i: &usize| Some(&labels[i]).filter(known).map(|l| Shape::of(l, &data));
    let shapes: Vec<Option<Shape>> = names.iter().map(shape).collect();
    let label = |k: usize| names.get(k).map_or("", |&i| labels[i].0.as_str());
    let read = page
        .letters(&ink, &shapes)
        .map_err(|unread| unread.error(source, names.len(), label))?;
    let mut names = names.into_iter();
    let rows = read.rows.into_iter();
    let mut rows: Vec<Row> = rows.map(|row| names.by_ref().zip(row).collect()).collect();
    claims.iter().for_each(|c| seat(all, &mut rows, c));
    rows.sort_by_key(|row| row.iter().map(|l| l.0).min());
    let mut layer = layer(rows, labels);
    let lines = lines.into_iter().map(|i| (i, Reason::Line));
    layer.rejected.extend(lines.chain(read.out));
    Ok(layer)
}

/// The letters of a row, each the number of its name and its ink.
type Row = Vec<(usize, Vec<usize>)>;

/// Puts a letter whose place a user says into a row: that of the names before and after it, or the nearest in height, or its own.
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
        ruled: false,
        rejected,
    }
}

/// A page as its letters are looked for.
struct Bare<'a> {
    all: &'a [Component],
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
    cost: f64,
}

impl Bare<'_> {
    fn is_line(&self, c: &Component) -> bool {
        let (w, h) = (c.upright.width(), c.upright.height());
        let (long, thin) = (w.max(h), w.min(h));
        let line = long > LINE_LENGTH * self.height && thin < LINE_SHAPE * long;
        line || (long > SCRAP.1 * self.height && thin < SCRAP.0 * self.stroke)
    }

    /// Gathers by count alone where most names say nothing of their letters, and reads where that fails or names tell.
    fn letters(&self, ink: &[usize], names: &[Option<Shape>]) -> Result<Read, Unread> {
        let known = names.iter().flatten();
        let silent = known.filter(|s| s.pieces == Pieces::Unknown && !s.full);
        let named = names.iter().flatten().count();
        let counted = if 2 * silent.count() > named {
            self.choose(ink, names, |ink| self.count(ink, names.len()).ok_or(()))
        } else {
            Err(())
        };
        counted.or_else(|()| self.choose(ink, names, |ink| self.read(ink, names)))
    }

    /// Takes all ink, or leaves out what is drawn with a far thinner pen where that is so much that it must be labels and guides, and the
    /// letters come out likelier.
    fn choose<E>(
        &self,
        ink: &[usize],
        names: &[Option<Shape>],
        take: impl Fn(&[usize]) -> Result<Read, E>,
    ) -> Result<Read, E> {
        let whole = take(ink);
        let (thin, thick): (Vec<usize>, Vec<usize>) = ink
            .iter()
            .partition(|&&i| self.all[i].stroke() < THIN * self.stroke);
        if (thin.len() as f64) < MANY * names.len() as f64 || thick.len() < names.len() {
            return whole;
        }
        match (whole, take(&thick)) {
            (Ok(whole), Ok(part)) if whole.cost <= part.cost => Ok(whole),
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
        let boxes: Vec<Rect> = groups.iter().map(|g| bounds(self.all, g)).collect();
        let mut order = rows(&boxes);
        if self.rtl {
            order.iter_mut().for_each(|r| r.reverse());
        }
        let letter = |&g: &usize| groups[g].clone();
        let row = |row: &Vec<usize>| row.iter().map(letter).collect();
        (groups.len() == letters).then(|| Read {
            rows: order.iter().map(row).collect(),
            out,
            cost: dearest,
        })
    }

    /// Reads some ink: pieces, rows, and what each piece is.
    fn read(&self, ink: &[usize], names: &[Option<Shape>]) -> Result<Read, Unread> {
        let usual = Usual {
            size: usual_size(self.all, ink, names.len()),
            stroke: self.stroke,
        };
        let found = pieces(self.all, ink, usual);
        let least = DIRT * usual_area(&found, names.len());
        let is_dirt = |p: &Piece| p.is_mote(usual) || (p.area as f64) < least;
        let ties = ties(&found, self.all, usual);
        let mut rows = in_rows(&found, &ties, usual, |i| is_dirt(&found[i]));
        if self.rtl {
            rows.iter_mut().for_each(|r| r.reverse());
        }
        let lines = Lines::new(&found, &ties, &rows, usual);
        let dirt: Vec<bool> = lines.pieces.iter().map(|p| is_dirt(p)).collect();
        let (reading, owners) = lines.read(names, &dirt);
        if !reading.agrees() {
            let lengths: Vec<usize> = rows.iter().map(Vec::len).collect();
            return Err(Unread::new(&reading, &lengths));
        }
        let letters = lines.letters(&reading, &owners);
        let mut used = vec![false; self.all.len()];
        let taken = letters.iter().flatten().flatten();
        taken.for_each(|&i| used[i] = true);
        let out = ink.iter().filter(|&&i| !used[i]);
        Ok(Read {
            out: out.map(|&i| (i, Reason::Dirt)).collect(),
            rows: letters,
            cost: reading.cost,
        })
    }
}

/// The median area of the letters among a page's pieces, px², where it has so many of them.
fn usual_area(pieces: &[Piece], letters: usize) -> f64 {
    let mut areas: Vec<usize> = pieces.iter().map(|p| p.area).collect();
    areas.sort_unstable_by(|a, b| b.cmp(a));
    areas.get(letters / 2).copied().unwrap_or(0) as f64
}

fn bounds(all: &[Component], group: &[usize]) -> Rect {
    let boxes = group.iter().map(|&i| all[i].upright);
    boxes.reduce(|a, b| a.union(b)).unwrap_or(Rect::ZERO)
}

/// Height of a usual letter, px: the median over the ink, each piece by its area.
fn usual_height(all: &[Component]) -> f64 {
    let mut sizes: Vec<(f64, usize)> = all.iter().map(|c| (c.upright.height(), c.area)).collect();
    sizes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = sizes.iter().map(|s| s.1).sum::<usize>() / 2;
    let mut sum = 0;
    let middle = sizes.iter().find(|s| {
        sum += s.1;
        sum > half
    });
    middle.map_or(1.0, |s| s.0.max(1.0))
}
