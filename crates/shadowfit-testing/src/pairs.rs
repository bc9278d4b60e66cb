//! Short lists of option combinations that contain every pair of values.
//!
//! Most faults that depend on options need only two particular values. A list with every pair finds these
//! faults with a fraction of the full product (Cohen, Dalal, Fredman, Patton, "The AETG system", 1997).

/// Values of two columns that occur in a row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Pair {
    columns: [usize; 2],
    values: [usize; 2],
}

/// Returns rows with one value per column, so that every pair of values of two columns occurs in a row.
/// `counts` is the number of values of each column. The rows are the same in every run.
///
/// # Panics
///
/// If a column has no values, or there are less than two columns.
pub fn all_pairs(counts: &[usize]) -> Vec<Vec<usize>> {
    assert!(counts.len() >= 2, "pairs need two columns");
    assert!(!counts.contains(&0), "every column needs a value: {counts:?}");
    let mut missing = pairs_of(counts);
    let mut rows = Vec::new();
    while let Some(first) = missing.first() {
        let mut row = vec![None; counts.len()];
        for (column, value) in first.columns.into_iter().zip(first.values) {
            row[column] = Some(value);
        }
        for column in 0..counts.len() {
            if row[column].is_none() {
                row[column] = Some(best_value(&row, column, counts[column], &missing, rows.len()));
            }
        }
        let row: Vec<usize> = row.into_iter().flatten().collect();
        missing.retain(|pair| pair.columns.map(|column| row[column]) != pair.values);
        rows.push(row);
    }
    rows
}

/// Returns the full product: a row for each combination of one value per column.
pub fn full_product(counts: &[usize]) -> Vec<Vec<usize>> {
    counts.iter().fold(vec![Vec::new()], |rows, count| {
        rows.iter().flat_map(|row| (0..*count).map(move |value| [&row[..], &[value]].concat())).collect()
    })
}

/// Returns every pair, in order.
fn pairs_of(counts: &[usize]) -> Vec<Pair> {
    let mut pairs = Vec::new();
    for second in 0..counts.len() {
        for first in 0..second {
            for a in 0..counts[first] {
                pairs.extend((0..counts[second]).map(|b| Pair { columns: [first, second], values: [a, b] }));
            }
        }
    }
    pairs
}

/// Returns the value of a column that adds the most missing pairs with the values already in the row. Ties
/// are broken differently in each row, so that values without a gain are also spread evenly.
fn best_value(row: &[Option<usize>], column: usize, count: usize, missing: &[Pair], turn: usize) -> usize {
    let gain = |value: usize| {
        let is_chosen = |of: usize, wanted: usize| if of == column { wanted == value } else { row[of] == Some(wanted) };
        let brings = |pair: &&Pair| {
            pair.columns.contains(&column) && (0..2).all(|side| is_chosen(pair.columns[side], pair.values[side]))
        };
        missing.iter().filter(brings).count()
    };
    let in_turn = (0..count).map(|step| (step + turn) % count);
    in_turn.rev().max_by_key(|value| gain(*value)).expect("a column has values")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_full_product_holds_every_combination_once() {
        let rows = full_product(&[2, 3]);
        assert_eq!(rows, [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [1, 2]]);
    }

    #[test]
    fn every_pair_of_values_occurs_in_few_rows() {
        for counts in [&[2, 3][..], &[6, 9, 2, 2, 2], &[1, 4, 1], &[3; 8], &[15, 6, 9, 2, 2, 2]] {
            let rows = all_pairs(counts);
            assert!(rows.iter().all(|row| row.iter().zip(counts).all(|(value, count)| value < count)));
            for Pair { columns: [a, b], values } in pairs_of(counts) {
                assert!(rows.iter().any(|row| [row[a], row[b]] == values), "{counts:?}: {a} and {b} with {values:?}");
            }
            let mut sorted = counts.to_vec();
            sorted.sort_unstable();
            let [.., a, b] = sorted[..] else { panic!("two columns") };
            // A list cannot be shorter than the product of the two longest columns.
            assert!(rows.len() >= a * b && rows.len() <= 2 * a * b + 3, "{counts:?}: {} rows", rows.len());
        }
    }
}
