//! Budgets, from their text to their figures: the library against its published figures and its reports, the whole
//! program against closed forms and independent algorithms.

#![allow(
    clippy::disallowed_methods,
    reason = "held against the platform's own functions"
)]

#[path = "../common/mod.rs"]
mod common;

mod archives;
mod audits;
mod batch;
mod bit_identity;
mod budgets;
mod certificates;
mod chains;
mod decimals;
mod every_format;
mod formats;
mod fuzzed;
mod independent;
mod interruption;
mod known;
mod one_figure;
#[cfg(feature = "parquet")]
mod parquet;
mod peers;
mod published;
mod references;
mod serve;
mod sheets;
mod strd;
mod verdicts;
mod workbooks;
