//! The value in the middle, and others by their rank.

use super::cast::index;
use std::cmp::Ordering;

/// A standard deviation in medians of the distance from the median, where values are normal ones.
pub const NORMAL: f64 = 1.4826;

/// The middle value, or the mean of the two in the middle; `None` of no values. Order does not matter.
#[must_use]
pub fn median(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let mut values: Vec<f64> = values.into_iter().collect();
    let middle = values.len() / 2;
    if values.is_empty() {
        return None;
    }
    let even = values.len().is_multiple_of(2);
    let (below, high, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    let low = below.iter().copied().filter(|_| even);
    let low = low.max_by(f64::total_cmp).unwrap_or(*high);
    Some(f64::midpoint(low, *high))
}

/// The value below which this share of the others lies; `None` of no values. They change places.
#[must_use]
pub fn quantile<T: Copy>(
    values: &mut [T],
    share: f64,
    order: impl Fn(&T, &T) -> Ordering,
) -> Option<T> {
    let last = values.len().checked_sub(1)?;
    let place = index(share * last as f64);
    Some(*values.select_nth_unstable_by(place, order).1)
}

/// The value in the middle, of two the later one in this order; `None` of no values.
#[must_use]
pub fn middle<T: Copy>(
    values: impl IntoIterator<Item = T>,
    order: impl Fn(&T, &T) -> Ordering,
) -> Option<T> {
    let mut values: Vec<T> = values.into_iter().collect();
    let place = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(place, order).1)
}

/// The value with half of all weights before it, where each comes with one; `None` of no weights.
#[must_use]
pub fn weighted(values: impl IntoIterator<Item = (f64, usize)>) -> Option<f64> {
    let mut values: Vec<(f64, usize)> = values.into_iter().collect();
    values.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = values.iter().map(|v| v.1).sum::<usize>() / 2;
    let mut sum = 0;
    let middle = values.iter().find(|v| {
        sum += v.1;
        sum > half
    });
    middle.map(|v| v.0)
}

/// The least and the greatest value; of no values infinity and its negative.
#[must_use]
pub fn range<'a>(values: impl IntoIterator<Item = &'a f32>) -> (f32, f32) {
    let none = (f32::INFINITY, f32::NEG_INFINITY);
    let wider = |(least, most): (f32, f32), v: &f32| (least.min(*v), most.max(*v));
    values.into_iter().fold(none, wider)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_few_values() {
        assert_eq!(median([]), None);
        assert_eq!(median([3.0]), Some(3.0));
        assert_eq!(median([3.0, 1.0]), Some(2.0));
        assert_eq!(median([9.0, 1.0, 2.0]), Some(2.0));
        assert_eq!(median([9.0, 4.0, 1.0, 2.0]), Some(3.0));
    }

    #[test]
    fn ranks_and_ends() {
        let mut values = [3.0, 1.0, 4.0, 1.5, 5.0];
        let ranks = [0.0, 0.5, 0.99, 1.0].map(|s| quantile(&mut values, s, f32::total_cmp));
        assert_eq!(ranks, [1.0, 3.0, 4.0, 5.0].map(Some));
        assert_eq!(quantile(&mut [], 0.5, f32::total_cmp), None);
        assert_eq!(range(&values), (1.0, 5.0));
        assert_eq!(range(&[]), (f32::INFINITY, f32::NEG_INFINITY));
    }
}
