//! Stated uncertainties against the scatter of simulated calibrations.
