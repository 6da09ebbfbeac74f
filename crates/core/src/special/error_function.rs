//! The error function and its complement.

/// erf(x) = 2/√π ∫₀ˣ exp(−t²) dt.
pub fn erf(x: f64) -> f64 {
    libm::erf(x)
}

/// erfc(x) = 1 − erf(x), without loss of digits for large x.
pub fn erfc(x: f64) -> f64 {
    libm::erfc(x)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::table::check;

    #[test]
    fn agree_with_the_table() {
        let table = include_str!("../../../../tests/data/special/normal.csv");
        check(table, "erf", 1e-15, |a| erf(a[0]));
        // The rounding of x² in the exponent alone is 2·x²·1e-16.
        check(table, "erfc", 1e-14, |a| erfc(a[0]));
    }
}
