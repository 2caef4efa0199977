//! Printed lines that lead across a picture, however they bend.
//!
//! The picture is looked at in strips, upright to the lines. In a strip a line is what most columns have at one
//! height, and not above or below; from strip to strip it goes on nearly as it did.

use crate::numeric::median::quantile;
use crate::types::Gray;
use kurbo::Point;
use rayon::prelude::*;

/// Width of a strip, px.
const STRIP: usize = 20;
/// How far from a line's middle there is paper again, px: nearest and farthest.
const BESIDE: (usize, usize) = (3, 5);
/// Coverage by which a line is darker than what lies beside it.
const FAINTEST: f64 = 0.02;
/// How far a line may lie from where it was expected, px: while its slope is not known, then, and more a strip that
/// was passed over.
const OFF: (f64, f64, f64) = (2.5, 1.5, 0.3);
/// Strips in a row in which a letter may hide it.
const HIDDEN: usize = 5;
/// Places in a row at its ends: one beyond a gap may be of something else.
const RUN: usize = 3;
/// Places that tell its slope.
const TAIL: usize = 6;
/// Share of the picture's width that a line leads across at least, and of the strips there that show it.
const LONG: f64 = 0.5;
const SHOWN: f64 = 0.6;

/// A line as it was seen, strip by strip from the left, px.
#[derive(Debug, Clone)]
pub(super) struct Line {
    pub(super) places: Vec<Point>,
}

impl Line {
    /// Where it is expected at `x`, and how far from there it may lie.
    fn expected(&self, x: f64) -> Option<(f64, f64)> {
        let last = self.places.last()?;
        let tail = &self.places[self.places.len().saturating_sub(TAIL)..];
        let first = tail.first()?;
        let gap = (x - last.x) / STRIP as f64 - 1.0;
        let (slope, off) = if tail.len() < TAIL / 2 {
            (0.0, OFF.0)
        } else {
            ((last.y - first.y) / (last.x - first.x), OFF.1)
        };
        Some((last.y + slope * (x - last.x), off + OFF.2 * gap))
    }

    /// Leaves out what lies apart at its ends.
    fn trim(&mut self) {
        let is_next = |a: &Point, b: &Point| b.x - a.x < 1.5 * STRIP as f64;
        let runs = self.places.chunk_by(is_next).map(<[Point]>::len);
        let runs: Vec<usize> = runs.collect();
        let apart = |runs: &mut dyn Iterator<Item = &usize>| runs.take_while(|n| **n < RUN).sum();
        let (before, after): (usize, usize) =
            (apart(&mut runs.iter()), apart(&mut runs.iter().rev()));
        let end = self.places.len().saturating_sub(after).max(before);
        self.places = self.places[before..end].to_vec();
    }

    fn is_long(&self, width: f64) -> bool {
        let ends = self.places.first().zip(self.places.last());
        let length = ends.map_or(0.0, |(a, b)| b.x - a.x);
        let strips = length / STRIP as f64 + 1.0;
        length > LONG * width && self.places.len() as f64 > SHOWN * strips
    }
}

/// The lines that lead from left to right across most of a picture.
pub(super) fn across(gray: &Gray) -> Vec<Line> {
    let strips = (0..gray.width() / STRIP).into_par_iter();
    let strips: Vec<Vec<f64>> = strips.map(|k| ridges(&profile(gray, k))).collect();
    let (mut open, mut done): (Vec<Line>, Vec<Line>) = (Vec::new(), Vec::new());
    for (k, found) in strips.into_iter().enumerate() {
        let x = (k * STRIP) as f64 + STRIP as f64 / 2.0;
        let last = |l: &Line| l.places.last().map_or(0.0, |p| p.x);
        let hidden = (HIDDEN + 1) * STRIP;
        done.extend(open.extract_if(.., |l| x - last(l) > hidden as f64));
        let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
        for (i, line) in open.iter().enumerate() {
            let Some((y, most)) = line.expected(x) else {
                continue;
            };
            let off = found.iter().map(|at| (at - y).abs()).enumerate();
            let near = off.filter(|(_, off)| *off < most);
            pairs.extend(near.map(|(j, off)| (off, i, j)));
        }
        pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut led, mut taken) = (vec![false; open.len()], vec![false; found.len()]);
        for (_, i, j) in pairs {
            if !led[i] && !taken[j] {
                (led[i], taken[j]) = (true, true);
                open[i].places.push(Point::new(x, found[j]));
            }
        }
        let new = found.iter().zip(&taken).filter(|(_, taken)| !**taken);
        open.extend(new.map(|(y, _)| Line {
            places: vec![Point::new(x, *y)],
        }));
    }
    done.extend(open);
    done.iter_mut().for_each(Line::trim);
    done.retain(|l| l.is_long(gray.width() as f64));
    done
}

/// The coverage that half of a strip's columns have, down the strip.
fn profile(gray: &Gray, strip: usize) -> Vec<f64> {
    let columns = strip * STRIP..(strip + 1) * STRIP;
    let mut samples = Vec::with_capacity(STRIP);
    let row = |y: usize| {
        samples.clear();
        samples.extend_from_slice(&gray.row(y)[columns.clone()]);
        quantile(&mut samples, 0.5, f32::total_cmp).map_or(0.0, f64::from)
    };
    (0..gray.height()).map(row).collect()
}

/// Heights at which a profile has a ridge as thin as a line.
fn ridges(profile: &[f64]) -> Vec<f64> {
    let (near, far) = BESIDE;
    let paper = |at: std::ops::RangeInclusive<usize>| {
        profile[at].iter().copied().fold(f64::INFINITY, f64::min)
    };
    let inner = far..profile.len().saturating_sub(far);
    let ridge = |y: usize| {
        let beside = paper(y - far..=y - near).max(paper(y + near..=y + far));
        let height = profile[y] - beside;
        let is_top = profile[y] > profile[y - 1] && profile[y] >= profile[y + 1];
        if !is_top || height < FAINTEST {
            return None;
        }
        // halfway between its edges, since a dark line is as dark beside its middle
        let half = beside + height / 2.0;
        let edge = |at: fn(usize, usize) -> usize| {
            let mut last = profile[y];
            let found = (1..=far).find_map(|far| {
                let here = profile[at(y, far)];
                let share = (last - half) / (last - here);
                last = here;
                (here < half).then_some(far as f64 - 1.0 + share)
            });
            found.unwrap_or(far as f64)
        };
        let (before, after) = (edge(|y, far| y - far), edge(|y, far| y + far));
        Some(y as f64 + 0.5 + (after - before) / 2.0)
    };
    let mut found: Vec<f64> = inner.filter_map(ridge).collect();
    // a dark line's top can have two
    found.dedup_by(|b, a| *b - *a < near as f64);
    found
}

/// Where a line is halfway along the picture, from the places nearest to there.
pub(super) fn level(line: &Line, middle: f64) -> f64 {
    let mut near = line.places.clone();
    near.sort_by(|a, b| (a.x - middle).abs().total_cmp(&(b.x - middle).abs()));
    near.truncate(TAIL);
    let count = near.len().max(1) as f64;
    near.iter().map(|p| p.y).sum::<f64>() / count
}

/// The picture on its side: columns are rows.
pub(super) fn turned(gray: &Gray) -> Gray {
    Gray::from_fn(gray.height(), gray.width(), |x, y| gray.at(y, x))
}

/// Means of squares of so many px.
pub(super) fn reduced(gray: &Gray, side: usize) -> Gray {
    let (w, h) = (gray.width() / side, gray.height() / side);
    let mut samples = vec![0.0; w * h];
    let rows = samples.par_chunks_mut(w.max(1)).enumerate();
    rows.for_each_init(Vec::new, |sums, (y, row)| {
        sums.clear();
        sums.extend_from_slice(&gray.row(y * side)[..w * side]);
        for below in (1..side).map(|k| gray.row(y * side + k)) {
            sums.iter_mut().zip(below).for_each(|(sum, v)| *sum += v);
        }
        for (mean, part) in row.iter_mut().zip(sums.chunks_exact(side)) {
            *mean = part.iter().sum::<f32>() / (side * side) as f32;
        }
    });
    Gray::from_fn(w, h, |x, y| samples[y * w + x])
}
