//! Verdicts compare the decimals of the file: differences, sums and products of decimals against decimal limits, with
//! whole numbers as the independent arithmetic.

use crate::common::Noise;
use crate::common::evaluation::gum;
use gumption::propagate::Verdict;

/// A whole number of the last decimal place, as a decimal.
fn decimal(count: i64, places: usize) -> String {
    let sign = if count < 0 { "-" } else { "" };
    let digits = format!("{:0width$}", count.unsigned_abs(), width = places + 1);
    let (whole, behind) = digits.split_at(digits.len() - places);
    format!("{sign}{whole}.{behind}")
}

#[test]
fn simple_acceptance_is_the_comparison_of_whole_numbers() {
    let mut noise = Noise(20);
    let mut whole = |below: f64| (noise.uniform() * below) as i64;
    let (mut accepted, mut ties) = (0, 0);
    for case in 0..400 {
        let places = 1 + whole(6.0) as usize;
        let (a, b, factor) = (whole(1e7), whole(1e7), 1 + whole(9.0));
        let (model, y) = match case % 3 {
            0 => ("a - b".to_string(), a - b),
            1 => ("a + b".to_string(), a + b),
            _ => (format!("{factor} * a - b"), factor * a - b),
        };
        let (upper, lower) = (y + whole(3.0) - 1, y - whole(3.0) + 1);
        if lower >= upper {
            continue;
        }
        let text = format!(
            "[measurand.y]\nmodel = \"{model}\"\n[input]\na = {{ value = {}, u = {u} }}\nb = {{ value = {}, u = {u} }}\n[conformity]\nlower = {}\nupper = {}\nrule = \"simple\"\n",
            decimal(a, places),
            decimal(b, places),
            decimal(lower, places),
            decimal(upper, places),
            u = decimal(1, places),
        );
        let verdict = gum(&text).conformity[0].verdict;
        let expected = match (lower..=upper).contains(&y) {
            true => Verdict::Conforming,
            false => Verdict::NotConforming,
        };
        assert_eq!(verdict, Some(expected), "{y} in {lower} … {upper}:\n{text}");
        accepted += usize::from(expected == Verdict::Conforming);
        ties += usize::from(y == lower || y == upper);
    }
    assert!(
        accepted > 100 && ties > 50,
        "{accepted} accepted, {ties} at a limit"
    );
}
