//! Gaussian copula: margins as stated, and the correlation that was stated.
//!
//! Correlated inputs that are not normal are drawn as F_a⁻¹(Φ(z₁)), F_b⁻¹(Φ(z₂)) from correlated
//! standard normals z. Their product-moment correlation r is smaller in size than the latent ρ of
//! the normals; [`latent_correlation`] finds the ρ for a stated r.
//!
//! With h = F⁻¹∘Φ expanded in Hermite polynomials, h = Σ c_k He_k/√k!, Mehler's formula says
//! r(ρ) = Σ c_k d_k ρᵏ/(σ_a σ_b). The coefficients come from one-dimensional integrals, so that
//! kinks and steps of the margins can be respected; r(1) and r(−1) are integrals as well, which
//! gives the sum of the terms that are left out.

use std::fmt;

use gumption_fault::{Said, say};

use super::Distribution;
use crate::special::{erfc, gauss_legendre, normal_cdf, normal_pdf, normal_quantile, normal_sf};

/// Why no latent correlation exists.
#[derive(Debug, Clone, PartialEq)]
pub enum CopulaError {
    /// |r| > 1 or not a number.
    NotACorrelation {
        /// The correlation that was asked for.
        wanted: f64,
    },
    /// One of the margins has no variance (t with ν ≤ 2) or does not vary, so that correlation is
    /// not defined.
    NoCorrelation,
    /// These two margins cannot be as correlated as that.
    OutOfReach {
        /// The correlation that was asked for.
        wanted: f64,
        /// Correlation of the two margins when one falls while the other rises.
        smallest: f64,
        /// Correlation of the two margins when they rise together.
        largest: f64,
    },
}

impl CopulaError {
    /// What is wrong, as a sentence without its stop.
    pub fn said(&self) -> Said {
        match self {
            Self::NotACorrelation { wanted } => {
                say!("a correlation coefficient lies between -1 and 1, but {wanted} was given")
            }
            Self::NoCorrelation => say!(
                "a correlation needs two distributions with a finite standard deviation above zero"
            ),
            Self::OutOfReach {
                wanted,
                smallest,
                largest,
            } => say!(
                "two quantities with these distributions can have correlation coefficients from \
                 {smallest:.4} to {largest:.4} only, but {wanted} was given"
            ),
        }
    }
}

impl fmt::Display for CopulaError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.said(), f)
    }
}

impl std::error::Error for CopulaError {}

/// Correlation of the two latent standard normals for which F_a⁻¹(Φ(z₁)) and F_b⁻¹(Φ(z₂)) have
/// the product-moment correlation `r`.
///
/// # Errors
/// When no such correlation exists.
///
/// ```
/// use gumption_core::distribution::{Uniform, latent_correlation};
///
/// let a = Uniform { lower: -1.0, upper: 1.0 }.into();
/// let rho = latent_correlation(&a, &a, 0.5)?;
/// assert!((rho - 2.0 * (std::f64::consts::PI * 0.5 / 6.0).sin()).abs() < 1e-12);
/// # Ok::<(), gumption_core::distribution::CopulaError>(())
/// ```
pub fn latent_correlation(a: &Distribution, b: &Distribution, r: f64) -> Result<f64, CopulaError> {
    if !(-1.0..=1.0).contains(&r) {
        return Err(CopulaError::NotACorrelation { wanted: r });
    }
    let varies =
        |margin: &Distribution| margin.variance().is_some_and(|v| v > 0.0 && v.is_finite());
    if !varies(a) || !varies(b) {
        return Err(CopulaError::NoCorrelation);
    }
    if r == 0.0 {
        return Ok(0.0);
    }
    closed_form(a, b, r).unwrap_or_else(|| Mehler::new(a, b).inverse(r))
}

/// The pairs whose r(ρ) has an inverse in closed form.
fn closed_form(a: &Distribution, b: &Distribution, r: f64) -> Option<Result<f64, CopulaError>> {
    if a.is_normal() && b.is_normal() {
        return Some(Ok(r));
    }
    let latent = a.latent_correlation(b)?;
    Some(within_reach(r, latent.smallest, latent.largest).map(latent.of))
}

/// `r` itself, or the end of the range that it misses by rounding only.
fn within_reach(r: f64, smallest: f64, largest: f64) -> Result<f64, CopulaError> {
    const ROUNDING: f64 = 1e-9;
    if r < smallest - ROUNDING || r > largest + ROUNDING {
        return Err(CopulaError::OutOfReach {
            wanted: r,
            smallest,
            largest,
        });
    }
    Ok(r.max(smallest).min(largest))
}

/// Terms of the expansion; what comes after is lumped together.
const TERMS: usize = 400;

/// r(ρ) = Σ γ_k ρᵏ.
struct Mehler {
    /// γ_k for k = 1 … TERMS.
    terms: Vec<f64>,
    /// What the left-out even and odd terms sum to at ρ = 1.
    rest_even: f64,
    rest_odd: f64,
    /// r(−1) and r(1).
    smallest: f64,
    largest: f64,
}

impl Mehler {
    fn new(a: &Distribution, b: &Distribution) -> Mehler {
        let (of_a, of_b) = (hermite_coefficients(a), hermite_coefficients(b));
        let terms: Vec<f64> = of_a.iter().zip(&of_b).map(|(c, d)| c * d).collect();
        let largest = extreme(a, b, Sense::Rising);
        let smallest = extreme(a, b, Sense::Falling);
        let odd: f64 = terms.iter().step_by(2).sum();
        let even: f64 = terms.iter().skip(1).step_by(2).sum();
        Mehler {
            rest_even: 0.5 * (largest + smallest) - even,
            rest_odd: 0.5 * (largest - smallest) - odd,
            terms,
            smallest,
            largest,
        }
    }

    fn correlation(&self, rho: f64) -> f64 {
        let series = rho * self.terms.iter().rev().fold(0.0, |sum, c| sum * rho + c);
        series + left_out(rho.abs()) * (self.rest_even + self.rest_odd * rho.signum())
    }

    /// The ρ with r(ρ) = r, by bisection and the secant in turn; r(ρ) rises from r(−1) to r(1).
    fn inverse(&self, r: f64) -> Result<f64, CopulaError> {
        let r = within_reach(r, self.smallest, self.largest)?;
        if r == self.largest {
            return Ok(1.0);
        }
        if r == self.smallest {
            return Ok(-1.0);
        }
        let (mut low, mut high) = if r > 0.0 { (0.0, 1.0) } else { (-1.0, 0.0) };
        let (mut below, mut above) = if r > 0.0 {
            (-r, self.largest - r)
        } else {
            (self.smallest - r, -r)
        };
        for step in 0..200 {
            let secant = low - below * (high - low) / (above - below);
            let middle = if step % 3 == 2 || !(low < secant && secant < high) {
                0.5 * (low + high)
            } else {
                secant
            };
            let error = self.correlation(middle) - r;
            if error.abs() < 1e-15 || high - low < 1e-15 {
                return Ok(middle);
            }
            if error < 0.0 {
                (low, below) = (middle, error);
            } else {
                (high, above) = (middle, error);
            }
        }
        Ok(0.5 * (low + high))
    }
}

/// What is left at ρ of the left-out terms, which sum to 1 at ρ = 1.
///
/// They only matter when both margins have steps, and then fall like k^(−3/2):
/// ∫ k^(−3/2) ρᵏ dk from N, divided by its value for ρ = 1.
fn left_out(rho: f64) -> f64 {
    let u = -libm::log(rho) * (TERMS as f64 + 0.5);
    if u > 700.0 {
        return 0.0;
    }
    libm::exp(-u) - (std::f64::consts::PI * u).sqrt() * erfc(u.sqrt())
}

/// c_k/σ for k = 1 … TERMS.
fn hermite_coefficients(margin: &Distribution) -> Vec<f64> {
    let sd = margin.standard_deviation().unwrap_or(f64::NAN);
    let mut coefficients = vec![0.0; TERMS];
    let steps = steps(margin);
    if !steps.is_empty() {
        // ∫ h He_k φ = Σ jumps · He_{k−1} φ at the jump, after integration by parts.
        for (z, jump) in steps {
            add_hermite(&mut coefficients, z, jump / sd * normal_pdf(z), 0);
        }
        for (index, c) in coefficients.iter_mut().enumerate() {
            *c /= ((index + 1) as f64).sqrt();
        }
    } else {
        let centre = margin.mean().unwrap_or(f64::NAN);
        for (z, weight) in nodes(kinks(margin), reach(margin)) {
            let h = (at(margin, z) - centre) / sd;
            add_hermite(&mut coefficients, z, h * weight, 1);
        }
    }
    coefficients
}

/// Adds `weight`·He_{first+i}(z)/√((first+i)!) to each coefficient i.
fn add_hermite(coefficients: &mut [f64], z: f64, weight: f64, first: usize) {
    let (mut before, mut now) = (0.0, weight);
    let mut degree = 0;
    let mut step = || {
        let value = now;
        let next = (z * now - f64::from(degree).sqrt() * before) / f64::from(degree + 1).sqrt();
        (before, now) = (now, next);
        degree += 1;
        value
    };
    for _ in 0..first {
        step();
    }
    for c in coefficients {
        *c += step();
    }
}

/// Whether the second margin rises or falls when the first rises.
#[derive(Clone, Copy, PartialEq)]
enum Sense {
    Rising,
    Falling,
}

/// Correlation of h_a(z) and h_b(±z), the largest or smallest that the margins allow.
fn extreme(a: &Distribution, b: &Distribution, sense: Sense) -> f64 {
    let sign = if sense == Sense::Rising { 1.0 } else { -1.0 };
    let standard = |margin: &Distribution| {
        let mean = margin.mean().unwrap_or(f64::NAN);
        let sd = margin.standard_deviation().unwrap_or(f64::NAN);
        move |x: f64| (x - mean) / sd
    };
    let (of_a, of_b) = (standard(a), standard(b));
    let mut breaks = breaks(a);
    breaks.extend(self::breaks(b).into_iter().map(|z| sign * z));
    nodes(breaks, reach(a).max(reach(b)))
        .into_iter()
        .map(|(z, weight)| weight * of_a(at(a, z)) * of_b(at(b, sign * z)))
        .sum()
}

/// h(z) = F⁻¹(Φ(z)).
fn at(margin: &Distribution, z: f64) -> f64 {
    if z < 0.0 {
        margin.quantile(normal_cdf(z))
    } else {
        margin.upper_quantile(normal_sf(z))
    }
}

/// The z at which h jumps, and by how much.
fn steps(margin: &Distribution) -> Vec<(f64, f64)> {
    let steps = margin.steps().into_iter();
    steps
        .map(|[below, jump]| (normal_quantile(below), jump))
        .filter(|(z, jump)| *jump > 0.0 && z.is_finite())
        .collect()
}

/// The z at which h is not smooth, for the kinds with a density.
fn kinks(margin: &Distribution) -> Vec<f64> {
    let places = margin.kinks().into_iter();
    let latent = places.map(|x| normal_quantile(margin.cdf(x)));
    latent.filter(|z| z.is_finite()).collect()
}

/// Every z at which h is not smooth.
fn breaks(margin: &Distribution) -> Vec<f64> {
    let mut breaks = kinks(margin);
    breaks.extend(steps(margin).into_iter().map(|(z, _)| z));
    breaks
}

/// How far out h² φ counts: a heavy tail does nearly as far as Φ(−z) is a number.
fn reach(margin: &Distribution) -> f64 {
    let (lower, upper) = margin.support();
    if lower.is_finite() && upper.is_finite() {
        10.0
    } else {
        37.0
    }
}

/// Nodes and weights (with the normal density) for integrals over the latent variable, in panels
/// that end at the `breaks`.
fn nodes(breaks: Vec<f64>, reach: f64) -> Vec<(f64, f64)> {
    let mut edges = breaks;
    edges.retain(|z| z.abs() < reach);
    // Narrow enough for Hermite polynomials of the highest degree.
    let panels = (4.0 * reach) as i32;
    edges.extend((0..=panels).map(|n| -reach + 0.5 * f64::from(n)));
    edges.sort_by(f64::total_cmp);
    edges.dedup();
    edges
        .windows(2)
        .flat_map(|edge| gauss_legendre(edge[0], edge[1]))
        .map(|(z, weight)| (z, weight * normal_pdf(z)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::*;
    use rand::{RngExt, SeedableRng};

    fn uniform() -> Distribution {
        Distribution::Uniform(Uniform {
            lower: -2.0,
            upper: 5.0,
        })
    }

    fn log_normal(sigma: f64) -> Distribution {
        Distribution::LogNormal(LogNormal {
            origin: 1.0,
            mu: 0.3,
            sigma,
        })
    }

    fn normal() -> Distribution {
        Distribution::Normal(Normal { mean: 3.0, sd: 0.2 })
    }

    #[test]
    fn series_agrees_with_closed_forms() {
        let pairs = [
            (normal(), normal()),
            (uniform(), uniform()),
            (log_normal(0.4), log_normal(0.9)),
        ];
        for (a, b) in pairs {
            let series = Mehler::new(&a, &b);
            for r in [-0.6, -0.2, 1e-3, 0.4, 0.85] {
                let exact = closed_form(&a, &b, r).unwrap().unwrap();
                let found = series.inverse(r).unwrap();
                assert!((found - exact).abs() < 1e-10, "{a:?} {r}: {found} {exact}");
            }
        }
    }

    #[test]
    fn normal_with_another_is_linear() {
        // E z·h(z) for a rectangle of unit variance is √(3/π); for a lognormal σ/√(exp σ² − 1).
        let rho = latent_correlation(&normal(), &uniform(), 0.6).unwrap();
        assert!((rho - 0.6 * (std::f64::consts::PI / 3.0).sqrt()).abs() < 1e-12);
        let rho = latent_correlation(&log_normal(1.0), &normal(), 0.6).unwrap();
        assert!((rho - 0.6 * 1f64.exp_m1().sqrt()).abs() < 1e-11);
    }

    /// Two equal coins: r = (2/π) arcsin ρ (Sheppard), the slowest series of all.
    #[test]
    fn coins() {
        let coin = Distribution::Discrete(Discrete {
            values: [0.0, 1.0].into(),
            probabilities: [0.5, 0.5].into(),
        });
        for r in [-0.95, -0.5, 0.1, 0.7] {
            let exact = (std::f64::consts::FRAC_PI_2 * r).sin();
            let found = latent_correlation(&coin, &coin, r).unwrap();
            assert!((found - exact).abs() < 1e-6, "{r}: {found} {exact}");
        }
        let found = latent_correlation(&coin, &coin, 0.5).unwrap();
        assert!((found - 0.5f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn ends_of_the_range() {
        let exponential = Distribution::Exponential(Exponential {
            origin: 0.0,
            mean: 2.0,
        });
        let series = Mehler::new(&exponential, &exponential);
        assert!((series.largest - 1.0).abs() < 1e-12);
        // 1 − π²/6
        let smallest = 1.0 - std::f64::consts::PI.powi(2) / 6.0;
        assert!((series.smallest - smallest).abs() < 1e-12);
        assert_eq!(latent_correlation(&exponential, &exponential, 1.0), Ok(1.0));
        let error = latent_correlation(&exponential, &exponential, -0.8).unwrap_err();
        assert!(matches!(error, CopulaError::OutOfReach { .. }));
        assert!(
            error.to_string().contains("from -0.6449 to 1.0000"),
            "{error}"
        );
        let error = latent_correlation(&log_normal(2.0), &log_normal(0.5), 0.9).unwrap_err();
        assert!(matches!(error, CopulaError::OutOfReach { .. }));
    }

    #[test]
    fn no_correlation() {
        let cauchy = Distribution::StudentT(StudentT {
            location: 0.0,
            scale: 1.0,
            dof: 1.0,
        });
        assert_eq!(
            latent_correlation(&cauchy, &normal(), 0.1),
            Err(CopulaError::NoCorrelation)
        );
        let error = latent_correlation(&normal(), &normal(), 1.5);
        assert_eq!(error, Err(CopulaError::NotACorrelation { wanted: 1.5 }));
    }

    #[test]
    fn agrees_with_simulation() {
        let pairs = [
            (
                Distribution::Triangular(Triangular {
                    lower: 0.0,
                    mode: 0.2,
                    upper: 1.0,
                }),
                uniform(),
                0.7,
            ),
            (
                Distribution::Arcsine(Arcsine {
                    lower: -1.0,
                    upper: 1.0,
                }),
                Distribution::Exponential(Exponential {
                    origin: 0.0,
                    mean: 1.0,
                }),
                -0.5,
            ),
            (
                Distribution::Trapezoidal(Trapezoidal {
                    lower: 0.0,
                    upper: 1.0,
                    beta: 0.3,
                }),
                Distribution::Empirical(Empirical {
                    sample: [1.0, 2.0, 2.5, 7.0].into(),
                }),
                0.8,
            ),
            (
                Distribution::CurvilinearTrapezoid(CurvilinearTrapezoid {
                    lower: 0.0,
                    upper: 1.0,
                    d: 0.3,
                }),
                Distribution::StudentT(StudentT {
                    location: 0.0,
                    scale: 1.0,
                    dof: 6.5,
                }),
                0.9,
            ),
        ];
        let mut rng = rand::rngs::SmallRng::seed_from_u64(7);
        for (a, b, r) in pairs {
            let rho = latent_correlation(&a, &b, r).unwrap();
            let trials = 20_000;
            let (mut sum, mut squares) = ([0.0; 2], [0.0; 3]);
            for _ in 0..trials {
                let first = normal_quantile(rng.random::<f64>());
                let other = normal_quantile(rng.random::<f64>());
                let second = rho * first + (1.0 - rho * rho).sqrt() * other;
                let (x, y) = (at(&a, first), at(&b, second));
                sum = [sum[0] + x, sum[1] + y];
                squares = [squares[0] + x * x, squares[1] + y * y, squares[2] + x * y];
            }
            let n = f64::from(trials);
            let covariance = squares[2] / n - sum[0] * sum[1] / (n * n);
            let variance = |i: usize| squares[i] / n - (sum[i] / n).powi(2);
            let found = covariance / (variance(0) * variance(1)).sqrt();
            assert!((found - r).abs() < 0.02, "{a:?} {b:?}: {found}, not {r}");
        }
    }
}
