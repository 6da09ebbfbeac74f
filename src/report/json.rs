//! The machine form of an evaluation: stable field names, exact numbers, a version tag.
//!
//! Numbers are the shortest decimal strings that read back as the same double. Infinity (degrees of
//! freedom) is the string `"inf"`; `null` means that there is no such figure. Every field is always
//! present.

use nalgebra::DMatrix;
use serde::{Serialize, Serializer};
use serde_json::Value;

use crate::budget::{
    Adaptive, Claim, Component, Confidence, Conformity, CoverageRule, Detection, DofRule,
    Evaluation as Kind, Input, Interval, Law, OutputShape, Owner, TScale,
};
use crate::propagate::{
    Basis, Clause8, ConformityResult, Contribution, Coverage, CoverageBasis, DetectionResult,
    Freedom, Gum, JointResult, MeasurandResult, Method, MonteCarlo, Run, Validation,
    compare_claims,
};
use crate::quantity::Rounding;

use super::fits_json::{self, FitJson};
use super::language::Language;
use super::schema::{Describe, record};
use super::{Report, analyses, claim, decisions, remarks, statement};

/// Name and version of the format; the number changes when a field changes its meaning or goes.
pub const FORMAT: &str = "gumption-evaluation/1";

/// The evaluation as a JSON value.
pub fn json(report: &Report<'_>) -> Value {
    serde_json::to_value(Document::new(report)).expect("the records hold nothing that JSON cannot")
}

/// Schema of [`json`]'s value.
pub(super) fn describe() -> Value {
    Document::describe()
}

/// A double; infinities as `"inf"` and `"-inf"`, not-a-number as null.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Number(f64);

impl Serialize for Number {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self.0 {
            f64::INFINITY => serializer.serialize_str("inf"),
            f64::NEG_INFINITY => serializer.serialize_str("-inf"),
            x if x.is_nan() => serializer.serialize_none(),
            x => serializer.serialize_f64(x),
        }
    }
}

impl Describe for Number {
    fn describe() -> Value {
        serde_json::json!({ "anyOf": [{ "type": "number" }, { "enum": ["inf", "-inf", null] }] })
    }
}

pub(super) fn number(x: f64) -> Number {
    Number(x)
}

pub(super) fn numbers(xs: &[f64]) -> Vec<Number> {
    xs.iter().copied().map(Number).collect()
}

pub(super) fn matrix(m: &DMatrix<f64>) -> Vec<Vec<Number>> {
    m.row_iter()
        .map(|row| row.iter().copied().map(Number).collect())
        .collect()
}

record! {
    /// One evaluated budget.
    Document<'a> {
        /// Name and version of this format.
        format: &'a str,
        /// Program that wrote it, with its version.
        generator: String,
        /// Row of a series.
        label: Option<&'a str>,
        /// What the file says about the measurement besides numbers.
        heading: Heading<'a>,
        /// Conventions on which guides differ.
        conventions: Conventions<'a>,
        /// Results, one per measurand.
        measurands: Vec<MeasurandJson<'a>>,
        /// Input quantities in the order of the file; contributions are in the same order.
        inputs: Vec<InputJson<'a>>,
        /// Elementary components of the inputs; contributions are in the same order.
        components: Vec<ComponentJson<'a>>,
        /// Correlated components.
        correlated: Vec<GroupJson>,
        /// Analyses of readings; their numbers are among `figures`, under their names.
        analyses: Vec<AnalysisJson<'a>>,
        /// Results of other files that are inputs here.
        taken_results: Vec<TakenJson<'a>>,
        /// Exactly known quantities.
        constants: Vec<ConstantJson<'a>>,
        /// Least-squares fits whose parameters are inputs.
        fits: Vec<FitJson<'a>>,
        /// Joint result of several measurands.
        joint: Option<JointJson>,
        /// How the Monte Carlo method was run.
        monte_carlo_run: Option<RunJson>,
        /// Conformity assessments.
        conformity: Vec<ConformityJson<'a>>,
        /// Characteristic limits.
        detection: Vec<DetectionJson<'a>>,
        /// Figures of analyses (fits, groups of readings, conformity …) by name.
        figures: Vec<FigureJson<'a>>,
        /// Comparison with claims.
        claims: Vec<ClaimJson<'a>>,
        /// What must be known before the figures are used.
        findings: Vec<FindingJson>,
        /// Remarks on the budget.
        remarks: Vec<RemarkJson<'a>>,
        /// The sentences for the certificate.
        statement: StatementJson,
    }
}

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
}

record! {
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
}

record! {
    /// Both methods for one measurand.
    MeasurandJson<'a> {
        /// Name.
        name: &'a str,
        /// Unit.
        unit: &'a str,
        /// Description.
        description: Option<&'a str>,
        /// Defining statements, one per line.
        equation: &'a str,
        /// Method that the statement uses: gum, monte_carlo.
        basis: &'a str,
        /// Law of propagation of uncertainty, first order.
        gum: GumJson<'a>,
        /// Second-order terms.
        second_order: Option<SecondOrderJson>,
        /// Propagation of distributions.
        monte_carlo: Option<MonteCarloJson>,
        /// Clause 8 of JCGM 101 for two and for one digit of u.
        validation: Option<Vec<ValidationJson>>,
    }
}

record! {
    /// GUM result.
    GumJson<'a> {
        /// Estimate y.
        estimate: Number,
        /// Combined standard uncertainty.
        standard_uncertainty: Number,
        /// Effective degrees of freedom used for k.
        effective_degrees_of_freedom: Number,
        /// How they were found: infinite, welch-satterthwaite, ensembles, refused.
        degrees_of_freedom_from: &'a str,
        /// Coverage factor k.
        coverage_factor: Number,
        /// Where k came from: normal, t, output, fixed.
        coverage_factor_from: &'a str,
        /// Degrees of freedom of the t-distribution that gave k.
        coverage_factor_degrees_of_freedom: Option<Number>,
        /// Shape of the output's distribution that gave k.
        output_shape: Option<&'a str>,
        /// Components that dominate that distribution.
        dominant: Vec<&'a str>,
        /// Coverage probability of k.
        coverage_probability: Number,
        /// Expanded uncertainty U.
        expanded_uncertainty: Number,
        /// Half-width of the interval for the profile's p, which clause 8 compares.
        half_width_for_p: Number,
        /// Contribution of each input.
        inputs: Vec<ContributionJson>,
        /// Contribution of each component.
        components: Vec<ContributionJson>,
    }
}

record! {
    /// A line of the budget table.
    ContributionJson {
        /// Sensitivity coefficient.
        sensitivity: Number,
        /// Standard uncertainty, in the unit of the input or component.
        standard_uncertainty: Number,
        /// Sensitivity times standard uncertainty, with sign, in the unit of the measurand.
        contribution: Number,
        /// Share of the variance of y; shares sum to 1 also under correlation.
        share: Number,
        /// Degrees of freedom.
        degrees_of_freedom: Number,
    }
}

record! {
    /// Second-order terms (JCGM 100, note to 5.1.2).
    SecondOrderJson {
        /// To be added to the estimate.
        shift: Number,
        /// Standard uncertainty with second-order terms.
        standard_uncertainty: Number,
        /// Whether they matter at the digits reported.
        matters: bool,
    }
}

record! {
    /// Monte Carlo result.
    MonteCarloJson {
        /// Mean; null when it does not exist.
        estimate: Option<Number>,
        /// Standard deviation; null when it does not exist.
        standard_uncertainty: Option<Number>,
        /// Median.
        median: Number,
        /// Probabilistically symmetric coverage interval.
        symmetric_interval: Vec<Number>,
        /// Shortest coverage interval.
        shortest_interval: Vec<Number>,
        /// Skewness.
        skewness: Option<Number>,
        /// Excess kurtosis.
        excess_kurtosis: Option<Number>,
        /// Standard errors of estimate, standard uncertainty, and both ends of the symmetric interval.
        standard_errors: Vec<Number>,
        /// Trials without a finite value.
        failed_trials: u64,
        /// Counts over the central range.
        histogram: HistogramJson,
    }
}

record! {
    /// Counts in equal bins.
    HistogramJson {
        /// Left edge of the first bin.
        start: Number,
        /// Width of a bin.
        width: Number,
        /// Counts.
        counts: Vec<u64>,
    }
}

record! {
    /// JCGM 101 clause 8.
    ValidationJson {
        /// Significant digits of u regarded as meaningful.
        digits: u64,
        /// Numerical tolerance δ.
        delta: Number,
        /// Difference of the lower ends.
        d_low: Number,
        /// Difference of the upper ends.
        d_high: Number,
        /// Standard error of the Monte Carlo ends, the larger of the two.
        standard_error: Number,
        /// validated, not-validated, or undecided (the ends scatter too much for a verdict).
        verdict: &'static str,
        /// Whether both differences are within δ beyond doubt.
        validated: bool,
    }
}

record! {
    /// An analysis of the readings behind a component.
    AnalysisJson<'a> {
        /// Name of the component, with which the names of its figures begin.
        component: &'a str,
        /// What it is: readings, anova, nested-anova, outlier-grubbs, outlier-dixon, outlier-4d, outlier-3s.
        kind: &'a str,
        /// What was done with the differences between groups, and between subgroups (included, negative, not-significant, ignored), or whether an outlier was found (outlier, none).
        verdicts: Vec<&'a str>,
    }
}

record! {
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
}

record! {
    /// How a component enters an input.
    TermJson {
        /// Index into components.
        component: u64,
        /// Change of the input per unit of the component.
        coefficient: Number,
    }
}

record! {
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
}

record! {
    /// A distribution.
    DistributionJson {
        /// Kind, as in budget files.
        name: String,
        /// Its parameters.
        parameters: Value,
    }
}

record! {
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
}

record! {
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
}

record! {
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

record! {
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
}

record! {
    /// Joint result (JCGM 102).
    JointJson {
        /// Covariance matrix, GUM.
        covariance: Vec<Vec<Number>>,
        /// Correlation matrix, GUM.
        correlation: Vec<Vec<Number>>,
        /// Covariance matrix, Monte Carlo.
        monte_carlo_covariance: Option<Vec<Vec<Number>>>,
        /// Correlation matrix, Monte Carlo.
        monte_carlo_correlation: Option<Vec<Vec<Number>>>,
        /// Degrees of freedom of the covariance matrix.
        degrees_of_freedom: Number,
        /// Factor of the elliptical region, GUM.
        ellipsoid_factor: Number,
        /// Factor of the hyper-rectangle, GUM.
        rectangle_factor: Number,
        /// Coverage regions from Monte Carlo.
        regions: Option<RegionsJson>,
        /// Whether a measurand is a linear function of the others.
        degenerate: bool,
    }
}

record! {
    /// Coverage regions from Monte Carlo.
    RegionsJson {
        /// Factor of the ellipsoid.
        ellipsoid_factor: Number,
        /// Factor of the hyper-rectangle.
        rectangle_factor: Number,
        /// Area or volume of the ellipsoid.
        ellipsoid_volume: Number,
        /// Area or volume of the smallest region.
        smallest_volume: Option<Number>,
        /// Cells of the smallest region.
        smallest_cells: Option<u64>,
    }
}

record! {
    /// A Monte Carlo run.
    RunJson {
        /// Trials.
        trials: u64,
        /// Seed.
        seed: u64,
        /// Coverage probability of the intervals.
        coverage_probability: Number,
        /// What an adaptive run reached.
        adaptive: Option<AdaptiveJson>,
    }
}

record! {
    /// An adaptive run.
    AdaptiveJson {
        /// Procedure: stein, jcgm101.
        procedure: String,
        /// Significant digits of u asked for.
        digits: u64,
        /// Numerical tolerance of each measurand.
        delta: Vec<Number>,
        /// Whether the results are stable to it.
        reached: bool,
    }
}

record! {
    /// A conformity assessment (JCGM 106).
    ConformityJson<'a> {
        /// Its name; its figures begin with it.
        name: &'a str,
        /// Measurand.
        measurand: &'a str,
        /// Tolerance limits, lower and upper; infinite where there is none.
        tolerance: Vec<Number>,
        /// Acceptance limits; null where no value is accepted.
        acceptance: Option<Vec<Number>>,
        /// Values outside of these limits are rejected.
        rejection: Vec<Number>,
        /// Decision: conforming, not_conforming, undecided; null in planning.
        verdict: Option<&'static str>,
        /// Conformance probability, with the knowledge of the process where there is some.
        conformance_probability: Option<Number>,
        /// Its complement.
        nonconformance_probability: Option<Number>,
        /// Conformance probability from the GUM result alone.
        from_measurement: Option<Number>,
        /// Conformance probability as the fraction of the Monte Carlo trials.
        from_trials: Option<Number>,
        /// Measurement capability index C_m.
        capability: Option<Number>,
        /// Test uncertainty ratio.
        test_uncertainty_ratio: Option<Number>,
        /// Risks over all items of the process.
        global: Option<GlobalJson>,
    }
}

record! {
    /// Risks over all items of a process.
    GlobalJson {
        /// Probability that an item conforms.
        in_tolerance: Number,
        /// Probability that an item is accepted.
        accepted: Number,
        /// Global consumer's risk.
        consumer: Number,
        /// Global producer's risk.
        producer: Number,
        /// Probability that an accepted item does not conform.
        false_acceptance: Number,
        /// Probability that a rejected item conforms.
        false_rejection: Number,
    }
}

record! {
    /// Characteristic limits (ISO 11929).
    DetectionJson<'a> {
        /// Measurand.
        measurand: &'a str,
        /// Probability of recognising an effect that is not there.
        alpha: Number,
        /// Probability of missing an effect at the detection limit.
        beta: Number,
        /// Decision threshold.
        decision_threshold: Option<Number>,
        /// Detection limit; null where there is none.
        detection_limit: Option<Number>,
        /// Decision threshold, Monte Carlo.
        monte_carlo_decision_threshold: Option<Number>,
        /// Detection limit, Monte Carlo.
        monte_carlo_detection_limit: Option<Number>,
        /// Whether the effect is recognised.
        recognised: Option<bool>,
        /// Whether the detection limit is at most the guideline value.
        suitable: Option<bool>,
        /// Best estimate of the non-negative measurand.
        best_estimate: Number,
        /// Its standard uncertainty.
        best_standard_uncertainty: Number,
        /// Limits of the symmetric coverage interval.
        symmetric_interval: Vec<Number>,
        /// Limits of the shortest coverage interval.
        shortest_interval: Vec<Number>,
        /// Coverage probability of both.
        coverage_probability: Number,
    }
}

record! {
    /// A figure of an analysis.
    FigureJson<'a> {
        /// Its name, as claims write it.
        name: &'a str,
        /// The number.
        value: Number,
        /// Its unit.
        unit: &'a str,
    }
}

record! {
    /// A claim with its comparison.
    ClaimJson<'a> {
        /// Measurand.
        measurand: &'a str,
        /// Who says so.
        reference: Option<&'a str>,
        /// Note.
        note: Option<&'a str>,
        /// How well the figures are known: high, medium, low; low decides nothing.
        confidence: &'static str,
        /// Claimed figures beside those obtained.
        comparison: Vec<ComparisonJson<'a>>,
    }
}

record! {
    /// A claimed figure beside the obtained one.
    ComparisonJson<'a> {
        /// What is compared.
        figure: &'static str,
        /// The input, component or other measurand that the figure is about.
        of: Option<&'a str>,
        /// What gave the obtained figure: gum, second_order, monte_carlo, analysis.
        method: &'static str,
        /// Claimed.
        claimed: Number,
        /// Largest difference that agrees.
        tolerance: Number,
        /// Obtained.
        obtained: Option<Number>,
        /// Obtained expanded uncertainty, rounded by the conventions of the budget.
        rounded: Option<Number>,
        /// Obtained divided by claimed.
        ratio: Option<Number>,
        /// Whether the claim is about this method; otherwise the figure is for information.
        judged: bool,
        /// Whether a verdict depends on it; not so where the claim's source is known in part only.
        decides: bool,
        /// Whether obtained differs from claimed by no more than the tolerance, or is the claimed figure when rounded.
        agrees: bool,
    }
}

record! {
    /// A finding.
    FindingJson {
        /// Measurand; null for the whole budget.
        measurand: Option<String>,
        /// Kind of finding.
        kind: String,
        /// Sentence in the language of the report.
        message: String,
    }
}

record! {
    /// A remark in both languages.
    RemarkJson<'a> {
        /// English.
        en: &'a str,
        /// Chinese.
        zh: &'a str,
    }
}

record! {
    /// Sentences for the certificate.
    StatementJson {
        /// English.
        en: Vec<String>,
        /// Chinese.
        zh: Vec<String>,
    }
}

impl<'a> Document<'a> {
    fn new(report: &Report<'a>) -> Self {
        let budget = report.budget;
        let evaluation = report.evaluation;
        let heading = &budget.heading;
        Document {
            format: FORMAT,
            generator: format!("gumption {}", env!("CARGO_PKG_VERSION")),
            label: report.label,
            heading: Heading {
                title: &heading.title,
                method: heading.method.as_deref(),
                object: heading.object.as_deref(),
                author: heading.author.as_deref(),
                date: heading.date.as_deref(),
                reference: heading.reference.as_deref(),
                note: heading.note.as_deref(),
            },
            conventions: conventions(&budget.conventions),
            measurands: evaluation
                .results
                .iter()
                .enumerate()
                .map(|(m, r)| measurand(report, m, r))
                .collect(),
            inputs: budget.inputs.iter().map(input).collect(),
            components: budget
                .components
                .iter()
                .map(|c| component(c, &budget.inputs))
                .collect(),
            correlated: budget
                .groups
                .iter()
                .map(|g| GroupJson {
                    members: g.members.iter().map(|m| *m as u64).collect(),
                    correlation: matrix(&g.correlation),
                    law: match g.law {
                        Law::Normal => "normal",
                        Law::StudentT { .. } => "t",
                        Law::GaussianCopula { .. } => "gaussian-copula",
                    }
                    .to_string(),
                    degrees_of_freedom: g.dof.map(Number),
                })
                .collect(),
            analyses: budget
                .analyses
                .iter()
                .map(|analysis| {
                    let (kind, verdicts) = analyses::codes(&analysis.found);
                    AnalysisJson {
                        component: &analysis.name,
                        kind,
                        verdicts,
                    }
                })
                .collect(),
            taken_results: budget
                .chain
                .taken
                .iter()
                .map(|taken| TakenJson {
                    name: &taken.input,
                    file: &taken.file,
                    row: taken.row.as_deref(),
                    measurand: &taken.measurand,
                    title: &taken.title,
                    equation: taken.equation.as_deref(),
                })
                .collect(),
            constants: budget
                .constants
                .iter()
                .map(|c| ConstantJson {
                    name: &c.name,
                    values: numbers(&c.values),
                    unit: &c.unit.symbol,
                    description: c.description.as_deref(),
                    reference: c.reference.as_deref(),
                })
                .collect(),
            fits: budget.fits.iter().map(fits_json::fit).collect(),
            joint: evaluation.joint.as_ref().map(joint),
            monte_carlo_run: evaluation.run.as_ref().map(run),
            conformity: conformity(report),
            detection: detection(report),
            figures: evaluation
                .figures
                .iter()
                .map(|f| FigureJson {
                    name: &f.name,
                    value: number(f.value),
                    unit: &f.unit.symbol,
                })
                .collect(),
            claims: budget
                .claims
                .iter()
                .enumerate()
                .map(|(index, c)| claim_json(report, index, c))
                .collect(),
            findings: evaluation
                .findings
                .iter()
                .map(|f| FindingJson {
                    measurand: f.measurand.map(|m| report.measurand(m).0.to_string()),
                    kind: remarks::code(&f.kind).to_string(),
                    message: remarks::finding_sentence(report, f.measurand, &f.kind),
                })
                .collect(),
            remarks: budget
                .remarks
                .iter()
                .map(|r| RemarkJson {
                    en: &r.en,
                    zh: &r.zh,
                })
                .collect(),
            statement: StatementJson {
                en: statement(&Report {
                    language: Language::English,
                    ..*report
                }),
                zh: statement(&Report {
                    language: Language::Chinese,
                    ..*report
                }),
            },
        }
    }
}

fn conventions(c: &crate::budget::Conventions) -> Conventions<'_> {
    Conventions {
        profile: &c.profile,
        overrides: c.overrides.iter().map(String::as_str).collect(),
        coverage_probability: number(c.coverage_probability),
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

fn measurand<'a>(report: &Report<'a>, m: usize, result: &'a MeasurandResult) -> MeasurandJson<'a> {
    let (name, unit) = report.measurand(m);
    MeasurandJson {
        name,
        unit: &unit.symbol,
        description: report
            .budget
            .measurands
            .get(m)
            .and_then(|m| m.description.as_deref()),
        equation: &report.budget.model.outputs()[m].equation,
        basis: match result.basis {
            Basis::Gum => "gum",
            Basis::MonteCarlo => "monte_carlo",
        },
        gum: gum(&result.gum),
        second_order: result.second_order.as_ref().map(|s| SecondOrderJson {
            shift: number(s.shift),
            standard_uncertainty: number(s.u),
            matters: s.matters,
        }),
        monte_carlo: result.monte_carlo.as_ref().map(monte_carlo),
        validation: result
            .validation
            .as_ref()
            .map(|both| both.iter().map(validation).collect()),
    }
}

fn gum(gum: &Gum) -> GumJson<'_> {
    let Coverage {
        k,
        basis,
        probability,
        expanded,
        half_width_for_p,
    } = &gum.coverage;
    let (from, dof, shape, dominant) = match basis {
        CoverageBasis::Normal => ("normal", None, None, &[][..]),
        CoverageBasis::StudentT { dof } => ("t", Some(number(*dof)), None, &[][..]),
        CoverageBasis::Output { dominant, shape } => {
            ("output", None, Some(*shape), dominant.as_slice())
        }
        CoverageBasis::Fixed => ("fixed", None, None, &[][..]),
    };
    GumJson {
        estimate: number(gum.estimate),
        standard_uncertainty: number(gum.u),
        effective_degrees_of_freedom: number(gum.freedom.value()),
        degrees_of_freedom_from: match gum.freedom {
            Freedom::Infinite => "infinite",
            Freedom::WelchSatterthwaite(_) => "welch-satterthwaite",
            Freedom::Ensembles(_) => "ensembles",
            Freedom::Refused { .. } => "refused",
        },
        coverage_factor: number(*k),
        coverage_factor_from: from,
        coverage_factor_degrees_of_freedom: dof,
        output_shape: shape,
        dominant: dominant.iter().map(String::as_str).collect(),
        coverage_probability: number(*probability),
        expanded_uncertainty: number(*expanded),
        half_width_for_p: number(*half_width_for_p),
        inputs: gum.inputs.iter().map(contribution).collect(),
        components: gum.components.iter().map(contribution).collect(),
    }
}

fn contribution(c: &Contribution) -> ContributionJson {
    ContributionJson {
        sensitivity: number(c.sensitivity),
        standard_uncertainty: number(c.u),
        contribution: number(c.contribution),
        share: number(c.share),
        degrees_of_freedom: number(c.dof),
    }
}

fn monte_carlo(mc: &MonteCarlo) -> MonteCarloJson {
    MonteCarloJson {
        estimate: mc.estimate.map(Number),
        standard_uncertainty: mc.u.map(Number),
        median: number(mc.median),
        symmetric_interval: numbers(&mc.symmetric),
        shortest_interval: numbers(&mc.shortest),
        skewness: mc.skewness.map(Number),
        excess_kurtosis: mc.excess_kurtosis.map(Number),
        standard_errors: numbers(&mc.standard_errors),
        failed_trials: mc.failed,
        histogram: HistogramJson {
            start: number(mc.histogram.start),
            width: number(mc.histogram.width),
            counts: mc.histogram.counts.clone(),
        },
    }
}

fn validation(v: &Validation) -> ValidationJson {
    ValidationJson {
        digits: u64::from(v.digits),
        delta: number(v.delta),
        d_low: number(v.d_low),
        d_high: number(v.d_high),
        standard_error: number(v.error),
        verdict: match v.verdict {
            Clause8::Validated => "validated",
            Clause8::NotValidated => "not-validated",
            Clause8::Undecided => "undecided",
        },
        validated: v.is_validated(),
    }
}

fn input(input: &Input) -> InputJson<'_> {
    InputJson {
        name: &input.name,
        description: input.description.as_deref(),
        group: input.group.as_deref(),
        unit: &input.unit.symbol,
        estimate: number(input.estimate),
        terms: input
            .terms
            .iter()
            .map(|t| TermJson {
                component: t.component as u64,
                coefficient: number(t.coefficient),
            })
            .collect(),
    }
}

fn component<'a>(c: &'a Component, inputs: &'a [Input]) -> ComponentJson<'a> {
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
        standard_uncertainty: number(c.u),
        degrees_of_freedom: number(c.dof),
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

fn parameters(distribution: &crate::distribution::Distribution) -> Value {
    use crate::distribution::Distribution as D;
    let list = |pairs: &[(&str, f64)]| -> Value {
        pairs
            .iter()
            .map(|(name, x)| ((*name).to_string(), serde_json::json!(Number(*x))))
            .collect::<serde_json::Map<_, _>>()
            .into()
    };
    match distribution {
        D::Normal { mean, sd } => list(&[("mean", *mean), ("sd", *sd)]),
        D::StudentT {
            location,
            scale,
            dof,
        } => list(&[("location", *location), ("scale", *scale), ("dof", *dof)]),
        D::Uniform { lower, upper } | D::Arcsine { lower, upper } => {
            list(&[("lower", *lower), ("upper", *upper)])
        }
        D::Triangular { lower, mode, upper } => {
            list(&[("lower", *lower), ("mode", *mode), ("upper", *upper)])
        }
        D::Trapezoidal { lower, upper, beta } => {
            list(&[("lower", *lower), ("upper", *upper), ("beta", *beta)])
        }
        D::CurvilinearTrapezoid { lower, upper, d } => {
            list(&[("lower", *lower), ("upper", *upper), ("d", *d)])
        }
        D::Exponential { origin, mean } => list(&[("origin", *origin), ("mean", *mean)]),
        D::Gamma {
            origin,
            shape,
            scale,
        } => list(&[("origin", *origin), ("shape", *shape), ("scale", *scale)]),
        D::LogNormal { origin, mu, sigma } => {
            list(&[("origin", *origin), ("mu", *mu), ("sigma", *sigma)])
        }
        D::Beta {
            alpha,
            beta,
            lower,
            upper,
        } => list(&[
            ("alpha", *alpha),
            ("beta", *beta),
            ("lower", *lower),
            ("upper", *upper),
        ]),
        D::Discrete {
            values,
            probabilities,
        } => {
            serde_json::json!({ "values": numbers(values), "probabilities": numbers(probabilities) })
        }
        D::Empirical { sample } => serde_json::json!({ "sample": numbers(sample) }),
    }
}

fn joint(joint: &JointResult) -> JointJson {
    JointJson {
        covariance: matrix(&joint.covariance),
        correlation: matrix(&joint.correlation),
        monte_carlo_covariance: joint.monte_carlo_covariance.as_ref().map(matrix),
        monte_carlo_correlation: joint.monte_carlo_correlation.as_ref().map(matrix),
        degrees_of_freedom: number(joint.dof.value()),
        ellipsoid_factor: number(joint.k_ellipsoid),
        rectangle_factor: number(joint.k_rectangle),
        regions: joint.regions.as_ref().map(|r| RegionsJson {
            ellipsoid_factor: number(r.k_ellipsoid),
            rectangle_factor: number(r.k_rectangle),
            ellipsoid_volume: number(r.ellipsoid_volume),
            smallest_volume: r.smallest_volume.map(Number),
            smallest_cells: r.smallest_cells.map(|n| n as u64),
        }),
        degenerate: joint.degenerate,
    }
}

fn run(run: &Run) -> RunJson {
    RunJson {
        trials: run.trials,
        seed: run.seed,
        coverage_probability: number(run.coverage_probability),
        adaptive: run.adaptive.as_ref().map(|a| AdaptiveJson {
            procedure: match a.procedure {
                Adaptive::Stein => "stein",
                Adaptive::Jcgm101 => "jcgm101",
            }
            .to_string(),
            digits: u64::from(a.digits),
            delta: numbers(&a.delta),
            reached: a.reached,
        }),
    }
}

fn conformity<'a>(report: &Report<'a>) -> Vec<ConformityJson<'a>> {
    let ends = |interval: Interval| numbers(&[interval.lower, interval.upper]);
    let pairs = report.budget.conformity.iter();
    let pairs = pairs.zip(&report.evaluation.conformity);
    let one = |(stated, found): (&'a Conformity, &ConformityResult)| ConformityJson {
        name: &stated.name,
        measurand: report.measurand(stated.measurand).0,
        tolerance: ends(stated.tolerance),
        acceptance: found.acceptance.map(ends),
        rejection: ends(found.rejection),
        verdict: found.verdict.map(decisions::verdict_code),
        conformance_probability: found.conformance.and_then(|c| c.probability).map(Number),
        nonconformance_probability: found.conformance.and_then(|c| c.complement).map(Number),
        from_measurement: found.conformance.map(|c| Number(c.from_measurement)),
        from_trials: found.conformance.and_then(|c| c.from_trials).map(Number),
        capability: found.capability.map(Number),
        test_uncertainty_ratio: found.test_uncertainty_ratio.map(Number),
        global: found.global.map(|risk| GlobalJson {
            in_tolerance: number(risk.in_tolerance),
            accepted: number(risk.accepted),
            consumer: number(risk.consumer),
            producer: number(risk.producer),
            false_acceptance: number(risk.false_acceptance),
            false_rejection: number(risk.false_rejection),
        }),
    };
    pairs.map(one).collect()
}

fn detection<'a>(report: &Report<'a>) -> Vec<DetectionJson<'a>> {
    let pairs = report.budget.detection.iter();
    let pairs = pairs.zip(&report.evaluation.detection);
    let one = |(stated, found): (&Detection, &DetectionResult)| DetectionJson {
        measurand: report.measurand(stated.measurand).0,
        alpha: number(stated.alpha),
        beta: number(stated.beta),
        decision_threshold: found.limits.map(|l| Number(l.decision_threshold)),
        detection_limit: found
            .limits
            .and_then(|l| l.detection_limit.value())
            .map(Number),
        monte_carlo_decision_threshold: found.from_trials.map(|l| Number(l.decision_threshold)),
        monte_carlo_detection_limit: found
            .from_trials
            .and_then(|l| l.detection_limit.value())
            .map(Number),
        recognised: found.recognised(),
        suitable: found.suitable(stated),
        best_estimate: number(found.best.value),
        best_standard_uncertainty: number(found.best.u),
        symmetric_interval: numbers(&found.best.symmetric),
        shortest_interval: numbers(&found.best.shortest),
        coverage_probability: number(found.best.coverage_probability),
    };
    pairs.map(one).collect()
}

fn claim_json<'a>(report: &Report<'a>, index: usize, claim: &'a Claim) -> ClaimJson<'a> {
    ClaimJson {
        measurand: report
            .budget
            .model
            .outputs()
            .get(claim.measurand)
            .map_or("", |o| o.name.as_str()),
        reference: claim.reference.as_deref(),
        note: claim.note.as_deref(),
        confidence: match claim.confidence {
            Confidence::High => "high",
            Confidence::Medium => "medium",
            Confidence::Low => "low",
        },
        comparison: compare_claims(report.budget, report.evaluation)
            .iter()
            .filter(|c| c.claim == index)
            .map(|c| ComparisonJson {
                figure: claim::code(&c.claimed.what),
                of: claim::subject(report, &c.claimed.what),
                method: match c.method {
                    Method::Gum => "gum",
                    Method::SecondOrder => "second_order",
                    Method::MonteCarlo => "monte_carlo",
                    Method::Analysis => "analysis",
                },
                claimed: number(c.claimed.value),
                tolerance: number(c.claimed.tolerance),
                obtained: c.obtained.map(Number),
                rounded: c.rounded.map(Number),
                ratio: c.ratio().map(Number),
                judged: c.judged,
                decides: c.decides,
                agrees: c.agrees(),
            })
            .collect(),
    }
}
