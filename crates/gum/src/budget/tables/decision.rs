//! What is decided about a measurand: conformity and detection.

use super::list::List;
use crate::budget::distributions::DistributionEntry;
use gumption_format::toml::Amount;
use gumption_format::toml::{table, words};

table! {
    /// Whether a measurand conforms to a tolerance (JCGM 106).
    ConformityTable "[conformity]" {
        /// Measurand, where there are several.
        measurand: String,
        /// Name of this assessment, where a measurand has several.
        name: String,
        /// Lower tolerance limit.
        lower: Amount,
        /// Upper tolerance limit.
        upper: Amount,
        /// In their place: maximum permissible error, the distance of both limits from `nominal`; `"0.1 %"` is of it.
        mpe: Amount,
        /// Nominal value between the limits; 0 when left out, for an error of indication.
        nominal: Amount,
        /// Of an error of indication, in place of `nominal`: the value of which a relative `mpe` is a part.
        mpe_of: Amount,
        /// Decision rule.
        rule: RuleWord,
        /// Distance of the acceptance limits from the tolerance limits; U when left out.
        guard_band: Amount,
        /// The same as a multiple of U.
        guard_band_factor: f64,
        /// Guarded acceptance: least conformance probability of an accepted item.
        conformance_probability: f64,
        /// Guarded rejection: least probability that a rejected item does not conform.
        nonconformance_probability: f64,
        /// In place of `conformance_probability`: largest specific consumer's risk, its complement.
        specific_consumer_risk: f64,
        /// In place of `nonconformance_probability`: largest specific producer's risk, its complement.
        specific_producer_risk: f64,
        /// Largest global consumer's risk R_C: that an item of the process does not conform and is accepted.
        global_consumer_risk: f64,
        /// Largest global producer's risk R_P: that an item of the process conforms and is rejected.
        global_producer_risk: f64,
        /// Acceptance limits: one for every tolerance limit.
        acceptance: List<Amount>,
        /// What is known of the items before one is measured.
        process: ProcessTable,
        /// Input that carries the measurand's value, where u depends on that value.
        carrier: String,
        /// Nothing is measured yet: only limits and risks are wanted.
        planning: bool,
    }
}

words! {
    /// Decision rules.
    RuleWord {
        /// Acceptance interval = tolerance interval (shared risk).
        Simple "simple",
        /// Acceptance limits inside the tolerance by the guard band.
        GuardedAcceptance "guarded-acceptance",
        /// Acceptance limits outside the tolerance by the guard band.
        GuardedRejection "guarded-rejection",
        /// Undecided within the guard band on both sides of a tolerance limit.
        NonBinary "non-binary",
        /// Guarded acceptance with w = U.
        IlacG8 "ILAC-G8",
        /// Conformance and non-conformance each to be shown with 95 %.
        Iso14253 "ISO 14253-1",
        /// Simple where U is at most a third of MPEV, else undecided within U of the limits.
        Jjf1094 "JJF 1094",
    }
}

table! {
    /// What is known of the items before one is measured.
    ProcessTable "`process`" {
        /// Distribution of the property over the items: `{ NAME = { parameters } }`, in the unit of the measurand.
        distribution: DistributionEntry,
        /// Fraction of the items that conform; a normal distribution centred between both limits follows from it.
        in_tolerance_probability: f64,
    }
}

table! {
    /// Characteristic limits of a measurand that is not negative (ISO 11929).
    DetectionTable "[detection]" {
        /// Measurand, where there are several.
        measurand: String,
        /// Input that carries the measurand's value: the gross counts or the gross indication.
        gross: String,
        /// Probability of recognising an effect that is not there (default 0.05).
        alpha: f64,
        /// Probability of missing an effect at the detection limit (default 0.05).
        beta: f64,
        /// Quantile for α in its place, as the source rounds it: 1.645 for 5 %.
        k_alpha: f64,
        /// Quantile for β in its place, as the source rounds it.
        k_beta: f64,
        /// Coverage probability of the limits of the coverage interval; that of the conventions when left out.
        coverage_probability: f64,
        /// Guideline value that the detection limit must not exceed.
        guideline: Amount,
    }
}
