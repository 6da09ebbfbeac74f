//! Finitely many values with probabilities, as the discrete and the empirical distribution have them.

use gumption_fault::{Said, say};

use super::stating::ParameterError;

/// Expectation.
pub(super) fn mean(pairs: impl Iterator<Item = (f64, f64)>) -> f64 {
    // About the first value, so that a large common offset costs no digits.
    let mut first = None;
    let mut sum = 0.0;
    for (x, p) in pairs {
        sum += p * (x - *first.get_or_insert(x));
    }
    first.unwrap_or(f64::NAN) + sum
}

/// Central moment.
pub(super) fn moment(pairs: impl Iterator<Item = (f64, f64)> + Clone, order: i32) -> f64 {
    let mean = mean(pairs.clone());
    let mut sum = 0.0;
    for (x, p) in pairs {
        sum += p * (x - mean).powi(order);
    }
    sum
}

/// Smallest and largest of ascending values.
pub(super) fn ends(values: &[f64]) -> (f64, f64) {
    let end = |value: Option<&f64>| value.copied().unwrap_or(f64::NAN);
    (end(values.first()), end(values.last()))
}

/// The steps between ascending values, with the probability of what lies below each.
pub(super) fn steps(values: &[f64], mut below: impl FnMut(usize) -> f64) -> Vec<[f64; 2]> {
    let pairs = values.windows(2).enumerate();
    pairs
        .map(|(index, pair)| [below(index), pair[1] - pair[0]])
        .collect()
}

/// Refuses values that are none or do not ascend.
pub(super) fn ascending(name: &Said, values: &[f64]) -> Result<(), ParameterError> {
    let unusable = |message: Said, help| Err(ParameterError::Unusable { message, help });
    if let Some(x) = values.iter().find(|x| !x.is_finite()) {
        return unusable(
            say!("the {name} holds {x}, but must hold finite numbers"),
            say!("leave it out"),
        );
    }
    match values.windows(2).find(|pair| pair[0] > pair[1]) {
        None => Ok(()),
        Some(pair) => unusable(
            say!(
                "the {name} must ascend, but {} comes before {}",
                pair[0],
                pair[1]
            ),
            say!("put it in order"),
        ),
    }
}
