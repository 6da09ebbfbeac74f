//! Phrases of a diagnosis: measurements, probabilities, why there is none.

use crate::language::Language;
use crate::number::{percent, significant};
use gumption_core::quantity::to_digits;
use gumption_fault::say;
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::evidence::Refusal;
use gumption_lab::diagnose::{Failure, Measure, ModelVersion, NoFit, Trouble, Unsettled};

/// A further measurement as a phrase.
pub(super) fn measure(measure: &Measure, l: Language) -> String {
    match measure {
        Measure::Own(name) => name.clone(),
        Measure::Again => l.pick("the same once more", "原样重复一次").to_owned(),
        Measure::Reversed => say!("the same once more, in reversed order").in_language(l),
        Measure::Set {
            column,
            value,
            unit,
        } => {
            // Five digits, and not more of them than there are.
            let value = format!("{} {unit}", to_digits(*value, 5));
            let value = value.trim_end();
            say!("the same once more with {column} at {value}").in_language(l)
        }
        Measure::Between(column) => {
            say!("the same once more with {column} half way between its values").in_language(l)
        }
        Measure::Opposite(column) => {
            say!("the same once more while {column} varies twice as much in the opposite sense")
                .in_language(l)
        }
        Measure::Exchanged(column) => {
            say!("the same once more with each {column} in the place of the next").in_language(l)
        }
    }
}

/// A probability in percent: nothing that is tested is certain.
pub(super) fn chance(p: f64) -> String {
    if p > 0.9995 {
        return ">99.9".to_owned();
    }
    percent(p)
}

/// Whether a probability is printed as less than what its digits can show.
pub(super) fn is_below_all_shown(p: f64) -> bool {
    p < 0.0005
}

/// A probability as an equation or inequality.
pub(super) fn p_is(p: f64) -> String {
    if p < 0.001 {
        "p < 0.001".to_owned()
    } else {
        format!("p = {}", significant(p, 2))
    }
}

/// The same below a head that says `p`.
pub(super) fn below_p(equation: &str) -> String {
    equation.replace("p = ", "").replace("p ", "")
}

/// A probability found from so many simulated recordings: the least that they can show is a bound.
pub(super) fn p_found(p: f64, draws: usize) -> String {
    let least = 1.0 / (draws + 1) as f64;
    if p > least {
        p_is(p)
    } else {
        p_is(p).replace("p = ", "p ≤ ")
    }
}

/// Probability of a false alarm in a table.
pub(super) fn probability(p: f64) -> String {
    if p < 0.001 {
        "<0.001".to_owned()
    } else {
        significant(p, 2)
    }
}

/// A fit on which a reader should not rely.
pub(super) fn unsettled(case: &Case, found: &Unsettled, l: Language) -> String {
    let model = match found.model {
        ModelVersion::Declared => l.pick("the declared model", "所声明的模型"),
        ModelVersion::Improved => l.pick("the model with the effects in it", "含上述效应的模型"),
    };
    match &found.trouble {
        Trouble::NoMinimum { steps } => say!("Not settled: the search for the parameters of {model} ended after {steps} steps in a place that is no minimum of χ². Values, uncertainties and names that follow from it may be wrong; state starts nearer to the truth: [parameter] NAME = {{ start = … }}").in_language(l),
        Trouble::NoFit(why) => {
            let why = failure(case, &Failure::Fit(why.clone()), l);
            say!("Not settled: {model} could not be fitted, so nothing is adopted: {why}").in_language(l)
        }
    }
}

/// Why a case could not be diagnosed.
pub fn failure(case: &Case, failure: &Failure, l: Language) -> String {
    match failure {
        Failure::Fit(NoFit::NoStart) => say!("the model has no finite value where the search for its parameters begins; state starts: [parameter] NAME = {{ start = … }}").in_language(l),
        Failure::Fit(NoFit::NoMinimum) => say!("the search for the parameters found no minimum; state starts nearer to the truth: [parameter] NAME = {{ start = … }}").in_language(l),
        Failure::Fit(NoFit::Undetermined(name)) => say!("the recording does not determine the parameter {name}: other parameters do the same to every row (`gumption calibrate` says which). Remove it, make it a [constant], or state what is known of it: value and u").in_language(l),
        Failure::Fit(NoFit::TooFew { observations, unknowns }) => say!("{observations} observations leave nothing to examine beside {unknowns} unknown parameters").in_language(l),
        Failure::Refused(Refusal::Dependent { parameter }) => {
            let name = case.parameters.get(*parameter).map_or("", |p| p.name.as_str());
            say!("the recording does not determine the parameter {name}").in_language(l)
        }
        Failure::TooLarge { rows, bytes, most } => {
            let gib = |bytes: u64| bytes.div_ceil(1 << 30);
            let (needed, most) = (gib(*bytes), gib(*most));
            say!("A diagnosis of {rows} rows takes about {needed} GiB of memory as they are averaged now, and at most {most} GiB are taken. Average them in fewer blocks: [recording] average = 400 or dwells = [\"position\"]; or take a part of the recording.").in_language(l)
        }
        Failure::TooCorrelated { rows, bytes, most } => {
            let gib = |bytes: u64| bytes.div_ceil(1 << 30);
            let (needed, most) = (gib(*bytes), gib(*most));
            say!("Noise that is correlated between {rows} rows takes about {needed} GiB of memory, and at most {most} GiB are taken. Simulate a part of the recording, or state the noise without `walk` and `at_rest`.").in_language(l)
        }
        Failure::Refused(Refusal::Cancelled) => say!("stopped").in_language(l),
        Failure::Refused(Refusal::NoFreedom { rows, parameters }) => say!("{rows} rows leave no degree of freedom beside {parameters} parameters").in_language(l),
        Failure::Refused(Refusal::Variance { .. }) => say!("the noise has rows whose variance is not a positive number").in_language(l),
        Failure::Refused(Refusal::NotPositive) => say!("the covariance matrix of the noise is not positive definite").in_language(l),
        Failure::Refused(Refusal::NotFinite { .. }) => say!("the model has no finite value or slope in some rows").in_language(l),
    }
}
