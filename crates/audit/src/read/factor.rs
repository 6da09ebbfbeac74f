//! Numbers that may be coverage factors.

/// Whether a number may be a coverage factor: 1 is that of a standard uncertainty.
pub fn is_factor(k: f64) -> bool {
    k > 1.0 && k < 5.0
}

/// Whether a number is a factor that laboratories fix.
pub fn is_fixed(k: f64) -> bool {
    k == 2.0 || FIXED.contains(&k)
}

/// Factors other than 2 that laboratories fix: normal quantiles as they are printed, and 3.
pub(crate) const FIXED: [f64; 4] = [1.96, 3.0, 2.58, 1.65];
