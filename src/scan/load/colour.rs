//! Which light a picture swallows, block by block.

use super::ColourDetail;
use crate::types::Colours;
use image::DynamicImage;
use rayon::prelude::*;

/// Side of a block: a thin stroke's width, and what cameras reduce colours to. px
const BLOCK: usize = 8;

/// The colours of a picture that has any.
pub(super) fn colours(image: &DynamicImage, detail: ColourDetail) -> Option<Colours> {
    let side = match detail {
        ColourDetail::Blocks => BLOCK,
        ColourDetail::Pixels => 1,
    };
    let size = (image.width() as usize, side);
    match image {
        DynamicImage::ImageRgb8(i) => Some(blocks(i.as_raw(), size, 3, |v| u32::from(*v))),
        DynamicImage::ImageRgba8(i) => Some(blocks(i.as_raw(), size, 4, |v| u32::from(*v))),
        DynamicImage::ImageRgb16(i) => Some(blocks(i.as_raw(), size, 3, |v| u32::from(v >> 8))),
        DynamicImage::ImageRgba16(i) => Some(blocks(i.as_raw(), size, 4, |v| u32::from(v >> 8))),
        _ => None,
    }
}

/// Means of blocks; a fourth channel is opacity over white.
fn blocks<S: Sync>(
    raw: &[S],
    (width, side): (usize, usize),
    channels: usize,
    level: impl Fn(&S) -> u32 + Sync,
) -> Colours {
    let columns = width.div_ceil(side);
    let bands = raw.par_chunks((width * channels * side).max(1));
    let rows = bands.map(|band| {
        let (mut sums, mut counts) = (vec![[0u32; 3]; columns], vec![0u32; columns]);
        for row in band.chunks_exact((width * channels).max(1)) {
            let blocks = row.chunks(channels * side);
            for ((sum, count), block) in sums.iter_mut().zip(&mut counts).zip(blocks) {
                for p in block.chunks_exact(channels) {
                    let opacity = p.get(3).map_or(255, &level);
                    let share = |v| (255 - level(v)) * opacity / 255;
                    sum.iter_mut().zip(p).for_each(|(s, v)| *s += share(v));
                    *count += 1;
                }
            }
        }
        let means = sums.into_iter().zip(counts);
        means
            .map(|(s, n)| s.map(|v| u8::try_from(v / n.max(1)).unwrap_or(u8::MAX)))
            .collect::<Vec<_>>()
    });
    let swallowed: Vec<Vec<[u8; 3]>> = rows.collect();
    Colours {
        block: side,
        columns,
        swallowed: swallowed.concat(),
    }
}
