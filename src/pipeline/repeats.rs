//! Several drawings of one glyph.

use super::letter::Letter;
use crate::assemble::{Note, names};
use crate::numeric::distance::Polyline;
use crate::types::{Label, Name};
use kurbo::{BezPath, flatten};
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// What becomes of glyphs that are drawn more than once.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Repeated {
    /// The drawing whose edge strays least from its smooth outline is taken.
    #[default]
    Best,
    /// The first is the glyph, the others are its alternates in the stylistic sets `ss01`, `ss02` …
    Alternates,
    /// They are an error.
    Error,
}

/// Chords of outlines leave their curves by no more than this, px.
const CHORD_PX: f64 = 0.05;
/// Stylistic sets of OpenType.
const SETS: usize = 20;

/// The letters with each glyph drawn once, in the order of the first, and what was decided.
pub(super) fn settle(letters: Vec<Letter>, repeated: Repeated) -> (Vec<Letter>, Vec<Note>) {
    let mut drawings: BTreeMap<Name, Vec<usize>> = BTreeMap::new();
    for (i, letter) in letters.iter().enumerate() {
        if let Ok(identity) = names::identify(&letter.label) {
            drawings.entry(identity.name).or_default().push(i);
        }
    }
    drawings.retain(|_, all| all.len() > 1);
    let (mut out, mut notes) = (BTreeSet::new(), Vec::new());
    let mut letters = letters;
    for (name, all) in &drawings {
        match repeated {
            Repeated::Alternates => {
                for (set, &i) in all.iter().skip(1).take(SETS).enumerate() {
                    letters[i].label = Label(format!("{name}.ss{:02}", set + 1));
                }
                out.extend(all.iter().skip(SETS + 1).copied());
            }
            Repeated::Best | Repeated::Error => {
                let noise = |&&i: &&usize| noise(&letters[i]);
                let best = all
                    .iter()
                    .min_by(|a, b| noise(a).total_cmp(&noise(b)))
                    .copied();
                out.extend(all.iter().copied().filter(|&i| Some(i) != best));
                notes.extend(best.map(|i| Note {
                    glyph: name.to_string(),
                    message: format!(
                        "drawn {} times; the drawing with the calmest edge is taken, {}",
                        all.len(),
                        letters[i].spot()
                    ),
                }));
            }
        }
    }
    let kept = letters
        .into_iter()
        .enumerate()
        .filter(|(i, _)| !out.contains(i));
    (kept.map(|(_, letter)| letter).collect(), notes)
}

/// Root mean square distance of the scanned edge from the outline, as a share of the em.
#[expect(
    clippy::cast_precision_loss,
    reason = "letters have fewer points than 2^52"
)]
fn noise(letter: &Letter) -> f64 {
    let lines: Vec<Polyline> = letter.paths.iter().filter_map(chords).collect();
    let distances = letter.edge.iter().flat_map(|c| c.points()).map(|&p| {
        let each = lines.iter().map(|l| l.nearest(p).distance);
        each.fold(f64::INFINITY, f64::min)
    });
    let (sum, n) = distances.fold((0.0, 0usize), |(s, n), d| (s + d * d, n + 1));
    (sum / n.max(1) as f64).sqrt() / letter.guides.px_per_em
}

fn chords(contour: &BezPath) -> Option<Polyline> {
    let mut points = Vec::new();
    flatten(contour, CHORD_PX, |el| points.extend(el.end_point()));
    points.extend(points.first().copied());
    Polyline::new(points)
}
