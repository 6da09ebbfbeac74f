//! Numbers of a column: the different ones, the largest, as they are written, and how they go with those of another.

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

/// Coefficient of correlation, of what both columns have a number of; 0 where one of them does not vary.
pub fn correlation(x: &[f64], z: &[f64]) -> f64 {
    let both = x.iter().copied().zip(z.iter().copied());
    let both: Vec<(f64, f64)> = both
        .filter(|(x, z)| x.is_finite() && z.is_finite())
        .collect();
    let count = both.len().max(1) as f64;
    let mean_x = both.iter().map(|(x, _)| x).sum::<f64>() / count;
    let mean_z = both.iter().map(|(_, z)| z).sum::<f64>() / count;
    let sum = |of: fn(f64, f64) -> f64| -> f64 {
        both.iter().map(|(x, z)| of(x - mean_x, z - mean_z)).sum()
    };
    let size = libm::sqrt(sum(|x, _| x * x) * sum(|_, z| z * z));
    if size > 0.0 {
        sum(|x, z| x * z) / size
    } else {
        0.0
    }
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
    fn columns_go_together_where_both_have_numbers() {
        let x = [1.0, 2.0, f64::NAN, 3.0];
        assert!((correlation(&x, &[2.0, 4.0, 9.0, 6.0]) - 1.0).abs() < 1e-15);
        assert!((correlation(&x, &[1.0, 0.0, 9.0, -1.0]) + 1.0).abs() < 1e-15);
        assert_eq!(correlation(&x, &[5.0; 4]), 0.0);
        assert_eq!(correlation(&[], &[]), 0.0);
    }

    #[test]
    fn numbers_are_rounded_to_a_place_not_coarser_than_a_step() {
        assert_eq!(rounded(45_231.518_3, 0.002), 45_231.518);
        assert_eq!(rounded(1_234_567.0, 250.0), 1_234_600.0);
        assert_eq!(rounded(-0.001, 0.1), 0.0);
        assert_eq!(rounded(7.123, 0.0), 7.123);
    }
}
