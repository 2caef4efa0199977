//! Letters that nothing but dots tells apart, and what their skeletons keep of the dots.

use khatt::pipeline::reference::spelling;
use khatt::recognise::{Alphabet, Look, Method, Pruning, Sample, Skeleton};
use khatt::types::{Bitmap, Gray, Label};
use kurbo::{Circle, Point, Rect, Shape};
use std::f64::consts::PI;

/// Letters that are one but for dots.
pub(crate) const GROUPS: [&str; 9] = ["بتثني", "جحخ", "دذ", "رز", "سش", "صض", "طظ", "عغ", "فق"];
/// Px an em of the pictures that are compared with.
const REFERENCE: f64 = 150.0;

/// How the pairs of letters fared.
#[derive(Debug, Default)]
pub(crate) struct Told {
    pub(crate) pairs: usize,
    /// Pairs with the same parts beside the body.
    pub(crate) alike: Vec<String>,
    /// Letters read as others of their group.
    pub(crate) misread: Vec<String>,
}

/// Compares the letters of each group, drawn at 150 px an em, as they are at `size` px an em.
pub(crate) fn compare(drawn: &[Sample], size: f64) -> Told {
    let mut told = Told::default();
    for group in GROUPS {
        let names: Vec<String> = group
            .chars()
            .map(|c| spelling(&Label(c.to_string())))
            .collect();
        let members: Vec<&Sample> = drawn.iter().filter(|s| names.contains(&s.label)).collect();
        let alphabet: Vec<Sample> = members.iter().map(|s| (*s).clone()).collect();
        let alphabet = Alphabet::new(&alphabet, Method::Shape);
        let small: Vec<(&str, Gray)> = members
            .iter()
            .map(|s| (s.label.as_str(), shrunk(&s.gray, REFERENCE / size)))
            .collect();
        for (i, (label, gray)) in small.iter().enumerate() {
            let guesses = alphabet.rank(&Look::new(gray, None, Method::Shape));
            if let Some(best) = guesses.first().filter(|g| g.label != *label) {
                told.misread.push(format!("{label}>{}", best.label));
            }
            for (other, gray_of_other) in &small[i + 1..] {
                told.pairs += 1;
                if Beside::new(gray).like(&Beside::new(gray_of_other)) {
                    told.alike.push(format!("{label}={other}"));
                }
            }
        }
    }
    told
}

/// Mean over squares of `by` px a side.
fn shrunk(gray: &Gray, by: f64) -> Gray {
    if by <= 1.0 {
        return gray.clone();
    }
    let side = |n: usize| index((n as f64 / by).ceil());
    let span = |i: usize| index(i as f64 * by)..index(((i + 1) as f64 * by).ceil());
    Gray::from_fn(side(gray.width()), side(gray.height()), |x, y| {
        let count = (span(x).len() * span(y).len()) as f32;
        let sums = span(y).map(|r| span(x).map(|c| gray.at(c, r)).sum::<f32>());
        sums.sum::<f32>() / count
    })
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a few hundred px"
)]
const fn index(v: f64) -> usize {
    v as usize
}

/// What stands beside the largest part of a letter's skeleton.
#[derive(Debug, Clone, Copy, Default)]
struct Beside {
    parts: usize,
    /// Ink, width and height of all, px.
    size: [f64; 3],
    /// Mean height over the body: 0 at its top, 1 at its bottom.
    place: f64,
}

impl Beside {
    fn new(gray: &Gray) -> Self {
        let skeleton = Skeleton::new(&Bitmap::threshold(gray, 0.5), Pruning::default());
        let mut parts = parts(&skeleton);
        parts.sort_by(|a, b| b.ink.total_cmp(&a.ink));
        let Some((body, rest)) = parts.split_first() else {
            return Self::default();
        };
        let Some(bounds) = rest.iter().map(|p| p.bounds).reduce(|a, b| a.union(b)) else {
            return Self::default();
        };
        let ink = rest.iter().map(|p| p.ink).sum();
        Self {
            parts: rest.len(),
            size: [ink, bounds.width(), bounds.height()],
            place: (bounds.center().y - body.bounds.y0) / body.bounds.height(),
        }
    }

    /// Whether nothing tells them apart: not their number, their ink, width or height by a quarter, nor their
    /// place by a sixth of the body.
    fn like(&self, other: &Self) -> bool {
        let near = |(a, b): (&f64, &f64)| a.min(*b) >= 0.75 * a.max(*b);
        self.parts == other.parts
            && self.size.iter().zip(&other.size).all(near)
            && (self.place - other.place).abs() < 1.0 / 6.0
    }
}

/// A part of a skeleton: strokes that meet, or a dot.
#[derive(Debug, Clone, Copy)]
struct Part {
    ink: f64,
    bounds: Rect,
}

fn parts(skeleton: &Skeleton) -> Vec<Part> {
    let n = skeleton.strokes.len();
    let mut group: Vec<usize> = (0..n).collect();
    let meet = |a: usize, b: usize| {
        let ends = |i: usize| skeleton.strokes[i].joins.iter().flatten();
        ends(a).any(|j| ends(b).any(|k| j == k))
    };
    for i in 0..n {
        for j in (0..i).filter(|j| meet(i, *j)) {
            let (from, to) = (group[i], group[j]);
            let moved = group.iter_mut().filter(|g| **g == from);
            moved.for_each(|g| *g = to);
        }
    }
    let of = |g: usize| {
        let strokes = skeleton.strokes.iter().zip(&group);
        let of_group = strokes.filter(|(_, h)| **h == g).map(|(s, _)| s);
        let discs = of_group.flat_map(|s| s.points.iter().zip(&s.half_widths));
        let part = |(at, half): (&Point, &f64)| Part {
            ink: 2.0 * half,
            bounds: Circle::new(*at, *half).bounding_box(),
        };
        discs.map(part).reduce(|a, b| Part {
            ink: a.ink + b.ink,
            bounds: a.bounds.union(b.bounds),
        })
    };
    let dots = skeleton.dots.iter().map(|d| Part {
        ink: PI * d.radius * d.radius,
        bounds: Circle::new(d.centre, d.radius).bounding_box(),
    });
    (0..n).filter_map(of).chain(dots).collect()
}
