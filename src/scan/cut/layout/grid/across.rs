//! Letters of cells side by side, or one below the other, that touch: their ink is cut apart near the border of the
//! cells.
//!
//! Such ink lies in the cell of its centre; in each of the others, whose middles it reaches, there is more of it than
//! of other ink.

use super::axis::Axis;
use super::plan::Plan;
use super::shared::{Shared, share};
use crate::scan::components::Component;
use crate::scan::cut::largest;
use crate::scan::cut::layout::named::least;
use crate::scan::cut::layout::touching::{Along, End, Example, Meeting, Side, Touch};
use crate::scan::letters::Shape;
use crate::types::Label;
use kurbo::Point;
use std::collections::BTreeMap;
use std::ops::Range;

/// The border of two letters lies within this share of a cell from that of their cells.
const UNEQUAL: f64 = 0.3;
/// What is cut at a lower cost shows how letters drawn alike go on.
const SURE: f64 = 1.0;
/// Letters are cut so many times more, as those drawn alike tell: those that lie free, then those cut for sure, too.
const MORE: usize = 2;

/// A letter's side: its cell, and which.
type Facing = (usize, Side);

/// Of sides that touch others: letters drawn alike.
type Examples = BTreeMap<Facing, Vec<Example>>;

/// Cuts apart in `all` what is of several cells' letters, shares the ink out anew, and says which pieces were cut
/// from others. New pieces go to the end of `all` and of `letters`.
///
/// What lies free of others then tells how the edges of letters drawn alike run beneath each other, and they are cut
/// once more.
pub(super) fn part(
    all: &mut Vec<Component>,
    letters: &mut Vec<usize>,
    shared: &mut Shared,
    (labels, plan): (&[Label], &Plan<'_>),
) -> Vec<usize> {
    let page = Page::of(labels, plan);
    let mut examples = Examples::new();
    if page.touching(all, shared, &examples).is_empty() {
        return Vec::new();
    }
    let drawn = (all.clone(), letters.clone(), shared.clone());
    let (mut parted, mut costs) = page.cut(all, letters, shared, &examples);
    let mut known = BTreeMap::new();
    for _ in 0..MORE {
        let alike = page.alike(&costs);
        if alike == known {
            break;
        }
        examples = page.examples(all, shared, &alike);
        known = alike;
        (*all, *letters, *shared) = drawn.clone();
        (parted, costs) = page.cut(all, letters, shared, &examples);
    }
    parted
}

/// The cells of a page and their names.
struct Page<'a> {
    labels: &'a [Label],
    plan: &'a Plan<'a>,
    /// What the name of each cell's letter tells.
    shapes: Vec<Option<Shape>>,
    /// Cells that have a name, and whose ink nobody said.
    open: Vec<bool>,
}

impl<'a> Page<'a> {
    fn of(labels: &'a [Label], plan: &'a Plan<'a>) -> Self {
        let cells = plan.rows * plan.columns;
        let (mut shapes, mut open) = (vec![None; cells], vec![false; cells]);
        for (index, label) in labels.iter().enumerate().filter(|(_, l)| l.0 != "_") {
            let (row, column) = plan.place(index);
            let cell = row * plan.columns + column;
            shapes[cell] = Some(Shape::of(label));
            open[cell] = plan.task.claims.iter().all(|(k, _)| *k != index);
        }
        Self {
            labels,
            plan,
            shapes,
            open,
        }
    }

    /// Whether a stroke joins a letter to others on a side, as its name says.
    fn has_stroke(&self, (cell, side): Facing) -> bool {
        self.shapes[cell].is_some_and(|s| s.joined[side as usize])
    }

    /// Cuts letters apart until none touch: the pieces that were cut from others, and what the cuts cost.
    fn cut(
        &self,
        all: &mut Vec<Component>,
        letters: &mut Vec<usize>,
        shared: &mut Shared,
        examples: &Examples,
    ) -> (Vec<usize>, BTreeMap<Facing, f64>) {
        let task = self.plan.task;
        let (mut parted, mut costs) = (Vec::new(), BTreeMap::new());
        loop {
            let before = all.len();
            for (touch, sides) in self.touching(all, shared, examples) {
                let of = touch.part(all, (task.gray(), task.upright));
                parted.extend(of.pieces);
                for (sides, cost) in sides.into_iter().zip(of.costs) {
                    costs.extend(sides.into_iter().map(|s| (s, cost)));
                }
            }
            letters.extend(before..all.len());
            match share(all, letters, self.labels, self.plan).filter(|_| all.len() > before) {
                Some(anew) => *shared = anew,
                None => return (parted, costs),
            }
        }
    }

    /// The letters whose sides are like those that were cut, and lie free or were cut at lower costs.
    fn alike(&self, costs: &BTreeMap<Facing, f64>) -> BTreeMap<Facing, Vec<usize>> {
        let of = |(cell, side): Facing| {
            let shape = self.shapes[cell].as_ref()?;
            Some((shape.skeleton()?, self.has_stroke((cell, side))))
        };
        let alike = |(&(cell, side), cost): (&Facing, &f64)| {
            let own = of((cell, side))?;
            let is_alike = |&other: &usize| {
                let beside = costs.get(&(other, side));
                let surer = beside.is_none_or(|c| c < cost && *c < SURE);
                other != cell && surer && of((other, side)) == Some(own)
            };
            let alike: Vec<usize> = (0..self.shapes.len()).filter(is_alike).collect();
            (!alike.is_empty()).then_some(((cell, side), alike))
        };
        costs.iter().filter_map(alike).collect()
    }

    /// The edges of such sides, moved into the cells of those that were cut.
    fn examples(
        &self,
        all: &[Component],
        shared: &Shared,
        alike: &BTreeMap<Facing, Vec<usize>>,
    ) -> Examples {
        let task = self.plan.task;
        let back = task.upright.inverse();
        let begin = |cell: usize| {
            let (row, column) = (cell / self.plan.columns, cell % self.plan.columns);
            back.at(Point::new(shared.x.begin(column), shared.y.begin(row)))
        };
        let examples = |(&(cell, side), others): (&Facing, &Vec<usize>)| {
            let example = |other: &usize| {
                let body = largest(all, &shared.cells[*other])?;
                let by = begin(cell) - begin(*other);
                let page = (task.gray(), task.upright);
                Some(Example::of((&all[body], side), page, by))
            };
            ((cell, side), others.iter().filter_map(example).collect())
        };
        alike.iter().map(examples).collect()
    }

    /// Letters of neighbouring cells that touch, and which of their sides do.
    fn touching(
        &self,
        all: &[Component],
        shared: &Shared,
        examples: &Examples,
    ) -> Vec<(Touch, Vec<Vec<Facing>>)> {
        let (plan, columns) = (self.plan, self.plan.columns);
        let own = |cell: &Vec<usize>| cell.iter().map(|&i| all[i].area).sum::<usize>();
        let own: Vec<usize> = shared.cells.iter().map(own).collect();
        let least = least(own.iter().copied());
        let claimed = |i: usize| plan.task.claims.iter().any(|(_, parts)| parts.contains(&i));
        let touch = |cell: usize, i: usize| {
            let (row, column) = (cell / columns, cell % columns);
            [Along::Row, Along::Column].into_iter().find_map(|along| {
                let (cells, home, reach) = match along {
                    Along::Row => (&shared.x, column, (all[i].upright.x0, all[i].upright.x1)),
                    Along::Column => (&shared.y, row, (all[i].upright.y0, all[i].upright.y1)),
                };
                let place = |k: usize| match along {
                    Along::Row => row * columns + k,
                    Along::Column => k * columns + column,
                };
                // more of it than of what lies there alone, be it dots
                let holds = |k: usize| {
                    let cell = place(k);
                    let here =
                        |p: &(usize, usize)| cells.cell(along.at(*p, plan.task.upright)) == Some(k);
                    let ink = || all[i].pixels().filter(here).count();
                    self.open[cell] && (least.max(own[cell] as f64)..).contains(&(ink() as f64))
                };
                let end = |k: usize| {
                    let (border, reach) = (cells.begin(k), UNEQUAL * cells.pitch);
                    let [before, after] = [place(k - 1), place(k)];
                    let is_row = along == Along::Row;
                    let sides = [(before, Side::Right), (after, Side::Left)];
                    let strokes = is_row && sides.iter().all(|s| self.has_stroke(*s));
                    let known = |s: Facing| examples.get(&s).filter(|_| is_row);
                    End {
                        stretch: border - reach..border + reach,
                        meeting: if strokes {
                            Meeting::Strokes
                        } else {
                            Meeting::Any
                        },
                        examples: sides.map(|s| known(s).cloned().unwrap_or_default()),
                    }
                };
                let seconds = seconds(cells, home, reach, holds);
                let both = [Side::Left, Side::Right];
                let facing = |k: usize| match along {
                    Along::Row => vec![(place(k - 1), Side::Right), (place(k), Side::Left)],
                    Along::Column => {
                        let cells = [place(k - 1), place(k)].into_iter();
                        cells.flat_map(|c| both.map(|s| (c, s))).collect()
                    }
                };
                let sides = seconds.clone().map(facing).collect();
                let ends: Vec<End> = seconds.map(end).collect();
                (!ends.is_empty()).then(|| (Touch::at(ends, (along, vec![i]), cells.pitch), sides))
            })
        };
        let ink = shared.cells.iter().enumerate();
        let ink = ink.flat_map(|(cell, ink)| ink.iter().map(move |&i| (cell, i)));
        ink.filter(|(_, i)| !claimed(*i))
            .filter_map(|(cell, i)| touch(cell, i))
            .collect()
    }
}

/// Of the cells around `home` that ink from one place to another reaches the middles of, all but the first: the
/// letters may be cut apart where each of them begins.
fn seconds(
    cells: &Axis,
    home: usize,
    (from, to): (f64, f64),
    holds: impl Fn(usize) -> bool,
) -> Range<usize> {
    let middle = |k: usize| cells.begin(k) + cells.pitch / 2.0;
    let is_in = |k: &usize| (from..to).contains(&middle(*k)) && holds(*k);
    let first = (0..home).rev().take_while(is_in).last().unwrap_or(home);
    let last = (home + 1..cells.count)
        .take_while(is_in)
        .last()
        .unwrap_or(home);
    first + 1..last + 1
}
