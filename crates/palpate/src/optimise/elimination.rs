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
