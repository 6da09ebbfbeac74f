//! Cholesky's factor of a covariance matrix together with its inverse.

use nalgebra::DMatrix;

/// Smaller matrices are factored as they are.
const SMALL: usize = 32;

/// L and L⁻¹ with LLᵀ = V for a positive definite V, n × n; nothing where it is none.
///
/// By halves, so that nearly all of the work is in products of matrices:
///
/// ```text
/// V = ┌ A   ·  ┐   L = ┌ L_A            0   ┐   L⁻¹ = ┌ L_A⁻¹               0     ┐   L_S L_Sᵀ = C − (B L_A⁻ᵀ)(B L_A⁻ᵀ)ᵀ
///     └ B   C  ┘       └ B L_A⁻ᵀ        L_S ┘         └ −L_S⁻¹ B L_A⁻ᵀ L_A⁻¹  L_S⁻¹ ┘
/// ```
pub(super) fn factors(matrix: &DMatrix<f64>) -> Option<[DMatrix<f64>; 2]> {
    let size = matrix.nrows();
    if size <= SMALL {
        let lower = matrix.clone().cholesky()?.unpack();
        let inverse = lower.solve_lower_triangular(&DMatrix::identity(size, size))?;
        return Some([lower, inverse]);
    }
    let half = size / 2;
    let rest = size - half;
    let block = |row: usize, column: usize, rows: usize, columns: usize| {
        matrix.view((row, column), (rows, columns)).into_owned()
    };
    let [upper, upper_inverse] = factors(&block(0, 0, half, half))?;
    let below = block(half, 0, rest, half) * upper_inverse.transpose();
    let mut left = block(half, half, rest, rest);
    left.gemm(-1.0, &below, &below.transpose(), 1.0);
    let [lower, lower_inverse] = factors(&left)?;
    let below_inverse = -(&lower_inverse * &below * &upper_inverse);
    let joined = |parts: [&DMatrix<f64>; 3]| {
        let mut joined = DMatrix::zeros(size, size);
        let places = [(0, 0), (half, 0), (half, half)];
        for (part, place) in parts.into_iter().zip(places) {
            joined.view_mut(place, part.shape()).copy_from(part);
        }
        joined
    };
    Some([
        joined([&upper, &below, &lower]),
        joined([&upper_inverse, &below_inverse, &lower_inverse]),
    ])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The correlation r^|i − j|, whose factor is known: L_ij = r^(i − j) √(1 − r²) but for the first column.
    #[test]
    fn a_markov_process_has_the_factor_of_its_closed_form() {
        let r = 0.8;
        let size = 3 * SMALL + 1;
        let power = |i: usize, j: usize| libm::pow(r, i.abs_diff(j) as f64);
        let [lower, inverse] = factors(&DMatrix::from_fn(size, size, power)).unwrap();
        for i in 0..size {
            for j in 0..size {
                let (first, inner) = (power(i, j), power(i, j) * libm::sqrt(1.0 - r * r));
                let expected = match j {
                    _ if j > i => 0.0,
                    0 => first,
                    _ => inner,
                };
                assert!((lower[(i, j)] - expected).abs() < 1e-12, "{i}, {j}");
            }
        }
        assert!((lower * inverse - DMatrix::identity(size, size)).amax() < 1e-12);
    }

    #[test]
    fn a_matrix_that_is_not_positive_has_none() {
        let mut matrix = DMatrix::identity(2 * SMALL, 2 * SMALL);
        matrix[(SMALL + 3, SMALL + 3)] = -1.0;
        assert_eq!(factors(&matrix), None);
    }
}
