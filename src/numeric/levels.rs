//! Levels of ink and paper that vary over a picture, and the coverage between them.

use super::cast::{index, single};

/// Spread of the neighbourhood a level is the mean of, px. Print and paper grain vary within a few
/// pixels: 8 px follows them less well, and percentiles of a window are led astray by the edge itself.
const SPREAD_PX: f64 = 2.0;
/// Side of a square in which pixels are summed before they are averaged, px.
const BLOCK: usize = 2;
/// Weight of the picture's own level against a neighbourhood of nothing but sure pixels, no unit: it
/// decides where a stroke is too thin to hold any.
const GLOBAL_WEIGHT: f32 = 0.004;
/// Ink and paper closer than this are no edge, coverage.
const CONTRAST: f32 = 0.2;

/// A block is surely ink or paper from this part of its pixels on.
const SURE: f32 = 0.99;
/// Blocks this near to one that is not sure have levels of their own, blocks: further from an edge none is felt.
const NEAR: usize = 6;

/// What a pixel says of the levels: ink value times weight, ink weight, paper value times weight, paper
/// weight. Also sums of these over pixels.
pub type Votes = [f32; 4];

/// Where each value lies between the paper's level (0) and the ink's (1) around it.
///
/// `values` run row by row, `width` a row; `votes` are asked once for each index. A level is the Gaussian
/// mean of the votes around, and where there are next to none, of all. Far from pixels whose votes leave it open what
/// they are nothing is asked: there ink is 1 and paper 0.
#[must_use]
pub fn normalised(values: &[f32], width: usize, votes: impl Fn(usize) -> Votes) -> Vec<f32> {
    let w = width.max(1);
    let h = values.len() / w;
    let columns = w.div_ceil(BLOCK);
    let mut sums = vec![[0.0f32; 4]; columns * h.div_ceil(BLOCK)];
    for y in 0..h {
        let row = &mut sums[y / BLOCK * columns..][..columns];
        for (c, s) in row.iter_mut().enumerate() {
            for x in BLOCK * c..(BLOCK * (c + 1)).min(w) {
                let v = votes(y * w + x);
                (0..4).for_each(|k| s[k] += v[k]);
            }
        }
    }
    let total = sums.iter().fold([0.0f64; 4], |t, s| {
        std::array::from_fn(|i| t[i] + f64::from(s[i]))
    });
    let mean = |sum: f64, count: f64, none: f64| if count > 0.0 { sum / count } else { none };
    let ink = single(mean(total[0], total[1], 1.0));
    let paper = single(mean(total[2], total[3], 0.0));
    if ink - paper < CONTRAST {
        return values.to_vec();
    }
    let full = (BLOCK * BLOCK) as f32;
    let open = sums.iter().map(|s| s[1].max(s[3]) < SURE * full);
    let near = dilated(&open.collect::<Vec<_>>(), columns, NEAR);
    // and one block further, since levels are read between blocks
    let told = dilated(&near, columns, 1);
    let local = |sum: f32, count: f32, global: f32| {
        (sum / full + GLOBAL_WEIGHT * global) / (count / full + GLOBAL_WEIGHT)
    };
    let levels = blurred(&sums, columns, &told);
    let levels = levels.iter().zip(&told).map(|(s, told)| {
        let (i, p) = (local(s[0], s[1], ink), local(s[2], s[3], paper));
        if *told && i - p >= CONTRAST {
            (i, p)
        } else {
            (ink, paper)
        }
    });
    let levels: Vec<(f32, f32)> = levels.collect();
    let far =
        |block: usize| (!near[block]).then(|| f32::from(u8::from(sums[block][1] > sums[block][3])));
    between(values, w, &levels, far)
}

/// Bits, rows of `width`, that are set or have a set one in the square of `reach` around them.
#[must_use]
pub fn dilated(bits: &[bool], width: usize, reach: usize) -> Vec<bool> {
    let across = smeared(bits, (width, 1), reach);
    smeared(&across, (bits.len(), width), reach)
}

/// Bits that are set or have a set one within `reach` steps of `step` in their line of `line` bits.
fn smeared(bits: &[bool], (line, step): (usize, usize), reach: usize) -> Vec<bool> {
    let set = |to: &mut [bool], from: &[bool]| to.iter_mut().zip(from).for_each(|(t, f)| *t |= f);
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

/// Gaussian sums over the blocks of a picture where they are wanted, 0 elsewhere.
fn blurred(sums: &[Votes], columns: usize, wanted: &[bool]) -> Vec<Votes> {
    let sigma = SPREAD_PX / BLOCK as f64;
    let radius = index((4.0 * sigma).ceil());
    let kernel: Vec<f32> = (0..=radius)
        .map(|i| single((-0.5 * (i as f64 / sigma).powi(2)).exp()))
        .collect();
    let norm = 1.0 / (2.0 * kernel.iter().sum::<f32>() - kernel[0]);
    let add = |to: &mut [Votes], from: &[Votes], k: f32| {
        for (t, f) in to.iter_mut().zip(from) {
            (0..4).for_each(|i| t[i] += k * f[i]);
        }
    };
    // `step` apart within lines of `line`
    let pass = |from: &[Votes], wanted: &[bool], (line, step): (usize, usize)| {
        let mut to = vec![[0.0f32; 4]; from.len()];
        let lines = to.chunks_exact_mut(line.max(1));
        let from = from.chunks_exact(line.max(1));
        for ((to, from), wanted) in lines.zip(from).zip(wanted.chunks_exact(line.max(1))) {
            let mut end = 0;
            for run in wanted.chunk_by(|a, b| a == b) {
                let start = end;
                end += run.len();
                for (d, k) in kernel.iter().map(|k| k * norm).enumerate() {
                    let d = d * step;
                    let (first, last) = (start.max(d), end.min(line.saturating_sub(d)));
                    if run[0] && first < end {
                        add(&mut to[first..end], &from[first - d..end - d], k);
                    }
                    if run[0] && d > 0 && start < last {
                        add(&mut to[start..last], &from[start + d..last + d], k);
                    }
                }
            }
        }
        to
    };
    let (rows, all) = ((columns, 1), (sums.len(), columns));
    // along rows as far up and down as the sums along columns look
    let across = pass(sums, &smeared(wanted, all, radius), rows);
    pass(&across, wanted, all)
}

/// Where each value lies between the levels around it, which are read between the blocks' centres; or what `far` says of
/// its block.
fn between(
    values: &[f32],
    w: usize,
    levels: &[(f32, f32)],
    far: impl Fn(usize) -> Option<f32>,
) -> Vec<f32> {
    let columns = w.div_ceil(BLOCK);
    let place = |i: usize, n: usize| {
        let f = (i as f32 + 0.5) / BLOCK as f32 - 0.5;
        let low = index(f64::from(f)).min(n - 1);
        (low, (low + 1).min(n - 1), (f - low as f32).clamp(0.0, 1.0))
    };
    let mix = |a: (f32, f32), b: (f32, f32), t: f32| (a.0 + t * (b.0 - a.0), a.1 + t * (b.1 - a.1));
    let across: Vec<_> = (0..w).map(|x| place(x, columns)).collect();
    let mut out = Vec::with_capacity(values.len());
    for (y, line) in values.chunks_exact(w).enumerate() {
        let (y0, y1, ty) = place(y, levels.len() / columns);
        let [above, below] = [y0, y1].map(|y| &levels[y * columns..(y + 1) * columns]);
        for (block, line) in line.chunks(BLOCK).enumerate() {
            if let Some(known) = far(y / BLOCK * columns + block) {
                out.extend(line.iter().map(|_| known));
                continue;
            }
            let across = &across[BLOCK * block..];
            out.extend(line.iter().zip(across).map(|(v, &(x0, x1, tx))| {
                let row = |x: usize| mix(above[x], below[x], ty);
                let (ink, paper) = mix(row(x0), row(x1), tx);
                (v - paper) / (ink - paper)
            }));
        }
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

    fn sure(coverage: f32, value: f32) -> Votes {
        let (ink, paper) = (coverage.floor(), (1.0 - coverage).floor());
        [ink * value, ink, paper * value, paper]
    }

    #[test]
    fn uneven_levels_become_coverage() {
        let (grey, coverage) = uneven();
        let got = normalised(&grey, W, |i| sure(coverage[i], grey[i]));
        let off = got.iter().zip(&coverage).map(|(a, b)| (a - b).abs());
        let off = off.fold(0.0, f32::max);
        assert!(off < 0.02, "{off}");
    }

    #[test]
    fn a_picture_without_contrast_or_pixels_stays_as_it_is() {
        let flat = vec![0.3; W * 4];
        assert_eq!(normalised(&flat, W, |i| sure((i % 2) as f32, 0.3)), flat);
        assert!(normalised(&[], 0, |_| [0.0; 4]).is_empty());
    }
}
