//! Things that belong together, found pair by pair (union-find).

/// Disjoint sets of indices from 0; each is named by its smallest one.
#[derive(Debug)]
pub struct Sets(Vec<usize>);

impl Sets {
    /// `count` sets of one index each.
    #[must_use]
    pub fn new(count: usize) -> Self {
        Self((0..count).collect())
    }

    /// The smallest index of the set that one is in; panics outside of `0..count`.
    pub fn first(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }

    /// Makes the sets of two indices one.
    pub fn join(&mut self, i: usize, j: usize) {
        let (a, b) = (self.first(i), self.first(j));
        self.0[a.max(b)] = a.min(b);
    }

    /// The sets in the order of their smallest indices, each in order.
    #[must_use]
    pub fn into_groups(mut self) -> Vec<Vec<usize>> {
        let mut groups: Vec<Vec<usize>> = Vec::new();
        let mut place = vec![usize::MAX; self.0.len()];
        for i in 0..self.0.len() {
            let first = self.first(i);
            if first == i {
                place[i] = groups.len();
                groups.push(Vec::new());
            }
            groups[place[first]].push(i);
        }
        groups
    }
}

#[cfg(test)]
mod tests {
    use super::Sets;

    #[test]
    fn sets_hold_what_was_joined_in_any_order() {
        let pairs = [(5, 2), (0, 4), (2, 7), (7, 5), (3, 3)];
        let of = |pairs: &mut dyn Iterator<Item = (usize, usize)>| {
            let mut sets = Sets::new(8);
            pairs.for_each(|(i, j)| sets.join(i, j));
            sets.into_groups()
        };
        let groups = of(&mut pairs.into_iter());
        let expected: [&[usize]; 5] = [&[0, 4], &[1], &[2, 5, 7], &[3], &[6]];
        assert_eq!(groups, expected);
        assert_eq!(groups, of(&mut pairs.into_iter().rev()));
    }
}
