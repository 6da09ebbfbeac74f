//! Diagnosis: does a recording agree with the declared measurement model, and if not, which physics
//! was left out?
//!
//! | chapter | holds |
//! |---|---|
//! | [`evidence`] | the statistics, on matrices only: detection, naming, location, plan |

pub mod evidence;
