//! Every table of the budget file, as the user writes it: here the file as a whole, beside it its tables.

mod claim;
mod column;
mod component;
mod constant;
mod conventions;
mod correlation;
mod decision;
mod fit;
mod input;
mod list;

use crate::budget::cell::Entry;
use gumption_format::toml::{Date, Named, OneOrMany, table};
use list::List;

pub use claim::*;
pub use column::*;
pub use component::*;
pub use constant::*;
pub use conventions::*;
pub use correlation::*;
pub use decision::*;
pub use fit::*;
pub use input::*;

table! {
    /// A budget of measurement uncertainty.
    FileTable "the file" {
        /// What is measured, as a heading.
        title: String,
        /// The heading in Chinese.
        title_zh: String,
        /// The procedure by which it is measured.
        method: String,
        /// The item that is measured or calibrated.
        object: String,
        /// Who evaluated the measurement.
        author: String,
        /// Date of the measurement; certificates past due on it are remarked on.
        date: Date,
        /// Where the figures come from.
        reference: String,
        /// Causes of uncertainty that several inputs share.
        source: Sources,
        /// Anything the reader should know.
        note: String,
        /// Name of a profile, the conventions on which guides differ (`gumption explain profiles`); GUM when left out.
        profile: String,
        /// Statements that every measurand sees: intermediate quantities, functions, measurands themselves.
        model: String,
        /// Changes to single conventions of the profile.
        conventions: ConventionsTable,
        /// How the Monte Carlo method is run.
        monte_carlo: MonteCarloTable,
        /// Units of the file's own: `div = "0.5 mV"`.
        unit: Named<String>,
        /// Exactly known quantities.
        constant: Named<ConstantEntry>,
        /// The quantities to be evaluated.
        measurand: Named<MeasurandTable>,
        /// The quantities on which they depend.
        input: Named<InputTable>,
        /// Curves fitted to data by least squares; their parameters are inputs.
        fit: Named<FitTable>,
        /// Correlation coefficients for which no cause is known.
        correlation: OneOrMany<CorrelationTable>,
        /// Inputs measured together, or given with a covariance matrix.
        joint: OneOrMany<JointTable>,
        /// Whether a measurand conforms to a tolerance.
        conformity: OneOrMany<ConformityTable>,
        /// Decision threshold and detection limit of a measurand that is not negative.
        detection: OneOrMany<DetectionTable>,
        /// What somebody's certificate says; compared, never used.
        claim: OneOrMany<ClaimTable>,
        /// The same budget for a table of values.
        series: SeriesTable,
    }
}

table! {
    /// A quantity to be evaluated.
    MeasurandTable "[measurand]" {
        /// Its formula; several statements on several lines. May be left out if the shared model defines it.
        model: String,
        /// The unit in which the result is wanted; dimension one when left out.
        unit: String,
        /// What it is.
        description: String,
    }
}

table! {
    /// The same budget for a table of values.
    SeriesTable "[series]" {
        /// Names of inputs or constants, `label`, or numbers of the claim such as `claim.value`.
        columns: List<String>,
        /// One list per evaluation, with an entry for every column; "" leaves out what the column names.
        rows: List<List<Entry>>,
        /// In place of both: a CSV file, whose first line names the columns.
        file: String,
        /// Rows whose labels differ in their last number only repeat one another: their mean and scatter are told.
        repetitions: bool,
    }
}
