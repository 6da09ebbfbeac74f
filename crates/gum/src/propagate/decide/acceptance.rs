//! Which measured values are accepted, and which rejected.

use crate::budget::Interval;

/// Where measured values lead to which decision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    /// Accepted values; `None` where no value is.
    pub acceptance: Option<Interval>,
    /// Values outside of it are rejected; between the two nothing is decided.
    pub rejection: Interval,
}
