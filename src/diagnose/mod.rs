//! Diagnosis: does a recording agree with the declared measurement model, and if not, which physics
//! was left out?
//!
//! | chapter | holds |
//! |---|---|
//! | [`faults`] | codes of what is refused |
//! | [`case`] | the case file: model, recording, claims |
//! | `frame` | the rows as numbers; the model at any parameters |
//! | `fit` | the declared model fitted to the recording |
//! | [`rivals`] | methods in common use, to be compared with |
//! | [`evidence`] | the statistics, on matrices only: detection, naming, location, plan |

mod adopt;
pub mod at_rest;
pub mod case;
pub mod catalogue;
mod compare;
mod confirm;
mod correlation;
pub mod evidence;
pub mod faults;
mod fit;
mod frame;
mod improved;
mod local;
mod noise;
mod place;
pub mod rivals;
mod run;
mod simulate;
mod spread;

pub use adopt::{Addition, Extended};
pub use compare::{Opinion, Pick, opinions};
pub use confirm::{Confirmation, Quality};
pub use fit::NoFit;
pub use improved::{RECORDING as IMPROVED_RECORDING, improved};
pub use noise::{Claimed, Origin};
pub use run::{Adopted, Diagnosis, Estimated, Failure, Omitted, diagnose};
pub use simulate::{Sheet, simulate};
pub use spread::Growth;
