//! Claimed beside obtained figures.

use crate::{Report, claim};
use gumption_format::machine::Number;
use gumption_format::machine::record;
use gumption_gum::budget::{Claim, Confidence};
use gumption_gum::propagate::{Method, compare_claims};

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

pub(super) fn claim<'a>(report: &Report<'a>, index: usize, claim: &'a Claim) -> ClaimJson<'a> {
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
                claimed: Number(c.claimed.value),
                tolerance: Number(c.claimed.tolerance),
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
