//! Tails and quantiles of log-concave densities.
//!
//! A density exp(g(y)) with concave g is handled from a point y₀ outwards: its tail is
//! exp(g(y₀)) · J with J = ∫₀^∞ exp(g(y₀ ± δ) − g(y₀)) dδ. Nothing cancels as long as the
//! implementor gives the *rise* g(y₀ + δ) − g(y₀) without cancellation.

use std::sync::LazyLock;

/// A log-concave density on the whole real line, seen from one of its points.
pub(super) trait LogConcave {
    /// g(y₀), the logarithm of the density.
    fn ln_density(&self) -> f64;
    /// g(y₀ + δ) − g(y₀).
    fn rise(&self, delta: f64) -> f64;
    /// g′(y₀).
    fn slope(&self) -> f64;
    /// −g″(y₀), not negative.
    fn curvature(&self) -> f64;
}

/// Which of the two tails.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    /// Probability of values below y₀.
    Lower,
    /// Probability of values above y₀.
    Upper,
}

impl Side {
    fn sign(self) -> f64 {
        match self {
            Side::Lower => -1.0,
            Side::Upper => 1.0,
        }
    }

    /// The other tail.
    pub(super) fn other(self) -> Side {
        match self {
            Side::Lower => Side::Upper,
            Side::Upper => Side::Lower,
        }
    }
}

/// A tail probability, kept so that it can be smaller than any floating-point number.
#[derive(Debug, Clone, Copy)]
pub(super) struct Tail {
    ln_density: f64,
    /// Tail divided by the density at its beginning.
    ratio: f64,
}

impl Tail {
    /// The probability.
    pub(super) fn value(self) -> f64 {
        (libm::exp(self.ln_density) * self.ratio).min(1.0)
    }

    /// Its logarithm.
    fn ln(self) -> f64 {
        self.ln_density + libm::log(self.ratio)
    }
}

/// The tail of `density` on one side of its point.
pub(super) fn tail<D: LogConcave>(density: &D, side: Side) -> Tail {
    let ln_density = density.ln_density();
    if density.slope() * side.sign() <= 0.0 {
        return Tail {
            ln_density,
            ratio: outward(density, side),
        };
    }
    // The density rises towards this side first: the other tail is the simpler integral. Only
    // when it leaves too little is this one integrated over the hump.
    let other = Tail {
        ln_density,
        ratio: outward(density, side.other()),
    }
    .value();
    let ratio = if other < 0.9 {
        (1.0 - other) * libm::exp(-ln_density)
    } else {
        outward(density, side)
    };
    Tail { ln_density, ratio }
}

/// The distance by which the point must be moved so that its tail on this `side` has the
/// logarithm `ln_target`, found by Newton's method; `moved` gives the density seen from a
/// point that lies so far from another.
///
/// ln(tail) is concave, so that the method converges from any start, from one side after the first
/// step; near the end Halley's correction takes the error to its third power at each step.
pub(super) fn solve<D: LogConcave>(
    mut point: D,
    side: Side,
    ln_target: f64,
    moved: impl Fn(&D, f64) -> D,
) -> D {
    for _ in 0..200 {
        let tail = tail(&point, side);
        let excess = tail.ln() - ln_target;
        let mut step = tail.ratio * excess;
        if excess.abs() < 1.0 {
            // Halley's correction; the second derivative of ln(tail) is known.
            let slope = point.slope() * side.sign();
            step /= 1.0 + 0.5 * excess * (1.0 + tail.ratio * slope);
        }
        if tail.ln() > -0.5 {
            // Far on the wrong side the tail is flat and the tangent useless.
            let scale = 4.0 * length(&point);
            if step.abs() > scale {
                step = scale.copysign(step);
            }
        }
        if step.is_nan() {
            break;
        }
        point = moved(&point, side.sign() * step);
        if excess.abs() <= 1e-5 {
            break;
        }
    }
    point
}

/// J = ∫₀^∞ exp(rise(±δ)) dδ.
fn outward<D: LogConcave>(density: &D, side: Side) -> f64 {
    let sign = side.sign();
    half_line(length(density), |delta| density.rise(sign * delta))
}

/// The distance over which the density changes by about a factor e.
fn length<D: LogConcave>(density: &D) -> f64 {
    1.0 / (density.slope().abs() + density.curvature().sqrt())
}

/// ∫₀^∞ exp(g(δ)) dδ, where g(0) = 0 and g is concave and falls in the end.
///
/// Trapezoidal rule after δ = length·exp(τ − exp(−τ)) (Takahasi and Mori 1974). Its number of
/// correct digits doubles with every halving of the step for most densities, and grows by a third
/// for the most crooked ones: an agreement to eleven digits means that the finer sum has all.
fn half_line(length: f64, g: impl Fn(f64) -> f64) -> f64 {
    let mut integral = 0.0;
    for (number, level) in LEVELS.iter().enumerate() {
        let sum = length * level.sum(|node| g(length * node));
        let finer = if number == 0 {
            sum
        } else {
            0.5 * integral + sum
        };
        let change = (finer - integral).abs();
        integral = finer;
        if change <= 3e-11 * integral {
            break;
        }
    }
    integral
}

/// The nodes exp(τ − exp(−τ)) that one halving of the step adds, with their weights.
struct Level {
    /// From τ ≥ 0 up.
    outer: Vec<(f64, f64)>,
    /// From τ < 0 down to where the nodes are no different from zero.
    inner: Vec<(f64, f64)>,
}

impl Level {
    /// Nodes at τ = offset + n·spacing, for a trapezoidal rule of this step.
    fn new(step: f64, spacing: f64, offset: f64) -> Level {
        let node = |tau: f64| {
            let shrink = libm::exp(-tau);
            let delta = libm::exp(tau - shrink);
            (delta, step * delta * (1.0 + shrink))
        };
        let nodes = |first: f64, spacing: f64, count: f64| {
            (0..(count / spacing.abs()) as u32)
                .map(|n| node(first + spacing * f64::from(n)))
                .collect()
        };
        Level {
            outer: nodes(offset, spacing, 60.0),
            inner: nodes(offset - spacing, -spacing, 3.8),
        }
    }

    /// Σ weight·exp(g(node)), outwards until the terms no longer count.
    fn sum(&self, g: impl Fn(f64) -> f64) -> f64 {
        let mut sum = 0.0;
        for (node, weight) in &self.outer {
            let g = g(*node);
            let term = weight * libm::exp(g);
            sum += term;
            if g < -2.0 && term <= 1e-18 * sum {
                break;
            }
        }
        sum + self
            .inner
            .iter()
            .map(|(node, weight)| weight * libm::exp(g(*node)))
            .sum::<f64>()
    }
}

/// Steps 0.35, 0.35/2, 0.35/4, … of the rule in [`half_line`].
static LEVELS: LazyLock<Vec<Level>> = LazyLock::new(|| {
    const FIRST: f64 = 0.35;
    let mut levels = vec![Level::new(FIRST, FIRST, 0.0)];
    levels.extend((1..6).map(|halvings| {
        let step = FIRST * 0.5f64.powi(halvings);
        Level::new(step, 2.0 * step, step)
    }));
    levels
});

/// ln(1 + r) − r without cancellation.
pub(super) fn ln_1p_minus(r: f64) -> f64 {
    if r.abs() > 0.5 {
        return libm::log1p(r) - r;
    }
    // ln(1+r) = 2 artanh(q), and 2q − r = −q·r.
    let q = r / (2.0 + r);
    let square = q * q;
    let mut power = 1.0;
    let mut sum = 0.0;
    let mut odd = 3.0;
    while power > 1e-18 {
        sum += power / odd;
        power *= square;
        odd += 2.0;
    }
    q * (2.0 * square * sum - r)
}

/// exp(d) − 1 − d without cancellation.
pub(super) fn exp_m1_minus(d: f64) -> f64 {
    if d.abs() > 0.5 {
        return libm::expm1(d) - d;
    }
    let mut term = 0.5 * d * d;
    let mut sum = 0.0;
    let mut n = 3.0;
    while term.abs() > 1e-18 * sum {
        sum += term;
        term *= d / n;
        n += 1.0;
    }
    sum
}

/// a·(r − 1 − ln r) for r = ratio, where `difference` = a·(r − 1) is known without cancellation.
///
/// What a Poisson or binomial density loses against its mode (half a deviance; Loader 2000).
pub(super) fn deviance(a: f64, difference: f64, ratio: f64) -> f64 {
    let relative = difference / a;
    if relative.abs() < 0.5 {
        -a * ln_1p_minus(relative)
    } else {
        difference - a * libm::log(ratio)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn half_line_integrals_with_closed_forms() {
        let close = |found: f64, expected: f64| {
            assert!((found / expected - 1.0).abs() < 4e-15, "{found} {expected}");
        };
        let half_pi = std::f64::consts::FRAC_PI_2;
        close(half_line(1.0, |d| -d), 1.0);
        // A length that is wrong by a factor does not matter.
        close(half_line(0.3, |d| -d), 1.0);
        close(half_line(1.0, |d| -0.5 * d * d), half_pi.sqrt());
        // e·E₁(1)
        close(half_line(0.5, |d| -d.exp_m1()), 0.596_347_362_323_194_1);
        // ∫ sech = π/2
        close(half_line(1.0, |d| -d.cosh().ln()), half_pi);
    }

    #[test]
    fn differences_do_not_cancel() {
        assert_eq!(ln_1p_minus(0.0), 0.0);
        assert!((ln_1p_minus(1e-10) / -4.999_999_999_666_667e-21 - 1.0).abs() < 1e-15);
        assert!((ln_1p_minus(-0.4) / (0.6f64.ln() + 0.4) - 1.0).abs() < 1e-14);
        assert_eq!(exp_m1_minus(0.0), 0.0);
        assert!((exp_m1_minus(1e-10) / 5.000_000_000_166_667e-21 - 1.0).abs() < 1e-15);
        assert!((exp_m1_minus(-0.4) / ((-0.4f64).exp() - 0.6) - 1.0).abs() < 1e-14);
    }
}
