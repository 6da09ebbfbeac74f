//! Sealed cases.
mod climate;
mod effect;
mod noise;
mod random;
mod rig;
mod scenario;
mod schedule;
mod simulate;
mod strength;
mod world;

pub use effect::{Concealed, Physics, Shape};
pub use rig::Rig;
pub use scenario::{Class, NoiseKnowledge, Scenario};
