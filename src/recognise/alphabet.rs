//! The letters of a reference, and the ranking of cells among them.

use super::dissimilar::{Curves, Way};
use super::ink::Ink;
use super::shape::Shape;
use super::skeleton::{Pruning, Skeleton};
use crate::numeric::median::median;
use crate::types::{Gray, Guides};
use serde::{Deserialize, Serialize};

/// The ways of matching one can choose.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Method {
    /// Aligned lines, their density, holes, marks and place.
    #[default]
    Shape,
    /// B-spline control points as printed.
    Bsplinematch,
    /// The same with free knots and the best affine map taken off.
    Bsplineaffine,
}

impl Method {
    /// Every method.
    #[must_use]
    pub const fn all() -> [Self; 3] {
        [Self::Shape, Self::Bsplinematch, Self::Bsplineaffine]
    }

    /// The word for it on the command line and in project files.
    #[must_use]
    pub const fn key(self) -> &'static str {
        match self {
            Self::Shape => "shape",
            Self::Bsplinematch => "bsplinematch",
            Self::Bsplineaffine => "bsplineaffine",
        }
    }

    /// One line for `khatt methods`.
    #[must_use]
    pub const fn about(self) -> &'static str {
        match self {
            Self::Shape => "lines aligned by the best affine map, dots and holes counted (default)",
            Self::Bsplinematch => {
                "control points of strokes at equal shares of arc length [bsplinematch sec. 4]"
            }
            Self::Bsplineaffine => "the same with free knots, starts and an affine map",
        }
    }

    /// The difference of distances that makes one letter e times likelier than another, from the distances
    /// at which right and wrong letters of the self-test were found.
    const fn temperature(self) -> f64 {
        match self {
            Self::Shape => 0.008,
            Self::Bsplinematch | Self::Bsplineaffine => 0.06,
        }
    }
}

/// How many references get the full comparison after the rough one.
const CANDIDATES: usize = 30;
/// Cells whose size and height must be known before a page's scale is believed.
const PAGE_CELLS: usize = 5;
/// Confidence from which a cell speaks for the page's scale.
const PAGE_CONFIDENCE: f64 = 0.6;

/// A letter of the reference, as a picture.
#[derive(Debug, Clone)]
pub struct Sample {
    /// What it is.
    pub label: String,
    /// Its picture.
    pub gray: Gray,
    /// Where its baseline is and how large an em, if known.
    pub guides: Option<Guides>,
}

/// A letter that a cell may hold.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Guess {
    /// The reference's label.
    pub label: String,
    /// How unlike the reference it is, from 0; comparable within one method only.
    pub distance: f64,
    /// How sure that it is this one, among all of the reference, 0…1.
    pub confidence: f64,
}

/// What is compared of a picture.
#[derive(Debug, Clone)]
enum Features {
    Shape(Box<Shape>),
    Curves(Curves, Way),
}

/// A picture made ready for comparison.
#[derive(Debug, Clone)]
pub struct Look {
    features: Option<Features>,
    /// Of the ink, px.
    height: f64,
    place: Place,
}

/// What is known of where the ink stands on its line.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// Top and bottom, em above the baseline.
    Line([f64; 2]),
    /// Its height alone, em.
    Height(f64),
    /// Nothing.
    Unknown,
}

impl Place {
    fn height(self) -> Option<f64> {
        match self {
            Self::Line([top, bottom]) => Some(top - bottom),
            Self::Height(height) => Some(height),
            Self::Unknown => None,
        }
    }

    /// Sum of the squared differences of top and bottom; where one of both has no line, as they lie best. 1 at most,
    /// and 0 where nothing is known.
    fn apart(self, other: Self) -> f64 {
        let squares = match (self, other) {
            (Self::Line(a), Self::Line(b)) => (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2),
            _ => match (self.height(), other.height()) {
                (Some(a), Some(b)) => (a - b).powi(2) / 2.0,
                _ => 0.0,
            },
        };
        squares.min(1.0)
    }
}

impl Look {
    /// Prepares a picture; `guides` where the page says where the baseline is.
    #[must_use]
    pub fn new(gray: &Gray, guides: Option<Guides>, method: Method) -> Self {
        let way = match method {
            Method::Shape => None,
            Method::Bsplinematch => Some(Way::Paper),
            Method::Bsplineaffine => Some(Way::Affine),
        };
        let Some(ink) = Ink::new(gray) else {
            return Self {
                features: None,
                height: 0.0,
                place: Place::Unknown,
            };
        };
        let place = match guides.filter(|g| g.px_per_em > 0.0) {
            Some(g) => {
                let em = |y: f64| (g.baseline_px - y) / g.px_per_em;
                Place::Line([em(ink.bounds.y0), em(ink.bounds.y1)])
            }
            None => Place::Unknown,
        };
        let features = match way {
            None => Features::Shape(Box::new(Shape::new(&ink))),
            Some(way) => Features::Curves(
                Curves::new(&Skeleton::new(&ink.whole(), Pruning::default()), way),
                way,
            ),
        };
        Self {
            features: Some(features),
            height: ink.bounds.height(),
            place,
        }
    }

    /// Whether there is no ink.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.features.is_none()
    }
}

/// Letters to choose from.
#[derive(Debug, Clone)]
pub struct Alphabet {
    method: Method,
    letters: Vec<(String, Look)>,
}

impl Alphabet {
    /// An alphabet of samples; those without ink are left out.
    #[must_use]
    pub fn new(samples: &[Sample], method: Method) -> Self {
        let look = |s: &Sample| (s.label.clone(), Look::new(&s.gray, s.guides, method));
        let letters = samples
            .iter()
            .map(look)
            .filter(|(_, l)| !l.is_empty())
            .collect();
        Self { method, letters }
    }

    /// Letters that the picture may be, likeliest first, each label once; none for a picture without ink.
    #[must_use]
    pub fn rank(&self, look: &Look) -> Vec<Guess> {
        let mut found: Vec<(usize, f64)> = match &look.features {
            None => return Vec::new(),
            Some(Features::Shape(shape)) => self.by_shape(shape, look.place),
            Some(Features::Curves(curves, way)) => self.by_curves(curves, *way),
        };
        found.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
        let mut guesses: Vec<Guess> = Vec::new();
        for (i, distance) in found {
            let label = &self.letters[i].0;
            if !guesses.iter().any(|g| g.label == *label) {
                guesses.push(Guess {
                    label: label.clone(),
                    distance,
                    confidence: 0.0,
                });
            }
        }
        let best = guesses.first().map_or(0.0, |g| g.distance);
        let weight = |d: f64| libm::exp(-(d - best) / self.method.temperature());
        let total: f64 = guesses.iter().map(|g| weight(g.distance)).sum();
        guesses
            .iter_mut()
            .for_each(|g| g.confidence = weight(g.distance) / total);
        guesses
    }

    fn by_shape(&self, shape: &Shape, place: Place) -> Vec<(usize, f64)> {
        let rough = self
            .letters
            .iter()
            .enumerate()
            .filter_map(|(i, (_, look))| match &look.features {
                Some(Features::Shape(s)) => Some((i, s.as_ref(), shape.rough(s))),
                _ => None,
            });
        let mut rough: Vec<_> = rough.collect();
        rough.sort_by(|a, b| a.2.total_cmp(&b.2).then(a.0.cmp(&b.0)));
        rough.truncate(CANDIDATES);
        let full = |&(i, s, r): &(usize, &Shape, f32)| {
            let apart = place.apart(self.letters[i].1.place);
            (i, f64::from(shape.distance(s, r)) + PLACE * apart)
        };
        rough.iter().map(full).collect()
    }

    fn by_curves(&self, curves: &Curves, way: Way) -> Vec<(usize, f64)> {
        let all = self
            .letters
            .iter()
            .enumerate()
            .filter_map(|(i, (_, look))| match &look.features {
                Some(Features::Curves(c, _)) => Some((i, curves.distance(c, way))),
                _ => None,
            });
        all.collect()
    }

    /// Takes the reference's proportions off a page: finds the scale and height that take the ink of surely known
    /// cells to the reference's, and puts every cell's place in the reference's em. Cells without a baseline give
    /// their heights alone, where these are of one scale. Where too few are sure, places are forgotten and shapes
    /// alone decide.
    pub fn settle_page(&self, looks: &mut [Look]) {
        let (mut lines, mut heights) = (Vec::new(), Vec::new());
        for look in looks.iter() {
            let blind = Look {
                place: Place::Unknown,
                ..look.clone()
            };
            let best = self.rank(&blind).into_iter().next();
            let sure = best.filter(|g| g.confidence >= PAGE_CONFIDENCE);
            let letter = sure.and_then(|g| self.letters.iter().find(|(l, _)| *l == g.label));
            if let Some(there @ Place::Line(line)) = letter.map(|l| l.1.place) {
                match look.place {
                    Place::Line(here) => lines.push((here, line)),
                    _ => heights.extend(there.height().map(|h| (look.height, h))),
                }
            }
        }
        let line = (lines.len() >= PAGE_CELLS).then(|| page_map(&lines));
        let scale = (heights.len() >= PAGE_CELLS).then(|| page_scale(&heights));
        let scale = scale.flatten();
        for look in looks {
            look.place = match (look.place, line, scale) {
                (Place::Line(p), Some((scale, shift)), _) => {
                    Place::Line(p.map(|v| scale * v + shift))
                }
                (Place::Unknown, _, Some(scale)) => Place::Height(scale * look.height),
                _ => Place::Unknown,
            };
        }
    }
}

/// Heights of one page differ from the reference's by this at most, median of the ratios' logarithms.
const ONE_SCALE: f64 = 0.2;
/// Weight of squared differences of top and bottom, em².
const PLACE: f64 = 0.2;

/// Scale and shift by medians: what half of the cells get wrong does no harm.
fn page_map(pairs: &[([f64; 2], [f64; 2])]) -> (f64, f64) {
    let height = |p: &[f64; 2]| (p[0] - p[1]).max(1e-6);
    let scale = median(pairs.iter().map(|(a, b)| height(b) / height(a))).unwrap_or_default();
    let shifts = pairs
        .iter()
        .flat_map(|(a, b)| [b[0] - scale * a[0], b[1] - scale * a[1]]);
    (scale, median(shifts).unwrap_or_default())
}

/// Em a pixel by heights in both; nothing where they differ too much to be of one scale.
fn page_scale(pairs: &[(f64, f64)]) -> Option<f64> {
    let ratios = || {
        pairs
            .iter()
            .map(|(px, em)| libm::log((em / px.max(1e-6)).max(1e-9)))
    };
    let middle = median(ratios())?;
    let spread = median(ratios().map(|r| (r - middle).abs()))?;
    (spread <= ONE_SCALE).then(|| libm::exp(middle))
}
