//! What the comparison of both methods finds (JCGM 101:2008, clause 8).

/// GUM-S1 clause 8.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Validation {
    /// Significant digits of u(y): 1 or 2.
    pub digits: u8,
    /// δ = ½·10^l.
    pub delta: f64,
    /// |y − U_p − y_low|.
    pub d_low: f64,
    /// |y + U_p − y_high|.
    pub d_high: f64,
    /// Standard error of the Monte Carlo ends, the larger of the two.
    pub error: f64,
    /// Whether neither difference exceeds δ, as far as the errors of the ends allow to tell.
    pub verdict: Clause8,
}

/// The verdict of GUM-S1 clause 8.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Clause8 {
    /// Neither difference exceeds δ.
    Validated,
    /// One of them does.
    NotValidated,
    /// The Monte Carlo ends scatter too much to tell: more trials are needed.
    Undecided,
}

impl Validation {
    /// Whether Monte Carlo validates the GUM result beyond doubt.
    pub fn is_validated(&self) -> bool {
        self.verdict == Clause8::Validated
    }
}
