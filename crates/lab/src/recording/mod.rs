//! Recordings of instruments: columns of a CSV file (read by [`gumption_format::csv`]), what is wrong with them, the dwells in them and
//! the statistics of each, and the noise of a long one.
//!
//! | chapter | holds |
//! |---|---|
//! | `checks` | missing values, times that go backwards, saturation, labels … |
//! | `words` | what is said of that, in both languages |
//! | `segment` | dwells: stretches that belong together; settling |
//! | `resolution` | the steps in which readings come |
//! | `values` | the different values of a column, and as they are written |
//! | `average` | mean of a dwell with its standard uncertainty; drift |
//! | `allan` | Allan deviation, overlapping, with confidence intervals |
//! | `power_law` | covariances of Allan variances for noise of a power law |
//! | `noise` | white noise, bias instability and rate random walk from an Allan deviation |
//! | [`at_rest`] | white noise, flicker and random walk by their likelihood, and the covariance matrix that other readings have by them |
//!
//! What makes a recording unreadable is a [`Fault`](gumption_fault::Fault) in a
//! [`Rejection`](gumption_fault::Rejection), drawn under the user's own lines; what makes it doubtful is
//! a [`Finding`], which says how grave it is. Nothing is repaired, and no value is made up: a missing
//! value is NaN, and every later step leaves it out and counts it.
//!
//! Numbers stay in the unit of their column.
//!
//! # A tour
//!
//! ```
//! use gumption_core::quantity::UnitTable;
//! use gumption_lab::recording::{Average, Recording, Request, by_label};
//!
//! let text = "time [s],position,U [mV]\n0,up,1.02\n1,up,1.00\n2,up,1.01\n3,down,-1.03\n4,down,-1.01\n";
//! let requests = [
//!     Request::numbers("time", "time"),
//!     Request::labels("position", "position"),
//!     Request::numbers("output", "U"),
//! ];
//! let recording = Recording::read("tumble.csv", text, &requests, &UnitTable::default())
//!     .map_err(|rejection| rejection.render(false))?;
//! let (Some(position), Some(output)) = (recording.labels("position"), recording.numbers("output"))
//! else {
//!     return Err("the columns are there".to_owned());
//! };
//! let dwells = by_label(&[position]);
//! assert_eq!(dwells.len(), 2);
//! let up = Average::of(&output[dwells[0].rows.clone()]).map_err(|few| few.to_string())?;
//! assert!((up.mean - 1.01).abs() < 1e-12 && (up.s - 0.01).abs() < 1e-12);
//! # Ok::<(), String>(())
//! ```

mod allan;
pub mod at_rest;
mod average;
mod checks;
mod noise;
mod power_law;
pub(crate) mod resolution;
mod segment;
#[cfg(test)]
mod tests;
pub(crate) mod values;
mod words;

pub use allan::{Allan, AllanPoint, Unsuitable, regular_interval};
pub use average::{Average, Drift, TooFew};
pub use checks::{Checks, Finding, Problem, Severity, check};
pub use noise::{Coefficient, Noises};
pub use power_law::PowerLaw;
pub use segment::{Cut, Dwell, Settling, Steps, Stillness, by_label};
pub(crate) use segment::{by_steps, by_stillness};

pub use gumption_format::csv::{
    Column, Content, Data, Epoch, Heading, Labels, Recording, Request, headings, text_of,
};
