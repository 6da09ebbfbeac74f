//! Coverage factors that are none: a coverage probability in their place, or a decimal point that was lost.

use crate::budget::faults::COVERAGE_FACTOR;
use gumption_core::special::student_t_two_sided_quantile;
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::Stated;

/// The largest probability that results are stated with.
const LARGEST_PROBABILITY: f64 = 0.9973;
/// That of one degree of freedom and 95.45 %, the largest that is stated without degrees of freedom.
const LARGEST: f64 = 13.97;
/// A factor below one may be that of the probable error, 0.6745.
const SMALLEST_PROBABILITY: f64 = 0.68;
/// Printed factors are rounded.
const ROUNDED: f64 = 1.03;

/// What is wrong with a coverage factor that no distribution has; `word` is the key that states a probability.
pub(super) fn no_factor(k: &Stated<f64>, dof: f64, word: &str) -> Option<Fault> {
    let largest = student_t_two_sided_quantile(LARGEST_PROBABILITY, dof).max(LARGEST);
    let is_fraction = (SMALLEST_PROBABILITY..1.0).contains(&k.value);
    if !is_fraction && k.value <= ROUNDED * largest {
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
        ..1.0 => say!("if it is a coverage probability, write {word} = {k}"),
        50.0..100.0 => say!(
            "for a coverage probability of {k} % write {word} = {}",
            gumption_core::quantity::show(k / 100.0)
        ),
        _ => {
            say!("write the coverage factor, mostly 2, or the coverage probability, {word} = 0.95")
        }
    }
}
