//! What is known of a quantity, and what follows from it.

use super::words::{Said, plain};

/// What is known. Figures are in the unit of the quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Known {
    /// A certificate: U and k.
    Certificate(f64, f64),
    /// Limits of nothing else.
    Limits(f64),
    /// Limits, the middle being likelier.
    Triangle(f64),
    /// Amplitude of a cycle.
    Cycle(f64),
    /// Full width of an interval.
    Width(f64),
    /// Step of an indication.
    Step(f64),
    /// Limits above and below.
    Uneven(f64, f64),
    /// Standard deviation of n readings, mean of m reported.
    Scatter(f64, u32, u32),
    /// Standard deviation pooled from series of n readings, mean of m reported: s, series, n, m.
    Pooled(f64, u32, u32, u32),
    /// Range of n readings, mean of m reported.
    Spread(f64, u32, u32),
    /// n equal readings, and the step of their indication.
    Alike(f64, u32),
    /// Limits in percent of the estimate.
    OfReading(f64),
    /// Limits in percent of this full scale.
    OfScale(f64, f64),
}

/// C(n) for n = 2 … 9 with the degrees of freedom (JJF 1059.1-2012, 4.3.2.3).
pub(super) const RANGE: [(f64, f64); 8] = [
    (1.13, 0.9),
    (1.69, 1.8),
    (2.06, 2.7),
    (2.33, 3.6),
    (2.53, 4.5),
    (2.70, 5.3),
    (2.85, 6.0),
    (2.97, 6.8),
];

/// How a laboratory gets from a figure to a standard uncertainty.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Step {
    /// The figure that it uses.
    pub used: f64,
    /// The divisor.
    pub divisor: Divisor,
    /// Degrees of freedom.
    pub nu: f64,
}

/// A divisor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Divisor {
    /// A root.
    Root(f64),
    /// A number.
    Number(f64),
}

impl Divisor {
    pub(super) fn value(self) -> f64 {
        match self {
            Divisor::Root(n) => libm::sqrt(n),
            Divisor::Number(n) => n,
        }
    }
}

impl Known {
    /// The right way (JCGM 100, 4.2 and 4.3), at an estimate.
    pub(super) fn right(self, estimate: f64) -> Step {
        let b = |used: f64, divisor| Step {
            used,
            divisor,
            nu: f64::INFINITY,
        };
        let (root, number) = (Divisor::Root, Divisor::Number);
        let mean = |used: f64, m: u32, nu: f64| Step {
            used,
            divisor: root(f64::from(m)),
            nu,
        };
        match self {
            Known::Certificate(expanded, k) => b(expanded, number(k)),
            Known::Limits(a) => b(a, root(3.0)),
            Known::Triangle(a) => b(a, root(6.0)),
            Known::Cycle(a) => b(a, root(2.0)),
            Known::Width(w) => b(w / 2.0, root(3.0)),
            Known::Step(q) | Known::Alike(q, _) => b(q / 2.0, root(3.0)),
            Known::Uneven(plus, minus) => b((plus + minus) / 2.0, root(3.0)),
            Known::Scatter(s, n, m) => mean(s, m, f64::from(n) - 1.0),
            Known::Pooled(s, series, n, m) => mean(s, m, f64::from(series) * (f64::from(n) - 1.0)),
            Known::Spread(r, n, m) => {
                let (c, nu) = RANGE[n as usize - 2];
                Step {
                    used: r,
                    divisor: number(c * libm::sqrt(f64::from(m))),
                    nu,
                }
            }
            Known::OfReading(p) => b(p / 100.0 * estimate.abs(), root(3.0)),
            Known::OfScale(p, scale) => b(p / 100.0 * scale, root(3.0)),
        }
    }

    /// Of the same kind, with about this standard uncertainty and two digits.
    pub(super) fn sized(self, u: f64, estimate: f64) -> Known {
        let ratio = u / (self.right(estimate).used / self.right(estimate).divisor.value());
        let two = |x: f64| plain(x * ratio, 2).parse().unwrap_or(x);
        match self {
            Known::Certificate(x, k) => Known::Certificate(two(x), k),
            Known::Limits(x) => Known::Limits(two(x)),
            Known::Triangle(x) => Known::Triangle(two(x)),
            Known::Cycle(x) => Known::Cycle(two(x)),
            Known::Width(x) => Known::Width(two(x)),
            Known::Step(x) => Known::Step(step(x * ratio)),
            Known::Alike(x, n) => Known::Alike(step(x * ratio), n),
            Known::Uneven(a, b) => Known::Uneven(two(a), two(b)),
            Known::Scatter(s, n, m) => Known::Scatter(two(s), n, m),
            Known::Pooled(s, series, n, m) => Known::Pooled(two(s), series, n, m),
            Known::Spread(r, n, m) => Known::Spread(two(r), n, m),
            Known::OfReading(p) => Known::OfReading(two(p)),
            Known::OfScale(p, scale) => Known::OfScale(two(p), scale),
        }
    }

    /// Whether it is evaluated from readings.
    pub(super) fn is_type_a(self) -> bool {
        matches!(
            self,
            Known::Scatter(..) | Known::Pooled(..) | Known::Spread(..) | Known::Alike(..)
        )
    }

    /// The figure of the ± column in a summary: what is stated.
    pub(super) fn figure(self) -> Option<f64> {
        match self {
            Known::Certificate(x, _)
            | Known::Limits(x)
            | Known::Triangle(x)
            | Known::Cycle(x)
            | Known::Width(x)
            | Known::Step(x)
            | Known::Scatter(x, ..)
            | Known::Pooled(x, ..)
            | Known::Spread(x, ..) => Some(x),
            Known::Alike(..) => Some(0.0),
            Known::Uneven(..) | Known::OfReading(_) | Known::OfScale(..) => None,
        }
    }

    /// Name of the distribution that belongs to it.
    pub(super) fn distribution(self) -> Said {
        match self {
            Known::Certificate(..) => Said("normal", "正态"),
            Known::Scatter(..) | Known::Pooled(..) | Known::Spread(..) => Said("normal", "正态"),
            Known::Triangle(_) => Said("triangular", "三角"),
            Known::Cycle(_) => Said("U-shaped", "反正弦"),
            _ => Said("rectangular", "均匀"),
        }
    }
}

/// The step 1, 2 or 5 next to a number.
fn step(x: f64) -> f64 {
    let ten = libm::floor(libm::log10(x));
    let lead = x / libm::exp10(ten);
    let nice = if lead < 1.5 {
        "1"
    } else if lead < 3.5 {
        "2"
    } else if lead < 7.5 {
        "5"
    } else {
        "10"
    };
    format!("{nice}e{ten}").parse().unwrap_or(x)
}
