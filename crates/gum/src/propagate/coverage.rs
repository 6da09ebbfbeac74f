//! The coverage factor k, the expanded uncertainty and the interval of the GUM.
//!
//! # Which distribution
//!
//! By clause G.4.1 k is t_p(ν_eff). That presumes an output that is close to normal; EA-4/02 (S9,
//! S10, S11) takes k from the output's own distribution where one or two contributions are so large that
//! all others together do not exceed 0.3 times them, or each of two outweighs them.
//! [`CoverageRule::Output`] follows, with the
//! convolution of the dominant contributions and a normal remainder ([`OutputShape::Convolution`]),
//! or with the dominant contributions alone, as the published figures of EA-4/02 have it
//! ([`OutputShape::DominantAlone`]). Degrees of freedom must not matter then (at least 50).
//!
//! # Degrees of freedom that are not integers
//!
//! Clause G.4.1 asks to interpolate or to truncate; H.1.6 truncates 16.7 to 16. [`DofRule::Truncated`]
//! rounds ν_eff to two decimals first, since u and ν are never known to more: the 18.9987 of the
//! example of G.4.1 stays 19 as published, the 16.98 of JCGM 101 9.5 becomes 16 as published.
//! [`DofRule::Real`] evaluates t at the real ν_eff, which is the interpolation done exactly.

use super::covariance::Covariance;
use super::gum::MeasurandForm;
use super::result::{Coverage, CoverageBasis};
use super::shape::Shape;
use crate::budget::{Component, Conventions, CoverageRule, OutputShape};
use gumption_core::distribution::{Distribution, rectangular};

/// The largest ratio of all others to the dominant contributions, EA-4/02 S9.10.
const REMAINDER: f64 = 0.3;

/// From here on degrees of freedom do not change k noticeably.
pub(super) const MANY: f64 = 50.0;

/// What k depends on.
pub(super) struct Situation<'b> {
    pub conventions: &'b Conventions,
    pub components: &'b [Component],
    pub covariance: &'b Covariance,
    pub of: &'b MeasurandForm,
    /// ν_eff.
    pub dof: f64,
}

/// k, U and the interval.
pub(super) fn evaluate(situation: &Situation<'_>) -> Coverage {
    let Situation {
        conventions, of, ..
    } = situation;
    let p = conventions.coverage_probability;
    let rule = conventions.coverage_factor;
    let output = situation.output(rule);
    let for_p = output.shape.half_width(p);
    let half_width = for_p * of.u;
    let stated = match output.basis {
        CoverageBasis::Output { .. } => conventions.output_probability,
        _ => p,
    };
    let k = match stated == p {
        true => for_p,
        false => output.shape.half_width(stated),
    };
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
        k,
        basis: output.basis,
        probability: stated,
        expanded: k * of.u,
        half_width_for_p: half_width,
    }
}

/// The distribution of the output divided by u(y) as far as it is known: that of the components that dominate with a
/// normal remainder, whatever the conventions take k from, or else t.
pub(super) fn best_shape<'b>(situation: &Situation<'b>) -> Shape<'b> {
    let dominated = situation.dominated(OutputShape::Convolution);
    dominated.map_or(Shape::student_t(situation.dof), |output| output.shape)
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
            CoverageRule::Output => self.dominated(self.conventions.output_shape),
            // A fixed k has its probability from the best description of the output.
            CoverageRule::Fixed(_) => self.dominated(OutputShape::Convolution),
        };
        wanted.unwrap_or_else(|| student_t(self.conventions.degrees_of_freedom.entered(self.dof)))
    }

    /// The output's distribution when one or two contributions dominate.
    fn dominated(&self, rule: OutputShape) -> Option<Output<'b>> {
        if self.dof < MANY || !(self.of.u > 0.0 && self.of.u.is_finite()) {
            return None;
        }
        let parts = self.largest();
        let &[first, ..] = parts.as_slice() else {
            return None;
        };
        let size = first.weight.abs();
        if !self.is_normal(first) && is_dominated_by(size) {
            return Some(self.one(first, rule));
        }
        let &[_, second] = parts.as_slice() else {
            return None;
        };
        let widths = self.half_width(first).zip(self.half_width(second))?;
        is_dominated_by_pair(first.weight.abs(), second.weight.abs())
            .then(|| self.two([first, second], widths, rule))
    }

    /// The two largest contributions that are not correlated with others, as parts of u(y).
    fn largest(&self) -> Vec<Part> {
        let mut parts: Vec<Part> = self
            .of
            .form
            .iter()
            .filter(|(component, _)| self.covariance.group(*component).is_none())
            .map(|&(component, weight)| Part {
                component,
                weight: weight / self.of.u,
            })
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
        matches!(
            distribution,
            Distribution::Normal(_) | Distribution::StudentT(_)
        )
    }

    /// Half-width of a rectangle, in units of u(y).
    fn half_width(&self, part: Part) -> Option<f64> {
        let rectangular = matches!(self.distribution(part), Distribution::Uniform(_));
        rectangular.then(|| part.weight.abs() * 3f64.sqrt())
    }

    fn one(&self, part: Part, rule: OutputShape) -> Output<'b> {
        let size = part.weight.abs();
        let (scale, remainder) = scale_and_remainder(size, rule);
        let distribution = self.distribution(part);
        let shape = match self.half_width(part) {
            Some(width) => Shape::Rectangles {
                a: width * scale,
                b: 0.0,
                remainder,
            },
            None => {
                let u = self.components[part.component].u;
                Shape::Dominant {
                    factor: part.weight * scale / u,
                    distribution,
                    remainder,
                }
            }
        };
        let dominant = vec![self.components[part.component].name.to_string()];
        Output {
            shape,
            basis: CoverageBasis::Output {
                dominant,
                shape: distribution.kind(),
            },
        }
    }

    fn two(&self, parts: [Part; 2], (a, b): (f64, f64), rule: OutputShape) -> Output<'b> {
        let together = libm::hypot(parts[0].weight, parts[1].weight);
        let (scale, remainder) = scale_and_remainder(together, rule);
        let shape = Shape::Rectangles {
            a: a * scale,
            b: b * scale,
            remainder,
        };
        let dominant = parts
            .iter()
            .map(|p| self.components[p.component].name.to_string())
            .collect();
        Output {
            shape,
            basis: CoverageBasis::Output {
                dominant,
                shape: rectangular::kind_of_sum(a, b),
            },
        }
    }
}

fn student_t<'b>(dof: f64) -> Output<'b> {
    let basis = if dof.is_infinite() {
        CoverageBasis::Normal
    } else {
        CoverageBasis::StudentT { dof }
    };
    Output {
        shape: Shape::student_t(dof),
        basis,
    }
}

/// Whether two contributions dominate: together as one does, or because each by itself outweighs all others
/// together. By the second, S11 has its trapezoid at a remainder of 0.34 of the pair, and the furnace of S5,
/// whose second largest is smaller than the rest, k = 2 at 0.36.
pub(super) fn is_dominated_by_pair(first: f64, second: f64) -> bool {
    let together = libm::hypot(first, second);
    is_dominated_by(together) || rest(together) <= second
}

/// Whether contributions that make up this part of u(y) leave little to all others.
pub(super) fn is_dominated_by(part: f64) -> bool {
    rest(part) <= REMAINDER * part
}

/// Standard uncertainty of all others, for contributions that make up `part` of u(y).
fn rest(part: f64) -> f64 {
    ((1.0 - part) * (1.0 + part)).max(0.0).sqrt()
}

/// By how much contributions that make up `part` of u(y) are stretched, and what is added to them:
/// without the remainder they stand for the whole of u(y).
fn scale_and_remainder(part: f64, rule: OutputShape) -> (f64, f64) {
    match rule {
        OutputShape::Convolution => (1.0, rest(part)),
        OutputShape::DominantAlone => (1.0 / part, 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::super::draft::component;
    use super::super::freedom;
    use super::*;
    use crate::budget::{DofRule, PROFILES};
    use gumption_core::distribution::{Normal, Uniform, Univariate, rectangular};

    const INF: f64 = f64::INFINITY;

    fn conventions(p: f64, rule: CoverageRule) -> Conventions {
        Conventions {
            coverage_probability: p,
            output_probability: p,
            coverage_factor: rule,
            ..PROFILES[0].conventions()
        }
    }

    fn normal(name: &str, u: f64, dof: f64) -> Component {
        component(
            name,
            Distribution::Normal(Normal { mean: 0.0, sd: u }),
            u,
            dof,
        )
    }

    fn rectangle(name: &str, a: f64) -> Component {
        let distribution = Distribution::Uniform(Uniform {
            lower: -a,
            upper: a,
        });
        component(name, distribution, a / 3f64.sqrt(), INF)
    }

    /// Coverage of the sum of components, each times `scale`.
    fn of_sum(components: &[Component], conventions: &Conventions, scale: f64) -> Coverage {
        let covariance = Covariance::new(components, &[]);
        let form = covariance.form((0..components.len()).map(|i| (i, scale)));
        let standard = covariance.dense(&form);
        let u = covariance.uncertainty(&form);
        let freedom = freedom::effective(&covariance, &form);
        let of = MeasurandForm { form, standard, u };
        let situation = Situation {
            conventions,
            components,
            covariance: &covariance,
            of: &of,
            dof: freedom.dof,
        };
        evaluate(&situation)
    }

    fn close(a: f64, b: f64, tolerance: f64) {
        assert!((a - b).abs() <= tolerance, "{a} is not {b}");
    }

    #[test]
    fn gum_h_1_6_and_g_4_1() {
        let gauge = [
            normal("ls", 25.0, 18.0),
            normal("d", 9.7, 25.6),
            normal("dalpha", 2.9, 50.0),
            normal("dtheta", 16.6, 2.0),
        ];
        let found = of_sum(&gauge, &conventions(0.99, CoverageRule::Output), 1.0);
        assert_eq!(found.basis, CoverageBasis::StudentT { dof: 16.0 });
        close(found.k, 2.92, 0.005);
        close(found.expanded, 93.0, 0.5);
        let product = [
            normal("1", 0.25, 9.0),
            normal("2", 0.57, 4.0),
            normal("3", 0.82, 14.0),
        ];
        let found = of_sum(&product, &conventions(0.95, CoverageRule::Output), 1.0);
        assert_eq!(found.basis, CoverageBasis::StudentT { dof: 19.0 });
        close(found.k, 2.09, 0.005);
    }

    #[test]
    fn truncation_follows_rounding_to_two_decimals() {
        assert_eq!(DofRule::Truncated.entered(18.9987), 19.0);
        assert_eq!(DofRule::Truncated.entered(16.98), 16.0);
        assert_eq!(DofRule::Truncated.entered(1.7), 1.0);
        assert_eq!(DofRule::Truncated.entered(0.6), 0.6);
        assert_eq!(DofRule::Truncated.entered(INF), INF);
        assert_eq!(DofRule::Real.entered(16.94), 16.94);
    }

    #[test]
    fn ea_4_02_s9() {
        // Hand-held multimeter: published u = 0.030 V, k = 1.65, U = 0.05 V.
        let budget = [
            rectangle("dViX", 0.05),
            rectangle("dVS", 0.011),
            normal("VS", 0.001, INF),
        ];
        let mut conventions = conventions(0.95, CoverageRule::Output);
        conventions.output_shape = OutputShape::DominantAlone;
        let found = of_sum(&budget, &conventions, 1.0);
        close(found.k, 1.65, 0.005);
        close(found.expanded, 0.05, 0.005);
        let dominant = vec!["dViX".to_string()];
        assert_eq!(
            found.basis,
            CoverageBasis::Output {
                dominant,
                shape: &Uniform::KIND
            }
        );
        // With its remainder the same budget needs a little more.
        conventions.output_shape = OutputShape::Convolution;
        close(of_sum(&budget, &conventions, 1.0).k, 1.69, 0.01);
    }

    #[test]
    fn ea_4_02_s10() {
        // Vernier caliper: resolution 25 µm and mechanical effects 50 µm dominate, k = 1.83.
        let budget = [
            normal("lS", 0.46, INF),
            rectangle("lix", 25.0),
            rectangle("lM", 50.0),
            normal("t", 0.58, INF),
        ];
        for output_shape in [OutputShape::Convolution, OutputShape::DominantAlone] {
            let rule = Conventions {
                output_shape,
                ..conventions(0.95, CoverageRule::Output)
            };
            let found = of_sum(&budget, &rule, -1.0);
            close(found.k, 1.83, 0.005);
            let dominant = vec!["lM".to_string(), "lix".to_string()];
            assert_eq!(
                found.basis,
                CoverageBasis::Output {
                    dominant,
                    shape: rectangular::kind_of_sum(2.0, 1.0)
                }
            );
        }
    }

    #[test]
    fn ea_4_02_s11() {
        // Block calibrator: axial and radial differences of temperature, each more than all others together.
        let budget = [
            normal("t_S", 15.0, INF),
            normal("dt_S", 10.0, INF),
            rectangle("dt_D", 40.0),
            rectangle("dt_iX", 50.0),
            rectangle("dt_R", 100.0),
            rectangle("dt_A", 250.0),
            rectangle("dt_H", 50.0),
            rectangle("dt_V", 30.0),
        ];
        let rule = Conventions {
            output_shape: OutputShape::DominantAlone,
            ..conventions(0.95, CoverageRule::Output)
        };
        let found = of_sum(&budget, &rule, 1.0);
        // A trapezoid of edge parameter β = 15/35: k = (1 − √(0.05 (1 − β²)))/√((1 + β²)/6).
        let beta: f64 = 15.0 / 35.0;
        let k = (1.0 - (0.05 * (1.0 - beta * beta)).sqrt()) / ((1.0 + beta * beta) / 6.0).sqrt();
        close(found.k, k, 1e-6);
        let dominant = vec!["dt_A".to_string(), "dt_R".to_string()];
        assert!(
            matches!(found.basis, CoverageBasis::Output { dominant: named, .. } if named == dominant)
        );
    }

    #[test]
    fn a_pair_whose_second_is_smaller_than_the_rest_does_not_dominate() {
        // The furnace of EA-4/02 S5 in contributions to t_X, mK.
        let budget = [
            normal("t_S", 100.0, INF),
            normal("dV_1", 77.0, INF),
            rectangle("dV_R", 154.0),
            normal("dt_S", 150.0, INF),
            rectangle("dt_D", 300.0),
            rectangle("dt_F", 1000.0),
        ];
        let found = of_sum(&budget, &conventions(0.9545, CoverageRule::Output), 1.0);
        assert_eq!(found.basis, CoverageBasis::Normal);
    }

    #[test]
    fn nothing_dominates() {
        let four: Vec<Component> = (0..4).map(|i| rectangle(&i.to_string(), 1.0)).collect();
        let found = of_sum(&four, &conventions(0.95, CoverageRule::Output), 1.0);
        assert_eq!(found.basis, CoverageBasis::Normal);
        close(found.k, 1.959964, 1e-6);
    }

    #[test]
    fn a_dominant_component_with_few_degrees_of_freedom_means_t() {
        let mut rough = rectangle("a", 1.0);
        rough.dof = 8.0;
        let found = of_sum(&[rough], &conventions(0.95, CoverageRule::Output), 1.0);
        assert_eq!(found.basis, CoverageBasis::StudentT { dof: 8.0 });
    }

    #[test]
    fn a_fixed_factor_has_the_probability_of_the_output() {
        let p = |components: &[Component]| {
            of_sum(
                components,
                &conventions(0.95, CoverageRule::Fixed(2.0)),
                1.0,
            )
        };
        let found = p(&[normal("a", 1.0, INF)]);
        close(found.probability, 0.9545, 1e-4);
        close(found.half_width_for_p, 1.959964, 1e-6);
        assert_eq!((found.k, found.expanded), (2.0, 2.0));
        // k = 2 with few degrees of freedom: ν = 3 covers 86.1 %, 10 covers 92.7 %.
        close(p(&[normal("a", 1.0, 3.0)]).probability, 0.861, 5e-4);
        close(p(&[normal("a", 1.0, 10.0)]).probability, 0.927, 5e-4);
        // A rectangle is wholly inside.
        close(p(&[rectangle("a", 1.0)]).probability, 1.0, 1e-12);
    }

    #[test]
    fn the_unit_changes_nothing() {
        let budget = [
            rectangle("a", 0.05),
            rectangle("b", 0.011),
            normal("c", 0.001, INF),
        ];
        let conventions = conventions(0.95, CoverageRule::Output);
        let expected = of_sum(&budget, &conventions, 1.0);
        for scale in [1e-27, -1e-3, 1e10] {
            let found = of_sum(&budget, &conventions, scale);
            close(found.k, expected.k, 1e-9);
            close(found.expanded / expected.expanded / scale.abs(), 1.0, 1e-9);
        }
    }

    #[test]
    fn an_exact_output_has_no_interval() {
        let found = of_sum(&[], &conventions(0.95, CoverageRule::Output), 1.0);
        assert_eq!(found.expanded, 0.0);
        assert_eq!(found.basis, CoverageBasis::Normal);
    }
}
