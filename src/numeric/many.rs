//! One function for every item of a list, on all threads where there are many.
//!
//! Items know nothing of each other, and answers come in the items' order: what comes out is the same on any number
//! of threads.

use rayon::prelude::*;

/// A list shorter than this is left to the thread that has it. A letter's contours are so few, and there threads have
/// other letters to do.
const MANY: usize = 8;

/// What `f` makes of each item.
pub fn each<T: Sync, R: Send>(items: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    if items.len() < MANY {
        items.iter().map(f).collect()
    } else {
        items.par_iter().map(&f).collect()
    }
}

/// Changes each item by `f`.
pub fn change<T: Send>(items: &mut [T], f: impl Fn(&mut T) + Sync) {
    if items.len() < MANY {
        items.iter_mut().for_each(f);
    } else {
        items.par_iter_mut().for_each(&f);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_and_many_keep_their_order() {
        for count in [0, 1, MANY - 1, MANY, 1000] {
            let mut items: Vec<usize> = (0..count).collect();
            let doubled: Vec<usize> = items.iter().map(|i| 2 * i).collect();
            assert_eq!(each(&items, |i| 2 * i), doubled);
            change(&mut items, |i| *i *= 2);
            assert_eq!(items, doubled);
        }
    }
}
