//! Errors of y brought to unit variance and no correlation.

use super::factor::{Cholesky, Scalar};
use super::problem::Spread;
use super::solution::{Failure, Observed};

/// L⁻¹, where L Lᵀ is the covariance matrix of y.
pub(super) enum Whitener<T> {
    /// All errors alike.
    Unit,
    /// 1/u of each point.
    Each(Vec<T>),
    /// L itself.
    Correlated(Cholesky<T>),
}

impl<T: Scalar> Whitener<T> {
    /// For a spread that is checked already.
    pub(super) fn new(spread: &Spread) -> Result<Whitener<T>, Failure> {
        Ok(match spread {
            Spread::Exact => Whitener::Unit,
            Spread::Each(u) if u.iter().all(|u| *u == 1.0) => Whitener::Unit,
            Spread::Each(u) => {
                Whitener::Each(u.iter().map(|u| T::from(1.0) / T::from(*u)).collect())
            }
            Spread::Matrix(v) => {
                Whitener::Correlated(Cholesky::new(v).ok_or(Failure::Covariance {
                    observed: Observed::Y,
                })?)
            }
        })
    }

    /// L⁻¹ b.
    pub(super) fn whiten(&self, b: &mut [T]) {
        match self {
            Whitener::Unit => {}
            Whitener::Each(weights) => multiply(b, weights),
            Whitener::Correlated(factor) => factor.lower(b),
        }
    }

    /// L⁻ᵀ b.
    pub(super) fn whiten_transposed(&self, b: &mut [T]) {
        match self {
            Whitener::Unit => {}
            Whitener::Each(weights) => multiply(b, weights),
            Whitener::Correlated(factor) => factor.upper(b),
        }
    }
}

fn multiply<T: Scalar>(b: &mut [T], weights: &[T]) {
    for (b, weight) in b.iter_mut().zip(weights) {
        *b = *b * *weight;
    }
}
