//! Small symmetric linear systems.

/// Cholesky factor of a symmetric positive definite matrix of a few rows.
pub(crate) struct Cholesky<const N: usize> {
    lower: [[f64; N]; N],
}

impl<const N: usize> Cholesky<N> {
    /// Factor L with `L L^T` = matrix, or `None` where the matrix is not positive definite to working accuracy.
    pub(crate) fn new(matrix: &[[f64; N]; N]) -> Option<Self> {
        let mut lower = [[0.0; N]; N];
        for row in 0..N {
            for column in 0..=row {
                let known: f64 = (0..column).map(|k| lower[row][k] * lower[column][k]).sum();
                let rest = matrix[row][column] - known;
                if row == column {
                    // Below this the pivot is round-off of the entry that it was subtracted from.
                    let positive = rest > 1e-13 * matrix[row][row].abs() && rest.is_finite();
                    if !positive {
                        return None;
                    }
                    lower[row][row] = rest.sqrt();
                } else {
                    lower[row][column] = rest / lower[column][column];
                }
            }
        }
        Some(Self { lower })
    }

    /// Solution of `matrix x = right`.
    pub(crate) fn solve(&self, right: &[f64; N]) -> [f64; N] {
        let mut solution = *right;
        for row in 0..N {
            let known: f64 = (0..row).map(|k| self.lower[row][k] * solution[k]).sum();
            solution[row] = (solution[row] - known) / self.lower[row][row];
        }
        for row in (0..N).rev() {
            let known: f64 = (row + 1..N).map(|k| self.lower[k][row] * solution[k]).sum();
            solution[row] = (solution[row] - known) / self.lower[row][row];
        }
        solution
    }

    /// Inverse of the matrix: the covariance, where the matrix is an information.
    pub(crate) fn inverse(&self) -> [[f64; N]; N] {
        let mut inverse = [[0.0; N]; N];
        for column in 0..N {
            let mut unit = [0.0; N];
            unit[column] = 1.0;
            let solution = self.solve(&unit);
            for row in 0..N {
                inverse[row][column] = solution[row];
            }
        }
        inverse
    }
}

/// Coefficients of a weighted linear least-squares fit.
pub(crate) struct LeastSquares<const N: usize> {
    pub(crate) coefficients: [f64; N],
    /// Their covariance, where the weights are inverse squares of standard errors.
    pub(crate) covariance: [[f64; N]; N],
    pub(crate) chi_squared: f64,
}

/// Minimum of `sum_i weight_i (y_i - sum_k c_k basis_i,k)^2` over c; `None` where the basis is degenerate.
pub(crate) fn least_squares<const N: usize>(
    basis: impl Fn(usize) -> [f64; N],
    y: &[f64],
    weight: &[f64],
) -> Option<LeastSquares<N>> {
    let mut information = [[0.0; N]; N];
    let mut right = [0.0; N];
    for (index, (&y, &weight)) in y.iter().zip(weight).enumerate() {
        let functions = basis(index);
        for (right, function) in right.iter_mut().zip(functions) {
            *right += weight * function * y;
        }
        add_information(&mut information, weight, &functions);
    }
    let factor = Cholesky::new(&information)?;
    let coefficients = factor.solve(&right);
    let squared = |index: usize| {
        let functions = basis(index);
        let model: f64 = (0..N).map(|k| coefficients[k] * functions[k]).sum();
        weight[index] * (y[index] - model) * (y[index] - model)
    };
    Some(LeastSquares {
        coefficients,
        covariance: factor.inverse(),
        chi_squared: (0..y.len()).map(squared).sum(),
    })
}

/// Standard error of a weighted sum of numbers with a covariance.
pub(crate) fn error_of<const N: usize>(weights: &[f64; N], covariance: &[[f64; N]; N]) -> f64 {
    let mut variance = 0.0;
    for (row, left) in covariance.iter().zip(weights) {
        for (entry, right) in row.iter().zip(weights) {
            variance += left * entry * right;
        }
    }
    variance.max(0.0).sqrt()
}

/// Adds what an observation of this weight says of the coefficients of functions with these values.
pub(crate) fn add_information<const N: usize>(
    information: &mut [[f64; N]; N],
    weight: f64,
    functions: &[f64; N],
) {
    for (row, left) in information.iter_mut().zip(functions) {
        for (entry, right) in row.iter_mut().zip(functions) {
            *entry += weight * left * right;
        }
    }
}

/// Second derivatives of a function by central differences with the given steps.
pub(crate) fn curvature<const N: usize>(
    function: impl Fn(&[f64; N]) -> f64,
    at: &[f64; N],
    steps: &[f64; N],
) -> [[f64; N]; N] {
    let shifted = |moves: &[(usize, f64)]| {
        let mut place = *at;
        for &(axis, sign) in moves {
            place[axis] += sign * steps[axis];
        }
        function(&place)
    };
    let centre = function(at);
    let mut matrix = [[0.0; N]; N];
    for row in 0..N {
        matrix[row][row] = (shifted(&[(row, 1.0)]) - 2.0 * centre + shifted(&[(row, -1.0)]))
            / (steps[row] * steps[row]);
        for column in 0..row {
            let mixed = shifted(&[(row, 1.0), (column, 1.0)])
                - shifted(&[(row, 1.0), (column, -1.0)])
                - shifted(&[(row, -1.0), (column, 1.0)])
                + shifted(&[(row, -1.0), (column, -1.0)]);
            matrix[row][column] = mixed / (4.0 * steps[row] * steps[column]);
            matrix[column][row] = matrix[row][column];
        }
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_of_three_by_hand() {
        // A = L L^T with L = (2; 1 3; 0 1 1), x = (1, -1, 2).
        let matrix = [[4.0, 2.0, 0.0], [2.0, 10.0, 3.0], [0.0, 3.0, 2.0]];
        let factor = Cholesky::new(&matrix).unwrap();
        let solution = factor.solve(&[2.0, -2.0, 1.0]);
        for (found, expected) in solution.iter().zip([1.0, -1.0, 2.0]) {
            assert!((found - expected).abs() < 1e-13);
        }
        let inverse = factor.inverse();
        for (row, entries) in matrix.iter().enumerate() {
            let times_inverse =
                |column: usize| -> f64 { (0..3).map(|k| entries[k] * inverse[k][column]).sum() };
            let expected = |column: usize| f64::from(u8::from(row == column));
            assert!((0..3).all(|k| (times_inverse(k) - expected(k)).abs() < 1e-13));
        }
    }

    #[test]
    fn singular_indefinite_and_broken_matrices_are_refused() {
        assert!(Cholesky::new(&[[1.0, 1.0], [1.0, 1.0]]).is_none());
        assert!(Cholesky::new(&[[1.0, 2.0], [2.0, 1.0]]).is_none());
        assert!(Cholesky::new(&[[f64::NAN]]).is_none());
        assert!(Cholesky::new(&[[f64::INFINITY]]).is_none());
    }

    #[test]
    fn curvature_of_a_quadratic_form() {
        let form = |p: &[f64; 2]| 3.0 * p[0] * p[0] + p[0] * p[1] + 0.5 * p[1] * p[1] - p[0];
        let found = curvature(form, &[0.3, -0.7], &[1e-3, 1e-3]);
        for (row, expected) in found.iter().zip([[6.0, 1.0], [1.0, 1.0]]) {
            for (entry, expected) in row.iter().zip(expected) {
                assert!((entry - expected).abs() < 1e-6);
            }
        }
    }
}
