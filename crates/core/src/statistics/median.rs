//! The middle of numbers.

/// The middle one of numbers, or the mean of the two in the middle; of those that are numbers, NaN where there is none.
pub fn median(mut numbers: Vec<f64>) -> f64 {
    numbers.retain(|x| !x.is_nan());
    let count = numbers.len();
    if count == 0 {
        return f64::NAN;
    }
    let (below, upper, _) = numbers.select_nth_unstable_by(count / 2, f64::total_cmp);
    match count % 2 {
        1 => *upper,
        _ => below
            .iter()
            .copied()
            .fold(f64::NEG_INFINITY, f64::max)
            .midpoint(*upper),
    }
}

#[cfg(test)]
mod tests {
    use super::median;

    #[test]
    fn half_of_the_numbers_are_on_either_side() {
        assert_eq!(median(vec![3.0, f64::NAN, 1.0, 2.0]), 2.0);
        assert_eq!(median(vec![4.0, 1.0, 3.0, 2.0]), 2.5);
        assert!(median(vec![f64::NAN]).is_nan());
    }
}
