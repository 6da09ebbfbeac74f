//! The coverage factor k, the expanded uncertainty and the interval of the GUM.
//!
//! # Which distribution
//!
//! By clause G.4.1 k is t_p(ν_eff). That presumes an output that is close to normal; EA-4/02 (S9,
//! S10) takes k from the output's own distribution where one or two contributions are so large that
//! all others together do not exceed 0.3 times them. [`CoverageRule::Output`] follows, with the
//! convolution of the dominant contributions and a normal remainder; [`CoverageRule::Dominant`]
//! takes the dominant contributions alone, as the published figures of EA-4/02 do. Both need
//! degrees of freedom that do not matter (at least 50).
//!
//! # Degrees of freedom that are not integers
//!
//! Clause G.4.1 asks to interpolate or to truncate; H.1.6 truncates 16.7 to 16. [`DofRule::Truncated`]
//! cuts what is printed, ν_eff to one decimal: 18.998 is printed 19.0 and stays 19, as in the example
//! of G.4.1. [`DofRule::Real`] evaluates t at the real ν_eff, which is the interpolation done exactly.

use super::covariance::Covariance;
use super::freedom::Effective;
use super::gum::MeasurandForm;
use super::shape::Shape;
use super::{Coverage, CoverageBasis};
use crate::budget::{Component, Conventions, CoverageRule, DofRule};
use crate::distribution::Distribution;

/// The largest ratio of all others to the dominant contributions, EA-4/02 S9.10.
const REMAINDER: f64 = 0.3;

/// From here on degrees of freedom do not change k noticeably.
const MANY: f64 = 50.0;

/// What k depends on.
pub(super) struct Situation<'b> {
    pub conventions: &'b Conventions,
    pub components: &'b [Component],
    pub covariance: &'b Covariance,
    pub of: &'b MeasurandForm,
    pub freedom: &'b Effective,
}

/// k, U and the interval.
pub(super) fn evaluate(situation: &Situation<'_>) -> Coverage {
    let Situation { conventions, of, .. } = situation;
    let p = conventions.coverage_probability;
    let rule = conventions.coverage_factor;
    let output = situation.output(rule);
    let half_width = output.shape.half_width(p) * of.u;
    if let CoverageRule::Fixed(k) = rule {
        return Coverage {
            k,
            basis: CoverageBasis::Fixed,
            probability: output.shape.coverage(k),
            expanded: k * of.u,
            half_width_for_p: half_width,
        };
    }
    Coverage {
        k: output.shape.half_width(p),
        basis: output.basis,
        probability: p,
        expanded: half_width,
        half_width_for_p: half_width,
    }
}

/// ν by which t is entered.
pub(super) fn entered_dof(rule: DofRule, dof: f64) -> f64 {
    match rule {
        DofRule::Truncated if (1.0..1e9).contains(&dof) => ((10.0 * dof).round() / 10.0).floor(),
        _ => dof,
    }
}

/// The distribution of the output divided by u(y), and its name.
struct Output<'b> {
    shape: Shape<'b>,
    basis: CoverageBasis,
}

/// A contribution that stands alone: component and its share of u(y), with sign.
#[derive(Clone, Copy)]
struct Part {
    component: usize,
    weight: f64,
}

impl<'b> Situation<'b> {
    fn output(&self, rule: CoverageRule) -> Output<'b> {
        let wanted = match rule {
            CoverageRule::Normal => return student_t(f64::INFINITY),
            CoverageRule::StudentT => None,
            CoverageRule::Output | CoverageRule::Fixed(_) => self.dominated(true),
            CoverageRule::Dominant => self.dominated(false),
        };
        wanted.unwrap_or_else(|| {
            student_t(entered_dof(self.conventions.degrees_of_freedom, self.freedom.dof))
        })
    }

    /// The output's distribution when one or two contributions dominate.
    fn dominated(&self, with_remainder: bool) -> Option<Output<'b>> {
        if self.freedom.dof < MANY || !(self.of.u > 0.0 && self.of.u.is_finite()) {
            return None;
        }
        let parts = self.largest();
        let &[first, ..] = parts.as_slice() else { return None };
        let size = first.weight.abs();
        if !self.is_normal(first) && rest(size) <= REMAINDER * size {
            return Some(self.one(first, with_remainder));
        }
        let &[_, second] = parts.as_slice() else { return None };
        let together = size.hypot(second.weight);
        let rectangles = self.half_width(first).zip(self.half_width(second));
        match rectangles {
            Some(widths) if rest(together) <= REMAINDER * together => {
                Some(self.two([first, second], widths, with_remainder))
            }
            _ => None,
        }
    }

    /// The two largest contributions that are not correlated with others, as parts of u(y).
    fn largest(&self) -> Vec<Part> {
        let mut parts: Vec<Part> = self
            .of
            .form
            .iter()
            .filter(|(component, _)| self.covariance.group(*component).is_none())
            .map(|&(component, weight)| Part { component, weight: weight / self.of.u })
            .collect();
        parts.sort_by(|a, b| b.weight.abs().total_cmp(&a.weight.abs()));
        parts.truncate(2);
        parts
    }

    fn distribution(&self, part: Part) -> &'b Distribution {
        &self.components[part.component].distribution
    }

    fn is_normal(&self, part: Part) -> bool {
        let distribution = self.distribution(part);
        matches!(distribution, Distribution::Normal { .. } | Distribution::StudentT { .. })
    }

    /// Half-width of a rectangle, in units of u(y).
    fn half_width(&self, part: Part) -> Option<f64> {
        let rectangular = matches!(self.distribution(part), Distribution::Uniform { .. });
        rectangular.then(|| part.weight.abs() * 3f64.sqrt())
    }

    fn one(&self, part: Part, with_remainder: bool) -> Output<'b> {
        let size = part.weight.abs();
        // Without the remainder the dominant contribution stands for the whole of u(y).
        let (scale, remainder) = if with_remainder { (1.0, rest(size)) } else { (1.0 / size, 0.0) };
        let distribution = self.distribution(part);
        let shape = match self.half_width(part) {
            Some(width) => Shape::Rectangles { a: width * scale, b: 0.0, remainder },
            None => {
                let u = self.components[part.component].u;
                Shape::Dominant { factor: part.weight * scale / u, distribution, remainder }
            }
        };
        let dominant = vec![self.components[part.component].name.clone()];
        Output { shape, basis: CoverageBasis::Output { dominant, shape: word(distribution) } }
    }

    fn two(&self, parts: [Part; 2], (a, b): (f64, f64), with_remainder: bool) -> Output<'b> {
        let together = parts[0].weight.hypot(parts[1].weight);
        let (scale, remainder) =
            if with_remainder { (1.0, rest(together)) } else { (1.0 / together, 0.0) };
        let shape = Shape::Rectangles { a: a * scale, b: b * scale, remainder };
        let dominant = parts.iter().map(|p| self.components[p.component].name.clone()).collect();
        let word = if (a - b).abs() <= 1e-9 * a { "triangular" } else { "trapezoidal" };
        Output { shape, basis: CoverageBasis::Output { dominant, shape: word } }
    }
}

fn student_t<'b>(dof: f64) -> Output<'b> {
    let basis =
        if dof.is_infinite() { CoverageBasis::Normal } else { CoverageBasis::StudentT { dof } };
    Output { shape: Shape::StudentT { scale: 1.0, dof }, basis }
}

/// Standard uncertainty of all others, for contributions that make up `part` of u(y).
fn rest(part: f64) -> f64 {
    ((1.0 - part) * (1.0 + part)).max(0.0).sqrt()
}

/// The name of a distribution in a sentence.
fn word(distribution: &Distribution) -> &'static str {
    match distribution {
        Distribution::Normal { .. } => "normal",
        Distribution::StudentT { .. } => "t",
        Distribution::Uniform { .. } => "rectangular",
        Distribution::Triangular { .. } => "triangular",
        Distribution::Trapezoidal { .. } => "trapezoidal",
        Distribution::CurvilinearTrapezoid { .. } => "curvilinear trapezoidal",
        Distribution::Arcsine { .. } => "arcsine",
        Distribution::Exponential { .. } => "exponential",
        Distribution::Gamma { .. } => "gamma",
        Distribution::LogNormal { .. } => "lognormal",
        Distribution::Beta { .. } => "beta",
        Distribution::Discrete { .. } => "discrete",
        Distribution::Empirical { .. } => "empirical",
    }
}
