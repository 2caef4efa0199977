//! Thinning to lines one pixel wide.
//!
//! Source   [guohall89 sec. 3, alg. A1]
//! Solves   deletes border pixels in two alternating passes (from the north-east, from the south-west) until none is left to delete
//! Takes    ink or paper, px, y down
//! Gives    a subset of the ink with the same parts and holes, one pixel wide
//! Symbols  `C(p)` -> `runs`, `N1`, `N2` -> the two pairings in `neighbours`, P1…P8 -> bits 0…7 clockwise from the north
//! Departs  a table of 256 neighbourhoods takes the place of the logic; only pixels beside a deletion are looked at again
//! Cost     O(ink · pen width)      Fails  never
//!
//! Unlike the better known two-pass thinning of Zhang and Suen it never deletes a 2 × 2 square: a dot stays a dot.

use crate::types::Bitmap;

/// Column and row steps to the eight neighbours, clockwise from the north.
pub(crate) const AROUND: [(isize, isize); 8] = [
    (0, -1),
    (1, -1),
    (1, 0),
    (1, 1),
    (0, 1),
    (-1, 1),
    (-1, 0),
    (-1, -1),
];

/// Bits with a margin of one pixel of paper, so that every neighbour exists.
#[derive(Debug, Clone)]
pub(crate) struct Field {
    /// Columns with the margin.
    pub(crate) stride: usize,
    /// Ink or paper, row-major, margin included.
    pub(crate) ink: Vec<bool>,
}

impl Field {
    /// The picture inside a margin.
    pub(crate) fn new(bitmap: &Bitmap) -> Self {
        let stride = bitmap.width() + 2;
        let mut ink = vec![false; stride * (bitmap.height() + 2)];
        for y in 0..bitmap.height() {
            for x in 0..bitmap.width() {
                ink[(y + 1) * stride + x + 1] = bitmap.at(x, y);
            }
        }
        Self { stride, ink }
    }

    /// Indices of the eight neighbours of a pixel inside the margin, clockwise from the north.
    pub(crate) fn around(&self, i: usize) -> [usize; 8] {
        AROUND.map(|(dx, dy)| {
            let row = i.wrapping_add_signed(dy * self.stride.cast_signed());
            row.wrapping_add_signed(dx)
        })
    }

    /// The neighbourhood as bits, bit 0 to the north, clockwise.
    pub(crate) fn code(&self, i: usize) -> usize {
        let near = self.around(i);
        (0..8).fold(0, |code, k| code | usize::from(self.ink[near[k]]) << k)
    }
}

/// Number of runs of ink around a pixel, P1 between two side neighbours bridging them: `C(p)`.
pub(crate) fn runs(code: usize) -> u32 {
    let p = |k: usize| code >> (k & 7) & 1 == 1;
    let run = |k: usize| u32::from(!p(k) && (p(k + 1) || p(k + 2)));
    (0..4).map(|k| run(2 * k)).sum()
}

/// Whether a pass deletes the middle of this neighbourhood; `pass` 0 or 1. [guohall89 sec. 3, conditions a–c]
fn deletes(code: usize, pass: usize) -> bool {
    let p = |k: usize| code >> (k & 7) & 1 == 1;
    let pairs = |from: usize| {
        (0..4)
            .filter(|k| p(from + 2 * k) || p(from + 2 * k + 1))
            .count()
    };
    let neighbours = pairs(0).min(pairs(7));
    let side = 4 * pass; // the second pass is the first turned by half a turn
    let kept = (p(side) || p(side + 1) || !p(side + 3)) && p(side + 2);
    runs(code) == 1 && (2..=3).contains(&neighbours) && !kept
}

/// The ink thinned to lines one pixel wide.
#[must_use]
pub fn thin(bitmap: &Bitmap) -> Bitmap {
    let mut field = Field::new(bitmap);
    let tables = [0, 1].map(|pass| std::array::from_fn::<bool, 256, _>(|c| deletes(c, pass)));
    let mut open: [Vec<usize>; 2] = [0, 1].map(|_| {
        let all = 0..field.ink.len();
        all.filter(|&i| field.ink[i]).collect()
    });
    let mut queued = vec![[true; 2]; field.ink.len()];
    while !(open[0].is_empty() && open[1].is_empty()) {
        for pass in 0..2 {
            let look = std::mem::take(&mut open[pass]);
            look.iter().for_each(|&i| queued[i][pass] = false);
            let gone: Vec<usize> = look
                .into_iter()
                .filter(|&i| field.ink[i] && tables[pass][field.code(i)])
                .collect();
            gone.iter().for_each(|&i| field.ink[i] = false);
            for n in gone.iter().flat_map(|&i| field.around(i)) {
                for (other, list) in open.iter_mut().enumerate() {
                    if field.ink[n] && !std::mem::replace(&mut queued[n][other], true) {
                        list.push(n);
                    }
                }
            }
        }
    }
    let bits = (0..bitmap.height()).flat_map(|y| {
        let row = (y + 1) * field.stride + 1;
        field.ink[row..row + bitmap.width()].iter().copied()
    });
    bitmap.with_bits(bits)
}
