//! The proof on concealed data: many sealed cases, diagnosed and graded, as tables.
//!
//! The diagnosis is handed in as a function, so that nothing here knows how it works.
//!
//! | chapter | holds |
//! |---|---|
//! | `trial` | which cases are made, and one of them run |
//! | `record` | what is kept of a run, as a line of CSV |
//! | `further` | the measurement that a diagnosis recommends for a list, made and diagnosed |
//! | `sequels` | the table of these measurements |
//! | `rate` | how often something happened, with its Clopper–Pearson interval |
//! | `report` | the tables |
//! | `bars` | the first of them: what has to hold, and whether it does |

mod bars;
mod further;
mod rate;
mod record;
mod report;
mod sequels;
mod trial;

pub use further::{Advice, Decision, PROMISED, Request, Sequel, decision, request};
pub use rate::Rate;
pub use record::{Outcome, Record, Twin, read, write};
pub use report::report;
pub use trial::{Ablation, EACH, FIRST_SEED, NULLS, Trial, trials};
