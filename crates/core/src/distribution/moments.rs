//! Expectation, variance and higher central moments, in closed form.

use super::Distribution;

impl Distribution {
    /// Expectation; `None` when it does not exist (t with ν ≤ 1).
    pub fn mean(&self) -> Option<f64> {
        match self {
            Self::Normal { mean, .. } => Some(*mean),
            Self::StudentT { location, dof, .. } => (*dof > 1.0).then_some(*location),
            Self::Uniform { lower, upper }
            | Self::Trapezoidal { lower, upper, .. }
            | Self::CurvilinearTrapezoid { lower, upper, .. }
            | Self::Arcsine { lower, upper } => Some(0.5 * (lower + upper)),
            Self::Triangular { lower, mode, upper } => Some((lower + mode + upper) / 3.0),
            Self::Exponential { origin, mean } => Some(origin + mean),
            Self::Gamma {
                origin,
                shape,
                scale,
            } => Some(origin + shape * scale),
            Self::LogNormal { origin, mu, sigma } => {
                Some(origin + libm::exp(mu + 0.5 * sigma * sigma))
            }
            Self::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => Some((lower * beta + upper * alpha) / (alpha + beta)),
            Self::Discrete { .. } | Self::Empirical { .. } => Some(self.finite_mean()),
        }
    }

    /// Variance; `None` when it does not exist (t with ν ≤ 2).
    pub fn variance(&self) -> Option<f64> {
        match self {
            Self::Normal { sd, .. } => Some(sd * sd),
            Self::StudentT { scale, dof, .. } => {
                (*dof > 2.0).then(|| scale * scale * over(*dof, 2.0))
            }
            // JCGM 101 6.4.2.4
            Self::Uniform { lower, upper } => Some((upper - lower).powi(2) / 12.0),
            Self::Triangular { lower, mode, upper } => {
                let (rise, fall) = (mode - lower, upper - mode);
                Some((rise * rise + rise * fall + fall * fall) / 18.0)
            }
            // JCGM 101 6.4.4.4
            Self::Trapezoidal { lower, upper, beta } => {
                Some((upper - lower).powi(2) * (1.0 + beta * beta) / 24.0)
            }
            // JCGM 101 6.4.3.4
            Self::CurvilinearTrapezoid { lower, upper, d } => {
                Some((upper - lower).powi(2) / 12.0 + d * d / 9.0)
            }
            // JCGM 101 6.4.6.4
            Self::Arcsine { lower, upper } => Some((upper - lower).powi(2) / 8.0),
            Self::Exponential { mean, .. } => Some(mean * mean),
            Self::Gamma { shape, scale, .. } => Some(shape * scale * scale),
            Self::LogNormal { mu, sigma, .. } => {
                let square = sigma * sigma;
                Some(libm::expm1(square) * libm::exp(2.0 * mu + square))
            }
            Self::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => {
                let n = alpha + beta;
                Some((upper - lower).powi(2) * (alpha / n) * (beta / n) / (n + 1.0))
            }
            Self::Discrete { .. } | Self::Empirical { .. } => Some(self.finite_moment(2)),
        }
    }

    /// Standard deviation; `None` when it does not exist.
    pub fn standard_deviation(&self) -> Option<f64> {
        self.variance().map(f64::sqrt)
    }

    /// E(X − E X)³; `None` when it does not exist (t with ν ≤ 3).
    pub fn third_central_moment(&self) -> Option<f64> {
        match self {
            Self::StudentT { dof, .. } => (*dof > 3.0).then_some(0.0),
            Self::Normal { .. }
            | Self::Uniform { .. }
            | Self::Trapezoidal { .. }
            | Self::CurvilinearTrapezoid { .. }
            | Self::Arcsine { .. } => Some(0.0),
            Self::Triangular { lower, mode, upper } => {
                let (rise, fall) = (mode - lower, upper - mode);
                Some((fall - rise) * (2.0 * rise + fall) * (rise + 2.0 * fall) / 270.0)
            }
            Self::Exponential { mean, .. } => Some(2.0 * mean.powi(3)),
            Self::Gamma { shape, scale, .. } => Some(2.0 * shape * scale.powi(3)),
            Self::LogNormal { mu, sigma, .. } => {
                let square = sigma * sigma;
                let grown = libm::expm1(square);
                Some(grown * grown * (grown + 3.0) * libm::exp(3.0 * mu + 1.5 * square))
            }
            Self::Beta { alpha, beta, .. } => {
                let n = alpha + beta;
                let variance = self.variance()?;
                let skewness = 2.0 * (beta - alpha) * (n + 1.0).sqrt()
                    / ((n + 2.0) * alpha.sqrt() * beta.sqrt());
                Some(skewness * libm::pow(variance, 1.5))
            }
            Self::Discrete { .. } | Self::Empirical { .. } => Some(self.finite_moment(3)),
        }
    }

    /// E(X − E X)⁴; `None` when it does not exist (t with ν ≤ 4).
    pub fn fourth_central_moment(&self) -> Option<f64> {
        match self {
            Self::Normal { sd, .. } => Some(3.0 * sd.powi(4)),
            Self::StudentT { scale, dof, .. } => {
                (*dof > 4.0).then(|| 3.0 * scale.powi(4) * over(*dof, 2.0) * over(*dof, 4.0))
            }
            Self::Uniform { lower, upper } => Some((upper - lower).powi(4) / 80.0),
            Self::Triangular { .. } => self.variance().map(|v| 2.4 * v * v),
            Self::Trapezoidal { lower, upper, beta } => {
                // The sum of two rectangular variables with these half-widths.
                let wide = 0.25 * (upper - lower) * (1.0 + beta);
                let narrow = 0.25 * (upper - lower) * (1.0 - beta);
                Some(
                    (wide.powi(4) + narrow.powi(4)) / 5.0
                        + 2.0 * wide * wide * narrow * narrow / 3.0,
                )
            }
            Self::CurvilinearTrapezoid { lower, upper, d } => {
                // A rectangular variable times its rectangular half-width h ± d.
                let h = 0.5 * (upper - lower);
                Some((h.powi(4) + 2.0 * h * h * d * d + d.powi(4) / 5.0) / 5.0)
            }
            Self::Arcsine { lower, upper } => Some(3.0 / 128.0 * (upper - lower).powi(4)),
            Self::Exponential { mean, .. } => Some(9.0 * mean.powi(4)),
            Self::Gamma { shape, scale, .. } => Some(3.0 * shape * (shape + 2.0) * scale.powi(4)),
            Self::LogNormal { sigma, .. } => {
                let w = libm::exp(sigma * sigma);
                let kurtosis = w * w * (w * w + 2.0 * w + 3.0) - 3.0;
                self.variance().map(|v| kurtosis * v * v)
            }
            Self::Beta { alpha, beta, .. } => {
                let n = alpha + beta;
                let excess = 6.0 * ((alpha - beta).powi(2) * (n + 1.0) - alpha * beta * (n + 2.0))
                    / (alpha * beta * (n + 2.0) * (n + 3.0));
                self.variance().map(|v| (3.0 + excess) * v * v)
            }
            Self::Discrete { .. } | Self::Empirical { .. } => Some(self.finite_moment(4)),
        }
    }

    /// Mean of the kinds with finitely many values.
    fn finite_mean(&self) -> f64 {
        // About the first value, so that a large common offset costs no digits.
        let mut first = None;
        let mut sum = 0.0;
        self.for_each_value(|x, p| sum += p * (x - *first.get_or_insert(x)));
        first.unwrap_or(f64::NAN) + sum
    }

    /// Central moment of the kinds with finitely many values.
    fn finite_moment(&self, order: i32) -> f64 {
        let mean = self.finite_mean();
        let mut sum = 0.0;
        self.for_each_value(|x, p| sum += p * (x - mean).powi(order));
        sum
    }

    /// Calls `visit(value, probability)` for the kinds with finitely many values.
    fn for_each_value(&self, mut visit: impl FnMut(f64, f64)) {
        match self {
            Self::Discrete {
                values,
                probabilities,
            } => {
                values
                    .iter()
                    .zip(probabilities.iter())
                    .for_each(|(x, p)| visit(*x, *p));
            }
            Self::Empirical { sample } => {
                let p = 1.0 / sample.len() as f64;
                sample.iter().for_each(|x| visit(*x, p));
            }
            _ => {}
        }
    }
}

/// ν/(ν − less), also for infinite ν.
fn over(dof: f64, less: f64) -> f64 {
    if dof.is_infinite() {
        1.0
    } else {
        dof / (dof - less)
    }
}
