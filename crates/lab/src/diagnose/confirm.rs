//! How well a model describes the recording: χ², residual scatter, prediction of what was held out.

use gumption_core::special::roots::last;
use gumption_core::special::{
    chi_squared_cdf, f_cdf, student_t_two_sided, student_t_two_sided_quantile,
};
use nalgebra::{DMatrix, DVector};

use super::candidates::baseline;
use super::design::{Design, Unknown};
use super::evidence::{self, COVERAGE, Covariance, Spread};
use super::fit::Fit;
use super::noise::Claimed;

/// How well a model describes the recording.
#[derive(Debug, Clone, PartialEq)]
pub struct Quality {
    /// χ² with the claimed noise.
    pub chi_squared: f64,
    /// How many there are.
    pub observations: usize,
    /// Observations less parameters.
    pub dof: f64,
    /// Root mean square of the residuals, for each response.
    pub residual: Vec<f64>,
    /// Root mean square of the claimed noise, for each response.
    pub expected: Vec<f64>,
    /// Root mean square of the errors of predictions of held-out observations, for each response.
    pub held_out: Vec<f64>,
}

impl Quality {
    /// χ² per degree of freedom.
    pub fn reduced(&self) -> f64 {
        self.chi_squared / self.dof
    }

    /// Probability of a χ² as small by chance, where the noise is claimed and independent from row to row and that is next to
    /// impossible: then it is claimed too large, or the readings do not scatter as they were taken.
    pub fn quieter(&self, claimed: &Claimed) -> Option<f64> {
        /// One recording in a thousand is told without reason.
        const RARE: f64 = 0.001;
        let is_claimed = !claimed.is_estimated() && !claimed.is_of_arithmetic();
        if !is_claimed || claimed.correlated.is_some() || self.dof < 1.0 {
            return None;
        }
        let p = match claimed.dof.is_finite() {
            true => f_cdf(self.reduced(), self.dof, claimed.dof),
            false => chi_squared_cdf(self.chi_squared, self.dof),
        };
        (p < RARE).then_some(p)
    }

    /// Whether parts of the recording that the fit had not seen are predicted worse than by another model. ln s² of n errors has the
    /// variance 2/n, so that the difference of two is beyond this in 5 % of equally good predictions, at most.
    pub(super) fn predicts_worse(&self, other: &Quality) -> bool {
        const QUANTILE: f64 = 1.645;
        let squares = |quality: &Quality| -> f64 {
            let scaled = quality.held_out.iter().zip(&other.expected);
            scaled.map(|(e, s)| (e / s) * (e / s)).sum()
        };
        let beyond = libm::exp(QUANTILE * 2.0 / (self.observations as f64).sqrt());
        squares(self) > beyond * squares(other)
    }
}

/// Parts into which observations are divided for the prediction of what was held out.
const FOLDS: usize = 10;

/// Computes the quality of a fit.
pub(super) fn quality(design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> Quality {
    Quality {
        chi_squared: chi_squared(fit, claimed),
        observations: design.observations(),
        dof: degrees(design),
        residual: design.root_mean_squares(&fit.residuals),
        expected: design.root_mean_squares(&claimed.u),
        held_out: design.root_mean_squares(&held_out(design, fit, claimed)),
    }
}

fn chi_squared(fit: &Fit, claimed: &Claimed) -> f64 {
    fit.residuals.component_div(&claimed.u).norm_squared()
}

/// A fitted quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Estimated {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// Its value.
    pub value: f64,
    /// Its standard uncertainty.
    pub u: f64,
    /// Degrees of freedom of the standard uncertainty.
    pub dof: f64,
}

/// Unknowns with their standard uncertainties.
pub(super) fn estimates(design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> Vec<Estimated> {
    let spreads = spreads(design, fit, claimed);
    let estimated = |(at, unknown): (usize, &Unknown)| {
        let (variance, dof) = mixed(&spreads, at);
        Estimated {
            name: unknown.name.clone(),
            unit: design.unit(at),
            value: fit.unknowns[at],
            u: variance.max(0.0).sqrt(),
            dof,
        }
    };
    design.unknowns.iter().enumerate().map(estimated).collect()
}

/// How well the unknowns are known with each law of the noise that the recording allows, as likely as they occur. Where the
/// size of the noise is estimated, it is the one with which the law gives the χ² of the fit, and known as well as this is.
fn spreads(design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> Vec<Spread> {
    let sized = |mut spread: Spread, found: f64| {
        if claimed.is_estimated() {
            spread.variances *= found / spread.expected.max(1.0);
        } else {
            spread.dof = claimed.dof;
        }
        spread
    };
    match baseline(design, fit, &claimed.of_fit()) {
        Ok(baseline) => {
            let found = match claimed.in_common() {
                Some(_) => baseline.chi_squared(),
                None => chi_squared(fit, claimed),
            };
            let spread = |law: &Covariance| sized(baseline.spread(law), found);
            let noise = claimed.noise(design, fit);
            noise.laws().iter().map(spread).collect()
        }
        Err(_) => {
            let degrees = degrees(design);
            let spread = Spread {
                variances: covariance(design, fit, claimed).diagonal(),
                expected: degrees,
                dof: degrees,
            };
            vec![sized(spread, chi_squared(fit, claimed))]
        }
    }
}

/// Variance of an unknown and its degrees of freedom. Of several laws the variance is the mean u² (law of total variance: all
/// of them have the same estimate), and the degrees of freedom are those with which the interval ±k·u has its probability in the
/// mixture of their t-distributions: infinite, where that of a normal distribution is no narrower.
fn mixed(spreads: &[Spread], at: usize) -> (f64, f64) {
    let count = spreads.len() as f64;
    let variance = spreads.iter().map(|law| law.variances[at]).sum::<f64>() / count;
    match spreads {
        [only] => (variance, only.dof),
        _ if variance > 0.0 => (variance, degrees_of_interval(factor(spreads, at, variance))),
        _ => (variance, f64::INFINITY),
    }
}

/// The k of the interval ±k·u in a mixture of laws whose mean variance is u².
fn factor(spreads: &[Spread], at: usize, variance: f64) -> f64 {
    let ratio = |law: &Spread| (law.variances[at].max(0.0) / variance).sqrt();
    let of_laws = spreads.iter().filter(|law| ratio(law) > 0.0);
    let own = |law: &Spread| ratio(law) * student_t_two_sided_quantile(COVERAGE, law.dof);
    let widest = of_laws.clone().map(own).fold(0.0, f64::max);
    let within = |k: f64| {
        let inside = of_laws
            .clone()
            .map(|law| student_t_two_sided(k / ratio(law), law.dof));
        let certain = spreads.len() - of_laws.clone().count();
        (inside.sum::<f64>() + certain as f64) / spreads.len() as f64
    };
    last(0.0, widest, |k| within(k) < COVERAGE)
}

/// The degrees of freedom of the t-distribution whose interval has the coverage factor k.
fn degrees_of_interval(k: f64) -> f64 {
    /// Beyond, the interval is that of a normal distribution to more digits than k is known with.
    const MANY: f64 = 1e9;
    /// Below, not even the probable error is known.
    const FEW: f64 = 0.5;
    let is_as_wide = |nu: f64| student_t_two_sided_quantile(COVERAGE, nu) >= k;
    match is_as_wide(MANY) {
        true => f64::INFINITY,
        false => last(FEW, MANY, is_as_wide),
    }
}

/// By what the noise is larger than claimed; one where the claim stands.
pub(super) fn scale(design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> f64 {
    match claimed.is_estimated() {
        true => (chi_squared(fit, claimed) / degrees(design).max(1.0)).sqrt(),
        false => 1.0,
    }
}

/// Observations and priors less unknowns.
pub(super) fn degrees(design: &Design<'_>) -> f64 {
    (design.observations() + design.priors()) as f64 - design.unknowns.len() as f64
}

/// Errors of the predictions of observations that the fit had not seen: tenths of the recording, in short
/// stretches that are spread over it.
fn held_out(design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> DVector<f64> {
    let Ok(baseline) = baseline(design, fit, &claimed.of_fit()) else {
        return fit.residuals.clone();
    };
    let blocks = design.blocks.len();
    let folds = FOLDS.min(blocks);
    let stretch = (blocks / (4 * folds)).max(1);
    let fold = |observation: usize| design.place(observation).1 / stretch % folds;
    let mut errors = DVector::zeros(design.observations());
    for held in 0..folds {
        let rows = (0..design.observations()).filter(|row| fold(*row) == held);
        let rows: Vec<usize> = rows.collect();
        for (row, error) in rows.iter().zip(&baseline.left_out(&rows)) {
            errors[*row] = *error;
        }
    }
    // All outputs of a block are held out together.
    let coloured = claimed
        .in_common()
        .map(|one| one.correlation.coloured(&errors));
    let errors = coloured.and_then(Result::ok).unwrap_or(errors);
    errors.component_mul(&claimed.u)
}

/// What of the observations lies along finite columns, by least squares in units of their noise.
pub(super) fn along(
    columns: &DMatrix<f64>,
    observed: &DVector<f64>,
    u: &DVector<f64>,
) -> DVector<f64> {
    columns * (evidence::inverse(&evidence::over_noise(columns, u)) * observed.component_div(u))
}

/// Covariance matrix of the unknowns with the claimed noise; what the recording does not determine has no part in it.
pub(super) fn covariance(design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> DMatrix<f64> {
    if let Ok(baseline) = baseline(design, fit, &claimed.of_fit()) {
        return match &claimed.correlated {
            Some(correlated) if claimed.in_common().is_none() => {
                baseline.covariance_with(&correlated.expected())
            }
            _ => baseline.covariance(),
        };
    }
    let mut rows = evidence::over_noise(&fit.jacobian, &claimed.u);
    for (at, unknown) in design.unknowns.iter().enumerate() {
        if let Some((_, u)) = unknown.prior {
            rows = rows.insert_row(0, 0.0);
            rows[(0, at)] = 1.0 / u;
        }
    }
    let inverse = evidence::inverse(&rows);
    &inverse * inverse.transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn predictions_are_worse_beyond_chance_alone() {
        let quality = |held_out: f64| Quality {
            chi_squared: 100.0,
            observations: 100,
            dof: 98.0,
            residual: vec![1.0],
            expected: vec![1.0],
            held_out: vec![held_out],
        };
        // exp(1.645·2/√100) = 1.3896, of squares.
        let before = quality(1.0);
        assert!(!quality(1.17).predicts_worse(&before));
        assert!(quality(1.19).predicts_worse(&before));
    }

    #[test]
    fn laws_that_disagree_cost_degrees_of_freedom() {
        use gumption_core::special::normal_cdf;
        let law = |variance: f64, dof: f64| Spread {
            variances: DVector::from_element(1, variance),
            expected: 1.0,
            dof,
        };
        assert_eq!(mixed(&[law(3.0, 12.0)], 0), (3.0, 12.0));
        assert_eq!(mixed(&[law(3.0, f64::INFINITY)], 0), (3.0, f64::INFINITY));
        // Of normal distributions of u² = 1 or 3, as likely: Φ(k√2) + Φ(k√(2/3)) = 1.95, k = 2.0383.
        let both = [law(1.0, f64::INFINITY), law(3.0, f64::INFINITY)];
        let (variance, dof) = mixed(&both, 0);
        let k = student_t_two_sided_quantile(0.95, dof);
        let inside = |scale: f64| 2.0 * normal_cdf(k * scale) - 1.0;
        assert_eq!(variance, 2.0);
        assert!((inside(2.0_f64.sqrt()) + inside((2.0 / 3.0_f64).sqrt()) - 1.9).abs() < 1e-12);
        // A narrower interval than that of a normal distribution is not stated.
        assert!(dof.is_finite() && k > 1.96);
        // One law of many that allows a hundred times as much: no interval of finite variance is wider than √(4/(9·0.05)) standard
        // deviations (Vysochanskij and Petunin 1980).
        let mut many = vec![law(1.0, f64::INFINITY); 19];
        many.push(law(1e4, f64::INFINITY));
        let (_, dof) = mixed(&many, 0);
        assert!(student_t_two_sided_quantile(0.95, dof) < 2.98);
    }
}
