//! Balanced Latin squares (Williams 1949): orders that favour no place and no predecessor.

/// Returns the rows of a balanced Latin square of the numbers below `n`: over all rows, each number comes equally often
/// in each place, and equally often right after each other number. There are `n` rows, or `2 * n` if `n` is odd (except
/// 1).
pub fn balanced_square(n: usize) -> Vec<Vec<usize>> {
    // 0, 1, n - 1, 2, n - 2, ...: all differences of neighbours are distinct.
    let first: Vec<usize> =
        (0..n).map(|i| if i % 2 == 1 { i.div_ceil(2) } else { (n - i / 2) % n }).collect();
    let mut rows: Vec<Vec<usize>> =
        (0..n).map(|row| first.iter().map(|number| (number + row) % n).collect()).collect();
    if n % 2 == 1 && n > 1 {
        rows.extend(rows.clone().into_iter().map(|row| row.into_iter().rev().collect()));
    }
    rows
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn all_equal(keys: impl Iterator<Item = [usize; 2]>, different: usize) -> bool {
        let mut counts = BTreeMap::new();
        keys.for_each(|key| *counts.entry(key).or_insert(0) += 1);
        counts.len() == different && counts.values().all(|count| Some(count) == counts.values().next())
    }

    #[test]
    fn places_and_neighbours_are_equally_frequent() {
        for n in 1..=9 {
            let square = balanced_square(n);
            assert_eq!(square.len(), if n % 2 == 1 && n > 1 { 2 * n } else { n });
            let places =
                square.iter().flat_map(|row| row.iter().enumerate().map(|(at, number)| [at, *number]));
            assert!(all_equal(places, n * n), "{n}: {square:?}");
            let neighbours = square.iter().flat_map(|row| row.windows(2).map(|pair| [pair[0], pair[1]]));
            assert!(n == 1 || all_equal(neighbours, n * (n - 1)), "{n}: {square:?}");
        }
    }
}
