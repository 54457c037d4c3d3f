//! Small systems of equations.

/// Replaces `right` by the solution of the system, by elimination with row exchange; `false` if a pivot is not above `least`, or
/// the solution not finite.
pub(crate) fn eliminate<const N: usize>(mut matrix: [[f64; N]; N], right: &mut [f64; N], least: f64) -> bool {
    for column in 0..N {
        let size = |row: &usize| matrix[*row][column].abs();
        let pivot = (column..N).max_by(|a, b| size(a).total_cmp(&size(b))).unwrap_or(column);
        let found = matrix[pivot][column];
        if !(found.abs() > least && found.is_finite()) {
            return false;
        }
        matrix.swap(column, pivot);
        right.swap(column, pivot);
        let (upper, lower) = matrix.split_at_mut(column + 1);
        let known = upper[column];
        for (row, numbers) in lower.iter_mut().enumerate() {
            let factor = numbers[column] / known[column];
            for (number, known) in numbers.iter_mut().zip(known) {
                *number -= factor * known;
            }
            right[column + 1 + row] -= factor * right[column];
        }
    }
    for row in (0..N).rev() {
        let known: f64 = (row + 1..N).map(|column| matrix[row][column] * right[column]).sum();
        right[row] = (right[row] - known) / matrix[row][row];
    }
    right.iter().all(|value| value.is_finite())
}

/// A sum of N functions fitted to values: their factors, and the weighted squares that they leave.
#[derive(Debug, Clone, Copy)]
pub(crate) struct LinearFit<const N: usize> {
    pub(crate) factors: [f64; N],
    pub(crate) left: f64,
}

/// Least squares over rows of function values, value and weight; `None` for fewer rows than functions, and where a pivot is not above
/// `least` times the largest entry of the normal equations.
pub(crate) fn fit_linear<const N: usize>(
    rows: impl IntoIterator<Item = ([f64; N], f64, f64)>,
    least: f64,
) -> Option<LinearFit<N>> {
    let (mut matrix, mut right, mut squares, mut count) = ([[0.0; N]; N], [0.0; N], 0.0, 0);
    for (row, value, weight) in rows {
        for ((own, equation), right) in row.iter().zip(&mut matrix).zip(&mut right) {
            equation.iter_mut().zip(row).for_each(|(entry, other)| *entry += weight * own * other);
            *right += weight * own * value;
        }
        squares += weight * value * value;
        count += 1;
    }
    let largest = matrix.iter().flatten().fold(0.0, |most: f64, entry| most.max(entry.abs()));
    let mut factors = right;
    if count < N || !eliminate(matrix, &mut factors, least * largest) {
        return None;
    }
    let explained: f64 = factors.iter().zip(&right).map(|(a, b)| a * b).sum();
    let left = (squares - explained).max(0.0);
    Some(LinearFit { factors, left })
}
