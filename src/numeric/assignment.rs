//! Who goes with whom at the least total cost.

/// For each row the column it is given, so that the sum of costs is least; every row gets one and no column
/// is given twice. Rows must not outnumber columns, and rows have the same length; costs are finite.
///
/// The Hungarian method with potentials, O(rows² columns) [kuhn55 sec. 3]: each row in turn sets off along a
/// shortest path of reduced costs to a column that is still free.
#[must_use]
pub fn assign(costs: &[Vec<f64>]) -> Vec<usize> {
    let (n, m) = (costs.len(), costs.first().map_or(0, Vec::len));
    // Row and column 0 are a start of their own; real ones count from 1.
    let (mut u, mut v) = (vec![0.0; n + 1], vec![0.0; m + 1]);
    let mut row_of = vec![0_usize; m + 1];
    for i in 1..=n.min(m) {
        row_of[0] = i;
        let mut least = vec![f64::INFINITY; m + 1];
        let mut before = vec![0_usize; m + 1];
        let mut done = vec![false; m + 1];
        let mut at = 0;
        while row_of[at] != 0 {
            done[at] = true;
            let row = row_of[at];
            let (mut step, mut next) = (f64::INFINITY, 0);
            for j in (1..=m).filter(|&j| !done[j]) {
                let reduced = costs[row - 1][j - 1] - u[row] - v[j];
                if reduced < least[j] {
                    (least[j], before[j]) = (reduced, at);
                }
                if least[j] < step {
                    (step, next) = (least[j], j);
                }
            }
            for j in 0..=m {
                if done[j] {
                    u[row_of[j]] += step;
                    v[j] -= step;
                } else {
                    least[j] -= step;
                }
            }
            at = next;
            if at == 0 {
                break; // only costs that are not finite are left
            }
        }
        while at != 0 {
            row_of[at] = row_of[before[at]];
            at = before[at];
        }
    }
    let mut column = vec![0; n];
    for (j, row) in row_of[1..].iter().enumerate() {
        if let Some(i) = row.checked_sub(1) {
            column[i] = j;
        }
    }
    column
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_sum_of_all_permutations() {
        // Costs from a congruence; the least sum of 5 × 5 by trying all 120 ways.
        let mut x = 7_u32;
        let mut next = || {
            x = x.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from(x >> 24)
        };
        fn best(costs: &[Vec<f64>], taken: &mut Vec<usize>) -> f64 {
            let i = taken.len();
            if i == costs.len() {
                return 0.0;
            }
            let mut least = f64::INFINITY;
            for j in 0..costs[i].len() {
                if !taken.contains(&j) {
                    taken.push(j);
                    least = least.min(costs[i][j] + best(costs, taken));
                    taken.pop();
                }
            }
            least
        }
        for columns in [5, 5, 5, 6, 7] {
            let costs: Vec<Vec<f64>> = (0..5)
                .map(|_| (0..columns).map(|_| next()).collect())
                .collect();
            let given = assign(&costs);
            let sum: f64 = given.iter().enumerate().map(|(i, &j)| costs[i][j]).sum();
            assert!((sum - best(&costs, &mut Vec::new())).abs() < 1e-9);
            let mut once = given.clone();
            once.sort_unstable();
            once.dedup();
            assert_eq!(once.len(), 5, "a column was given twice: {given:?}");
        }
        assert!(assign(&[]).is_empty());
    }
}
