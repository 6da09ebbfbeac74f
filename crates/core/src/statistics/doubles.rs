//! What doubles as they are have in common, where sums of twice their precision tell nothing more.

/// The least and the largest number; ∞ and −∞ of none.
pub fn range(numbers: impl IntoIterator<Item = f64>) -> (f64, f64) {
    let none = (f64::INFINITY, f64::NEG_INFINITY);
    numbers
        .into_iter()
        .fold(none, |(least, most), x| (least.min(x), most.max(x)))
}

/// The mean, and the sum of squared deviations from it.
pub fn mean_and_squares(numbers: &[f64]) -> (f64, f64) {
    let mean = numbers.iter().sum::<f64>() / numbers.len() as f64;
    let squares = numbers.iter().map(|x| (x - mean) * (x - mean)).sum();
    (mean, squares)
}

/// The mean, and the experimental standard deviation of one number (GUM 4.2.2).
pub fn mean_and_deviation(numbers: &[f64]) -> (f64, f64) {
    let (mean, squares) = mean_and_squares(numbers);
    (mean, (squares / (numbers.len() as f64 - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn of_three_numbers() {
        let numbers = [1.0, 4.0, -2.0];
        assert_eq!(range(numbers), (-2.0, 4.0));
        assert_eq!(mean_and_squares(&numbers), (1.0, 18.0));
        assert_eq!(mean_and_deviation(&numbers), (1.0, 3.0));
        assert_eq!(range([]), (f64::INFINITY, f64::NEG_INFINITY));
    }
}
