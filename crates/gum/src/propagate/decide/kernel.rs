//! The distribution of measured values for a given value of the measurand: normal, or t where u has few degrees
//! of freedom, with a standard uncertainty that may depend on the value.

use crate::budget::Interval;
use gumption_core::special::{student_t_cdf, student_t_pdf, student_t_sf};

/// A measurement as a source of errors.
pub(super) struct Kernel<'a> {
    /// u at a value of the measurand.
    pub u: &'a dyn Fn(f64) -> f64,
    /// ν; infinite for a normal distribution.
    pub dof: f64,
}

impl Kernel<'_> {
    /// Probability of a measured value in the interval.
    pub(super) fn inside(&self, interval: Interval, value: f64) -> f64 {
        let u = (self.u)(value);
        let low = (interval.lower - value) / u;
        let high = (interval.upper - value) / u;
        // From the tail on the side of which the interval lies: 1 − p has no digits left there.
        if low > 0.0 {
            student_t_sf(low, self.dof) - student_t_sf(high, self.dof)
        } else {
            student_t_cdf(high, self.dof) - student_t_cdf(low, self.dof)
        }
    }

    /// Probability of a measured value outside of it.
    pub(super) fn outside(&self, interval: Interval, value: f64) -> f64 {
        let u = (self.u)(value);
        student_t_cdf((interval.lower - value) / u, self.dof)
            + student_t_sf((interval.upper - value) / u, self.dof)
    }

    /// Density of this measured value.
    pub(super) fn density(&self, measured: f64, value: f64) -> f64 {
        let u = (self.u)(value);
        student_t_pdf((measured - value) / u, self.dof) / u
    }
}
