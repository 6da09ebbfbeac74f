//! Calibration: from a recording and measurement equations to coefficients with their covariance.
//!
//! | chapter | holds |
//! |---|---|
//! | `tables` | every table of a calibration file |
//! | [`procedure`] | the procedures of the library: calibration files themselves |

pub mod procedure;
pub(crate) mod tables;
