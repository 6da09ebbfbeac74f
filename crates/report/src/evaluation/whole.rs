//! The whole document, and its short parts.

use super::claims::ClaimJson;
use super::decisions::{ConformityJson, DetectionJson};
use super::fits::FitJson;
use super::joint::JointJson;
use super::result::MeasurandJson;
use super::understood::{
    AnalysisJson, ComponentJson, ConstantJson, Conventions, GroupJson, Heading, InputJson,
    TakenJson,
};
use crate::indices::names;
use crate::{Report, language::Language, remarks, statement};
use gumption_fault::Said;
use gumption_format::machine::record;
use gumption_gum::budget::{Adaptive, NamedFigure};
use gumption_gum::propagate::{Finding, Quasi, Run, SobolIndex};

use super::{claims, decisions, fits, joint, result, understood};
use gumption_format::machine::{Machine, Number, numbers};

record! {
    /// One evaluated budget.
    EvaluationJson<'a> {
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
        /// Sobol' sensitivity indices, where they were asked for.
        sensitivity_indices: Option<SensitivityJson<'a>>,
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
        remarks: Vec<RemarkJson>,
        /// The sentences for the certificate.
        statement: StatementJson,
    }

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
        /// Where quasi-random points were asked for: what became of it.
        quasi: Option<QuasiJson>,
    }

    /// Sobol' sensitivity indices.
    SensitivityJson<'a> {
        /// Trials of each of the two independent samples.
        trials: u64,
        /// Inputs that are independent of all others, or together those that are not independent of one another.
        factors: Vec<Vec<&'a str>>,
        /// Per measurand: one per factor, or null where it has no standard deviation.
        measurands: Vec<Option<Vec<IndexJson>>>,
    }

    /// Indices of one factor.
    IndexJson {
        /// First-order index.
        first_order: Number,
        /// Its standard error.
        first_order_error: Number,
        /// Total index.
        total: Number,
        /// Its standard error.
        total_error: Number,
    }

    /// Quasi-random points.
    QuasiJson {
        /// Whether they were used; `trials` is their number then. Otherwise random trials were run.
        used: bool,
        /// Why random trials were run, or what the points gained.
        note: String,
        /// Independent scrambles.
        replicates: Option<u64>,
        /// The components that were averaged over in place of being drawn.
        averaged: Vec<String>,
        /// Significant digits of u asked for.
        digits: Option<u64>,
        /// Numerical tolerance.
        delta: Option<Number>,
        /// Whether the results are stable to it.
        reached: Option<bool>,
        /// Random trials that would have errors as small.
        equivalent_trials: Option<Number>,
        /// Standard errors of both ends of the shortest interval.
        shortest_standard_errors: Option<Vec<Number>>,
    }

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

    /// A figure of an analysis.
    FigureJson<'a> {
        /// Its name, as claims write it.
        name: &'a str,
        /// The number.
        value: Number,
        /// Its unit.
        unit: &'a str,
    }

    /// A finding.
    FindingJson {
        /// Measurand; null for the whole budget.
        measurand: Option<String>,
        /// Kind of finding.
        kind: String,
        /// Sentence in the language of the report.
        message: String,
    }

    /// A remark in both languages.
    RemarkJson {
        /// English.
        en: String,
        /// Chinese.
        zh: String,
    }

    /// Sentences for the certificate.
    StatementJson {
        /// English.
        en: Vec<String>,
        /// Chinese.
        zh: Vec<String>,
    }
}

impl Machine for EvaluationJson<'_> {
    const KIND: &'static str = "evaluation";
    const VERSION: u32 = 1;
    const SEVERAL: bool = true;
}

impl<'a> EvaluationJson<'a> {
    pub(super) fn new(report: &Report<'a>) -> Self {
        let budget = report.budget;
        let evaluation = report.evaluation;
        EvaluationJson {
            label: report.label,
            heading: understood::heading(&budget.heading),
            conventions: understood::conventions(&budget.conventions),
            measurands: evaluation
                .results
                .iter()
                .enumerate()
                .map(|(m, r)| result::measurand(report, m, r))
                .collect(),
            inputs: budget.inputs.iter().map(understood::input).collect(),
            components: budget
                .components
                .iter()
                .map(|c| understood::component(c, &budget.inputs))
                .collect(),
            correlated: budget.groups.iter().map(understood::group).collect(),
            analyses: budget.analyses.iter().map(understood::analysis).collect(),
            taken_results: budget.chain.taken.iter().map(understood::taken).collect(),
            constants: budget.constants.iter().map(understood::constant).collect(),
            fits: budget.fits.iter().map(fits::fit).collect(),
            joint: evaluation.joint.as_ref().map(joint::joint),
            monte_carlo_run: evaluation.run.as_ref().map(run),
            sensitivity_indices: sensitivity(report),
            conformity: decisions::conformity(report),
            detection: decisions::detection(report),
            figures: evaluation.figures.iter().map(figure).collect(),
            claims: budget
                .claims
                .iter()
                .enumerate()
                .map(|(index, c)| claims::claim(report, index, c))
                .collect(),
            findings: evaluation
                .findings
                .iter()
                .map(|f| finding(report, f))
                .collect(),
            remarks: budget.remarks.iter().map(remark).collect(),
            statement: in_both_languages(report),
        }
    }
}

fn figure(figure: &NamedFigure) -> FigureJson<'_> {
    FigureJson {
        name: &figure.name,
        value: Number(figure.value),
        unit: &figure.unit.symbol,
    }
}

fn finding(report: &Report<'_>, found: &Finding) -> FindingJson {
    let measurand = found.measurand;
    FindingJson {
        measurand: measurand.map(|m| report.measurand(m).0.to_string()),
        kind: remarks::code(&found.kind).to_string(),
        message: remarks::finding_sentence(report, measurand, &found.kind),
    }
}

fn remark(remark: &Said) -> RemarkJson {
    RemarkJson {
        en: remark.to_string(),
        zh: remark.in_language(Language::Chinese),
    }
}

fn in_both_languages(report: &Report<'_>) -> StatementJson {
    let sentences = |language| {
        statement(&Report {
            language,
            ..*report
        })
    };
    StatementJson {
        en: sentences(Language::English),
        zh: sentences(Language::Chinese),
    }
}

fn run(run: &Run) -> RunJson {
    RunJson {
        trials: run.trials,
        seed: run.seed,
        coverage_probability: Number(run.coverage_probability),
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
        quasi: run.quasi.as_ref().map(quasi),
    }
}

fn sensitivity<'a>(report: &Report<'a>) -> Option<SensitivityJson<'a>> {
    let indices = report.evaluation.indices.as_ref()?;
    let index = |index: &SobolIndex| IndexJson {
        first_order: Number(index.first),
        first_order_error: Number(index.first_error),
        total: Number(index.total),
        total_error: Number(index.total_error),
    };
    let of = |found: &Option<Vec<SobolIndex>>| {
        found
            .as_ref()
            .map(|found| found.iter().map(index).collect())
    };
    Some(SensitivityJson {
        trials: indices.trials,
        factors: indices
            .factors
            .iter()
            .map(|factor| names(report, factor))
            .collect(),
        measurands: indices.measurands.iter().map(of).collect(),
    })
}

fn quasi(of: &Quasi) -> QuasiJson {
    let run = match of {
        Quasi::Used(run) => Some(run),
        Quasi::Refused(_) => None,
    };
    QuasiJson {
        used: run.is_some(),
        note: crate::quasi::sentence(of, Language::English),
        replicates: run.map(|run| run.replicates as u64),
        averaged: run.map_or(Vec::new(), |run| run.averaged.clone()),
        digits: run.map(|run| u64::from(run.digits)),
        delta: run.map(|run| Number(run.delta)),
        reached: run.map(|run| run.reached),
        equivalent_trials: run.map(|run| Number(run.equivalent_trials)),
        shortest_standard_errors: run.map(|run| numbers(&run.shortest_errors)),
    }
}
