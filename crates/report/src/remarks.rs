//! Findings as sentences: what was found, what follows from it, what to do.

use gumption_fault::{Between, Said, say};
use gumption_format::document::{Finding as Remark, Severity};
use gumption_gum::budget::FitDoubt;
use gumption_gum::propagate::{FindingKind, Reason, is_residue};

use super::fits::{doubtful_fit, test_figures};
use super::number::{aligned, exact, freedom, grouped, probability, significant};
use super::{Report, meant, moments};

/// All findings and the budget's remarks, each one paragraph; what is found alike of several
/// measurands stands once.
pub(super) fn remarks(report: &Report<'_>) -> Vec<Remark> {
    let l = report.language;
    let several = report.evaluation.results.len() > 1;
    let mut found: Vec<(Remark, Vec<String>)> = Vec::new();
    for finding in &report.evaluation.findings {
        let remark = Remark {
            id: code(&finding.kind).to_string(),
            severity: finding.kind.severity(),
            language: l,
            text: finding_sentence(report, finding.measurand, &finding.kind),
        };
        let name = finding
            .measurand
            .filter(|_| several)
            .map(|m| report.measurand(m).0.to_string());
        match found.iter_mut().find(|(known, _)| *known == remark) {
            Some((_, names)) => names.extend(name),
            None => found.push((remark, Vec::from_iter(name))),
        }
    }
    let findings = found.into_iter().map(|(mut remark, names)| {
        if !names.is_empty() {
            let (names, text) = (l.list(&names), &remark.text);
            remark.text = l.with_head(&names, text);
        }
        remark
    });
    let of_budget = report.budget.remarks.iter().map(|remark| Remark {
        id: REMARK.to_string(),
        severity: Severity::Note,
        language: l,
        text: remark.in_language(l),
    });
    findings.chain(of_budget).collect()
}

/// What remarks of the budget are called, for machines.
pub(super) const REMARK: &str = "remark";

/// A stable name of the kind, for machines.
pub(super) fn code(kind: &FindingKind) -> &'static str {
    match kind {
        FindingKind::VanishingSensitivity { .. } => "vanishing_sensitivity",
        FindingKind::SecondOrderMatters { .. } => "second_order_matters",
        FindingKind::NotValidated => "not_validated",
        FindingKind::Undecided { .. } => "undecided",
        FindingKind::NeedsMonteCarlo => "needs_monte_carlo",
        FindingKind::TrialsUnresolved { .. } => "trials_unresolved",
        FindingKind::SlopesUnresolved => "slopes_unresolved",
        FindingKind::Cancelled => "cancelled",
        FindingKind::MomentsMissing { .. } => "moments_missing",
        FindingKind::FewReadings { .. } => "few_readings",
        FindingKind::FailedTrials { .. } => "failed_trials",
        FindingKind::NotConverged { .. } => "not_converged",
        FindingKind::FreedomRefused { .. } => "freedom_refused",
        FindingKind::FewDegreesOfFreedom { .. } => "few_degrees_of_freedom",
        FindingKind::Irregular { .. } => "irregular",
        FindingKind::NearSingular { .. } => "near_singular",
        FindingKind::PhaseWraps { .. } => "phase_wraps",
        FindingKind::PhaseUnknown { .. } => "phase_unknown",
        FindingKind::Unseen { .. } => "unseen",
        FindingKind::LargeUncertainty { .. } => "large_uncertainty",
        FindingKind::BelowReference { .. } => "below_reference",
        FindingKind::FallingCarrier { .. } => "falling_carrier",
        FindingKind::RoundedDown => "rounded_down",
        FindingKind::ErrorMeant { .. } => "error_meant",
        FindingKind::IndicationMeant { .. } => "indication_meant",
        FindingKind::CoarseStep { .. } => "coarse_step",
        FindingKind::Extrapolated { .. } => "extrapolated",
        FindingKind::LackOfFit { .. } => "lack_of_fit",
        FindingKind::ResidualsTooSmall { .. } => "residuals_too_small",
        FindingKind::ExactFit { .. } => "exact_fit",
        FindingKind::DoubtfulFit { doubt, .. } => match doubt {
            FitDoubt::Pattern { .. } => "residual_pattern",
            FitDoubt::Pole { .. } => "pole_between_points",
            FitDoubt::BetterMinimum { .. } => "better_minimum",
        },
        FindingKind::Asymmetric => "asymmetric",
    }
}

/// One finding in the report's language.
pub(super) fn finding_sentence(
    report: &Report<'_>,
    measurand: Option<usize>,
    kind: &FindingKind,
) -> String {
    said(report, measurand, kind).in_language(report.language)
}

fn said(report: &Report<'_>, measurand: Option<usize>, kind: &FindingKind) -> Said {
    match kind {
        FindingKind::VanishingSensitivity {
            inputs,
            shift,
            u_effect,
        } => vanishing(report, measurand, (inputs, *shift, *u_effect)),
        FindingKind::SecondOrderMatters {
            shift,
            u_first,
            u_second,
        } => {
            let moved = match is_residue(*shift, *u_second) {
                true => say!("leave the estimate as it is"),
                false => say!(
                    "move the estimate by {}",
                    amount(report, measurand, significant(*shift, 2))
                ),
            };
            let changed = match (significant(*u_first, 3), significant(*u_second, 3)) {
                (first, second) if first == second => say!("leave u as it is"),
                (first, second) => say!(
                    "change u from {first} to {}",
                    amount(report, measurand, second)
                ),
            };
            say!(
                "The model is noticeably nonlinear over the uncertainties of its inputs: second-order terms {moved} and {changed}. Do not use the first-order figures alone."
            )
        }
        FindingKind::NotValidated => not_validated(report, measurand),
        FindingKind::Undecided { trials } => undecided(report, measurand, *trials),
        FindingKind::NeedsMonteCarlo => say!(
            "First order is doubtful for this budget and Monte Carlo was not run, so nothing checks the result. Run the evaluation with Monte Carlo before using it."
        ),
        FindingKind::TrialsUnresolved { error } => say!(
            "The model takes large numbers from one another. The estimate is computed with twice the digits and holds; the trials of Monte Carlo are doubles, which know y only to {}, not to the tolerance of JCGM 101, clause 8. Monte Carlo was left out, and nothing validates the GUM result. For a validation take the common part out of the inputs, and write it as a difference.",
            amount(report, measurand, significant(*error, 2))
        ),
        FindingKind::SlopesUnresolved => say!(
            "The sensitivity coefficients are what rounding left of larger numbers: a change of the estimates in their last digits changes u in the digits that are printed. Write the formula so that large terms do not cancel: write it as a difference."
        ),
        FindingKind::Cancelled => say!(
            "The contributions of the inputs cancel and leave u = 0. Trials would scatter by the rounding of the computer alone; they are not used. No measurement is without uncertainty: add what the inputs do not have in common, or state a correlation below 1."
        ),
        FindingKind::MomentsMissing { reason } => moments::missing(reason),
        FindingKind::FewReadings { components, dof } => {
            moments::few_readings(report, measurand, (components, *dof)).into()
        }
        FindingKind::FailedTrials { failed, trials } => say!(
            "In {} of {} Monte Carlo trials the model had no finite value (for example a division by zero or the root of a negative number). The results leave these trials out. Check whether the distributions of the inputs reach values that are physically impossible.",
            grouped(*failed),
            grouped(*trials)
        ),
        FindingKind::NotConverged { trials } => say!(
            "The adaptive Monte Carlo procedure stopped at its maximum of {} trials before the results were stable to the numerical tolerance asked for. The last digit shown may change with the seed. Raise `max_trials` or ask for fewer digits.",
            grouped(*trials)
        ),
        FindingKind::FreedomRefused {
            members,
            lower_bound,
        } => say!(
            "The effective degrees of freedom are not defined, because {} are correlated and have different finite degrees of freedom: the Welch–Satterthwaite formula is for independent terms. k is taken for the smallest of them, ν = {}, which as a rule makes U too large rather than too small. State a common `dof`, or replace the correlation by a shared source.",
            Said::row(Between::And, members.iter().cloned()),
            freedom(*lower_bound)
        ),
        FindingKind::FewDegreesOfFreedom { dof } => {
            moments::few_degrees(report, measurand, *dof).into()
        }
        FindingKind::Irregular { what } => say!(
            "The model is not smooth at the estimates: {}. A derivative says little there, so the GUM figures may be wrong. Rely on Monte Carlo.",
            what.said()
        ),
        FindingKind::NearSingular { what } => say!(
            "The model comes close to a point where it has no value: {}. The output may have very long tails, and neither u nor k then describes it well. Look at the coverage interval, and check the uncertainty of that quantity.",
            what.said()
        ),
        FindingKind::PhaseWraps { what } => say!(
            "The distribution of a phase reaches the place where phases jump from π to -π: {}. A phase is a point of a circle: every trial is taken on the turn around the estimate, so that estimate, u and interval are those of directions. An end beyond ±π is the direction on the other side of the cut (less or plus a full turn).",
            what.said()
        ),
        FindingKind::PhaseUnknown { what } => say!(
            "The direction is hardly known: {}, and its distribution reaches all round the circle. Trials are taken on the turn around the estimate; u and interval then say little. Report real and imaginary part (or both components) in place of the phase.",
            what.said()
        ),
        FindingKind::Unseen { what } => say!(
            "Monte Carlo was not run, and the GUM method does not see that the model changes within the reach of its inputs: {}. Run the evaluation with Monte Carlo before using the result.",
            what.said()
        ),
        FindingKind::LargeUncertainty { input, ratio } => say!(
            "The uncertainty of {input} contributes {} times as much as all others together. Check its unit, and whether a relative uncertainty is meant.",
            significant(*ratio, 2)
        ),
        FindingKind::BelowReference {
            component,
            k,
            reference,
        } => say!(
            "The expanded uncertainty U is smaller than what {component} alone contributes with the k = {} of its certificate, {}: a result is not known better than its reference. Check k.",
            exact(*k),
            amount(report, measurand, significant(*reference, 2))
        ),
        FindingKind::FallingCarrier { input } => say!(
            "{input} is stated as `gross` in [detection], and the result falls where it rises: it is the background, and the decision threshold is not that of the result. State the input that rises with what is measured."
        ),
        FindingKind::RoundedDown => say!(
            "Rounding to one digit makes U smaller by more than 5 %, which EA-4/02, 6.3, does not let stand. State two digits (`digits = 2`), or carry up (`rounding = \"up\"`)."
        ),
        FindingKind::ErrorMeant { .. } | FindingKind::IndicationMeant { .. } => {
            meant::sentence(report, measurand, kind).into()
        }
        FindingKind::CoarseStep { what } => say!(
            "The GUM method replaces a rounding by the straight line through its steps, which leaves out what the rounding does: {}. State the rounding as a component of its own (`step`), or run Monte Carlo, which rounds every trial.",
            what.said()
        ),
        FindingKind::Extrapolated { what } => say!(
            "A table is used beyond its ends: {}. The last straight line of the table was continued, with no allowance for what the quantity does out there. Extend the table, or add a component for the extrapolation.",
            what.said()
        ),
        FindingKind::LackOfFit { fit, test } => say!(
            "The curve of the fit {fit} does not describe its data ({}): deviations as large come about in fewer than one of twenty cases if curve and uncertainties are right. The uncertainties of its parameters do not cover that. Look at the residuals for a pattern or a single wrong point; try another formula, or state larger uncertainties of the data.",
            test_figures(test)
        ),
        FindingKind::ResidualsTooSmall { fit, test } => say!(
            "The data of the fit {fit} lie closer to the curve than their stated uncertainties let expect ({}). Perhaps these are too large, or contain a part that all points have in common: state that as a component with common = true.",
            test_figures(test)
        ),
        FindingKind::DoubtfulFit { fit, doubt } => doubtful_fit(fit, doubt),
        FindingKind::ExactFit { fit } => say!(
            "The curve of the fit {fit} passes through all its points, so that the residuals tell no uncertainty of its parameters: they enter as exact. State the uncertainties of the data."
        ),
        FindingKind::Asymmetric => say!(
            "The distribution of the output is asymmetric, so that the probabilistically symmetric and the shortest coverage interval differ. Do not write the result as estimate ± U; state the interval."
        ),
    }
}

/// Inputs, shift and effect on u of [`FindingKind::VanishingSensitivity`].
fn vanishing(
    report: &Report<'_>,
    measurand: Option<usize>,
    (inputs, shift, u_effect): (&[String], f64, f64),
) -> Said {
    let names = report.language.first_of(inputs);
    let alone = inputs.len() == 1;
    let first = match alone {
        true => say!(
            "First order sees next to nothing of the uncertainty of {names}: the sensitivity coefficient vanishes at the estimates."
        ),
        false => say!(
            "First order sees next to nothing of the uncertainty of {names}: the sensitivity coefficients vanish at the estimates."
        ),
    };
    if shift == 0.0 && u_effect == 0.0 {
        return say!(
            "{first} Second order does not see it either, although the measurand depends on it. Only Monte Carlo tells what it does."
        );
    }
    if !u_effect.is_finite() {
        return say!(
            "{first} The second derivatives do not exist there. Only Monte Carlo tells what it does."
        );
    }
    let amount = |x: f64| amount(report, measurand, significant(x, 2));
    let moved = match is_residue(shift, u_effect) {
        true => Said::default(),
        false => say!(" and move the estimate by {}", amount(shift)),
    };
    let added = amount(u_effect);
    let found = match alone {
        true => say!("Its second-order terms add {added} to u in quadrature{moved}"),
        false => say!("Their second-order terms add {added} to u in quadrature{moved}"),
    };
    say!(
        "{first} {found}: the first-order result is wrong. Rely on Monte Carlo, and on second order where it agrees with it."
    )
}

/// Why the statement takes its method.
fn reported(report: &Report<'_>, measurand: Option<usize>) -> Reason {
    let results = &report.evaluation.results;
    let result = measurand.and_then(|m| results.get(m));
    result.map_or(Reason::NotValidated, |result| {
        result.reported(&report.budget.conventions).reason
    })
}

fn not_validated(report: &Report<'_>, measurand: Option<usize>) -> Said {
    let p = probability(report.coverage_probability());
    let differs = say!(
        "The {p} interval of the GUM differs from the Monte Carlo interval by more than the tolerance δ (JCGM 101, clause 8)"
    );
    let take = say!("Take the Monte Carlo interval wherever a {p} interval is needed.");
    match reported(report, measurand) {
        Reason::NotValidatedFewReadings => say!(
            "{differs}, and y and u differ also where what has few degrees of freedom has u itself as its standard deviation, because the model is nonlinear. The statement takes y and u of that Monte Carlo run, and the k of the profile. {take}"
        ),
        Reason::MomentsAgree => say!(
            "{differs}, but estimate and standard uncertainty agree within δ. The statement claims these and the k of the profile; it therefore uses the GUM result. {take}"
        ),
        Reason::NotNegative => say!(
            "{differs}. The statement gives the interval of ISO 11929; that of Monte Carlo stands beside it."
        ),
        _ => say!(
            "The GUM result is not validated by Monte Carlo (JCGM 101, clause 8): its {p} interval differs from the Monte Carlo interval by more than the tolerance. The statement therefore uses the Monte Carlo result."
        ),
    }
}

fn undecided(report: &Report<'_>, measurand: Option<usize>, trials: u64) -> Said {
    let taken = match reported(report, measurand) {
        Reason::MomentsDiffer | Reason::NotValidatedFewReadings => say!(
            "But the statement claims y and u, and one of them differs from that of Monte Carlo by more than δ, which the scatter of the trials does not explain. It therefore uses the Monte Carlo result."
        ),
        _ => say!("The statement uses the GUM result."),
    };
    say!(
        "Monte Carlo neither validates nor refutes the interval of the GUM (JCGM 101, clause 8): with so many trials the ends of its interval are not known well enough to compare them to within δ. {taken} For a verdict set trials to about {}, or take trials = \"adaptive\".",
        grouped(trials)
    )
}

/// An amount in the unit of the measurand's differences.
fn amount(report: &Report<'_>, measurand: Option<usize>, number: String) -> String {
    let unit = measurand
        .map(|m| super::symbol(report.measurand(m).1))
        .unwrap_or_default();
    if unit.is_empty() {
        number
    } else {
        format!("{number} {unit}")
    }
}

/// The bound that clause 8 compares with, for a table: `δ = 0.0005`.
pub(super) fn tolerance(delta: f64) -> String {
    aligned(delta, delta, 1)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fixtures;
    use crate::language::Language;
    use gumption_gum::budget::CoverageRule;
    use gumption_gum::propagate::CoverageBasis;

    fn texts(remarks: &[Remark]) -> String {
        let texts: Vec<&str> = remarks.iter().map(|remark| remark.text.as_str()).collect();
        texts.join("\n")
    }

    #[test]
    fn a_fixed_factor_makes_no_allowance_for_few_readings() {
        let mut case = fixtures::refused_freedom();
        let of = |case: &fixtures::Case| texts(&remarks(&case.report(Language::English)));
        assert!(of(&case).contains("for which a k from the t-distribution allows"));
        case.budget.conventions.coverage_factor = CoverageRule::Fixed(2.0);
        case.evaluation.results[0].gum.coverage.basis = CoverageBasis::Fixed;
        // t_0.9545(4) = 2.869.
        assert!(of(&case).contains(
            "k = 2 makes no allowance for that; for 95.45 % that of the t-distribution is 2.87"
        ));
        let chinese = texts(&remarks(&case.report(Language::Chinese)));
        assert!(chinese.contains("按 t 分布为 2.87"), "{chinese}");
    }
}
