//! Reads the tables of `tests/data/special`, which `make_table.py` there writes.

/// Compares `function` with every line of `table` that has this name, to a relative `tolerance`.
///
/// A value that is the exponential of a large number cannot be better than the last digit of that
/// number, which is allowed on top.
///
/// A line is `name,argument,…,value`.
pub(super) fn check(table: &str, name: &str, tolerance: f64, function: impl Fn(&[f64]) -> f64) {
    let mut lines = 0;
    let mut worst: (f64, String) = (0.0, String::new());
    for line in table.lines() {
        let mut fields = line.split(',');
        if fields.next() != Some(name) {
            continue;
        }
        lines += 1;
        let mut numbers: Vec<f64> = fields
            .map(|text| text.parse().expect("the table holds numbers"))
            .collect();
        let expected = numbers.pop().expect("a line ends with the value");
        let found = function(&numbers);
        let error = if found == expected {
            0.0
        } else if found.is_nan() || expected == 0.0 || !expected.is_finite() {
            f64::INFINITY
        } else {
            ((found / expected - 1.0).abs() - f64::EPSILON * expected.abs().ln().abs()).max(0.0)
        };
        if error >= worst.0 {
            worst = (
                error,
                format!("{line}: found {found:e}, off by {error:.1e}"),
            );
        }
    }
    assert!(lines > 0, "no line for {name}");
    assert!(worst.0 <= tolerance, "{}", worst.1);
}
