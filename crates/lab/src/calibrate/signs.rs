//! Coefficients whose sign is not that of others like them: the two ways of an axis in each other's place.

use super::coefficient::Coefficient;

/// So many standard uncertainties must a coefficient be from zero for its sign to tell something.
const SURE: f64 = 5.0;

/// Of the coefficients that should have the same sign, those that are fewer; nothing where they are half.
pub(super) fn reversed(coefficients: &[Coefficient], same: &[String]) -> Vec<String> {
    let sure = coefficients
        .iter()
        .filter(|one| same.contains(&one.name) && one.value.abs() > SURE * one.u);
    let (negative, positive): (Vec<_>, Vec<_>) = sure.partition(|one| one.value < 0.0);
    let fewer = match negative.len().cmp(&positive.len()) {
        std::cmp::Ordering::Less => negative,
        std::cmp::Ordering::Equal => Vec::new(),
        std::cmp::Ordering::Greater => positive,
    };
    fewer.into_iter().map(|one| one.name.clone()).collect()
}
