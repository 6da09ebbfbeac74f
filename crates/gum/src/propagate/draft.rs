//! Budgets for the tests, built without a file.

use nalgebra::DMatrix;

use super::result::{Coverage, CoverageBasis, Freedom, Gum};
use crate::budget::{
    Budget, Component, Conventions, CoverageRule, Evaluation, Group, Heading, Input, Law,
    Measurand, MonteCarloSettings, Owner, PROFILES, Points, Term, Trials,
};
use gumption_core::distribution::{Distribution, Normal, Uniform};
use gumption_core::model::{MeasurandSource, Request, Role, Symbol, compile};
use gumption_core::quantity::{Unit, UnitTable};

/// A component of the first input, of dimension one.
pub(super) fn component(name: &str, distribution: Distribution, u: f64, dof: f64) -> Component {
    Component {
        name: name.into(),
        label: name.into(),
        owner: Owner::Input(0),
        unit: Unit::one(),
        distribution,
        u,
        dof,
        evaluation: Evaluation::TypeB,
        how: String::new().into(),
        certificate: None,
        reference: None,
    }
}

/// A result of the GUM with k = 2 and an interval y ± `half_width`.
pub(super) fn gum(estimate: f64, u: f64, half_width: f64) -> Gum {
    Gum {
        estimate,
        u,
        inputs: Vec::new(),
        components: Vec::new(),
        freedom: Freedom::Infinite,
        coverage: Coverage {
            k: 2.0,
            basis: CoverageBasis::Normal,
            probability: 0.95,
            expanded: 2.0 * u,
            half_width_for_p: half_width,
        },
    }
}

/// A budget of dimensionless inputs with one component each.
pub(super) struct Draft {
    names: Vec<String>,
    inputs: Vec<Input>,
    components: Vec<Component>,
    groups: Vec<Group>,
}

impl Draft {
    pub(super) fn new() -> Self {
        Draft {
            names: Vec::new(),
            inputs: Vec::new(),
            components: Vec::new(),
            groups: Vec::new(),
        }
    }

    pub(super) fn input(
        mut self,
        name: &str,
        estimate: f64,
        distribution: Distribution,
        u: f64,
        dof: f64,
    ) -> Self {
        let component = self.components.len();
        self.components.push(Component {
            owner: Owner::Input(self.inputs.len()),
            ..self::component(name, distribution, u, dof)
        });
        self.inputs.push(Input {
            name: name.into(),
            description: None,
            group: None,
            unit: Unit::one(),
            estimate,
            terms: vec![Term {
                component,
                coefficient: 1.0,
            }],
        });
        self.names.push(name.to_string());
        self
    }

    pub(super) fn normal(self, name: &str, estimate: f64, u: f64, dof: f64) -> Self {
        self.input(
            name,
            estimate,
            Distribution::Normal(Normal { mean: 0.0, sd: u }),
            u,
            dof,
        )
    }

    pub(super) fn rectangle(self, name: &str, estimate: f64, a: f64, dof: f64) -> Self {
        let distribution = Distribution::Uniform(Uniform {
            lower: -a,
            upper: a,
        });
        self.input(name, estimate, distribution, a / 3f64.sqrt(), dof)
    }

    pub(super) fn correlate(
        mut self,
        members: &[usize],
        entries: &[f64],
        dof: Option<f64>,
    ) -> Self {
        let n = members.len();
        let correlation = DMatrix::from_row_slice(n, n, entries);
        self.groups.push(Group {
            members: members.to_vec(),
            correlation: correlation.into(),
            law: Law::Normal,
            dof,
        });
        self
    }

    /// Adds the component of another input to an input (a shared source).
    pub(super) fn share(mut self, input: usize, other: usize, coefficient: f64) -> Self {
        let component = self.inputs[other].terms[0].component;
        self.inputs[input].terms.push(Term {
            component,
            coefficient,
        });
        self
    }

    pub(super) fn budget(self, p: f64, models: &[(&str, &str)]) -> Budget {
        let place = |(i, name): (usize, &String)| Symbol {
            name: name.as_str().into(),
            unit: Unit::one(),
            role: Role::Input(i),
        };
        let symbols: Vec<Symbol> = self.names.iter().enumerate().map(place).collect();
        let measurands: Vec<MeasurandSource<'_>> = models
            .iter()
            .map(|(name, model)| MeasurandSource {
                name,
                model: Some(model),
                unit: None,
            })
            .collect();
        let units = UnitTable::default();
        let request = Request {
            symbols: &symbols,
            shared: None,
            measurands: &measurands,
            units: &units,
        };
        Budget {
            heading: Heading::default(),
            conventions: Conventions {
                coverage_probability: p,
                output_probability: p,
                coverage_factor: CoverageRule::StudentT,
                ..PROFILES[0].conventions()
            },
            monte_carlo: MonteCarloSettings {
                points: Points::Random,
                indices: false,
                seed: 1,
                trials: Trials::Fixed(200_000),
            },
            model: compile(&request).unwrap_or_else(|faults| panic!("{faults:#?}")),
            inputs: self.inputs,
            constants: Vec::new(),
            measurands: models
                .iter()
                .map(|(name, _)| Measurand {
                    name: name.to_string(),
                    description: None,
                })
                .collect(),
            components: self.components,
            groups: self.groups,
            following: Vec::new(),
            conformity: Vec::new(),
            detection: Vec::new(),
            claims: Vec::new(),
            analyses: Vec::new(),
            fits: Vec::new(),
            figures: Vec::new(),
            remarks: Vec::new(),
            chain: Default::default(),
        }
    }
}
