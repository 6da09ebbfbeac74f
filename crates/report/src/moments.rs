//! Why a result has no mean or no standard deviation, and what few readings do, as sentences.

use std::cmp::Ordering;

use gumption_core::special::student_t_two_sided_quantile;
use gumption_core::statistics::relative_scatter_of_s;
use gumption_fault::{Between, Said, say};
use gumption_gum::budget::CoverageRule;
use gumption_gum::propagate::{
    Consequence, CoverageBasis, FewReadings, MeasurandResult, MissingMoments, Reason, Side,
};

use super::Report;
use super::number::{exact, freedom, print, probability, significant};

/// Why, with what to do.
pub(super) fn missing(reason: &MissingMoments) -> Said {
    let given = match reason.leave_a_mean() {
        true => say!("Monte Carlo gives mean and coverage interval, and no u."),
        false => say!("Monte Carlo gives median and coverage interval instead."),
    };
    let missing = match reason.leave_a_mean() {
        true => say!("no standard deviation"),
        false => say!("neither a mean nor a standard deviation"),
    };
    match reason {
        MissingMoments::HeavyComponent { name, dof, power } => {
            let nu = freedom(*dof);
            let degrees = if *dof == 1.0 { "degree" } else { "degrees" };
            let grows = match is_first(*power) {
                true => say!("follows it in proportion"),
                false => say!("grows like its power {}", exponent(*power)),
            };
            let above = exponent(2.0 * power);
            say!(
                "The distribution of the output has {missing}: `{name}` has a t-distribution with {nu} {degrees} of freedom, which has moments of order below {nu} only, and the output {grows} as far as the trials reach. {given} More readings behind `{name}` would help; a standard deviation exists above {above} degrees of freedom."
            )
        }
        MissingMoments::JointReadings { inputs, readings } => {
            let (n, many) = (readings, inputs.len());
            let names = Said::row(Between::And, inputs.iter().cloned());
            let (nu, enough) = (n - many.min(*n), many + 3);
            say!(
                "The distribution of the output has {missing}: {n} simultaneous readings of {many} inputs ({names}) leave ν = n − N = {n} − {many} = {nu} for their multivariate t-distribution in Monte Carlo (JCGM 102, 5.3.2), which has no standard deviation for ν ≤ 2. {given} More simultaneous readings would help; a standard deviation exists from {enough} on."
            )
        }
        MissingMoments::Tail {
            side,
            index,
            consequence,
        } => {
            let side = match side {
                Side::Lower => say!("lower"),
                Side::Upper => say!("upper"),
            };
            let then = match consequence {
                Consequence::NoMean => say!("neither mean nor standard deviation exists"),
                Consequence::SlowMean => {
                    say!("the mean does not settle and the standard deviation does not exist")
                }
                Consequence::NoDeviation => say!("the standard deviation does not exist"),
                Consequence::SlowDeviation => say!(
                    "the standard deviation does not settle: ten times the trials would not halve its error"
                ),
            };
            let power = exponent(*index);
            say!(
                "The {side} tail of the Monte Carlo trials falls off roughly like the power −{power} of the distance from the median, so that {then}. {given} Check whether an input with very few degrees of freedom, or a divisor that may be zero, is meant."
            )
        }
        MissingMoments::FewTrials { relative_error } => say!(
            "A handful of far trials decides the standard deviation of the Monte Carlo result (its own relative standard error is {} %), so that another seed would give another u. {given} Check whether a divisor comes close to zero, or an input has very few degrees of freedom.",
            percent(*relative_error)
        ),
    }
}

/// What few readings do: to ν_eff, where that is small, and to Monte Carlo; and what the statement makes of it.
pub(super) fn few_readings(
    report: &Report<'_>,
    measurand: Option<usize>,
    (components, dof): (&[FewReadings], Option<f64>),
) -> String {
    let l = report.language;
    let wider = |few: &FewReadings| {
        let (name, nu) = (&few.component, freedom(few.dof));
        match few.dof > 2.0 {
            true => {
                let times = significant((few.dof / (few.dof - 2.0)).sqrt(), 3);
                say!("`{name}` has ν = {nu}, and that is {times} times u").in_language(l)
            }
            false => say!("`{name}` has ν = {nu}, for which there is none (it exists for ν > 2)")
                .in_language(l),
        }
    };
    let named: Vec<String> = components.iter().map(wider).collect();
    let named = l.pick(l.list(&named), named.join("；"));
    let drawn = say!(
        "Monte Carlo draws from a t-distribution (JCGM 101, 6.4.9), whose standard deviation is larger than u: {named}."
    )
    .in_language(l);
    let result = measurand.and_then(|m| report.evaluation.results.get(m));
    let reason = result.map(|result| result.reported(&report.budget.conventions).reason);
    // Without a difference beyond the tolerance the sign of it is chance.
    let differs = reason == Some(Reason::FewReadings);
    let width = result.filter(|_| differs).map_or(Ordering::Greater, width);
    let refuted = reason.map_or_else(String::new, |reason| of_reason(report, reason, width));
    let space = l.pick(" ", "");
    let parts = match (dof, result) {
        (Some(dof), _) => [few_degrees(report, measurand, dof), drawn, refuted],
        (None, result) => {
            let few = l.pick("Few degrees of freedom:", "自由度小：");
            let factor = result.filter(|_| refuted.is_empty());
            let follows = factor.map_or(refuted, |result| of_factor(report, result, components));
            let more = match width {
                Ordering::Greater => {
                    say!("More readings would bring both together.").in_language(l)
                }
                Ordering::Less | Ordering::Equal => String::new(),
            };
            [format!("{few}{space}{drawn}"), follows, more]
        }
    };
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    parts.join(space)
}

/// The width of the interval of Monte Carlo beside that of the GUM, beyond what its ends scatter (three standard errors): few
/// readings only make it wider.
fn width(result: &MeasurandResult) -> Ordering {
    let of_gum = 2.0 * result.gum.coverage.half_width_for_p;
    let Some(found) = &result.monte_carlo else {
        return Ordering::Equal;
    };
    let [low, high] = found.symmetric;
    let difference = high - low - of_gum;
    match difference.abs() <= found.noise_of_ends() {
        true => Ordering::Equal,
        false => difference.total_cmp(&0.0),
    }
}

/// What the reason why the statement takes its method has to do with few readings; nothing where another finding tells
/// the reason, or the factor k tells it.
fn of_reason(report: &Report<'_>, reason: Reason, width: Ordering) -> String {
    let l = report.language;
    let p = probability(report.coverage_probability());
    match reason {
        Reason::FewReadings if width == Ordering::Equal => say!("The {p} interval of Monte Carlo is as wide as that of the GUM and lies elsewhere, because the model is nonlinear (clause 8), while the statement is u itself (GUM 4.2.3) times the k of the profile. Take the Monte Carlo interval wherever a {p} interval is needed.").in_language(l),
        Reason::FewReadings if width == Ordering::Less => say!("The {p} interval of Monte Carlo is narrower than that of the GUM all the same: the shapes of other distributions or the model make it so (clause 8), while the statement is u itself (GUM 4.2.3) times the k of the profile. Take the Monte Carlo interval wherever a {p} interval is needed.").in_language(l),
        Reason::FewReadings => say!("The {p} interval of Monte Carlo therefore differs from that of the GUM by more than the tolerance δ (clause 8), while the statement is u itself (GUM 4.2.3) times the k of the profile. Take the Monte Carlo interval wherever a {p} interval is needed.").in_language(l),
        Reason::NotNegative => say!("The statement takes the interval of ISO 11929, which rests on u itself (GUM 4.2.3).").in_language(l),
        _ => String::new(),
    }
}

/// Whether the k of the GUM result that the statement takes allows for few degrees of freedom: that follows from how k
/// was made.
fn of_factor(report: &Report<'_>, result: &MeasurandResult, components: &[FewReadings]) -> String {
    let l = report.language;
    let reported = result.reported(&report.budget.conventions);
    // Where clause 8 refutes the GUM, the finding about that tells what is taken.
    if !matches!(
        reported.reason,
        Reason::NotChecked | Reason::Validated | Reason::Undecided
    ) {
        return String::new();
    }
    let coverage = &result.gum.coverage;
    let of_u = percent(components.iter().map(|few| few.share).sum());
    let k = exact(coverage.k);
    match &coverage.basis {
        CoverageBasis::StudentT { .. } => say!("The statement takes the GUM result, whose k from the t-distribution allows for the few degrees of freedom.").in_language(l),
        CoverageBasis::Fixed => say!("The statement takes the GUM result, whose k = {k} is fixed whatever the degrees of freedom; they are {of_u} % of u².").in_language(l),
        CoverageBasis::Normal => say!("The statement takes the GUM result, whose k is that of a normal distribution; they are {of_u} % of u².").in_language(l),
        CoverageBasis::Output { .. } => say!("The statement takes the GUM result, whose k comes from the components that dominate; they are {of_u} % of u².").in_language(l),
    }
}

/// Only few effective degrees of freedom, and whether k allows for them.
pub(super) fn few_degrees(report: &Report<'_>, measurand: Option<usize>, dof: f64) -> String {
    let l = report.language;
    let of_u = percent(relative_scatter_of_s(dof));
    let rule = report.budget.conventions.degrees_of_freedom;
    let (nu, entered) = (freedom(dof), rule.entered(dof));
    let degrees = if dof == 1.0 { "degree" } else { "degrees" };
    // What stands beside k is the ν that gave it.
    let cut = match freedom(entered) {
        same if same == nu => Said::default(),
        cut => say!(" (for k they are cut to {cut}, GUM G.4.1)"),
    };
    let first = say!(
        "Only {nu} effective {degrees} of freedom{cut}: u itself is uncertain by about {of_u} %"
    )
    .in_language(l);
    let Some(result) = measurand.and_then(|m| report.evaluation.results.get(m)) else {
        return first;
    };
    let coverage = &result.gum.coverage;
    let p = report.coverage_probability();
    let of_t = significant(student_t_two_sided_quantile(p, entered), 3);
    let p = probability(p);
    match (&coverage.basis, report.budget.conventions.coverage_factor) {
        (CoverageBasis::StudentT { .. }, _) => say!("{first}, for which a k from the t-distribution allows. More readings of the dominant input would lower U.").in_language(l),
        (CoverageBasis::Fixed, _) | (CoverageBasis::Normal, CoverageRule::Normal) => {
            let k = match report.budget.conventions.coverage_factor {
                CoverageRule::Fixed(k) => exact(k),
                _ => significant(coverage.k, 3),
            };
            say!("{first}. k = {k} makes no allowance for that; for {p} that of the t-distribution is {of_t}. More readings of the dominant input would help; coverage_factor_from = \"t\" in [conventions] takes the k of the t-distribution.").in_language(l)
        }
        (CoverageBasis::Normal | CoverageBasis::Output { .. }, _) => say!("{first}. k, from the distribution of the result, makes no allowance for that; for {p} that of the t-distribution is {of_t}. More readings would help.").in_language(l),
    }
}

/// Whether a power is the first, within what it is known to.
fn is_first(power: f64) -> bool {
    (power - 1.0).abs() < 0.05
}

/// A tail index is known to one decimal at best.
fn exponent(index: f64) -> String {
    print(&super::number::at_place(index, -1))
}

/// A fraction in percent, to the nearest whole number.
fn percent(fraction: f64) -> String {
    format!("{:.0}", 100.0 * fraction)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::language::Language;

    #[test]
    fn too_few_simultaneous_readings_are_counted() {
        let reason = |readings| MissingMoments::JointReadings {
            inputs: ["V", "I", "phi"].map(String::from).to_vec(),
            readings,
        };
        let five = missing(&reason(5)).to_string();
        assert!(five.contains("has no standard deviation: 5 simultaneous readings of 3 inputs (V, I and phi) leave ν = n − N = 5 − 3 = 2"), "{five}");
        assert!(five.contains("from 6 on"), "{five}");
        assert!(
            missing(&reason(4))
                .to_string()
                .contains("neither a mean nor")
        );
    }

    #[test]
    fn chinese_is_chinese() {
        let tail = |consequence| MissingMoments::Tail {
            side: Side::Lower,
            index: 1.04,
            consequence,
        };
        for consequence in [
            Consequence::NoMean,
            Consequence::SlowMean,
            Consequence::NoDeviation,
            Consequence::SlowDeviation,
        ] {
            let sentence = missing(&tail(consequence)).in_language(Language::Chinese);
            assert!(sentence.contains("−1.0 次幂"), "{sentence}");
            assert!(
                !sentence.contains(|c: char| c.is_ascii_alphabetic()),
                "{sentence}"
            );
        }
    }
}
