//! Evidence in closed form: Bayes factors of effects against none.
//!
//! Named effects have Zellner's g-prior on their coefficients with the g that the recording makes most
//! probable (empirical Bayes), so that evidence does not depend on units or on guesses of size. Smooth
//! discrepancies have coefficients of given relative variances with a common factor, again the most
//! probable of a ladder. The scale of the noise is integrated over: known exactly (ν₀ = ∞) or estimated
//! with ν₀ degrees of freedom beside the m of the residuals.

/// From here on the scale of the noise counts as known.
const EXACT: f64 = 1e8;

/// What the scale of the noise is inferred from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Scale {
    /// It is known: 1 in whitened units.
    Known,
    /// Estimated with this many degrees of freedom, residuals included.
    Estimated {
        /// N = m + ν₀.
        total: f64,
    },
}

impl Scale {
    /// For m degrees of freedom of the residuals and ν₀ of other knowledge.
    pub(super) fn new(dof: usize, scale_dof: f64) -> Scale {
        if scale_dof >= EXACT {
            Scale::Known
        } else {
            Scale::Estimated {
                total: dof as f64 + scale_dof,
            }
        }
    }

    /// When d directions of the residuals are spent on adopted effects.
    pub(super) fn less(self, d: usize) -> Scale {
        match self {
            Scale::Known => Scale::Known,
            Scale::Estimated { total } => Scale::Estimated {
                total: total - d as f64,
            },
        }
    }
}

/// Logarithm of the Bayes factor of effects that span d directions and reduce the sum of squares
/// `rss` (residuals and, where the scale is estimated, ν₀) by `fit`.
pub(super) fn named(d: usize, fit: f64, rss: f64, scale: Scale) -> f64 {
    let d = d as f64;
    match scale {
        Scale::Known => {
            let g = (fit / d - 1.0).max(0.0);
            0.5 * (fit * g / (1.0 + g) - d * libm::log1p(g))
        }
        Scale::Estimated { total } => {
            if !(total > d) || !(rss > 0.0) {
                return 0.0;
            }
            // R² next to 1 keeps its distance from 1: the logarithms below need it.
            let left = ((rss - fit) / rss).clamp(f64::EPSILON, 1.0);
            let ratio = (1.0 - left) / d / (left / (total - d));
            let g = (ratio - 1.0).max(0.0);
            0.5 * ((total - d) * libm::log1p(g) - total * libm::log1p(g * left))
        }
    }
}

/// A discrepancy whose coefficients have expectation zero and variances s·eₖ, prepared for every s of
/// the ladder.
#[derive(Debug, Clone)]
pub(super) struct Ladder {
    eigenvalues: Vec<f64>,
    steps: Vec<Step>,
}

#[derive(Debug, Clone)]
struct Step {
    /// ½ Σ log(1 + s eₖ).
    half_log_det: f64,
    /// s eₖ/(1 + s eₖ).
    weights: Vec<f64>,
}

/// Squared sizes s that are tried, over the variance of the noise: λ from 1 to 1000.
const SIZES: [f64; 13] = [
    1.0, 3.0, 10.0, 30.0, 1e2, 3e2, 1e3, 3e3, 1e4, 3e4, 1e5, 3e5, 1e6,
];

impl Ladder {
    /// For the eigenvalues eₖ, which sum to about one.
    pub(super) fn new(eigenvalues: &[f64]) -> Ladder {
        let step = |s: &f64| Step {
            half_log_det: 0.5 * eigenvalues.iter().map(|e| libm::log1p(s * e)).sum::<f64>(),
            weights: eigenvalues.iter().map(|e| s * e / (1.0 + s * e)).collect(),
        };
        Ladder {
            eigenvalues: eigenvalues.to_vec(),
            steps: SIZES.iter().map(step).collect(),
        }
    }

    /// √eₖ.
    pub(super) fn roots(&self) -> Vec<f64> {
        self.eigenvalues.iter().map(|e| e.sqrt()).collect()
    }

    /// What [`Ladder::log_bayes_factor`] is at most, whatever the sizes of the single components.
    pub(super) fn at_most(&self, sum_of_squares: f64, rss: f64, scale: Scale) -> f64 {
        let least = self.steps.first().map_or(0.0, |step| step.half_log_det);
        shrunk(sum_of_squares, least, rss, scale)
    }

    /// Logarithm of the Bayes factor against none, given the squared components of the residuals along
    /// the directions and the sum of squares `rss`.
    pub(super) fn log_bayes_factor(
        &self,
        squares: impl Iterator<Item = f64> + Clone,
        rss: f64,
        scale: Scale,
    ) -> f64 {
        let value = |step: &Step| {
            let both = step.weights.iter().zip(squares.clone());
            let fit = both.map(|(weight, square)| weight * square).sum();
            shrunk(fit, step.half_log_det, rss, scale)
        };
        let values = self.steps.iter().map(value);
        values.fold(f64::NEG_INFINITY, f64::max)
    }
}

/// As [`Ladder::log_bayes_factor`] for excess scatter in all of m directions.
pub(super) fn scatter(m: usize, chi_squared: f64, rss: f64, scale: Scale) -> f64 {
    let m = m as f64;
    let value = |s: &f64| {
        let e = s / m;
        let (fit, half_log_det) = (e / (1.0 + e) * chi_squared, 0.5 * m * libm::log1p(e));
        shrunk(fit, half_log_det, rss, scale)
    };
    SIZES.iter().map(value).fold(f64::NEG_INFINITY, f64::max)
}

fn shrunk(fit: f64, half_log_det: f64, rss: f64, scale: Scale) -> f64 {
    match scale {
        Scale::Known => 0.5 * fit - half_log_det,
        Scale::Estimated { total } => {
            let share = match rss > 0.0 {
                true => (fit / rss).min(1.0 - f64::EPSILON),
                false => 0.0,
            };
            -half_log_det - 0.5 * total * libm::log1p(-share)
        }
    }
}

/// The largest; −∞ of none.
pub fn maximum(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::NEG_INFINITY, f64::max)
}

/// log Σ exp xᵢ; −∞ for none.
pub fn log_sum(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let top = values.clone().fold(f64::NEG_INFINITY, f64::max);
    if top == f64::NEG_INFINITY {
        return top;
    }
    top + libm::log(values.map(|x| libm::exp(x - top)).sum::<f64>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_direction_and_known_noise_is_the_closed_form() {
        // ½(F − 1) − ½ log F with F = W.
        for w in [1.5_f64, 4.0, 36.0, 400.0] {
            let expected = 0.5 * (w - 1.0) - 0.5 * w.ln();
            assert!((named(1, w, 1e9, Scale::Known) - expected).abs() < 1e-12);
        }
        assert_eq!(named(1, 0.7, 1e9, Scale::Known), 0.0);
    }

    #[test]
    fn many_degrees_of_freedom_approach_known_noise() {
        for d in [1, 2, 5] {
            for w in [8.0, 40.0] {
                let known = named(d, w, 0.0, Scale::Known);
                let n = 1e7;
                let estimated = named(d, w, n, Scale::Estimated { total: n });
                assert!((known - estimated).abs() < 1e-3, "{known} {estimated}");
            }
        }
    }

    /// Marginal likelihoods written out: N(0, I) against N(0, I + s e uuᵀ).
    #[test]
    fn a_ladder_is_a_ratio_of_normal_densities() {
        let eigenvalues = [0.7, 0.3];
        let z = [9.0_f64, -2.0];
        let ratio = |s: f64| -> f64 {
            eigenvalues
                .iter()
                .zip(z)
                .map(|(e, z)| {
                    let variance = 1.0 + s * e;
                    -0.5 * variance.ln() - 0.5 * z * z / variance + 0.5 * z * z
                })
                .sum()
        };
        let expected = SIZES.iter().map(|s| ratio(*s)).fold(f64::MIN, f64::max);
        let got =
            Ladder::new(&eigenvalues).log_bayes_factor(z.iter().map(|z| z * z), 0.0, Scale::Known);
        assert!((got - expected).abs() < 1e-12);
    }

    #[test]
    fn sums_of_exponentials_do_not_overflow() {
        let values = [1000.0, 1000.0 + 2.0_f64.ln()];
        assert!((log_sum(values.iter().copied()) - (1000.0 + 3.0_f64.ln())).abs() < 1e-12);
        assert_eq!(log_sum(std::iter::empty()), f64::NEG_INFINITY);
    }
}
