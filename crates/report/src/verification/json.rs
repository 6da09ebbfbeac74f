//! The machine form of a verification.

use serde_json::Value;

use crate::claim;
use crate::language::Language;
use gumption_format::machine::{Machine, Number, record};
use gumption_gum::propagate::{Comparison, Method};
use gumption_verify::{Example, Row, Verdict, Verification};

use super::{dossier, example, words};

record! {
    /// A verification.
    VerificationJson<'a> {
        /// Day, ISO 8601.
        date: &'a str,
        /// The computer.
        platform: Platform<'a>,
        /// Seeds of the random numbers that were used.
        seeds: Vec<u64>,
        /// What the verification shows and what it does not.
        purpose: Vec<String>,
        /// How figures were compared.
        method: Vec<String>,
        /// Numbers of examples and figures.
        counts: CountsJson,
        /// The result in words: `N passed, M failed`.
        result: String,
        /// Every file with claims.
        examples: Vec<ExampleJson<'a>>,
        /// Files without claims, which do not count.
        without_claims: Vec<&'a str>,
    }

    /// The computer.
    Platform<'a> {
        /// Operating system.
        os: &'a str,
        /// Architecture of the processor.
        architecture: &'a str,
        /// Instruction set that was used.
        instruction_set: &'a str,
    }

    /// Numbers of examples and figures.
    CountsJson {
        /// Examples that passed.
        passed: u64,
        /// Examples that failed.
        failed: u64,
        /// Examples that were shown only.
        not_gating: u64,
        /// Figures that decide.
        figures: u64,
        /// Those among them that differ.
        differing: u64,
        /// Figures that were shown only.
        figures_not_gating: u64,
    }

    /// One file with claims.
    ExampleJson<'a> {
        /// File.
        file: &'a str,
        /// Title.
        title: &'a str,
        /// Where the figures come from.
        reference: Option<&'a str>,
        /// passed, failed, not_gating.
        verdict: &'a str,
        /// Why there are no figures.
        problem: Option<String>,
        /// The file itself, or the rows of its series.
        rows: Vec<RowJson<'a>>,
    }

    /// One evaluation.
    RowJson<'a> {
        /// Row of a series.
        label: Option<&'a str>,
        /// Monte Carlo trials.
        trials: Option<u64>,
        /// Seed of the random numbers.
        seed: Option<u64>,
        /// Every claimed figure.
        figures: Vec<FigureJson<'a>>,
    }

    /// A published figure and the one obtained.
    FigureJson<'a> {
        /// The measurand that the claim is about.
        measurand: Option<&'a str>,
        /// Which figure, as in the claims of the evaluation.
        figure: &'a str,
        /// Input, component or analysis that it is about.
        subject: Option<String>,
        /// The figure in words.
        name: String,
        /// Which method gave it: gum, second_order, monte_carlo, analysis.
        method: &'a str,
        /// Unit; empty for one.
        unit: String,
        /// As published.
        published: Number,
        /// As obtained.
        obtained: Option<Number>,
        /// Obtained less published.
        difference: Option<Number>,
        /// Largest difference that still agrees.
        tolerance: Number,
        /// Correct significant digits that the claim asks for.
        digits: Option<u64>,
        /// Log relative error: correct significant digits obtained, at most 16.
        log_relative_error: Option<Number>,
        /// An expanded uncertainty rounded as the conventions of the file say.
        rounded: Option<Number>,
        /// Whether they agree.
        agrees: bool,
        /// Whether the verdict depends on it.
        gating: bool,
        /// Who says so.
        reference: Option<&'a str>,
        /// What else is to be known about the claim.
        note: Option<&'a str>,
    }
}

impl Machine for VerificationJson<'_> {
    const KIND: &'static str = "verification";
    const VERSION: u32 = 1;
}

/// JSON Schema of `verification.json` and of the output of `gumption verify --json`.
pub fn verification_schema() -> Value {
    gumption_format::machine::schema::<VerificationJson<'_>>("gumption verify --json")
}

/// The machine form of a verification.
pub(super) fn form(verification: &Verification, l: Language) -> VerificationJson<'_> {
    let environment = &verification.environment;
    let counts = verification.counts();
    VerificationJson {
        date: &environment.date,
        platform: Platform {
            os: environment.os,
            architecture: environment.architecture,
            instruction_set: environment.instruction_set,
        },
        seeds: verification.seeds(),
        purpose: dossier::purpose(l),
        method: dossier::method(l),
        counts: CountsJson {
            passed: counts.passed as u64,
            failed: counts.failed as u64,
            not_gating: counts.not_gating as u64,
            figures: counts.figures as u64,
            differing: counts.differing as u64,
            figures_not_gating: counts.figures_not_gating as u64,
        },
        result: words::tally(verification, l),
        examples: verification
            .examples
            .iter()
            .map(|one| example_json(one, l))
            .collect(),
        without_claims: verification
            .without_claims
            .iter()
            .map(String::as_str)
            .collect(),
    }
}

fn example_json(one: &Example, l: Language) -> ExampleJson<'_> {
    ExampleJson {
        file: &one.file,
        title: &one.heading.title,
        reference: one.heading.reference.as_deref(),
        verdict: match one.verdict() {
            Verdict::Passed => "passed",
            Verdict::Failed => "failed",
            Verdict::NotGating => "not_gating",
        },
        problem: one
            .rows
            .as_ref()
            .err()
            .map(|problem| example::words_of(problem, l)),
        rows: one
            .rows
            .iter()
            .flatten()
            .map(|row| row_json(row, l))
            .collect(),
    }
}

fn row_json(row: &Row, l: Language) -> RowJson<'_> {
    let run = row.evaluation.run.as_ref();
    RowJson {
        label: row.label.as_deref(),
        trials: run.map(|run| run.trials),
        seed: run.map(|run| run.seed),
        figures: row
            .comparisons
            .iter()
            .map(|comparison| figure_json(row, comparison, l))
            .collect(),
    }
}

fn figure_json<'a>(row: &'a Row, comparison: &'a Comparison, l: Language) -> FigureJson<'a> {
    let report = example::report(row, l);
    let what = &comparison.claimed.what;
    let claim = row.budget.claims.get(comparison.claim);
    FigureJson {
        measurand: example::measurand(&report, comparison),
        figure: claim::code(what),
        subject: claim::subject(&report, what).map(|name| name.to_string()),
        name: example::name(&report, comparison),
        method: match comparison.method {
            Method::Gum => "gum",
            Method::SecondOrder => "second_order",
            Method::MonteCarlo => "monte_carlo",
            Method::Analysis => "analysis",
        },
        unit: example::unit(&report, comparison),
        published: Number(comparison.claimed.value),
        obtained: comparison.obtained.map(Number),
        difference: comparison.difference().map(Number),
        tolerance: Number(comparison.claimed.tolerance),
        digits: row
            .digits_wanted(comparison)
            .filter(|digits| example::is_by_digits(comparison, *digits))
            .map(u64::from),
        log_relative_error: comparison.log_relative_error().map(Number),
        rounded: comparison.rounded.map(Number),
        agrees: comparison.agrees(),
        gating: row.gates(comparison),
        reference: claim.and_then(|claim| claim.reference.as_deref()),
        note: claim.and_then(|claim| claim.note.as_deref()),
    }
}
