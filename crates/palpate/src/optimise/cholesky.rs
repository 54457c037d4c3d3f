//! Cholesky factorisation for the small matrices of a fit (up to a few dozen rows).

use smallvec::SmallVec;

/// A few numbers; those of every usual law without a trip to the heap.
pub(crate) type Few = SmallVec<[f64; 8]>;

/// A square matrix of as many rows, row-major; up to five without a trip to the heap.
pub(crate) type Square = SmallVec<[f64; 25]>;

/// Lower triangle of a symmetric positive definite matrix, factored.
pub(crate) struct Cholesky {
    size: usize,
    lower: Square,
    scale: Few,
}

impl Cholesky {
    /// Factors `matrix` (row-major, `size` × `size`) after scaling its diagonal to one; `None` if it is singular to rounding.
    pub(crate) fn new(matrix: &[f64], size: usize) -> Option<Self> {
        let mut made = Self {
            size,
            lower: Square::from_elem(0.0, size * size),
            scale: Few::from_elem(1.0, size),
        };
        let (lower, scale) = (&mut made.lower, &mut made.scale);
        for (i, scale) in scale.iter_mut().enumerate() {
            *scale /= matrix[i * (size + 1)].sqrt();
        }
        if scale.iter().any(|s| !s.is_finite()) {
            return None;
        }
        for i in 0..size {
            for j in 0..=i {
                let mut sum = matrix[i * size + j] * scale[i] * scale[j];
                for k in 0..j {
                    sum -= lower[i * size + k] * lower[j * size + k];
                }
                if i == j {
                    // The diagonal was one; what is left of it is the squared distance from the rows before.
                    if sum <= size as f64 * f64::EPSILON {
                        return None;
                    }
                    lower[i * size + i] = sum.sqrt();
                } else {
                    lower[i * size + j] = sum / lower[j * size + j];
                }
            }
        }
        Some(made)
    }

    /// Solves in place.
    pub(crate) fn solve(&self, right: &mut [f64]) {
        let n = self.size;
        for i in 0..n {
            let mut sum = right[i] * self.scale[i];
            for (entry, known) in self.lower[i * n..].iter().zip(&right[..i]) {
                sum -= entry * known;
            }
            right[i] = sum / self.lower[i * n + i];
        }
        for i in (0..n).rev() {
            let mut sum = right[i];
            for (k, known) in right.iter().enumerate().skip(i + 1) {
                sum -= self.lower[k * n + i] * known;
            }
            right[i] = sum / self.lower[i * n + i];
        }
        for (value, scale) in right.iter_mut().zip(&self.scale) {
            *value *= scale;
        }
    }

    /// ln of the determinant.
    pub(crate) fn log_determinant(&self) -> f64 {
        (0..self.size).map(|i| 2.0 * (self.lower[i * self.size + i] / self.scale[i]).ln()).sum()
    }

    /// Column `j` of the lower factor.
    pub(crate) fn column(&self, j: usize) -> Vec<f64> {
        (0..self.size).map(|i| self.lower[i * self.size + j] / self.scale[i]).collect()
    }

    /// The inverse, row-major.
    pub(crate) fn inverse(&self) -> Vec<f64> {
        let n = self.size;
        let mut inverse = vec![0.0; n * n];
        for j in 0..n {
            let mut column = Few::from_elem(0.0, n);
            column[j] = 1.0;
            self.solve(&mut column);
            for i in 0..n {
                inverse[i * n + j] = column[i];
            }
        }
        inverse
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::statistics::dot;

    #[test]
    fn solves_and_refuses() {
        let matrix = [4.0, 2.0, 0.6, 2.0, 5.0, 1.0, 0.6, 1.0, 3.0];
        let factor = Cholesky::new(&matrix, 3).unwrap();
        let mut x = [1.0, -2.0, 0.5];
        factor.solve(&mut x);
        for i in 0..3 {
            let back = dot(&matrix[3 * i..3 * i + 3], &x);
            assert!((back - [1.0, -2.0, 0.5][i]).abs() < 1e-14);
        }
        // 4·(15 − 1) − 2·(6 − 0.6) + 0.6·(2 − 3)
        assert!((factor.log_determinant() - 44.6f64.ln()).abs() < 1e-14);
        let (first, last) = (factor.column(0), factor.column(2));
        assert!((first[0] * first[2] - 0.6).abs() < 1e-15 && last[0] == 0.0);
        assert!(Cholesky::new(&[1.0, 1.0, 1.0, 1.0], 2).is_none());
        assert!(Cholesky::new(&[1.0, 0.0, 0.0, 0.0], 2).is_none());
    }
}
