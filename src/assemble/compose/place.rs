//! Where dots stand: clear of the body by the gap, over or under its head, as near as they come.
//!
//! A group of dots stands over or under the middle of the head. Its height follows from the ink in the columns that
//! it covers, a gap wider on both sides: above it and above the line of the teeth, or below it and below the
//! baseline. Beside the stem of ط the place is taken that is lowest for the way it lies from the loop's middle, and
//! the dot of ج stands in the bowl where there is room.

use crate::assemble::marks::Place;
use crate::assemble::profile::{crossings, edges};
use crate::types::Outline;
use kurbo::{Affine, Point, Size};
use std::iter::successors;

/// Distance between columns, and between the places tried, em.
const STEP: f64 = 0.005;

/// How far the polygon that is looked at may leave the curve, em.
const FLATNESS: f64 = 0.0005;

/// Height that a place must save for one unit of the way from the middle.
const PULL: f64 = 1.0;

/// Lowest ink of a column that stands on the line, em: tails and bowls go deeper.
const ON_LINE: f64 = -0.06;

/// Columns that stand on the line are a letter's head if they make up this part of its width.
const HEAD: f64 = 0.2;

/// Skeletons whose dots stand over the loop, however long the tail is; the loop begins at this part of its height.
const LOOPED: &str = "ڡٯ";
const LOOP: f64 = 0.8;

/// The skeleton whose loop lies beside a stem, to its right.
const STEMMED: char = 'ط';

/// Skeletons with a bowl that is open to the side.
const BOWLED: char = 'ح';

/// A body that dots are set to.
pub(super) struct Body<'a> {
    pub(super) letter: char,
    /// Whether it ends a word.
    pub(super) is_end: bool,
    pub(super) outline: &'a Outline,
    /// Height of a tooth.
    pub(super) tooth: Option<f64>,
    /// Font units.
    pub(super) gap: f64,
    pub(super) em: f64,
}

/// A column: its x, and where its ink begins and ends, from below.
type Column = (f64, Vec<f64>);

impl Body<'_> {
    /// The middle of the dots' lower edge where they stand above, of their upper edge where below; none without ink.
    pub(super) fn place(&self, dots: Size, side: Place) -> Option<Point> {
        let columns = self.columns();
        if side == Place::Top {
            return self.above(&columns, dots);
        }
        let inside = (self.is_end && self.letter == BOWLED)
            .then(|| self.inside(&columns, dots))
            .flatten();
        inside.or_else(|| self.below(&columns, dots))
    }

    fn columns(&self) -> Vec<Column> {
        // a column is a row of the shape with its axes exchanged
        let turned = self
            .outline
            .transformed(Affine::new([0.0, 1.0, 1.0, 0.0, 0.0, 0.0]));
        let edges = edges(&turned, FLATNESS * self.em);
        let Some(ink) = self.outline.bounds() else {
            return Vec::new();
        };
        let step = STEP * self.em;
        let xs = successors(Some(ink.x0 + 0.5 * step), |x| Some(x + step));
        xs.take_while(|x| *x < ink.x1)
            .map(|x| (x, crossings(&edges, x)))
            .collect()
    }

    /// Middle of the columns that `is_one` picks.
    fn middle(columns: &[Column], is_one: impl Fn(f64, f64) -> bool) -> Option<(f64, usize)> {
        let picked = |(x, ys): &Column| {
            let (low, high) = (*ys.first()?, *ys.last()?);
            is_one(low, high).then_some(*x)
        };
        let xs: Vec<f64> = columns.iter().filter_map(picked).collect();
        Some((0.5 * (xs.first()? + xs.last()?), xs.len()))
    }

    /// The middle of the head.
    fn head(&self, columns: &[Column], side: Place) -> Option<f64> {
        let all = Self::middle(columns, |_, _| true)?;
        let top = self.outline.bounds()?.y1;
        if side == Place::Top && LOOPED.contains(self.letter) {
            return Self::middle(columns, |_, high| high > LOOP * top).map(|m| m.0);
        }
        let line = ON_LINE * self.em;
        let is_head = |m: &(f64, usize)| m.1 as f64 >= HEAD * all.1 as f64;
        let standing = Self::middle(columns, |low, _| low > line).filter(is_head);
        let over = || Self::middle(columns, |_, high| high > 0.0).filter(|_| side == Place::Top);
        Some(standing.or_else(over).unwrap_or(all).0)
    }

    /// Places over the letter between two ends; none where the dots are wider than what lies between.
    fn places(&self, (left, right): (f64, f64), width: f64) -> impl Iterator<Item = f64> + use<> {
        let step = STEP * self.em;
        let end = right - 0.5 * width;
        successors(Some(left + 0.5 * width), move |x| Some(x + step)).take_while(move |x| *x <= end)
    }

    /// The columns that dots of that width at that place must be clear of.
    fn near<'c>(
        &self,
        columns: &'c [Column],
        at: f64,
        width: f64,
    ) -> impl Iterator<Item = &'c Column> {
        let half = 0.5 * width + self.gap;
        columns.iter().filter(move |(x, _)| (x - at).abs() <= half)
    }

    fn above(&self, columns: &[Column], dots: Size) -> Option<Point> {
        let ink = self.outline.bounds()?;
        let line = self.tooth.map_or(f64::NEG_INFINITY, |t| t.min(ink.y1));
        let height = |at: f64| {
            let tops = self
                .near(columns, at, dots.width)
                .filter_map(|(_, ys)| ys.last().copied());
            tops.fold(line, f64::max) + self.gap
        };
        let mut at = self.head(columns, Place::Top)?;
        if self.letter == STEMMED {
            let top = |c: &&Column| c.1.last().copied().unwrap_or(f64::NEG_INFINITY);
            let stem = columns.iter().max_by(|a, b| top(a).total_cmp(&top(b)))?.0;
            let middle = 0.5 * (stem + ink.x1);
            let cost = |at: &f64| height(*at) + PULL * (at - middle).abs();
            let places = self.places((stem, ink.x1), dots.width);
            at = places
                .min_by(|a, b| cost(a).total_cmp(&cost(b)))
                .unwrap_or(middle);
        }
        Some(Point::new(at, height(at))).filter(|p| p.is_finite())
    }

    fn below(&self, columns: &[Column], dots: Size) -> Option<Point> {
        let at = self.head(columns, Place::Bottom)?;
        let near = self.near(columns, at, dots.width);
        let lows = near.filter_map(|(_, ys)| ys.first().copied());
        Some(Point::new(at, lows.fold(0.0, f64::min) - self.gap))
    }

    /// In the bowl: nearest to the middle, halfway between what lies over and under it.
    fn inside(&self, columns: &[Column], dots: Size) -> Option<Point> {
        let ink = self.outline.bounds()?;
        let middle = ink.center().x;
        let room = |at: f64| {
            let mut covered: Vec<(f64, f64)> = self
                .near(columns, at, dots.width)
                .flat_map(|(_, ys)| ys.chunks_exact(2).map(|pair| (pair[0], pair[1])))
                .collect();
            covered.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut reach = covered.first()?.1;
            let mut widest = (0.0, 0.0);
            for &(low, high) in &covered {
                if low - reach > widest.1 - widest.0 {
                    widest = (reach, low);
                }
                reach = reach.max(high);
            }
            let fits = widest.1 - widest.0 >= dots.height + 2.0 * self.gap;
            fits.then(|| Point::new(at, 0.5 * (widest.0 + widest.1 + dots.height)))
        };
        self.places((ink.x0, ink.x1), dots.width)
            .filter_map(room)
            .min_by(|a, b| (a.x - middle).abs().total_cmp(&(b.x - middle).abs()))
    }
}
