//! Diagnosis: does a recording agree with the declared measurement model, and if not, which physics
//! was left out?
//!
//! # Words
//!
//! | word | means |
//! |---|---|
//! | design | the rows of a case as numbers: averaged in blocks, with the unknowns and their slopes |
//! | fitted model | the declared model at its best, with the slopes by everything that an effect may disturb |
//! | cell | an effect of the catalogue on quantities of this case, with all its variants |
//! | candidate, atom | a cell, and a variant of it, as matrices for the statistics |
//! | block | an atom as directions that are seen beside the parameters |
//! | slot | an effect that was found, with the names that may stand for it |
//! | explanation | a name for an effect with the sizes that it may have; rivals explain the same |
//! | visibility | share of an effect that the parameters do not absorb |
//! | λ, κ | strength of an effect, and what the nearest rival leaves of it, in standard deviations |
//!
//! # Chapters
//!
//! | chapter | holds |
//! |---|---|
//! | [`faults`], `failure` | codes of what is refused; why a case could not be diagnosed |
//! | [`case`] | the case file: model, recording, claims |
//! | `design` | the rows as numbers; the model at any parameters |
//! | `blocks` | rows that are averaged together |
//! | `coarse` | the same for the catalogue: a few means in every block of a long recording |
//! | `fit` | the declared model fitted to the recording |
//! | `noise`, `noise_claims` | what is known about the noise of every row; what the case claims about it |
//! | `noise_laws`, `noise_rounding`, `noise_scale` | what the course of the noise may be beside a fit; readings in coarse steps; a scale that wanders |
//! | `replicates`, `noise_growth`, `noise_labels`, `noise_outputs`, `noise_correlation` | noise from rows that agree; noise that grows with the reading, differs from label to label, goes together in several outputs, or is correlated in time |
//! | [`catalogue`] | the effects, and what they do to the rows of a case |
//! | `candidates` | cells and recording as matrices, asked of `evidence` |
//! | [`evidence`] | the statistics, on matrices only: detection, naming, location, plan |
//! | `possible` | sizes that an effect cannot have |
//! | `reduced` | a recording reduced to its residuals |
//! | `settled` | a model fitted, with the noise that is claimed or that it leaves |
//! | `further` | whether a further effect gains more than noise alone gives it |
//! | `inquiry` | the recording asked in stages, noise and effects in turn |
//! | `run` | a diagnosis from end to end |
//! | `adopt`, `adopted` | the model with effects in it: its equations, its fit; how well it does |
//! | `shapes` | time constants, knees and widths of adopted effects, and what is not known of them |
//! | `confirm`, `parts`, `held_out` | how well a model describes the recording, its parts, and a recording that the fit has not seen |
//! | `regions` | where the mismatch may sit |
//! | `plan` | what an experiment can see and tell apart, without data |
//! | `extra`, `prolonged` | measurements that may follow, and the recording together with one of them |
//! | `explanation` | explanations of the same mismatch, and what tells them apart |
//! | `accounts` | why effects that a reader asks about are not the answer |
//! | `typical`, `omitted` | usual sizes of effects, and what those cost that are not in the model |
//! | `declared_form` | whether the declared model has an effect already, by its form |
//! | `conclusion` | what is said: names that are told, tentative ones, what has none |
//! | `emphasis` | what is worth attention: lines that change a result, measurements that decide |
//! | `result`, `improved` | the parameters as the measurands of a budget; the improved case as files |
//! | `chance` | draws in proportion to weights; random numbers |
//! | `simulate` | the recording that a case predicts |
//! | `size`, `parallel` | how much memory a diagnosis takes; work on several threads |
//! | `stand_in` | what can stand in for something whose trace is known |

mod accounts;
mod adopt;
mod adopted;
mod blocks;
mod candidates;
pub mod case;
pub mod catalogue;
mod chance;
mod coarse;
mod conclusion;
mod confirm;
mod declared_form;
mod design;
mod emphasis;
pub mod evidence;
mod explanation;
mod extra;
mod failure;
pub mod faults;
mod fit;
mod further;
mod held_out;
mod improved;
mod inquiry;
mod noise;
mod noise_claims;
mod noise_correlation;
mod noise_growth;
mod noise_labels;
mod noise_laws;
mod noise_outputs;
mod noise_rounding;
mod noise_scale;
mod omitted;
mod parallel;
mod parts;
mod plan;
mod possible;
mod prolonged;
mod reduced;
mod regions;
mod replicates;
mod result;
mod run;
mod settled;
mod shapes;
mod simulate;
mod size;
mod stand_in;
mod typical;

pub use crate::recording::resolution::u_of_step;
pub use accounts::Account;
pub use adopt::{Addition, Extended, Free};
pub use adopted::Adopted;
pub use case::{Asked, Called, Extra, Measure, Origin};
pub use conclusion::{Conclusion, Doubt, Standing};
pub use confirm::{Estimated, Quality};
pub use emphasis::{Agreement, Unseen};
pub use explanation::Separating;
pub use failure::Failure;
pub use fit::{ModelVersion, NoFit, Trouble, Unsettled};
pub use held_out::{HeldOutQuality, Listed, Prediction};
pub use improved::improved;
pub use inquiry::IfIndependent;
pub use noise::Claimed;
pub use noise_correlation::{Correlated, Memory};
pub use noise_growth::{Growth, Quantity};
pub use noise_labels::ByLabel;
pub use noise_outputs::Together;
pub use noise_rounding::{Rounding, Unrounded};
pub use omitted::Omitted;
pub use parts::Confirmation;
pub use plan::{Outlook, Promise, Prospect, plan};
pub use result::budget;
pub use run::{Diagnosis, diagnose};
pub use shapes::{Shape, Shapes};
pub use simulate::{Sheet, Simulation, simulate};
pub use stand_in::{Pick, StandIn, stand_ins};
