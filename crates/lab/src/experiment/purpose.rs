//! What an experiment is read for.

/// What an experiment is read for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// Its readings.
    Calibrate,
    /// Its schedule, before there are readings.
    Plan,
}
