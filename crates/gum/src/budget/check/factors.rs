//! Coverage factors that are none: a coverage probability in their place, or a decimal point that was lost.

use crate::budget::faults::COVERAGE_FACTOR;
use gumption_core::special::{normal_two_sided_quantile, student_t_two_sided_quantile};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::Stated;

/// The largest probability that results are stated with.
const LARGEST_PROBABILITY: f64 = 0.9973;
/// That of most certificates: of one degree of freedom its factor, 13.97, is the largest that is stated without degrees of freedom.
const USUAL_PROBABILITY: f64 = 0.9545;
/// A factor below one may be that of the probable error, 0.6745.
const SMALLEST_PROBABILITY: f64 = 0.68;
/// That of the probable error, by which half of a normal distribution is covered: nobody states less.
const OF_PROBABLE_ERROR: f64 = 0.5;
/// Factors are printed to two digits at least: half a unit of the second one is a twentieth of the number at most.
const ROUNDED: f64 = 1.05;

/// What is wrong with a coverage factor that no distribution has; `word` is the key that states a probability.
pub(super) fn no_factor(k: &Stated<f64>, dof: f64, word: &str) -> Option<Fault> {
    let unstated = student_t_two_sided_quantile(USUAL_PROBABILITY, 1.0);
    let largest = student_t_two_sided_quantile(LARGEST_PROBABILITY, dof).max(unstated);
    let is_fraction = (SMALLEST_PROBABILITY..1.0).contains(&k.value);
    let smallest = normal_two_sided_quantile(OF_PROBABLE_ERROR);
    let is_small = k.value > 0.0 && k.value * ROUNDED < smallest;
    if !is_fraction && !is_small && k.value <= ROUNDED * largest {
        return None;
    }
    let fault = Fault::new(
        COVERAGE_FACTOR,
        k.span.clone(),
        say!("a coverage factor of {}", k.value),
    );
    Some(fault.label(say!("mostly 2")).help(help(k.value, word)))
}

fn help(k: f64, word: &str) -> Said {
    match k {
        SMALLEST_PROBABILITY..1.0 => say!("if it is a coverage probability, write {word} = {k}"),
        50.0..100.0 => say!(
            "for a coverage probability of {k} % write {word} = {}",
            gumption_core::quantity::show(k / 100.0)
        ),
        _ => {
            say!("write the coverage factor, mostly 2, or the coverage probability, {word} = 0.95")
        }
    }
}
