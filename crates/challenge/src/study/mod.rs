//! The proof on concealed data: many sealed cases, diagnosed and graded, as tables.
//!
//! The diagnosis is handed in as a function, so that nothing here knows how it works.
//!
//! | chapter | holds |
//! |---|---|
//! | `trial` | which cases are made, and one of them run |
//! | `record` | what is kept of a run |
//! | `further` | the measurement that a diagnosis recommends for a list, made and diagnosed |
//! | `rate` | how often something happened, with its Clopper–Pearson interval |
//! | `measures` | what is measured, each with its definition and its floor |
//! | `report` | the tables |

mod further;
mod measures;
mod rate;
mod record;
mod report;
mod trial;

pub use further::{Advice, Decision, PROMISED, Request, Sequel, decision, request};
pub use measures::measures;
pub use rate::Rate;
pub use record::{Outcome, Record, Twin, read, write};
pub use report::report;
pub use trial::{Ablation, CASES, FIRST_SEED, Trial, trials};
