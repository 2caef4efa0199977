//! The ink's rings → where joining strokes of both letters lie in line with each other.
//!
//! Such strokes have no corner where one ends and the other begins: what is known is where the letters' middles are.

use super::across::Across;
use crate::numeric::cast::index;
use kurbo::Point;

/// The sides of a stroke that runs along the row go along it, by the cosine of their angle to it, and are so many
/// strokes apart.
const ALONG: f64 = 0.97;
const WIDTHS: [f64; 2] = [0.4, 1.6];
/// So many points to either side tell which way an edge goes.
const BESIDE: usize = 3;
/// Width of the columns that rings are looked at in, px: each has a point of every edge that passes it.
const COLUMN_PX: f64 = 2.0;
/// The strokes meet no farther from where the middles say than so many halves of the border's stretch.
const NEAR: f64 = 0.5;

/// A point of a ring: which ring, and which of its points.
pub(super) type Place = (usize, usize);

/// Where an edge passes a column.
#[derive(Debug, Clone, Copy)]
struct Pass {
    /// How far up, px.
    up: f64,
    /// Cosine of its angle to the row.
    along: f64,
    place: Place,
}

/// The lower and the upper side of the stroke along the row that is nearest to where the letters meet, if their
/// `middles` are where they belong, halves of the border's stretch behind it.
pub(super) fn joint(
    rings: &[Vec<Point>],
    stroke: f64,
    across: &Across,
    middles: [Option<f64>; 2],
) -> Option<[Place; 2]> {
    let meeting = meeting(rings, across, middles)?;
    let off = |p: &Pass| (across.at(rings[p.place.0][p.place.1]) - meeting).abs();
    let is_stroke = |sides: &&[Pass]| {
        let width = (sides[1].up - sides[0].up) / stroke;
        // the ink of a ring lies on its left
        sides[0].along > ALONG
            && sides[1].along < -ALONG
            && (WIDTHS[0]..WIDTHS[1]).contains(&width)
            && off(&sides[0]) < NEAR
    };
    let columns = columns(rings, across);
    let strokes = columns.iter().flat_map(|c| c.windows(2).filter(is_stroke));
    let nearest = strokes.min_by(|a, b| off(&a[0]).total_cmp(&off(&b[0])))?;
    Some([nearest[0].place, nearest[1].place])
}

/// Where one letter ends and the next one begins: the mean of what either's other end says.
fn meeting(rings: &[Vec<Point>], across: &Across, middles: [Option<f64>; 2]) -> Option<f64> {
    let all = || rings.iter().flatten().map(|&p| across.at(p));
    let first = all().fold(f64::INFINITY, f64::min);
    let last = all().fold(f64::NEG_INFINITY, f64::max);
    let ends = middles.into_iter().zip([first, last]);
    let ends: Vec<f64> = ends
        .filter_map(|(middle, other)| Some(2.0 * middle? - other))
        .collect();
    (!ends.is_empty()).then(|| ends.iter().sum::<f64>() / ends.len() as f64)
}

/// Where rings pass narrow columns across the row near the border, from below.
fn columns(rings: &[Vec<Point>], across: &Across) -> Vec<Vec<Pass>> {
    let along = across.along();
    let column = |p: Point| index((across.at(p) + 1.0) / (COLUMN_PX * across.step()));
    let mut columns = vec![Vec::new(); index(2.0 / (COLUMN_PX * across.step())) + 1];
    for (r, points) in rings.iter().enumerate() {
        let n = points.len();
        for i in (0..n).filter(|&i| across.at(points[i]).abs() <= 1.0) {
            let way = points[(i + BESIDE) % n] - points[(i + n - BESIDE % n) % n];
            let pass = Pass {
                up: along.cross(points[i].to_vec2()),
                along: way.dot(along) / way.hypot().max(f64::MIN_POSITIVE),
                place: (r, i),
            };
            if let Some(passes) = columns.get_mut(column(points[i])) {
                passes.push(pass);
            }
        }
    }
    for passes in &mut columns {
        passes.sort_by(|a: &Pass, b| a.up.total_cmp(&b.up));
    }
    columns
}
