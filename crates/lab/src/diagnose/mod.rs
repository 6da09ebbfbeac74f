//! Diagnosis: does a recording agree with the declared measurement model, and if not, which physics
//! was left out?
//!
//! | chapter | holds |
//! |---|---|
//! | [`faults`] | codes of what is refused |
//! | [`case`] | the case file: model, recording, claims |
//! | `frame` | the rows as numbers; the model at any parameters |
//! | `fit` | the declared model fitted to the recording |
//! | `plan` | what an experiment can see and tell apart, without data |
//! | `extra`, `longer` | measurements that may follow, and the recording together with one of them |
//! | `contender`, `separation` | explanations of the same mismatch, and what tells them apart |
//! | `typical`, `omitted` | usual sizes of effects, and what those cost that are not in the model |
//! | `form` | whether the declared model has an effect already, by its form |
//! | `confirm`, `parts` | how well a model describes the recording, and its parts |
//! | `held_out` | prediction of a recording that the fit has not seen |
//! | `likeness` | what can stand in for something whose trace is known |
//! | `inquiry` | candidates and recording as matrices, asked of `evidence` |
//! | `conclusion` | what is said: names that are told, tentative ones, what has none |
//! | `emphasis` | what is worth attention: lines that change a result, measurements that decide |
//! | `result` | the parameters as the measurands of a budget |
//! | [`rivals`] | methods in common use, to be compared with |
//! | [`evidence`] | the statistics, on matrices only: detection, naming, location, plan |

mod adopt;
mod adopted;
pub mod at_rest;
pub mod case;
pub mod catalogue;
mod compare;
mod conclusion;
mod confirm;
mod contender;
mod correlation;
mod emphasis;
pub mod evidence;
mod extra;
mod failure;
pub mod faults;
mod fit;
mod form;
mod frame;
mod held_out;
mod improved;
mod inquiry;
mod likeness;
mod local;
mod longer;
mod noise;
mod omitted;
mod parts;
mod place;
mod plan;
mod replicates;
mod result;
pub mod rivals;
mod run;
mod separation;
mod simulate;
mod spread;
mod typical;

pub use adopt::{Addition, Extended, Free};
pub use adopted::Adopted;
pub use compare::{Opinion, Pick, opinions};
pub use conclusion::{Conclusion, Doubt, Nameless};
pub use confirm::{Estimated, Quality};
pub use emphasis::{Agreement, Unseen};
pub use extra::{Extra, Measure};
pub use failure::Failure;
pub use fit::{FittedModel, NoFit, Trouble, Unsettled};
pub use held_out::{HeldOutQuality, Prediction};
pub use improved::improved;
pub use likeness::{Likeness, likenesses};
pub use noise::{Claimed, Origin};
pub use omitted::Omitted;
pub use parts::Confirmation;
pub use plan::{Outlook, Promise, Prospect, plan};
pub use result::budget;
pub use run::{Diagnosis, diagnose};
pub use separation::Separating;
pub use simulate::{Sheet, Simulation, simulate};
pub use spread::Growth;
