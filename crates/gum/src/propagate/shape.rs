//! The distribution of a linearised output, as far as coverage factors need it.
//!
//! Where no component dominates it is normal, or t. Where one or two rectangles do, it is their
//! convolution with a normal remainder, in closed form; where another distribution does, the
//! convolution is an integral over that distribution's quantiles.

use gumption_core::distribution::Distribution;
use gumption_core::special::roots::last;
use gumption_core::special::{
    normal_cdf, normal_pdf, student_t_cdf, student_t_sf, student_t_two_sided,
    student_t_two_sided_quantile,
};

/// A zero-mean distribution.
#[derive(Debug, Clone)]
pub(super) enum Shape<'d> {
    /// Scaled t; normal for infinite ν.
    StudentT { scale: f64, dof: f64 },
    /// Sum of two rectangles (half-widths `a` ≥ `b` ≥ 0) and a normal remainder.
    Rectangles { a: f64, b: f64, remainder: f64 },
    /// `factor` times a distribution, and a normal remainder.
    Dominant {
        factor: f64,
        distribution: &'d Distribution,
        remainder: f64,
    },
    /// The finite trials of Monte Carlo in ascending order.
    Trials(Vec<f64>),
}

impl Shape<'_> {
    /// A t-distribution of unit scale; normal for infinite ν.
    pub(super) const fn student_t(dof: f64) -> Self {
        Shape::StudentT { scale: 1.0, dof }
    }

    /// Probability of a value up to `x`.
    pub(super) fn cdf(&self, x: f64) -> f64 {
        match self {
            Shape::StudentT { scale, dof } => student_t_cdf(x / scale, *dof),
            Shape::Rectangles { a, b, remainder } => {
                rectangles_cdf(x, *a, *b, *remainder).clamp(0.0, 1.0)
            }
            Shape::Dominant {
                factor,
                distribution,
                remainder,
            } => convolved_cdf(x, *factor, distribution, *remainder),
            Shape::Trials(values) => {
                values.partition_point(|value| *value <= x) as f64 / values.len() as f64
            }
        }
    }

    /// Probability of a value above `x`, with its digits where it is small.
    pub(super) fn sf(&self, x: f64) -> f64 {
        match self {
            Shape::StudentT { scale, dof } => student_t_sf(x / scale, *dof),
            Shape::Rectangles { .. } => self.cdf(-x),
            Shape::Dominant {
                factor,
                distribution,
                remainder,
            } => convolved_cdf(-x, -factor, distribution, *remainder),
            Shape::Trials(_) => 1.0 - self.cdf(x),
        }
    }

    /// Probability of a value in ±`half_width`.
    pub(super) fn coverage(&self, half_width: f64) -> f64 {
        match self {
            Shape::StudentT { scale, dof } => student_t_two_sided(half_width / scale, *dof),
            _ => self.cdf(half_width) - self.cdf(-half_width),
        }
    }

    /// The half-width of the interval about zero that has probability `p`.
    pub(super) fn half_width(&self, p: f64) -> f64 {
        match self {
            Shape::StudentT { scale, dof } => scale * student_t_two_sided_quantile(p, *dof),
            Shape::Rectangles { a, b, remainder } => self.search(p, a + b + 4.0 * remainder),
            Shape::Dominant {
                factor,
                distribution,
                remainder,
            } => {
                let sd = distribution.standard_deviation().unwrap_or(1.0);
                self.search(p, 3.0 * factor.abs() * sd + 4.0 * remainder)
            }
            Shape::Trials(_) => self.search(p, 1.0),
        }
    }

    /// Bisection from a first guess of the upper end; the coverage grows with the half-width.
    fn search(&self, p: f64, guess: f64) -> f64 {
        let (mut low, mut high) = (0.0, guess);
        for _ in 0..1024 {
            if self.coverage(high) >= p || !high.is_finite() {
                break;
            }
            low = high;
            high *= 2.0;
        }
        match high.is_finite() {
            true => last(high, low, |half| self.coverage(half) >= p),
            false => high,
        }
    }
}

/// Distribution function of R(−a, a) + R(−b, b) + N(0, σ²).
///
/// The density of a rectangle is a difference of two steps, so the distribution function of the sum
/// is a difference of integrals of Φ: of the first for one rectangle, of the second for two.
fn rectangles_cdf(x: f64, a: f64, b: f64, sigma: f64) -> f64 {
    // Below this the second rectangle is a rounding error of the first.
    if b <= 1e-7 * a {
        return (ramp(x + a, sigma) - ramp(x - a, sigma)) / (2.0 * a);
    }
    let inner = parabola(x + a - b, sigma) + parabola(x - a + b, sigma);
    (parabola(x + a + b, sigma) - inner + parabola(x - a - b, sigma)) / (4.0 * a * b)
}

/// ∫ Φ(t/σ) dt up to x; max(x, 0) for σ = 0.
fn ramp(x: f64, sigma: f64) -> f64 {
    let z = x / sigma;
    if sigma == 0.0 || z.abs() > 40.0 {
        return x.max(0.0);
    }
    sigma * (z * normal_cdf(z) + normal_pdf(z))
}

/// The integral of [`ramp`]; max(x, 0)²/2 for σ = 0.
fn parabola(x: f64, sigma: f64) -> f64 {
    let z = x / sigma;
    if sigma == 0.0 {
        return 0.5 * x.max(0.0).powi(2);
    }
    if z.abs() > 40.0 {
        return if x > 0.0 {
            0.5 * (x * x + sigma * sigma)
        } else {
            0.0
        };
    }
    0.5 * sigma * sigma * ((z * z + 1.0) * normal_cdf(z) + z * normal_pdf(z))
}

/// Distribution function of factor·E + N(0, σ²): the mean over p of Φ((x − factor·q(p))/σ).
fn convolved_cdf(x: f64, factor: f64, distribution: &Distribution, sigma: f64) -> f64 {
    if sigma == 0.0 {
        return scaled_cdf(x, factor, distribution);
    }
    let below = |value: f64| normal_cdf((x - factor * value) / sigma);
    distribution.sum(&below).unwrap_or_else(|| {
        let integrand = |p: f64| below(distribution.quantile(p));
        // Φ falls from 1 to 0 around here: with a breakpoint there no step can be overlooked.
        let middle = distribution.cdf(x / factor).clamp(0.0, 1.0);
        integral(&integrand, 0.0, middle) + integral(&integrand, middle, 1.0)
    })
}

/// Distribution function of factor·E.
fn scaled_cdf(x: f64, factor: f64, distribution: &Distribution) -> f64 {
    if factor > 0.0 {
        distribution.cdf(x / factor)
    } else {
        distribution.sf(x / factor)
    }
}

/// Adaptive Simpson rule for a bounded function.
fn integral(f: &impl Fn(f64) -> f64, from: f64, to: f64) -> f64 {
    if to <= from {
        return 0.0;
    }
    const PANELS: usize = 16;
    let width = (to - from) / PANELS as f64;
    // The last panel ends where it should: a probability beyond 1, by a rounding, has no quantile.
    let edge = |i: usize| (from + width * i as f64).min(to);
    (0..PANELS)
        .map(|i| {
            let (a, b) = (edge(i), edge(i + 1));
            let ends = [f(a), f(0.5 * (a + b)), f(b)];
            simpson(f, [a, b], ends, 1e-10 / PANELS as f64, 30)
        })
        .sum()
}

fn simpson(
    f: &impl Fn(f64) -> f64,
    [a, b]: [f64; 2],
    [fa, fm, fb]: [f64; 3],
    tolerance: f64,
    depth: u32,
) -> f64 {
    let m = 0.5 * (a + b);
    let (left, right) = (f(0.5 * (a + m)), f(0.5 * (m + b)));
    let whole = (b - a) / 6.0 * (fa + 4.0 * fm + fb);
    let halves = (b - a) / 12.0 * (fa + 4.0 * left + 2.0 * fm + 4.0 * right + fb);
    let error = halves - whole;
    if depth == 0 || error.abs() <= 15.0 * tolerance || m <= a || m >= b {
        return halves + error / 15.0;
    }
    simpson(f, [a, m], [fa, left, fm], 0.5 * tolerance, depth - 1)
        + simpson(f, [m, b], [fm, right, fb], 0.5 * tolerance, depth - 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_core::distribution::{
        Arcsine, Discrete, Empirical, Exponential, Trapezoidal, Triangular, Uniform,
    };

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance, "{a} is not {b}");
    }

    /// k of a rectangle (unit variance share `share`) with a normal remainder.
    fn rectangle_k(share: f64, p: f64) -> f64 {
        let (a, remainder) = ((3.0 * share).sqrt(), (1.0 - share).sqrt());
        Shape::Rectangles {
            a,
            b: 0.0,
            remainder,
        }
        .half_width(p)
    }

    #[test]
    fn one_rectangle() {
        close(rectangle_k(1.0, 0.95), 0.95 * 3f64.sqrt(), 1e-11);
        // Shares of variance against k for 95 %, by a midpoint sum over the rectangle.
        let expected = [
            (0.50, 1.917424),
            (0.64, 1.879267),
            (0.81, 1.804614),
            (0.90, 1.743844),
            (0.96, 1.687124),
        ];
        for (share, k) in expected {
            close(rectangle_k(share, 0.95), k, 1e-6);
        }
        close(rectangle_k(1e-6, 0.95), 1.959964, 1e-5);
    }

    /// The coverage factor of a trapezoid, β = top width over base width.
    fn trapezoid_k(p: f64, beta: f64) -> f64 {
        let scale = ((1.0 + beta * beta) / 6.0).sqrt();
        if p / (2.0 - p) >= beta {
            (1.0 - ((1.0 - p) * (1.0 - beta * beta)).sqrt()) / scale
        } else {
            0.5 * p * (1.0 + beta) / scale
        }
    }

    #[test]
    fn two_rectangles() {
        for beta in [0.0, 0.2, 0.33, 0.6, 0.9, 0.97, 0.999] {
            // Half-widths a ≥ b: base 2(a + b), top 2(a − b).
            let (a, b) = (0.5 * (1.0 + beta), 0.5 * (1.0 - beta));
            let u = f64::sqrt((a * a + b * b) / 3.0);
            for p in [0.5, 0.95, 0.9545, 0.99] {
                let k = Shape::Rectangles {
                    a,
                    b,
                    remainder: 0.0,
                }
                .half_width(p)
                    / u;
                close(k, trapezoid_k(p, beta), 1e-9);
            }
        }
    }

    #[test]
    fn ea_4_02_s10() {
        // 50 µm and 25 µm, β = 0.33: published k = 1.83.
        let u = ((50.0_f64.powi(2) + 25.0_f64.powi(2)) / 3.0).sqrt();
        let k = Shape::Rectangles {
            a: 50.0,
            b: 25.0,
            remainder: 0.0,
        }
        .half_width(0.95)
            / u;
        close(k, 1.83, 0.005);
    }

    #[test]
    fn closed_form_and_integral_agree() {
        let rectangle = Distribution::Uniform(Uniform {
            lower: -1.0,
            upper: 1.0,
        });
        let triangle = Distribution::Triangular(Triangular {
            lower: -1.0,
            mode: 0.0,
            upper: 1.0,
        });
        for remainder in [0.0, 1e-6, 0.01, 0.2, 1.0] {
            let closed = Shape::Rectangles {
                a: 1.0,
                b: 0.0,
                remainder,
            };
            let integral = Shape::Dominant {
                factor: -1.0,
                distribution: &rectangle,
                remainder,
            };
            close(closed.half_width(0.95), integral.half_width(0.95), 1e-7);
            let closed = Shape::Rectangles {
                a: 0.5,
                b: 0.5,
                remainder,
            };
            let integral = Shape::Dominant {
                factor: 1.0,
                distribution: &triangle,
                remainder,
            };
            close(closed.half_width(0.95), integral.half_width(0.95), 1e-7);
        }
    }

    /// A trapezoid is the sum of two rectangles, whatever the share of the remainder: the ends of the panels of the integral
    /// fall anywhere, and one that was rounded beyond a probability of 1 made k = 0.87 of 1.69.
    #[test]
    fn a_trapezoid_with_any_remainder() {
        for step in 0..40 {
            let beta = 0.025 * f64::from(step);
            let trapezoid = Distribution::Trapezoidal(Trapezoidal {
                lower: -1.0,
                upper: 1.0,
                beta,
            });
            for parts in 1..30 {
                let remainder = 0.0137 * f64::from(parts);
                let [closed, integral] = [
                    Shape::Rectangles {
                        a: 0.5 * (1.0 + beta),
                        b: 0.5 * (1.0 - beta),
                        remainder,
                    },
                    Shape::Dominant {
                        factor: 1.0,
                        distribution: &trapezoid,
                        remainder,
                    },
                ];
                close(closed.half_width(0.95), integral.half_width(0.95), 1e-7);
            }
        }
    }

    #[test]
    fn other_shapes_without_remainder() {
        let arcsine = Distribution::Arcsine(Arcsine {
            lower: -1.0,
            upper: 1.0,
        });
        let shape = Shape::Dominant {
            factor: 2.0,
            distribution: &arcsine,
            remainder: 0.0,
        };
        close(
            shape.half_width(0.95),
            2.0 * (0.475 * std::f64::consts::PI).sin(),
            1e-9,
        );
        // Exponential of mean 1 about its mean: 1 − e^−(1+h) = 0.95 for h > 1.
        let exponential = Distribution::Exponential(Exponential {
            origin: -1.0,
            mean: 1.0,
        });
        for factor in [1.0, -1.0] {
            let shape = Shape::Dominant {
                factor,
                distribution: &exponential,
                remainder: 0.0,
            };
            close(shape.half_width(0.95), 20f64.ln() - 1.0, 1e-9);
        }
    }

    #[test]
    fn an_exponential_with_remainder() {
        // Exponentially modified normal distribution in closed form.
        let (mean, sigma) = (1.0, 0.3);
        let exponential = Distribution::Exponential(Exponential {
            origin: -mean,
            mean,
        });
        let closed = |x: f64| {
            let z = x + mean;
            normal_cdf(z / sigma) - (0.5 * sigma * sigma - z).exp() * normal_cdf(z / sigma - sigma)
        };
        for x in [-1.5, -0.5, 0.0, 1.0, 3.0] {
            close(convolved_cdf(x, 1.0, &exponential, sigma), closed(x), 1e-9);
            close(
                convolved_cdf(x, -1.0, &exponential, sigma),
                1.0 - closed(-x),
                1e-9,
            );
        }
    }

    #[test]
    fn steps() {
        let coin = Distribution::Discrete(Discrete {
            values: [-1.0, 1.0].into(),
            probabilities: [0.5, 0.5].into(),
        });
        let sample = Distribution::Empirical(Empirical {
            sample: [-1.0, -1.0, 1.0, 1.0].into(),
        });
        for distribution in [&coin, &sample] {
            let shape = Shape::Dominant {
                factor: 1.0,
                distribution,
                remainder: 0.1,
            };
            // P(|±1 + 0.1 z| < h) = Φ((h − 1)/0.1) but for Φ(−20).
            close(shape.coverage(1.1), normal_cdf(1.0), 1e-12);
        }
    }

    #[test]
    fn coverage_and_half_width_are_inverse() {
        let arcsine = Distribution::Arcsine(Arcsine {
            lower: -1.0,
            upper: 1.0,
        });
        let shapes = [
            Shape::StudentT {
                scale: 0.2,
                dof: 4.5,
            },
            Shape::StudentT {
                scale: 0.2,
                dof: f64::INFINITY,
            },
            Shape::Rectangles {
                a: 2.0,
                b: 0.3,
                remainder: 0.1,
            },
            Shape::Dominant {
                factor: -3.0,
                distribution: &arcsine,
                remainder: 0.1,
            },
        ];
        for shape in shapes {
            for p in [0.5, 0.6827, 0.95, 0.9973] {
                close(shape.coverage(shape.half_width(p)), p, 1e-9);
            }
        }
    }
}
