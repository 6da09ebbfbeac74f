//! White noise, bias instability and rate random walk from an Allan deviation.

use nalgebra::{DMatrix, DVector};

use super::allan::Allan;
use super::power_law::{PowerLaw, covariances};
use gumption_core::special::{chi_squared_sf, normal_quantile};

/// The noise of an instrument: σ²(τ) = N²/τ + B² · 2 ln 2/π + K² τ/3.
///
/// Units, with the readings in R and the interval in s: N in R·√s, B in R, K in R/√s.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Noises {
    /// N, for the rate of a gyro the angle random walk: the part that falls with τ^−½.
    pub white: Coefficient,
    /// B: the flat part, whose Allan deviation is 0.664 B.
    pub bias_instability: Coefficient,
    /// K: the part that rises with τ^½.
    pub rate_random_walk: Coefficient,
    /// Weighted sum of squared residuals of the fit.
    pub chi_squared: f64,
    /// Averaging times less the number of coefficients that were identified.
    pub dof: usize,
    /// Probability of a greater χ² if the three noises are all there is. Approximate, because Allan
    /// variances of few degrees of freedom are not normal; a very small one says that something else
    /// is in the recording: a drift, a period, quantisation.
    pub p_value: f64,
}

impl Noises {
    /// Whether they explain the deviations: a χ² as great comes about in more than one of a hundred recordings.
    pub fn explain(&self) -> bool {
        /// Usual level of a test whose distribution is known approximately.
        const LEVEL: f64 = 0.01;
        self.p_value >= LEVEL
    }

    /// The Allan deviation of the noises that the recording shows, at an averaging time.
    pub fn deviation(&self, tau: f64) -> f64 {
        let shares = [self.white, self.bias_instability, self.rate_random_walk];
        let shares = shares.into_iter().zip(PowerLaw::ALL);
        let variance = shares.filter_map(|(found, law)| {
            let value = found.value()?;
            Some(value * value * law.allan_variance(tau))
        });
        variance.sum::<f64>().sqrt()
    }
}

/// A coefficient of noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Coefficient {
    /// The recording shows it.
    Identified {
        /// Its value.
        value: f64,
        /// Its standard uncertainty.
        u: f64,
    },
    /// The recording does not show it.
    Hidden {
        /// It is less than this with a probability of 95 %.
        limit: f64,
    },
}

impl Coefficient {
    /// The value, if the recording shows it.
    pub fn value(self) -> Option<f64> {
        match self {
            Coefficient::Identified { value, .. } => Some(value),
            Coefficient::Hidden { .. } => None,
        }
    }
}

/// A part of the variance is identified if the deviations without it are less likely by this much in −2 ln L: as much as two
/// standard uncertainties.
const EVIDENT: f64 = 4.0;
/// The weights follow the coefficients; they settle in a few rounds.
const ROUNDS: usize = 25;

impl Allan {
    /// The noises that the Allan deviation shows, by generalised least squares on the variances with
    /// the covariances of theory. Those that are not evident are left out one after another. A noise scatters its own
    /// estimate, so that its square over u says little: without a random walk the covariances of long averaging times are
    /// far smaller, and what was hidden in its scatter is refuted.
    ///
    /// `None` for readings that are all equal, or with fewer than four averaging times.
    pub fn noises(&self) -> Option<Noises> {
        if self.points.len() < 4 || self.points.iter().any(|point| point.deviation <= 0.0) {
            return None;
        }
        let problem = Variances::new(self);
        let mut fit = problem.fit(&PowerLaw::ALL)?;
        while let Some(less) = problem.without_the_least(&fit) {
            fit = less;
        }
        let laws = fit.laws.clone();
        let coefficient = |law: PowerLaw| -> Option<Coefficient> {
            // From variances per interval to those per unit of time.
            let scale = law.allan_variance(1.0) / law.allan_variance(self.interval);
            if let Some(place) = laws.iter().position(|other| *other == law) {
                let (square, u) = (fit.squares[place], fit.covariance[(place, place)].sqrt());
                let value = square.max(0.0).sqrt();
                return Some(Coefficient::Identified {
                    value: value * scale.sqrt(),
                    u: u / (2.0 * value) * scale.sqrt(),
                });
            }
            let limit = (problem.limit(&fit, law)? * scale).sqrt();
            Some(Coefficient::Hidden { limit })
        };
        let dof = self.points.len() - laws.len();
        Some(Noises {
            white: coefficient(PowerLaw::White)?,
            bias_instability: coefficient(PowerLaw::Flicker)?,
            rate_random_walk: coefficient(PowerLaw::RandomWalk)?,
            chi_squared: fit.chi_squared,
            dof,
            p_value: chi_squared_sf(fit.chi_squared, dof as f64),
        })
    }
}

/// The variances and what theory says of them, for an interval of 1 and variances near 1.
struct Variances {
    observed: DVector<f64>,
    taus: Vec<f64>,
    /// The covariances as quadratic forms of squared coefficients.
    terms: Vec<Vec<[[f64; 3]; 3]>>,
    unit: f64,
}

struct Fit {
    laws: Vec<PowerLaw>,
    squares: DVector<f64>,
    covariance: DMatrix<f64>,
    chi_squared: f64,
    weights: Weights,
}

impl Fit {
    /// −2 ln L of normal variances, but for a constant.
    fn deviance(&self) -> f64 {
        self.chi_squared + self.weights.log_determinant
    }
}

/// How exactly the variances are known.
#[derive(Clone)]
struct Weights {
    /// Inverse of their covariance matrix.
    inverse: DMatrix<f64>,
    /// Logarithm of the determinant of that matrix.
    log_determinant: f64,
}

impl Variances {
    fn new(allan: &Allan) -> Variances {
        let squares = allan
            .points
            .iter()
            .map(|point| point.deviation * point.deviation);
        let squares: Vec<f64> = squares.collect();
        let unit = squares.iter().copied().fold(f64::INFINITY, f64::min);
        let steps: Vec<usize> = allan.points.iter().map(|point| point.intervals).collect();
        let mut terms = vec![vec![[[0.0; 3]; 3]; steps.len()]; steps.len()];
        for (i, a) in steps.iter().enumerate() {
            for (j, b) in steps.iter().enumerate().skip(i) {
                terms[i][j] = covariances(allan.readings, *a, *b);
                terms[j][i] = terms[i][j];
            }
        }
        Variances {
            observed: DVector::from_iterator(squares.len(), squares.iter().map(|v| v / unit)),
            taus: steps.iter().map(|m| *m as f64).collect(),
            terms,
            unit,
        }
    }

    /// Least squares whose weights follow from the coefficients that it finds.
    fn fit(&self, laws: &[PowerLaw]) -> Option<Fit> {
        let relative = self.observed.map(|v| 1.0 / (v * v));
        let first = Weights {
            inverse: DMatrix::from_diagonal(&relative),
            log_determinant: -relative
                .iter()
                .map(|weight| libm::log(*weight))
                .sum::<f64>(),
        };
        let mut fit = self.solve(laws, first)?;
        for _ in 0..ROUNDS {
            let Some(weights) = self.weights(&fit) else {
                break;
            };
            fit = self.solve(laws, weights)?;
        }
        Some(self.in_units(fit))
    }

    /// The fit without the noise that is least evident, if any is not: one with a negative square before all others.
    fn without_the_least(&self, fit: &Fit) -> Option<Fit> {
        if fit.laws.len() < 2 {
            return None;
        }
        let costs = (0..fit.laws.len()).filter_map(|place| {
            let mut laws = fit.laws.clone();
            laws.remove(place);
            let less = self.fit(&laws)?;
            let cost = match fit.squares[place] > 0.0 {
                true => less.deviance() - fit.deviance(),
                false => f64::NEG_INFINITY,
            };
            Some((cost, less))
        });
        let (cost, less) = costs.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (cost < EVIDENT).then_some(less)
    }

    /// The upper limit of the square of a coefficient that a fit does without: twice, because the scatter
    /// of its estimate grows with the coefficient, so that the covariances are those at the limit.
    fn limit(&self, without: &Fit, law: PowerLaw) -> Option<f64> {
        let mut laws = without.laws.clone();
        laws.push(law);
        let place = laws.len() - 1;
        let upper = |fit: &Fit| {
            let u = fit.covariance[(place, place)].sqrt();
            fit.squares[place].max(0.0) + normal_quantile(0.95) * u
        };
        let mut fit = self.solve(&laws, without.weights.clone())?;
        let first = upper(&fit);
        fit.squares = without.squares.map(|square| square / self.unit).push(first);
        let at_limit = self.weights(&fit)?;
        let second = upper(&self.solve(&laws, at_limit)?);
        Some(first.max(second) * self.unit)
    }

    fn solve(&self, laws: &[PowerLaw], weights: Weights) -> Option<Fit> {
        let design = DMatrix::from_fn(self.taus.len(), laws.len(), |i, j| {
            laws[j].allan_variance(self.taus[i])
        });
        let weighted = design.transpose() * &weights.inverse;
        let covariance = (&weighted * &design).try_inverse()?;
        let squares = &covariance * (weighted * &self.observed);
        let residuals = &self.observed - &design * &squares;
        let chi_squared = (residuals.transpose() * &weights.inverse * &residuals)[(0, 0)];
        Some(Fit {
            laws: laws.to_vec(),
            squares,
            covariance,
            chi_squared,
            weights,
        })
    }

    /// Those that the coefficients of a fit imply.
    fn weights(&self, fit: &Fit) -> Option<Weights> {
        let mut c = [0.0; 3];
        for (law, square) in fit.laws.iter().zip(fit.squares.iter()) {
            c[*law as usize] = square.max(0.0);
        }
        let n = self.taus.len();
        let covariance = DMatrix::from_fn(n, n, |i, j| {
            let terms = &self.terms[i][j];
            (0..3)
                .flat_map(|p| (0..3).map(move |q| c[p] * c[q] * terms[p][q]))
                .sum()
        });
        let factor = covariance.cholesky()?;
        let diagonal = factor.l_dirty().diagonal();
        Some(Weights {
            inverse: factor.inverse(),
            log_determinant: 2.0 * diagonal.iter().map(|x| libm::log(*x)).sum::<f64>(),
        })
    }

    fn in_units(&self, mut fit: Fit) -> Fit {
        fit.squares *= self.unit;
        fit.covariance *= self.unit * self.unit;
        fit
    }
}
