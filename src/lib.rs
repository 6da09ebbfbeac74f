//! Measurement uncertainty from a budget file: the law of propagation of uncertainty (GUM,
//! JCGM 100) and the propagation of distributions by Monte Carlo (GUM-S1, JCGM 101; S2,
//! JCGM 102 for several measurands), each validating the other.
//!
//! Data flows one way, and the modules stand in that order: text → [`budget`] → [`model`] →
//! [`propagate`] → [`report`].
//!
//! | module | holds |
//! |---|---|
//! | [`fault`] | what is wrong in a user's file, and where |
//! | [`quantity`] | units, dimensions, rounding of decimal numbers |
//! | [`special`] | special functions for quantiles and coverage factors |
//! | [`distribution`] | the distributions an input may have |
//! | [`model`] | the model language: text → checked program → values, derivatives, blocks |
//! | [`budget`] | the file format and the checked budget |
//! | [`propagate`] | GUM and Monte Carlo evaluation of a budget |
//! | [`report`] | text, Markdown, JSON and the certificate's sentence |

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod budget;
pub mod distribution;
pub mod fault;
pub mod model;
pub mod propagate;
pub mod quantity;
pub mod report;
pub mod special;
