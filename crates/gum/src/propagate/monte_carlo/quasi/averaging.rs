//! What is averaged over in place of being drawn.
//!
//! Along a line E = t·d in the space of components, where t has a known distribution, a point of the others gives
//! a whole distribution of the measurand, if this is a polynomial of first or second degree in t. Four kinds of such
//! lines are known:
//!
//! | line | measurand |
//! |---|---|
//! | a sum of independent components and of groups of normal ones | affine in all of them together |
//! | one component | affine |
//! | a direction among normal components, correlated or not | of second degree in all of them together |
//! | one bounded component | of second degree |
//!
//! The one that makes up most of the measurand's variance is taken. In a sum the slopes must have a constant ratio,
//! as they have where the components are added; corrections that change it by less than a thousandth of the
//! sum's standard deviation are let pass (the slope of the whole sum is that at the point).

use gumption_lanes::sampler::normal_block;
use gumption_lanes::{Block, Generator, LANES, level};

use super::laws::{self, Law, Part};
use super::trial::{Trial, effects, inputs_of};
use crate::budget::{Budget, Group, Law as Joint};

/// The least part of u(y) that the line must make up.
pub(super) const LEAST_PART: f64 = 0.05;

/// Components with nonlinear neighbours that are tried as parts of a sum, or of a direction.
const MOST_TRIED: usize = 64;

/// The greatest change of the slope of one part against that of the sum, in standard deviations of the sum.
const CHANGE: f64 = 1e-3;

/// Components that make up less of a direction's standard deviation are left out of it.
const MINOR: f64 = 0.01;

/// What a second degree costs, as a part of the variance.
const BENT: f64 = 0.8;

/// The stream of random numbers that slopes are looked at with.
const LOOK: u64 = (1 << 49) - 1;

/// A line E = t·d that is averaged over.
pub(super) struct Averaged {
    /// Components, with their change per unit of t.
    pub(super) direction: Vec<(usize, f64)>,
    /// t as a linear function of the components' deviations, which are drawn and taken off their part along the line;
    /// `None` where the components are held at zero.
    pub(super) coordinate: Option<Vec<(usize, f64)>>,
    pub(super) law: Law,
    /// Whether the measurand is of second degree.
    pub(super) bent: bool,
    /// Slope of the measurand that a sum was made for.
    pub(super) slope: Option<f64>,
}

impl Averaged {
    /// Names of the components.
    pub(super) fn names(&self, budget: &Budget) -> Vec<String> {
        let names = self.direction.iter();
        names
            .map(|(component, _)| budget.components[*component].name.to_string())
            .collect()
    }

    /// Components that are not drawn.
    pub(super) fn held(&self) -> Vec<usize> {
        match self.coordinate {
            Some(_) => Vec::new(),
            None => self
                .direction
                .iter()
                .map(|(component, _)| *component)
                .collect(),
        }
    }
}

/// The line that makes up most of the variance, if any makes up enough.
pub(super) fn choose(budget: &Budget, seed: u64) -> Option<Averaged> {
    let survey = Survey::new(budget);
    let sum = survey.sum(seed);
    let direction = survey.direction();
    let alone = survey.alone(1, laws::averages);
    let square = survey.alone(2, |of| laws::squares(of) && !of.is_normal());
    let best = [
        (survey.variance_of_sum(&sum), Kind::Sum(sum)),
        (survey.variance_of(&alone), Kind::Alone(alone, false)),
        (
            BENT * survey.variance_along(&direction),
            Kind::Direction(direction),
        ),
        (
            BENT * survey.variance_of(&square),
            Kind::Alone(square, true),
        ),
    ]
    .into_iter()
    // The first of equals.
    .reduce(|best, next| if next.0 > best.0 { next } else { best })?;
    if best.0 <= LEAST_PART * LEAST_PART * survey.total {
        return None;
    }
    match best.1 {
        Kind::Sum(members) => survey.averaged_sum(&members),
        Kind::Alone(component, bent) => survey.averaged_alone(component?, bent),
        Kind::Direction(slopes) => survey.averaged_direction(&slopes),
    }
}

enum Kind {
    Sum(Vec<usize>),
    Alone(Option<usize>, bool),
    /// Components with their slopes.
    Direction(Vec<(usize, f64)>),
}

/// What is known of the components.
struct Survey<'b> {
    budget: &'b Budget,
    inputs: Vec<Vec<usize>>,
    /// Half of how far a standard uncertainty up and down moves the measurand.
    effects: Vec<f64>,
    /// Slopes of the measurand at the estimates.
    slopes: Vec<f64>,
    /// Standard deviations.
    sds: Vec<f64>,
    /// Whether every input that a component acts on takes part in no nonlinear operation.
    linear: Vec<bool>,
    /// The group of each component.
    group: Vec<Option<&'b Group>>,
    /// Sum of the squared effects.
    total: f64,
}

impl<'b> Survey<'b> {
    fn new(budget: &'b Budget) -> Survey<'b> {
        let components = budget.components.len();
        let x: Vec<f64> = budget.inputs.iter().map(|input| input.estimate).collect();
        let gradient = budget.model.gradients(&x);
        let bent = budget.model.nonlinear_inputs();
        let mut slopes = vec![0.0; components];
        let mut linear = vec![true; components];
        for (i, input) in budget.inputs.iter().enumerate() {
            for term in input.terms.iter().filter(|term| term.coefficient != 0.0) {
                slopes[term.component] += gradient[(0, i)] * term.coefficient;
                linear[term.component] &= !bent[i];
            }
        }
        let mut group = vec![None; components];
        for of in &budget.groups {
            of.members
                .iter()
                .for_each(|member| group[*member] = Some(of));
        }
        let effects: Vec<f64> = effects(budget)
            .into_iter()
            .map(|effect| 0.5 * effect)
            .collect();
        let sd = |of: &crate::budget::Component| of.distribution.standard_deviation();
        Survey {
            budget,
            inputs: inputs_of(budget),
            total: effects.iter().map(|effect| effect * effect).sum(),
            effects,
            slopes,
            sds: budget
                .components
                .iter()
                .map(|of| sd(of).unwrap_or(f64::INFINITY))
                .collect(),
            linear,
            group,
        }
    }

    fn distribution(&self, component: usize) -> &'b gumption_core::distribution::Distribution {
        &self.budget.components[component].distribution
    }

    /// Those that inputs use and that matter, by falling effect.
    fn by_effect(&self, keep: impl Fn(usize) -> bool) -> Vec<usize> {
        let all = 0..self.effects.len();
        let used = |component: &usize| !self.inputs[*component].is_empty() && keep(*component);
        let mut order: Vec<usize> = all.filter(used).collect();
        order.sort_by(|a, b| self.effects[*b].total_cmp(&self.effects[*a]));
        order
    }

    /// The degree of the measurand in some components together.
    fn degree(&self, components: &[usize]) -> Option<u8> {
        let inputs: Vec<usize> = components
            .iter()
            .flat_map(|c| &self.inputs[*c])
            .copied()
            .collect();
        self.budget.model.degree_in(&inputs)
    }

    /// Those of `more` that can join `some` without raising the degree in all of them above `most`.
    fn joined(&self, mut some: Vec<usize>, more: Vec<usize>, most: u8) -> Vec<usize> {
        for component in more.into_iter().take(MOST_TRIED) {
            some.push(component);
            if self.degree(&some).is_none_or(|degree| degree > most) {
                some.pop();
            }
        }
        some
    }

    /// Parts of a sum.
    fn sum(&self, seed: u64) -> Vec<usize> {
        let adds = |component: usize| match self.group[component] {
            Some(group) => {
                group.law == Joint::Normal && group.members.iter().all(|m| self.linear[*m])
            }
            None => laws::adds(self.distribution(component)),
        };
        let free = self.by_effect(|component| self.linear[component] && adds(component));
        let others = self.by_effect(|component| {
            let matters = self.effects[component].powi(2) > LEAST_PART * LEAST_PART * self.total;
            !self.linear[component] && self.group[component].is_none() && matters && adds(component)
        });
        let members = self.joined(free, others, 1);
        self.with_constant_ratios(members, seed)
    }

    /// Leaves out parts whose slopes change against the slope of the sum from point to point.
    fn with_constant_ratios(&self, mut members: Vec<usize>, seed: u64) -> Vec<usize> {
        if members.iter().all(|component| self.linear[*component]) {
            return members;
        }
        let mut trial = Trial::new(self.budget);
        for (component, (deviation, sd)) in trial.deviations.iter_mut().zip(&self.sds).enumerate() {
            if sd.is_finite() && !members.contains(&component) {
                let mut generator = Generator::new(seed, component as u64, LOOK);
                normal_block(level(), &mut generator, deviation);
                deviation.0.iter_mut().for_each(|z| *z *= sd);
            }
        }
        trial.move_all();
        let start = *trial.value();
        let deviation = self.variance_of_sum(&members).sqrt();
        members.retain(|component| {
            if self.linear[*component] {
                return true;
            }
            let sd = self.sds[*component];
            trial.deviations[*component] = Block([sd; LANES]);
            trial.move_some(&self.inputs[*component]);
            let moved = *trial.value();
            trial.deviations[*component] = Block::ZERO;
            trial.move_some(&self.inputs[*component]);
            let expected = sd * self.slopes[*component];
            let steps = moved
                .0
                .iter()
                .zip(&start.0)
                .map(|(moved, start)| moved - start);
            steps
                .map(|step| (step - expected).abs())
                .all(|change| change <= CHANGE * deviation)
        });
        members
    }

    /// The component with the greatest effect among those in which the measurand is of this degree at most.
    fn alone(
        &self,
        degree: u8,
        fits: impl Fn(&gumption_core::distribution::Distribution) -> bool,
    ) -> Option<usize> {
        let fits = |component: usize| {
            self.group[component].is_none() && fits(self.distribution(component))
        };
        let order = self.by_effect(fits).into_iter().take(MOST_TRIED);
        let of_degree = |component: &usize| self.degree(&[*component]).is_some_and(|d| d <= degree);
        order.into_iter().find(of_degree)
    }

    /// Normal components, with the slopes that their direction shall follow: those at the estimates or, where these
    /// are too small to tell, one component alone.
    fn direction(&self) -> Vec<(usize, f64)> {
        let normal = |component: usize| match self.group[component] {
            Some(group) => group.law == Joint::Normal,
            None => self.distribution(component).is_normal(),
        };
        let members = self.joined(Vec::new(), self.by_effect(normal), 2);
        let mut slopes = self.with_slopes(&members);
        let deviation = self.variance_along(&slopes).sqrt();
        slopes.retain(|(component, slope)| slope.abs() * self.sds[*component] > MINOR * deviation);
        let Some(first) = members.first() else {
            return slopes;
        };
        let alone = vec![(*first, self.effects[*first] / self.sds[*first])];
        if self.variance_along(&alone) > 2.0 * self.variance_along(&slopes) {
            alone
        } else {
            slopes
        }
    }

    /// Covariance of two components.
    fn covariance(&self, a: usize, b: usize) -> f64 {
        let place =
            |group: &Group, of: usize| group.members.iter().position(|member| *member == of);
        let correlation = match self.group[a] {
            _ if a == b => 1.0,
            Some(group) => match (place(group, a), place(group, b)) {
                (Some(i), Some(j)) => group.correlation[(i, j)],
                _ => 0.0,
            },
            None => 0.0,
        };
        correlation * self.sds[a] * self.sds[b]
    }

    /// Σ g for slopes g: the components' covariances with what the slopes make of them.
    fn moved(&self, slopes: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let related = |a: usize| match self.group[a] {
            Some(group) => group.members.clone(),
            None => vec![a],
        };
        let mut moved: Vec<(usize, f64)> = Vec::new();
        let mut place = vec![None; self.sds.len()];
        for (component, slope) in slopes {
            for other in related(*component) {
                let covariance = self.covariance(*component, other) * slope;
                match place[other] {
                    Some(at) => {
                        let of: &mut (usize, f64) = &mut moved[at];
                        of.1 += covariance;
                    }
                    None => {
                        place[other] = Some(moved.len());
                        moved.push((other, covariance));
                    }
                }
            }
        }
        moved
    }

    /// gᵀΣg.
    fn variance_along(&self, slopes: &[(usize, f64)]) -> f64 {
        let mut slope_of = vec![0.0; self.sds.len()];
        slopes
            .iter()
            .for_each(|(component, slope)| slope_of[*component] = *slope);
        self.moved(slopes)
            .iter()
            .map(|(component, moved)| slope_of[*component] * moved)
            .sum()
    }

    fn with_slopes(&self, members: &[usize]) -> Vec<(usize, f64)> {
        members
            .iter()
            .map(|component| (*component, self.slopes[*component]))
            .collect()
    }

    fn variance_of_sum(&self, members: &[usize]) -> f64 {
        self.variance_along(&self.with_slopes(members))
    }

    fn variance_of(&self, component: &Option<usize>) -> f64 {
        component.map_or(0.0, |component| self.effects[component].powi(2))
    }

    fn averaged_sum(&self, members: &[usize]) -> Option<Averaged> {
        let slopes = self.with_slopes(members);
        let deviation = self.variance_along(&slopes).sqrt();
        let alone = |(component, _): &&(usize, f64)| self.group[*component].is_none();
        let parts: Vec<Part> = slopes
            .iter()
            .filter(alone)
            .map(|(component, slope)| Part {
                distribution: self.distribution(*component),
                factor: slope / deviation,
            })
            .collect();
        let grouped: Vec<(usize, f64)> = slopes
            .iter()
            .filter(|member| !alone(member))
            .copied()
            .collect();
        let normal = self.variance_along(&grouped) / (deviation * deviation);
        Some(Averaged {
            direction: self.scaled(&self.moved(&slopes), 1.0 / deviation),
            coordinate: None,
            law: laws::sum(&parts, normal)?,
            bent: false,
            slope: (members.len() > 1).then_some(deviation),
        })
    }

    fn averaged_alone(&self, component: usize, bent: bool) -> Option<Averaged> {
        let sd = self.sds[component];
        Some(Averaged {
            direction: vec![(component, sd)],
            coordinate: None,
            law: laws::single(&self.distribution(component).scaled(1.0 / sd)?)?,
            bent,
            slope: None,
        })
    }

    fn averaged_direction(&self, slopes: &[(usize, f64)]) -> Option<Averaged> {
        let deviation = self.variance_along(slopes).sqrt();
        Some(Averaged {
            direction: self.scaled(&self.moved(slopes), 1.0 / deviation),
            coordinate: Some(self.scaled(slopes, 1.0 / deviation)),
            law: laws::normal(1.0),
            bent: true,
            slope: None,
        })
    }

    fn scaled(&self, of: &[(usize, f64)], factor: f64) -> Vec<(usize, f64)> {
        of.iter()
            .map(|(component, x)| (*component, x * factor))
            .collect()
    }
}
