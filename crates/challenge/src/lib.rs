//! Sealed cases: calibrations of inertial sensors and of other instruments, simulated in time, in which
//! something is concealed; and the grading of what a diagnosis says of them.
//!
//! Nothing here knows the regressors of [`diagnose`](gumption_lab::diagnose): effects have states and act where
//! their physics acts, in other forms than any catalogue would give them. Only the grader knows names of
//! the catalogue, as words.
//!
//! | chapter | holds |
//! |---|---|
//! | `random` | one stream of random numbers for each thing that chance decides |
//! | `world` | frames, the Earth, what the device lives through |
//! | `climate` | room, fixture, thermometer; humidity, pressure, supply, vibration |
//! | `rig` | how a rig points the sensor, and the declared model |
//! | `schedule` | when it goes where and when it is read |
//! | `further` | what may be measured after the calibration |
//! | `noise` | white noise, random walk, flicker |
//! | `effect` | everything that can be concealed |
//! | `simulate` | a campaign, in time |
//! | `geometry` | lengths and angles of what is added to a recording |
//! | `strength` | λ and κ from twin runs |
//! | `instrument` | instruments beyond the rigs |
//! | `names` | which names of the catalogue are right for which physics |
//! | `scenario` | what is concealed together, and how strongly |
//! | `truth` | the sealed truth |
//! | `files` | the case as files |
//! | `case` | a sealed case from a seed |
//! | [`budget`] | claimed budgets in which slips are concealed, as sheets |
//! | [`grade`](mod@grade) | a diagnosis held against the truth |
//! | [`study`] | many cases, and the tables of the proof |

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod budget;
mod case;
mod climate;
mod effect;
mod files;
mod further;
mod geometry;
pub mod grade;
mod instrument;
mod names;
mod noise;
mod random;
mod rig;
mod scenario;
mod schedule;
mod simulate;
mod strength;
pub mod study;
mod truth;
mod world;

pub use case::{Bench, Request, SealedCase, challenge};
pub use effect::{Concealed, Physics, Shape};
pub use files::CaseFile;
pub use further::{Further, Mount, Setting};
pub use instrument::Instrument;
pub use names::Accepted;
pub use rig::Rig;
pub use scenario::{Class, NoiseKnowledge, Scenario};
pub use truth::{ALIAS, TrueEffect, Truth, seal};
