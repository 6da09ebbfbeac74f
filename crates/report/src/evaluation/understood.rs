//! The budget as it was understood: heading, conventions, inputs and their components.

use serde_json::Value;

use super::matrix::matrix;
use crate::analyses;
use gumption_core::distribution::{Distribution, Parameter};
use gumption_core::quantity::Rounding;
use gumption_format::machine::record;
use gumption_format::machine::{Number, numbers};
use gumption_gum::budget::chain::TakenResult;
use gumption_gum::budget::{
    Analysis, Component, Constant, CoverageRule, DofRule, Evaluation as Kind, Group, Input, Law,
    OutputShape, Owner, TScale,
};

record! {
    /// Heading of the file.
    Heading<'a> {
        /// Title.
        title: &'a str,
        /// Measurement method or procedure.
        method: Option<&'a str>,
        /// What was measured.
        object: Option<&'a str>,
        /// Who wrote the budget.
        author: Option<&'a str>,
        /// Date of the measurement, ISO 8601.
        date: Option<&'a str>,
        /// Where the figures come from.
        reference: Option<&'a str>,
        /// Further words.
        note: Option<&'a str>,
    }

    /// Conventions after profile and overrides.
    Conventions<'a> {
        /// Profile.
        profile: &'a str,
        /// What the file changed in the profile.
        overrides: Vec<&'a str>,
        /// Coverage probability p.
        coverage_probability: Number,
        /// Where k comes from: output, t, normal, fixed.
        coverage_factor_from: &'a str,
        /// The fixed k.
        coverage_factor: Option<Number>,
        /// What k from the output takes for its distribution: convolution, dominant-alone.
        output_shape: &'a str,
        /// How effective degrees of freedom enter t: truncated, real.
        degrees_of_freedom: &'a str,
        /// Rounding of printed figures: half-even, half-up, up.
        rounding: &'a str,
        /// Significant digits of U in statements.
        digits: u64,
        /// Meaning of u for a t-distributed input in Monte Carlo: scale, standard-deviation.
        t_scale: &'a str,
    }

    /// An input quantity.
    InputJson<'a> {
        /// Name.
        name: &'a str,
        /// Description.
        description: Option<&'a str>,
        /// Group for subtotals.
        group: Option<&'a str>,
        /// Unit.
        unit: &'a str,
        /// Estimate.
        estimate: Number,
        /// Components that act on it.
        terms: Vec<TermJson>,
    }

    /// How a component enters an input.
    TermJson {
        /// Index into components.
        component: u64,
        /// Change of the input per unit of the component.
        coefficient: Number,
    }

    /// A zero-mean elementary component.
    ComponentJson<'a> {
        /// Unique name.
        name: &'a str,
        /// Name without its owner.
        label: &'a str,
        /// Input that has it; null for a shared source.
        input: Option<&'a str>,
        /// Shared source.
        shared_source: Option<&'a str>,
        /// Unit of the deviation.
        unit: &'a str,
        /// Distribution of the deviation.
        distribution: DistributionJson,
        /// Standard uncertainty as GUM propagates it.
        standard_uncertainty: Number,
        /// Degrees of freedom.
        degrees_of_freedom: Number,
        /// Type of evaluation: A, B.
        evaluation: &'a str,
        /// How the standard uncertainty was found.
        how: &'a str,
        /// Calibration certificate.
        certificate: Option<CertificateJson<'a>>,
        /// Other source.
        reference: Option<&'a str>,
    }

    /// A distribution.
    DistributionJson {
        /// Kind, as in budget files.
        name: String,
        /// Its parameters.
        parameters: Value,
    }

    /// A calibration certificate.
    CertificateJson<'a> {
        /// Number.
        number: Option<&'a str>,
        /// Laboratory.
        laboratory: Option<&'a str>,
        /// Date.
        date: Option<&'a str>,
        /// Due date.
        due: Option<&'a str>,
    }

    /// Correlated components.
    GroupJson {
        /// Indices into components.
        members: Vec<u64>,
        /// Correlation matrix.
        correlation: Vec<Vec<Number>>,
        /// Joint distribution in Monte Carlo: normal, t, gaussian-copula.
        law: String,
        /// Common degrees of freedom.
        degrees_of_freedom: Option<Number>,
    }

    /// An analysis of the readings behind a component.
    AnalysisJson<'a> {
        /// Name of the component, with which the names of its figures begin.
        component: &'a str,
        /// What it is: readings, anova, nested-anova, outlier-grubbs, outlier-dixon, outlier-4d, outlier-3s.
        kind: &'a str,
        /// What was done with the differences between groups, and between subgroups (included, negative, not-significant, ignored), or whether an outlier was found (outlier, none).
        verdicts: Vec<&'a str>,
    }

    /// A result of another file.
    TakenJson<'a> {
        /// Name that the model uses for it.
        name: &'a str,
        /// The file, as the budget names it.
        file: &'a str,
        /// Row of its series.
        row: Option<&'a str>,
        /// Its measurand.
        measurand: &'a str,
        /// Title of that file.
        title: &'a str,
        /// Defining statements there; null for a saved result, which is taken over in linear form.
        equation: Option<&'a str>,
    }

    /// An exactly known quantity.
    ConstantJson<'a> {
        /// Name.
        name: &'a str,
        /// Value, or the elements of a vector.
        values: Vec<Number>,
        /// Unit.
        unit: &'a str,
        /// Description.
        description: Option<&'a str>,
        /// Source.
        reference: Option<&'a str>,
    }
}

pub(super) fn heading(stated: &gumption_gum::budget::Heading) -> Heading<'_> {
    Heading {
        title: &stated.title,
        method: stated.method.as_deref(),
        object: stated.object.as_deref(),
        author: stated.author.as_deref(),
        date: stated.date.as_deref(),
        reference: stated.reference.as_deref(),
        note: stated.note.as_deref(),
    }
}

pub(super) fn conventions(c: &gumption_gum::budget::Conventions) -> Conventions<'_> {
    Conventions {
        profile: &c.profile,
        overrides: c.overrides.iter().map(String::as_str).collect(),
        coverage_probability: Number(c.coverage_probability),
        coverage_factor_from: match c.coverage_factor {
            CoverageRule::Output => "output",
            CoverageRule::StudentT => "t",
            CoverageRule::Normal => "normal",
            CoverageRule::Fixed(_) => "fixed",
        },
        coverage_factor: match c.coverage_factor {
            CoverageRule::Fixed(k) => Some(Number(k)),
            _ => None,
        },
        output_shape: match c.output_shape {
            OutputShape::Convolution => "convolution",
            OutputShape::DominantAlone => "dominant-alone",
        },
        degrees_of_freedom: match c.degrees_of_freedom {
            DofRule::Truncated => "truncated",
            DofRule::Real => "real",
        },
        rounding: match c.rounding {
            Rounding::HalfEven => "half-even",
            Rounding::HalfUp => "half-up",
            Rounding::Up => "up",
        },
        digits: u64::from(c.digits),
        t_scale: match c.t_scale {
            TScale::Scale => "scale",
            TScale::StandardDeviation => "standard-deviation",
        },
    }
}

pub(super) fn input(input: &Input) -> InputJson<'_> {
    InputJson {
        name: &input.name,
        description: input.description.as_deref(),
        group: input.group.as_deref(),
        unit: &input.unit.symbol,
        estimate: Number(input.estimate),
        terms: input
            .terms
            .iter()
            .map(|t| TermJson {
                component: t.component as u64,
                coefficient: Number(t.coefficient),
            })
            .collect(),
    }
}

pub(super) fn component<'a>(c: &'a Component, inputs: &'a [Input]) -> ComponentJson<'a> {
    ComponentJson {
        name: &c.name,
        label: &c.label,
        input: match &c.owner {
            Owner::Input(i) => inputs.get(*i).map(|i| i.name.as_str()),
            Owner::Source(_) => None,
        },
        shared_source: match &c.owner {
            Owner::Input(_) => None,
            Owner::Source(name) => Some(name),
        },
        unit: &c.unit.symbol,
        distribution: DistributionJson {
            name: c.distribution.kind().key.to_string(),
            parameters: parameters(&c.distribution),
        },
        standard_uncertainty: Number(c.u),
        degrees_of_freedom: Number(c.dof),
        evaluation: match c.evaluation {
            Kind::TypeA => "A",
            Kind::TypeB => "B",
        },
        how: &c.how,
        certificate: c.certificate.as_ref().map(|c| CertificateJson {
            number: c.number.as_deref(),
            laboratory: c.laboratory.as_deref(),
            date: c.date.as_deref(),
            due: c.due.as_deref(),
        }),
        reference: c.reference.as_deref(),
    }
}

fn parameters(distribution: &Distribution) -> Value {
    let named = distribution
        .parameters()
        .into_iter()
        .map(|(name, parameter)| {
            let value = match parameter {
                Parameter::Number(x) => serde_json::json!(Number(x)),
                Parameter::Numbers(list) => serde_json::json!(numbers(list)),
            };
            (name.to_string(), value)
        });
    named.collect::<serde_json::Map<_, _>>().into()
}

pub(super) fn group(group: &Group) -> GroupJson {
    let law = match group.law {
        Law::Normal => "normal",
        Law::StudentT { .. } => "t",
        Law::GaussianCopula { .. } => "gaussian-copula",
    };
    GroupJson {
        members: group.members.iter().map(|m| *m as u64).collect(),
        correlation: matrix(&group.correlation),
        law: law.to_string(),
        degrees_of_freedom: group.dof.map(Number),
    }
}

pub(super) fn analysis(analysis: &Analysis) -> AnalysisJson<'_> {
    let (kind, verdicts) = analyses::codes(&analysis.found);
    AnalysisJson {
        component: &analysis.name,
        kind,
        verdicts,
    }
}

pub(super) fn taken(taken: &TakenResult) -> TakenJson<'_> {
    TakenJson {
        name: &taken.input,
        file: &taken.file,
        row: taken.row.as_deref(),
        measurand: &taken.measurand,
        title: &taken.title,
        equation: taken.equation.as_deref(),
    }
}

pub(super) fn constant(constant: &Constant) -> ConstantJson<'_> {
    ConstantJson {
        name: &constant.name,
        values: numbers(&constant.values),
        unit: &constant.unit.symbol,
        description: constant.description.as_deref(),
        reference: constant.reference.as_deref(),
    }
}
