//! A calibration and a plan for machines: exact numbers, stable names.

use nalgebra::DMatrix;
use serde_json::Value;

use crate::calibrate::{
    Alias, Calibration, Cause, Combination, Experiment, Figures, Identifiability, Misfit, Origin,
    Plan, ResponseScatter, Scatter, Scope, Words,
};
use crate::language::Language;
use crate::machine::{self, Machine, Number, record};

use super::causes::cause_name;
use super::sections::said;
use super::trouble::in_words;

record! {
    /// Coefficients from a recording and measurement equations.
    CalibrationForm<'a> {
        /// What a plan has as well.
        #[serde(flatten)]
        common: Common<'a>,
        /// `calibration`.
        kind: &'static str,
        /// Number of readings used.
        readings: usize,
        /// Readings left out, because a value is missing.
        left_out: usize,
        /// Pairs of points or labels whose readings look exchanged.
        swapped: Vec<[&'a str; 2]>,
        /// Coefficients with another sign than those like them.
        reversed: &'a [String],
        /// Points that stand apart from all others.
        apart: Vec<ApartForm<'a>>,
        /// Values at which readings stay that should differ.
        limits: Vec<LimitForm<'a>>,
        /// Whether the equations are linear in the parameters.
        linear: bool,
        /// Steps of the search; 0 for linear equations.
        iterations: usize,
        /// What tells the scatter of the readings: `residuals`, `dwells` or `stated`.
        scatter: &'static str,
        /// The scatter of each response.
        responses: Vec<ResponseForm<'a>>,
        /// What is left of each reading.
        residuals: Vec<ResidualForm<'a>>,
        /// Coefficients of parts of the recording, where the file wants them one by one.
        parts: Vec<PartForm<'a>>,
        /// What is doubtful in the recording.
        findings: Vec<FindingForm>,
    }

    /// What a schedule would tell, before anything is measured.
    PlanForm<'a> {
        /// What a calibration has as well.
        #[serde(flatten)]
        common: Common<'a>,
        /// `plan`.
        kind: &'static str,
        /// Number of readings.
        readings: usize,
        /// Parameters whose value is not stated and was taken as zero.
        assumed_zero: &'a [String],
    }

    /// What calibrations and plans have in common.
    Common<'a> {
        /// Title.
        title: &'a str,
        /// Procedure of the library.
        procedure: Option<&'a str>,
        /// Where the method comes from.
        reference: Option<&'a str>,
        /// What is calibrated.
        object: Option<&'a str>,
        /// Who did it.
        author: Option<&'a str>,
        /// When.
        date: Option<&'a str>,
        /// Measurement equations.
        equations: Vec<&'a str>,
        /// Probability of the coverage intervals.
        coverage_probability: Number,
        /// Parameters, then results; of a plan with the values that were assumed, and none where the schedule does not
        /// determine all of them.
        coefficients: Vec<CoefficientForm<'a>>,
        /// Covariance matrix of the coefficients.
        covariance: Vec<Vec<Number>>,
        /// Correlation matrix of the coefficients.
        correlation: Vec<Vec<Number>>,
        /// What the uncertainties come from.
        causes: Vec<CauseForm<'a>>,
        /// What the readings tell apart.
        identifiability: IdentifiabilityForm<'a>,
        /// Effects outside the equations.
        omitted: Vec<OmittedForm<'a>>,
    }

    /// A coefficient.
    CoefficientForm<'a> {
        /// As the equations call it.
        name: &'a str,
        /// What it is.
        description: Option<&'a str>,
        /// Unit of value, u and U.
        unit: &'a str,
        /// Estimate.
        value: Number,
        /// Standard uncertainty.
        u: Number,
        /// Effective degrees of freedom.
        dof: Number,
        /// Coverage factor.
        k: Number,
        /// Expanded uncertainty.
        #[serde(rename = "U")]
        expanded: Number,
        /// Probability that a coefficient that is zero comes out as far from it (two-sided t test).
        p_value: Number,
        /// Whether it differs from zero beyond chance (p < 0.05); null where no test says so.
        significant: Option<bool>,
    }

    /// A cause of doubt.
    CauseForm<'a> {
        /// What it is.
        name: String,
        /// `stated`, `residuals`, `samples` or `prior`.
        kind: &'static str,
        /// On which points one of its errors acts: `common`, `each` or `by COLUMN`.
        scope: String,
        /// How its standard uncertainty was found.
        how: &'a str,
        /// What it does to each coefficient.
        contributions: Vec<ContributionForm<'a>>,
    }

    /// What a cause does to a coefficient.
    ContributionForm<'a> {
        /// The coefficient.
        coefficient: &'a str,
        /// Part of its standard uncertainty.
        u: Number,
        /// Change by one standard uncertainty, with its sign, where the cause is one error.
        effect: Option<Number>,
        /// Share of the variance.
        share: Number,
        /// Degrees of freedom.
        dof: Number,
    }

    /// What the readings tell apart.
    IdentifiabilityForm<'a> {
        /// Number of independent combinations of parameters that they determine.
        rank: usize,
        /// Number of parameters.
        parameters: usize,
        /// Condition number of the scaled equations.
        condition: Number,
        /// Combinations that no reading shows.
        undetermined: Vec<UndeterminedForm<'a>>,
        /// Parameters that others imitate nearly.
        near: Vec<NearForm<'a>>,
    }

    /// A combination of parameters that changes no reading.
    UndeterminedForm<'a> {
        /// In words.
        words: String,
        /// Changes that cancel.
        changes: Vec<ChangeForm<'a>>,
    }

    /// A parameter that others imitate nearly.
    NearForm<'a> {
        /// The parameter.
        parameter: &'a str,
        /// By how much larger its standard uncertainty is than if the others were known.
        inflation: Number,
        /// Changes that nearly cancel.
        changes: Vec<ChangeForm<'a>>,
    }

    /// A change of a parameter.
    ChangeForm<'a> {
        /// The parameter.
        parameter: &'a str,
        /// The change.
        change: Number,
        /// Its unit.
        unit: &'a str,
    }

    /// An effect outside the equations.
    OmittedForm<'a> {
        /// Its name.
        name: &'a str,
        /// What it would add to an equation.
        term: &'a str,
        /// Its unit.
        unit: &'a str,
        /// What it is.
        description: Option<&'a str>,
        /// Its usual size.
        typical: Option<Number>,
        /// Whether it acts on any reading.
        acts: bool,
        /// Share of it that the residuals would show.
        visible: Number,
        /// What it does to each coefficient.
        shifts: Vec<ShiftForm<'a>>,
    }

    /// What an omitted effect does to a coefficient.
    ShiftForm<'a> {
        /// The coefficient.
        coefficient: &'a str,
        /// Change for each unit of the effect.
        per_unit: Number,
        /// Unit of the coefficient.
        unit: &'a str,
    }

    /// A point that stands apart.
    ApartForm<'a> {
        /// The response.
        response: &'a str,
        /// The point.
        point: &'a str,
        /// Its residual over the standard deviation that those of the others give it.
        t: Number,
        /// Probability that the largest residual is as far out.
        p_value: Number,
    }

    /// A value at which readings stay.
    LimitForm<'a> {
        /// The response.
        response: &'a str,
        /// The value.
        value: Number,
        /// Where it is read.
        points: Vec<&'a str>,
    }

    /// The scatter of a response.
    ResponseForm<'a> {
        /// The response.
        name: &'a str,
        /// Its unit.
        unit: &'a str,
        /// Number of readings.
        readings: usize,
        /// Root mean square of the residuals.
        rms: Number,
        /// Standard deviation of a reading, or of one of unit weight.
        s: Number,
        /// Its degrees of freedom.
        dof: Number,
        /// The residuals against the known errors of the readings, where these are known.
        test: Option<TestForm>,
    }

    /// Whether residuals are as large as the known errors let expect.
    TestForm {
        /// Residual standard deviation to expect.
        expected: Number,
        /// Σ(r/u)².
        chi_squared: Number,
        /// Degrees of freedom.
        dof: Number,
        /// Probability of a larger χ².
        p_value: Number,
        /// `between dwells` where something changes from dwell to dwell, `larger` or `smaller` than the errors let
        /// expect; null where neither.
        misfit: Option<&'static str>,
    }

    /// What is left of a reading.
    ResidualForm<'a> {
        /// The point.
        point: &'a str,
        /// The response.
        response: &'a str,
        /// What was read.
        observed: Number,
        /// What the equation gives.
        fitted: Number,
        /// Their difference.
        residual: Number,
        /// The difference over its standard deviation.
        standardised: Number,
    }

    /// A part of the recording.
    PartForm<'a> {
        /// Its label.
        label: &'a str,
        /// Its coefficients.
        coefficients: Vec<CoefficientForm<'a>>,
    }

    /// Something doubtful in the recording.
    FindingForm {
        /// What.
        message: String,
        /// What to do.
        advice: String,
        /// Line of the file; 0 for the whole.
        line: usize,
        /// How often.
        count: usize,
    }
}

impl Machine for CalibrationForm<'_> {
    const KIND: &'static str = "calibration";
    const VERSION: u32 = 1;
}

impl Machine for PlanForm<'_> {
    const KIND: &'static str = "calibration-plan";
    const VERSION: u32 = 1;
}

/// JSON Schema of the output of `gumption calibrate --json`.
pub fn calibration_schema() -> Value {
    machine::schema::<CalibrationForm<'_>>("gumption calibrate --json")
}

/// JSON Schema of the output of `gumption plan --json` for a calibration.
pub fn plan_schema() -> Value {
    machine::schema::<PlanForm<'_>>("gumption plan --json")
}

/// The machine form of a calibration.
pub(super) fn calibration<'a>(
    experiment: &'a Experiment,
    found: &'a Calibration,
    l: Language,
) -> CalibrationForm<'a> {
    let figures = Some(&found.figures);
    let points = |points: &'a [Words]| points.iter().map(|point| said(point, l)).collect();
    let units = experiment.equations.responses().iter();
    let units = units.map(|quantity| quantity.unit.symbol.as_str());
    CalibrationForm {
        common: common(
            experiment,
            figures,
            &found.identifiability,
            &found.aliases,
            l,
        ),
        kind: "calibration",
        readings: found.readings,
        left_out: found.left_out,
        swapped: found
            .swapped
            .iter()
            .map(|[a, b]| [said(a, l), said(b, l)])
            .collect(),
        reversed: &found.reversed,
        apart: all(&found.apart, |one| ApartForm {
            response: &one.response,
            point: said(&one.point, l),
            t: Number(one.t),
            p_value: Number(one.p_value),
        }),
        limits: all(&found.limits, |limit| LimitForm {
            response: &limit.response,
            value: Number(limit.value),
            points: points(&limit.points),
        }),
        linear: found.linear,
        iterations: found.iterations,
        scatter: match found.scatter {
            Scatter::Residuals => "residuals",
            Scatter::Dwells => "dwells",
            Scatter::Stated => "stated",
        },
        responses: found
            .responses
            .iter()
            .zip(units)
            .map(|(one, unit)| response(one, unit))
            .collect(),
        residuals: all(&found.residuals, |one| ResidualForm {
            point: said(&one.point, l),
            response: &one.response,
            observed: Number(one.observed),
            fitted: Number(one.fitted),
            residual: Number(one.observed - one.fitted),
            standardised: Number(one.standardised),
        }),
        parts: all(&found.parts, |(label, part)| PartForm {
            label,
            coefficients: coefficients(&part.figures, l),
        }),
        findings: all(&experiment.points.findings, |finding| FindingForm {
            message: l.pick(finding.message(), finding.message_zh()),
            advice: l.pick(finding.advice(), finding.advice_zh()).into(),
            line: finding.line,
            count: finding.count,
        }),
    }
}

/// The machine form of a plan.
pub(super) fn plan<'a>(experiment: &'a Experiment, plan: &'a Plan, l: Language) -> PlanForm<'a> {
    let figures = plan.figures.as_ref();
    PlanForm {
        common: common(experiment, figures, &plan.identifiability, &plan.aliases, l),
        kind: "plan",
        readings: plan.readings,
        assumed_zero: &plan.assumed,
    }
}

/// A list in another form.
fn all<'a, T, F>(list: &'a [T], form: impl FnMut(&'a T) -> F) -> Vec<F> {
    list.iter().map(form).collect()
}

fn common<'a>(
    experiment: &'a Experiment,
    figures: Option<&'a Figures>,
    identifiability: &'a Identifiability,
    aliases: &'a [Alias],
    l: Language,
) -> Common<'a> {
    let heading = &experiment.heading;
    let equations = 0..experiment.equations.responses().len();
    let matrix = |of: &dyn Fn(&Figures) -> DMatrix<f64>| {
        figures.map_or_else(Vec::new, |figures| rows(&of(figures)))
    };
    let omitted = experiment.omitted.iter().zip(aliases);
    Common {
        title: said(&heading.title, l),
        procedure: heading.procedure.as_deref(),
        reference: heading.reference.as_deref(),
        object: heading.object.as_deref(),
        author: heading.author.as_deref(),
        date: heading.date.as_deref(),
        equations: equations
            .map(|response| experiment.equations.text(response))
            .collect(),
        coverage_probability: Number(experiment.coverage_probability),
        coefficients: figures.map_or_else(Vec::new, |figures| coefficients(figures, l)),
        covariance: matrix(&|figures| figures.covariance.clone()),
        correlation: matrix(&Figures::correlation),
        causes: figures.map_or_else(Vec::new, |figures| {
            all(&figures.causes, |one| cause(one, figures, l))
        }),
        identifiability: IdentifiabilityForm {
            rank: identifiability.rank,
            parameters: identifiability.parameters,
            condition: Number(identifiability.condition),
            undetermined: all(&identifiability.undetermined, |combination| {
                UndeterminedForm {
                    words: in_words(combination, l),
                    changes: changes(combination),
                }
            }),
            near: all(&identifiability.near, |near| NearForm {
                parameter: &near.parameter,
                inflation: Number(near.inflation),
                changes: changes(&near.combination),
            }),
        },
        omitted: omitted
            .map(|(one, alias)| OmittedForm {
                name: &alias.name,
                term: &one.term,
                unit: &one.unit.symbol,
                description: one.description.as_ref().map(|words| said(words, l)),
                typical: one.typical.map(Number),
                acts: alias.acts,
                visible: Number(alias.visible),
                shifts: shifts(experiment, alias),
            })
            .collect(),
    }
}

fn coefficients(figures: &Figures, l: Language) -> Vec<CoefficientForm<'_>> {
    all(&figures.coefficients, |one| CoefficientForm {
        name: &one.name,
        description: one.description.as_ref().map(|words| said(words, l)),
        unit: &one.unit.symbol,
        value: Number(one.value),
        u: Number(one.u),
        dof: Number(one.dof),
        k: Number(one.k),
        expanded: Number(one.k * one.u),
        p_value: Number(one.p_value),
        significant: one.is_significant(),
    })
}

fn cause<'a>(cause: &'a Cause, figures: &'a Figures, l: Language) -> CauseForm<'a> {
    let (kind, scope) = match &cause.origin {
        Origin::Stated {
            scope: Scope::By(column),
            ..
        } => ("stated", format!("by {column}")),
        Origin::Stated {
            scope: Scope::Common,
            ..
        } => ("stated", "common".to_owned()),
        Origin::Stated {
            scope: Scope::Each, ..
        } => ("stated", "each".to_owned()),
        Origin::Residuals { .. } => ("residuals", "each".to_owned()),
        Origin::Samples { .. } => ("samples", "each".to_owned()),
        Origin::Prior { .. } => ("prior", "common".to_owned()),
    };
    let contributions = figures.coefficients.iter().enumerate().map(|(index, one)| {
        let part = cause.contributes(index, one.u);
        ContributionForm {
            coefficient: &one.name,
            u: Number(part.u),
            effect: part.effect.map(Number),
            share: Number(part.share),
            dof: Number(part.dof),
        }
    });
    CauseForm {
        name: cause_name(cause, l),
        kind,
        scope,
        how: &cause.how,
        contributions: contributions.collect(),
    }
}

fn changes(combination: &Combination) -> Vec<ChangeForm<'_>> {
    all(&combination.changes, |(parameter, change, unit)| {
        ChangeForm {
            parameter,
            change: Number(*change),
            unit,
        }
    })
}

fn shifts<'a>(experiment: &'a Experiment, alias: &Alias) -> Vec<ShiftForm<'a>> {
    let parameters = experiment
        .parameters
        .iter()
        .map(|one| (&one.name, &one.unit));
    let results = experiment.results.iter().map(|one| (&one.name, &one.unit));
    let all = parameters.chain(results).zip(&alias.shifts);
    all.map(|((coefficient, unit), shift)| ShiftForm {
        coefficient,
        per_unit: Number(*shift),
        unit: &unit.symbol,
    })
    .collect()
}

fn response<'a>(one: &'a ResponseScatter, unit: &'a str) -> ResponseForm<'a> {
    ResponseForm {
        name: &one.response,
        unit,
        readings: one.readings,
        rms: Number(one.rms),
        s: Number(one.s),
        dof: Number(one.dof),
        test: one.test.map(|test| TestForm {
            expected: Number(test.expected),
            chi_squared: Number(test.chi_squared),
            dof: Number(test.dof),
            p_value: Number(test.p_value),
            misfit: test.misfit.map(|misfit| match misfit {
                Misfit::BetweenDwells => "between dwells",
                Misfit::Larger => "larger",
                Misfit::Smaller => "smaller",
            }),
        }),
    }
}

fn rows(matrix: &DMatrix<f64>) -> Vec<Vec<Number>> {
    let rows = matrix.row_iter();
    rows.map(|row| row.iter().copied().map(Number).collect())
        .collect()
}
