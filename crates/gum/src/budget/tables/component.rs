//! One reason to doubt a quantity, in every way of stating it.

use std::ops::Range;

use super::list::List;
use crate::budget::components::Evaluation;
use crate::budget::distributions::DistributionEntry;
use crate::budget::variants::{Amounts, Groups, Numbers, ReadingsOf};
use gumption_format::toml::{Amount, Date, Dof, OneOrMany, Stated};
use gumption_format::toml::{table, words};

table! {
    /// One reason to doubt a quantity.
    ComponentTable "a component" {
        /// Its name in the budget table: `calibration`.
        name: String,
        /// Way: standard uncertainty; of a vector or of the data of a fit, one for all elements, a list or a column of a CSV file.
        u: Amounts,
        /// Way: half-width a of symmetric limits ±a (rectangular unless `distribution` says otherwise); of a vector or of the data of a fit, one for all elements, a list or a column of a CSV file.
        half_width: Amounts,
        /// Way: lower and upper limit of the quantity itself.
        limits: List<Amount>,
        /// Way, with `minus`: upper limit above the value.
        plus: Amount,
        /// Way, with `plus`: lower limit below the value, as a positive number.
        minus: Amount,
        /// Way: expanded uncertainty from a certificate; without `U`, the certificate behind another way.
        certificate: CertificateTable,
        /// Whether a stated u was evaluated from readings (Type A) or otherwise.
        kind as "type": Evaluation,
        /// Way: repeated readings, in the unit of the input, as a list or from a CSV file; of a vector, one list for each element.
        readings: Numbers,
        /// Way: readings in groups (days, laboratories), one list for each; in subgroups of groups, lists of lists; or from a CSV file.
        groups: Groups,
        /// Way: means, standard deviations and numbers of readings of groups.
        group_summary: GroupSummaryTable,
        /// With `groups`: what is done with a difference between them.
        between: BetweenWord,
        /// Level of significance of the F test of `groups` or of the `outlier_test` (default 0.05).
        significance: f64,
        /// With `readings`: tests the most outlying one; reported, never removed.
        outlier_test: OutlierWord,
        /// Way: accuracy specification of an instrument.
        specification: SpecificationTable,
        /// Way: resolution q of an indication; half-width q/2.
        step: Amount,
        /// Way, with `range`: number of bits of a quantiser.
        bits: u64,
        /// Lower and upper end of the quantiser's range: `[0, 10]`, `[-5, 5]`.
        range: List<Amount>,
        /// Way: a `[source.NAME]` cause; its name.
        source: String,
        /// Way: the scatter of the data about a `[fit.NAME]`; its name. `of` says of how many readings the value is the mean (default 1).
        residual_of: String,
        /// Way: a sample of the distribution itself, as a list or from a CSV file.
        sample: Numbers,
        /// Shape that goes with another way (`"uniform"`), or a way of its own: `{ NAME = { parameters } }`.
        distribution: DistributionEntry,
        /// Way: number of counted events (Poisson).
        count: u64,
        /// Way, with `trials`: number of successes (binomial).
        successes: u64,
        /// Number of attempts.
        trials: u64,
        /// Prior of `count` or `successes`.
        prior: PriorWord,
        /// Trapezoid: ratio of the top to the base, between 0 and 1.
        beta: f64,
        /// Curvilinear trapezoid: half-width of the doubt about the limits.
        d: Amount,
        /// Coverage probability of a normal half-width.
        p: f64,
        /// Degrees of freedom of the standard uncertainty.
        dof: Dof,
        /// Relative uncertainty Δu/u of the standard uncertainty; gives ν = ½(Δu/u)^-2.
        reliability: f64,
        /// Numbers are fractions of the value: `u = 0.001`, `u = "0.1 %"`. With `source`: the cause acts in proportion.
        relative: bool,
        /// With `readings`: whether the estimate is their mean (default), a single reading, or the mean of so many.
        of: ReadingsOf,
        /// Standard deviation from earlier work in place of that of the readings.
        pooled: PooledTable,
        /// With `readings`: correct u for serial correlation.
        autocorrelated: bool,
        /// Vector inputs: one error shared by all elements (default: one for each).
        common: bool,
        /// With `source`: change of the input per unit of the cause.
        sensitivity: Amount,
        /// Standard uncertainty for the GUM method only, where a published table uses another one than that of the distribution.
        gum_u: Amount,
        /// Where the number comes from.
        reference: String,
    }
}

/// Where a parameter stands that goes with the name of a shape.
pub struct Modifier {
    /// Place of the key.
    pub key: Range<usize>,
    /// Place of the value.
    pub span: Range<usize>,
}

impl ComponentTable {
    /// The parameters that go with the name of a shape.
    pub fn modifiers(&self) -> impl Iterator<Item = (&'static str, Modifier)> {
        fn place<T>(stated: &Stated<T>) -> Modifier {
            Modifier {
                key: stated.key.clone(),
                span: stated.span.clone(),
            }
        }
        let beta = self.beta.as_ref().map(|beta| ("beta", place(beta)));
        let d = self.d.as_ref().map(|d| ("d", place(d)));
        beta.into_iter().chain(d)
    }
}

words! {
    /// What is done with a difference between groups of readings.
    BetweenWord {
        /// Its variance is part of u.
        Include "include",
        /// As "include" if an F test finds the difference, else as "none".
        Test "test",
        /// All readings are taken for one population.
        None "none",
    }
}

words! {
    /// Tests for outliers.
    OutlierWord {
        /// Grubbs: largest deviation in units of s.
        Grubbs "grubbs",
        /// Dixon: gap beside the outermost reading over the range.
        Dixon "dixon",
        /// Dixon's Q: gap over the whole range for any number of readings.
        Q "dixon-q",
        /// Four mean deviations of the other readings.
        FourD "4d",
        /// Three standard deviations.
        ThreeS "3s",
    }
}

table! {
    /// What is known of groups of readings.
    GroupSummaryTable "group_summary" {
        /// Mean of each group.
        means: List<Amount>,
        /// Experimental standard deviation of each group.
        s: List<Amount>,
        /// Number of readings of each group, or one number for all.
        n: OneOrMany<u64>,
    }
}

words! {
    /// What is known of a rate or proportion before counting.
    PriorWord {
        /// Constant density.
        Uniform "uniform",
        /// Jeffreys' prior.
        Jeffreys "jeffreys",
        /// Reciprocal of the rate.
        Reciprocal "reciprocal",
    }
}

table! {
    /// Expanded uncertainty from a certificate.
    CertificateTable "certificate" {
        /// Digital calibration certificate (XML): its file. Value, U, k, ν, unit, number, laboratory and date come from it.
        dcc: String,
        /// With `dcc`: which result, by its identifier or name; may be left out where it has only one.
        result: String,
        /// With `dcc`: which point of a result that has several, by its label or number.
        point: String,
        /// Expanded uncertainty U.
        U: Amount,
        /// With `U`: a share of the value that is added to it: `"0.4 ppm"` of U = 30 nm + 0.4·10⁻⁶·L.
        reading: Amount,
        /// Coverage factor k.
        k: f64,
        /// Coverage probability p, in place of k.
        p: f64,
        /// Effective degrees of freedom ν_eff.
        dof: Dof,
        /// Number of the certificate.
        number: String,
        /// Who issued it.
        laboratory: String,
        /// Date of the calibration.
        date: Date,
        /// Date when the next calibration is due.
        due: Date,
    }
}

table! {
    /// Accuracy specification: half-width = reading part + range part + counts + fixed part.
    SpecificationTable "specification" {
        /// Part of the value: `"0.002 %"`.
        reading: Amount,
        /// Part of the range: `"0.0006 %"`; needs `span`.
        range: Amount,
        /// The range of which `range` is a part.
        span: Amount,
        /// Number of counts (digits); needs `step`.
        counts: f64,
        /// Value of one count.
        step: Amount,
        /// A constant part.
        fixed: Amount,
    }
}

table! {
    /// Standard deviation from earlier work.
    PooledTable "pooled" {
        /// Pooled standard deviation of a single reading.
        s: Amount,
        /// Its degrees of freedom.
        dof: Dof,
        /// In place of both: earlier series of readings, one list for each.
        readings: List<List<f64>>,
    }
}
