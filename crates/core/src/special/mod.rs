//! Special functions for quantiles and coverage factors, accurate over their whole range.
//!
//! Effective degrees of freedom are real numbers from below one to far above 10⁶, and coverage
//! intervals ask for tails and for the neighbourhood of the median alike. So every distribution
//! here comes with both tails (`_cdf` and `_sf`) and with quantiles from both ends
//! (`_quantile` and `_upper_quantile`): 1 − p is exact for p ≥ ½ only.
//!
//! | chapter | holds |
//! |---|---|
//! | `error_function` | erf and erfc |
//! | `normal` | normal density, distribution function, quantile |
//! | `gamma` | ln Γ, Γ, regularised incomplete gamma function and its inverse |
//! | `beta` | ln B, regularised incomplete beta function and its inverse |
//! | `student_t`, `chi_squared`, `f` | the distributions that degrees of freedom lead to |
//! | `quadrature` | Gauss–Legendre quadrature |
//! | [`roots`] | where a condition ceases to hold |
//! | `log_concave` | the one algorithm behind gamma, beta and t |
//!
//! # Method
//!
//! In the variable y = ln x (gamma), y = ln(x/(1−x)) (beta) and y = arsinh(t/√ν) (t) the three
//! densities are log-concave for *all* parameters. A tail is therefore the density at its
//! beginning times an integral that falls from 1 at least exponentially, which a double
//! exponential quadrature finds to the last digits, whatever the parameters; and the logarithm of
//! a tail is concave in y, so that Newton's method for the quantile converges from anywhere. The
//! density itself is written with deviances from its mode (Loader 2000), which do not cancel.
//!
//! # Accuracy
//!
//! Against tables made with 50 digits (`tests/data/special`): tails and distribution functions
//! to 1e-13 relative (3e-13 at 1e-300), quantiles to 1e-12 relative, parameters 0.05 to 10¹⁵, probabilities 1e-300
//! to 1 − 1e-16.
//!
//! Arguments outside a function's domain give NaN.

mod beta;
mod chi_squared;
mod error_function;
mod f;
mod gamma;
mod log_concave;
mod normal;
mod quadrature;
pub mod roots;
mod student_t;
#[cfg(test)]
mod table;

pub use beta::{beta_regularized, beta_regularized_upper, inverse_beta_regularized, ln_beta};
pub use chi_squared::{
    chi_squared_cdf, chi_squared_quantile, chi_squared_sf, chi_squared_upper_quantile,
};
pub use error_function::{erf, erfc};
pub use f::{f_cdf, f_quantile, f_sf, f_upper_quantile};
pub use gamma::{
    gamma, gamma_regularized, gamma_regularized_upper, inverse_gamma_regularized,
    inverse_gamma_regularized_upper, ln_gamma,
};
pub use normal::{
    normal_cdf, normal_pdf, normal_quantile, normal_sf, normal_two_sided,
    normal_two_sided_quantile, normal_upper_quantile,
};
pub use quadrature::gauss_legendre;
pub use student_t::{
    student_t_cdf, student_t_pdf, student_t_quantile, student_t_score, student_t_sf,
    student_t_two_sided, student_t_two_sided_quantile, student_t_upper_quantile,
};
