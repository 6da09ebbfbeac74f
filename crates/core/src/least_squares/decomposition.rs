//! Decompositions that end. Those of `nalgebra` repeat their steps until what they leave is small, which a number that is none
//! never is: they are not begun with such numbers, and are given up after more steps than any matrix of finite ones takes.

use nalgebra::{DMatrix, Dyn, SVD, SymmetricEigen};

/// Two or three steps are taken for each singular value or eigenvalue.
const STEPS_EACH: usize = 100;

/// A = UΣVᵀ, with both factors; `None` where A is empty or has a number that is not finite.
pub fn singular(matrix: DMatrix<f64>) -> Option<SVD<f64, Dyn, Dyn>> {
    let steps = steps(&matrix)?;
    SVD::try_new(matrix, true, true, 5.0 * f64::EPSILON, steps)
}

/// The inverse of A where it has one, without directions that it stretches no more than `flat`; `None` where A is empty or has a
/// number that is not finite.
pub fn pseudo_inverse(matrix: DMatrix<f64>, flat: f64) -> Option<DMatrix<f64>> {
    let steps = steps(&matrix)?;
    let found = SVD::try_new_unordered(matrix, true, true, 5.0 * f64::EPSILON, steps)?;
    found.pseudo_inverse(flat).ok()
}

/// Eigenvalues and eigenvectors of a symmetric matrix; `None` where it is empty or has a number that is not finite.
pub fn axes(symmetric: DMatrix<f64>) -> Option<SymmetricEigen<f64, Dyn>> {
    let steps = steps(&symmetric)?;
    SymmetricEigen::try_new(symmetric, f64::EPSILON, steps)
}

/// Steps after which a matrix of finite numbers is given up; of an empty one there are none.
fn steps(matrix: &DMatrix<f64>) -> Option<usize> {
    let is_usable = !matrix.is_empty() && matrix.iter().all(|x| x.is_finite());
    is_usable.then(|| STEPS_EACH * (1 + matrix.nrows().min(matrix.ncols())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_no_number_is_not_decomposed() {
        for x in [f64::NAN, f64::INFINITY] {
            let matrix = DMatrix::from_row_slice(3, 2, &[1.0, 2.0, x, 0.5, 0.1, 3.0]);
            assert!(singular(matrix.clone()).is_none());
            assert!(axes(matrix.transpose() * matrix).is_none());
        }
    }

    #[test]
    fn a_matrix_is_the_product_of_its_factors() {
        let matrix = DMatrix::from_fn(7, 4, |i, j| libm::sin((3 * i + 5 * j * j) as f64));
        let found = singular(matrix.clone()).and_then(|svd| svd.recompose().ok());
        assert!((found.expect("factors") - &matrix).amax() < 1e-14);
        let square = matrix.transpose() * &matrix;
        let found = axes(square.clone()).map(|axes| axes.recompose());
        assert!((found.expect("axes") - square).amax() < 1e-13);
    }
}
