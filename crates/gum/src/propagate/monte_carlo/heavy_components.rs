//! Components of few degrees of freedom that leave an output without moments.
//!
//! A t distribution has moments of order below ν only: no standard deviation for ν ≤ 2, no mean for ν ≤ 1 (JCGM 101
//! 6.4.9.4). An output that grows like the power p of such a component has them of order below ν/p only, however small
//! the component's part of u is; the trials would not show it as long as it is small. How the output grows is asked of
//! the model, out to where the trials reach: a product or a quotient follows the component there in proportion, an
//! arctangent no longer does.

use crate::budget::{Budget, Component, Group, Law};
use crate::propagate::result::MissingMoments;
use gumption_core::distribution::{Distribution, StudentT};
use gumption_core::special::student_t_two_sided_quantile;

/// The highest moment that is reported: the kurtosis is of order four.
const HIGHEST: f64 = 4.0;

/// Powers are found from differences of doubles.
const ROUNDING: f64 = 0.01;

/// Differences below this part of a value are rounding.
const RESOLVED: f64 = 1e-12;

/// So many components with the fewest degrees of freedom are followed through a nonlinear model, which has to be
/// evaluated for each; of the others the trials tell.
const MOST: usize = 100;

/// A t-distributed component that an output follows, with the power by which it does.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HeavyComponent {
    name: String,
    dof: f64,
    power: f64,
}

impl HeavyComponent {
    /// A component with so many degrees of freedom, and the power of it like which the output grows.
    pub(super) fn new(name: &str, dof: f64, power: f64) -> Self {
        HeavyComponent {
            name: name.into(),
            dof,
            power,
        }
    }

    /// Whether the output has a moment of this order.
    pub(super) fn leaves(&self, order: f64) -> bool {
        order * self.power < (1.0 - ROUNDING) * self.dof
    }

    /// Why there are no moments.
    pub(super) fn reason(&self) -> MissingMoments {
        MissingMoments::HeavyComponent {
            name: self.name.clone(),
            dof: self.dof,
            power: self.power,
        }
    }
}

/// For every output the component that leaves it the fewest moments, where it lacks one that is reported; the trials
/// reach as far as one of so many does.
pub(super) fn heavy_components(budget: &Budget, trials: u64) -> Vec<Option<HeavyComponent>> {
    let mut heaviest = vec![None; budget.model.outputs().len()];
    let mut rays = rays(&budget.components, &budget.groups, trials);
    if rays.is_empty() {
        return heaviest;
    }
    rays.sort_by(|a, b| a.dof.total_cmp(&b.dof));
    let terrain = Terrain::new(budget);
    let mut followed = 0;
    for ray in &rays {
        let steps = terrain.steps(ray);
        let straight = steps.iter().all(|(input, _)| !terrain.nonlinear[*input]);
        followed += usize::from(!straight);
        if !straight && followed > MOST {
            continue;
        }
        let powers = match straight {
            true => terrain.slopes(&steps),
            false => terrain.powers(&steps, ray.reach),
        };
        for (heaviest, power) in heaviest.iter_mut().zip(powers) {
            let name = &budget.components[ray.component].name;
            let found = HeavyComponent::new(name, ray.dof, power);
            let heavier =
                |known: &HeavyComponent| found.dof * known.power < known.dof * found.power;
            if !found.leaves(HIGHEST) && heaviest.as_ref().is_none_or(heavier) {
                *heaviest = Some(found);
            }
        }
    }
    heaviest
}

/// Where a t variable of few degrees of freedom moves the components.
struct Ray {
    component: usize,
    dof: f64,
    /// The largest of the trials.
    reach: f64,
    /// Changes of components per unit of the variable.
    moves: Vec<(usize, f64)>,
}

/// The t variables that lack a moment which is reported, alone or in groups.
fn rays(components: &[Component], groups: &[Group], trials: u64) -> Vec<Ray> {
    let ray = |component: usize, dof: f64, moves: Vec<(usize, f64)>| {
        (dof <= HIGHEST).then(|| Ray {
            component,
            dof,
            reach: student_t_two_sided_quantile(1.0 - 1.0 / trials.max(100) as f64, dof),
            moves,
        })
    };
    let mut joint = vec![false; components.len()];
    let mut rays = Vec::new();
    for group in groups {
        let (dof, scale) = match &group.law {
            Law::Normal => (f64::INFINITY, &Vec::new()),
            Law::StudentT { dof, scale } => (*dof, scale),
            // The members keep their own distributions.
            Law::GaussianCopula { .. } => continue,
        };
        for (place, &member) in group.members.iter().enumerate() {
            joint[member] = true;
            // A column of the correlation matrix is a direction in which the group can move as a whole.
            let moves = || {
                let all = group.members.iter().zip(scale).enumerate();
                all.map(|(other, (member, scale))| {
                    (*member, scale * group.correlation[(other, place)])
                })
                .collect()
            };
            rays.extend(
                (dof <= HIGHEST)
                    .then(moves)
                    .and_then(|moves| ray(member, dof, moves)),
            );
        }
    }
    for (place, component) in components.iter().enumerate() {
        if let (false, Distribution::StudentT(StudentT { dof, scale, .. })) =
            (joint[place], &component.distribution)
        {
            rays.extend(ray(place, *dof, vec![(place, *scale)]));
        }
    }
    rays
}

/// The model around the estimates.
struct Terrain<'b> {
    budget: &'b Budget,
    /// The inputs that a component acts on, and how.
    acts_on: Vec<Vec<(usize, f64)>>,
    nonlinear: Vec<bool>,
    /// The estimates, and a point beside them where no factor happens to be zero.
    points: [Vec<f64>; 2],
}

impl<'b> Terrain<'b> {
    fn new(budget: &'b Budget) -> Self {
        let mut acts_on = vec![Vec::new(); budget.components.len()];
        let estimates: Vec<f64> = budget.inputs.iter().map(|input| input.estimate).collect();
        let mut beside = estimates.clone();
        for (place, input) in budget.inputs.iter().enumerate() {
            for term in &input.terms {
                acts_on[term.component].push((place, term.coefficient));
                // Multiples of the golden ratio fall nowhere in particular.
                let part = (term.component as f64 + 1.0) * 0.618_033_988_749_894_9 % 1.0;
                beside[place] += term.coefficient * budget.components[term.component].u * part;
            }
        }
        Terrain {
            budget,
            acts_on,
            nonlinear: budget.model.nonlinear_inputs(),
            points: [estimates, beside],
        }
    }

    /// Changes of inputs per unit of the variable.
    fn steps(&self, ray: &Ray) -> Vec<(usize, f64)> {
        let mut steps: Vec<(usize, f64)> = Vec::new();
        for (component, moved) in &ray.moves {
            for (input, coefficient) in &self.acts_on[*component] {
                match steps.iter_mut().find(|(known, _)| known == input) {
                    Some((_, step)) => *step += coefficient * moved,
                    None => steps.push((*input, coefficient * moved)),
                }
            }
        }
        steps
    }

    /// The power for each output where the inputs are in no nonlinear operation: one, or zero where it does not change.
    fn slopes(&self, steps: &[(usize, f64)]) -> Vec<f64> {
        let gradients = self.budget.model.gradients(&self.points[0]);
        let of = |output: usize| {
            let terms = steps
                .iter()
                .map(|(input, step)| gradients[(output, *input)] * step);
            let (slope, size) = terms.fold((0.0, 0.0), |(sum, size): (f64, f64), term| {
                (sum + term, size + term.abs())
            });
            f64::from(u8::from(slope.abs() > RESOLVED * size))
        };
        (0..gradients.nrows()).map(of).collect()
    }

    /// The power for each output, by following the model out to the reach of the trials.
    fn powers(&self, steps: &[(usize, f64)], reach: f64) -> Vec<f64> {
        let mut powers = vec![0.0_f64; self.budget.model.outputs().len()];
        for point in &self.points {
            let here = self.budget.model.values(point);
            for sign in [-1.0, 1.0] {
                let change = |distance: f64| {
                    let mut x = point.clone();
                    for (input, step) in steps {
                        x[*input] += sign * distance * step;
                    }
                    let there = self.budget.model.values(&x);
                    let pairs = there.iter().zip(&here);
                    pairs
                        .map(|(there, here)| ((there - here).abs(), RESOLVED * here.abs()))
                        .collect::<Vec<_>>()
                };
                let end = change(reach);
                let starts = [0.25, 0.5, 0.75].map(|part| libm::pow(reach, part));
                let starts = starts.map(|start| (start, change(start)));
                for (output, power) in powers.iter_mut().enumerate() {
                    let grown = |(start, change): &(f64, Vec<(f64, f64)>)| {
                        let ((from, rounding), (to, _)) = (change[output], end[output]);
                        let seen = to.is_finite() && from > rounding && from > 0.0;
                        seen.then(|| libm::log(to / from) / libm::log(reach / start))
                    };
                    // What oscillates is far out now and then; it grows from nowhere on.
                    let least = starts.iter().map(grown).reduce(|a, b| Some(a?.min(b?)));
                    *power = power.max(least.flatten().unwrap_or(0.0));
                }
            }
        }
        powers
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Heaviest component of a model of `a` and `c`, each with so many readings.
    fn of(model: &str, readings: [&str; 2]) -> Option<(String, f64, bool, bool)> {
        let [a, c] = readings;
        let text = format!("[measurand.y]\nmodel = \"{model}\"\n[input.a]\n{a}\n[input.c]\n{c}\n");
        let loaded = crate::budget::read(&text, "b.toml", std::path::Path::new(""));
        let budget = loaded.unwrap().rows.remove(0).budget;
        let found = heavy_components(&budget, 1_000_000).remove(0)?;
        Some((
            found.name.clone(),
            (found.power * 10.0).round() / 10.0,
            found.leaves(1.0),
            found.leaves(2.0),
        ))
    }

    const NORMAL: &str = "value = 5\nu = 0.1";
    const TWO: &str = "readings = [4.9, 5.0]";
    const THREE: &str = "readings = [4.999, 5.000, 5.001]";
    const FIVE: &str = "readings = [4.9, 4.95, 5.0, 5.05, 5.1]";

    #[test]
    fn proportional_whatever_the_operation() {
        for model in [
            "a + c",
            "a * c",
            "c / a",
            "a / c",
            "1e9 * a - 1e-3 * c",
            "a * c / (a + c)",
        ] {
            let (name, power, mean, deviation) = of(model, [NORMAL, THREE]).unwrap();
            assert_eq!(
                (power, mean, deviation),
                (1.0, true, false),
                "{model}: {name}"
            );
        }
        let (_, _, mean, _) = of("a + c", [NORMAL, TWO]).unwrap();
        assert!(!mean);
    }

    #[test]
    fn what_the_model_bounds_is_not_followed() {
        for model in [
            "a + atan(1e6 * (c - 5))",
            "a + sin(1e5 * c)",
            "a + 0 * c",
            "a + c - c",
        ] {
            assert_eq!(of(model, [NORMAL, THREE]), None, "{model}");
        }
    }

    #[test]
    fn powers_take_moments_from_more_degrees_of_freedom() {
        // t(4) has a variance and no kurtosis; its square, far out, has no variance.
        let (_, power, _, deviation) = of("a + c", [NORMAL, FIVE]).unwrap();
        assert_eq!((power, deviation), (1.0, true));
        let (_, power, mean, deviation) = of("a + (c - 5)^2", [NORMAL, FIVE]).unwrap();
        assert_eq!((power, mean, deviation), (2.0, true, false));
        assert_eq!(of("a + c", [NORMAL, NORMAL]), None);
    }

    #[test]
    fn the_heaviest_is_named() {
        let (name, ..) = of("a * c", [TWO, THREE]).unwrap();
        assert_eq!(name, "a");
    }

    #[test]
    fn joint_readings_move_together() {
        let text = |model: &str| {
            format!(
                "[measurand.y]\nmodel = \"{model}\"\n[input.a]\nreadings = [1, 2, 4, 3]\n[input.c]\nreadings = [11, 12, 14, 13]\n[[joint]]\ninputs = [\"a\", \"c\"]\n"
            )
        };
        let of = |model: &str| {
            let loaded = crate::budget::read(&text(model), "b.toml", std::path::Path::new(""));
            let budget = loaded.unwrap().rows.remove(0).budget;
            heavy_components(&budget, 1_000_000).remove(0)
        };
        let found = of("a * c").unwrap();
        // Both factors at once: between the first power near the estimates and the second far out.
        assert!(
            found.dof == 2.0 && (1.2..=2.0).contains(&found.power),
            "{found:?}"
        );
        // The readings differ by a constant, and so do the means.
        assert_eq!(of("c - a"), None);
    }
}
