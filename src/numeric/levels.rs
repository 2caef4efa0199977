//! Levels of ink and paper that vary over a picture, and the coverage between them.

use super::cast::single;
use super::coverage::blur;
use super::median::{NORMAL, median};
use std::ops::BitOrAssign;

/// Spread of the neighbourhood a level is the mean of, px. Print and paper grain vary within a few
/// pixels: 8 px follows them less well, and percentiles of a window are led astray by the edge itself.
const SPREAD_PX: f64 = 2.0;
/// Side of a square in which pixels are summed before they are averaged, px.
const BLOCK: usize = 2;
/// Pixels of a block.
const FULL: f32 = (BLOCK * BLOCK) as f32;
/// Part that a pixel takes of its own block's level; the rest is that of the block it lies next to.
const OWN: f32 = 0.75;
/// Weight of the picture's own level against a neighbourhood of nothing but sure pixels, no unit: it
/// decides where a stroke is too thin to hold any.
const GLOBAL_WEIGHT: f32 = 0.004;
/// Ink and paper closer than this are no edge, coverage.
const CONTRAST: f32 = 0.2;
/// A pixel whose model is within this of ink or paper tells their level, coverage.
const TELLS: f32 = 0.1;

/// A pixel is plain paper up to this model, coverage: nearer to an edge one differs where the edge lies a little aside.
const PLAIN: f32 = 0.02;
/// It is blotted where it stands out of the paper's level by so much, coverage, and so many deviations of what is plain.
const STANDS_OUT: f32 = 0.2;
const DEVIATIONS: f64 = 6.0;
/// And beside such a pixel where it does so by this part of that.
const BESIDE: f32 = 0.5;

/// A block is surely ink or paper from this part of its pixels on.
const SURE: f32 = 0.99;
/// Blocks this near to one that is not sure have levels of their own, blocks: further from an edge none is felt.
const NEAR: usize = 6;

/// Where each value lies between the paper's level (0) and the ink's (1) around it.
///
/// `values` run row by row, `width` a row; `model` is what each would be if ink were 1 and paper 0. A pixel tells all
/// of a level where its model is ink or paper alone, less the more it holds of the other, whose part is taken off. A
/// level is the Gaussian mean of what is told around, and where that is next to nothing, of all. Far from pixels that
/// leave it open what they are nothing is asked: there ink is 1 and paper 0. Paper that is blotted tells nothing: what a
/// model leaves out, as a short serif, would pass for a part of the level.
#[must_use]
pub fn normalised(values: &[f32], width: usize, model: &[f32]) -> Vec<f32> {
    let w = width.max(1);
    let first = levelled(values, w, model);
    match without_blots(model, &first, w) {
        Some(model) => levelled(values, w, &model),
        None => first,
    }
}

/// The model with nothing told by paper that is blotted; nothing where none is. `seen` is what it made of the values.
fn without_blots(model: &[f32], seen: &[f32], w: usize) -> Option<Vec<f32>> {
    let pixels = || seen.iter().zip(model);
    let stand_out = |least: f32| pixels().map(move |(v, m)| (*m < PLAIN) & (*v > least));
    if !stand_out(STANDS_OUT).any(|out| out) {
        return None;
    }
    // exactly 0 is paper of which nothing is asked
    let plain = pixels().filter(|(v, m)| **m < PLAIN && **v != 0.0);
    let deviation = NORMAL * median(plain.map(|(v, _)| f64::from(v.abs())))?;
    let least = STANDS_OUT.max(single(DEVIATIONS * deviation));
    let blots: Vec<bool> = stand_out(least).collect();
    let near = dilated(&blots, w, 1)
        .into_iter()
        .zip(stand_out(BESIDE * least));
    let blotted: Vec<bool> = near.map(|(near, out)| near && out).collect();
    let told = |(m, blotted): (&f32, &bool)| if *blotted { 0.5 } else { *m };
    let any = blots.iter().any(|out| *out);
    any.then(|| model.iter().zip(&blotted).map(told).collect())
}

/// Where each value lies between the levels that the model tells.
fn levelled(values: &[f32], w: usize, model: &[f32]) -> Vec<f32> {
    let sums = told(values, w, model);
    let columns = w.div_ceil(BLOCK);
    let mean = |sum: f64, count: f64, none: f64| if count > 0.0 { sum / count } else { none };
    let [ink, inks, paper, papers] = sums.each_ref().map(|s| total(s));
    let ink = single(mean(ink, inks, 1.0));
    let paper = single(mean(paper, papers, 0.0));
    if values.is_empty() || ink - paper < CONTRAST {
        return values.to_vec();
    }
    let counts = || sums[1].iter().zip(&sums[3]);
    let open: Vec<bool> = counts().map(|(i, p)| i.max(*p) < SURE * FULL).collect();
    let near = dilated(&open, columns, NEAR);
    let sure = |((i, p), near): ((&f32, &f32), &bool)| {
        if *near {
            f32::NAN
        } else {
            f32::from(u8::from(i > p))
        }
    };
    let sure: Vec<f32> = counts().zip(&near).map(sure).collect();
    let mut around = sums;
    around
        .iter_mut()
        .for_each(|s| blur(s, columns, SPREAD_PX / BLOCK as f64, 0));
    let [i, inks, p, papers] = &around;
    let mut levels = [(i, inks, ink), (p, papers, paper)].map(|(sums, counts, global)| {
        let local = |(sum, count): (&f32, &f32)| {
            (sum / FULL + GLOBAL_WEIGHT * global) / (count / FULL + GLOBAL_WEIGHT)
        };
        sums.iter().zip(counts).map(local).collect::<Vec<f32>>()
    });
    let [inks, papers] = &mut levels;
    for (i, p) in inks.iter_mut().zip(papers) {
        let told = *i - *p >= CONTRAST;
        *i = if told { *i } else { ink };
        *p = if told { *p } else { paper };
    }
    between(values, w, &levels, &sure)
}

/// Sum of values, several at a time.
fn total(values: &[f32]) -> f64 {
    let mut sums = [0.0; 8];
    for eight in values.chunks(sums.len()) {
        let pairs = sums.iter_mut().zip(eight);
        pairs.for_each(|(sum, v)| *sum += f64::from(*v));
    }
    sums.iter().sum()
}

/// What pixels tell of the levels, summed over blocks: ink value times weight, ink weight, paper value times weight,
/// paper weight.
fn told(values: &[f32], w: usize, model: &[f32]) -> [Vec<f32>; 4] {
    let columns = w.div_ceil(BLOCK);
    let rows = (values.len() / w).div_ceil(BLOCK);
    let mut sums = [(); 4].map(|()| Vec::with_capacity(columns * rows));
    let mut lines = [(); 4].map(|()| vec![0.0f32; BLOCK * columns]);
    for (values, model) in values.chunks(BLOCK * w).zip(model.chunks(BLOCK * w)) {
        lines.iter_mut().for_each(|l| l.fill(0.0));
        let [ink, inks, paper, papers] = &mut lines;
        for (values, model) in values.chunks_exact(w).zip(model.chunks_exact(w)) {
            let ink = ink.iter_mut().zip(inks.iter_mut());
            let paper = paper.iter_mut().zip(papers.iter_mut());
            let line = ink.zip(paper).zip(values.iter().zip(model));
            line.for_each(|(((ink, inks), (paper, papers)), (seen, model))| {
                let i = (1.0 - (1.0 - model) / TELLS).clamp(0.0, 1.0);
                let p = (1.0 - model / TELLS).clamp(0.0, 1.0);
                *ink += i * (seen + 1.0 - model);
                *inks += i;
                *paper += p * (seen - model);
                *papers += p;
            });
        }
        for (sums, line) in sums.iter_mut().zip(&lines) {
            sums.extend(line.chunks_exact(BLOCK).map(|b| b[0] + b[1]));
        }
    }
    sums
}

/// Bits, rows of `width`, that are set or have a set one in the square of `reach` around them.
#[must_use]
pub fn dilated<B: Copy + BitOrAssign>(bits: &[B], width: usize, reach: usize) -> Vec<B> {
    let across = smeared(bits, (width, 1), reach);
    smeared(&across, (bits.len(), width), reach)
}

/// Bits that are set or have a set one within `reach` steps of `step` in their line of `line` bits.
fn smeared<B: Copy + BitOrAssign>(
    bits: &[B],
    (line, step): (usize, usize),
    reach: usize,
) -> Vec<B> {
    let set = |to: &mut [B], from: &[B]| to.iter_mut().zip(from).for_each(|(t, f)| *t |= *f);
    let mut out = bits.to_vec();
    let lines = out.chunks_exact_mut(line.max(1));
    for (to, from) in lines.zip(bits.chunks_exact(line.max(1))) {
        for d in (1..=reach).map(|d| (d * step).min(line)) {
            set(&mut to[d..], from);
            set(to, &from[d..]);
        }
    }
    out
}

/// Where each value lies between the levels of ink and paper around it, which are read between the blocks' centres;
/// or what is `sure` of its block, where that is a number.
fn between(values: &[f32], w: usize, levels: &[Vec<f32>; 2], sure: &[f32]) -> Vec<f32> {
    let columns = w.div_ceil(BLOCK);
    let last = (sure.len() / columns.max(1)).saturating_sub(1);
    let line = |row: usize| {
        let at = row.min(last) * columns..(row.min(last) + 1) * columns;
        levels.each_ref().map(|l| widened(&l[at.clone()]))
    };
    // of the row of blocks above, the own and the one below
    let mut lines = [0, 0, 1].map(line);
    let mut known = vec![0.0; BLOCK * columns];
    let mut out = Vec::with_capacity(values.len());
    for (y, values) in values.chunks_exact(w).enumerate() {
        let own = y / BLOCK;
        if y % BLOCK == 0 {
            if own > 0 {
                lines.rotate_left(1);
                lines[2] = line(own + 1);
            }
            let sure = known.chunks_exact_mut(BLOCK).zip(&sure[own * columns..]);
            sure.for_each(|(to, v)| to.fill(*v));
        }
        let [above, [ink, paper], below] = &lines;
        let [inks, papers] = if y % BLOCK == 0 { above } else { below };
        let levels = ink.iter().zip(inks).zip(paper.iter().zip(papers));
        let pixels = values.iter().zip(levels).zip(&known);
        out.extend(pixels.map(|((v, ((ink, inks), (paper, papers))), known)| {
            let ink = inks + OWN * (ink - inks);
            let paper = papers + OWN * (paper - papers);
            let part = (v - paper) / (ink - paper);
            if known.is_nan() { part } else { *known }
        }));
    }
    out
}

/// Levels of a row of blocks, read at each pixel's column.
fn widened(blocks: &[f32]) -> Vec<f32> {
    let ends = |i: usize| blocks.get(i).copied().unwrap_or_default();
    let mut row = vec![ends(0)];
    row.extend(blocks);
    row.push(ends(blocks.len().saturating_sub(1)));
    let mut out = vec![0.0; BLOCK * blocks.len()];
    for (to, b) in out.chunks_exact_mut(BLOCK).zip(row.windows(3)) {
        to[0] = b[0] + OWN * (b[1] - b[0]);
        to[1] = b[2] + OWN * (b[1] - b[2]);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    const W: usize = 64;

    /// Coverage of a disk, on paper that darkens and with ink that pales from left to right.
    fn uneven() -> (Vec<f32>, Vec<f32>) {
        let at = |i: usize| (single((i % W) as f64), single((i / W) as f64));
        let disk = |i: usize| {
            let (x, y) = at(i);
            (20.5 - (x - 31.5).hypot(y - 31.5)).clamp(0.0, 1.0)
        };
        let coverage: Vec<f32> = (0..W * W).map(disk).collect();
        let grey = |i: usize| {
            let light = at(i).0 / 640.0;
            light + coverage[i] * (0.9 - 2.0 * light)
        };
        ((0..W * W).map(grey).collect(), coverage)
    }

    #[test]
    fn uneven_levels_become_coverage() {
        let (grey, coverage) = uneven();
        let got = normalised(&grey, W, &coverage);
        let off = got.iter().zip(&coverage).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f32::max);
        assert!(off < 0.02, "{off}");
    }

    #[test]
    fn what_a_model_leaves_out_is_no_level() {
        // a stem, and a pale serif of 5 × 2 px that its model has not
        let stem: Vec<f32> = (0..W * W)
            .map(|i| (20.5 - single((i % W) as f64)).clamp(0.0, 1.0))
            .collect();
        let serif = |i: &usize| (22..27).contains(&(i % W)) && (30..32).contains(&(i / W));
        let coverage = |i: usize| if serif(&i) { 0.4 } else { stem[i] };
        let grey: Vec<f32> = (0..W * W).map(|i| 0.1 + 0.8 * coverage(i)).collect();
        let got = normalised(&grey, W, &stem);
        for i in (0..W * W).filter(serif) {
            assert!((got[i] - 0.4).abs() < 0.01, "{}", got[i]);
        }
        // as much is nothing to rough paper
        let grain = |i: usize| single((i * 37 % 101) as f64 / 101.0 - 0.5);
        let rough: Vec<f32> = (0..W * W).map(|i| grey[i] + 0.4 * grain(i)).collect();
        assert_eq!(normalised(&rough, W, &stem), levelled(&rough, W, &stem));
    }

    #[test]
    fn a_picture_without_contrast_or_pixels_stays_as_it_is() {
        let flat = vec![0.3; W * 4];
        let stripes: Vec<f32> = (0..W * 4).map(|i| (i % 2) as f32).collect();
        assert_eq!(normalised(&flat, W, &stripes), flat);
        assert!(normalised(&[], 0, &[]).is_empty());
    }
}
