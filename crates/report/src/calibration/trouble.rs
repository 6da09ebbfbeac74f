//! Why an experiment gives no coefficients, and combinations of parameters in words.

use gumption_fault::say;
use gumption_lab::calibrate::{Combination, Trouble};

use crate::language::Language;
use crate::number::significant;
use crate::phrase::plural;

/// What is wrong and what to do about it.
pub(super) fn sentences(trouble: &Trouble, l: Language) -> String {
    match trouble {
        Trouble::TooFew { readings, parameters } => say!("{readings} reading{} cannot determine {parameters} parameters; measure at more points, or list fewer parameters.", plural(*readings)).in_language(l),
        Trouble::NoScatter { response, readings, parameters } => say!("The scatter of {response} is not known: {readings} reading{} and {parameters} parameters leave no residuals. Measure at more points, or state the errors of the readings in [reading.{response}] and write noise.from = \"stated\".", plural(*readings)).in_language(l),
        Trouble::NoSamples => say!("noise.from = \"dwells\" needs the samples of each dwell, and every row of this recording is one point. Name the columns that tell dwells apart, dwells = […], or write noise.from = \"residuals\".").in_language(l),
        Trouble::NoWeights { response } => say!("weights = \"readings\" needs the standard uncertainty of every reading of {response}: state it in [reading.{response}], average samples in dwells, or write weights = \"equal\".").in_language(l),
        Trouble::Undetermined { combinations, begun } => {
            let head = say!("The readings do not tell the parameters apart:").in_language(l);
            let tail = say!("Add points where their effects differ, or take one of them as known ([input.NAME] instead of [parameter.NAME]).").in_language(l);
            let list: Vec<String> = combinations.iter().map(|c| format!("  • {}", in_words(c, l))).collect();
            let elsewhere = (!begun.is_empty()).then(|| {
                let names = begun.join(", ");
                say!("Or the search begins where nothing changes: state another start of {names}.").in_language(l)
            });
            let elsewhere = elsewhere.map_or(String::new(), |advice| format!("\n  {advice}"));
            format!("{head}\n{}\n  {tail}{elsewhere}", list.join("\n"))
        }
        Trouble::NoStart { parameters } => {
            let names = parameters.join(", ");
            say!("The equations are not linear in {names}, and the search needs a place to begin: state roughly [parameter.{}] start = ….", parameters[0]).in_language(l)
        }
        Trouble::Undefined { point, response } => {
            let point = l.pick(&point.en, &point.zh);
            say!("The equation of {response} has no value in {point}: check the start values, and the columns for zeros and signs.").in_language(l)
        }
        Trouble::NoConvergence { iterations } => say!("The search found no minimum in {iterations} steps: begin nearer to the solution, or check that each parameter matters.").in_language(l),
        Trouble::TooLarge { readings, bytes, most } => {
            let gib = |bytes: u64| bytes.div_ceil(1 << 30);
            let (needed, most) = (gib(*bytes), gib(*most));
            say!("A calibration of {readings} readings takes about {needed} GiB of memory, and at most {most} GiB are taken. Average the samples of each state first: [recording] dwells = [\"position\"], steps = \"omega\" or still = 50; or take every tenth row of the recording.").in_language(l)
        }
        Trouble::Unsolvable => say!("The least-squares problem cannot be solved as it is stated.").in_language(l),
        Trouble::InPart { label, trouble } => {
            let inner = sentences(trouble, l);
            say!("In \"{label}\": {inner}").in_language(l)
        }
    }
}

/// What may change without a change of the readings.
pub(super) fn in_words(combination: &Combination, l: Language) -> String {
    match combination.changes.as_slice() {
        [(name, ..)] => say!("{name} changes no reading").in_language(l),
        _ => say!("{} together change no reading", changes(combination)).in_language(l),
    }
}

/// The changes of a combination: `K3 + 1, K1 − 0.75 mA/gn`.
pub(super) fn changes(combination: &Combination) -> String {
    let change = |(name, change, unit): &(String, f64, String)| {
        let sign = if *change < 0.0 { '−' } else { '+' };
        let unit = if unit == "1" {
            String::new()
        } else {
            format!(" {unit}")
        };
        format!("{name} {sign} {}{unit}", significant(change.abs(), 3))
    };
    let changes: Vec<String> = combination.changes.iter().map(change).collect();
    changes.join(", ")
}
