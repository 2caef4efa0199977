//! Shortest paths through stages: labels that are kept while nothing cheaper of their kind exists.
//!
//! A label stands at a stage and carries a key, the kind of its future: of two labels with one stage
//! and key only the cheaper is kept. With a key that says everything the future depends on, the
//! cheapest path is the optimum (Bellman); with a coarser one it is an upper bound. Stages are
//! worked through in increasing order, and every step leads to a later stage.

/// A label's number, in order of creation.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub struct Id(usize);

#[derive(Debug, Clone)]
struct Label<T> {
    cost: u64,
    prev: Option<Id>,
    item: T,
}

/// A label that nothing cheaper of its kind has replaced.
#[derive(Debug, Clone, Copy)]
struct Alive {
    key: u64,
    cost: u64,
    id: Id,
}

/// All labels made, and which of them are alive at each stage.
#[derive(Debug, Clone)]
pub struct Labels<T> {
    labels: Vec<Label<T>>,
    /// By key; costs are kept here too, since most questions end with them.
    alive: Vec<Vec<Alive>>,
    beyond: Vec<u64>,
}

impl<T> Labels<T> {
    /// No labels at `stages` stages.
    #[must_use]
    pub fn new(stages: usize) -> Self {
        Self {
            labels: Vec::new(),
            alive: vec![Vec::new(); stages],
            beyond: vec![u64::MAX; stages],
        }
    }

    /// Keeps a label if nothing of its stage and key costs as little; answers whether it was kept.
    /// A stage beyond the last is refused.
    pub fn offer(&mut self, place: (usize, u64), cost: u64, prev: Option<Id>, item: T) -> bool {
        let (stage, key) = place;
        let Some(alive) = self.alive.get_mut(stage) else {
            return false;
        };
        let new = Alive {
            key,
            cost,
            id: Id(self.labels.len()),
        };
        match alive.binary_search_by_key(&key, |a| a.key) {
            Ok(i) if alive[i].cost <= cost => return false,
            Ok(i) => alive[i] = new,
            Err(i) => alive.insert(i, new),
        }
        self.labels.push(Label { cost, prev, item });
        for least in self.beyond[..=stage].iter_mut().rev() {
            if *least <= cost {
                break;
            }
            *least = cost;
        }
        true
    }

    /// The labels alive at a stage, by key.
    #[must_use]
    pub fn at(&self, stage: usize) -> Vec<Id> {
        let alive = self.alive.get(stage);
        alive.map_or_else(Vec::new, |a| a.iter().map(|a| a.id).collect())
    }

    /// The least cost of any label at this stage or a later one.
    #[must_use]
    pub fn least_from(&self, stage: usize) -> u64 {
        self.beyond.get(stage).copied().unwrap_or(u64::MAX)
    }

    /// Whether a label of this stage, key and cost would be kept.
    #[must_use]
    pub fn wants(&self, place: (usize, u64), cost: u64) -> bool {
        let alive = self.alive.get(place.0);
        alive.is_some_and(|all| {
            let found = all.binary_search_by_key(&place.1, |a| a.key);
            found.map_or(true, |i| cost < all[i].cost)
        })
    }

    /// What a label costs.
    #[must_use]
    pub fn cost(&self, id: Id) -> u64 {
        self.labels[id.0].cost
    }

    /// What a label carries.
    #[must_use]
    pub fn item(&self, id: Id) -> &T {
        &self.labels[id.0].item
    }

    /// What the labels on the way to this one carry, first to last.
    #[must_use]
    pub fn path(&self, id: Id) -> Vec<&T> {
        let mut out = Vec::new();
        let mut next = Some(id);
        while let Some(id) = next {
            out.push(self.item(id));
            next = self.labels[id.0].prev;
        }
        out.reverse();
        out
    }
}
