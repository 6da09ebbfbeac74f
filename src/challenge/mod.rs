//! Sealed cases.
mod case;
mod climate;
mod effect;
mod files;
pub mod grade;
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

pub use case::{Request, SealedCase, challenge};
pub use effect::{Concealed, Physics, Shape};
pub use files::CaseFile;
pub use rig::Rig;
pub use scenario::{Class, NoiseKnowledge, Scenario};
pub use truth::{TrueEffect, Truth, seal};
