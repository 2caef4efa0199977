//! Which share of a letter's ink is of which colour: printers' colour separation, turned round.
//!
//! Light that inks swallow adds up where two meet in a pixel, so a pixel of their border is a sum of their colours,
//! and its parts are found by least squares: of one ink where that explains it, else of two. Every ink has its own
//! level, and a part counts only near a piece of its ink that is large enough to be drawn: fringes of a
//! scanner and dark specks in a stroke go to the ink around them. Nothing is lost: the parts of a pixel sum up to it.

use super::chamfer::distances;
use super::components::{Component, LOW, SEED, components};
use super::error::Fault;
use super::ink::{Ink, Inks, more, paper, swallowed};
use crate::numeric::cast::single;
use crate::types::{Colours, Gray, Sheet};
use serde::{Deserialize, Serialize};

/// Coverage from which a pixel shows its ink's own colour.
const CORE: f32 = 0.7;
/// Light, in 255ths, by which one ink must miss a pixel's colour before two are thought of: paper, scanners and
/// thick ink stray by less.
const STRAY: f64 = 12.0;
/// Thickness from which a piece of a letter can have a colour of its own, px: a scanner's fringes are thinner.
const FRINGE: f64 = 2.5;
/// Share of the area of a dot from which a piece can be black: where a coloured pen lingers it is black too.
const LINGERS: f64 = 0.5;
/// How far beyond a piece of its ink a colour reaches, px: the blur of its edge, and of colours kept at half size.
const REACH: u16 = 4;
/// How far a layer runs on under the layers above it, px: without it paper would shine through between them.
const TRAP: usize = 2;

/// An ink as a page shows it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Colour {
    /// The ink, as a project file names it.
    pub ink: String,
    /// How it looks on white paper: red, green and blue.
    pub rgb: [u8; 3],
    /// Ink of this colour, px².
    pub area_px: usize,
}

/// What tells the inks of a page apart.
pub(super) struct Separation<'a> {
    colours: &'a Colours,
    paper: [f64; 3],
    inks: Vec<Solid>,
}

/// An ink where it covers the paper.
struct Solid {
    colour: Colour,
    has_hue: bool,
    /// Light that it swallows more than paper does, 255ths.
    swallowed: [f64; 3],
    /// Its coverage, of the darkest inks'.
    level: f32,
    /// The least area of a piece of it, px².
    least: f64,
}

/// A part of the sheet's picture.
pub(super) struct Part<'a> {
    /// Column and row of its corner in the sheet's picture.
    pub(super) corner: (usize, usize),
    pub(super) width: usize,
    /// Coverage by all inks.
    pub(super) samples: &'a [f32],
}

impl<'a> Separation<'a> {
    /// Measures the inks of a page on its letters, of which `least` px² can be drawn.
    ///
    /// # Errors
    /// The page has no colours, or too little of one of the inks.
    pub(super) fn measure(
        sheet: &'a Sheet,
        letters: &[Component],
        inks: &Inks,
        least: f64,
    ) -> Result<Option<Self>, Fault> {
        if inks.layers().is_empty() {
            return Ok(None);
        }
        let Some(colours) = &sheet.colours else {
            return Err(Fault::NoColours(inks.to_string()));
        };
        let paper = paper(colours);
        let mut seen: Vec<Vec<([u8; 3], f32)>> = vec![Vec::new(); inks.layers().len()];
        for (x, y) in letters.iter().flat_map(Component::pixels) {
            let (here, coverage) = (colours.at(x, y), sheet.gray.at(x, y));
            let ink = inks.nearest(more(here, paper)).filter(|_| coverage >= CORE);
            if let Some(list) = ink.and_then(|i| seen.get_mut(i)) {
                list.push((here, coverage));
            }
        }
        let solid = |(&ink, mut seen): (&Ink, Vec<([u8; 3], f32)>)| {
            if (seen.len() as f64) < least {
                return Err(Fault::OtherInk(ink.into()));
            }
            let middle = seen.len() / 2;
            let look =
                [0, 1, 2].map(|i| seen.select_nth_unstable_by_key(middle, |s| s.0[i]).1.0[i]);
            let level = seen
                .select_nth_unstable_by(middle, |a, b| a.1.total_cmp(&b.1))
                .1
                .1;
            let colour = Colour {
                ink: ink.into(),
                rgb: [0, 1, 2].map(|i| on_white(look[i], paper[i])),
                area_px: seen.len(),
            };
            Ok(Solid {
                colour,
                has_hue: ink != Ink::Black,
                swallowed: more(look, paper),
                level,
                least: if ink == Ink::Black {
                    LINGERS * least
                } else {
                    0.0
                },
            })
        };
        let inks: Result<Vec<Solid>, Fault> = inks.layers().iter().zip(seen).map(solid).collect();
        Ok(Some(Self {
            colours,
            paper,
            inks: inks?,
        }))
    }

    /// The inks, the lowest first.
    pub(super) fn colours(&self) -> Vec<Colour> {
        self.inks.iter().map(|i| i.colour.clone()).collect()
    }

    /// Whether a piece is more like an ink with a hue than grey, as dust and print are.
    pub(super) fn is_hued(&self, piece: &Component) -> bool {
        let seen = swallowed(piece, self.colours, self.paper);
        // as the cosine of the angle between two colours, but for the first one's length
        let like = |ink: [f64; 3]| dot(seen, ink) / dot(ink, ink).sqrt().max(f64::MIN_POSITIVE);
        let mut hues = self.inks.iter().filter(|ink| ink.has_hue);
        piece.stroke() >= FRINGE && hues.any(|ink| like(ink.swallowed) > like([1.0; 3]))
    }

    /// The coverage by each ink, the lowest first, each on its own level.
    pub(super) fn plates(&self, part: &Part<'_>) -> Vec<Vec<f32>> {
        let mut plates = vec![vec![0.0; part.samples.len()]; self.inks.len()];
        for (i, &coverage) in part.samples.iter().enumerate() {
            let (x, y) = (i % part.width, i / part.width);
            let here = self.colours.at(part.corner.0 + x, part.corner.1 + y);
            for (ink, amount) in self.amounts(more(here, self.paper)) {
                plates[ink][i] = coverage * amount;
            }
        }
        self.gather(&mut plates, part.width);
        for (plate, ink) in plates.iter_mut().zip(&self.inks) {
            plate.iter_mut().for_each(|v| *v /= ink.level);
        }
        plates
    }

    /// The parts of a pixel's ink, of sum 1, by the light that it swallows: one, or two where one does not explain
    /// it.
    fn amounts(&self, light: [f64; 3]) -> Vec<(usize, f32)> {
        let solid = |i: usize| self.inks[i].swallowed;
        let miss = |parts: &[(usize, f64)]| {
            let left = [0, 1, 2].map(|c| {
                let sum: f64 = parts.iter().map(|&(i, a)| a * solid(i)[c]).sum();
                light[c] - sum
            });
            dot(left, left)
        };
        let least = |all: Vec<Vec<(usize, f64)>>| {
            let all = all.into_iter().map(|parts| (miss(&parts), parts));
            all.min_by(|a, b| a.0.total_cmp(&b.0))
        };
        let count = self.inks.len();
        let alone = |i| vec![(i, dot(light, solid(i)) / dot(solid(i), solid(i)).max(1.0))];
        let Some(mut best) = least((0..count).map(alone).collect()) else {
            return Vec::new();
        };
        if best.0 > STRAY * STRAY {
            let pairs = (0..count).flat_map(|i| (i + 1..count).map(move |j| (i, j)));
            let both = pairs.filter_map(|(i, j)| {
                let (a, b) = both(light, solid(i), solid(j))?;
                Some(vec![(i, a), (j, b)])
            });
            let both = least(both.collect()).filter(|both| both.0 < best.0);
            best = both.unwrap_or(best);
        }
        let weight = |(i, a): (usize, f64)| a.max(f64::EPSILON) * f64::from(self.inks[i].level);
        let sum: f64 = best.1.iter().map(|&part| weight(part)).sum();
        let share = |part: (usize, f64)| (part.0, single(weight(part) / sum));
        best.1.into_iter().map(share).collect()
    }

    /// Gives ink far from every piece of its colour to the colours that are near.
    fn gather(&self, plates: &mut [Vec<f32>], width: usize) {
        let pairs = plates.iter().zip(&self.inks);
        let far: Vec<Vec<u16>> = pairs.map(|(p, ink)| far(p, width, ink.least)).collect();
        for i in 0..far.first().map_or(0, Vec::len) {
            let nearest = far.iter().map(|f| f[i]).min().unwrap_or_default();
            let stays = |k: &usize| far[*k][i] <= nearest.max(3 * REACH);
            let sum: f32 = plates.iter().map(|p| p[i]).sum();
            let near: f32 = (0..plates.len()).filter(stays).map(|k| plates[k][i]).sum();
            let heir = far.iter().position(|f| f[i] == nearest);
            for (k, plate) in plates.iter_mut().enumerate() {
                plate[i] = match () {
                    () if !stays(&k) => 0.0,
                    () if near.abs() > f32::EPSILON => sum * plate[i] / near,
                    () if Some(k) == heir => sum,
                    () => 0.0,
                };
            }
        }
    }
}

/// How far each pixel lies from the pieces of a plate that are at least so large, thirds of a px.
fn far(plate: &[f32], width: usize, least: f64) -> Vec<u16> {
    let height = plate.len() / width.max(1);
    let gray = Gray::from_fn(width, height, |x, y| plate[y * width + x]);
    let mut field = vec![u16::MAX; plate.len()];
    let pieces = components(&gray, LOW, SEED).into_iter();
    for piece in pieces.filter(|c| c.area as f64 >= least && c.stroke() >= FRINGE) {
        piece.pixels().for_each(|(x, y)| field[y * width + x] = 0);
    }
    if field.contains(&0) {
        distances(&mut field, width);
    }
    field
}

/// Runs every plate on under the plates above it by [`TRAP`] px, as printers do: else paper would shine through
/// where two meet.
pub(super) fn trap(plates: &mut [Vec<f32>], width: usize) {
    let mut above: Vec<f32> = vec![0.0; plates.first().map_or(0, Vec::len)];
    for plate in plates.iter_mut().rev() {
        let own = plate.clone();
        above.iter_mut().zip(&own).for_each(|(a, v)| *a += v);
        let mut wide = own;
        for _ in 0..TRAP {
            wide = widened(&wide, width);
        }
        for ((v, wide), above) in plate.iter_mut().zip(wide).zip(&above) {
            *v = v.max(wide.min(*above));
        }
    }
}

/// The greatest of each pixel and its eight neighbours.
fn widened(plate: &[f32], width: usize) -> Vec<f32> {
    let (width, height) = (width.max(1), plate.len() / width.max(1));
    let at = |x: usize, y: usize| {
        let rows = y.saturating_sub(1)..(y + 2).min(height);
        let window = rows
            .flat_map(|r| &plate[r * width + x.saturating_sub(1)..r * width + (x + 2).min(width)]);
        window.copied().fold(f32::NEG_INFINITY, f32::max)
    };
    (0..plate.len()).map(|i| at(i % width, i / width)).collect()
}

/// How much of two inks swallows this light, where it is some of each.
fn both(light: [f64; 3], a: [f64; 3], b: [f64; 3]) -> Option<(f64, f64)> {
    let (aa, ab, bb) = (dot(a, a), dot(a, b), dot(b, b));
    let (al, bl) = (dot(a, light), dot(b, light));
    let determinant = aa * bb - ab * ab;
    let (p, q) = (al * bb - bl * ab, bl * aa - al * ab);
    (determinant > 0.0 && p > 0.0 && q > 0.0).then(|| (p / determinant, q / determinant))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// What an ink's channel would reflect on paper that swallows nothing.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "0…255 by the clamp"
)]
fn on_white(swallowed: u8, paper: f64) -> u8 {
    let share = (255.0 - f64::from(swallowed)) / (255.0 - paper).max(1.0);
    (255.0 * share).round().clamp(0.0, 255.0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::types::Colours;
    use proptest::collection::vec;
    use proptest::prelude::*;

    const SIDE: usize = 40;
    const PAPER: [u8; 3] = [5, 7, 15];
    const BLACK: [u8; 3] = [230, 228, 225];
    const RED: [u8; 3] = [55, 210, 205];

    /// A picture of black and red, as shares of 255 of each, and what it says of its inks.
    fn separated(inks: impl Fn(usize, usize) -> (u32, u32)) -> (Vec<f32>, Vec<Vec<f32>>) {
        let at = |i: usize| inks(i % SIDE, i / SIDE);
        let level = |part: (u32, u32), c: usize| {
            let paper = 255 - part.0 - part.1;
            let sum = paper * u32::from(PAPER[c])
                + part.0 * u32::from(BLACK[c])
                + part.1 * u32::from(RED[c]);
            u8::try_from(sum / 255).unwrap()
        };
        let gray = Gray::from_fn(SIDE, SIDE, |x, y| {
            let part = inks(x, y);
            single(f64::from(part.0 + part.1) / 255.0)
        });
        let swallowed = (0..SIDE * SIDE).map(|i| [0, 1, 2].map(|c| level(at(i), c)));
        let sheet = Sheet {
            colours: Some(Colours {
                block: 1,
                columns: SIDE,
                swallowed: swallowed.collect(),
            }),
            gray,
            dpi: None,
            guessed: None,
            source: "page".to_owned(),
        };
        let list: Inks = serde_json::from_str("[\"black\", \"red\"]").unwrap();
        let letters = components(&sheet.gray, LOW, SEED);
        let separation = Separation::measure(&sheet, &letters, &list, 9.0)
            .unwrap()
            .unwrap();
        let mut plates = separation.plates(&Part {
            corner: (0, 0),
            width: SIDE,
            samples: sheet.gray.samples(),
        });
        for (plate, ink) in plates.iter_mut().zip(&separation.inks) {
            plate.iter_mut().for_each(|v| *v *= ink.level);
        }
        (sheet.gray.samples().to_vec(), plates)
    }

    #[test]
    fn a_border_between_two_inks_lies_where_it_was_drawn() {
        // red from column 8 to 20.3, black from there to 32
        let inside = |y: usize| (5..35).contains(&y);
        let (_, plates) = separated(|x, y| match x {
            8..20 if inside(y) => (0, 255),
            20 if inside(y) => (178, 77),
            21..32 if inside(y) => (255, 0),
            _ => (0, 0),
        });
        let width = |plate: &[f32]| plate[20 * SIDE..21 * SIDE].iter().sum::<f32>();
        assert!(
            (width(&plates[0]) - 11.7).abs() < 0.05,
            "{}",
            width(&plates[0])
        );
        assert!(
            (width(&plates[1]) - 12.3).abs() < 0.05,
            "{}",
            width(&plates[1])
        );
        let mut trapped = plates.clone();
        trap(&mut trapped, SIDE);
        assert!(
            (width(&trapped[0]) - 11.7 - TRAP as f32).abs() < 0.4,
            "black runs on under red"
        );
        assert_eq!(trapped[1], plates[1], "nothing lies over red");
    }

    #[test]
    fn what_is_too_thin_for_an_ink_of_its_own_is_its_neighbours() {
        // a reddish fringe along a black bar, and a black speck in a red one
        let (_, plates) = separated(|x, y| match (x, y) {
            (8, 5..35) => (60, 100),
            (9..18, 5..35) => (255, 0),
            (27, 20) => (255, 0),
            (24..34, 5..35) => (0, 255),
            _ => (0, 0),
        });
        for y in 5..35 {
            assert!(plates[1][y * SIDE + 8].abs() < 1e-6, "fringe in row {y}");
            assert!(plates[0][y * SIDE + 27].abs() < 1e-6, "speck in row {y}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(32))]

        #[test]
        fn no_ink_is_lost_and_none_is_made(seed in vec((0..SIDE, 0..SIDE, 3..12_usize, 0..2_u8), 1..8)) {
            let bars = [seed.as_slice(), &[(2, 2, 6, 0), (30, 30, 6, 1)]].concat();
            let (samples, plates) = separated(|x, y| {
                let hit = bars.iter().rev().find(|b| (b.0..b.0 + b.2).contains(&x) && (b.1..b.1 + b.2).contains(&y));
                hit.map_or((0, 0), |b| if b.3 == 0 { (255, 0) } else { (0, 255) })
            });
            for (i, v) in samples.iter().enumerate() {
                let sum: f32 = plates.iter().map(|p| p[i]).sum();
                prop_assert!((sum - v).abs() < 1e-5, "{i}: {sum} of {v}");
            }
        }
    }
}
