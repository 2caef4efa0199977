//! The last touch to welded spans: joins that turned out smooth.

use super::found::Found;
use crate::numeric::joins::{is_soft, soften};

/// No corner is smoothed that this moves a point further off than it was, px.
const GIVE_PX: f64 = 0.25;

/// Makes corners smooth that hardly turn, where the points allow it.
pub(super) fn smooth(found: &mut Found) {
    let soft: Vec<usize> = (0..found.chain.nodes.len())
        .filter(|&i| is_soft(&found.chain, i))
        .collect();
    if soft.is_empty() {
        return;
    }
    if !smoothed(found, &soft) && soft.len() > 1 {
        for i in soft {
            smoothed(found, &[i]);
        }
    }
}

/// Makes the joins of some nodes smooth; leaves all as it was, and says so, where a span's points do not allow it.
fn smoothed(found: &mut Found, soft: &[usize]) -> bool {
    let (chain, feet, worst) = (found.chain.clone(), found.feet.clone(), found.worst());
    for &i in soft {
        soften(&mut found.chain.nodes[i]);
    }
    found.settle(20, 1e-3);
    let better = found.chain.to_path().is_finite()
        && found
            .worst()
            .iter()
            .zip(worst)
            .all(|(now, was)| *now <= was + GIVE_PX);
    if !better {
        (found.chain, found.feet) = (chain, feet);
    }
    better
}
