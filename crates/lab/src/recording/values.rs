//! Numbers of a column: the different ones, the largest, and as they are written.

/// Different values, ascending.
pub fn levels_of(x: &[f64]) -> Vec<f64> {
    let mut levels = x.to_vec();
    levels.sort_by(f64::total_cmp);
    levels.dedup();
    levels
}

/// The largest modulus.
pub fn largest(x: &[f64]) -> f64 {
    x.iter().fold(0.0_f64, |most, x| most.max(x.abs()))
}

/// A number rounded to a decimal place not coarser than a step; as it is where there is no step.
pub fn rounded(x: f64, step: f64) -> f64 {
    /// A double has no more.
    const MOST: i32 = 15;
    let place = libm::floor(libm::log10(step));
    if !(step > 0.0 && place.is_finite()) {
        return x;
    }
    let decimals = (-place as i32).clamp(-MOST, MOST);
    let shown = match usize::try_from(decimals) {
        Ok(decimals) => format!("{x:.decimals$}"),
        Err(_) => {
            let power = libm::pow(10.0, place);
            format!("{}", (x / power).round() * power)
        }
    };
    let rounded = shown.parse().unwrap_or(x);
    // No negative zero in a formula.
    if rounded == 0.0 { 0.0 } else { rounded }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_rounded_to_a_place_not_coarser_than_a_step() {
        assert_eq!(rounded(45_231.518_3, 0.002), 45_231.518);
        assert_eq!(rounded(1_234_567.0, 250.0), 1_234_600.0);
        assert_eq!(rounded(-0.001, 0.1), 0.0);
        assert_eq!(rounded(7.123, 0.0), 7.123);
    }
}
